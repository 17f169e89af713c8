//! Accelerations at several instants of a stretch of motion.
//!
//! Gaps are formed as the gap at one end of the stretch plus what it has changed since, so that a gap which begins or ends
//! on a level keeps its relative accuracy beside it.
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::{Contact, Field};
use crate::law::{On, Variation};
use crate::numeric::fourier::phases::waves;
use crate::system::Part;

/// Angles up to which cosine and sine are those of their series to rounding.
const SMALL_TURN: f64 = 1e-3;

/// An end of a stretch of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// Where it starts.
    Start,
    /// Where it ends.
    End,
}

/// The gap at an end of a stretch, from which it is measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Anchor {
    pub(crate) end: End,
    pub(crate) gap: f64,
}

/// Parts of a stretch that have passed, and that are left, at every instant.
pub(crate) type Parts<'p, const S: usize> = (&'p [f64; S], &'p [f64; S]);

/// Cosine and sine of one harmonic at every instant.
pub(super) type Waves<const S: usize> = [[f64; S]; 2];

/// `S` instants of a stretch: states and what follows from them. One row for each coordinate, contact or harmonic.
#[derive(Debug)]
pub(crate) struct Batch<const S: usize> {
    /// Cosines and sines of every harmonic.
    pub(super) waves: Vec<Waves<S>>,
    /// Their changes since the start, and since the end; only where a contact moves.
    changes: [Vec<Waves<S>>; 2],
    /// The right-hand side of the equations of motion.
    load: Vec<[f64; S]>,
    pub(crate) q: Vec<[f64; S]>,
    pub(crate) v: Vec<[f64; S]>,
    /// `q` minus that at the start, and minus that at the end.
    pub(crate) shift: [Vec<[f64; S]>; 2],
    /// `q` at the start and at the end.
    pub(crate) ends: [Vec<f64>; 2],
    force: Vec<[f64; S]>,
    pub(crate) a: Vec<[f64; S]>,
    pub(crate) contacts: Vec<Samples<S>>,
}

/// One contact at the instants of a batch.
#[derive(Debug, Clone)]
pub(crate) struct Samples<const S: usize> {
    /// Gap minus that of its anchor.
    pub(crate) rise: [f64; S],
    pub(super) gap: [f64; S],
    pub(super) rate: [f64; S],
    pub(super) force: [f64; S],
    pub(super) by_gap: [f64; S],
    pub(super) by_rate: [f64; S],
    pub(super) by_argument: [f64; S],
}

impl<const S: usize> Samples<S> {
    /// Gap and rate.
    pub(crate) fn motion(&self) -> [&[f64; S]; 2] {
        [&self.gap, &self.rate]
    }
}

impl<const S: usize> Batch<S> {
    pub(crate) fn new(field: &Field) -> Self {
        let n = field.coordinates();
        let rows = || vec![[0.0; S]; n];
        let moving = field.contacts.iter().any(|contact| contact.moving);
        let waves = || vec![[[0.0; S]; 2]; field.harmonics.len()];
        let changes = || if moving { waves() } else { Vec::new() };
        let zeros = [0.0; S];
        let samples = Samples {
            rise: zeros,
            gap: zeros,
            rate: zeros,
            force: zeros,
            by_gap: zeros,
            by_rate: zeros,
            by_argument: zeros,
        };
        Self {
            waves: waves(),
            changes: [changes(), changes()],
            load: rows(),
            q: rows(),
            v: rows(),
            shift: [rows(), rows()],
            ends: [vec![0.0; n], vec![0.0; n]],
            force: rows(),
            a: rows(),
            contacts: vec![samples; field.contacts.len()],
        }
    }
}

