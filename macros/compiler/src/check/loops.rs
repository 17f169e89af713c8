//! Rules on loops.

use crate::ast::{Declaration, Equation, Expr, Kind, Loop, Statement};
use crate::errors::{Diagnostics, Extent};
use crate::index::Constants;

use super::expressions;

/// More coordinates than a model that is written out has.
const MOST_COORDINATES: usize = 1024;

/// More repetitions, all loops taken together, than compile in good time.
const MOST_REPETITIONS: usize = 4096;

/// More operations, all loops written out, than compile in good time.
const MOST_OPERATIONS: usize = 1 << 18;

/// The arrays of coordinates are of a size that can be compiled.
pub(super) fn coordinates_are_few(
    declaration: &Declaration,
    diagnostics: &mut Diagnostics,
) -> bool {
    let mut count: usize = 0;
    for coordinate in &declaration.coordinates {
        count = count.saturating_add(coordinate.size());
        if count > MOST_COORDINATES {
            let message = format!(
                "more than {MOST_COORDINATES} coordinates: every one is compiled to code of its own; make the array smaller"
            );
            diagnostics.report(Extent::at(coordinate.name.span()), message);
            return false;
        }
    }
    true
}

/// Loops run over known whole numbers, and not for too long. The equations are returned, once for each repetition.
pub(super) fn loops_end_soon<'a>(
    declaration: &'a Declaration,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<&'a Equation>> {
    let mut unroller = Unroller {
        constants: Constants::of(&declaration.lets),
        repetitions: 0,
        operations: 0,
        equations: Vec::new(),
    };
    let before = diagnostics.count();
    for item in &declaration.lets {
        diagnostics.keep(unroller.expression(&item.value));
    }
    for force in expressions::of_laws(declaration) {
        diagnostics.keep(unroller.expression(force));
    }
    for statement in &declaration.equations {
        diagnostics.keep(unroller.statement(statement));
    }
    for output in &declaration.outputs {
        diagnostics.keep(unroller.expression(&output.value));
    }
    (diagnostics.count() == before).then_some(unroller.equations)
}

struct Unroller<'a> {
    constants: Constants,
    repetitions: usize,
    operations: usize,
    equations: Vec<&'a Equation>,
}

impl<'a> Unroller<'a> {
    fn statement(&mut self, statement: &'a Statement) -> syn::Result<()> {
        match statement {
            Statement::Equation(equation) => {
                self.equations.push(equation);
                self.expression(&equation.left)?;
                self.expression(&equation.right)
            }
            Statement::Loop(repeated) => self.repeat(repeated, |unroller| {
                repeated
                    .body
                    .iter()
                    .try_for_each(|statement| unroller.statement(statement))
            }),
        }
    }

    fn expression(&mut self, expression: &Expr) -> syn::Result<()> {
        self.operations += 1;
        if self.operations > MOST_OPERATIONS {
            return Err(expression.extent.fault(format!(
                "more than {MOST_OPERATIONS} numbers, names and operations, with all loops written out: make the ranges smaller"
            )));
        }
        if let Kind::Sigma(repeated) = &expression.kind {
            return self.repeat(repeated, |unroller| unroller.expression(&repeated.body));
        }
        expression
            .operands()
            .into_iter()
            .try_for_each(|operand| self.expression(operand))
    }

    fn repeat<T>(
        &mut self,
        repeated: &Loop<T>,
        mut body: impl FnMut(&mut Self) -> syn::Result<()>,
    ) -> syn::Result<()> {
        for index in self.constants.range(repeated)? {
            self.repetitions += 1;
            if self.repetitions > MOST_REPETITIONS {
                let place = repeated.start.extent.to(repeated.end.extent);
                return Err(place.fault(format!(
                    "more than {MOST_REPETITIONS} repetitions, all loops taken together: loops are written out while compiling; make the range smaller"
                )));
            }
            self.constants.set(repeated, index);
            for item in &repeated.lets {
                self.expression(&item.value)?;
                self.constants.name(item);
            }
            body(self)?;
        }
        self.constants.leave(repeated);
        Ok(())
    }
}
