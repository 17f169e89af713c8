//! Expressions to sums of [`Term`]s: parameters, waves and linear motion are taken apart; what is nonlinear stays whole, as an expression in coordinates and velocities.

use std::collections::HashMap;

use crate::ast::{Expr, Form, Kind};
use crate::dag::{Dag, Function, Id, Variable};
use crate::errors::{Extent, shortened};
use crate::index::Constants;

use super::interval::Ranges;
use super::term::{Motion, Term, collect};
use super::wave::Wave;
use super::written::{Quote, Written};

/// More terms than any equation has, and few enough to be quick.
const MOST_TERMS: usize = 1 << 14;

/// Operations in one coefficient.
const LARGEST_COEFFICIENT: usize = 1000;

/// A call of a law.
#[derive(Debug, Clone)]
pub struct Call {
    /// Index of the law.
    pub law: usize,
    /// Its gap, affine in the coordinates.
    pub gap: Vec<Term>,
    /// Its arguments, functions of parameters and `omega`.
    pub arguments: Vec<Id>,
}

/// What a name stands for.
#[derive(Debug, Clone)]
pub enum Meaning {
    /// A variable that does not move: a parameter, an argument of a law.
    Constant(Variable),
    /// A coordinate.
    Coordinate(usize),
    /// An array of coordinates: the first, and how many.
    Array(usize, usize),
    /// An expression named by `let`.
    Value(Vec<Term>),
}

/// Takes expressions apart.
#[derive(Debug, Default)]
pub struct Expander {
    /// The macro that the declaration stands in, for messages.
    pub form: Form,
    /// The graph.
    pub dag: Dag,
    /// What is known of parameters and arguments.
    pub ranges: Ranges,
    /// What names stand for.
    pub names: HashMap<String, Meaning>,
    /// Names that stand for exact numbers, for indices.
    pub constants: Constants,
    /// Laws that can be called, by name.
    pub laws: HashMap<String, usize>,
    /// The calls found so far.
    pub calls: Vec<Call>,
    /// The powers, quotients and switches that depend on the motion.
    pub written: Vec<Written>,
    /// Names of parameters, for messages.
    pub parameters: Vec<String>,
    /// Names of coordinates, for messages.
    pub coordinates: Vec<String>,
    /// Names of the arguments of the law at hand.
    pub arguments: Vec<String>,
    /// Name of the gap of the law at hand.
    pub gap: String,
    /// How many terms have been made.
    spent: usize,
    /// Where the budget of the graph was found to be spent.
    pub spent_at: Option<Extent>,
    /// How many terms may be made beyond those of one equation.
    pub allowance: usize,
}

impl Expander {
    /// An expression as one would write it.
    pub fn show(&self, id: Id) -> String {
        let is_name = !self.gap.contains([' ', '*', '/', '-']);
        shortened(self.dag.display(id, &|variable| match variable {
            // `a*(x - y)`, not `a*x - y`.
            Variable::Gap if !is_name => format!("({})", self.gap),
            _ => self.label(variable),
        }))
    }

    /// A variable as one would write it.
    pub fn label(&self, variable: Variable) -> String {
        let name = |names: &[String], index: usize| {
            names
                .get(index)
                .cloned()
                .unwrap_or_else(|| format!("#{index}"))
        };
        match variable {
            Variable::Gap => self.gap.clone(),
            Variable::Rate => format!("dot({})", self.gap),
            Variable::Base(index) => format!("base {index}"),
            Variable::Argument(index) => name(&self.arguments, index),
            Variable::Parameter(index) => name(&self.parameters, index),
            Variable::Omega => "omega".to_owned(),
            Variable::Time => "t".to_owned(),
            Variable::Coordinate(index) => name(&self.coordinates, index),
            Variable::Velocity(index) => format!("dot({})", name(&self.coordinates, index)),
            Variable::Acceleration(index) => format!("ddot({})", name(&self.coordinates, index)),
        }
    }

    /// The terms of an expression.
    ///
    /// # Errors
    /// What the language cannot express, at its place.
    pub fn expand(&mut self, expression: &Expr) -> syn::Result<Vec<Term>> {
        let extent = expression.extent;
        let terms = match &expression.kind {
            Kind::Number(value, _) => {
                let value = self.dag.number(*value);
                vec![Term::constant(value, extent)]
            }
            Kind::Name(name) => self.name(&name.to_string(), extent)?,
            Kind::Sum(parts) => {
                let mut terms = Vec::new();
                for (minus, part) in parts {
                    let part = self.expand(part)?;
                    terms.extend(part.into_iter().map(|term| {
                        if *minus {
                            term.negated(&mut self.dag)
                        } else {
                            term
                        }
                    }));
                }
                terms
            }
            Kind::Product(parts) => self.product(parts, extent)?,
            Kind::Power(base, exponent) => {
                let base_terms = self.expand(base)?;
                let exponent_terms = self.expand(exponent)?;
                let quote = Quote::power(base, &shortened(exponent));
                let exponent = self.constant(&exponent_terms, exponent.extent, "an exponent")?;
                self.power(base_terms, exponent, quote, extent)?
            }
            Kind::Absolute(operand) => {
                let terms = self.expand(operand)?;
                self.function(Function::Absolute, &terms, operand, extent)?
            }
            Kind::Call(name, arguments) => self.call(&name.to_string(), arguments, extent)?,
            Kind::Force(law) => self.force(&law.to_string(), extent)?,
            Kind::Element(name, index) => self.element(&name.to_string(), index, extent)?,
            Kind::Sigma(repeated) => self.sigma(repeated)?,
        };
        self.spend(terms.len(), extent)?;
        Ok(terms)
    }

