//! Signals of a motion at one instant, and their derivatives along any direction: with the state, with a variable, with the phase.
//!
//! With the coefficients `c`, waves `w` of the phase and the base frequency `Omega`, all of which may move by `c'`, `w'` and `Omega'`,
//!
//! ```text
//! g  = sum d w q - sum delta w,          r  = sum d (w v + Omega w_tau q) - sum delta Omega w_tau               (1)
//! f  = phi(g, r; a),                     f' = phi_g g' + phi_r r' + sum_a phi_a a'                              (2)
//! M a = sum l w - C v - K q - sum e f,   M a' = ( sum l w - C v - K q - sum e f )' - M' a                       (3)
//! ```
//!
//! and the derivative of every sum is by the rule of products. Each contact is on a stated piece of its law, so that one-sided limits at
//! switches have derivatives too.

use std::cell::Cell;
use std::sync::Arc;

use nalgebra::DMatrix;

use crate::law::{Derivatives, On, Variation};
use crate::laws::single::Single;
use crate::model::layout::{Entry, Layout, Term};
use crate::system::{Part, Place, Signal, System, Variable, Wave};

/// How far beside a level slopes are taken that are none on it, as a part of the motion over a radian.
const INSIDE: f64 = 1e-10;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Asked {
    Coordinate(usize),
    /// Its derivatives by time.
    Rate(usize),
    Acceleration(usize),
    Output(usize),
    Contact(usize),
    /// The power of the load, `f . v`.
    Power,
}

/// A multiple of something that moves.
#[derive(Debug, Clone, Copy)]
struct Product {
    of: Signal,
    wave: Wave,
    /// One, without a coefficient.
    coefficient: Option<usize>,
}

/// What is known of a contact at these values.
#[derive(Debug, Clone)]
struct Contact {
    arguments: Vec<f64>,
    levels: Vec<f64>,
}

/// Derivatives of all coefficients, and of the base frequency, by one variable.
#[derive(Debug, Clone)]
pub(super) struct By {
    pub(super) coefficients: Vec<f64>,
    pub(super) base: f64,
}

/// A motion at one instant.
#[derive(Debug, Clone)]
pub(super) struct Instant {
    phase: f64,
    state: Vec<f64>,
    pieces: Vec<usize>,
    /// Gap and rate of each contact.
    pub(super) gaps: Vec<[f64; 2]>,
    forces: Vec<Single>,
    pub(super) acceleration: Vec<f64>,
    /// The waves of the system with their derivatives.
    waves: Vec<[f64; 3]>,
    /// Derivatives of forces by arguments, contact by contact, as far as they have been asked for.
    by_arguments: Vec<Cell<Option<f64>>>,
    loads: Vec<f64>,
}

/// Workspace for how forces and accelerations move.
#[derive(Debug, Clone)]
pub(super) struct Moved {
    acceleration: Vec<f64>,
    forces: Vec<f64>,
    loads: Vec<f64>,
}

/// In what direction a derivative is taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Direction<'d> {
    /// How the state moves.
    pub(super) state: &'d [f64],
    /// What moves besides.
    pub(super) by: Option<&'d By>,
    /// How much the phase moves.
    pub(super) phase: f64,
}

/// Signals of a system at values of its parameters and of `omega`.
pub(super) struct Slopes {
    system: Arc<dyn System>,
    layout: Layout,
    values: Vec<f64>,
    omega: f64,
    pub(super) base: f64,
    coefficients: Vec<f64>,
    contacts: Vec<Contact>,
    inverse_mass: DMatrix<f64>,
    mass: Vec<Entry>,
    /// All waves but the constant one, once each.
    waves: Vec<Wave>,
    /// The first of the arguments of each contact among those of all.
    first_argument: Vec<usize>,
    asked: Vec<Asked>,
    sums: Vec<Vec<Product>>,
    /// Whether a sum has an acceleration or a force.
    has_forces: bool,
}

