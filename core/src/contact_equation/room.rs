//! Room for a pass over an orbit: nothing is allocated while one is made.

use super::block::Square;
use super::skeleton::{Interval, Skeleton};
use super::values::Output;

/// Room for a pass.
#[derive(Debug, Default)]
pub(super) struct Room {
    /// States at the last cut, and their derivatives by the extended unknowns, row by row.
    pub(super) y: Vec<f64>,
    pub(super) by: Vec<f64>,
    pub(super) by_next: Vec<f64>,
    /// Integrals of (1) per pair, row by row of targets: coefficients of `I` and of `D`.
    pub(super) once: Vec<f64>,
    pub(super) twice: Vec<f64>,
    /// Per active contact and node: what a unit force does to the states.
    pub(super) input: Vec<f64>,
    /// What all forces together do to a state, node by node; and, where directions move, how that changes with where the interval begins,
    /// and with where it ends.
    pub(super) load: [Vec<f64>; 3],
    /// Per pair and target: what the forces have done changes so with the time.
    pub(super) by_time: Vec<[f64; 2]>,
    /// The steady response at one phase, with its derivatives, and the same where the interval begins.
    pub(super) steady: [Vec<f64>; 3],
    pub(super) steady_from: [Vec<f64>; 3],
    pub(super) resonant: [Vec<f64>; 4],
    pub(super) targets: Targets,
    /// Per active contact and node: gap and rate, and what they are of the states as rows.
    pub(super) outputs: Vec<Output>,
    pub(super) gap_rows: Vec<f64>,
    pub(super) rate_rows: Vec<f64>,
    pub(super) gaps: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) forces: Vec<f64>,
    pub(super) by_gap: Vec<f64>,
    pub(super) by_rate: Vec<f64>,
    /// Rows over the states.
    pub(super) rows: [Vec<f64>; 3],
    /// Per switch: gap less level and its slope by the phase, and their derivatives.
    pub(super) at_switch: Vec<[f64; 2]>,
    pub(super) switch_rows: Vec<f64>,
    pub(super) slope_rows: Vec<f64>,
}

/// The states at the targets of an interval, target by target, and how they change with where it begins and ends and with the frequency.
#[derive(Debug, Default)]
pub(super) struct Targets {
    pub(super) states: Vec<f64>,
    pub(super) by_from: Vec<f64>,
    pub(super) by_to: Vec<f64>,
    pub(super) by_omega: Vec<f64>,
    /// The exponential of every pair from the beginning on.
    pub(super) exponentials: Vec<Square>,
}

impl Room {
    pub(super) fn new(skeleton: &Skeleton, contacts: usize) -> Self {
        let (order, columns) = (skeleton.order, skeleton.unknowns() + 1);
        let pairs = order / 2;
        let most =
            |of: fn(&Interval) -> usize| skeleton.intervals.iter().map(of).max().unwrap_or(0);
        let nodes = most(|interval| interval.nodes.count());
        let forces = most(|interval| interval.active.len() * interval.nodes.count());
        let states = || vec![0.0; order];
        let at_targets = || vec![0.0; (nodes + 1) * order];
        let at_nodes = || vec![0.0; nodes * order];
        let switches = skeleton.switches.len();
        let integrals = vec![0.0; pairs * (nodes + 1) * nodes];
        Self {
            y: states(),
            by: vec![0.0; order * columns],
            by_next: vec![0.0; order * columns],
            once: integrals.clone(),
            twice: integrals,
            input: vec![0.0; forces.max(contacts) * order],
            load: std::array::from_fn(|_| at_nodes()),
            by_time: vec![[0.0; 2]; pairs * (nodes + 1)],
            steady_from: std::array::from_fn(|_| states()),
            steady: std::array::from_fn(|_| states()),
            resonant: std::array::from_fn(|_| states()),
            targets: Targets {
                states: at_targets(),
                by_from: at_targets(),
                by_to: at_targets(),
                by_omega: at_targets(),
                exponentials: vec![[[0.0; 2]; 2]; (nodes + 1) * pairs],
            },
            outputs: vec![Output::default(); forces],
            gap_rows: vec![0.0; forces * order],
            rate_rows: vec![0.0; forces * order],
            gaps: vec![0.0; forces],
            rates: vec![0.0; forces],
            forces: vec![0.0; forces],
            by_gap: vec![0.0; forces],
            by_rate: vec![0.0; forces],
            rows: std::array::from_fn(|_| states()),
            at_switch: vec![[0.0; 2]; switches],
            switch_rows: vec![0.0; switches * columns],
            slope_rows: vec![0.0; switches * columns],
        }
    }
}
