//! Rules on what is declared and not used.

use std::collections::HashSet;

use super::expressions;
use super::names::{declared, local, plain};
use crate::ast::{Declaration, Kind, Law};
use crate::errors::{Diagnostics, Extent};

/// Every parameter, law, `let`, coordinate and law argument is used.
pub(super) fn everything_is_used(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let mut used: HashSet<String> = HashSet::new();
    expressions::parts(declaration, &mut |part, _| {
        if let Kind::Name(name) | Kind::Call(name, _) | Kind::Element(name, _) = &part.kind {
            used.insert(name.to_string());
        }
    });
    expressions::loops(declaration, &mut |_, _, own| {
        for (what, name) in own {
            if !used.contains(&name.to_string()) {
                let advice = if what == "index" {
                    "write a factor instead of the loop"
                } else {
                    "remove it"
                };
                let message = format!(
                    "{} `{name}` of this loop is never used: {advice}",
                    plain(what)
                );
                diagnostics.report(Extent::at(name.span()), message);
            }
        }
    });
    for (what, name) in declared(declaration) {
        let advice = match what {
            "parameter" => "remove it, or use it in a law or an equation",
            "argument" => "remove it, or use it in a piece",
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
    for expression in expressions::of_law(law) {
        expression.walk(&mut |part| {
            if let Kind::Name(name) = &part.kind {
                used.insert(name.to_string());
            }
        });
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
