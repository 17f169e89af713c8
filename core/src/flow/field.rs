//! The first-order form of the equations of motion, at fixed parameters and frequency, with every contact on a stated piece.
//!
//! With the state `(q, v)`, `v = dq/dt`, and the equations (1) to (3) of [`system`](crate::system),
//!
//! ```text
//! a(q, v, tau) = M^-1 r,   r = sum_h (a_h cos h tau + b_h sin h tau) - C v - K q - sum_c e_c phi_c(g_c, g_c')    (1)
//! g_c' = d_c . v + Omega (D d_c . q - D delta_c),    Omega = omega / divisor,   D = d/dtau                        (2)
//! da/dq = -M^-1 (K + sum_c e_c (phi_g d_c + phi_r Omega D d_c)),   da/dv = -M^-1 (C + sum_c e_c phi_r d_c)        (3)
//! ```
//!
//! All is evaluated at `S` instants at once. Gaps are formed as the gap at one end of a stretch plus what it has changed
//! since, so that a gap which begins or ends on a level keeps its relative accuracy there.
//!
//! Source: the derivatives are those of `stability/monodromy.rs`, here at fixed phase and with a parameter.

use crate::law::{Derivatives, Law, On, Variation};
use crate::layout::{Entry, Layout, Term};
use crate::system::{Part, System, Variable, Wave};
use nalgebra::DMatrix;

use super::FlowError;

/// A system at values of its parameters and of `omega`.
pub(crate) struct Field<'a> {
    pub(crate) system: &'a dyn System,
    layout: Layout,
    values: Vec<f64>,
    omega: f64,
    /// `Omega`
    base: f64,
    coefficients: Vec<f64>,
    /// The entries of `M^-1` that are not zero: row, column, value.
    inverse_mass: Vec<(usize, usize, f64)>,
    /// Zero only if the mass matrix is singular.
    singular: Option<f64>,
    /// Harmonics of all waves but the constant.
    harmonics: Vec<u32>,
    damping: Vec<Item>,
    stiffness: Vec<Item>,
    load: Vec<Item>,
    pub(crate) contacts: Vec<Contact>,
}

/// A coefficient, where it stands, and its wave by position among the harmonics; none for a constant.
#[derive(Debug, Clone, Copy)]
struct Item {
    row: usize,
    column: usize,
    coefficient: usize,
    wave: Option<(usize, Part)>,
}

/// What is known of a contact at these values.
#[derive(Debug)]
pub(crate) struct Contact {
    pub(crate) law: usize,
    pub(crate) arguments: Vec<f64>,
    pub(crate) levels: Vec<f64>,
    force: Vec<Item>,
    gap: Vec<Item>,
    offset: Vec<Item>,
    /// The gap depends on the phase not only through the coordinates.
    moving: bool,
}

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

/// A gap at one instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gap {
    pub(crate) value: f64,
    /// By time.
    pub(crate) rate: f64,
    /// The sum of the sizes of what the value is a sum of.
    pub(crate) size: f64,
}

/// `S` instants of a stretch: states and what follows from them. One row for each coordinate, contact or harmonic.
#[derive(Debug)]
pub(crate) struct Batch<const S: usize> {
    /// Cosines and sines of every harmonic.
    waves: Vec<[[f64; S]; 2]>,
    /// Their changes since the start, and since the end; only where a contact moves.
    changes: [Vec<[[f64; S]; 2]>; 2],
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
    gap: [f64; S],
    rate: [f64; S],
    force: [f64; S],
    by_gap: [f64; S],
    by_rate: [f64; S],
    by_argument: [f64; S],
}

/// The derivatives (3) at the instants of a batch, and that by one variable: row by row of the matrices.
#[derive(Debug)]
pub(crate) struct Slopes<const S: usize> {
    pub(crate) by_q: Vec<[f64; S]>,
    pub(crate) by_v: Vec<[f64; S]>,
    pub(crate) by_variable: Vec<[f64; S]>,
    /// Before multiplication with `M^-1`.
    rows: Vec<[f64; S]>,
    pub(crate) coefficients: Vec<f64>,
}

