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
//! This file is what is asked at one instant; [`batch`] evaluates (1) and [`slopes`] evaluates (3) at several.

pub(crate) mod batch;
pub(crate) mod slopes;

use std::sync::Arc;

use super::FlowError;
use super::error::check_value;
use crate::law::{Law, On};
use crate::laws::single;
use crate::model::layout::{Entry, Layout, Term};
use crate::model::validate::in_order;
use crate::numeric::linear::{Lu, Matrix};
use crate::system::{Part, System, Variable, Wave};

/// A system at values of its parameters and of `omega`.
pub(crate) struct Field {
    pub(crate) system: Arc<dyn System>,
    layout: Layout,
    values: Vec<f64>,
    omega: f64,
    /// `Omega`
    base: f64,
    coefficients: Vec<f64>,
    /// The entries of `M^-1` that are not zero: row, column, value.
    inverse_mass: Vec<(usize, usize, f64)>,
    /// Workspace for the mass matrix, its factors, and a column of its inverse.
    mass: Matrix,
    lu: Lu,
    column: Vec<f64>,
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

/// Workspace for derivatives of the coefficients, and of the levels of a contact.
#[derive(Debug)]
pub(crate) struct Workspace<'r> {
    pub(crate) by: &'r mut [f64],
    pub(crate) levels: &'r mut [f64],
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

impl Field {
    /// The equations of a system.
    ///
    /// # Errors
    /// If levels are out of order or the mass matrix is singular.
    pub(crate) fn new(system: &dyn System, values: &[f64], omega: f64) -> Result<Self, FlowError> {
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
            system: system.shared(),
            values: values.to_vec(),
            omega,
            base: 0.0,
            coefficients: vec![0.0; layout.coefficients],
            inverse_mass: Vec::with_capacity(layout.coordinates.pow(2)),
            mass: Matrix::zeros(layout.coordinates),
            lu: Lu::new(layout.coordinates),
            column: vec![0.0; layout.coordinates],
            damping: layout.damping.iter().map(entry).collect(),
            stiffness: layout.stiffness.iter().map(entry).collect(),
            load: layout.load.iter().map(entry).collect(),
            contacts: contacts.collect(),
            harmonics,
            layout,
        };
        field.update()?;
        Ok(field)
    }

    pub(crate) fn coordinates(&self) -> usize {
        self.layout.coordinates
    }

    /// `Omega`, radians of phase per unit of time.
    pub(crate) fn base(&self) -> f64 {
        self.base
    }

