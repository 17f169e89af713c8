//! Rules on names.

use std::collections::HashSet;

use proc_macro2::Ident;

use super::expressions::{self, Where};
use crate::ast::{Coordinate, Declaration, Expr, Form, Kind, Law};
use crate::errors::{Diagnostics, Extent, nearest, shortened};

/// Names with a meaning of their own.
pub(super) const CONSTANTS: [&str; 3] = ["omega", "t", "pi"];

/// Functions; `max` and `min` take two arguments, all others one.
pub(super) const FUNCTIONS: [&str; 12] = [
    "dot", "ddot", "H", "sgn", "abs", "cos", "sin", "exp", "tanh", "sqrt", "max", "min",
];

/// Every name that is declared, with what it is.
pub(super) fn declared(declaration: &Declaration) -> Vec<(&'static str, &Ident)> {
    let coordinates = declaration
        .coordinates
        .iter()
        .map(|item| ("coordinate", &item.name));
    let parameters = declaration
        .parameters
        .iter()
        .map(|item| (declaration.form.parameter(), &item.name));
    let lets = declaration.lets.iter().map(|item| ("`let`", &item.name));
    let laws = declaration.laws.iter().map(|item| ("law", &item.name));
    let outputs = declaration.outputs.iter();
    let outputs = outputs.map(|item| ("output", &item.name));
    coordinates
        .chain(parameters)
        .chain(lets)
        .chain(laws)
        .chain(outputs)
        .collect()
}

/// The names that a law declares for itself.
pub(super) fn local(law: &Law) -> impl Iterator<Item = (&'static str, &Ident)> {
    let arguments = law.arguments.iter().map(|name| ("argument", name));
    std::iter::once(("gap", &law.gap)).chain(arguments)
}

/// Types of Rust that generated code is made of, and would mean the model instead.
const PRIMITIVES: [&str; 17] = [
    "bool", "char", "str", "f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16",
    "u32", "u64", "u128", "usize",
];

/// Whether a name is that of a type that is built into Rust.
pub(crate) fn is_primitive(name: &Ident) -> bool {
    PRIMITIVES.iter().any(|primitive| name == primitive)
}

/// No name is one that generated code needs: the type is not called like a number of Rust, and nothing is called `__x` or `r#x`.
pub(super) fn names_are_free_in_generated_code(
    declaration: &Declaration,
    diagnostics: &mut Diagnostics,
) {
    let name = &declaration.name;
    if is_primitive(name) {
        let message = format!(
            "`{name}` is a type of Rust, which generated code uses: choose another name, as in `Oscillator`"
        );
        diagnostics.report(Extent::at(name.span()), message);
    }
    let locals = declaration.laws.iter().flat_map(local);
    let mut names: Vec<(&str, &Ident)> = vec![("model", name)];
    names.extend(declared(declaration).into_iter().chain(locals));
    expressions::loops(declaration, &mut |_, _, own| names.extend(own));
    // The name of a law alone is that of its type.
    if declaration.form == Form::LawAlone {
        names.retain(|(what, _)| *what != "law");
    }
    for (_, name) in names {
        let text = name.to_string();
        if text.starts_with("__") {
            let message =
                format!("names that begin with `__` are those of generated code: rename `{text}`");
            diagnostics.report(Extent::at(name.span()), message);
        }
        if let Some(plain) = text.strip_prefix("r#") {
            let message = format!(
                "names are words of mathematics, without `r#`: write `{plain}_` or another name"
            );
            diagnostics.report(Extent::at(name.span()), message);
        }
    }
}

/// More than a model that is written by hand declares, of each kind.
pub(crate) const MOST_DECLARED: usize = 512;

/// There are not too many items of a kind, and a law has not too many arguments. False where a rule that compares names would take
/// too long.
pub(super) fn names_are_few(declaration: &Declaration, diagnostics: &mut Diagnostics) -> bool {
    let items = declared(declaration);
    let mut many = Vec::new();
    let parameter = declaration.form.parameter();
    for kind in ["coordinate", parameter, "`let`", "law", "output"] {
        let names = items.iter().filter(|(what, _)| *what == kind);
        many.push((kind, names.map(|(_, name)| *name).nth(MOST_DECLARED)));
    }
    for law in &declaration.laws {
        many.push(("argument of a law", law.arguments.get(MOST_DECLARED)));
    }
    let mut few = true;
    for (kind, name) in many {
        if let Some(name) = name {
            let message = format!(
                "more than {MOST_DECLARED} declarations of a {}: {}",
                plain(kind),
                match kind {
                    "coordinate" => "write an array, as in `Chain(x[64])`",
                    "`let`" => "write what repeats as a loop",
                    _ => "use numbers, or attach laws to matrices with a `Structure`",
                }
            );
            diagnostics.report(Extent::at(name.span()), message);
            few = false;
        }
    }
    few
}

