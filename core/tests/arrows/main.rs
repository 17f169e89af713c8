//! Rooms of the runtime depend one way: each names only rooms that stand before it in [`ROOMS`].
//!
//! Every path of every file is resolved from its tokens: in `use`, in place, in macros, and in attributes that hold a path as text, as
//! serde's do. Links of documentation are not looked at, and code for tests may look anywhere: a test of a room compares it with others.
//! What is not allowed at all is a name that the root re-exports, since it hides which room is meant.

mod reader;

use std::fs;
use std::path::{Path, PathBuf};

use reader::{Reader, arrows};

/// The contract under the names that users have for it; it stands before everything.
const CONTRACT: &[&str] = &["law", "system"];

/// The modules of the package of the contract.
const IN_CONTRACT: &[&str] = &[
    "setters",
    "data",
    "law",
    "output",
    "system",
    "declared",
    "constants",
];

/// Single files that stand before all rooms, at most four.
const SHARED: &[&str] = &["serialise", "event", "cancel"];

/// The modules of the compiler, the first that runs first. What differentiates and simplifies stands before lowering, which takes terms
/// apart with both; `stages` calls them in the order in which a declaration passes through them.
const STAGES: &[&str] = &[
    "errors",
    "dag",
    "ast",
    "index",
    "ir",
    "parse",
    "check",
    "differentiate",
    "simplify",
    "lower",
    "facts",
    "primitive",
    "tape",
    "interpret",
    "emit",
    "stages",
    "sketch",
    "law_alone",
    "text",
];

/// Packages that the runtime is built on, and which of them each is built on itself.
const LEAVES: &[(&str, &[&str])] = &[
    ("contract", &[]),
    ("file", &[]),
    ("fourier", &[]),
    ("chart", &["file"]),
];

/// The rooms, the lowest first. What is asked of either method stands behind both.
const ROOMS: &[&str] = &[
    "numeric",
    "error",
    "model",
    "laws",
    "time",
    "continuation",
    "branches",
    "balance",
    "orbit",
    "balance_branch",
    "shooting",
    "contact_equation",
    "response",
    "sensitivity",
    "attractors",
    "bifurcation",
    "report",
];

/// Modules that only tests see.
const TESTS: &[&str] = &["guide", "testing"];

/// The arrows of a text that run up.
fn up(room: &str, text: &str, order: &[&str]) -> Vec<String> {
    let arrows = Reader::of(&[room.to_owned(), "file".to_owned()], text).arrows;
    let up = arrows.into_iter().filter(|arrow| !arrow.runs_down(order));
    up.map(|arrow| arrow.path).collect()
}

/// What stands before what in the runtime.
fn order() -> Vec<&'static str> {
    [CONTRACT, SHARED, ROOMS].concat()
}

/// The root of a package of this folder's, or of the runtime itself.
fn root(package: &str) -> PathBuf {
    let runtime = Path::new(env!("CARGO_MANIFEST_DIR"));
    runtime.join(package).join("src/lib.rs")
}

/// Fails if a path of a package runs up, or if so few are read that something must have been passed over.
fn assert_no_arrow_runs_up(package: &str, order: &[&str], least: usize) {
    let found = arrows(&root(package), &[]);
    assert!(found.len() >= least, "{} paths are read", found.len());
    let up = found.iter().filter(|arrow| !arrow.runs_down(order));
    let up: Vec<String> = up
        .map(|arrow| format!("{} names {}", arrow.module, arrow.path))
        .collect();
    assert!(up.is_empty(), "run up:\n{}", up.join("\n"));
}

#[test]
fn rooms_name_only_rooms_before_them() {
    assert_no_arrow_runs_up("", &order(), 500);
}

#[test]
fn every_module_of_the_root_has_its_place() {
    assert!(SHARED.len() <= 4);
    let root = root("");
    let text = fs::read_to_string(&root).expect("the root");
    for name in Reader::of(&[], &text).declared {
        let name = name.as_str();
        let known = [CONTRACT, SHARED, ROOMS, TESTS].concat().contains(&name);
        assert!(known, "{name} has no place among the rooms");
        let is_file = root.with_file_name(format!("{name}.rs")).exists();
        let may_be_file = [CONTRACT, SHARED, TESTS].concat().contains(&name);
        assert!(!is_file || may_be_file, "{name} is no room");
    }
}

