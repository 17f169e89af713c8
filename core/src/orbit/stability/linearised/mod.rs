//! The equation of motion linearised about an orbit, at the nodes of one panel after the other.
//!
//! Perturbations of an orbit of the system (1) of [`system`](crate::system) obey, with phase derivatives and the state
//! `(q, dq/dtau)`,
//!
//! ```text
//! Y' = [        0                   I       ]
//!      [ -M^-1 S / Omega^2   -M^-1 T / Omega ] Y                                                             (1)
//! S = K + sum_c e_c (phi_g d_c + phi_r dd_c/dt),    T = C + sum_c e_c phi_r d_c                              (2)
//! ```
//!
//! What is constant in (2) is put together once for an orbit, and each contact adds a product of a column and a row.

mod nodes;
mod pair;

use nodes::Nodes;
use pair::{Pair, wave_at};

use super::orbit::Orbit;
use super::path::{Cut, Event, Path};
use crate::law::{On, Variation};
use crate::laws::generic::scales::Sight;
use crate::laws::single;
use crate::model::layout::{Entry, add_constant};
use crate::numeric::fourier::grading::Grading;
use crate::numeric::fourier::series;

/// The matrix of (1) along one orbit; written column by column.
#[derive(Debug, Default)]
pub(super) struct Linearised {
    coordinates: usize,
    base: f64,
    period: usize,
    /// Row by row.
    inverse_mass: Vec<f64>,
    /// The constant part of (1), column by column.
    constant: Vec<f64>,
    /// Entries of the stiffness that vary by themselves, with their coefficients over `Omega^2`.
    varying: Vec<(Entry, f64)>,
    contacts: Vec<Pair>,
    nodes: Nodes,
    /// Of a system of one coordinate in which nothing varies but slopes: `S / (M Omega^2)` and `T / (M Omega)` at the nodes.
    single: bool,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// What [`Linearised::look`] says.
    sight: Option<Sight>,
}

/// Difference of phases that are the same but for rounding.
const SAME: f64 = 1e-12;

/// A panel, and how it is to be integrated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) grading: Grading,
    pub(super) steps: usize,
}

impl Linearised {
    /// Takes an orbit. False if its mass matrix is singular.
    pub(super) fn load(&mut self, orbit: &Orbit<'_>) -> bool {
        let n = orbit.layout.coordinates;
        (self.coordinates, self.base, self.period) = (n, orbit.base, orbit.period);
        if !self.invert_mass(orbit) {
            return false;
        }
        self.constant.clear();
        self.constant.resize(4 * n * n, 0.0);
        self.varying.clear();
        for i in 0..n {
            self.constant[(n + i) * 2 * n + i] = 1.0;
        }
        let square = orbit.base * orbit.base;
        for entry in &orbit.layout.stiffness {
            let value = orbit.coefficients[entry.coefficient] / square;
            if entry.wave.harmonic == 0 {
                self.subtract(entry.row, entry.column, value);
            } else {
                self.varying.push((*entry, value));
            }
        }
        for entry in &orbit.layout.damping {
            let value = orbit.coefficients[entry.coefficient] / orbit.base;
            self.subtract(entry.row, n + entry.column, value);
        }
        self.contacts
            .resize_with(orbit.layout.contacts.len(), Pair::default);
        let Self {
            contacts,
            inverse_mass,
            period,
            ..
        } = self;
        for (pair, layout) in contacts.iter_mut().zip(&orbit.layout.contacts) {
            let mut waves = layout.force.iter().chain(&layout.gap);
            pair.fixed = waves.all(|term| term.wave.harmonic == 0);
            pair.turn_to(layout, orbit, *period, inverse_mass, 0.0);
        }
        self.single =
            n == 1 && self.varying.is_empty() && self.contacts.iter().all(|pair| pair.fixed);
        true
    }

    fn invert_mass(&mut self, orbit: &Orbit<'_>) -> bool {
        let n = orbit.layout.coordinates;
        self.inverse_mass.clear();
        if n == 1 {
            let mut mass = [0.0];
            add_constant(&orbit.layout.mass, orbit.coefficients, n, &mut mass);
            self.inverse_mass.push(1.0 / mass[0]);
            return mass != [0.0];
        }
        let mass = orbit.layout.mass(orbit.coefficients);
        let Some(inverse) = mass.try_inverse() else {
            return false;
        };
        self.inverse_mass
            .extend_from_slice(inverse.transpose().as_slice());
        true
    }

