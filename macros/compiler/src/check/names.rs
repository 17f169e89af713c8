//! Rules on names.

use std::collections::HashSet;

use proc_macro2::Ident;

use crate::ast::{Condition, Declaration, Expr, Kind, Law};
use crate::errors::{Diagnostics, Extent, nearest};

/// Names with a meaning of their own.
const CONSTANTS: [&str; 3] = ["omega", "t", "pi"];

/// Functions and the number of their arguments, which is always one.
const FUNCTIONS: [&str; 10] = [
    "dot", "ddot", "H", "sgn", "abs", "cos", "sin", "exp", "tanh", "sqrt",
];

/// Every name that is declared, with what it is.
fn declared(declaration: &Declaration) -> Vec<(&'static str, &Ident)> {
    let coordinates = declaration
        .coordinates
        .iter()
        .map(|name| ("coordinate", name));
    let parameters = declaration
        .parameters
        .iter()
        .map(|item| ("parameter", &item.name));
    let lets = declaration.lets.iter().map(|item| ("`let`", &item.name));
    let laws = declaration.laws.iter().map(|item| ("law", &item.name));
    coordinates
        .chain(parameters)
        .chain(lets)
        .chain(laws)
        .collect()
}

/// The names that a law declares for itself.
fn local(law: &Law) -> impl Iterator<Item = (&'static str, &Ident)> {
    let arguments = law.arguments.iter().map(|name| ("argument", name));
    std::iter::once(("gap", &law.gap)).chain(arguments)
}

/// No declared name hides `omega`, `t`, `pi` or a function.
pub(super) fn names_are_not_built_in(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let locals = declaration.laws.iter().flat_map(local);
    for (what, name) in declared(declaration).into_iter().chain(locals) {
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
                "{} `{text}` has the name of a {}: rename one of them",
                plain(what),
                plain(other)
            );
            diagnostics.report(Extent::at(name.span()), message);
        }
        None => known.push((what, text)),
    }
}

fn plain(what: &str) -> &str {
    what.trim_matches('`')
}

/// The expressions of a declaration, each with the law it stands in and how many of the `let` items come before it.
fn expressions(declaration: &Declaration) -> Vec<(&Expr, Option<&Law>, usize)> {
    let lets = declaration.lets.len();
    let mut all: Vec<(&Expr, Option<&Law>, usize)> = declaration
        .lets
        .iter()
        .enumerate()
        .map(|(index, item)| (&item.value, None, index))
        .collect();
    for law in &declaration.laws {
        for piece in &law.pieces {
            if let Condition::All(comparisons, _) = &piece.condition {
                for comparison in comparisons {
                    all.push((&comparison.smaller, Some(law), lets));
                    all.push((&comparison.larger, Some(law), lets));
                }
            }
            all.push((&piece.force, Some(law), lets));
        }
    }
    for equation in &declaration.equations {
        all.push((&equation.left, None, lets));
        all.push((&equation.right, None, lets));
    }
    all
}

/// Every name that is used has been declared, and a `let` before its use.
pub(super) fn names_are_known(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let mut reported = HashSet::new();
    for (expression, law, lets) in expressions(declaration) {
        let mut known: Vec<String> = CONSTANTS.map(str::to_owned).to_vec();
        known.extend(
            declaration
                .parameters
                .iter()
                .map(|item| item.name.to_string()),
        );
        known.extend(
            declaration.lets[..lets]
                .iter()
                .map(|item| item.name.to_string()),
        );
        match law {
            Some(law) => known.extend(local(law).map(|(_, name)| name.to_string())),
            None => known.extend(declaration.coordinates.iter().map(ToString::to_string)),
        }
        expression.walk(&mut |part| {
            let Kind::Name(name) = &part.kind else { return };
            let text = name.to_string();
            if !known.contains(&text) && reported.insert(text.clone()) {
                diagnostics.report(part.extent, unknown(declaration, &text, law, &known));
            }
        });
    }
}

fn unknown(declaration: &Declaration, name: &str, law: Option<&Law>, known: &[String]) -> String {
    if FUNCTIONS.contains(&name) || declaration.laws.iter().any(|item| item.name == name) {
        return format!("`{name}` takes an argument in parentheses, as in `{name}(...)`");
    }
    if declaration.lets.iter().any(|item| item.name == name) {
        return format!("`{name}` is used before its `let`: move the `let` up");
    }
    if let Some(law) = law
        && declaration
            .coordinates
            .iter()
            .any(|coordinate| coordinate == name)
    {
        return format!(
            "`{name}` is a coordinate, and a law knows only its gap: write `{}` here and call the law with `{name}` in the equation",
            law.gap
        );
    }
    match nearest(name, known.iter().map(String::as_str)) {
        Some(meant) => format!("unknown name `{name}`: did you mean `{meant}`?"),
        None => format!("unknown name `{name}`: declare it with `param {name};`"),
    }
}