    /// Changes the frequency or a parameter; not if the equations could not be evaluated then.
    pub(crate) fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        check_value(self.system.as_ref(), variable, value)?;
        let present = match variable {
            Variable::Omega => &mut self.omega,
            Variable::Parameter(index) => &mut self.values[index],
        };
        let before = std::mem::replace(present, value);
        let updated = self.update();
        if updated.is_err() {
            match variable {
                Variable::Omega => self.omega = before,
                Variable::Parameter(index) => self.values[index] = before,
            }
            self.update()?;
        }
        updated
    }

    fn update(&mut self) -> Result<(), FlowError> {
        self.base = self.omega / f64::from(self.system.facts().divisor);
        self.system
            .coefficients(&self.values, self.omega, &mut self.coefficients);
        self.invert_mass()?;
        let contacts = self.contacts.iter_mut().zip(&self.layout.contacts);
        for (index, (contact, layout)) in contacts.enumerate() {
            layout.arguments(&self.coefficients, &mut contact.arguments);
            let law = self.system.law(contact.law);
            law.levels(&contact.arguments, &mut contact.levels);
            if !in_order(&contact.levels) {
                return Err(FlowError::Levels { contact: index });
            }
        }
        Ok(())
    }

    fn invert_mass(&mut self) -> Result<(), FlowError> {
        let n = self.coordinates();
        self.mass.clear();
        for entry in &self.layout.mass {
            self.mass.row_mut(entry.row)[entry.column] += self.coefficients[entry.coefficient];
        }
        if self.lu.factorise(&mut self.mass).is_err() {
            let determinant = self.layout.mass(&self.coefficients).determinant();
            return Err(FlowError::SingularMass { determinant });
        }
        self.inverse_mass.clear();
        for j in 0..n {
            self.column.fill(0.0);
            self.column[j] = 1.0;
            self.lu.solve(&self.mass, &mut self.column);
            let entries = self.column.iter().enumerate();
            let entries = entries.filter(|&(_, &value)| value != 0.0);
            self.inverse_mass
                .extend(entries.map(|(i, &value)| (i, j, value)));
        }
        Ok(())
    }

    /// The law of a contact.
    pub(crate) fn law(&self, contact: usize) -> &dyn Law {
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

    /// What a gap is a sum of, in size, where coordinates have sizes, the first of each pair.
    pub(crate) fn gap_size(&self, contact: usize, sizes: &[[f64; 2]], phase: f64) -> f64 {
        let contact = &self.contacts[contact];
        let size =
            |item: &Item| (self.coefficients[item.coefficient] * self.wave(item, phase).0).abs();
        let gap = contact
            .gap
            .iter()
            .map(|item| size(item) * sizes[item.row][0]);
        gap.sum::<f64>() + contact.offset.iter().map(size).sum::<f64>()
    }

    /// The second derivative of a gap by time, from the acceleration.
    pub(crate) fn gap_acceleration(
        &self,
        contact: usize,
        q: &[f64],
        v: &[f64],
        a: &[[f64; 1]],
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

    /// What the rate of a gap is a sum of, in size and about, where coordinates and their rates have sizes.
    pub(crate) fn rate_size(&self, contact: usize, sizes: impl Fn(usize) -> [f64; 2]) -> f64 {
        let contact = &self.contacts[contact];
        let turning = |item: &Item| {
            let harmonic = item.wave.map_or(0, |(index, _)| self.harmonics[index]);
            self.base * f64::from(harmonic)
        };
        let gap = contact.gap.iter().map(|item| {
            let d = self.coefficients[item.coefficient].abs();
            let [q, v] = sizes(item.row);
            d * (v + turning(item) * q)
        });
        let offset = contact
            .offset
            .iter()
            .map(|item| self.coefficients[item.coefficient].abs() * turning(item));
        gap.sum::<f64>() + offset.sum::<f64>()
    }

    /// The force of a contact on a level, from the side of a piece.
    pub(crate) fn force_at_level(
        &self,
        contact: usize,
        level: usize,
        piece: usize,
        rate: f64,
    ) -> f64 {
        self.force(contact, piece, self.contacts[contact].levels[level], rate)
    }

    /// The force of a contact on a piece.
    pub(crate) fn force(&self, contact: usize, piece: usize, gap: f64, rate: f64) -> f64 {
        let contact = &self.contacts[contact];
        let law = self.system.law(contact.law);
        single::force(law, On::Piece(piece), &contact.arguments, [gap, rate])
    }

    /// How much a gap moves, beside a level, with a tangent column and with a variable.
    pub(crate) fn gap_change(
        &self,
        contact: usize,
        level: usize,
        column: &[f64],
        q: &[f64],
        phase: f64,
        by: Option<(Variable, Workspace<'_>)>,
    ) -> f64 {
        let item_at = |item: &Item| self.wave(item, phase).0;
        let (facts, layout) = (&self.contacts[contact], &self.layout.contacts[contact]);
        let gap = facts.gap.iter();
        let mut change: f64 = gap
            .map(|d| self.coefficients[d.coefficient] * item_at(d) * column[d.row])
            .sum();
        let Some((variable, Workspace { by, levels })) = by else {
            return change;
        };
        self.coefficients_by(variable, by);
        let gap = facts.gap.iter();
        change += gap
            .map(|d| by[d.coefficient] * item_at(d) * q[d.row])
            .sum::<f64>();
        let offset = facts.offset.iter();
        change -= offset
            .map(|delta| by[delta.coefficient] * item_at(delta))
            .sum::<f64>();
        let law = self.system.law(facts.law);
        for &(argument, coefficient) in &layout.arguments {
            if by[coefficient] != 0.0 {
                let levels = &mut levels[..facts.levels.len()];
                law.levels_by(&facts.arguments, argument, levels);
                change -= by[coefficient] * levels[level];
            }
        }
        change
    }

    /// Moves positions as little as possible so that the gap of a contact grows by a number.
    pub(crate) fn move_gap(&self, contact: usize, phase: f64, by: f64, q: &mut [f64]) {
        let terms = &self.contacts[contact].gap;
        let d = |item: &Item| self.coefficients[item.coefficient] * self.wave(item, phase).0;
        let along = |row: usize| {
            terms
                .iter()
                .filter(|item| item.row == row)
                .map(d)
                .sum::<f64>()
        };
        let square: f64 = (0..q.len()).map(|row| along(row).powi(2)).sum();
        if square > 0.0 {
            for (row, q) in q.iter_mut().enumerate() {
                *q += by * along(row) / square;
            }
        }
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

    /// The derivatives of all coefficients by a variable.
    pub(crate) fn coefficients_by(&self, variable: Variable, by: &mut [f64]) {
        self.system
            .coefficients_by(variable, &self.values, self.omega, by);
    }

    /// Whether an argument of a contact's law depends on the variable that the derivatives of the coefficients are by.
    pub(crate) fn depends(&self, contact: usize, argument: usize, by: &[f64]) -> bool {
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
