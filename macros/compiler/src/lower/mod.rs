//! [`Declaration`] to [`Model`]: equations are multiplied out, linear terms become coefficients, the rest laws.

mod assemble;
mod build;
mod calls;
mod found;
mod functions;
mod gaps;
mod law;
mod outputs;
mod polynomial;
mod repeat;
mod rules;

mod algebra;
mod expand;
mod interval;
mod resolve;
mod term;
mod wave;
mod written;

use hertzian_contract::system::Bound;

use crate::ast::{Declaration, Equation, Expr, Kind, Limit, Statement};
use crate::check::Units;
use crate::dag::{Dag, Id, Variable};
use crate::errors::{Diagnostics, Extent};
use crate::index::Constants;
use crate::ir::{self, Model};

use self::build::Builder;
use self::expand::{Expander, Meaning};
use self::found::Gatherer;
use self::interval::{Interval, Stretch};
use self::law::Lowered;
use self::rules::{forcing, inertia};
use self::term::{Term, collect};

/// What an equation with a few contacts is multiplied out to.
const TERMS_PER_COORDINATE: usize = 512;

/// Operands that are read and written before a declaration is given up: less than a second, and several hundred times what any
/// of the examples takes.
pub(crate) const BUDGET: u64 = 3_000_000;

/// Lowers a declaration that has passed [`check`](crate::check::check), which gives its units. `None` if something was reported.
pub fn lower(
    declaration: &Declaration,
    units: Units,
    diagnostics: &mut Diagnostics,
) -> Option<Model> {
    let parameters = parameters(declaration, &units);
    let mut context = context(declaration, &parameters);
    context.dag.set_budget(Some(BUDGET));
    let mut builder = Builder::new(context);
    let model = lowered(declaration, parameters, units, &mut builder, diagnostics);
    let context = &mut builder.context;
    if context.dag.is_spent() {
        // What was found since then, and what was built, is worth nothing.
        let place = context
            .spent_at
            .unwrap_or_else(|| all_equations(declaration));
        diagnostics.only(expand::too_long(place));
        return None;
    }
    let mut model = model?;
    model.dag = std::mem::take(&mut context.dag);
    model.dag.set_budget(None);
    Some(model)
}

/// The fault of a declaration that multiplies out to more than can be handled.
pub(crate) fn too_long(declaration: &Declaration) -> syn::Error {
    expand::too_long(all_equations(declaration))
}

fn lowered(
    declaration: &Declaration,
    parameters: Vec<ir::Parameter>,
    units: Units,
    builder: &mut Builder,
    diagnostics: &mut Diagnostics,
) -> Option<Model> {
    let context = &mut builder.context;
    for item in &declaration.lets {
        let terms = diagnostics.keep(context.expand(&item.value))?;
        context
            .names
            .insert(item.name.to_string(), Meaning::Value(terms));
    }
    let mut gatherer = Gatherer::default();
    let mut rows = Rows::default();
    for statement in &declaration.equations {
        rows.statement(context, statement, &mut gatherer, diagnostics);
    }
    let laws = declared_laws(context, declaration, diagnostics);
    let found = gatherer.laws(context, diagnostics);
    if !diagnostics.is_clean() {
        return None;
    }
    for (row, term) in rows.terms {
        diagnostics.keep(builder.term(row, term, &laws));
    }
    for law in found {
        builder.found(law);
    }
    let mut assembly = diagnostics.keep(builder.assemble(declaration))?;
    let outputs = outputs::outputs(
        builder,
        declaration,
        &units.outputs,
        &laws,
        &mut assembly,
        diagnostics,
    );
    for contact in &mut assembly.contacts {
        let unit = units.laws.get(&builder.laws[contact.law].name);
        contact.unit = unit.cloned().unwrap_or_default().into();
    }
    let masses = assembly.masses();
    let ranges = &builder.context.ranges.parameters;
    let dag = &builder.context.dag;
    diagnostics.keep(inertia::mass_is_regular(declaration, dag, &masses, ranges))?;
    inertia::ranges_admit_no_singular_mass(declaration, dag, &masses, ranges, diagnostics);
    let (dag, ranges) = (&mut builder.context.dag, &builder.context.ranges);
    inertia::masses_are_positive(declaration, dag, &masses, ranges, diagnostics);
    Some(Model {
        dag: Dag::default(),
        visibility: declaration.visibility.clone(),
        name: declaration.name.clone(),
        documentation: declaration.documentation.clone(),
        equation: written(declaration),
        coordinates: declaration.elements().map(|(name, _)| name).collect(),
        units: units.coordinates,
        parameters,
        divisor: assembly.divisor,
        laws: std::mem::take(&mut builder.laws),
        contacts: assembly.contacts,
        coefficients: assembly.coefficients,
        outputs,
    })
}

/// The equations as written, and the constants and laws that are in them.
fn written(declaration: &Declaration) -> String {
    let equations = declaration.equations.iter().map(ToString::to_string);
    let lets = declaration.lets.iter().map(ToString::to_string);
    let laws = declaration.laws.iter().map(ToString::to_string);
    let lines: Vec<String> = equations.chain(lets).chain(laws).collect();
    lines.join("\n")
}

/// The declared parameters.
pub fn parameters(declaration: &Declaration, units: &Units) -> Vec<ir::Parameter> {
    let bound = |limit: Option<Limit>| match limit {
        None => Bound::Unbounded,
        Some(Limit {
            value,
            included: true,
        }) => Bound::Included(value),
        Some(Limit {
            value,
            included: false,
        }) => Bound::Excluded(value),
    };
    let lowered = |(index, parameter): (usize, &crate::ast::Parameter)| ir::Parameter {
        name: parameter.name.clone(),
        documentation: parameter.documentation.trim_end().to_owned(),
        unit: units.parameters.get(index).cloned().unwrap_or_default(),
        minimum: bound(parameter.minimum),
        maximum: bound(parameter.maximum),
        default: parameter.default.map(|(value, _)| value),
    };
    let parameters = declaration.parameters.iter().enumerate();
    parameters.map(lowered).collect()
}