/// Every call is of a function or law that exists, with as many arguments as it takes.
pub(super) fn calls_are_of_known_functions(
    declaration: &Declaration,
    diagnostics: &mut Diagnostics,
) {
    for (expression, inside, _) in expressions(declaration) {
        expression.walk(&mut |part| {
            let Kind::Call(name, arguments) = &part.kind else { return };
            let text = name.to_string();
            let law = declaration.laws.iter().find(|law| law.name == text);
            if let (Some(_), Some(_)) = (law, inside) {
                let message = "a law cannot call a law: write the force out, or add the two laws in the equation";
                diagnostics.report(part.extent, message);
                return;
            }
            let expected = match law {
                Some(law) => 1 + law.arguments.len(),
                None if FUNCTIONS.contains(&text.as_str()) => 1,
                None => {
                    diagnostics.report(Extent::at(name.span()), unknown_function(declaration, &text));
                    return;
                }
            };
            if arguments.len() != expected {
                let message = format!(
                    "`{text}` takes {}, and {} given",
                    super::counted(expected, "argument"),
                    match arguments.len() {
                        0 => "none is".to_owned(),
                        1 => "1 is".to_owned(),
                        count => format!("{count} are"),
                    }
                );
                diagnostics.report(part.extent, message);
            }
        });
    }
}

fn unknown_function(declaration: &Declaration, name: &str) -> String {
    if CONSTANTS.contains(&name)
        || declared(declaration)
            .iter()
            .any(|(_, other)| *other == name)
    {
        return format!("`{name}` is not a function: write a star, `{name}*(...)`");
    }
    let advice = match name {
        "sign" | "signum" => Some("sgn".to_owned()),
        "heaviside" | "step" | "Heaviside" => Some("H".to_owned()),
        "diff" | "d" => Some("dot".to_owned()),
        "min" | "max" => {
            return format!("unknown function `{name}`: write the two cases as pieces of a law");
        }
        _ => {
            let laws: Vec<String> = declaration
                .laws
                .iter()
                .map(|law| law.name.to_string())
                .collect();
            let known = FUNCTIONS.into_iter().chain(laws.iter().map(String::as_str));
            nearest(name, known).map(str::to_owned)
        }
    };
    match advice {
        Some(meant) => format!("unknown function `{name}`: did you mean `{meant}`?"),
        None => format!(
            "unknown function `{name}`: the functions are {}",
            FUNCTIONS.join(", ")
        ),
    }
}

/// Every parameter, law, `let`, coordinate and law argument is used.
pub(super) fn everything_is_used(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let mut used: HashSet<String> = HashSet::new();
    for (expression, _, _) in expressions(declaration) {
        expression.walk(&mut |part| {
            if let Kind::Name(name) | Kind::Call(name, _) = &part.kind {
                used.insert(name.to_string());
            }
        });
    }
    for (what, name) in declared(declaration) {
        let advice = match what {
            "parameter" => "remove it, or use it in a law or an equation",
            "law" => "call it in an equation, or remove it",
            "`let`" => "remove it",
            _ => continue,
        };
        if !used.contains(&name.to_string()) {
            diagnostics.report(
                Extent::at(name.span()),
                format!("{} `{name}` is never used: {advice}", plain(what)),
            );
        }
    }
    for law in &declaration.laws {
        arguments_are_used(law, diagnostics);
    }
}

fn arguments_are_used(law: &Law, diagnostics: &mut Diagnostics) {
    let mut used: HashSet<String> = HashSet::new();
    let mut note = |expression: &Expr| {
        expression.walk(&mut |part| {
            if let Kind::Name(name) = &part.kind {
                used.insert(name.to_string());
            }
        });
    };
    for piece in &law.pieces {
        note(&piece.force);
        if let Condition::All(comparisons, _) = &piece.condition {
            for comparison in comparisons {
                note(&comparison.smaller);
                note(&comparison.larger);
            }
        }
    }
    for (what, name) in local(law) {
        if !used.contains(&name.to_string()) {
            let advice = match what {
                "gap" => "a force without a gap is a load, which stands in the equation",
                _ => "use it, or remove it",
            };
            let message = format!(
                "{what} `{name}` of law `{}` is never used: {advice}",
                law.name
            );
            diagnostics.report(Extent::at(name.span()), message);
        }
    }
}
