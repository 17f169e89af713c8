//! Room for a pass over an orbit: nothing is allocated while one is made.

use super::block::Square;
use super::skeleton::{Interval, Skeleton};

/// Room for a pass.
#[derive(Debug, Default)]
pub(super) struct Room {
    /// States, and their derivatives by the extended unknowns, row by row.
    pub(super) y: Vec<f64>,
    pub(super) by: Vec<f64>,
    pub(super) by_next: Vec<f64>,
    /// Integrals of (1) per pair, row by row of targets: coefficients of `I` and of `D`.
    pub(super) once: Vec<f64>,
    pub(super) twice: Vec<f64>,
    /// Per active contact and node: what a unit force does to the states.
    pub(super) input: Vec<f64>,
    /// Per node: what all forces together do, and how that changes with the phase.
    pub(super) load: Vec<f64>,
    pub(super) load_by: Vec<f64>,
    /// Per pair and target: what the forces have done changes so with the time.
    pub(super) by_time: Vec<[f64; 2]>,
    pub(super) steady_from: [Vec<f64>; 3],
    pub(super) steady: [Vec<f64>; 3],
    pub(super) resonant: [Vec<f64>; 4],
    /// Per pair, the exponential up to a target.
    pub(super) exponentials: Vec<Square>,
    pub(super) target: Target,
    /// Rows of gap and rate over the states, and their derivatives by the phase.
    pub(super) output: [Vec<f64>; 2],
    pub(super) output_by: [Vec<f64>; 2],
    pub(super) gaps: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) forces: Vec<f64>,
    pub(super) by_gap: Vec<f64>,
    pub(super) by_rate: Vec<f64>,
    /// Derivatives of gaps and rates by the extended unknowns, row by row of active contacts and nodes.
    pub(super) gap_rows: Vec<f64>,
    pub(super) rate_rows: Vec<f64>,
    /// Per switch: gap less level and its slope by the phase, and their derivatives.
    pub(super) at_switch: Vec<[f64; 2]>,
    pub(super) switch_rows: Vec<f64>,
    pub(super) slope_rows: Vec<f64>,
}

/// The states at a target, and how they change with where the interval begins and ends and with the frequency.
#[derive(Debug, Default)]
pub(super) struct Target {
    pub(super) psi: f64,
    pub(super) phase: f64,
    pub(super) state: Vec<f64>,
    pub(super) by_from: Vec<f64>,
    pub(super) by_to: Vec<f64>,
    pub(super) by_omega: Vec<f64>,
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
        let switches = skeleton.switches.len();
        let integrals = vec![0.0; pairs * (nodes + 1) * nodes];
        Self {
            y: states(),
            by: vec![0.0; order * columns],
            by_next: vec![0.0; order * columns],
            once: integrals.clone(),
            twice: integrals,
            input: vec![0.0; forces.max(contacts) * order],
            load: vec![0.0; nodes * order],
            load_by: vec![0.0; nodes * order],
            by_time: vec![[0.0; 2]; pairs * (nodes + 1)],
            steady_from: std::array::from_fn(|_| states()),
            steady: std::array::from_fn(|_| states()),
            resonant: std::array::from_fn(|_| states()),
            exponentials: vec![[[0.0; 2]; 2]; pairs],
            target: Target {
                state: states(),
                by_from: states(),
                by_to: states(),
                by_omega: states(),
                ..Target::default()
            },
            output: std::array::from_fn(|_| states()),
            output_by: std::array::from_fn(|_| states()),
            gaps: vec![0.0; forces],
            rates: vec![0.0; forces],
            forces: vec![0.0; forces],
            by_gap: vec![0.0; forces],
            by_rate: vec![0.0; forces],
            gap_rows: vec![0.0; forces * columns],
            rate_rows: vec![0.0; forces * columns],
            at_switch: vec![[0.0; 2]; switches],
            switch_rows: vec![0.0; switches * columns],
            slope_rows: vec![0.0; switches * columns],
        }
    }
}
