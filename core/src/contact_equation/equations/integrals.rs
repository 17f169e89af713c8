//! What the forces at the nodes of an interval do to the states, up to every target, and how that changes with where it begins and ends.
//!
//! Integrals go from target to target, over the ways of a [rule](crate::contact_equation::collocation::nodes::Between) between them:
//!
//! ```text
//! X(t + h) = e^(A h) X(t) + s sum_q w_q e^(A d_q s) f_q                                                       (1)
//! dX(t + h)/ds = e^(A h) (dX(t)/ds + (h / s) A X(t)) + sum_q w_q (1 + d_q s A) e^(A d_q s) f_q                (2)
//! ```
//!
//! with the time `s` of the interval and `h` of the way, and for every point `q` of the rule its weight `w_q` and what is left to the end of
//! the way, `d_q`, as parts of the interval. (2) summed over the ways is the derivative in (3) of [`equations`](crate::contact_equation::equations).
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, chapter 2 (compound rules of Gauss type).

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use std::ops::Range;

use multiversion::multiversion;

use crate::contact_equation::collocation::nodes::Nodes;
use crate::contact_equation::linear_part::block::{Block, Pair, add_both, pair, times};
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::skeleton::interval::Active;

/// Of one interval. Forced states stand state by state, target by target.
#[derive(Debug, Default)]
pub(super) struct Integrals {
    nodes: usize,
    /// Per pair, row by row of targets, node by node: coefficients of `I` and of `D`.
    once: Vec<f64>,
    twice: Vec<f64>,
    /// Per active contact: what a unit force does to the states, state by state, node by node.
    input: Vec<f64>,
    /// What all forces together do to a state, node by node; and, where directions move, how that changes with where the interval begins,
    /// and with where it ends.
    load: [Vec<f64>; 3],
    /// The integrals of these.
    forced: [Vec<f64>; 3],
    /// How the first of them changes with the time.
    by_time: Vec<f64>,
    /// Directions move with the phase.
    moves: bool,
    /// Kernels at the points of the rule.
    kernels: Found,
    /// What the forces do to the states of a pair at the points of the rule.
    at_points: [Vec<f64>; 2],
    /// Sums over nodes for the states of a pair.
    sums: [Vec<f64>; 4],
    row: Vec<f64>,
}

/// An interval whose forces are these.
#[derive(Debug, Clone, Copy)]
pub(super) struct Loaded<'l> {
    pub(in crate::contact_equation) values: &'l Values,
    pub(in crate::contact_equation) nodes: &'static Nodes,
    pub(in crate::contact_equation) active: &'l [Active],
    pub(in crate::contact_equation) phases: [f64; 2],
    pub(in crate::contact_equation) time: f64,
    /// Unknowns, which the forces are some of.
    pub(in crate::contact_equation) u: &'l [f64],
    pub(in crate::contact_equation) derivatives: bool,
}

impl Integrals {
    /// Room for so many states, nodes, and forces.
    pub(in crate::contact_equation) fn new(order: usize, nodes: usize, forces: usize) -> Self {
        let targets = nodes + 1;
        let tables = || vec![0.0; order / 2 * targets * nodes];
        Self {
            nodes: 0,
            once: tables(),
            twice: tables(),
            input: vec![0.0; forces * order],
            load: std::array::from_fn(|_| vec![0.0; nodes * order]),
            forced: std::array::from_fn(|_| vec![0.0; targets * order]),
            by_time: vec![0.0; targets * order],
            moves: false,
            kernels: Found::default(),
            at_points: [Vec::new(), Vec::new()],
            sums: std::array::from_fn(|_| vec![0.0; targets]),
            row: vec![0.0; order],
        }
    }

    fn targets(&self) -> usize {
        self.nodes + 1
    }

