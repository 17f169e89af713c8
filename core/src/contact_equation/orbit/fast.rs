//! Pairs of states of an interval that turn too fast for the polynomial through its targets, as arrays: what forces at nodes have done to all of them at a
//! place between targets, by (1) of [`partway`](crate::contact_equation::collocation::partway).
//!
//! Forces at a point of the rule are sums over the nodes, `f = sum_l l(y_q) f_l`, for both states of every pair. Where one contact acts whose direction does not
//! move, that is one number, times what it does to each state.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, section 1.1 (sums of columns as loops over arrays).

use multiversion::multiversion;

use super::motion::Motion;
use crate::contact_equation::collocation::partway::Partway;
use crate::contact_equation::equations::pass_results::Passed;
use crate::contact_equation::linear_part::block::{Block, pair};
use crate::contact_equation::linear_part::kernels::{Found, Kernels};
use crate::numeric::fourier::kernels::LANES;

/// Those of one interval.
#[derive(Debug, Default)]
pub(super) struct Fast {
    pairs: Vec<usize>,
    blocks: Vec<Block>,
    kernels: Kernels,
    /// How many there are, as a multiple of the lanes: those behind the last one are at rest.
    count: usize,
    /// Entries of `D`, pair by pair: row by row.
    deviation: [Vec<f64>; 4],
    /// What the forces at each node do to the first and to the second states, pair by pair.
    load: [Vec<f64>; 2],
    /// What one contact does to these, and at which pair and state most.
    alone: Option<Alone>,
}

/// What a unit force of the only contact does.
#[derive(Debug)]
struct Alone {
    input: [Vec<f64>; 2],
    state: usize,
    place: usize,
}

/// Room for one instant.
#[derive(Debug, Default)]
pub(super) struct FastRoom {
    kernels: Found,
    force: [Vec<f64>; 2],
    /// What forces have done to the first and to the second states.
    pub(super) states: [Vec<f64>; 2],
}

impl Fast {
    /// Of an interval with forces at nodes.
    pub(super) fn of(motion: &Motion<'_>, interval: usize) -> Self {
        let equations = motion.equations;
        let (values, passed) = (&equations.values, &equations.passed[interval]);
        let of = &equations.skeleton.intervals[interval];
        let whole = (passed.phases[1] - passed.phases[0]) / values.base;
        let all = &values.linear.blocks;
        let is_fast = |r: &usize| !of.nodes.follows(all[*r].rate() * whole.abs());
        let pairs: Vec<usize> = (0..all.len()).filter(is_fast).collect();
        let blocks: Vec<Block> = pairs.iter().map(|&r| all[r]).collect();
        let (n, count) = (of.nodes.count(), pairs.len().next_multiple_of(LANES));
        let load = [0, 1].map(|i| {
            let mut load = vec![0.0; n * count];
            for (node, load) in load.chunks_exact_mut(count.max(1)).enumerate() {
                for (to, r) in load.iter_mut().zip(&pairs) {
                    *to = passed.load[(2 * r + i) * n + node];
                }
            }
            load
        });
        let entry = |row: usize, column: usize| {
            let mut entries = vec![0.0; count];
            for (entry, block) in entries.iter_mut().zip(&blocks) {
                *entry = block.deviation[row][column];
            }
            entries
        };
        let alone = match &of.active[..] {
            [active] => Some(&values.contacts[active.contact].input),
            _ => None,
        };
        let alone = alone.filter(|input| input.is_constant());
        let alone = alone.and_then(|input| Alone::of(input.constant(), &pairs));
        Self {
            kernels: Kernels::of(&blocks),
            deviation: [entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)],
            count,
            load,
            alone,
            pairs,
            blocks,
        }
    }

    /// Which pairs these are.
    pub(super) fn pairs(&self) -> &[usize] {
        &self.pairs
    }

    /// Leaves in the room what forces have done up to where a rule ends, in an interval of this length.
    pub(super) fn follow(&self, passed: &Passed, rule: &Partway, whole: f64, room: &mut FastRoom) {
        let count = self.count;
        for states in &mut room.states {
            states.clear();
            states.resize(count, 0.0);
        }
        for force in &mut room.force {
            force.resize(rule.points.len().max(1) * count, 0.0);
        }
        if let Some(target) = rule.done {
            let order = passed.free.len();
            let known = &passed.forced[target * order..][..order];
            for (place, &r) in self.pairs.iter().enumerate() {
                let known = pair(known, r);
                (room.force[0][place], room.force[1][place]) = (known[0], known[1]);
            }
            self.add(rule.left * whole, 1.0, 0, room);
        }
        self.write_forces(rule, room);
        for (point, [left, weight]) in rule.points.iter().enumerate() {
            self.add(left * whole, weight * whole, point, room);
        }
    }

    /// Writes what forces do at every point of a rule.
    fn write_forces(&self, rule: &Partway, room: &mut FastRoom) {
        let count = self.count;
        let Some(Alone {
            input,
            state,
            place,
        }) = &self.alone
        else {
            for (to, load) in room.force.iter_mut().zip(&self.load) {
                let to = &mut to[..rule.points.len() * count];
                write_sums(&rule.values, load, count, to);
            }
            return;
        };
        let rows = rule.values.chunks_exact(self.load[0].len() / count);
        for (point, row) in rows.enumerate() {
            let nodes = self.load[*state].chunks_exact(count);
            let sum: f64 = row.iter().zip(nodes).map(|(l, f)| l * f[*place]).sum();
            let force = sum / input[*state][*place];
            for (to, input) in room.force.iter_mut().zip(input) {
                for (to, input) in to[point * count..].iter_mut().zip(input) {
                    *to = force * input;
                }
            }
        }
    }

    /// Adds `e^(A t)` of what is written at a point, times a factor.
    fn add(&self, time: f64, factor: f64, point: usize, room: &mut FastRoom) {
        self.kernels.find(&self.blocks, time, &mut room.kernels);
        let kernels = [&room.kernels.c[..], &room.kernels.k[..]];
        let [first, second] = &mut room.states;
        let force = room.force.each_ref();
        let force = force.map(|of| &of[point * self.count..][..self.count]);
        let [a, b, c, d] = &self.deviation;
        add_carried([a, b], kernels, factor, force, first);
        add_carried([d, c], kernels, factor, [force[1], force[0]], second);
    }
}