    /// Subtracts `M^-1` times a force `value` on equation `row` from a column of the constant part.
    fn subtract(&mut self, row: usize, column: usize, value: f64) {
        let n = self.coordinates;
        for i in 0..n {
            self.constant[column * 2 * n + n + i] -= self.inverse_mass[i * n + row] * value;
        }
    }

    /// Whether (1) is the same everywhere on the pieces that the contacts are on.
    pub(super) fn is_constant(&self, orbit: &Orbit<'_>, path: &Path) -> bool {
        let contacts = self.contacts.iter().zip(&path.contacts);
        let mut contacts = contacts.zip(&orbit.layout.contacts);
        self.varying.is_empty()
            && contacts.all(|((pair, contact), layout)| {
                let facts = &orbit.system.law(layout.law).facts().pieces[contact.piece];
                let either = [facts.by_gap, facts.by_rate];
                either == [Variation::Zero; 2]
                    || pair.fixed && !either.contains(&Variation::Varying)
            })
    }

    /// Evaluates the slopes of a constant panel. Returns how many evaluations that took.
    pub(super) fn evaluate_constant(&mut self, orbit: &Orbit<'_>, path: &Path) -> usize {
        let mut count = 0;
        let contacts = self.contacts.iter_mut().zip(&path.contacts);
        for ((pair, contact), layout) in contacts.zip(&orbit.layout.contacts) {
            count += usize::from(pair.evaluate_once(orbit, contact, layout));
        }
        count
    }

    /// The worst that nodes saw of laws since this was asked last; `None` if none of them may be sharp.
    pub(super) fn look(&mut self) -> Option<Sight> {
        self.sight.take()
    }

    /// Puts nodes on a panel and evaluates the slopes there. Returns how many evaluations that took.
    pub(super) fn evaluate(
        &mut self,
        orbit: &Orbit<'_>,
        path: &Path,
        panel: &Panel,
        ends: [&[Cut]; 2],
    ) -> usize {
        self.nodes.place(panel);
        let mut count = 0;
        for (index, pair) in self.contacts.iter_mut().enumerate() {
            let (contact, layout) = (&path.contacts[index], &orbit.layout.contacts[index]);
            let facts = &orbit.system.law(layout.law).facts().pieces[contact.piece];
            if ![facts.by_gap, facts.by_rate].contains(&Variation::Varying) {
                count += usize::from(pair.evaluate_once(orbit, contact, layout));
                let (by_gap, by_rate) = (pair.by_gap[0], pair.by_rate[0]);
                pair.by_gap.clear();
                pair.by_gap.resize(self.nodes.gap.len(), by_gap);
                pair.by_rate.clear();
                pair.by_rate.resize(self.nodes.gap.len(), by_rate);
                continue;
            }
            // Its own cut at the very end, where another may switch as well.
            let [start, end] = ends;
            let own = |cuts: &[Cut], edge: Option<&Cut>| {
                let here = |cut: &&Cut| {
                    let apart = edge.map_or(f64::INFINITY, |edge| (cut.tau - edge.tau).abs());
                    cut.contact == index && apart < SAME
                };
                cuts.iter().find(here).copied()
            };
            let ends = [own(start, start.last()), own(end, end.first())];
            self.nodes.motion(contact, panel, ends);
            let sight = pair.evaluate(orbit, contact, layout, &mut self.nodes);
            self.sight = self.sight.max(sight);
            count += self.nodes.taus.len();
        }
        if self.single {
            self.line_up();
        }
        count
    }

    /// Adds up the slopes of a system of one coordinate.
    fn line_up(&mut self) {
        let count = self.nodes.gap.len();
        for (sums, constant) in [
            (&mut self.stiffness, -self.constant[1]),
            (&mut self.damping, -self.constant[3]),
        ] {
            sums.clear();
            sums.resize(count, constant);
        }
        for pair in self.contacts.iter().filter(|pair| pair.present) {
            let gain = pair.push[0] * pair.pull[0] / self.base;
            for (sum, slope) in self.stiffness.iter_mut().zip(&pair.by_gap) {
                *sum += gain / self.base * slope;
            }
            for (sum, slope) in self.damping.iter_mut().zip(&pair.by_rate) {
                *sum += gain * slope;
            }
        }
    }