    /// Everything of an interval.
    pub(in crate::contact_equation) fn fill(&mut self, of: &Loaded<'_>) {
        self.nodes = of.nodes.count();
        let contacts = of.active.iter();
        self.moves = contacts
            .map(|active| &of.values.contacts[active.contact])
            .any(|contact| !contact.input.is_constant());
        self.loads(of);
        let size = self.targets() * self.nodes;
        for (r, block) in of.values.linear.blocks.iter().enumerate() {
            if block.is_free() {
                let tables = [&mut self.once, &mut self.twice];
                let known = [&of.nodes.once, &of.nodes.twice];
                let factors = [of.time, of.time * of.time];
                for ((table, known), factor) in tables.into_iter().zip(known).zip(factors) {
                    let table = &mut table[r * size..][..size];
                    for (to, of) in table.iter_mut().zip(known) {
                        *to = factor * of;
                    }
                }
            } else {
                self.tables(of, r, block);
            }
            self.fill_forced(of, r, block);
        }
    }

    /// What the forces at the nodes do to the states.
    fn loads(&mut self, of: &Loaded<'_>) {
        let (n, order) = (self.nodes, self.row.len());
        let Self {
            input, load, row, ..
        } = self;
        for load in load.iter_mut() {
            load[..n * order].fill(0.0);
        }
        let [from, to] = of.phases;
        for (place, active) in of.active.iter().enumerate() {
            let contact = &of.values.contacts[active.contact];
            for node in 0..n {
                let psi = of.nodes.targets[node];
                let phase = from + psi * (to - from);
                let input = &mut input[place * n * order..][..n * order];
                contact.input.write(phase, 0, row);
                let force = of.u[active.first + node];
                for (state, by) in row.iter().enumerate() {
                    input[state * n + node] = *by;
                    load[0][state * n + node] += force * by;
                }
                if self.moves {
                    contact.input.write(phase, 1, row);
                    for (state, by) in row.iter().enumerate() {
                        load[1][state * n + node] += (1.0 - psi) * force * by;
                        load[2][state * n + node] += psi * force * by;
                    }
                }
            }
        }
    }

    /// (1) for every polynomial.
    fn tables(&mut self, of: &Loaded<'_>, r: usize, block: &Block) {
        let (n, time) = (self.nodes, of.time);
        let size = self.targets() * n;
        let once = &mut self.once[r * size..][..size];
        let twice = &mut self.twice[r * size..][..size];
        let rule = of.nodes.between(block.rate() * time.abs());
        self.kernels.find(block, &rule.left, time);
        let mut before = 0.0;
        for (way, &psi) in of.nodes.targets.iter().enumerate() {
            let step = block.kernel((psi - before) * time);
            before = psi;
            let (done, to) = (way * n, (way + 1) * n);
            if way == 0 {
                once[..n].fill(0.0);
                twice[..n].fill(0.0);
            } else {
                for l in 0..n {
                    let [a, b] = [once[done - n + l], twice[done - n + l]];
                    (once[done + l], twice[done + l]) = block.compose(step, a, b);
                }
            }
            let points = rule.points(way);
            let weighted = &rule.weighted[points.start * n..points.end * n];
            let tables = [&mut once[done..to], &mut twice[done..to]];
            let kernels = [&self.kernels.c, &self.kernels.k].map(|of| &of[points.clone()]);
            add_kernels(kernels, time, weighted, tables);
        }
    }

    /// The forced states of a pair.
    fn fill_forced(&mut self, of: &Loaded<'_>, r: usize, block: &Block) {
        let (n, targets) = (self.nodes, self.targets());
        let tables = [&self.once, &self.twice].map(|of| &of[r * targets * n..][..targets * n]);
        let d = block.deviation;
        for which in 0..if self.moves { 3 } else { 1 } {
            let loads = [0, 1].map(|i| &self.load[which][(2 * r + i) * n..][..n]);
            let sums = self.sums.each_mut().map(|of| &mut of[..targets]);
            products(tables, loads, sums);
            let [a, b, c, e] = self.sums.each_ref();
            let forced = &mut self.forced[which][2 * r * targets..][..2 * targets];
            for t in 0..targets {
                forced[t] = a[t] + d[0][0] * c[t] + d[0][1] * e[t];
                forced[targets + t] = b[t] + d[1][0] * c[t] + d[1][1] * e[t];
            }
            if which == 0 && of.derivatives && block.is_free() {
                // X f = s S1 f + s^2 D S2 f
                let by_time = &mut self.by_time[2 * r * targets..][..2 * targets];
                let per = 1.0 / of.time;
                for t in 0..targets {
                    by_time[t] = per * (a[t] + 2.0 * (d[0][0] * c[t] + d[0][1] * e[t]));
                    by_time[targets + t] = per * (b[t] + 2.0 * (d[1][0] * c[t] + d[1][1] * e[t]));
                }
            }
        }
        if of.derivatives && !block.is_free() {
            self.by_time(of, r, block);
        }
    }

