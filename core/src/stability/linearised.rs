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

use nalgebra::DMatrix;

use super::magnus;
use super::orbit::Orbit;
use super::path::{Contact, Cut, Event, Path};
use crate::fourier::grading::Grading;
use crate::fourier::kernels::{evaluate, padded};
use crate::fourier::phases::sines_and_cosines;
use crate::fourier::series;
use crate::law::{Derivatives, On, Variation};
use crate::layout::{ContactLayout, Entry, Term};
use crate::system::{Part, Wave};

/// Within this phase of the highest harmonic, four terms of Taylor's series give the gap to rounding.
const NEAR: f64 = 1e-3;

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
}

/// Phases no farther from each other than this are the same but for rounding.
const SAME: f64 = 1e-12;

/// The column `M^-1 e` and the row `d` of a contact, with its slopes at the nodes.
#[derive(Debug, Default)]
struct Pair {
    /// Neither direction varies.
    fixed: bool,
    push: Vec<f64>,
    pull: Vec<f64>,
    /// `dd/dtau`
    turn: Vec<f64>,
    by_gap: Vec<f64>,
    by_rate: Vec<f64>,
    /// The slopes are not all zero on this panel.
    present: bool,
}

/// The nodes of one panel: three for each step.
#[derive(Debug, Default)]
struct Nodes {
    rules: Vec<Rule>,
    cosines: Vec<f64>,
    sines: Vec<f64>,
    taus: Vec<f64>,
    /// Phases from the start of the panel, or from its end and negative.
    offsets: Vec<f64>,
    /// Width of a step times the slope of the grading.
    weights: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    force: Vec<f64>,
}

/// Graded nodes on `[0, 1]`, kept for the next panel that wants them.
#[derive(Debug)]
struct Rule {
    grading: Grading,
    steps: usize,
    /// Distance from the start, or from the end and negative.
    distances: Vec<f64>,
    /// Slope of the map over the number of steps.
    slopes: Vec<f64>,
}

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
        let coefficient = |entry: &Entry| orbit.coefficients[entry.coefficient];
        self.inverse_mass.clear();
        if n == 1 {
            let mass: f64 = orbit.layout.mass.iter().map(coefficient).sum();
            self.inverse_mass.push(1.0 / mass);
            return mass != 0.0;
        }
        let mut mass = DMatrix::zeros(n, n);
        for entry in &orbit.layout.mass {
            mass[(entry.row, entry.column)] += coefficient(entry);
        }
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
            pair.evaluate(orbit, contact, layout, &mut self.nodes);
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
        let level = [contact.levels[cut.level]];
        let force = |piece| {
            let mut force = [0.0];
            let on = On::Piece(piece);
            law.force(on, &contact.arguments, &level, &[rate], &mut force);
            force[0]
        };
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

impl Pair {
    /// The directions at a phase.
    fn turn_to(
        &mut self,
        layout: &ContactLayout,
        orbit: &Orbit<'_>,
        period: usize,
        inverse_mass: &[f64],
        tau: f64,
    ) {
        let n = orbit.layout.coordinates;
        for vector in [&mut self.push, &mut self.pull, &mut self.turn] {
            vector.clear();
            vector.resize(n, 0.0);
        }
        let value = |term: &Term| orbit.coefficients[term.coefficient];
        for term in &layout.force {
            let value = value(term) * wave_at(term.wave, period, tau);
            for (i, push) in self.push.iter_mut().enumerate() {
                *push += inverse_mass[i * n + term.index] * value;
            }
        }
        for term in &layout.gap {
            self.pull[term.index] += value(term) * wave_at(term.wave, period, tau);
            self.turn[term.index] += value(term) * slope_at(term.wave, period, tau);
        }
    }

    /// The slopes of a piece on which they are constant, at any gap of it. Returns whether that took an evaluation.
    fn evaluate_once(
        &mut self,
        orbit: &Orbit<'_>,
        contact: &Contact,
        layout: &ContactLayout,
    ) -> bool {
        let law = orbit.system.law(layout.law);
        let facts = &law.facts().pieces[contact.piece];
        for slopes in [&mut self.by_gap, &mut self.by_rate] {
            slopes.clear();
            slopes.push(0.0);
        }
        self.present = [facts.by_gap, facts.by_rate] != [Variation::Zero; 2];
        if !self.present {
            return false;
        }
        let below = contact
            .piece
            .checked_sub(1)
            .map(|index| contact.levels[index]);
        let above = contact.levels.get(contact.piece).copied();
        let gap = match (below, above) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (Some(a), None) => a + a.abs().max(1.0),
            (None, Some(b)) => b - b.abs().max(1.0),
            (None, None) => 0.0,
        };
        let mut force = [0.0];
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let on = On::Piece(contact.piece);
        law.derivatives(on, &contact.arguments, &[gap], &[0.0], out);
        true
    }

    /// The slopes at the nodes.
    fn evaluate(
        &mut self,
        orbit: &Orbit<'_>,
        contact: &Contact,
        layout: &ContactLayout,
        nodes: &mut Nodes,
    ) {
        self.present = true;
        self.by_gap.resize(nodes.gap.len(), 0.0);
        self.by_rate.resize(nodes.gap.len(), 0.0);
        let out = Derivatives {
            force: &mut nodes.force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let law = orbit.system.law(layout.law);
        let on = On::Piece(contact.piece);
        law.derivatives(on, &contact.arguments, &nodes.gap, &nodes.rate, out);
    }
}

