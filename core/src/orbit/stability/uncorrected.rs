//! Multipliers of orbits as the balance has them, not corrected for what it leaves out: what test functions of bifurcations look at
//! between two points of a branch.

use nalgebra::Complex;

use super::Method;
use super::method::Floquet;
use super::orbit::Orbit;
use crate::balance::Balance;

/// Error of the multipliers that is aimed at: the event is located to what it leaves.
const EXACT: f64 = 1e-12;

/// Multipliers of the orbits of one balance.
#[derive(Debug)]
pub(crate) struct Uncorrected<'a> {
    balance: Balance<'a>,
    engine: Box<dyn Floquet>,
    /// The last orbit, as extended unknowns, and its multipliers.
    at: Vec<f64>,
    found: Vec<Complex<f64>>,
    /// Orbits whose multipliers were computed.
    pub(crate) computed: usize,
}

/// What is taken over from one orbit to the next.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Memory {
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pace: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    at: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    found: Vec<Complex<f64>>,
}

impl Memory {
    /// Whether it is one of orbits with so many unknowns and multipliers: it may have been read from a file.
    pub(crate) fn is_of(&self, unknowns: usize, multipliers: usize) -> bool {
        let nothing = self.at.is_empty() && self.found.is_empty();
        let orbit = self.at.len() == unknowns + 1 && self.at.iter().all(|x| x.is_finite());
        nothing || orbit && [0, multipliers].contains(&self.found.len())
    }
}

impl<'a> Uncorrected<'a> {
    pub(crate) fn new(balance: Balance<'a>) -> Self {
        Self {
            balance,
            engine: Method::Monodromy.engine(),
            at: Vec::new(),
            found: Vec::new(),
            computed: 0,
        }
    }

    pub(crate) fn memory(&self) -> Memory {
        Memory {
            pace: self.engine.pace(),
            at: self.at.clone(),
            found: self.found.clone(),
        }
    }

    /// As after the orbit that left this.
    pub(crate) fn remember(&mut self, memory: &Memory) {
        self.engine.keep_pace(memory.pace);
        self.at.clone_from(&memory.at);
        self.found.clone_from(&memory.found);
    }

    /// Those of an orbit, given as extended unknowns, largest modulus first; none where nothing is known.
    pub(crate) fn at(&mut self, u: &[f64]) -> &[Complex<f64>] {
        if self.at != u {
            let last = u.len() - 1;
            self.balance.set(u[last]);
            self.computed += 1;
            let orbit = Orbit::of(&self.balance, &u[..last]);
            self.found = self.engine.multipliers(&orbit, EXACT).multipliers;
            self.at.clear();
            self.at.extend_from_slice(u);
        }
        &self.found
    }
}