/// A wave at a phase, and its first two derivatives by the phase.
fn wave(wave: Wave, phase: f64) -> [f64; 3] {
    if wave == Wave::CONSTANT {
        return [1.0, 0.0, 0.0];
    }
    let h = f64::from(wave.harmonic);
    let (sine, cosine) = (h * phase).sin_cos();
    let [value, slope] = match wave.part {
        Part::Cosine => [cosine, -sine],
        Part::Sine => [sine, cosine],
    };
    [value, h * slope, -h * h * value]
}

/// A matrix times a vector.
fn times(matrix: &DMatrix<f64>, vector: &[f64], out: &mut [f64]) {
    for (row, out) in out.iter_mut().enumerate() {
        *out = (0..vector.len())
            .map(|j| matrix[(row, j)] * vector[j])
            .sum();
    }
}

impl Slopes {
    pub(super) fn new(system: &Arc<dyn System>, asked: &[Asked]) -> Self {
        let layout = Layout::of(system);
        let contacts = layout.contacts.iter().map(|contact| Contact {
            arguments: vec![0.0; contact.argument_count],
            levels: vec![0.0; system.law(contact.law).facts().levels.len()],
        });
        let n = layout.coordinates;
        let mut slopes = Self {
            values: vec![0.0; system.facts().parameters.len()],
            omega: 1.0,
            base: 1.0,
            coefficients: vec![0.0; layout.coefficients],
            contacts: contacts.collect(),
            inverse_mass: DMatrix::identity(n, n),
            mass: layout.mass.clone(),
            waves: Vec::new(),
            first_argument: Vec::new(),
            asked: asked.to_vec(),
            sums: Vec::new(),
            has_forces: false,
            system: Arc::clone(system),
            layout,
        };
        slopes.sums = asked.iter().map(|&asked| slopes.products(asked)).collect();
        slopes.has_forces = slopes
            .sums
            .iter()
            .flatten()
            .any(|product| matches!(product.of, Signal::Acceleration(_) | Signal::Force(_)));
        slopes.number();
        slopes
    }

    /// Numbers the waves and the arguments of contacts.
    fn number(&mut self) {
        let layout = &self.layout;
        let loads = layout.load.iter().map(|e| e.wave);
        let matrices = layout.stiffness.iter().map(|e| e.wave);
        let of_contacts = layout.contacts.iter().flat_map(|contact| {
            let terms = contact.gap.iter().chain(&contact.offset);
            terms.chain(&contact.force).map(|term| term.wave)
        });
        let of_sums = self.sums.iter().flatten().map(|product| product.wave);
        for wave in loads.chain(matrices).chain(of_contacts).chain(of_sums) {
            if wave != Wave::CONSTANT && !self.waves.contains(&wave) {
                self.waves.push(wave);
            }
        }
        let mut first = 0;
        for contact in &layout.contacts {
            self.first_argument.push(first);
            first += contact.argument_count;
        }
    }

    /// Room for motions at one instant.
    pub(super) fn instant(&self) -> Instant {
        let (n, count) = (self.layout.coordinates, self.contacts.len());
        let arguments = self.layout.contacts.iter().map(|c| c.argument_count).sum();
        Instant {
            phase: 0.0,
            state: vec![0.0; 2 * n],
            pieces: vec![0; count],
            gaps: Vec::with_capacity(count),
            forces: Vec::with_capacity(count),
            acceleration: vec![0.0; n],
            waves: vec![[0.0; 3]; self.waves.len()],
            by_arguments: vec![Cell::new(None); arguments],
            loads: vec![0.0; n],
        }
    }

    /// Room for how forces and accelerations move.
    pub(super) fn moved(&self) -> Moved {
        let (n, count) = (self.layout.coordinates, self.contacts.len());
        Moved {
            acceleration: vec![0.0; n],
            forces: vec![0.0; count],
            loads: vec![0.0; n],
        }
    }

