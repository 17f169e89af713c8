//! Rules on outputs.

use std::collections::HashSet;

use crate::ast::{Declaration, Expr, Kind, Scope};
use crate::errors::{Diagnostics, nearest};

/// The force in an output is that of a law which acts in the equations.
pub(super) fn forces_are_of_laws_in_the_equations(
    declaration: &Declaration,
    diagnostics: &mut Diagnostics,
) {
    let acting = acting(declaration);
    for output in &declaration.outputs {
        output.value.walk(&mut |part| {
            let Kind::Force(law) = &part.kind else {
                return;
            };
            let name = law.to_string();
            let laws = || declaration.laws.iter().map(|law| law.name.to_string());
            if acting.contains(&name) {
                return;
            }
            let message = if laws().any(|known| known == name) {
                format!("law `{name}` acts in no equation, so it has no force to be read")
            } else {
                let known: Vec<String> = laws().collect();
                let advice = match nearest(&name, known.iter().map(String::as_str)) {
                    Some(meant) => format!("did you mean `force({meant})`?"),
                    None => "`force` in an output takes the name of a law, as in `force(contact)`"
                        .to_owned(),
                };
                format!("there is no law `{name}`: {advice}")
            };
            diagnostics.report(part.extent, message);
        });
    }
}

/// The names of what is called in equations, and in the `let` items that they may use.
fn acting(declaration: &Declaration) -> HashSet<String> {
    let mut called = HashSet::new();
    let mut visit = |part: &Expr, _: &Scope<'_>| {
        if let Kind::Call(name, _) = &part.kind {
            called.insert(name.to_string());
        }
    };
    let outermost = Scope::new();
    for item in &declaration.lets {
        item.value.walk_in(&outermost, &mut visit);
    }
    for statement in &declaration.equations {
        statement.walk_in(&outermost, &mut visit);
    }
    called
}
