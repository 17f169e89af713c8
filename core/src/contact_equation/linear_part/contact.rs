//! A contact at values of the parameters: its law, where it acts, and its gap and rate in the states of the [linear part](super::linear).

use nalgebra::{DMatrix, DVector};

use super::configuration::Affine;
use super::linear::{Linear, Seen, seen};
use super::moving_vector::{Moving, dot};
use crate::model::layout::{ContactLayout, Layout, Term};
use crate::numeric::linear;
use crate::system::System;

/// A contact.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Contact {
    pub(in crate::contact_equation) law: usize,
    pub(in crate::contact_equation) arguments: Vec<f64>,
    pub(in crate::contact_equation) levels: Vec<f64>,
    /// Whether the force jumps at them.
    pub(in crate::contact_equation) jumps: Vec<bool>,
    /// `T^-1 [0; M^-1 e]`: what a unit force does to the states, with the sign of the right-hand side.
    pub(in crate::contact_equation) input: Moving,
    /// `d . q` and `d . q'` as rows over the states.
    pub(in crate::contact_equation) gap: Moving,
    pub(in crate::contact_equation) rate: Moving,
    /// `delta`
    pub(super) offset: Moving,
    /// `d`, over the coordinates.
    direction: Moving,
    /// Unless one of these moves.
    pub(super) standing: Option<Standing>,
}

/// What of a contact does not move, over the coordinates.
#[derive(Debug, Clone)]
pub(super) struct Standing {
    /// `e`
    pub(in crate::contact_equation) force: DVector<f64>,
    /// `d`
    pub(in crate::contact_equation) gap: DVector<f64>,
    /// `delta`
    pub(super) offset: f64,
}

impl Contact {
    /// At these coefficients.
    pub(super) fn new(
        system: &dyn System,
        layout: &Layout,
        coefficients: &[f64],
        linear: &Linear,
        index: usize,
    ) -> Self {
        let of = &layout.contacts[index];
        let law = system.law(of.law);
        let mut contact = Self {
            law: of.law,
            arguments: vec![0.0; of.argument_count],
            levels: vec![0.0; law.facts().levels.len()],
            jumps: law
                .facts()
                .levels
                .iter()
                .map(|level| level.force_jumps)
                .collect(),
            ..Self::default()
        };
        of.arguments(coefficients, &mut contact.arguments);
        law.levels(&contact.arguments, &mut contact.levels);
        let column = |matrix: &DMatrix<f64>, i: usize| matrix.column(i).as_slice().to_vec();
        let row = |matrix: &DMatrix<f64>, i: usize| -> Vec<f64> {
            matrix.row(i).iter().copied().collect()
        };
        for term in &of.force {
            let states = column(&linear.input, term.index);
            contact
                .input
                .add(term, -coefficients[term.coefficient], &states);
        }
        let mut unit = vec![0.0; layout.coordinates];
        for term in &of.gap {
            let factor = coefficients[term.coefficient];
            unit[term.index] = 1.0;
            contact.direction.add(term, factor, &unit);
            unit[term.index] = 0.0;
            contact
                .gap
                .add(term, factor, &row(&linear.positions, term.index));
            contact
                .rate
                .add(term, factor, &row(&linear.velocities, term.index));
        }
        for term in &of.offset {
            contact
                .offset
                .add(term, coefficients[term.coefficient], &[1.0]);
        }
        contact.standing = standing(of, coefficients, layout.coordinates);
        contact
    }

    /// A gap on a piece: no farther than at its ends.
    pub(in crate::contact_equation) fn held(&self, piece: usize, gap: f64) -> f64 {
        let below = piece.checked_sub(1).map(|level| self.levels[level]);
        let above = self.levels.get(piece);
        gap.max(below.unwrap_or(f64::NEG_INFINITY))
            .min(above.copied().unwrap_or(f64::INFINITY))
    }

