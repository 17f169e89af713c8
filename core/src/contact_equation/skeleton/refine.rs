//! A skeleton with more nodes, and an orbit on it.

use super::Skeleton;
use super::interval::{Active, Interval};
use super::placement::{Kink, Placement};
use crate::contact_equation::collocation::nodes::{COUNTS, Nodes};
use crate::contact_equation::linear_part::values::Values;
use crate::system::System;

impl Skeleton {
    /// The same with panels that end at other kinks, and with more nodes.
    pub(in crate::contact_equation) fn finer_with(
        &self,
        system: &dyn System,
        values: &Values,
        kinks: Vec<Kink>,
    ) -> Self {
        let placement = Placement {
            kinks,
            ..self.placement.clone()
        };
        let mut finer = Self::new(system, values, placement);
        for _ in 0..=self.refined {
            finer = finer.finer();
        }
        finer
    }

    /// Extended unknowns, or changes of them, as those of equations with the same switches at these unknowns, and other panels: forces are
    /// interpolated at the phases of nodes.
    pub(in crate::contact_equation) fn rearranged(
        &self,
        to: &Self,
        at: &[f64],
        u: &[f64],
    ) -> Vec<f64> {
        let mut rearranged = u[..self.told()].to_vec();
        rearranged.resize(to.unknowns(), 0.0);
        rearranged.push(u[u.len() - 1]);
        let ends = |skeleton: &Self, interval: &Interval| {
            [interval.from, interval.to].map(|mark| skeleton.place(at, mark).phase)
        };
        let mut polynomials = Vec::new();
        for panel in &to.intervals {
            let [from, end] = ends(to, panel);
            for of in &panel.active {
                for (node, target) in panel.nodes.targets[..panel.nodes.count()]
                    .iter()
                    .enumerate()
                {
                    let phase = from + target * (end - from);
                    let known = self.intervals.iter().flat_map(|interval| {
                        let own = |active: &&Active| active.contact == of.contact;
                        let active = interval.active.iter().find(own)?;
                        let [from, end] = ends(self, interval);
                        let outside = (from - phase).max(phase - end).max(0.0);
                        Some((outside, interval, active, (phase - from) / (end - from)))
                    });
                    let nearest = known.min_by(|a, b| a.0.total_cmp(&b.0));
                    let Some((_, interval, active, psi)) =
                        nearest.filter(|found| found.3.is_finite())
                    else {
                        continue;
                    };
                    polynomials.resize(interval.nodes.count(), 0.0);
                    interval
                        .nodes
                        .polynomials(psi.clamp(0.0, 1.0), &mut polynomials);
                    let forces = &u[active.first..][..polynomials.len()];
                    let force = polynomials.iter().zip(forces).map(|(l, f)| l * f).sum();
                    rearranged[of.first + node] = force;
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
                let grading = interval.nodes.grading;
                let grading = [
                    if part == 0 { grading[0] } else { 1 },
                    if part + 1 == parts { grading[1] } else { 1 },
                ];
                let nodes = Nodes::of(next.unwrap_or(most), grading);
                let mut panel = Interval {
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
                        interval.nodes.polynomials(psi, row);
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
