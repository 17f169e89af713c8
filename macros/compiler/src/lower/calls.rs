//! Calls: of functions by name, of laws, and of the derivative by time.

use crate::ast::Expr;
use crate::dag::{Function, Variable};
use crate::errors::Extent;

use super::expand::{Call, Expander};
use super::term::{Motion, Term, collect};
use super::wave::Wave;
use super::written::Quote;

impl Expander {
    pub(super) fn call(
        &mut self,
        name: &str,
        arguments: &[Expr],
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        if let Some(&law) = self.laws.get(name) {
            return self.law(law, arguments, extent);
        }
        if let ("max" | "min", [first, second]) = (name, arguments) {
            return self.extremum(name == "max", [first, second], extent);
        }
        let [argument] = arguments else {
            return Err(extent.fault(format!("`{name}` takes one argument")));
        };
        let operand = self.expand(argument)?;
        match name {
            "dot" => self.rate(&operand, argument.extent),
            "ddot" => {
                let first = self.rate(&operand, argument.extent)?;
                self.rate(&first, argument.extent)
            }
            "sqrt" => {
                let half = self.dag.integer(2);
                let one = self.dag.integer(1);
                let half = self.dag.quotient(one, half);
                self.power(operand, half, Quote::power(argument, "0.5"), extent)
            }
            "H" => self.function(Function::Step, &operand, argument, extent),
            "sgn" => self.function(Function::Sign, &operand, argument, extent),
            "abs" => self.function(Function::Absolute, &operand, argument, extent),
            "cos" => self.function(Function::Cosine, &operand, argument, extent),
            "sin" => self.function(Function::Sine, &operand, argument, extent),
            "exp" => self.function(Function::Exponential, &operand, argument, extent),
            "tanh" => self.function(Function::Tanh, &operand, argument, extent),
            _ => Err(extent.fault(format!("unknown function `{name}`"))),
        }
    }

    fn law(&mut self, law: usize, arguments: &[Expr], extent: Extent) -> syn::Result<Vec<Term>> {
        let Some((gap, rest)) = arguments.split_first() else {
            return Err(extent.fault("a law takes its gap as first argument"));
        };
        let place = gap.extent;
        let gap = self.expand(gap)?;
        let gap = collect(&mut self.dag, gap);
        for term in &gap {
            match term.motion {
                Motion::None | Motion::Linear(Variable::Coordinate(_)) if term.time == 0 => {}
                Motion::Nonlinear(_) | Motion::Call(_) => {
                    return Err(place.fault(
                        "the gap must be linear in the coordinates: put what is nonlinear inside the law",
                    ));
                }
                _ => {
                    return Err(place.fault(
                        "the gap is made of coordinates, parameters and waves of omega*t alone",
                    ));
                }
            }
        }
        if !gap.iter().any(Term::moves) {
            return Err(place.fault(
                "this gap holds no coordinate: it would be a force that depends on time alone",
            ));
        }
        let mut values = Vec::new();
        for argument in rest {
            let terms = self.expand(argument)?;
            values.push(self.constant(&terms, argument.extent, "an argument of a law")?);
        }
        self.calls.push(Call {
            law,
            gap,
            arguments: values,
        });
        let one = self.dag.integer(1);
        Ok(vec![Term {
            motion: Motion::Call(self.calls.len() - 1),
            ..Term::constant(one, extent)
        }])
    }

    /// The force of a law in an output: its first call. That all of them are one contact is checked where contacts are known.
    pub(super) fn force(&mut self, law: &str, extent: Extent) -> syn::Result<Vec<Term>> {
        let index = self.laws.get(law);
        let mut calls = self.calls.iter();
        let call = index.and_then(|index| calls.position(|call| call.law == *index));
        let Some(call) = call else {
            return Err(extent.fault(format!("law `{law}` acts in no equation")));
        };
        let one = self.dag.integer(1);
        Ok(vec![Term {
            motion: Motion::Call(call),
            ..Term::constant(one, extent)
        }])
    }

    /// The derivative by time: of the wave, and of the motion.
    ///
    /// # Errors
    /// For nonlinear motion, and third derivatives.
    pub fn rate(&mut self, terms: &[Term], extent: Extent) -> syn::Result<Vec<Term>> {
        let mut rates = Vec::new();
        for term in terms {
            if term.time > 0 {
                return Err(extent.fault("`dot` of an expression with bare `t`"));
            }
            let moved = match term.motion {
                Motion::None => None,
                Motion::Linear(Variable::Coordinate(index)) => Some(Variable::Velocity(index)),
                Motion::Linear(Variable::Velocity(index)) => Some(Variable::Acceleration(index)),
                Motion::Linear(_) => {
                    return Err(
                        extent.fault("derivatives higher than the second have no place in (1)")
                    );
                }
                Motion::Nonlinear(_) | Motion::Call(_) => {
                    return Err(extent.fault("`dot` of a nonlinear expression: write its derivative out, as in `2*x*dot(x)`"));
                }
            };
            rates.extend(moved.map(|variable| Term {
                motion: Motion::Linear(variable),
                ..*term
            }));
            let multiple = if term.wave.sine {
                Some(term.wave.multiple)
            } else {
                term.wave.multiple.negate()
            };
            let omega = self.dag.variable(Variable::Omega);
            let multiple = multiple.map_or(omega, |multiple| {
                let number = self.dag.number(multiple);
                self.dag.product(&[number, omega])
            });
            if let Some((_, wave)) = Wave::new(term.wave.multiple, !term.wave.sine) {
                rates.push(Term {
                    wave,
                    ..term.scaled(&mut self.dag, multiple)
                });
            }
        }
        Ok(collect(&mut self.dag, rates))
    }
}