/// No declared name hides `omega`, `t`, `pi` or a function.
pub(super) fn names_are_not_built_in(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let locals = declaration.laws.iter().flat_map(local);
    let mut names: Vec<(&str, &Ident)> = declared(declaration).into_iter().chain(locals).collect();
    expressions::loops(declaration, &mut |_, _, own| names.extend(own));
    for (what, name) in names {
        let text = name.to_string();
        let meaning = match text.as_str() {
            "omega" => "the frequency of excitation",
            "t" => "time",
            "pi" => "the number 3.14159...",
            other if FUNCTIONS.contains(&other) => "a function",
            _ => continue,
        };
        let message = format!(
            "`{text}` is {meaning} already: give this {} another name",
            plain(what)
        );
        diagnostics.report(Extent::at(name.span()), message);
    }
}

/// No name is declared twice, and none inside a law hides one outside.
pub(super) fn names_are_distinct(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let mut outer: Vec<(&str, String)> = Vec::new();
    for (what, name) in declared(declaration) {
        distinct(what, name, &mut outer, diagnostics);
    }
    for law in &declaration.laws {
        let mut all = outer.clone();
        for (what, name) in local(law) {
            distinct(what, name, &mut all, diagnostics);
        }
    }
    expressions::loops(declaration, &mut |law, around, own| {
        let mut all = outer.clone();
        all.extend(
            law.into_iter()
                .flat_map(local)
                .chain(around.iter().copied())
                .map(|(what, name)| (what, name.to_string())),
        );
        for (what, name) in own {
            distinct(what, name, &mut all, diagnostics);
        }
    });
}

fn distinct(
    what: &'static str,
    name: &Ident,
    known: &mut Vec<(&'static str, String)>,
    diagnostics: &mut Diagnostics,
) {
    let text = name.to_string();
    match known.iter().find(|(_, other)| *other == text) {
        Some((other, _)) if *other == what => {
            let message = format!(
                "{} `{text}` is declared twice: remove or rename one of them",
                plain(what)
            );
            diagnostics.report(Extent::at(name.span()), message);
        }
        Some((other, _)) => {
            let message = format!(
                "{} `{text}` has the name of {} {}: rename one of them",
                plain(what),
                article(other),
                plain(other)
            );
            diagnostics.report(Extent::at(name.span()), message);
        }
        None => known.push((what, text)),
    }
}

fn article(what: &str) -> &'static str {
    match what {
        "argument" | "index" | "output" => "an",
        _ => "a",
    }
}

pub(super) fn plain(what: &str) -> &str {
    what.trim_matches('`')
}

/// Every name that is used has been declared, a `let` before its use; arrays are used with an index, and only they.
pub(super) fn names_are_known(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let mut reported = HashSet::new();
    let mut beside_time = HashSet::new();
    expressions::parts(declaration, &mut |part, at| {
        let (name, indexed) = match &part.kind {
            Kind::Product(factors) => {
                beside_time.extend(multiples_of_time(factors));
                return;
            }
            Kind::Name(name) => (name, false),
            Kind::Element(name, _) => (name, true),
            _ => return,
        };
        let fault = if is_known(declaration, name, at) {
            let coordinate = |item: &&Coordinate| item.name == *name;
            let coordinate = declaration.coordinates.iter().find(coordinate);
            index_is_in_place(name, coordinate.filter(|_| at.law.is_none()), indexed)
        } else {
            let text = name.to_string();
            Some(unknown(declaration, &text, beside_time.contains(&text), at))
        };
        if let Some(message) = fault
            && reported.insert(name.to_string())
        {
            diagnostics.report(part.extent, message);
        }
    });
}