    /// (2) of a pair, whose kernels are known.
    fn by_time(&mut self, of: &Loaded<'_>, r: usize, block: &Block) {
        let (n, targets, time) = (self.nodes, self.targets(), of.time);
        let rule = of.nodes.between(block.rate() * time.abs());
        for (i, to) in self.at_points.iter_mut().enumerate() {
            to.resize(rule.left.len(), 0.0);
            let load = &self.load[0][(2 * r + i) * n..][..n];
            write_products(&rule.weighted, load, to);
        }
        let (mut integral, mut slope) = ([0.0; 2], [0.0; 2]);
        let mut before = 0.0;
        for (way, &psi) in of.nodes.targets.iter().enumerate() {
            let step = psi - before;
            before = psi;
            let e = block.exponential(step * time);
            let driven = times(block.matrix, integral);
            slope = times(e, [0, 1].map(|i| slope[i] + step * driven[i]));
            integral = times(e, integral);
            for place in rule.points(way) {
                let sum = [self.at_points[0][place], self.at_points[1][place]];
                let left = rule.left[place] * time;
                let carried = block.carried(self.kernels.kernel(place), sum);
                let driven = times(block.matrix, carried);
                for i in 0..2 {
                    integral[i] += time * carried[i];
                    slope[i] += carried[i] + left * driven[i];
                }
            }
            for i in 0..2 {
                self.by_time[(2 * r + i) * targets + way] = slope[i];
            }
        }
    }

    /// What the forces have done to a state, at all targets; or how that changes with where the interval begins, or with where it ends.
    pub(in crate::contact_equation) fn forced(&self, which: usize, state: usize) -> &[f64] {
        &self.forced[which][state * self.targets()..][..self.targets()]
    }

    /// What all forces together do to a state, state by state, node by node.
    pub(in crate::contact_equation) fn load(&self) -> &[f64] {
        &self.load[0][..self.nodes * self.row.len()]
    }

    /// How that changes with the time.
    pub(super) fn driven(&self, state: usize) -> &[f64] {
        &self.by_time[state * self.targets()..][..self.targets()]
    }

    /// Whether directions move.
    pub(in crate::contact_equation) fn moves(&self) -> bool {
        self.moves
    }

    /// Adds the derivatives of what depends like a row on the states of some pairs at a target, by the forces of the interval, contact by
    /// contact. The same row times `D` stands beside it.
    pub(super) fn add_own(
        &self,
        of: &Loaded<'_>,
        pairs: Range<usize>,
        [row, turned]: [&[f64]; 2],
        target: usize,
        entries: &mut [f64],
    ) {
        let (n, order) = (self.nodes, self.row.len());
        let size = self.targets() * n;
        for (place, active) in of.active.iter().enumerate() {
            let moves = !of.values.contacts[active.contact].input.is_constant();
            let entries = &mut entries[place * n..(place + 1) * n];
            for r in pairs.clone() {
                let tables = [&self.once, &self.twice];
                let tables = tables.map(|of| &of[r * size + target * n..][..n]);
                let input = &self.input[(place * order + 2 * r) * n..][..2 * n];
                let input: [&[f64]; 2] = input.split_at(n).into();
                let factors = [row, turned].map(|row| pair(row, r));
                if moves {
                    add_moving(tables, input, factors, entries);
                } else {
                    let [first, second] = input;
                    let through = factors.map(|of| of[0] * first[0] + of[1] * second[0]);
                    add_both(tables, through, entries);
                }
            }
        }
    }
}