impl<const S: usize> Batch<S> {
    pub(crate) fn new(field: &Field<'_>) -> Self {
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

impl<const S: usize> Slopes<S> {
    pub(crate) fn new(field: &Field<'_>) -> Self {
        let n = field.coordinates();
        Self {
            by_q: vec![[0.0; S]; n * n],
            by_v: vec![[0.0; S]; n * n],
            by_variable: vec![[0.0; S]; n],
            rows: vec![[0.0; S]; n],
            coefficients: vec![0.0; field.coefficients.len()],
        }
    }
}

/// One where there is no wave, and otherwise a row of it.
fn wave_at<const S: usize>(waves: &[[[f64; S]; 2]], wave: Option<(usize, Part)>) -> [f64; S] {
    wave.map_or([1.0; S], |(index, part)| waves[index][part as usize])
}

impl<'a> Field<'a> {
    /// The equations of a system.
    pub(crate) fn new(system: &'a dyn System, values: &[f64], omega: f64) -> Self {
        let layout = Layout::of(system);
        let harmonics = harmonics(&layout);
        let position = |wave: Wave| {
            let index = harmonics.binary_search(&wave.harmonic).ok()?;
            Some((index, wave.part))
        };
        let entry = |entry: &Entry| Item {
            row: entry.row,
            column: entry.column,
            coefficient: entry.coefficient,
            wave: position(entry.wave),
        };
        let term = |term: &Term| Item {
            row: term.index,
            column: term.index,
            coefficient: term.coefficient,
            wave: position(term.wave),
        };
        let contacts = layout.contacts.iter().map(|contact| Contact {
            law: contact.law,
            arguments: vec![0.0; contact.argument_count],
            levels: vec![0.0; system.law(contact.law).facts().levels.len()],
            force: contact.force.iter().map(term).collect(),
            gap: contact.gap.iter().map(term).collect(),
            offset: contact.offset.iter().map(term).collect(),
            moving: contact.gap_harmonic().max(contact.offset_harmonic()) > 0,
        });
        let mut field = Self {
            system,
            values: values.to_vec(),
            omega,
            base: 0.0,
            coefficients: vec![0.0; layout.coefficients],
            inverse_mass: Vec::new(),
            singular: None,
            damping: layout.damping.iter().map(entry).collect(),
            stiffness: layout.stiffness.iter().map(entry).collect(),
            load: layout.load.iter().map(entry).collect(),
            contacts: contacts.collect(),
            harmonics,
            layout,
        };
        field.update();
        field
    }

    pub(crate) fn coordinates(&self) -> usize {
        self.layout.coordinates
    }

    /// `Omega`, radians of phase per unit of time.
    pub(crate) fn base(&self) -> f64 {
        self.base
    }

    /// Changes the frequency or a parameter.
    pub(crate) fn set(&mut self, variable: Variable, value: f64) {
        match variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.values[index] = value,
        }
        self.update();
    }

    /// The mass matrix can be inverted.
    pub(crate) fn regular(&self) -> Result<(), FlowError> {
        self.singular.map_or(Ok(()), |determinant| {
            Err(FlowError::SingularMass { determinant })
        })
    }

    fn update(&mut self) {
        self.base = self.omega / f64::from(self.system.facts().divisor);
        self.system
            .coefficients(&self.values, self.omega, &mut self.coefficients);
        let n = self.coordinates();
        let mut mass = DMatrix::zeros(n, n);
        for entry in &self.layout.mass {
            mass[(entry.row, entry.column)] += self.coefficients[entry.coefficient];
        }
        let determinant: f64 = mass.determinant();
        self.inverse_mass.clear();
        let inverse = mass
            .try_inverse()
            .filter(|inverse| inverse.iter().all(|x| x.is_finite()));
        self.singular = inverse.is_none().then_some(determinant);
        if let Some(inverse) = inverse {
            let entries = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            self.inverse_mass
                .extend(entries.map(|(i, j)| (i, j, inverse[(i, j)])));
            self.inverse_mass.retain(|&(_, _, value)| value != 0.0);
        }
        for (contact, layout) in self.contacts.iter_mut().zip(&self.layout.contacts) {
            layout.arguments(&self.coefficients, &mut contact.arguments);
            let law = self.system.law(contact.law);
            law.levels(&contact.arguments, &mut contact.levels);
        }
    }

    /// The law of a contact.
    pub(crate) fn law(&self, contact: usize) -> &'a dyn Law {
        self.system.law(self.contacts[contact].law)
    }