impl Nodes {
    /// Puts three nodes into every step of a panel.
    fn place(&mut self, panel: &Panel) {
        let rule = self.rule(panel);
        let rule = &self.rules[rule];
        let count = rule.distances.len();
        let filled = padded(count);
        for room in [
            &mut self.cosines,
            &mut self.sines,
            &mut self.gap,
            &mut self.rate,
            &mut self.force,
        ] {
            room.resize(filled, 0.0);
        }
        let width = panel.end - panel.start;
        self.taus.clear();
        self.offsets.clear();
        self.weights.clear();
        self.offsets
            .extend(rule.distances.iter().map(|distance| width * distance));
        self.weights
            .extend(rule.slopes.iter().map(|slope| width * slope));
        self.taus.extend(self.offsets.iter().map(|&offset| {
            let from_end = offset.is_sign_negative();
            offset + if from_end { panel.end } else { panel.start }
        }));
        // Nodes that only fill the last group stand where the last one stands.
        self.taus.resize(filled, self.taus[count - 1]);
        sines_and_cosines(&self.taus, &mut self.sines, &mut self.cosines);
        self.taus.truncate(count);
    }

    fn rule(&mut self, panel: &Panel) -> usize {
        let Panel { grading, steps, .. } = *panel;
        let known = self
            .rules
            .iter()
            .position(|rule| rule.grading == grading && rule.steps == steps);
        known.unwrap_or_else(|| {
            let h = 1.0 / steps as f64;
            let mut rule = Rule {
                grading,
                steps,
                distances: Vec::with_capacity(3 * steps),
                slopes: Vec::with_capacity(3 * steps),
            };
            for step in 0..steps {
                for node in magnus::NODES {
                    let (distance, slope, from_start) = grading.distance((step as f64 + node) * h);
                    rule.distances
                        .push(if from_start { distance } else { -distance });
                    rule.slopes.push(slope * h);
                }
            }
            self.rules.push(rule);
            self.rules.len() - 1
        })
    }

    /// Gap and rate of a contact at the nodes. Close to an end where the gap is on a level and the slopes are singular, the gap
    /// is taken from its Taylor polynomial there: a small distance from the level keeps all its digits then.
    fn motion(&mut self, contact: &Contact, panel: &Panel, ends: [Option<Cut>; 2]) {
        evaluate(
            [&contact.gap, &contact.rate],
            &self.cosines,
            &self.sines,
            &mut self.gap,
            &mut self.rate,
        );
        let near = NEAR / series::harmonics(&contact.gap).max(1) as f64;
        let powers = [panel.grading.start, panel.grading.end];
        let phases = [panel.start, panel.end];
        for end in 0..2 {
            let Some(cut) = ends[end].filter(|cut| cut.event != Event::Near && powers[end] > 1)
            else {
                continue;
            };
            let taylor = taylor(&contact.gap, phases[end]);
            let level = contact.levels[cut.level];
            for (&distance, gap) in self.offsets.iter().zip(&mut self.gap) {
                let of_this_end = distance.is_sign_negative() == (end == 1);
                if of_this_end && distance.abs() < near {
                    let [a, b, c, d] = taylor;
                    *gap = level + distance * (a + distance * (b + distance * (c + distance * d)));
                }
            }
        }
    }
}

/// Derivatives of a series at a phase, from the first to the fourth, each divided by its factorial.
fn taylor(series: &[f64], tau: f64) -> [f64; 4] {
    let (sine, cosine) = tau.sin_cos();
    let (mut c, mut s) = (1.0, 0.0);
    let mut sums = [0.0; 4];
    for (index, pair) in series[1..].chunks_exact(2).enumerate() {
        let k = (index + 1) as f64;
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        let (even, odd) = (pair[0] * c + pair[1] * s, pair[1] * c - pair[0] * s);
        sums[0] += k * odd;
        sums[1] -= k * k * even;
        sums[2] -= k * k * k * odd;
        sums[3] += k * k * k * k * even;
    }
    [sums[0], sums[1] / 2.0, sums[2] / 6.0, sums[3] / 24.0]
}

/// Value of a wave at a phase of the orbit.
fn wave_at(wave: Wave, period: usize, tau: f64) -> f64 {
    if wave.harmonic == 0 {
        return 1.0;
    }
    let angle = f64::from(wave.harmonic) * period as f64 * tau;
    match wave.part {
        Part::Cosine => angle.cos(),
        Part::Sine => angle.sin(),
    }
}

/// Its phase derivative.
fn slope_at(wave: Wave, period: usize, tau: f64) -> f64 {
    if wave.harmonic == 0 {
        return 0.0;
    }
    let (slope, sign) = wave.derivative();
    sign * f64::from(wave.harmonic) * period as f64 * wave_at(slope, period, tau)
}
