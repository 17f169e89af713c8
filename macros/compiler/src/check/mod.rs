//! What a declaration must fulfil. One rule is one function, its sentence is its first line of documentation, and each has a
//! case in `tests/tests/compile_fail`.
//!
//! These are the rules on what is written. The others need the lowered expressions, and are in `lower/rules`.

mod calls;
mod expressions;
mod loops;
mod names;
mod outputs;
mod units;
mod used;

pub(crate) use names::{MOST_DECLARED, is_primitive};
pub(crate) use units::Units;

use crate::ast::{Declaration, Equation, Expr, Kind, Let, Parameter, Statement};
use crate::errors::{Diagnostics, Extent};

/// Applies the rules on what is written. Returns the units of what is measured.
pub fn check(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Units {
    if !names::names_are_few(declaration, diagnostics) {
        return Units::default();
    }
    names::names_are_free_in_generated_code(declaration, diagnostics);
    names::names_are_not_built_in(declaration, diagnostics);
    names::names_are_distinct(declaration, diagnostics);
    names::names_are_known(declaration, diagnostics);
    calls::calls_are_of_known_functions(declaration, diagnostics);
    outputs::forces_are_of_laws_in_the_equations(declaration, diagnostics);
    // A misspelt name would be reported a second time, as the right one not being used.
    if diagnostics.is_clean() {
        used::everything_is_used(declaration, diagnostics);
    }
    ranges_are_not_empty(declaration, diagnostics);
    defaults_are_in_range(declaration, diagnostics);
    if !loops::coordinates_are_few(declaration, diagnostics) {
        return Units::default();
    }
    if let Some(equations) = loops::loops_end_soon(declaration, diagnostics) {
        there_is_one_equation_per_coordinate(declaration, &equations, diagnostics);
        every_equation_holds_an_acceleration(declaration, &equations, diagnostics);
    }
    if diagnostics.is_clean() {
        return units::units_agree(declaration, diagnostics);
    }
    Units::default()
}

/// A range admits at least one value.
fn ranges_are_not_empty(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    for parameter in &declaration.parameters {
        let (Some(minimum), Some(maximum)) = (parameter.minimum, parameter.maximum) else {
            continue;
        };
        if is_empty(parameter) {
            let message = format!(
                "no value of `{}` lies in this range: write the smaller end first, as in `{}..={}`",
                parameter.name,
                minimum.value.min(maximum.value),
                minimum.value.max(maximum.value)
            );
            diagnostics.report(parameter.range, message);
        }
    }
}

fn is_empty(parameter: &Parameter) -> bool {
    let (Some(minimum), Some(maximum)) = (parameter.minimum, parameter.maximum) else {
        return false;
    };
    let touching = minimum.value == maximum.value && minimum.included && maximum.included;
    minimum.value >= maximum.value && !touching
}

/// A default lies in its range, where the range has values.
fn defaults_are_in_range(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    for parameter in declaration.parameters.iter().filter(|p| !is_empty(p)) {
        let Some((value, extent)) = parameter.default else {
            continue;
        };
        let below = parameter
            .minimum
            .is_some_and(|end| value < end.value || (value == end.value && !end.included));
        let above = parameter
            .maximum
            .is_some_and(|end| value > end.value || (value == end.value && !end.included));
        if below || above {
            let message = format!(
                "the default of `{}` lies outside of its range: change one of them",
                parameter.name
            );
            diagnostics.report(extent, message);
        }
    }
}

/// There are as many equations as coordinates.
fn there_is_one_equation_per_coordinate(
    declaration: &Declaration,
    equations: &[&Equation],
    diagnostics: &mut Diagnostics,
) {
    let coordinates: Vec<_> = declaration.elements().collect();
    if let Some((coordinate, name)) = coordinates.get(equations.len()) {
        let message = format!(
            "coordinate `{coordinate}` has no equation: {} declared, {} given; add one such as `ddot({coordinate}) + {coordinate} = 0;`",
            counted(coordinates.len(), "coordinate"),
            counted(equations.len(), "equation"),
        );
        diagnostics.report(Extent::at(name.span()), message);
    }
    if let Some(equation) = equations.get(coordinates.len()) {
        let message = format!(
            "one equation too many: the model has {}, and each has one equation",
            counted(coordinates.len(), "coordinate"),
        );
        diagnostics.report(equation.left.extent.to(equation.right.extent), message);
    }
}

/// Every equation of motion holds a second derivative.
fn every_equation_holds_an_acceleration(
    declaration: &Declaration,
    equations: &[&Equation],
    diagnostics: &mut Diagnostics,
) {
    let coordinates: Vec<_> = declaration.elements().collect();
    if equations.len() != coordinates.len() {
        return;
    }
    let mut accelerations: Vec<String> = Vec::new();
    let mut note = |item: &Let| {
        if holds_acceleration(&item.value, &accelerations) {
            accelerations.push(item.name.to_string());
        }
    };
    declaration.lets.iter().for_each(&mut note);
    for statement in &declaration.equations {
        lets_of(statement, &mut note);
    }
    let mut reported: Option<&Equation> = None;
    for (&equation, (coordinate, _)) in equations.iter().zip(&coordinates) {
        let found = holds_acceleration(&equation.left, &accelerations)
            || holds_acceleration(&equation.right, &accelerations);
        if !found && !reported.is_some_and(|other| std::ptr::eq(other, equation)) {
            let message = format!(
                "no second derivative in this equation: an equation of motion holds inertia, as in `ddot({coordinate}) + ... = ...`"
            );
            diagnostics.report(equation.left.extent.to(equation.right.extent), message);
            reported = Some(equation);
        }
    }
}

/// The `let` items of loops of equations.
fn lets_of(statement: &Statement, note: &mut dyn FnMut(&Let)) {
    if let Statement::Loop(repeated) = statement {
        repeated.lets.iter().for_each(&mut *note);
        for statement in &repeated.body {
            lets_of(statement, note);
        }
    }
}

fn holds_acceleration(expression: &Expr, accelerations: &[String]) -> bool {
    let mut found = false;
    expression.walk(&mut |part| {
        found |= match &part.kind {
            Kind::Call(name, _) => name == "ddot",
            Kind::Name(name) => accelerations.contains(&name.to_string()),
            _ => false,
        };
    });
    found
}

/// A number of things, in words that fit it.
fn counted(count: usize, thing: &str) -> String {
    if count == 1 {
        format!("1 {thing}")
    } else {
        format!("{count} {thing}s")
    }
}
