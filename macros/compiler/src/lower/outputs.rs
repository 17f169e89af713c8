//! Outputs to coefficients with places: equation (4) of the contract.

use std::collections::BTreeSet;

use hertzian_contract::system::Signal;

use crate::ast::{Declaration, Kind, Output};
use crate::dag::{Rational, Variable};
use crate::errors::{Diagnostics, Extent};
use crate::ir;

use super::assemble::Assembly;
use super::build::{Builder, Called};
use super::law::Lowered;
use super::rules::{forcing, outputs as rules};
use super::term::{Motion, Term, collect};

/// Adds the coefficients of all outputs, each in its unit: its text, and a power of ten.
pub fn outputs(
    builder: &mut Builder,
    declaration: &Declaration,
    units: &[(String, Rational)],
    laws: &[Option<Lowered>],
    assembly: &mut Assembly,
    diagnostics: &mut Diagnostics,
) -> Vec<ir::Output> {
    let calls = builder.context.calls.len();
    let mut lowered = Vec::new();
    for (index, output) in declaration.outputs.iter().enumerate() {
        let unit = units.get(index).cloned();
        let (unit, ten) = unit.unwrap_or((String::new(), Rational::ZERO));
        let mut reader = Reader {
            builder,
            laws,
            assembly,
            calls,
            index,
        };
        diagnostics.keep(reader.output(output, ten));
        lowered.push(ir::Output {
            name: output.name.to_string(),
            documentation: output.documentation.trim_end().to_owned(),
            unit,
            written: output.value.to_string(),
        });
    }
    lowered
}

/// Takes one output apart.
struct Reader<'r> {
    builder: &'r mut Builder,
    laws: &'r [Option<Lowered>],
    assembly: &'r mut Assembly,
    /// How many calls of laws are in the equations.
    calls: usize,
    index: usize,
}

impl Reader<'_> {
    /// Adds an output, multiplied by a power of ten.
    fn output(&mut self, output: &Output, ten: Rational) -> syn::Result<()> {
        self.forces_are_of_one_contact(output)?;
        let context = &mut self.builder.context;
        let terms = context.expand(&output.value)?;
        let terms = collect(&mut context.dag, terms);
        rules::output_moves(output, &terms)?;
        let factor = context.dag.integer(10);
        let exponent = context.dag.number(ten);
        let factor = context.dag.power(factor, exponent);
        for term in terms {
            rules::output_is_linear(&term)?;
            forcing::term_is_harmonic(&term)?;
            let term = term.scaled(&mut self.builder.context.dag, factor);
            self.term(term)?;
        }
        Ok(())
    }

    fn term(&mut self, term: Term) -> syn::Result<()> {
        let of = match term.motion {
            Motion::Linear(Variable::Coordinate(index)) => Signal::Coordinate(index),
            Motion::Linear(Variable::Velocity(index)) => Signal::Rate(index),
            Motion::Linear(Variable::Acceleration(index)) => Signal::Acceleration(index),
            Motion::Call(call) => match self.builder.called(&term, call, self.laws)? {
                None => return Ok(()),
                Some(Called::Linear(products)) => {
                    return products.into_iter().try_for_each(|term| self.term(term));
                }
                Some(Called::Law {
                    law,
                    arguments,
                    gap,
                }) => {
                    let contact = self.assembly.contact_of(law, &arguments, &gap);
                    Signal::Force(rules::call_is_in_the_equations(contact, term.extent)?)
                }
            },
            _ => Signal::Constant,
        };
        let dag = &mut self.builder.context.dag;
        let whole = self.assembly.output(dag, self.index, of, &term);
        rules::output_has_the_period(whole, term.extent)
    }

    /// Looks at each `force(law)` of an output.
    fn forces_are_of_one_contact(&mut self, output: &Output) -> syn::Result<()> {
        let mut forces: Vec<(String, Extent)> = Vec::new();
        output.value.walk(&mut |part| {
            if let Kind::Force(law) = &part.kind {
                forces.push((law.to_string(), part.extent));
            }
        });
        for (law, extent) in forces {
            let contacts = self.contacts_of(&law, extent)?;
            rules::force_is_of_one_contact(&law, contacts, extent)?;
        }
        Ok(())
    }

    /// In how many contacts a law acts. One that is linear everywhere has none, and is told apart by its gaps.
    fn contacts_of(&mut self, law: &str, extent: Extent) -> syn::Result<usize> {
        let index = self.builder.context.laws.get(law).copied();
        let calls = &self.builder.context.calls[..self.calls];
        let own: Vec<usize> = (0..calls.len())
            .filter(|&call| Some(calls[call].law) == index)
            .collect();
        let one = self.builder.context.dag.integer(1);
        let unit = Term::constant(one, extent);
        let (mut contacts, mut linear) = (BTreeSet::new(), Vec::new());
        for call in own {
            match self.builder.called(&unit, call, self.laws)? {
                None => {}
                Some(Called::Linear(products)) => {
                    let products: Vec<_> = (products.iter())
                        .map(|term| (term.motion, term.wave, term.coefficient))
                        .collect();
                    if !linear.contains(&products) {
                        linear.push(products);
                    }
                }
                Some(Called::Law {
                    law,
                    arguments,
                    gap,
                }) => contacts.extend(self.assembly.contact_of(law, &arguments, &gap)),
            }
        }
        Ok(contacts.len() + linear.len())
    }
}
