//! A skeleton with more nodes, and an orbit on it.

use super::Skeleton;
use super::interval::Interval;
use super::placement::{Kink, Placement};
use crate::contact_equation::collocation::nodes::{COUNTS, Nodes};
use crate::contact_equation::linear_part::values::Values;
use crate::system::System;

impl Skeleton {
    /// The same with panels that end at other kinks.
    pub(in crate::contact_equation) fn with(
        &self,
        system: &dyn System,
        values: &Values,
        kinks: Vec<Kink>,
    ) -> Self {
        let placement = Placement {
            kinks,
            ..self.placement.clone()
        };
        Self::new(system, values, placement)
    }

    /// The same with panels that end at other kinks, and with more nodes.
    pub(in crate::contact_equation) fn finer_with(
        &self,
        system: &dyn System,
        values: &Values,
        kinks: Vec<Kink>,
    ) -> Self {
        let mut finer = self.with(system, values, kinks);
        for _ in 0..=self.refined {
            finer = finer.finer();
        }
        finer
    }

    /// Extended unknowns, or changes of them, as those of equations with the same switches and other panels: forces are interpolated at the
    /// same part of the way between two switches.
    pub(in crate::contact_equation) fn rearranged(&self, to: &Self, u: &[f64]) -> Vec<f64> {
        let mut rearranged = u[..self.told()].to_vec();
        rearranged.resize(to.unknowns(), 0.0);
        rearranged.push(u[u.len() - 1]);
        let mut polynomials = Vec::new();
        for panel in &to.intervals {
            let [from, end] = panel.parts();
            for node in 0..panel.nodes.count() {
                let part = from + panel.nodes.targets[node] * (end - from);
                let same = |known: &&Interval| {
                    known.from.from == panel.from.from && part <= known.parts()[1]
                };
                let Some(known) = self.intervals.iter().find(same) else {
                    continue;
                };
                let [first, last] = known.parts();
                let psi = (part - first) / (last - first);
                polynomials.resize(known.nodes.count(), 0.0);
                known
                    .nodes
                    .polynomials(psi.clamp(0.0, 1.0), &mut polynomials);
                for (of, at) in known.active.iter().zip(&panel.active) {
                    let forces = &u[of.first..][..polynomials.len()];
                    let force = polynomials.iter().zip(forces).map(|(l, f)| l * f).sum();
                    rearranged[at.first + node] = force;
                }
            }
        }
        rearranged
    }

    /// The same with more nodes, and with more panels where those are as many as can be.
    pub(in crate::contact_equation) fn finer(&self) -> Self {
        let most = COUNTS[COUNTS.len() - 1];
        let mut finer = self.clone();
        finer.forces = 0;
        finer.refined += 1;
        finer.intervals.clear();
        let first = self.order + self.switches.len();
        for interval in &self.intervals {
            let count = interval.nodes.count();
            let next = COUNTS.iter().copied().find(|more| *more > count);
            let parts = if next.is_none() && !interval.active.is_empty() {
                2
            } else {
                1
            };
            for part in 0..parts {
                let [begin, end] = interval.steepness;
                let steepness = [
                    if part == 0 { begin } else { 1 },
                    if part + 1 == parts { end } else { 1 },
                ];
                let nodes = Nodes::graded(next.unwrap_or(most), steepness);
                let mut panel = Interval {
                    steepness,
                    nodes,
                    ends: interval.ends.filter(|_| part + 1 == parts),
                    ..interval.clone()
                };
                if parts == 2 {
                    let middle = interval.middle();
                    if part == 0 {
                        panel.to = middle;
                    } else {
                        panel.from = middle;
                    }
                }
                for active in &mut panel.active {
                    active.first = first + finer.forces;
                    finer.forces += nodes.count();
                }
                finer.intervals.push(panel);
            }
        }
        finer
    }

    /// Extended unknowns as those of a finer skeleton: forces are interpolated.
    pub(in crate::contact_equation) fn interpolated(&self, finer: &Self, u: &[f64]) -> Vec<f64> {
        let mut to = u[..self.told()].to_vec();
        to.resize(finer.unknowns(), 0.0);
        to.push(u[u.len() - 1]);
        let parts = |interval: &Interval| {
            let most = COUNTS[COUNTS.len() - 1];
            if interval.nodes.count() == most && !interval.active.is_empty() {
                2
            } else {
                1
            }
        };
        let mut panels = finer.intervals.iter();
        for interval in &self.intervals {
            let parts = parts(interval);
            let n = interval.nodes.count();
            for (part, panel) in panels.by_ref().take(parts).enumerate() {
                let of_panel = |part: usize| {
                    let mut matrix = vec![0.0; panel.nodes.count() * n];
                    let rows = matrix.chunks_exact_mut(n);
                    for (row, target) in rows.zip(&panel.nodes.targets) {
                        let psi = (part as f64 + target) / parts as f64;
                        interval.nodes.forces(psi, row);
                    }
                    matrix
                };
                let made;
                let matrix = if interval.active.is_empty() {
                    continue;
                } else if parts == 1 {
                    interval.nodes.at_next(panel.nodes)
                } else {
                    made = of_panel(part);
                    &made
                };
                for (of, at) in interval.active.iter().zip(&panel.active) {
                    let forces = &u[of.first..][..n];
                    let to = to[at.first..].iter_mut();
                    for (to, row) in to.zip(matrix.chunks_exact(n)) {
                        *to = row.iter().zip(forces).map(|(l, f)| l * f).sum();
                    }
                }
            }
        }
        to
    }
}