#[test]
fn stages_of_the_compiler_name_only_stages_before_them() {
    assert_no_arrow_runs_up("../macros/compiler", STAGES, 100);
}

#[test]
fn modules_of_the_contract_name_only_modules_before_them() {
    assert_no_arrow_runs_up("contract", IN_CONTRACT, 10);
}

/// Packages below the runtime know nothing of it: they depend on nothing of this workspace but what is listed.
#[test]
fn leaves_depend_on_leaves_alone() {
    for (package, needs) in LEAVES {
        let manifest = root(package).with_file_name("../Cargo.toml");
        let manifest = fs::read_to_string(manifest).expect("a manifest");
        let of_ours = manifest.lines().filter_map(|line| {
            let name = line.split(['.', ' ', '=']).next()?;
            name.strip_prefix("hertzian-")
        });
        let of_ours: Vec<&str> = of_ours.collect();
        assert_eq!(of_ours, *needs, "{package}");
    }
}

#[test]
fn planted_arrows_are_found() {
    for (text, path) in [
        ("use crate::report::Table;", "report::Table"),
        ("use crate::{numeric::fourier, report};", "report"),
        (
            "use super::super::{numeric, response::{run::{self, Run as R}}};",
            "response::run",
        ),
        ("fn f() -> f64 { crate::response::f(0.5) }", "response::f"),
        ("fn f(x: &dyn A<crate::response::B>) {}", "response::B"),
        ("type A = <crate::response::B as C>::D;", "response::B"),
        (
            "mod inner { use super::super::super::report::A; }",
            "report::A",
        ),
        ("use crate::report::*;", "report"),
        ("use hertzian::report::A;", "report::A"),
        ("fn f() { ::hertzian::report::f() }", "report::f"),
        (
            "macro_rules! m { () => { $crate::report::A }; }",
            "report::A",
        ),
        (
            "impl A { #[serde(with = \"crate::report::f\")] x: u8 }",
            "report::f",
        ),
        (
            "struct A { #[cfg_attr(feature = \"serde\", serde(with = \"crate::report::f\"))] x: u8 }",
            "report::f",
        ),
        (
            "#[cfg(test)] mod tests { } use crate::report::A;",
            "report::A",
        ),
        (
            "#[cfg(test)] pub(crate) fn f() {} use crate::report::A;",
            "report::A",
        ),
        // Names of the root, whatever they are in truth.
        ("use crate::Branch;", "Branch"),
        ("use crate::*;", ""),
        ("use crate as root;", ""),
    ] {
        assert_eq!(
            up("balance", text, &order()).first().map(String::as_str),
            Some(path),
            "{text}"
        );
    }
}

#[test]
fn planted_arrows_of_the_compiler_are_found() {
    let up = |stage, text| up(stage, text, STAGES);
    assert_eq!(up("check", "use crate::lower::term;"), ["lower::term"]);
    assert_eq!(up("tape", "use crate::emit::powers;"), ["emit::powers"]);
    let none: [&str; 0] = [];
    assert_eq!(up("lower", "use crate::simplify::expand;"), none);
}

#[test]
fn what_is_allowed_is_not_reported() {
    for text in [
        "use crate::numeric::{fourier::{self, series}, linear::*};",
        "use super::terms::{block, block_mut}; use self::inner::A;",
        "pub(crate) mod a { pub(in crate::balance) fn f(&self) { self.g() } }",
        "/// See [`crate::report`]\nfn f() {}",
        "#[doc = \"crate::report\"] fn f() {}",
        "#[cfg(test)] mod tests { use crate::report::Table; }",
        "#[cfg(test)] use crate::report::Table;",
        "#[cfg(test)] #[allow(dead_code)] pub(crate) fn f() { crate::report::f() }",
        "#[cfg(all(test, feature = \"plot\"))] fn f() { crate::report::f() }",
        "fn f() { a::crate_report::b(); let report = 1; }",
    ] {
        assert_eq!(
            up("balance", text, &order()),
            Vec::<String>::new(),
            "{text}"
        );
    }
}
