//! Where a gap first leaves its piece on a step.
//!
//! Distances from the levels of a piece are polynomials in `u` through their values at both ends and at the nodes, in
//! Bernstein form, so that a pair of crossings within one step is not missed. At an end that stands on the level itself the
//! distance is divided by the part of the step that has passed, or is left: its zero there is taken out, and a double one if the
//! motion starts there at rest. Not if it only touches the level there: what it does within rounding of the level is no crossing.

use crate::time::field::Gap;

use super::engine::Engine;
use super::roots;

/// Rounding of a polynomial's coefficients, in parts of its largest value.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A gap leaves its piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Found {
    pub(super) contact: usize,
    pub(super) level: usize,
    /// Where on the step.
    pub(super) u: f64,
    /// It stands on that level and leaves without having been on the piece.
    pub(super) at_once: bool,
    /// The step starts on that level, slowly, and the acceleration leads away from it.
    pub(super) doubtful: bool,
}

impl<const S: usize> Engine<S> {
    /// The first crossing on the trial, if any; not the one that it ends on.
    pub(super) fn crossing(&mut self) -> Option<Found> {
        let mut first: Option<Found> = None;
        let end = self.phase() + self.trial.width;
        for contact in 0..self.here.on.len() {
            let gap = self.field.gap(contact, &self.trial.q, &self.trial.v, end);
            let piece = self.here.pieces[contact];
            let count = self.field.contacts[contact].levels.len();
            let lower = piece.checked_sub(1);
            let upper = (piece < count).then_some(piece);
            for (level, sign) in [(lower, 1.0), (upper, -1.0)] {
                let Some(level) = level else { continue };
                let found = self.leaves(contact, level, sign, gap);
                if found.is_some_and(|found| first.is_none_or(|first| found.u < first.u)) {
                    first = found;
                }
            }
        }
        first
    }

    /// Where `sign` times the distance from a level becomes negative.
    fn leaves(&mut self, contact: usize, level: usize, sign: f64, end: Gap) -> Option<Found> {
        let starts = self.here.on[contact] == Some(level);
        let ends = self.trial.landing == Some((contact, level));
        let at_rest = starts && self.is_at_rest(contact);
        let divided = starts && (at_rest || !self.touches(contact, level));
        let acceleration = if starts {
            self.acceleration_of(contact)
        } else {
            0.0
        };
        let doubtful = !at_rest && sign * acceleration > 0.0 && self.is_slow(contact);
        let rounding = self.rounding(contact, level);
        let size = self.here.gaps[contact].size.max(end.size);
        let rounding = rounding.unwrap_or(ROUNDING * size);
        self.write_distances(contact, level, sign, end);
        if divided {
            self.divide_at_start(contact, sign, at_rest.then_some(acceleration));
        }
        if ends {
            self.divide_at_end(sign * end.rate);
        }
        let largest = self.values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let rounding = if divided || ends { 0.0 } else { rounding };
        let noise = (ROUNDING * largest).max(rounding);
        if largest == 0.0 {
            return None;
        }
        self.rule
            .in_bernstein_form(&self.values, noise, &mut self.coefficients);
        let u = roots::first(&self.coefficients)?;
        let inside = roots::value(&self.coefficients, 0.5 * u) - noise;
        Some(Found {
            contact,
            level,
            u,
            at_once: starts && inside <= 2.0 * noise,
            doubtful,
        })
    }

    /// Writes `sign` times the distance of a gap from a level, at both ends and at the nodes.
    fn write_distances(&mut self, contact: usize, level: usize, sign: f64, end: Gap) {
        let value = self.field.contacts[contact].levels[level];
        let base = self.anchors[contact].gap - value;
        let rise = &self.batch.contacts[contact].rise;
        for j in 0..S {
            self.values[j + 1] = sign * (base + rise[j]);
        }
        self.values[0] = sign * (self.here.gaps[contact].value - value);
        self.values[S + 1] = sign * (end.value - value);
    }

    /// Divides distances from a level on which the gap starts by the part that has passed; by its square where the gap goes away from
    /// rest with an acceleration.
    fn divide_at_start(&mut self, contact: usize, sign: f64, from_rest: Option<f64>) {
        let time = self.time();
        let tables = &self.tables[self.trial.table];
        let parts = self.values[1..=S].iter_mut().zip(&tables.passed);
        parts.for_each(|(distance, part)| {
            *distance /= from_rest.map_or(*part, |_| part * part);
        });
        let limit = match from_rest {
            Some(acceleration) => 0.5 * time * time * acceleration,
            None => self.here.gaps[contact].rate * time,
        };
        self.values[0] = sign * limit;
    }

    /// Divides distances from a level on which the gap ends, with a rate, by the part that is left.
    fn divide_at_end(&mut self, rate: f64) {
        let time = self.time();
        let tables = &self.tables[self.trial.table];
        let parts = self.values[1..=S].iter_mut().zip(&tables.left);
        parts.for_each(|(distance, part)| *distance /= part);
        self.values[S + 1] = -rate * time;
    }
}
