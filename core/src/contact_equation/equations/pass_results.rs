//! What the last pass has met, as data: for whoever looks at the motion afterwards, and what they have found, which is kept with it.

use std::cell::OnceCell;

use crate::numeric::roots::Place;

/// What was met on an interval, for whoever looks at the motion afterwards.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Passed {
    pub(in crate::contact_equation) phases: [f64; 2],
    /// States less the steady response at its beginning, in the pairs of its configuration.
    pub(in crate::contact_equation) free: Vec<f64>,
    /// What the forces do to the states, at the nodes and the end.
    pub(in crate::contact_equation) forced: Vec<f64>,
    /// What all forces together do to a state, state by state, node by node.
    pub(in crate::contact_equation) load: Vec<f64>,
    /// The states at the beginning, the nodes and the end.
    pub(in crate::contact_equation) states: Vec<f64>,
    /// How the force of each contact changes with its gap at the nodes, if derivatives were asked for.
    pub(in crate::contact_equation) stiffness: Vec<f64>,
}

/// An extreme of a gap within an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::contact_equation) struct GapExtreme {
    pub(in crate::contact_equation) contact: usize,
    pub(in crate::contact_equation) interval: usize,
    pub(in crate::contact_equation) phase: f64,
    pub(in crate::contact_equation) gap: f64,
    pub(in crate::contact_equation) maximum: bool,
}

/// The extremes of one orbit, as far as they were asked for: those of gaps say whether equations fit it, those of coordinates are read where it is kept.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Extremes {
    /// Per coordinate, phase and value where it is smallest and largest over the period.
    pub(in crate::contact_equation) coordinates: OnceCell<Vec<[Place; 2]>>,
    /// Per contact, in the order of time, until the orbit comes back; none where its law has no levels.
    pub(in crate::contact_equation) gaps: OnceCell<Vec<Vec<GapExtreme>>>,
}

/// A contact with the gap that another one has had, or with the opposite.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Image {
    pub(in crate::contact_equation) contact: usize,
    pub(in crate::contact_equation) sign: f64,
}