    /// The gap of a contact at one instant.
    pub(crate) fn gap(&self, contact: usize, q: &[f64], v: &[f64], phase: f64) -> Gap {
        let contact = &self.contacts[contact];
        let mut gap = Gap {
            value: 0.0,
            rate: 0.0,
            size: 0.0,
        };
        let mut add = |value: f64, rate: f64| {
            gap.value += value;
            gap.rate += rate;
            gap.size += value.abs();
        };
        for item in &contact.gap {
            let (wave, slope) = self.wave(item, phase);
            let d = self.coefficients[item.coefficient];
            add(
                d * wave * q[item.row],
                d * (wave * v[item.row] + self.base * slope * q[item.row]),
            );
        }
        for item in &contact.offset {
            let (wave, slope) = self.wave(item, phase);
            let delta = self.coefficients[item.coefficient];
            add(-delta * wave, -delta * self.base * slope);
        }
        gap
    }

    /// The second derivative of a gap by time, from the acceleration.
    pub(crate) fn gap_acceleration(
        &self,
        contact: usize,
        (q, v, a): (&[f64], &[f64], &[[f64; 1]]),
        phase: f64,
    ) -> f64 {
        let contact = &self.contacts[contact];
        let bend = |item: &Item, wave: f64| {
            let h = item
                .wave
                .map_or(0.0, |(index, _)| f64::from(self.harmonics[index]));
            -(self.base * h).powi(2) * wave
        };
        let gap = contact.gap.iter().map(|item| {
            let (wave, slope) = self.wave(item, phase);
            let i = item.row;
            self.coefficients[item.coefficient]
                * (wave * a[i][0] + 2.0 * self.base * slope * v[i] + bend(item, wave) * q[i])
        });
        let offset = contact.offset.iter().map(|item| {
            let (wave, _) = self.wave(item, phase);
            self.coefficients[item.coefficient] * bend(item, wave)
        });
        gap.sum::<f64>() - offset.sum::<f64>()
    }

    /// What the rate of a gap is a sum of, in size and about.
    pub(crate) fn rate_size(&self, contact: usize, q: &[f64], v: &[f64]) -> f64 {
        let contact = &self.contacts[contact];
        let turning = |item: &Item| {
            let harmonic = item.wave.map_or(0, |(index, _)| self.harmonics[index]);
            self.base * f64::from(harmonic)
        };
        let gap = contact.gap.iter().map(|item| {
            let d = self.coefficients[item.coefficient].abs();
            d * (v[item.row].abs() + turning(item) * q[item.row].abs())
        });
        let offset = contact
            .offset
            .iter()
            .map(|item| self.coefficients[item.coefficient].abs() * turning(item));
        gap.sum::<f64>() + offset.sum::<f64>()
    }

    /// The size of a gap from sizes of the coordinates.
    pub(crate) fn gap_scale(&self, contact: usize, sizes: &[[f64; 2]]) -> f64 {
        let terms = self.contacts[contact].gap.iter();
        terms
            .map(|d| self.coefficients[d.coefficient].abs() * sizes[d.row][0])
            .sum()
    }

    /// The force of a contact on a level, from the side of a piece.
    pub(crate) fn force_at_level(
        &self,
        contact: usize,
        level: usize,
        piece: usize,
        rate: f64,
    ) -> f64 {
        let mut force = [0.0];
        let contact = &self.contacts[contact];
        self.system.law(contact.law).force(
            On::Piece(piece),
            &contact.arguments,
            &[contact.levels[level]],
            &[rate],
            &mut force,
        );
        force[0]
    }

