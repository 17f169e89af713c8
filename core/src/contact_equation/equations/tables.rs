//! What unit forces at the nodes of an interval do to the states up to every target, and kernels that this follows from. They depend on the linear part
//! and the length of the interval in time alone, and are kept as long as these stay: forces are carried over, residuals are followed by derivatives and those of one kind by
//! those of another at the same length.
//!
//! ```text
//! S(t + h) = e^(A h) S(t) + s sum_q w_q e^(A d_q s) l_q                                                       (1)
//! ```
//!
//! is (1) of [`integrals`](super::integrals) for every polynomial `l`, with the coefficients of `I` and of `D` of a pair.
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, chapter 2 (compound rules of Gauss type).

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::integrals::Loaded;
use crate::contact_equation::collocation::nodes::Between;
use crate::contact_equation::linear_part::block::Block;
use crate::contact_equation::linear_part::kernels::Found;

/// Of one interval, or of the last one that was asked for.
#[derive(Debug, Default)]
pub(super) struct Tables {
    nodes: usize,
    /// The interval and its time.
    known: Option<(usize, f64)>,
    /// Per pair: kernels at the points of the rule, and on the ways between targets.
    points: Vec<Found>,
    ways: Vec<Found>,
    /// Tables of the same are known, too.
    filled: bool,
    /// Per pair, row by row of targets, node by node: coefficients of `I` and of `D`.
    once: Vec<f64>,
    twice: Vec<f64>,
}

/// The rule that serves a pair on an interval.
pub(super) fn rule(of: &Loaded<'_>, block: &Block) -> &'static Between {
    of.nodes.rule(place_of_rule(of, block))
}

/// Its place among all.
pub(super) fn place_of_rule(of: &Loaded<'_>, block: &Block) -> usize {
    of.nodes.place_for(block.rate() * of.time.abs())
}

impl Tables {
    /// Room for so many states and nodes.
    pub(super) fn new(order: usize, nodes: usize) -> Self {
        let tables = || vec![0.0; order / 2 * (nodes + 1) * nodes];
        let found = || vec![Found::default(); order / 2];
        Self {
            nodes: 0,
            known: None,
            points: found(),
            ways: found(),
            filled: false,
            once: tables(),
            twice: tables(),
        }
    }

    /// Nothing is known any more: the linear part is another one.
    pub(super) fn forget(&mut self) {
        self.known = None;
    }

    /// Kernels of an interval.
    pub(super) fn find(&mut self, of: &Loaded<'_>) {
        let asked = Some((of.interval, of.time));
        if self.known == asked {
            return;
        }
        self.known = asked;
        self.filled = false;
        self.nodes = of.nodes.count();
        let blocks = of.values.linear.blocks.iter();
        for ((block, points), ways) in blocks.zip(&mut self.points).zip(&mut self.ways) {
            if !block.is_free() {
                points.find(block, &rule(of, block).left, of.time);
                ways.find(block, of.nodes.ways(), of.time);
            }
        }
    }

    /// Tables of an interval whose kernels are known.
    pub(super) fn fill(&mut self, of: &Loaded<'_>) {
        if std::mem::replace(&mut self.filled, true) {
            return;
        }
        let size = (self.nodes + 1) * self.nodes;
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
                self.fill_pair(of, r, block);
            }
        }
    }

    /// (1) for every polynomial.
    fn fill_pair(&mut self, of: &Loaded<'_>, r: usize, block: &Block) {
        let n = self.nodes;
        let size = (n + 1) * n;
        let once = &mut self.once[r * size..][..size];
        let twice = &mut self.twice[r * size..][..size];
        let rule = rule(of, block);
        for way in 0..=n {
            let (done, to) = (way * n, (way + 1) * n);
            if way == 0 {
                once[..n].fill(0.0);
                twice[..n].fill(0.0);
            } else {
                let step = self.ways[r].kernel(way);
                for l in 0..n {
                    let [a, b] = [once[done - n + l], twice[done - n + l]];
                    (once[done + l], twice[done + l]) = block.compose(step, a, b);
                }
            }
            let points = rule.points(way);
            let weighted = &rule.weighted[points.start * n..points.end * n];
            let tables = [&mut once[done..to], &mut twice[done..to]];
            let Found { c, k, .. } = &self.points[r];
            let kernels = [c, k].map(|of| &of[points.clone()]);
            add_kernels(kernels, of.time, weighted, tables);
        }
    }

    /// Both tables of a pair.
    pub(super) fn of_pair(&self, r: usize) -> [&[f64]; 2] {
        let size = (self.nodes + 1) * self.nodes;
        [&self.once, &self.twice].map(|of| &of[r * size..][..size])
    }

    /// Kernels of a pair at the points of its rule.
    pub(super) fn at_points(&self, r: usize) -> &Found {
        &self.points[r]
    }

    /// Its kernels on the ways between targets.
    pub(super) fn on_ways(&self, r: usize) -> &Found {
        &self.ways[r]
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