    /// An affine force at both ends of its piece: between them it is where it does not depend on the rate, else it is anywhere.
    pub(in crate::contact_equation) fn force_at_ends(
        &self,
        affine: &Affine,
        piece: usize,
    ) -> [f64; 2] {
        if affine.by_rate != 0.0 {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        [f64::NEG_INFINITY, f64::INFINITY].map(|far| {
            let gap = self.held(piece, far);
            // Of a force that does not change with an infinite gap.
            let by = if affine.by_gap == 0.0 {
                0.0
            } else {
                affine.by_gap * (gap - affine.at)
            };
            affine.force + by
        })
    }

    /// The highest harmonic of what moves in its gap.
    pub(in crate::contact_equation) fn harmonic(&self) -> f64 {
        self.gap.harmonic().max(self.offset.harmonic())
    }

    /// Neither its direction nor its offset moves.
    pub(in crate::contact_equation) fn stands(&self) -> bool {
        self.gap.is_constant() && self.offset.is_constant()
    }

    /// Gap and rate at a phase that moves so fast, by positions and velocities: (1).
    pub(in crate::contact_equation) fn gap_of(
        &self,
        tau: f64,
        base: f64,
        state: &[f64],
    ) -> [f64; 2] {
        let (positions, velocities) = state.split_at(state.len() / 2);
        let of = |derivative: u32| {
            let offset = self.offset.value(tau, derivative);
            self.direction.dot(tau, derivative, positions) - offset
        };
        let rate = self.direction.dot(tau, 0, velocities);
        let turning = if self.stands() { 0.0 } else { of(1) };
        [of(0), rate + base * turning]
    }

    /// The same by the states of the linear part.
    pub(in crate::contact_equation) fn gap_in(
        &self,
        tau: f64,
        base: f64,
        states: &[f64],
    ) -> [f64; 2] {
        let of = |derivative: u32| {
            let offset = self.offset.value(tau, derivative);
            self.gap.dot(tau, derivative, states) - offset
        };
        let rate = self.rate.dot(tau, 0, states);
        let turning = if self.stands() { 0.0 } else { of(1) };
        [of(0), rate + base * turning]
    }

    /// The direction of one that stands, over the coordinates.
    pub(in crate::contact_equation) fn constant_direction(&self) -> &[f64] {
        &self.direction.constant
    }

    /// The offset of one that stands.
    pub(in crate::contact_equation) fn constant_offset(&self) -> f64 {
        self.offset.value(0.0, 0)
    }

    /// Gap and rate of one that stands, as what they see of the states.
    pub(in crate::contact_equation) fn row(&self) -> Vec<Seen> {
        let [gap, rate] = [&self.gap, &self.rate].map(|of| of.constant.iter().copied());
        seen(gap, rate)
    }

    /// The largest sizes that both rows may have.
    pub(in crate::contact_equation) fn largest(&self, base: f64) -> Vec<Seen> {
        let (gap, mut rate) = (self.gap.sizes(), self.rate.sizes());
        let turning = base * self.gap.harmonic();
        rate.resize(gap.len(), 0.0);
        for (rate, gap) in rate.iter_mut().zip(&gap) {
            *rate += turning * gap;
        }
        seen(gap.into_iter(), rate.into_iter())
    }

    /// Gap and rate in these states, and what they are of the states as rows. There is room for `another` row.
    ///
    /// ```text
    /// g = d . q - delta,    g' = d . q' + (d' . q - delta') tau'                                              (1)
    /// ```
    pub(in crate::contact_equation) fn output(
        &self,
        at: Instant,
        states: &[f64],
        [gap, rate]: [&mut [f64]; 2],
        another: &mut [f64],
    ) -> Output {
        let Instant {
            tau,
            base,
            by_omega,
        } = at;
        let stands = self.gap.is_constant() && self.offset.is_constant();
        if stands && self.gap.constant.len() == gap.len() {
            // Most contacts: nothing but the states counts.
            gap.copy_from_slice(&self.gap.constant);
            rate.copy_from_slice(&self.rate.constant);
            let offset = self.offset.constant.first().copied().unwrap_or(0.0);
            return Output {
                gap: dot(gap, states) - offset,
                rate: dot(rate, states),
                ..Output::default()
            };
        }
        self.gap.write(tau, 0, gap);
        self.rate.write(tau, 0, rate);
        let mut output = Output {
            gap: linear::dot(gap, states) - self.offset.value(tau, 0),
            rate: linear::dot(rate, states),
            ..Output::default()
        };
        if !self.gap.is_constant() {
            output.by_phase[1] = self.rate.dot(tau, 1, states);
            output.by_phase[1] += base * self.gap.dot(tau, 2, states);
            self.gap.write(tau, 1, another);
            output.by_phase[0] = linear::dot(another, states);
            for (rate, turning) in rate.iter_mut().zip(&*another) {
                *rate += base * turning;
            }
        }
        output.by_phase[0] -= self.offset.value(tau, 1);
        output.by_phase[1] -= base * self.offset.value(tau, 2);
        let turning = output.by_phase[0];
        output.rate += base * turning;
        output.by_omega = turning * by_omega;
        output
    }
}

/// Where a contact is looked at: the phase, how fast it moves, and how that changes with the frequency that is varied.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Instant {
    pub(in crate::contact_equation) tau: f64,
    pub(in crate::contact_equation) base: f64,
    pub(in crate::contact_equation) by_omega: f64,
}

/// Gap and rate of a contact, and their explicit derivatives by the phase; that of the rate by the varied frequency.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact_equation) struct Output {
    pub(in crate::contact_equation) gap: f64,
    pub(in crate::contact_equation) rate: f64,
    pub(in crate::contact_equation) by_phase: [f64; 2],
    pub(in crate::contact_equation) by_omega: f64,
}

fn standing(of: &ContactLayout, coefficients: &[f64], n: usize) -> Option<Standing> {
    let mut terms = of.force.iter().chain(&of.gap).chain(&of.offset);
    let sum = |terms: &[Term], n: usize| {
        let mut to = DVector::zeros(n);
        for term in terms {
            to[term.index] += coefficients[term.coefficient];
        }
        to
    };
    terms.all(|term| term.wave.harmonic == 0).then(|| Standing {
        force: sum(&of.force, n),
        gap: sum(&of.gap, n),
        offset: sum(&of.offset, 1)[0],
    })
}