    /// How much a gap moves, beside a level, with a tangent column and with a variable.
    pub(crate) fn gap_change(
        &self,
        contact: usize,
        level: usize,
        column: &[f64],
        (q, phase): (&[f64], f64),
        by: Option<(Variable, &mut [f64])>,
    ) -> f64 {
        let item_at = |item: &Item| self.wave(item, phase).0;
        let (facts, layout) = (&self.contacts[contact], &self.layout.contacts[contact]);
        let gap = facts.gap.iter();
        let mut change: f64 = gap
            .map(|d| self.coefficients[d.coefficient] * item_at(d) * column[d.row])
            .sum();
        let Some((variable, by)) = by else {
            return change;
        };
        self.system
            .coefficients_by(variable, &self.values, self.omega, by);
        let gap = facts.gap.iter();
        change += gap
            .map(|d| by[d.coefficient] * item_at(d) * q[d.row])
            .sum::<f64>();
        let offset = facts.offset.iter();
        change -= offset
            .map(|delta| by[delta.coefficient] * item_at(delta))
            .sum::<f64>();
        let law = self.system.law(facts.law);
        let mut levels = vec![0.0; facts.levels.len()];
        for &(argument, coefficient) in &layout.arguments {
            if by[coefficient] != 0.0 {
                law.levels_by(&facts.arguments, argument, &mut levels);
                change -= by[coefficient] * levels[level];
            }
        }
        change
    }

    /// Adds the acceleration that a force of a contact causes.
    pub(crate) fn push(&self, contact: usize, phase: f64, force: f64, to: &mut [f64]) {
        for e in &self.contacts[contact].force {
            let e_value = self.coefficients[e.coefficient] * self.wave(e, phase).0;
            for &(row, column, value) in &self.inverse_mass {
                if column == e.row {
                    to[row] += value * e_value * force;
                }
            }
        }
    }

    /// Whether an argument of a contact's law depends on a variable.
    pub(crate) fn depends(&self, contact: usize, argument: usize, variable: Variable) -> bool {
        let mut by = vec![0.0; self.coefficients.len()];
        self.system
            .coefficients_by(variable, &self.values, self.omega, &mut by);
        self.layout.contacts[contact]
            .arguments
            .iter()
            .any(|&(index, coefficient)| index == argument && by[coefficient] != 0.0)
    }

    /// A wave and its derivative by phase.
    fn wave(&self, item: &Item, phase: f64) -> (f64, f64) {
        let Some((index, part)) = item.wave else {
            return (1.0, 0.0);
        };
        let h = f64::from(self.harmonics[index]);
        let (sine, cosine) = (h * phase).sin_cos();
        match part {
            Part::Cosine => (cosine, -h * sine),
            Part::Sine => (sine, h * cosine),
        }
    }

