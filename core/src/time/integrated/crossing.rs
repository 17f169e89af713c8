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
        let value = self.field.contacts[contact].levels[level];
        let start = self.here.gaps[contact];
        let starts = self.here.on[contact] == Some(level);
        let ends = self.trial.landing == Some((contact, level));
        let time = self.time();
        let at_rest = starts && self.is_at_rest(contact);
        let touches = starts && !at_rest && self.touches(contact, level);
        let acceleration = if starts {
            self.acceleration_of(contact)
        } else {
            0.0
        };
        let doubtful = !at_rest && sign * acceleration > 0.0 && self.is_slow(contact);
        let rounding = self.rounding(contact, level);
        let rounding = rounding.unwrap_or(ROUNDING * start.size.max(end.size));
        let tables = &self.tables[self.trial.table];
        let base = self.anchors[contact].gap - value;
        let rise = &self.batch.contacts[contact].rise;
        let values = &mut self.values;
        for j in 0..S {
            values[j + 1] = sign * (base + rise[j]);
        }
        values[0] = sign * (start.value - value);
        values[S + 1] = sign * (end.value - value);
        if starts && !touches {
            // A gap that is at rest there goes away from the level as the square.
            let parts = values[1..=S].iter_mut().zip(&tables.passed);
            parts.for_each(|(distance, part)| {
                *distance /= if at_rest { part * part } else { *part }
            });
            values[0] = sign
                * if at_rest {
                    0.5 * time * time * acceleration
                } else {
                    start.rate * time
                };
        }
        if ends {
            let parts = values[1..=S].iter_mut().zip(&tables.left);
            parts.for_each(|(distance, part)| *distance /= part);
            values[S + 1] = -sign * end.rate * time;
        }
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let divided = ends || starts && !touches;
        let noise = (ROUNDING * largest).max(if divided { 0.0 } else { rounding });
        if largest == 0.0 {
            return None;
        }
        self.rule
            .in_bernstein_form(values, noise, &mut self.coefficients);
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
}