/// Adds both tables, each times what a row of two entries sees of the input at the nodes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_moving(
    [once, twice]: [&[f64]; 2],
    [first, second]: [&[f64]; 2],
    [row, turned]: [Pair; 2],
    entries: &mut [f64],
) {
    let tables = once.iter().zip(twice).zip(first.iter().zip(second));
    for (entry, ((once, twice), (a, b))) in entries.iter_mut().zip(tables) {
        *entry += once * (row[0] * a + row[1] * b) + twice * (turned[0] * a + turned[1] * b);
    }
}

/// Adds kernels times weighted polynomials, of some nodes at a time, whose sums are in registers. Nodes are a multiple of four.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_kernels(kernels: [&[f64]; 2], time: f64, weighted: &[f64], [once, twice]: [&mut [f64]; 2]) {
    let nodes = once.len();
    let mut first = 0;
    while first < nodes {
        let tables = [&mut once[first..], &mut twice[first..]];
        first += match nodes - first {
            16.. => add_some::<16>(kernels, time, weighted, nodes, first, tables),
            8.. => add_some::<8>(kernels, time, weighted, nodes, first, tables),
            _ => add_some::<4>(kernels, time, weighted, nodes, first, tables),
        };
    }
}

/// The same of so many nodes from one on. Says how many they are.
#[inline(always)]
fn add_some<const N: usize>(
    [c, k]: [&[f64]; 2],
    time: f64,
    weighted: &[f64],
    nodes: usize,
    first: usize,
    [once, twice]: [&mut [f64]; 2],
) -> usize {
    let tables = (once.first_chunk_mut::<N>(), twice.first_chunk_mut::<N>());
    let (Some(once), Some(twice)) = tables else {
        return N;
    };
    let (mut a, mut b) = (*once, *twice);
    for ((c, k), row) in c.iter().zip(k).zip(weighted.chunks_exact(nodes)) {
        let [c, k] = [c * time, k * time];
        if let Some(weights) = row[first..].first_chunk::<N>() {
            for l in 0..N {
                a[l] += c * weights[l];
                b[l] += k * weights[l];
            }
        }
    }
    (*once, *twice) = (a, b);
    N
}

/// Products of the rows of both tables with both loads: of the first one, then of the second. Nodes are a multiple of four.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn products(tables: [&[f64]; 2], loads: [&[f64]; 2], sums: [&mut [f64]; 4]) {
    let groups = loads[0].len() / 4;
    let [x, y] = loads.map(|load| load.as_chunks::<4>().0);
    let [once, twice] = tables.map(|table| table.as_chunks::<4>().0);
    let (x, y) = (&x[..groups], &y[..groups]);
    for t in 0..sums[0].len() {
        let (once, twice) = (
            &once[t * groups..][..groups],
            &twice[t * groups..][..groups],
        );
        let (mut a, mut b, mut c, mut d) = ([0.0; 4], [0.0; 4], [0.0; 4], [0.0; 4]);
        for g in 0..groups {
            for l in 0..4 {
                a[l] += once[g][l] * x[g][l];
                b[l] += once[g][l] * y[g][l];
                c[l] += twice[g][l] * x[g][l];
                d[l] += twice[g][l] * y[g][l];
            }
        }
        sums[0][t] = (a[0] + a[2]) + (a[1] + a[3]);
        sums[1][t] = (b[0] + b[2]) + (b[1] + b[3]);
        sums[2][t] = (c[0] + c[2]) + (c[1] + c[3]);
        sums[3][t] = (d[0] + d[2]) + (d[1] + d[3]);
    }
}

/// Writes the products of rows with a load, row by row. Nodes are a multiple of four.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn write_products(rows: &[f64], load: &[f64], to: &mut [f64]) {
    let groups = load.as_chunks::<4>().0;
    for (row, to) in rows.chunks_exact(load.len()).zip(to) {
        let mut sums = [0.0; 4];
        for (row, load) in row.as_chunks::<4>().0.iter().zip(groups) {
            for l in 0..4 {
                sums[l] += row[l] * load[l];
            }
        }
        *to = (sums[0] + sums[2]) + (sums[1] + sums[3]);
    }
}
