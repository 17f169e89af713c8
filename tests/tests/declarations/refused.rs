//! Faulty declarations and the messages they get: each case is one file in `tests/compile_fail`, with its messages beside it.
//!
//! What the macros emit for a case is turned into the text that `rustc` shows, which takes no time. That `rustc` shows just that is
//! checked with all cases in a few programs, since it takes a while to start and reports everything that is wrong with one. They are
//! a package of their own that depends on little, which is checked once; trybuild would check all dependencies of this package, twice.
//!
//!     UPDATE_MESSAGES=1 cargo test -p hertzian-tests --test declarations refused
//!
//! rewrites the messages of the cases.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::shown;

/// How many programs hold all cases.
const FILES: usize = 4;

/// The cases in alphabetical order, each with the path that `rustc` shows.
fn cases() -> Vec<(PathBuf, String)> {
    let folder = Path::new("tests/compile_fail");
    let inside = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let mut cases: Vec<(PathBuf, String)> = inside
        .expect("the folder of the cases")
        .map(|entry| entry.expect("a file of the folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| {
            let name = path.file_name().expect("the name of a file");
            let shown = folder.join(name).display().to_string();
            (path, shown)
        })
        .collect();
    cases.sort();
    cases
}

#[test]
fn faulty_declarations_are_refused_where_they_are_wrong() {
    let update = std::env::var_os("UPDATE_MESSAGES").is_some();
    let cases = cases();
    assert!(!cases.is_empty());
    for (path, name) in cases {
        let text = fs::read_to_string(&path).expect("a case");
        let messages = shown::of(&text, &name);
        assert!(!messages.is_empty(), "{name} is not refused");
        let beside = path.with_extension("stderr");
        if update {
            fs::write(&beside, &messages).expect("the folder is writable");
        }
        let expected = fs::read_to_string(&beside).unwrap_or_default();
        assert!(
            messages == expected,
            "{name} has other messages:\n\n{messages}\ninstead of\n\n{expected}"
        );
    }
}

/// The package of the files, which depends on the runtime alone.
const MANIFEST: &str = r#"
[package]
name = "refused"
edition = "2024"

[dependencies]
hertzian = { path = "CORE", default-features = false }

[workspace]
"#;

/// Writes a package whose programs hold all cases, each as a module of its own so that names do not meet. Given back are the
/// programs with the messages that they are to get.
fn package(folder: &Path) -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("");
    let core = root.join("core").display().to_string();
    let sources = folder.join("src/bin");
    fs::create_dir_all(&sources).expect("a folder for files of tests");
    fs::write(folder.join("Cargo.toml"), MANIFEST.replace("CORE", &core)).expect("a manifest");
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file");
    let cases = cases();
    let parts = cases.chunks(cases.len().div_ceil(FILES)).enumerate();
    let programs = parts.map(|(index, part)| {
        let mut text = "#![allow(dead_code)]\nfn main() {}\n".to_owned();
        for (path, _) in part {
            let name = path.file_stem().expect("the name of a case").display();
            let case = fs::read_to_string(path).expect("a case");
            let _ = write!(text, "mod {name} {{\n{case}}}\n");
        }
        let program = format!("some_{index}");
        let file = format!("src/bin/{program}.rs");
        fs::write(folder.join(&file), &text).expect("a program");
        (program, shown::of(&text, &file))
    });
    programs.collect()
}

/// What `rustc` says of each program of a package, besides how many errors there were.
fn said(folder: &Path) -> BTreeMap<String, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(folder)
        .args(["check", "--bins", "--keep-going", "--offline", "--quiet"])
        .arg("--message-format=json")
        // Else lines are cut to the width of the terminal.
        .env("RUSTFLAGS", "--diagnostic-width=140")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("CARGO_INCREMENTAL", "0")
        .output()
        .expect("cargo runs");
    let mut said = BTreeMap::<String, String>::new();
    for line in output.stdout.split(|byte| *byte == b'\n') {
        let Ok(line) = serde_json::from_slice::<Value>(line) else {
            continue;
        };
        let message = &line["message"];
        let has_place = message["spans"].as_array().is_some_and(|at| !at.is_empty());
        if let (true, Some(program), Some(text)) = (
            has_place,
            line["target"]["name"].as_str(),
            message["rendered"].as_str(),
        ) {
            let messages = said.entry(program.to_owned()).or_default();
            if !messages.is_empty() {
                messages.push('\n');
            }
            messages.push_str(text.trim_end());
            messages.push('\n');
        }
    }
    assert!(
        !said.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    said
}

#[test]
fn the_compiler_shows_these_messages_and_no_others() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused");
    let expected = package(&folder);
    let found = said(&folder);
    assert_eq!(expected.len(), found.len());
    for (program, expected) in &expected {
        let found = &found[program];
        assert!(
            found == expected,
            "{program} gets other messages:\n\n{found}\ninstead of\n\n{expected}"
        );
    }
}