    /// A wave at an instant.
    fn wave(&self, wave: Wave, at: &Instant) -> [f64; 3] {
        if wave == Wave::CONSTANT {
            return [1.0, 0.0, 0.0];
        }
        let known = self.waves.iter().position(|own| *own == wave);
        known.map_or([f64::NAN; 3], |index| at.waves[index])
    }

    fn products(&self, asked: Asked) -> Vec<Product> {
        let once = |of| Product {
            of,
            wave: Wave::CONSTANT,
            coefficient: None,
        };
        match asked {
            Asked::Coordinate(index) => vec![once(Signal::Coordinate(index))],
            Asked::Rate(index) => vec![once(Signal::Rate(index))],
            Asked::Acceleration(index) => vec![once(Signal::Acceleration(index))],
            Asked::Contact(index) => vec![once(Signal::Force(index))],
            Asked::Power => Vec::new(),
            Asked::Output(index) => {
                let places = self.system.facts().places.iter().enumerate();
                let products = places.filter_map(|(coefficient, place)| match *place {
                    Place::Output { output, of, wave } if output == index => Some(Product {
                        of,
                        wave,
                        coefficient: Some(coefficient),
                    }),
                    _ => None,
                });
                products.collect()
            }
        }
    }

    /// Goes over to other values.
    pub(super) fn set(&mut self, values: &[f64], omega: f64) {
        self.values.copy_from_slice(values);
        self.omega = omega;
        self.base = omega / f64::from(self.system.facts().divisor);
        self.system
            .coefficients(values, omega, &mut self.coefficients);
        let n = self.layout.coordinates;
        let mass = self.layout.mass(&self.coefficients);
        self.inverse_mass = mass
            .try_inverse()
            .unwrap_or_else(|| DMatrix::from_element(n, n, f64::NAN));
        for (contact, layout) in self.contacts.iter_mut().zip(&self.layout.contacts) {
            layout.arguments(&self.coefficients, &mut contact.arguments);
            let law = self.system.law(layout.law);
            law.levels(&contact.arguments, &mut contact.levels);
        }
    }

    /// Which of the signals one is.
    pub(super) fn position(&self, asked: Asked) -> Option<usize> {
        self.asked.iter().position(|own| *own == asked)
    }

    /// Entries of a state.
    pub(super) fn order(&self) -> usize {
        2 * self.layout.coordinates
    }

    /// Number of signals.
    pub(super) fn count(&self) -> usize {
        self.sums.len()
    }

    /// Number of contacts.
    pub(super) fn contacts(&self) -> usize {
        self.contacts.len()
    }

    /// Derivatives of the coefficients by a variable.
    pub(super) fn by(&self, variable: Variable) -> By {
        let mut coefficients = vec![0.0; self.layout.coefficients];
        self.system
            .coefficients_by(variable, &self.values, self.omega, &mut coefficients);
        let base = match variable {
            Variable::Omega => 1.0 / f64::from(self.system.facts().divisor),
            Variable::Parameter(_) => 0.0,
        };
        By { coefficients, base }
    }

