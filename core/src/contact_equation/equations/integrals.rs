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
//! What unit forces do stands in [`tables`](super::tables), where derivatives are asked for.
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, chapter 2 (compound rules of Gauss type).

use std::ops::Range;

use multiversion::multiversion;

use super::tables::{Tables, place_of_rule};
use crate::contact_equation::collocation::nodes::{Nodes, RULES};
use crate::contact_equation::linear_part::block::{Block, Pair, add, add_both, pair, times};
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::skeleton::interval::Active;

/// Of one interval. Forced states stand state by state, target by target.
#[derive(Debug, Default)]
pub(super) struct Integrals {
    nodes: usize,
    tables: Tables,
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
    /// The forces at the points of every rule, contact by contact, if they are known.
    forces: [Vec<f64>; RULES],
    /// What the forces do to a state at the points of its rule, and sums of that over each way.
    at_points: Vec<f64>,
    on_ways: [Vec<[f64; 4]>; 2],
    /// Sums over nodes for the states of a pair.
    sums: [Vec<f64>; 4],
    row: Vec<f64>,
}

/// An interval whose forces are these.
#[derive(Debug, Clone, Copy)]
pub(super) struct Loaded<'l> {
    /// Which one it is.
    pub(super) interval: usize,
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
        Self {
            nodes: 0,
            tables: Tables::new(order, nodes),
            input: vec![0.0; forces * order],
            load: std::array::from_fn(|_| vec![0.0; nodes * order]),
            forced: std::array::from_fn(|_| vec![0.0; targets * order]),
            by_time: vec![0.0; targets * order],
            moves: false,
            forces: Default::default(),
            at_points: Vec::new(),
            on_ways: std::array::from_fn(|_| vec![[0.0; 4]; targets]),
            sums: std::array::from_fn(|_| vec![0.0; targets]),
            row: vec![0.0; order],
        }
    }

    /// The linear part is another one.
    pub(super) fn forget(&mut self) {
        self.tables.forget();
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
        self.tables.find(of);
        if of.derivatives {
            self.tables.fill(of);
        }
        for forces in &mut self.forces {
            forces.clear();
        }
        for (r, block) in of.values.linear.blocks.iter().enumerate() {
            if block.is_free() {
                self.fill_free(of, r, block);
            } else {
                self.follow(of, r, block);
            }
            if self.moves && of.derivatives {
                self.fill_moving(r, block);
            }
        }
    }

    /// What the forces at the nodes do to the states.
    fn loads(&mut self, of: &Loaded<'_>) {
        let (n, order) = (self.nodes, self.row.len());
        let Self {
            input, load, row, ..
        } = self;
        let loads = if self.moves { 3 } else { 1 };
        for load in &mut load[..loads] {
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

    /// The forced states of a pair that nothing holds, and how they change with the time: with (2) of [nodes](Nodes),
    ///
    /// ```text
    /// X f = s S1 f + s^2 D S2 f                                                                               (3)
    /// ```
    fn fill_free(&mut self, of: &Loaded<'_>, r: usize, block: &Block) {
        let (n, targets, time) = (self.nodes, self.targets(), of.time);
        let loads = [0, 1].map(|i| &self.load[0][(2 * r + i) * n..][..n]);
        let sums = self.sums.each_mut().map(|of| &mut of[..targets]);
        products([&of.nodes.once, &of.nodes.twice], loads, sums);
        let [a, b, c, e] = self.sums.each_ref();
        let d = block.deviation;
        let forced = &mut self.forced[0][2 * r * targets..][..2 * targets];
        let by_time = &mut self.by_time[2 * r * targets..][..2 * targets];
        for t in 0..targets {
            for (i, once) in [a[t], b[t]].into_iter().enumerate() {
                let twice = time * (d[i][0] * c[t] + d[i][1] * e[t]);
                forced[i * targets + t] = time * (once + twice);
                by_time[i * targets + t] = once + 2.0 * twice;
            }
        }
    }

    /// How the forced states of a pair change with where the interval begins, and with where it ends, as far as directions move.
    fn fill_moving(&mut self, r: usize, block: &Block) {
        let (n, targets) = (self.nodes, self.targets());
        let d = block.deviation;
        for which in 1..3 {
            let loads = [0, 1].map(|i| &self.load[which][(2 * r + i) * n..][..n]);
            let sums = self.sums.each_mut().map(|of| &mut of[..targets]);
            products(self.tables.of_pair(r), loads, sums);
            let [a, b, c, e] = self.sums.each_ref();
            let forced = &mut self.forced[which][2 * r * targets..][..2 * targets];
            for t in 0..targets {
                forced[t] = a[t] + d[0][0] * c[t] + d[0][1] * e[t];
                forced[targets + t] = b[t] + d[1][0] * c[t] + d[1][1] * e[t];
            }
        }
    }

    /// (1) and (2) of a pair, whose kernels are known.
    fn follow(&mut self, of: &Loaded<'_>, r: usize, block: &Block) {
        let (targets, time) = (self.targets(), of.time);
        let place = place_of_rule(of, block);
        let rule = of.nodes.rule(place);
        for i in 0..2 {
            let acts = self.write_at_points(of, place, 2 * r + i);
            let sums = &mut self.on_ways[i][..targets];
            if acts {
                let Found { c, k, .. } = self.tables.at_points(r);
                write_sums(&rule.starts, [c, k, &rule.left], &self.at_points, sums);
            } else {
                sums.fill([0.0; 4]);
            }
        }
        let (mut integral, mut slope) = ([0.0; 2], [0.0; 2]);
        let (d, ways) = (block.deviation, self.tables.on_ways(r));
        for (way, step) in of.nodes.ways().iter().enumerate() {
            let [x, y] = self.on_ways.each_ref().map(|of| of[way]);
            let through = times(d, [x[1], y[1]]);
            let carried = [x[0] + through[0], y[0] + through[1]];
            let e = block.exponential_of(ways.kernel(way));
            if of.derivatives {
                let driven = times(block.matrix, integral);
                let through = times(d, [x[3], y[3]]);
                let left = times(block.matrix, [x[2] + through[0], y[2] + through[1]]);
                slope = times(e, [0, 1].map(|i| slope[i] + step * driven[i]));
                slope = [0, 1].map(|i| slope[i] + carried[i] + time * left[i]);
            }
            integral = times(e, integral);
            integral = [0, 1].map(|i| integral[i] + time * carried[i]);
            for i in 0..2 {
                let at = (2 * r + i) * targets + way;
                self.forced[0][at] = integral[i];
                self.by_time[at] = slope[i];
            }
        }
    }

    /// Writes what forces do to a state at the points of a rule, with their weights. Says whether they do anything. Where directions do not move that is
    /// what each force is there, once for all states, times what it does.
    fn write_at_points(&mut self, of: &Loaded<'_>, rule_place: usize, state: usize) -> bool {
        let (n, order) = (self.nodes, self.row.len());
        let rule = of.nodes.rule(rule_place);
        let count = rule.left.len();
        self.at_points.resize(count, 0.0);
        if self.moves {
            let load = &self.load[0][state * n..][..n];
            write_products(&rule.weighted, load, &mut self.at_points);
            return true;
        }
        let forces = &mut self.forces[rule_place];
        if forces.is_empty() {
            forces.resize(of.active.len() * count, 0.0);
            for (active, to) in of.active.iter().zip(forces.chunks_exact_mut(count)) {
                let load = &of.u[active.first..][..n];
                write_products(&rule.weighted, load, to);
            }
        }
        let mut acts = false;
        for (place, forces) in forces.chunks_exact(count).enumerate() {
            let by = self.input[(place * order + state) * n];
            if by == 0.0 {
                continue;
            }
            if acts {
                add(&mut self.at_points, by, forces);
            } else {
                for (to, force) in self.at_points.iter_mut().zip(forces) {
                    *to = by * force;
                }
            }
            acts = true;
        }
        acts
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
        for (place, active) in of.active.iter().enumerate() {
            let moves = !of.values.contacts[active.contact].input.is_constant();
            let entries = &mut entries[place * n..(place + 1) * n];
            for r in pairs.clone() {
                let tables = self.tables.of_pair(r);
                let tables = tables.map(|of| &of[target * n..][..n]);
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

/// Writes sums over the points of every way, of values times kernels, and times what is left, too.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn write_sums(starts: &[usize], [c, k, left]: [&[f64]; 3], values: &[f64], to: &mut [[f64; 4]]) {
    for (ends, to) in starts.windows(2).zip(to) {
        let way = ends[0]..ends[1];
        let [c, k, left, x] = [c, k, left, values].map(|of| of[way.clone()].as_chunks::<2>());
        // Points are an even number.
        let mut sums = [[0.0; 2]; 4];
        let points = c.0.iter().zip(k.0).zip(left.0).zip(x.0);
        for (((c, k), left), x) in points {
            for l in 0..2 {
                let [c, k] = [c[l] * x[l], k[l] * x[l]];
                sums[0][l] += c;
                sums[1][l] += k;
                sums[2][l] += left[l] * c;
                sums[3][l] += left[l] * k;
            }
        }
        *to = sums.map(|sum| sum[0] + sum[1]);
    }
}