impl Field {
    /// Puts the instants of a batch on a stretch that starts at a phase.
    pub(crate) fn place<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        phase: f64,
        width: f64,
        parts: Parts<'_, S>,
    ) {
        place(&mut batch.waves, &self.harmonics, phase, width, parts.0);
        self.place_changes(batch, phase, width, parts);
        self.place_load(batch);
    }

    /// The same once the width has grown by a little: the waves are turned.
    pub(crate) fn widen<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        phase: f64,
        width: f64,
        growth: f64,
        parts: Parts<'_, S>,
    ) {
        if growth.abs() * self.highest_harmonic() > SMALL_TURN {
            self.place(batch, phase, width, parts);
            return;
        }
        turn(&mut batch.waves, &self.harmonics, growth, parts.0);
        self.place_changes(batch, phase, width, parts);
        self.place_load(batch);
    }

    /// How the waves have changed since the start, and since the end.
    fn place_changes<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        phase: f64,
        width: f64,
        parts: Parts<'_, S>,
    ) {
        let (passed, left) = parts;
        let ends = [(phase, width, passed), (phase + width, -width, left)];
        for (changes, (from, width, parts)) in batch.changes.iter_mut().zip(ends) {
            for (changes, &harmonic) in changes.iter_mut().zip(&self.harmonics) {
                // cos(x + y) - cos x = -2 sin(y / 2) sin(x + y / 2), and so for the sine.
                let half = 0.5 * f64::from(harmonic);
                for j in 0..S {
                    let by = width * parts[j];
                    let (sine, cosine) = (half * (2.0 * from + by)).sin_cos();
                    let factor = 2.0 * (half * by).sin();
                    (changes[0][j], changes[1][j]) = (-factor * sine, factor * cosine);
                }
            }
        }
    }

    fn place_load<const S: usize>(&self, batch: &mut Batch<S>) {
        batch.load.fill([0.0; S]);
        for item in &self.load {
            let factor = self.coefficients[item.coefficient];
            add_wave(&mut batch.load[item.row], factor, &batch.waves, item.wave);
        }
    }

    /// Writes the accelerations (1), with every contact on a piece.
    pub(crate) fn accelerate<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        pieces: &[usize],
        anchors: &[Anchor],
    ) {
        accelerate(self, batch, pieces, anchors);
    }

    /// Divides rows of forces by the mass matrix.
    #[inline(always)]
    pub(super) fn divide_by_mass<const S: usize>(&self, forces: &[[f64; S]], to: &mut [[f64; S]]) {
        to.fill([0.0; S]);
        for &(row, column, value) in &self.inverse_mass {
            add_times(&mut to[row], value, &forces[column]);
        }
    }

    /// Gap and rate of a contact, the gap measured from an end of the stretch.
    #[inline(always)]
    fn gaps<const S: usize>(&self, batch: &mut Batch<S>, index: usize, anchor: Anchor) {
        let contact = &self.contacts[index];
        let samples = &mut batch.contacts[index];
        let end = anchor.end as usize;
        (samples.rise, samples.rate) = ([0.0; S], [0.0; S]);
        for item in &contact.gap {
            let d = self.coefficients[item.coefficient];
            let (shift, v) = (&batch.shift[end][item.row], &batch.v[item.row]);
            let Some((wave, part)) = item.wave else {
                add_times(&mut samples.rise, d, shift);
                add_times(&mut samples.rate, d, v);
                continue;
            };
            let row = &batch.waves[wave][part as usize];
            add_product(&mut samples.rise, d, shift, row);
            add_product(&mut samples.rate, d, v, row);
            let change = &batch.changes[end][wave][part as usize];
            add_times(&mut samples.rise, d * batch.ends[end][item.row], change);
            let (factor, slope) = self.slope(&batch.waves, wave, part);
            let q = &batch.q[item.row];
            add_product(&mut samples.rate, d * self.base * factor, q, slope);
        }
        self.offsets(contact, samples, &batch.waves, &batch.changes[end]);
        for j in 0..S {
            samples.gap[j] = anchor.gap + samples.rise[j];
        }
    }

    /// What the offset of a moving contact adds.
    #[inline(always)]
    fn offsets<const S: usize>(
        &self,
        contact: &Contact,
        samples: &mut Samples<S>,
        waves: &[Waves<S>],
        changes: &[Waves<S>],
    ) {
        for item in &contact.offset {
            if let Some((wave, part)) = item.wave {
                let delta = self.coefficients[item.coefficient];
                add_times(&mut samples.rise, -delta, &changes[wave][part as usize]);
                let (factor, slope) = self.slope(waves, wave, part);
                add_times(&mut samples.rate, -delta * self.base * factor, slope);
            }
        }
    }

    /// The derivative of a wave by phase: a factor and a row.
    #[inline(always)]
    pub(super) fn slope<'b, const S: usize>(
        &self,
        waves: &'b [Waves<S>],
        index: usize,
        part: Part,
    ) -> (f64, &'b [f64; S]) {
        let h = f64::from(self.harmonics[index]);
        match part {
            Part::Cosine => (-h, &waves[index][1]),
            Part::Sine => (h, &waves[index][0]),
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn place<const S: usize>(
    rows: &mut [Waves<S>],
    harmonics: &[u32],
    phase: f64,
    width: f64,
    passed: &[f64; S],
) {
    for (row, &harmonic) in rows.iter_mut().zip(harmonics) {
        let h = f64::from(harmonic);
        let mut angles = [0.0; S];
        for j in 0..S {
            angles[j] = h * (phase + width * passed[j]);
        }
        *row = waves(&angles);
    }
}

/// Turns waves by small angles.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn turn<const S: usize>(rows: &mut [Waves<S>], harmonics: &[u32], growth: f64, passed: &[f64; S]) {
    for ([cosines, sines], &harmonic) in rows.iter_mut().zip(harmonics) {
        let turn = f64::from(harmonic) * growth;
        for j in 0..S {
            let x = turn * passed[j];
            let square = x * x;
            let sine = x * (1.0 - square / 6.0 * (1.0 - square / 20.0));
            let less = 0.5 * square * (1.0 - square / 12.0);
            let (c, s) = (cosines[j], sines[j]);
            cosines[j] = c - (less * c + sine * s);
            sines[j] = s - (less * s - sine * c);
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn accelerate<const S: usize>(
    field: &Field,
    batch: &mut Batch<S>,
    pieces: &[usize],
    anchors: &[Anchor],
) {
    batch.force.copy_from_slice(&batch.load);
    for item in &field.damping {
        let factor = -field.coefficients[item.coefficient];
        add_times(&mut batch.force[item.row], factor, &batch.v[item.column]);
    }
    for item in &field.stiffness {
        let factor = -field.coefficients[item.coefficient];
        let (to, q) = (&mut batch.force[item.row], &batch.q[item.column]);
        add_times_wave(to, factor, q, &batch.waves, item.wave);
    }
    for (index, contact) in field.contacts.iter().enumerate() {
        field.gaps(batch, index, anchors[index]);
        let samples = &mut batch.contacts[index];
        let law = field.system.law(contact.law);
        if law.facts().pieces[pieces[index]].force == Variation::Zero {
            continue;
        }
        law.force(
            On::Piece(pieces[index]),
            &contact.arguments,
            &samples.gap,
            &samples.rate,
            &mut samples.force,
        );
        for item in &contact.force {
            let factor = -field.coefficients[item.coefficient];
            let to = &mut batch.force[item.row];
            add_times_wave(to, factor, &samples.force, &batch.waves, item.wave);
        }
    }
    field.divide_by_mass(&batch.force, &mut batch.a);
}

/// Adds a number times a wave.
#[inline(always)]
pub(super) fn add_wave<const S: usize>(
    to: &mut [f64; S],
    factor: f64,
    waves: &[Waves<S>],
    wave: Option<(usize, Part)>,
) {
    match wave {
        Some((index, part)) => add_times(to, factor, &waves[index][part as usize]),
        None => to.iter_mut().for_each(|x| *x += factor),
    }
}

/// Adds a number times a row and a wave.
#[inline(always)]
pub(super) fn add_times_wave<const S: usize>(
    to: &mut [f64; S],
    factor: f64,
    x: &[f64; S],
    waves: &[Waves<S>],
    wave: Option<(usize, Part)>,
) {
    match wave {
        Some((index, part)) => add_product(to, factor, x, &waves[index][part as usize]),
        None => add_times(to, factor, x),
    }
}

#[inline(always)]
pub(super) fn add_times<const S: usize>(to: &mut [f64; S], factor: f64, x: &[f64; S]) {
    for j in 0..S {
        to[j] += factor * x[j];
    }
}

#[inline(always)]
pub(super) fn add_product<const S: usize>(
    to: &mut [f64; S],
    factor: f64,
    x: &[f64; S],
    y: &[f64; S],
) {
    for j in 0..S {
        to[j] += factor * x[j] * y[j];
    }
}