    /// The pieces that the gaps are on.
    pub(super) fn pieces<'p>(
        &'p self,
        phase: f64,
        state: &'p [f64],
    ) -> impl Iterator<Item = usize> + 'p {
        self.contacts
            .iter()
            .enumerate()
            .map(move |(index, contact)| {
                let gap = self.gap(index, phase, state)[0];
                contact.levels.iter().filter(|&&level| gap > level).count()
            })
    }

    /// (1)
    pub(super) fn gap(&self, contact: usize, phase: f64, state: &[f64]) -> [f64; 2] {
        let (q, v) = state.split_at(self.layout.coordinates);
        let layout = &self.layout.contacts[contact];
        let mut sum = [0.0; 2];
        for term in &layout.gap {
            let [w, slope, _] = wave(term.wave, phase);
            let d = self.coefficients[term.coefficient];
            sum[0] += d * w * q[term.index];
            sum[1] += d * (w * v[term.index] + self.base * slope * q[term.index]);
        }
        for term in &layout.offset {
            let [w, slope, _] = wave(term.wave, phase);
            let delta = self.coefficients[term.coefficient];
            sum[0] -= delta * w;
            sum[1] -= delta * self.base * slope;
        }
        sum
    }

    /// The derivative of (1) along a direction.
    fn gap_along(&self, contact: usize, at: &Instant, direction: Direction<'_>) -> [f64; 2] {
        let n = self.layout.coordinates;
        let (q, v) = at.state.split_at(n);
        let (dq, dv) = direction.state.split_at(n);
        let layout = &self.layout.contacts[contact];
        let base = [self.base, direction.by.map_or(0.0, |by| by.base)];
        let value = |term: &Term| self.value(term.coefficient, direction);
        let mut sum = [0.0; 2];
        for term in &layout.gap {
            let [w, slope, bend] = self.wave(term.wave, at);
            let (dw, dslope) = (slope * direction.phase, bend * direction.phase);
            let ([d, dd], i) = (value(term), term.index);
            sum[0] += dd * w * q[i] + d * (dw * q[i] + w * dq[i]);
            sum[1] += dd * (w * v[i] + base[0] * slope * q[i])
                + d * (dw * v[i] + w * dv[i] + base[1] * slope * q[i])
                + d * base[0] * (dslope * q[i] + slope * dq[i]);
        }
        for term in &layout.offset {
            let [w, slope, bend] = self.wave(term.wave, at);
            let (dw, dslope) = (slope * direction.phase, bend * direction.phase);
            let [delta, ddelta] = value(term);
            sum[0] -= ddelta * w + delta * dw;
            sum[1] -= (ddelta * base[0] + delta * base[1]) * slope + delta * base[0] * dslope;
        }
        sum
    }

    /// A coefficient, and how it moves.
    fn value(&self, coefficient: usize, direction: Direction<'_>) -> [f64; 2] {
        let by = direction.by.map_or(0.0, |by| by.coefficients[coefficient]);
        [self.coefficients[coefficient], by]
    }

    /// The motion at one instant, with every contact on a piece.
    pub(super) fn at(&self, phase: f64, state: &[f64], pieces: &[usize]) -> Instant {
        let mut at = self.instant();
        self.look(phase, state, pieces, &mut at);
        at
    }

    /// The same into room that there is.
    pub(super) fn look(&self, phase: f64, state: &[f64], pieces: &[usize], at: &mut Instant) {
        at.phase = phase;
        at.state.copy_from_slice(state);
        at.pieces.copy_from_slice(pieces);
        for (value, &of) in at.waves.iter_mut().zip(&self.waves) {
            *value = wave(of, phase);
        }
        at.by_arguments.iter_mut().for_each(|by| by.set(None));
        at.gaps.clear();
        at.forces.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let piece = pieces[index];
            let [gap, rate] = self.gap(index, phase, state);
            // Where a stretch ends rounding must not take the gap off its piece.
            let lower = piece.checked_sub(1).map(|level| contact.levels[level]);
            let gap = lower.map_or(gap, |lower| gap.max(lower));
            let gap = contact
                .levels
                .get(piece)
                .map_or(gap, |&upper| gap.min(upper));
            let law = self.system.law(self.layout.contacts[index].law);
            let force = if law.facts().pieces[piece].force == Variation::Zero {
                Single {
                    force: 0.0,
                    by_gap: 0.0,
                    by_rate: 0.0,
                }
            } else {
                Single::of(law, On::Piece(piece), &contact.arguments, [gap, rate])
            };
            at.gaps.push([gap, rate]);
            at.forces.push(force);
        }
        self.load(at);
        times(&self.inverse_mass, &at.loads, &mut at.acceleration);
    }

    /// The right-hand side of (3).
    fn load(&self, at: &mut Instant) {
        let mut loads = std::mem::take(&mut at.loads);
        loads.fill(0.0);
        let (q, v) = at.state.split_at(self.layout.coordinates);
        let c = &self.coefficients;
        for e in &self.layout.load {
            loads[e.row] += c[e.coefficient] * self.wave(e.wave, at)[0];
        }
        for e in &self.layout.damping {
            loads[e.row] -= c[e.coefficient] * v[e.column];
        }
        for e in &self.layout.stiffness {
            loads[e.row] -= c[e.coefficient] * self.wave(e.wave, at)[0] * q[e.column];
        }
        for (contact, force) in self.layout.contacts.iter().zip(&at.forces) {
            for e in &contact.force {
                loads[e.index] -= c[e.coefficient] * self.wave(e.wave, at)[0] * force.force;
            }
        }
        at.loads = loads;
    }

    /// (2)
    fn force_along(&self, contact: usize, at: &Instant, direction: Direction<'_>) -> f64 {
        let Single {
            by_gap, by_rate, ..
        } = at.forces[contact];
        let layout = &self.layout.contacts[contact];
        let law = self.system.law(layout.law);
        if law.facts().pieces[at.pieces[contact]].force == Variation::Zero {
            return 0.0;
        }
        let [dg, dr] = self.gap_along(contact, at, direction);
        let mut change = by_gap * dg + by_rate * dr;
        let Some(by) = direction.by else {
            return change;
        };
        for &(argument, coefficient) in &layout.arguments {
            if by.coefficients[coefficient] != 0.0 {
                change += self.by_argument(contact, at, argument) * by.coefficients[coefficient];
            }
        }
        change
    }

    /// The derivative of a force by an argument: computed once at an instant, however many directions ask for it.
    fn by_argument(&self, contact: usize, at: &Instant, argument: usize) -> f64 {
        let kept = &at.by_arguments[self.first_argument[contact] + argument];
        kept.get().unwrap_or_else(|| {
            let by = self.computed_by_argument(contact, at, argument);
            kept.set(Some(by));
            by
        })
    }

    fn computed_by_argument(&self, contact: usize, at: &Instant, argument: usize) -> f64 {
        let law = self.system.law(self.layout.contacts[contact].law);
        let [gap, rate] = at.gaps[contact];
        let (mut force, mut by_gap, mut by_rate, mut by) = ([0.0], [0.0], [0.0], [0.0]);
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        let on = On::Piece(at.pieces[contact]);
        let arguments = &self.contacts[contact].arguments;
        law.derivatives_and_by(argument, on, arguments, &[gap], &[rate], out, &mut by);
        by[0]
    }

    /// (3), and the derivatives of all forces.
    fn move_forces(&self, at: &Instant, direction: Direction<'_>, room: &mut Moved) {
        let n = self.layout.coordinates;
        let (q, v) = at.state.split_at(n);
        let (dq, dv) = direction.state.split_at(n);
        for (contact, force) in room.forces.iter_mut().enumerate() {
            *force = self.force_along(contact, at, direction);
        }
        let loads = &mut room.loads;
        loads.fill(0.0);
        let waves = |w: Wave| {
            let [value, slope, _] = self.wave(w, at);
            [value, slope * direction.phase]
        };
        for e in &self.layout.load {
            let ([c, dc], [w, dw]) = (self.value(e.coefficient, direction), waves(e.wave));
            loads[e.row] += dc * w + c * dw;
        }
        for e in &self.layout.damping {
            let [c, dc] = self.value(e.coefficient, direction);
            loads[e.row] -= dc * v[e.column] + c * dv[e.column];
        }
        for e in &self.layout.stiffness {
            let ([c, dc], [w, dw]) = (self.value(e.coefficient, direction), waves(e.wave));
            loads[e.row] -= (dc * w + c * dw) * q[e.column] + c * w * dq[e.column];
        }
        for e in &self.mass {
            let [_, dc] = self.value(e.coefficient, direction);
            loads[e.row] -= dc * at.acceleration[e.column];
        }
        for (index, contact) in self.layout.contacts.iter().enumerate() {
            for e in &contact.force {
                let ([c, dc], [w, dw]) = (self.value(e.coefficient, direction), waves(e.wave));
                let force = at.forces[index].force;
                loads[e.index] -= (dc * w + c * dw) * force + c * w * room.forces[index];
            }
        }
        times(&self.inverse_mass, loads, &mut room.acceleration);
    }

    /// How the state moves with the phase.
    pub(super) fn write_rate(&self, at: &Instant, rate: &mut [f64]) {
        let velocities = &at.state[self.layout.coordinates..];
        let by_time = velocities.iter().chain(at.acceleration.iter());
        for (rate, x) in rate.iter_mut().zip(by_time) {
            *rate = x / self.base;
        }
    }

    /// Writes how the rate of the state, by the phase, moves along a direction.
    pub(super) fn rate_along(
        &self,
        at: &Instant,
        direction: Direction<'_>,
        room: &mut Moved,
        out: &mut [f64],
    ) {
        self.move_forces(at, direction, room);
        let n = self.layout.coordinates;
        let velocities = at.state[n..].iter().zip(&direction.state[n..]);
        let by_time = velocities.chain(at.acceleration.iter().zip(&room.acceleration));
        let base = direction.by.map_or(0.0, |by| by.base) / self.base;
        for (out, (x, dx)) in out.iter_mut().zip(by_time) {
            *out = (dx - x * base) / self.base;
        }
    }

    /// Where a gap stands on a level at which its force has no slope, that of its own piece beside it: along a motion that stays on the level what
    /// it is multiplied by is zero.
    pub(super) fn step_inside(&self, at: &mut Instant) {
        for (index, contact) in self.contacts.iter().enumerate() {
            if at.forces[index].by_gap.is_finite() {
                continue;
            }
            let piece = at.pieces[index];
            let [gap, rate] = at.gaps[index];
            let lower = piece.checked_sub(1).map(|level| contact.levels[level]);
            let step = INSIDE * (rate / self.base).abs();
            let inside = if lower == Some(gap) {
                gap + step
            } else {
                gap - step
            };
            let law = self.system.law(self.layout.contacts[index].law);
            let on = On::Piece(piece);
            let beside = Single::of(law, on, &contact.arguments, [inside, rate]);
            at.gaps[index][0] = inside;
            at.forces[index].by_gap = beside.by_gap;
            at.forces[index].by_rate = beside.by_rate;
        }
    }

    /// Whether a signal is a force that is nothing on these pieces.
    pub(super) fn is_nothing(&self, signal: usize, pieces: &[usize]) -> bool {
        let Asked::Contact(contact) = self.asked[signal] else {
            return false;
        };
        let law = self.system.law(self.layout.contacts[contact].law);
        law.facts().pieces[pieces[contact]].force == Variation::Zero
    }

    /// Writes all signals.
    pub(super) fn write(&self, at: &Instant, out: &mut [f64]) {
        for (index, out) in out.iter_mut().enumerate() {
            *out = if self.asked[index] == Asked::Power {
                self.power(at)
            } else {
                let products = self.sums[index].iter().map(|product| {
                    let c = product.coefficient.map_or(1.0, |c| self.coefficients[c]);
                    c * self.wave(product.wave, at)[0] * self.signal(product.of, at)
                });
                products.sum()
            };
        }
    }

    fn power(&self, at: &Instant) -> f64 {
        let v = &at.state[self.layout.coordinates..];
        let load = self.layout.load.iter();
        load.map(|e| self.coefficients[e.coefficient] * self.wave(e.wave, at)[0] * v[e.row])
            .sum()
    }

    fn signal(&self, of: Signal, at: &Instant) -> f64 {
        match of {
            Signal::Coordinate(index) => at.state[index],
            Signal::Rate(index) => at.state[self.layout.coordinates + index],
            Signal::Acceleration(index) => at.acceleration[index],
            Signal::Force(contact) => at.forces[contact].force,
            _ => 1.0,
        }
    }

    /// Writes the derivatives of all signals along a direction.
    pub(super) fn along<'o>(
        &self,
        at: &Instant,
        direction: Direction<'_>,
        room: &mut Moved,
        out: impl Iterator<Item = &'o mut f64>,
    ) {
        if self.has_forces {
            self.move_forces(at, direction, room);
        }
        for (index, out) in out.enumerate() {
            if self.asked[index] == Asked::Power {
                *out = self.power_along(at, direction);
                continue;
            }
            let products = self.sums[index].iter().map(|product| {
                let [c, dc] = product
                    .coefficient
                    .map_or([1.0, 0.0], |c| self.value(c, direction));
                let [w, slope, _] = self.wave(product.wave, at);
                let change = match product.of {
                    Signal::Coordinate(index) => direction.state[index],
                    Signal::Rate(index) => direction.state[self.layout.coordinates + index],
                    Signal::Acceleration(index) => room.acceleration[index],
                    Signal::Force(contact) => room.forces[contact],
                    _ => 0.0,
                };
                (dc * w + c * slope * direction.phase) * self.signal(product.of, at)
                    + c * w * change
            });
            *out = products.sum();
        }
    }

    fn power_along(&self, at: &Instant, direction: Direction<'_>) -> f64 {
        let n = self.layout.coordinates;
        let (v, dv) = (&at.state[n..], &direction.state[n..]);
        let load = self.layout.load.iter().map(|e| {
            let [w, slope, _] = self.wave(e.wave, at);
            let [c, dc] = self.value(e.coefficient, direction);
            (dc * w + c * slope * direction.phase) * v[e.row] + c * w * dv[e.row]
        });
        load.sum()
    }

    /// How much the gap of a contact grows beside a level, along a direction; and by the phase, along the motion.
    pub(super) fn distance_along(
        &self,
        at: &Instant,
        contact: usize,
        level: usize,
        direction: Direction<'_>,
    ) -> [f64; 2] {
        let [mut change, _] = self.gap_along(contact, at, direction);
        let layout = &self.layout.contacts[contact];
        if let Some(by) = direction.by {
            let law = self.system.law(layout.law);
            let mut levels = vec![0.0; self.contacts[contact].levels.len()];
            for &(argument, coefficient) in &layout.arguments {
                let moved = by.coefficients[coefficient];
                if moved != 0.0 {
                    law.levels_by(&self.contacts[contact].arguments, argument, &mut levels);
                    change -= moved * levels[level];
                }
            }
        }
        [change, at.gaps[contact][1] / self.base]
    }

    /// How the rate of a gap grows with the phase along the motion.
    pub(super) fn bend(&self, at: &Instant, contact: usize) -> f64 {
        let mut rate = vec![0.0; self.order()];
        self.write_rate(at, &mut rate);
        let motion = Direction {
            state: &rate,
            by: None,
            phase: 1.0,
        };
        self.gap_along(contact, at, motion)[1]
    }

    /// A level of the law of a contact.
    pub(super) fn level(&self, contact: usize, level: usize) -> f64 {
        self.contacts[contact].levels[level]
    }

    /// Whether the force of a contact jumps at a level, even without a rate.
    pub(super) fn jumps(&self, contact: usize, level: usize) -> bool {
        let law = self.system.law(self.layout.contacts[contact].law);
        law.facts().levels[level].force_jumps
    }

    /// Number of levels of the law of a contact.
    pub(super) fn levels(&self, contact: usize) -> usize {
        self.contacts[contact].levels.len()
    }
}