    pub(super) fn spend(&mut self, terms: usize, extent: Extent) -> syn::Result<()> {
        self.spent = self.spent.saturating_add(terms);
        if self.spent > MOST_TERMS + self.allowance {
            return Err(extent.fault("too much to multiply out: make it a law, or factor it"));
        }
        self.work_is_left(extent)
    }

    /// The budget of the graph is not spent.
    pub(super) fn work_is_left(&mut self, extent: Extent) -> syn::Result<()> {
        if self.dag.is_spent() {
            let extent = *self.spent_at.get_or_insert(extent);
            return Err(too_long(extent));
        }
        Ok(())
    }

    fn name(&mut self, name: &str, extent: Extent) -> syn::Result<Vec<Term>> {
        let one = self.dag.integer(1);
        let unit = Term::constant(one, extent);
        let term = match (name, self.names.get(name)) {
            (_, Some(Meaning::Constant(variable))) => Term {
                coefficient: self.dag.variable(*variable),
                ..unit
            },
            (_, Some(Meaning::Coordinate(index))) => Term {
                motion: Motion::Linear(Variable::Coordinate(*index)),
                ..unit
            },
            (_, Some(Meaning::Value(terms))) => {
                return Ok(terms.iter().map(|term| Term { extent, ..*term }).collect());
            }
            ("omega", None) => Term {
                coefficient: self.dag.variable(Variable::Omega),
                ..unit
            },
            ("pi", None) => Term {
                coefficient: self.dag.pi(),
                ..unit
            },
            ("t", None) => Term { time: 1, ..unit },
            _ => return Err(extent.fault(format!("`{name}` cannot be used here"))),
        };
        Ok(vec![term])
    }

    /// Several factors. At most one that moves is multiplied out; a product of two or more is nonlinear and stays whole.
    fn product(&mut self, parts: &[(bool, Expr)], extent: Extent) -> syn::Result<Vec<Term>> {
        let one = self.dag.integer(1);
        let mut steady = vec![Term::constant(one, extent)];
        let mut moving: Vec<Vec<Term>> = Vec::new();
        for (divided, part) in parts {
            let mut terms = self.expand(part)?;
            if *divided {
                let minus_one = self.dag.integer(-1);
                terms = self.power(terms, minus_one, Quote::power(part, "-1"), part.extent)?;
            }
            if terms.iter().any(Term::moves) {
                moving.push(terms);
            } else {
                steady = self.multiply(&steady, &terms, extent)?;
            }
        }
        match moving.len() {
            0 => Ok(steady),
            1 => self.multiply(&steady, &moving[0], extent),
            _ => {
                let product = self.nonlinear_product(&moving, extent)?;
                self.multiply(&steady, &product, extent)
            }
        }
    }

    /// The product of two sums of which at most one moves.
    ///
    /// # Errors
    /// If there would be too many terms.
    pub fn multiply(
        &mut self,
        left: &[Term],
        right: &[Term],
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        self.spend(left.len().saturating_mul(right.len()), extent)?;
        let mut terms = Vec::new();
        for (a, b) in left.iter().flat_map(|a| right.iter().map(move |b| (a, b))) {
            let motion = if a.moves() { a.motion } else { b.motion };
            let coefficient = self.dag.product(&[a.coefficient, b.coefficient]);
            let time = a.time.saturating_add(b.time);
            let waves = a
                .wave
                .times(b.wave)
                .ok_or_else(|| extent.fault("this frequency is too fine a fraction of omega"))?;
            for (weight, wave) in waves {
                let weight = self.dag.number(weight);
                let coefficient = self.dag.product(&[coefficient, weight]);
                terms.push(Term {
                    coefficient,
                    wave,
                    time,
                    motion,
                    extent,
                });
            }
        }
        let terms = collect(&mut self.dag, terms);
        self.coefficients_are_small(&terms, extent)?;
        Ok(terms)
    }

