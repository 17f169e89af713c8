//! Derivatives of what is read off orbits, and of where events are, by the frequency and by every parameter of the declaration.
//!
//! An orbit by whatever method is taken as a state that returns to itself, and everything is differentiated along its motion in time:
//! exponents, levels, the motion of switches, one-sided limits at them. `of_branch` has the questions, `rows` what is read off, `orbit` and
//! `events` the answers. `cycle` has the equations, `slopes` signals at one instant, `scan` where an orbit switches and has extremes,
//! `sample_phases` where it is looked at, `landing` switches, `reader` and `moments` what is read off, `fold` and `grazing` how folds and touches
//! move, `multipliers` and `change` how multipliers do, `critical` where they cross the unit circle.

mod change;
mod critical;
mod cycle;
mod error;
mod events;
mod fold;
mod grazing;
mod landing;
mod moments;
mod multipliers;
mod of_branch;
mod orbit;
mod reader;
mod rows;
mod sample_phases;
mod scan;
mod slopes;
mod uncertain;

pub use uncertain::Uncertain;

use crate::event::EventKind;
use crate::numeric::estimate::Estimate;

/// What is read off an orbit, with its derivatives.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Measured {
    /// What it is, as [`Wanted`](crate::observe::Wanted) is written: `x:p2p`; `power` is the mean power of the load.
    pub name: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// Its value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Its derivative by each of [`Sensitivities::variables`], all others fixed; not a number by one for which it has another derivative to each
    /// side, which [`Sensitivities::missing`] says. Its error is how much another tolerance of the flow and other nodes change it, and
    /// roundings times the condition of the orbit's equations; infinite where it was not asked for.
    pub by: Vec<Estimate>,
}

/// Derivatives at an orbit or at an event.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Sensitivities {
    /// What the derivatives are by: `omega`, then the parameters in the order of the declaration.
    pub variables: Vec<String>,
    /// Their values.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub values: Vec<f64>,
    /// What the branch varies.
    pub varied: String,
    /// The kind of an event; `None` of any other orbit.
    pub kind: Option<EventKind>,
    /// Derivatives of the place of an event, a value of what is varied, by each of the variables: none by that itself, and none of a broken
    /// symmetry by what breaks it (`missing` says so). Empty of any other orbit.
    pub place: Vec<Option<Estimate>>,
    /// What is read off the orbit, at a fixed value of what is varied, multipliers as `multiplier_1_re` and `multiplier_1_im`, largest
    /// modulus first. Empty at a fold: there these derivatives are unbounded, as the inverse of the distance along the branch.
    pub measured: Vec<Measured>,
    /// What is read off the orbit at an event as the event moves: at a fold, how the height of the resonance changes. By what is varied
    /// these derivatives are zero. Empty of any other orbit.
    pub moving: Vec<Measured>,
    /// What has no derivatives here, and why.
    pub missing: Vec<Missing>,
    /// How far the orbit's equations are from singular ones, as a part of their size: zero at a fold. Derivatives at a fixed value of what is
    /// varied grow as its inverse.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub condition: f64,
}

/// What has no derivatives.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Missing {
    /// Its name, or what several have in common.
    pub what: String,
    /// Why there are none, as a sentence.
    pub why: String,
}

impl Missing {
    fn new(what: impl Into<String>, why: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            why: why.into(),
        }
    }
}

impl Sensitivities {
    /// The derivative of what is read off by a variable, by their names; `None` where there is none of that name.
    pub fn of(&self, name: &str, variable: &str) -> Option<Estimate> {
        self.by(&self.measured, name, variable)
    }

    /// The derivative of what is read off at an event as the event moves, by their names; `None` where there is none of that name.
    pub fn of_moving(&self, name: &str, variable: &str) -> Option<Estimate> {
        self.by(&self.moving, name, variable)
    }

    fn by(&self, rows: &[Measured], name: &str, variable: &str) -> Option<Estimate> {
        let index = self.variables.iter().position(|own| own == variable)?;
        let row = rows.iter().find(|row| row.name == name)?;
        row.by.get(index).copied()
    }

    /// The derivative of the place of an event by a variable, by its name.
    pub fn of_place(&self, variable: &str) -> Option<Estimate> {
        let index = self.variables.iter().position(|own| own == variable)?;
        self.place.get(index).copied().flatten()
    }
}