    /// Writes the matrix of (1) on a constant panel, times a factor.
    pub(super) fn constant_matrix(&self, factor: f64, matrix: &mut [f64]) {
        self.write(0, factor, matrix);
    }

    /// Writes the matrix of (1) at a node, times the width of the step there.
    pub(super) fn matrix(&mut self, orbit: &Orbit<'_>, node: usize, matrix: &mut [f64]) {
        let (tau, factor) = (self.nodes.taus[node], self.nodes.weights[node]);
        if self.single {
            matrix[0] = 0.0;
            matrix[1] = -factor * self.stiffness[node];
            matrix[2] = factor;
            matrix[3] = -factor * self.damping[node];
            return;
        }
        let Self {
            contacts,
            inverse_mass,
            period,
            ..
        } = &mut *self;
        for (pair, layout) in contacts.iter_mut().zip(&orbit.layout.contacts) {
            if !pair.fixed && pair.present {
                pair.turn_to(layout, orbit, *period, inverse_mass, tau);
            }
        }
        self.write(node, factor, matrix);
        let n = self.coordinates;
        for (entry, value) in &self.varying {
            let value = factor * value * wave_at(entry.wave, self.period, tau);
            for i in 0..n {
                matrix[entry.column * 2 * n + n + i] -=
                    self.inverse_mass[i * n + entry.row] * value;
            }
        }
    }

    fn write(&self, node: usize, factor: f64, matrix: &mut [f64]) {
        let n = self.coordinates;
        for (to, from) in matrix.iter_mut().zip(&self.constant) {
            *to = factor * from;
        }
        let factor = factor / self.base;
        for pair in self.contacts.iter().filter(|pair| pair.present) {
            let (by_gap, by_rate) = (pair.by_gap[node], pair.by_rate[node]);
            for j in 0..n {
                let stiffness = by_gap * pair.pull[j] / self.base + by_rate * pair.turn[j];
                let damping = by_rate * pair.pull[j];
                if stiffness == 0.0 && damping == 0.0 {
                    continue;
                }
                for (i, push) in pair.push.iter().enumerate() {
                    matrix[j * 2 * n + n + i] -= factor * push * stiffness;
                    matrix[(n + j) * 2 * n + n + i] -= factor * push * damping;
                }
            }
        }
    }

    /// Multiplies by the matrix of a switch (saltation): where the force jumps by `[phi]` in the course of time,
    ///
    /// ```text
    /// I - [ 0 ; M^-1 e_c [phi] / (Omega g') ] [ d_c^T  0 ]
    /// ```
    ///
    /// where `g'` is the rate of the gap: positive or negative, but the same on both sides.
    ///
    /// Source: Leine and Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7.
    pub(super) fn jump(
        &mut self,
        orbit: &Orbit<'_>,
        path: &Path,
        cut: &Cut,
        matrices: [&mut [f64]; 2],
    ) {
        let layout = &orbit.layout.contacts[cut.contact];
        let law = orbit.system.law(layout.law);
        let facts = law.facts().levels[cut.level];
        if cut.event == Event::Near || !(facts.force_jumps || facts.by_rate_jumps) {
            return;
        }
        let contact = &path.contacts[cut.contact];
        let rate = series::value(&contact.rate, cut.tau);
        let at = [contact.levels[cut.level], rate];
        let force = |piece| single::force(law, On::Piece(piece), &contact.arguments, at);
        let jump = force(cut.level + 1) - force(cut.level);
        let weight = jump / (self.base * rate.abs());
        if !weight.is_finite() || jump == 0.0 {
            return;
        }
        let pair = &mut self.contacts[cut.contact];
        if !pair.fixed {
            pair.turn_to(layout, orbit, self.period, &self.inverse_mass, cut.tau);
        }
        let n = self.coordinates;
        for matrix in matrices {
            for column in matrix.chunks_exact_mut(2 * n) {
                let (above, below) = column.split_at_mut(n);
                let pulled: f64 = pair.pull.iter().zip(above).map(|(d, x)| d * *x).sum();
                for (x, push) in below.iter_mut().zip(&pair.push) {
                    *x -= push * weight * pulled;
                }
            }
        }
    }
}