    /// Numbers that do not fit stay unevaluated, and coefficients could then grow without end.
    fn coefficients_are_small(&self, terms: &[Term], extent: Extent) -> syn::Result<()> {
        let size = |term: &Term| -> usize {
            let parts = self.dag.reachable(&[term.coefficient]);
            parts
                .into_iter()
                .map(|id| 1 + self.dag.operands(id).len())
                .sum()
        };
        if terms.iter().any(|term| size(term) > LARGEST_COEFFICIENT) {
            return Err(extent.fault("too much to multiply out: make it a law, or factor it"));
        }
        Ok(())
    }

    fn nonlinear_product(
        &mut self,
        factors: &[Vec<Term>],
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        let one = self.dag.integer(1);
        let mut product = Vec::new();
        let mut outside = vec![Term::constant(one, extent)];
        for factor in factors {
            if factor
                .iter()
                .any(|term| matches!(term.motion, Motion::Call(_)))
            {
                return Err(extent.fault(
                    "a law multiplied by the motion: put the product inside the law, which knows its gap and `dot` of it",
                ));
            }
            // A single term may bring a wave along, which stays outside: `x*cos(omega*t) * H(x)`.
            if let [term] = factor[..] {
                let inside = Term {
                    coefficient: one,
                    wave: Wave::CONSTANT,
                    time: 0,
                    ..term
                };
                product.push(self.value(&[inside], extent)?);
                outside = self.multiply(
                    &outside,
                    &[Term {
                        motion: Motion::None,
                        ..term
                    }],
                    extent,
                )?;
            } else {
                product.push(self.value(factor, extent)?);
            }
        }
        let whole = self.dag.product(&product);
        let inside = Term {
            motion: self.motion_of(whole),
            ..Term::constant(one, extent)
        };
        self.multiply(&outside, &[inside], extent)
    }

    /// An expression in coordinates and velocities as the motion of a term.
    fn motion_of(&self, id: Id) -> Motion {
        match *self.dag.node(id) {
            crate::dag::Node::Variable(variable) => Motion::Linear(variable),
            _ => Motion::Nonlinear(id),
        }
    }

    /// A nonlinear function of coordinates and velocities as terms.
    pub(super) fn nonlinear(&mut self, id: Id, extent: Extent) -> Vec<Term> {
        let one = self.dag.integer(1);
        let term = Term::constant(one, extent);
        if self
            .dag
            .variables(id)
            .iter()
            .any(|&variable| is_motion(variable))
        {
            vec![Term {
                motion: self.motion_of(id),
                ..term
            }]
        } else {
            vec![Term {
                coefficient: id,
                ..term
            }]
        }
    }

    /// The sum of terms as one expression in coordinates and velocities.
    ///
    /// # Errors
    /// If something in it depends on time by itself, is a law or an acceleration.
    pub fn value(&mut self, terms: &[Term], extent: Extent) -> syn::Result<Id> {
        let mut parts = Vec::new();
        for term in terms {
            if !term.is_steady() {
                return Err(extent.fault(
                    "time inside a nonlinear term: declare a law and call it with the moving gap, as in `contact(x - cos(omega*t))`",
                ));
            }
            let motion = match term.motion {
                Motion::None => self.dag.integer(1),
                Motion::Linear(Variable::Acceleration(_)) => {
                    return Err(extent.fault("the equation must be linear in `ddot`: bring this term to the form mass * ddot(x)"));
                }
                Motion::Linear(variable) => self.dag.variable(variable),
                Motion::Nonlinear(id) => id,
                Motion::Call(_) => {
                    return Err(extent.fault(
                        "a law inside a nonlinear expression: put the expression inside the law",
                    ));
                }
            };
            parts.push(self.dag.product(&[term.coefficient, motion]));
        }
        Ok(self.dag.sum(&parts))
    }

    /// The sum of terms that must be a function of parameters and `omega` alone.
    ///
    /// # Errors
    /// If it moves or depends on time.
    pub fn constant(&mut self, terms: &[Term], extent: Extent, what: &str) -> syn::Result<Id> {
        if !terms.iter().all(Term::is_constant) {
            return Err(extent.fault(format!("{what} must be made of numbers and parameters")));
        }
        let parts: Vec<Id> = terms.iter().map(|term| term.coefficient).collect();
        Ok(self.dag.sum(&parts))
    }
}

/// What is said where the budget of the graph is spent.
pub(super) fn too_long(extent: Extent) -> syn::Error {
    extent.fault(
        "this would take too long to compile: write it with fewer terms, factors and pieces, or attach laws to matrices with a `Structure`",
    )
}

/// Whether a variable is a coordinate or one of its derivatives.
pub fn is_motion(variable: Variable) -> bool {
    matches!(
        variable,
        Variable::Coordinate(_) | Variable::Velocity(_) | Variable::Acceleration(_)
    )
}
