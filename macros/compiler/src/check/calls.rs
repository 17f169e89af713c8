//! Rules on calls.

use std::collections::HashSet;

use super::expressions;
use super::names::{CONSTANTS, FUNCTIONS, declared};
use crate::ast::{Declaration, Kind};
use crate::errors::{Diagnostics, Extent, nearest, shortened};

/// Every call is of a function or law that exists, with as many arguments as it takes.
pub(super) fn calls_are_of_known_functions(
    declaration: &Declaration,
    diagnostics: &mut Diagnostics,
) {
    expressions::parts(declaration, &mut |part, at| {
        let Kind::Call(name, arguments) = &part.kind else {
            return;
        };
        let text = shortened(name);
        let law = declaration.laws.iter().find(|law| law.name == text);
        if let (Some(_), Some(_)) = (law, at.law) {
            let message =
                "a law cannot call a law: write the force out, or add the two laws in the equation";
            diagnostics.report(part.extent, message);
            return;
        }
        let expected = match law {
            Some(law) => 1 + law.arguments.len(),
            None if text == "max" || text == "min" => 2,
            None if FUNCTIONS.contains(&text.as_str()) => 1,
            None => {
                diagnostics.report(
                    Extent::at(name.span()),
                    unknown_function(declaration, &text),
                );
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

/// The law that nothing calls, if there is one and not more: a law renamed where it is declared, and not where it is called.
fn renamed(declaration: &Declaration) -> Option<String> {
    let mut called = HashSet::new();
    expressions::parts(declaration, &mut |part, _| {
        if let Kind::Call(name, _) = &part.kind {
            called.insert(name.to_string());
        }
    });
    let laws = declaration.laws.iter().map(|law| law.name.to_string());
    let mut idle = laws.filter(|law| !called.contains(law));
    let law = idle.next()?;
    idle.next().is_none().then_some(law)
}

fn unknown_function(declaration: &Declaration, name: &str) -> String {
    if CONSTANTS.contains(&name)
        || declared(declaration)
            .iter()
            .any(|(_, other)| *other == name)
    {
        return format!("`{name}` is not a function: write a star, `{name}*(...)`");
    }
    // Functions of their own, not misspelt ones.
    let instead = match name {
        "sinh" => "write `(exp(x) - exp(-x))/2`",
        "cosh" => "write `(exp(x) + exp(-x))/2`",
        "tan" => "write `sin(x)/cos(x)`",
        "cbrt" => "write `x^(1/3)`",
        "pow" | "powf" | "powi" => "write `x^n`",
        _ => "",
    };
    if !instead.is_empty() {
        return format!("unknown function `{name}`: {instead}");
    }
    if let Some(law) = renamed(declaration) {
        return format!(
            "unknown function `{name}`: did you mean the law `{law}`, which is never called?"
        );
    }
    let advice = match name {
        "sign" | "signum" => Some("sgn".to_owned()),
        "heaviside" | "step" | "Heaviside" => Some("H".to_owned()),
        "diff" | "d" => Some("dot".to_owned()),
        "maximum" => Some("max".to_owned()),
        "minimum" => Some("min".to_owned()),
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