    /// Puts the instants of a batch on a stretch that starts at a phase: `passed` and `left` are their distances, in
    /// parts of the width, from its start and from its end.
    pub(crate) fn place<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        phase: f64,
        width: f64,
        passed: &[f64; S],
        left: &[f64; S],
    ) {
        for (waves, &harmonic) in batch.waves.iter_mut().zip(&self.harmonics) {
            let h = f64::from(harmonic);
            for j in 0..S {
                let (sine, cosine) = (h * (phase + width * passed[j])).sin_cos();
                (waves[0][j], waves[1][j]) = (cosine, sine);
            }
        }
        for (index, changes) in batch.changes.iter_mut().enumerate() {
            for (changes, &harmonic) in changes.iter_mut().zip(&self.harmonics) {
                let half = 0.5 * f64::from(harmonic);
                for j in 0..S {
                    // cos(x + y) - cos x = -2 sin(y / 2) sin(x + y / 2), and so for the sine.
                    let (from, by) = if index == 0 {
                        (phase, width * passed[j])
                    } else {
                        (phase + width, -width * left[j])
                    };
                    let (sine, cosine) = (half * (2.0 * from + by)).sin_cos();
                    let factor = 2.0 * (half * by).sin();
                    (changes[0][j], changes[1][j]) = (-factor * sine, factor * cosine);
                }
            }
        }
        for load in &mut batch.load {
            *load = [0.0; S];
        }
        for item in &self.load {
            add_times(
                &mut batch.load[item.row],
                self.coefficients[item.coefficient],
                &wave_at(&batch.waves, item.wave),
            );
        }
    }

    /// Writes the accelerations (1), with every contact on a piece.
    pub(crate) fn accelerate<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        pieces: &[usize],
        anchors: &[Anchor],
    ) {
        self.forces(batch, pieces, anchors);
        batch.force.copy_from_slice(&batch.load);
        for item in &self.damping {
            let factor = -self.coefficients[item.coefficient];
            add_times(&mut batch.force[item.row], factor, &batch.v[item.column]);
        }
        for item in &self.stiffness {
            let factor = -self.coefficients[item.coefficient];
            let (to, q) = (&mut batch.force[item.row], &batch.q[item.column]);
            add_product(to, factor, q, &wave_at(&batch.waves, item.wave));
        }
        for (contact, samples) in self.contacts.iter().zip(&batch.contacts) {
            for item in &contact.force {
                let factor = -self.coefficients[item.coefficient];
                let (to, force) = (&mut batch.force[item.row], &samples.force);
                add_product(to, factor, force, &wave_at(&batch.waves, item.wave));
            }
        }
        self.divide_by_mass(&batch.force, &mut batch.a);
    }

    fn divide_by_mass<const S: usize>(&self, forces: &[[f64; S]], to: &mut [[f64; S]]) {
        for row in to.iter_mut() {
            *row = [0.0; S];
        }
        for &(row, column, value) in &self.inverse_mass {
            add_times(&mut to[row], value, &forces[column]);
        }
    }

    /// The forces of all contacts.
    fn forces<const S: usize>(&self, batch: &mut Batch<S>, pieces: &[usize], anchors: &[Anchor]) {
        for (index, contact) in self.contacts.iter().enumerate() {
            self.gaps(batch, index, anchors[index]);
            let samples = &mut batch.contacts[index];
            let law = self.system.law(contact.law);
            if law.facts().pieces[pieces[index]].force == Variation::Zero {
                samples.force = [0.0; S];
                continue;
            }
            law.force(
                On::Piece(pieces[index]),
                &contact.arguments,
                &samples.gap,
                &samples.rate,
                &mut samples.force,
            );
        }
    }

    /// Gap and rate of a contact, the gap measured from an end of the stretch.
    fn gaps<const S: usize>(&self, batch: &mut Batch<S>, index: usize, anchor: Anchor) {
        let contact = &self.contacts[index];
        let samples = &mut batch.contacts[index];
        let end = anchor.end as usize;
        (samples.rise, samples.rate) = ([0.0; S], [0.0; S]);
        for item in &contact.gap {
            let d = self.coefficients[item.coefficient];
            let wave = wave_at(&batch.waves, item.wave);
            add_product(&mut samples.rise, d, &batch.shift[end][item.row], &wave);
            add_product(&mut samples.rate, d, &batch.v[item.row], &wave);
            if let Some(wave) = item.wave {
                let change = wave_at(&batch.changes[end], Some(wave));
                add_times(&mut samples.rise, d * batch.ends[end][item.row], &change);
                let (factor, slope) = self.slope(&batch.waves, wave);
                let q = &batch.q[item.row];
                add_product(&mut samples.rate, d * self.base * factor, q, slope);
            }
        }
        for item in &contact.offset {
            if let Some(wave) = item.wave {
                let delta = self.coefficients[item.coefficient];
                let change = wave_at(&batch.changes[end], Some(wave));
                add_times(&mut samples.rise, -delta, &change);
                let (factor, slope) = self.slope(&batch.waves, wave);
                add_times(&mut samples.rate, -delta * self.base * factor, slope);
            }
        }
        samples.gap = samples.rise.map(|rise| anchor.gap + rise);
    }

    /// The derivative of a wave by phase: a factor and a row.
    fn slope<'b, const S: usize>(
        &self,
        waves: &'b [[[f64; S]; 2]],
        (index, part): (usize, Part),
    ) -> (f64, &'b [f64; S]) {
        let h = f64::from(self.harmonics[index]);
        match part {
            Part::Cosine => (-h, &waves[index][1]),
            Part::Sine => (h, &waves[index][0]),
        }
    }

    /// Writes the derivatives (3) at a batch whose accelerations are known, and by one variable at fixed phase and state.
    pub(crate) fn linearise<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        pieces: &[usize],
        by: Option<Variable>,
        out: &mut Slopes<S>,
    ) {
        let n = self.coordinates();
        for row in out.by_q.iter_mut().chain(&mut out.by_v) {
            *row = [0.0; S];
        }
        // Forces first, one row for each pair of an equation and a coordinate; then M^-1, column by column.
        for item in &self.stiffness {
            let factor = -self.coefficients[item.coefficient];
            let to = &mut out.by_q[item.row * n + item.column];
            add_times(to, factor, &wave_at(&batch.waves, item.wave));
        }
        for item in &self.damping {
            let factor = -self.coefficients[item.coefficient];
            add_times(&mut out.by_v[item.row * n + item.column], factor, &[1.0; S]);
        }
        for index in 0..self.contacts.len() {
            self.slopes_of_law(&mut batch.contacts[index], index, pieces[index], None);
            let contact = &self.contacts[index];
            let samples = &batch.contacts[index];
            for e in &contact.force {
                let wave = wave_at(&batch.waves, e.wave);
                let factor = -self.coefficients[e.coefficient];
                let stiffness = times(factor, &samples.by_gap, &wave);
                let damping = times(factor, &samples.by_rate, &wave);
                for d in &contact.gap {
                    let value = self.coefficients[d.coefficient];
                    let wave = wave_at(&batch.waves, d.wave);
                    let to = e.row * n + d.row;
                    add_product(&mut out.by_q[to], value, &stiffness, &wave);
                    add_product(&mut out.by_v[to], value, &damping, &wave);
                    if let Some(wave) = d.wave {
                        let (factor, slope) = self.slope(&batch.waves, wave);
                        let factor = factor * value * self.base;
                        add_product(&mut out.by_q[to], factor, &damping, slope);
                    }
                }
            }
        }
        for j in 0..n {
            for matrix in [&mut out.by_q, &mut out.by_v] {
                for i in 0..n {
                    out.rows[i] = matrix[i * n + j];
                }
                for i in 0..n {
                    matrix[i * n + j] = [0.0; S];
                }
                for &(row, column, value) in &self.inverse_mass {
                    add_times(&mut matrix[row * n + j], value, &out.rows[column]);
                }
            }
        }
        if let Some(variable) = by {
            self.by_variable(batch, pieces, variable, out);
        }
    }

    /// Derivatives of the force of a contact by gap and rate, and by an argument.
    fn slopes_of_law<const S: usize>(
        &self,
        samples: &mut Samples<S>,
        index: usize,
        piece: usize,
        argument: Option<usize>,
    ) {
        let contact = &self.contacts[index];
        let law = self.system.law(contact.law);
        let out = Derivatives {
            force: &mut samples.force,
            by_gap: &mut samples.by_gap,
            by_rate: &mut samples.by_rate,
        };
        let (on, arguments) = (On::Piece(piece), &contact.arguments);
        match argument {
            None => law.derivatives(on, arguments, &samples.gap, &samples.rate, out),
            Some(argument) => law.derivatives_and_by(
                argument,
                on,
                arguments,
                &samples.gap,
                &samples.rate,
                out,
                &mut samples.by_argument,
            ),
        }
    }

    /// `M^-1 (dr/dp - dM/dp a)`, the derivative of (1) by a variable `p`.
    fn by_variable<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        pieces: &[usize],
        variable: Variable,
        out: &mut Slopes<S>,
    ) {
        let by = &mut out.coefficients;
        self.system
            .coefficients_by(variable, &self.values, self.omega, by);
        for row in &mut out.rows {
            *row = [0.0; S];
        }
        let rows = &mut out.rows;
        for item in &self.load {
            let wave = wave_at(&batch.waves, item.wave);
            add_times(&mut rows[item.row], by[item.coefficient], &wave);
        }
        for item in &self.damping {
            let v = &batch.v[item.column];
            add_times(&mut rows[item.row], -by[item.coefficient], v);
        }
        for item in &self.stiffness {
            let wave = wave_at(&batch.waves, item.wave);
            let q = &batch.q[item.column];
            add_product(&mut rows[item.row], -by[item.coefficient], q, &wave);
        }
        for entry in &self.layout.mass {
            let a = &batch.a[entry.column];
            add_times(&mut rows[entry.row], -by[entry.coefficient], a);
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            let force = self.force_by(batch, index, pieces[index], variable, by);
            for e in &contact.force {
                let wave = wave_at(&batch.waves, e.wave);
                let (value, slope) = (self.coefficients[e.coefficient], by[e.coefficient]);
                add_product(&mut rows[e.row], -value, &force, &wave);
                add_product(
                    &mut rows[e.row],
                    -slope,
                    &batch.contacts[index].force,
                    &wave,
                );
            }
        }
        self.divide_by_mass(&out.rows, &mut out.by_variable);
    }

    /// The derivative of the force of a contact by a variable, at fixed phase and state.
    fn force_by<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        index: usize,
        piece: usize,
        variable: Variable,
        by: &[f64],
    ) -> [f64; S] {
        let contact = &self.contacts[index];
        let mut force = [0.0; S];
        for &(argument, coefficient) in &self.layout.contacts[index].arguments {
            if by[coefficient] != 0.0 {
                let samples = &mut batch.contacts[index];
                self.slopes_of_law(samples, index, piece, Some(argument));
                add_times(&mut force, by[coefficient], &samples.by_argument);
            }
        }
        let base_by = self.base_by(variable);
        let (mut gap, mut rate) = ([0.0; S], [0.0; S]);
        for d in &contact.gap {
            let (value, change) = (self.coefficients[d.coefficient], by[d.coefficient]);
            let (q, v) = (&batch.q[d.row], &batch.v[d.row]);
            let wave = wave_at(&batch.waves, d.wave);
            add_product(&mut gap, change, q, &wave);
            add_product(&mut rate, change, v, &wave);
            if let Some(wave) = d.wave {
                let (factor, slope) = self.slope(&batch.waves, wave);
                let factor = factor * (change * self.base + value * base_by);
                add_product(&mut rate, factor, q, slope);
            }
        }
        for delta in &contact.offset {
            let (value, change) = (self.coefficients[delta.coefficient], by[delta.coefficient]);
            add_times(&mut gap, -change, &wave_at(&batch.waves, delta.wave));
            if let Some(wave) = delta.wave {
                let (factor, slope) = self.slope(&batch.waves, wave);
                let factor = factor * (change * self.base + value * base_by);
                add_times(&mut rate, -factor, slope);
            }
        }
        let samples = &batch.contacts[index];
        add_product(&mut force, 1.0, &samples.by_gap, &gap);
        add_product(&mut force, 1.0, &samples.by_rate, &rate);
        force
    }

    /// The highest harmonic of all waves.
    pub(crate) fn highest_harmonic(&self) -> f64 {
        self.harmonics.last().map_or(0.0, |&h| f64::from(h))
    }

    /// `dOmega / dp`
    pub(crate) fn base_by(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Omega => 1.0 / f64::from(self.system.facts().divisor),
            Variable::Parameter(_) => 0.0,
        }
    }
}

fn harmonics(layout: &Layout) -> Vec<u32> {
    let entries = layout.stiffness.iter().chain(&layout.load);
    let terms = layout.contacts.iter().flat_map(|contact| {
        contact
            .force
            .iter()
            .chain(&contact.gap)
            .chain(&contact.offset)
    });
    let mut harmonics: Vec<u32> = entries
        .map(|entry| entry.wave.harmonic)
        .chain(terms.map(|term| term.wave.harmonic))
        .filter(|&harmonic| harmonic > 0)
        .collect();
    harmonics.sort_unstable();
    harmonics.dedup();
    harmonics
}

fn add_times<const S: usize>(to: &mut [f64; S], factor: f64, x: &[f64; S]) {
    for j in 0..S {
        to[j] += factor * x[j];
    }
}

fn add_product<const S: usize>(to: &mut [f64; S], factor: f64, x: &[f64; S], y: &[f64; S]) {
    for j in 0..S {
        to[j] += factor * x[j] * y[j];
    }
}

fn times<const S: usize>(factor: f64, x: &[f64; S], y: &[f64; S]) -> [f64; S] {
    std::array::from_fn(|j| factor * x[j] * y[j])
}
