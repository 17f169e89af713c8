//! How far a computation is: what all callbacks are told.

use std::ops::ControlFlow;

use crate::branches::point::Point;

/// A callback.
pub(crate) type See<'v> = &'v mut dyn FnMut(Progress<'_>) -> ControlFlow<()>;

/// How far a computation is.
///
/// Every callback has the form `FnMut(Progress<'_>) -> ControlFlow<()>`: to show progress, or to stop by
/// [`ControlFlow::Break`](std::ops::ControlFlow::Break) with what is computed by then. It is called where something is done; between two
/// calls a [`Cancel`](crate::Cancel) stops a computation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress<'p> {
    /// What is computed.
    pub stage: Stage,
    /// How much of it is done, in what the stage counts.
    pub done: usize,
    /// How much there is of it, where that is known beforehand.
    pub total: Option<usize>,
    /// Value of what is varied.
    pub value: Option<f64>,
    /// The orbit that was found last.
    pub point: Option<&'p Point>,
}

impl Progress<'_> {
    /// So much is done of a stage, and nothing else is known.
    pub const fn new(stage: Stage, done: usize) -> Self {
        Self {
            stage,
            done,
            total: None,
            value: None,
            point: None,
        }
    }

    /// So much is done of a stage, and the last is at this value.
    pub(crate) const fn at(stage: Stage, done: usize, value: f64) -> Self {
        Self {
            value: Some(value),
            ..Self::new(stage, done)
        }
    }
}

impl<'p> Progress<'p> {
    /// So many points of a branch, and the last of them.
    pub(crate) const fn orbit(done: usize, point: &'p Point) -> Self {
        Self {
            point: Some(point),
            ..Self::at(Stage::Branch, done, point.value)
        }
    }
}

/// What a computation is doing, and what it counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// It looks for the first orbit: attempts.
    FirstOrbit,
    /// It follows a branch of orbits: points.
    Branch,
    /// It follows the branch once more by the harmonic balance, since the contact equation that was [chosen](crate::Chosen) led no further:
    /// points.
    Again,
    /// It reads everything off the orbits of a branch that is there: orbits.
    Completing,
    /// It follows a curve of bifurcations in two parameters, or a backbone: points.
    Curve,
    /// It lets motions settle, value by value: values.
    Sweep,
    /// It lets motions settle, cell by cell: cells.
    Basin,
    /// It lets motions settle at a value, to find further branches: motions.
    Settling,
    /// It solves for orbits from states around a value, to find further branches: states.
    Solving,
    /// It looks for all solutions over two parameters, row by row: rows, of which the last is at this value of the second parameter.
    Map,
    /// It computes the variants of a study: variants.
    Study,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::FirstOrbit => "first orbit",
            Self::Branch => "branch",
            Self::Again => "branch by the harmonic balance",
            Self::Completing => "completing",
            Self::Curve => "curve",
            Self::Sweep => "sweep",
            Self::Basin => "basin",
            Self::Settling => "settling",
            Self::Solving => "solving",
            Self::Map => "map",
            Self::Study => "study",
        })
    }
}
