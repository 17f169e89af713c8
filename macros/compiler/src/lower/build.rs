//! Terms, calls and found forces to laws and coefficients.

use std::collections::HashMap;

use crate::ast::Declaration;
use crate::dag::{Id, Variable};
use crate::errors::Extent;
use crate::ir;

use super::assemble::{self, Action, Assembly};
use super::expand::{Call, Expander};
use super::found::Found;
use super::law::{self, Lowered};
use super::rules::forcing;
use super::term::{Motion, Term};
use super::wave::Wave;

/// Collects what [`Assembly`] is made of.
pub struct Builder {
    /// What expressions mean.
    pub context: Expander,
    /// Distinct laws.
    pub laws: Vec<ir::Law>,
    actions: Vec<(Action, Extent)>,
    terms: Vec<(usize, Term)>,
}

/// What a call of a law comes to.
pub enum Called {
    /// A law that is linear everywhere, multiplied out.
    Linear(Vec<Term>),
    /// A contact of a law.
    Law {
        /// Index among the laws of the model.
        law: usize,
        /// All of its arguments.
        arguments: Vec<Id>,
        /// Its gap.
        gap: Vec<Term>,
    },
}

impl Builder {
    /// Nothing yet.
    pub fn new(context: Expander) -> Self {
        Self {
            context,
            laws: Vec::new(),
            actions: Vec::new(),
            terms: Vec::new(),
        }
    }

    /// Adds a term that is a call of a law or linear.
    pub fn term(&mut self, row: usize, term: Term, laws: &[Option<Lowered>]) -> syn::Result<()> {
        let Motion::Call(call) = term.motion else {
            self.linear(row, term);
            return Ok(());
        };
        match self.called(&term, call, laws)? {
            None => {}
            Some(Called::Linear(products)) => {
                for product in products {
                    self.linear(row, product);
                }
            }
            Some(Called::Law {
                law,
                arguments,
                gap,
            }) => {
                let action = Action {
                    law,
                    gap,
                    arguments,
                    row,
                    factor: term.coefficient,
                    wave: term.wave,
                };
                self.actions.push((action, term.extent));
            }
        }
        Ok(())
    }

    /// What a term with a call of a law comes to; nothing where the law was refused.
    pub fn called(
        &mut self,
        term: &Term,
        call: usize,
        laws: &[Option<Lowered>],
    ) -> syn::Result<Option<Called>> {
        let Call {
            law,
            gap,
            mut arguments,
        } = self.context.calls[call].clone();
        let Some(Some(lowered)) = laws.get(law) else {
            return Ok(None);
        };
        let written: HashMap<Variable, Id> = numbered(&arguments);
        for &captured in &lowered.captured {
            arguments.push(self.context.dag.substitute(captured, &written));
        }
        if let Some(parts) = law::linear(&mut self.context.dag, &lowered.law) {
            let products = self.linear_law(term, &gap, &arguments, parts)?;
            return Ok(Some(Called::Linear(products)));
        }
        let law = intern(&mut self.laws, lowered.law.clone());
        Ok(Some(Called::Law {
            law,
            arguments,
            gap,
        }))
    }

    /// A law that is linear everywhere is multiplied out.
    fn linear_law(
        &mut self,
        term: &Term,
        gap: &[Term],
        arguments: &[Id],
        parts: [Id; 3],
    ) -> syn::Result<Vec<Term>> {
        let by = numbered(arguments);
        let one = self.context.dag.integer(1);
        let rate = self.context.rate(gap, term.extent)?;
        let unit = vec![Term::constant(one, term.extent)];
        let mut products = Vec::new();
        for (part, motion) in parts.into_iter().zip([gap.to_vec(), rate, unit]) {
            let factor = self.context.dag.substitute(part, &by);
            let factor = Term {
                motion: Motion::None,
                ..term.scaled(&mut self.context.dag, factor)
            };
            products.extend(self.context.multiply(&[factor], &motion, term.extent)?);
        }
        Ok(products)
    }

    /// Adds a linear term. Damping that varies with time has no matrix to stand in: it is a law, linear in its rate.
    fn linear(&mut self, row: usize, term: Term) {
        let Motion::Linear(Variable::Velocity(column)) = term.motion else {
            self.terms.push((row, term));
            return;
        };
        if term.is_steady() {
            self.terms.push((row, term));
            return;
        }
        let damper = ir::Law {
            name: "damper".to_owned(),
            arguments: Vec::new(),
            ranges: Vec::new(),
            levels: Vec::new(),
            pieces: vec![self.context.dag.variable(Variable::Rate)],
        };
        let law = intern(&mut self.laws, damper);
        let gap = self.coordinate(column, term.extent);
        let action = Action {
            law,
            gap: vec![gap],
            arguments: Vec::new(),
            row,
            factor: term.coefficient,
            wave: term.wave,
        };
        self.actions.push((action, term.extent));
    }

    fn coordinate(&mut self, index: usize, extent: Extent) -> Term {
        let one = self.context.dag.integer(1);
        Term {
            motion: Motion::Linear(Variable::Coordinate(index)),
            ..Term::constant(one, extent)
        }
    }

    pub fn found(&mut self, found: Found) {
        let arguments = found.lowered.captured;
        let law = intern(&mut self.laws, found.lowered.law);
        let extent = found.extent;
        let gap: Vec<Term> = found
            .direction
            .iter()
            .map(|&(index, factor)| Term {
                coefficient: factor,
                ..self.coordinate(index, extent)
            })
            .collect();
        for (row, wave, factor) in found.rows {
            let action = Action {
                law,
                gap: gap.clone(),
                arguments: arguments.clone(),
                row,
                factor,
                wave,
            };
            self.actions.push((action, extent));
        }
    }

    pub fn assemble(&mut self, declaration: &Declaration) -> syn::Result<Assembly> {
        let mut waves: Vec<Wave> = self.terms.iter().map(|(_, term)| term.wave).collect();
        for (action, _) in &self.actions {
            waves.push(action.wave);
            waves.extend(action.gap.iter().map(|term| term.wave));
        }
        let extent = super::all_equations(declaration);
        let divisor = assemble::divisor(waves.iter()).map_err(|message| extent.fault(message))?;
        let mut assembly = Assembly::new(divisor);
        let dag = &mut self.context.dag;
        for (row, term) in &self.terms {
            forcing::mass_is_constant(term)?;
            assembly.linear(dag, *row, term);
        }
        for (action, _) in &self.actions {
            assembly.force(dag, action);
        }
        assembly.drop_zeros(dag);
        Ok(assembly)
    }
}

/// Values of the arguments of a law, by position.
fn numbered(arguments: &[Id]) -> HashMap<Variable, Id> {
    let numbered = |(index, &value): (usize, &Id)| (Variable::Argument(index), value);
    arguments.iter().enumerate().map(numbered).collect()
}

/// Adds a law unless an equal one is there already; its index.
fn intern(laws: &mut Vec<ir::Law>, law: ir::Law) -> usize {
    let same = |other: &ir::Law| {
        let levels = |law: &ir::Law| -> Vec<(Id, bool)> {
            law.levels
                .iter()
                .map(|level| (level.value, level.belongs_above))
                .collect()
        };
        other.arguments == law.arguments
            && other.pieces == law.pieces
            && levels(other) == levels(&law)
    };
    laws.iter().position(same).unwrap_or_else(|| {
        laws.push(law);
        laws.len() - 1
    })
}