/// The names in a product with `t` that has no `omega`: one of them is what its writer calls the frequency.
fn multiples_of_time(factors: &[(bool, Expr)]) -> HashSet<String> {
    let is_time = |part: &Expr| matches!(&part.kind, Kind::Name(name) if name == "t");
    let mut names = HashSet::new();
    if factors.iter().any(|(_, factor)| is_time(factor)) {
        for (_, factor) in factors {
            factor.walk(&mut |part| {
                if let Kind::Name(name) = &part.kind {
                    names.insert(name.to_string());
                }
            });
        }
    }
    if names.contains("omega") {
        names.clear();
    }
    names
}

fn is_known(declaration: &Declaration, name: &Ident, at: Where<'_, '_>) -> bool {
    let given = match at.law {
        Some(law) => local(law).any(|(_, other)| other == name),
        None => declaration
            .coordinates
            .iter()
            .any(|item| item.name == *name),
    };
    given
        || CONSTANTS.iter().any(|constant| name == constant)
        || declaration.parameters.iter().any(|item| item.name == *name)
        || declaration.lets[..at.lets]
            .iter()
            .any(|item| item.name == *name)
        || at.loops.iter().any(|(_, other)| *other == name)
}

fn index_is_in_place(
    name: &Ident,
    coordinate: Option<&Coordinate>,
    indexed: bool,
) -> Option<String> {
    match (coordinate.map(|item| item.count), indexed) {
        (Some(Some(count)), false) => Some(format!(
            "`{name}` is an array of {}: write one of them, as in `{name}[0]`",
            super::counted(count, "coordinate")
        )),
        (Some(None), true) => Some(format!(
            "`{name}` is a single coordinate: write `{name}`, or declare an array, as in `Model({name}[8])`"
        )),
        (None, true) => Some(format!(
            "`{name}` is no array: only coordinates have an index"
        )),
        _ => None,
    }
}

fn unknown(declaration: &Declaration, name: &str, beside_time: bool, at: Where<'_, '_>) -> String {
    let shown = shortened(name);
    let name = shown.as_str();
    if FUNCTIONS.contains(&name) || declaration.laws.iter().any(|item| item.name == name) {
        return format!("`{name}` takes an argument in parentheses, as in `{name}(...)`");
    }
    if declaration.lets.iter().any(|item| item.name == name) {
        return format!("`{name}` is used before its `let`: move the `let` up");
    }
    if declaration.outputs.iter().any(|item| item.name == name) {
        return format!("`{name}` is an output, which is only read: name what both need by `let`");
    }
    let coordinates = || declaration.coordinates.iter().map(|item| &item.name);
    if let Some(law) = at.law
        && coordinates().any(|coordinate| coordinate == name)
    {
        return format!(
            "`{name}` is a coordinate, and a law knows only its gap: write `{}` here and call the law with `{name}` in the equation",
            law.gap
        );
    }
    if beside_time {
        return format!(
            "unknown name `{name}`: the frequency of excitation is called `omega`, as in `cos(omega*t)`"
        );
    }
    let known = candidates(declaration, at);
    match nearest(name, known.iter().map(String::as_str)) {
        Some(meant) => format!("unknown name `{name}`: did you mean `{meant}`?"),
        None => format!(
            "unknown name `{name}`: {}",
            how_to_declare(declaration, name)
        ),
    }
}

/// Every name that could have been meant.
fn candidates(declaration: &Declaration, at: Where<'_, '_>) -> Vec<String> {
    let mut known: Vec<String> = CONSTANTS.map(str::to_owned).to_vec();
    known.extend(
        declaration
            .parameters
            .iter()
            .map(|item| item.name.to_string()),
    );
    known.extend(
        declaration.lets[..at.lets]
            .iter()
            .map(|item| item.name.to_string()),
    );
    known.extend(at.loops.iter().map(|(_, name)| name.to_string()));
    match at.law {
        Some(law) => known.extend(local(law).map(|(_, name)| name.to_string())),
        None => known.extend(
            declaration
                .coordinates
                .iter()
                .map(|item| item.name.to_string()),
        ),
    }
    known
}

fn how_to_declare(declaration: &Declaration, name: &str) -> String {
    match (declaration.form, declaration.laws.first()) {
        (Form::LawAlone, Some(law)) => format!(
            "add it to the arguments, as in `{}({}, {name})`",
            law.name, law.gap
        ),
        _ => format!("declare it with `param {name};`"),
    }
}
