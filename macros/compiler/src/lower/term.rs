//! Sums of terms: what an expression of the equation of motion is multiplied out to.

use crate::dag::{Dag, Id, Rational, Variable};
use crate::errors::Extent;

use super::wave::Wave;

/// `coefficient * wave(t) * t^time * motion`
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// A function of parameters and `omega`.
    pub coefficient: Id,
    /// Its periodic dependence on time.
    pub wave: Wave,
    /// The power of bare time; zero in all that is periodic.
    pub time: u32,
    /// Its dependence on the motion.
    pub motion: Motion,
    /// Where it stands.
    pub extent: Extent,
}

/// How a term depends on the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Not at all.
    None,
    /// A coordinate or one of its derivatives.
    Linear(Variable),
    /// A nonlinear function of coordinates and velocities.
    Nonlinear(Id),
    /// A law, by position among the calls.
    Call(usize),
}

impl Term {
    /// A term that is constant in time and free of the motion.
    pub fn constant(coefficient: Id, extent: Extent) -> Self {
        Self {
            coefficient,
            wave: Wave::CONSTANT,
            time: 0,
            motion: Motion::None,
            extent,
        }
    }

    /// Whether nothing but parameters and `omega` is in it.
    pub fn is_constant(&self) -> bool {
        self.motion == Motion::None && self.is_steady()
    }

    /// Whether it does not depend on time by itself.
    pub fn is_steady(&self) -> bool {
        self.time == 0 && self.wave == Wave::CONSTANT
    }

    /// Whether it depends on the motion.
    pub fn moves(&self) -> bool {
        self.motion != Motion::None
    }

    /// The term with its coefficient multiplied.
    pub fn scaled(self, dag: &mut Dag, factor: Id) -> Self {
        Self {
            coefficient: dag.product(&[self.coefficient, factor]),
            ..self
        }
    }

    /// The term with the other sign.
    pub fn negated(self, dag: &mut Dag) -> Self {
        Self {
            coefficient: dag.negate(self.coefficient),
            ..self
        }
    }
}

/// Adds up the coefficients of terms that are otherwise equal, and drops what cancels. Keeps the order.
pub fn collect(dag: &mut Dag, terms: Vec<Term>) -> Vec<Term> {
    let mut positions = std::collections::HashMap::new();
    let mut collected: Vec<Term> = Vec::new();
    for term in terms {
        let position = *positions
            .entry((term.wave, term.time, term.motion))
            .or_insert(collected.len());
        match collected.get_mut(position) {
            Some(same) => same.coefficient = dag.sum(&[same.coefficient, term.coefficient]),
            None => collected.push(term),
        }
    }
    collected.retain(|term| dag.as_number(term.coefficient) != Some(Rational::ZERO));
    collected
}