fn context(declaration: &Declaration, parameters: &[ir::Parameter]) -> Expander {
    let mut context = Expander::default();
    context.form = declaration.form;
    for (index, parameter) in parameters.iter().enumerate() {
        let name = parameter.name.to_string();
        context
            .names
            .insert(name.clone(), Meaning::Constant(Variable::Parameter(index)));
        context.parameters.push(name);
        context
            .ranges
            .parameters
            .push(Interval::of_range(parameter.minimum, parameter.maximum));
    }
    for coordinate in &declaration.coordinates {
        let first = context.coordinates.len();
        let meaning = match coordinate.count {
            Some(count) => Meaning::Array(first, count),
            None => Meaning::Coordinate(first),
        };
        context.names.insert(coordinate.name.to_string(), meaning);
        let count = first + coordinate.size();
        let names = declaration.elements().map(|(name, _)| name);
        context.coordinates.extend(names.take(count).skip(first));
    }
    context.constants = Constants::of(&declaration.lets);
    context.allowance = TERMS_PER_COORDINATE * context.coordinates.len();
    context.laws = declaration
        .laws
        .iter()
        .enumerate()
        .map(|(index, law)| (law.name.to_string(), index))
        .collect();
    context
}

/// The terms of all equations, but for the nonlinear ones.
#[derive(Default)]
struct Rows {
    count: usize,
    terms: Vec<(usize, Term)>,
}

impl Rows {
    /// Adds an equation, or a loop of them. A loop ends with the first index that is at fault, so that no fault is
    /// reported once for each.
    fn statement(
        &mut self,
        context: &mut Expander,
        statement: &Statement,
        gatherer: &mut Gatherer,
        diagnostics: &mut Diagnostics,
    ) {
        let repeated = match statement {
            Statement::Equation(equation) => {
                let row = self.count;
                let terms = equation_terms(context, row, equation, gatherer, diagnostics);
                self.terms.extend(terms.into_iter().map(|term| (row, term)));
                self.count += 1;
                return;
            }
            Statement::Loop(repeated) => repeated,
        };
        let faults = diagnostics.count();
        let written = context.written.len();
        let result = context.repeat(repeated, |context| {
            for statement in &repeated.body {
                if diagnostics.count() == faults {
                    self.statement(context, statement, gatherer, diagnostics);
                }
            }
            context.written.truncate(written);
            Ok(())
        });
        diagnostics.keep(result);
    }
}

/// All terms of an equation, brought to the left, except for nonlinear ones, which are gathered.
fn equation_terms(
    context: &mut Expander,
    row: usize,
    equation: &Equation,
    gatherer: &mut Gatherer,
    diagnostics: &mut Diagnostics,
) -> Vec<Term> {
    let mut terms = Vec::new();
    // What is written in `let` items is kept, what is in the terms before is not.
    let known = context.written.len();
    for (side, on_right) in [(&equation.left, false), (&equation.right, true)] {
        for (minus, part) in addends(side) {
            context.written.truncate(known);
            let Some(expanded) = diagnostics.keep(context.expand(part)) else {
                continue;
            };
            for term in collect(&mut context.dag, expanded) {
                let extent = part.extent;
                let term = Term { extent, ..term };
                let term = if minus == on_right {
                    term
                } else {
                    term.negated(&mut context.dag)
                };
                let added = forcing::term_is_in_its_place(&term, on_right)
                    .and_then(|()| forcing::term_is_harmonic(&term))
                    .and_then(|()| gatherer.add(context, row, &term, part));
                // The rest of what is written here would have the same fault.
                let Some(added) = diagnostics.keep(added) else {
                    break;
                };
                terms.extend(added);
            }
        }
    }
    terms
}

/// The terms of one side as written, so that a fault in one does not hide a fault in another.
fn addends(side: &Expr) -> Vec<(bool, &Expr)> {
    match &side.kind {
        Kind::Sum(parts) => parts.iter().map(|(minus, part)| (*minus, part)).collect(),
        _ => vec![(false, side)],
    }
}

fn declared_laws(
    context: &mut Expander,
    declaration: &Declaration,
    diagnostics: &mut Diagnostics,
) -> Vec<Option<Lowered>> {
    let mut laws = Vec::new();
    for (index, law) in declaration.laws.iter().enumerate() {
        let calls: Vec<Vec<Id>> = context
            .calls
            .iter()
            .filter(|call| call.law == index)
            .map(|call| call.arguments.clone())
            .collect();
        let mut ranges = Vec::new();
        for argument in 0..law.arguments.len() {
            let mut range: Option<Interval> = None;
            for value in calls.iter().filter_map(|call| call.get(argument)) {
                let bounds = context
                    .ranges
                    .bounds(&mut context.dag, *value, Stretch::ALL);
                range = Some(range.map_or(bounds, |range| range.hull(bounds)));
            }
            ranges.push(range.unwrap_or(Interval::ALL));
        }
        laws.push(law::declared(context, law, ranges, diagnostics));
    }
    laws
}

/// From the first equation to the last.
pub fn all_equations(declaration: &Declaration) -> Extent {
    let equations: Vec<&Equation> = declaration
        .equations
        .iter()
        .flat_map(Statement::equations)
        .collect();
    match (equations.first(), equations.last()) {
        (Some(first), Some(last)) => first.left.extent.to(last.right.extent),
        _ => Extent::at(declaration.name.span()),
    }
}
