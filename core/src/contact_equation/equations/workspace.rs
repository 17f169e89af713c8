//! Room for a pass over an orbit. What is kept of an interval grows in its first passes; nothing is allocated in later ones.

use super::integrals::Integrals;
use super::targets::Targets;
use crate::contact_equation::linear_part::contact::Output;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::interval::Interval;
use crate::numeric::linear::Placed;

/// Numbers that are kept of intervals which keep their own, at most: 16 MB.
const KEPT: usize = 1 << 21;
/// Of them, kernels of a pair on each way between two targets: three for every point of a rule, of which most have 16.
const KERNELS: usize = 3 * 16;

/// Room for a pass.
#[derive(Debug, Default)]
pub(in crate::contact_equation) struct Room {
    /// States at the last cut, and their derivatives by the unknowns that are no forces and the parameter, row by row.
    pub(in crate::contact_equation) y: Vec<f64>,
    pub(in crate::contact_equation) by: Vec<f64>,
    pub(super) by_next: Vec<f64>,
    /// The steady response where an interval begins, with its derivatives.
    pub(super) steady_from: [Vec<f64>; 3],
    /// Of as many intervals with forces as there is room for, and of one at a time of the others; and which of them is that of an interval.
    pub(super) integrals: Vec<Integrals>,
    pub(super) integrals_of: Vec<usize>,
    pub(in crate::contact_equation) targets: Targets,
    /// Per active contact and node: gap and rate, and what they are of the states as rows.
    pub(in crate::contact_equation) outputs: Vec<Output>,
    pub(super) gap_rows: Vec<f64>,
    pub(super) rate_rows: Vec<f64>,
    pub(in crate::contact_equation) gaps: Vec<f64>,
    pub(in crate::contact_equation) rates: Vec<f64>,
    pub(in crate::contact_equation) forces: Vec<f64>,
    pub(in crate::contact_equation) by_gap: Vec<f64>,
    pub(in crate::contact_equation) by_rate: Vec<f64>,
    /// Derivatives of the states of a configuration by those of the linear part.
    pub(in crate::contact_equation) carried: Vec<f64>,
    pub(super) placed: Vec<Placed>,
    /// Rows over the states.
    pub(in crate::contact_equation) rows: [Vec<f64>; 3],
    /// Per switch: gap less level and its slope by the phase, and their derivatives.
    pub(super) at_switch: Vec<[f64; 2]>,
    pub(super) switch_rows: Vec<f64>,
    pub(super) slope_rows: Vec<f64>,
    /// The same as forms of the states behind an interval.
    pub(super) gap_forms: Vec<f64>,
    pub(super) slope_forms: Vec<f64>,
    pub(super) read_at: Vec<usize>,
}

impl Room {
    /// Makes room for derivatives of states, where they are carried along.
    pub(super) fn carry(&mut self, skeleton: &Skeleton) {
        let size = skeleton.order * (skeleton.told() + 1);
        self.by.resize(size, 0.0);
        self.by_next.resize(size, 0.0);
    }

    /// The linear part is another one.
    pub(super) fn forget(&mut self) {
        for integrals in &mut self.integrals {
            integrals.forget();
        }
    }

    pub(in crate::contact_equation) fn new(skeleton: &Skeleton) -> Self {
        let (order, columns) = (skeleton.order, skeleton.told() + 1);
        let most =
            |of: fn(&Interval) -> usize| skeleton.intervals.iter().map(of).max().unwrap_or(0);
        let nodes = most(|interval| interval.nodes.count());
        let forces = most(Interval::forces);
        let states = || vec![0.0; order];
        let carried = if skeleton.configurations.is_empty() {
            0
        } else {
            order * order
        };
        let switches = skeleton.switches.len();
        let (integrals, integrals_of) = integrals(skeleton, [nodes, forces]);
        Self {
            y: states(),
            by: Vec::new(),
            by_next: Vec::new(),
            steady_from: std::array::from_fn(|_| states()),
            integrals,
            integrals_of,
            targets: Targets::new(order, nodes + 1),
            outputs: vec![Output::default(); forces],
            gap_rows: vec![0.0; forces * order],
            rate_rows: vec![0.0; forces * order],
            gaps: vec![0.0; forces],
            rates: vec![0.0; forces],
            forces: vec![0.0; forces],
            by_gap: vec![0.0; forces],
            by_rate: vec![0.0; forces],
            carried: vec![0.0; carried],
            placed: Vec::with_capacity(order),
            rows: std::array::from_fn(|_| states()),
            at_switch: vec![[0.0; 2]; switches],
            switch_rows: vec![0.0; switches * columns],
            slope_rows: vec![0.0; switches * columns],
            gap_forms: vec![0.0; switches * order],
            slope_forms: vec![0.0; switches * order],
            read_at: vec![0; switches],
        }
    }
}

/// Integrals of intervals that have so many nodes and forces at most, and which of them each has.
fn integrals(skeleton: &Skeleton, [nodes, forces]: [usize; 2]) -> (Vec<Integrals>, Vec<usize>) {
    let order = skeleton.order;
    let mut own = Vec::new();
    let mut kept = 0;
    let mut places = Vec::with_capacity(skeleton.intervals.len());
    for interval in &skeleton.intervals {
        let n = interval.nodes.count();
        let size = order / 2 * (n + 1) * (2 * n + KERNELS);
        let is_kept = !interval.active.is_empty() && kept + size <= KEPT;
        places.push(is_kept.then_some(own.len()));
        if is_kept {
            kept += size;
            own.push(Integrals::new(order, n, interval.forces()));
        }
    }
    let shared = own.len();
    let mut alone = skeleton.intervals.iter().zip(&places);
    if alone.any(|(interval, place)| place.is_none() && !interval.active.is_empty()) {
        own.push(Integrals::new(order, nodes, forces));
    }
    let places = places.into_iter().map(|place| place.unwrap_or(shared));
    (own, places.collect())
}
