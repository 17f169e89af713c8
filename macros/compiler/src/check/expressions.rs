//! Every expression of a declaration, with the names it may use.

use crate::ast::{Condition, Declaration, Expr, Kind, Law, Loop, Scope, Statement};

/// Where an expression stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Where<'a, 'b> {
    /// The law it stands in.
    pub law: Option<&'a Law>,
    /// How many of the `let` items come before it.
    pub lets: usize,
    /// The names of the loops around it.
    pub loops: &'b Scope<'a>,
}

/// The expressions in laws.
pub(super) fn of_laws(declaration: &Declaration) -> impl Iterator<Item = &Expr> {
    declaration.laws.iter().flat_map(of_law)
}

/// The expressions in one law.
pub(super) fn of_law(law: &Law) -> impl Iterator<Item = &Expr> {
    law.pieces.iter().flat_map(|piece| {
        let comparisons = match &piece.condition {
            Condition::All(comparisons, _) => comparisons.as_slice(),
            _ => &[],
        };
        comparisons
            .iter()
            .flat_map(|comparison| [&comparison.smaller, &comparison.larger])
            .chain(std::iter::once(&piece.force))
    })
}

/// Every expression, and every part of it.
pub(super) fn parts<'a>(
    declaration: &'a Declaration,
    visit: &mut dyn FnMut(&'a Expr, Where<'a, '_>),
) {
    let outermost = Scope::new();
    for (lets, item) in declaration.lets.iter().enumerate() {
        item.value.walk_in(&outermost, &mut |part, loops| {
            visit(
                part,
                Where {
                    law: None,
                    lets,
                    loops,
                },
            );
        });
    }
    let lets = declaration.lets.len();
    for law in &declaration.laws {
        for expression in of_law(law) {
            expression.walk_in(&outermost, &mut |part, loops| {
                visit(
                    part,
                    Where {
                        law: Some(law),
                        lets,
                        loops,
                    },
                );
            });
        }
    }
    let mut visit = |part: &'a Expr, loops: &Scope<'a>| {
        let law = None;
        visit(part, Where { law, lets, loops });
    };
    for statement in &declaration.equations {
        statement.walk_in(&outermost, &mut visit);
    }
    for output in &declaration.outputs {
        output.value.walk_in(&outermost, &mut visit);
    }
}

/// The names that loops declare, each with the law it stands in and the names of the loops around.
pub(super) fn loops<'a>(
    declaration: &'a Declaration,
    visit: &mut dyn FnMut(Option<&'a Law>, &Scope<'a>, Scope<'a>),
) {
    parts(declaration, &mut |part, at| {
        if let Kind::Sigma(repeated) = &part.kind {
            visit(at.law, at.loops, names(repeated));
        }
    });
    for statement in &declaration.equations {
        of_statement(statement, &Scope::new(), visit);
    }
}

fn of_statement<'a>(
    statement: &'a Statement,
    around: &Scope<'a>,
    visit: &mut dyn FnMut(Option<&'a Law>, &Scope<'a>, Scope<'a>),
) {
    let Statement::Loop(repeated) = statement else {
        return;
    };
    let own = names(repeated);
    let inner = around.iter().chain(&own).copied().collect();
    visit(None, around, own);
    for statement in &repeated.body {
        of_statement(statement, &inner, visit);
    }
}

fn names<T>(repeated: &Loop<T>) -> Scope<'_> {
    let lets = repeated.lets.iter().map(|item| ("`let`", &item.name));
    std::iter::once(("index", &repeated.index))
        .chain(lets)
        .collect()
}