impl Alone {
    /// Of what a unit force does to all states; none where it moves none of some pairs.
    fn of(input: &[f64], pairs: &[usize]) -> Option<Self> {
        if input.is_empty() {
            return None;
        }
        let input = [0, 1].map(|i| -> Vec<f64> {
            let states = pairs.iter().map(|r| input[2 * r + i]);
            states.collect()
        });
        let places = (0..2).flat_map(|state| (0..pairs.len()).map(move |place| [state, place]));
        let size = |[state, place]: [usize; 2]| input[state][place].abs();
        let most = places.max_by(|a, b| size(*a).total_cmp(&size(*b)));
        let [state, place] = most.filter(|most| size(*most) > 0.0)?;
        Some(Self {
            input,
            state,
            place,
        })
    }
}

/// Writes sums of columns of this length with the factors of each row, row by row: group by group of lanes, so that sums stay in registers.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn write_sums(rows: &[f64], columns: &[f64], length: usize, to: &mut [f64]) {
    if length == 0 {
        return;
    }
    let factors = columns.len() / length;
    let groups = length / LANES;
    let (columns, _) = columns.as_chunks::<LANES>();
    let (to, _) = to.as_chunks_mut::<LANES>();
    for (row, to) in rows.chunks_exact(factors).zip(to.chunks_exact_mut(groups)) {
        for (group, to) in to.iter_mut().enumerate() {
            let mut sum = [0.0; LANES];
            let own = columns[group..].iter().step_by(groups);
            for (factor, column) in row.iter().zip(own) {
                for l in 0..LANES {
                    sum[l] += factor * column[l];
                }
            }
            *to = sum;
        }
    }
}

/// Adds a multiple of `c x + k (d x + e y)`, of states with the others of their pairs.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_carried(
    [own, other]: [&[f64]; 2],
    [c, k]: [&[f64]; 2],
    factor: f64,
    [x, y]: [&[f64]; 2],
    to: &mut [f64],
) {
    let count = to.len();
    let (own, other) = (&own[..count], &other[..count]);
    let (c, k, x, y) = (&c[..count], &k[..count], &x[..count], &y[..count]);
    for at in 0..count {
        to[at] += factor * (c[at] * x[at] + k[at] * (own[at] * x[at] + other[at] * y[at]));
    }
}
