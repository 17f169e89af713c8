//! What rounding leaves in derivatives of a motion that passes a level where the stiffness is unbounded.
//!
//! A gap is known to a unit `u` in its last place, so that beside a level `l` that is not zero its distance from there has an error of that
//! size. A force `phi` whose derivative is unbounded there makes of it, over the time that the gap takes for `u`,
//!
//! ```text
//! |d(dv)| = |M^-1 e (phi(l + u) - phi(l)) / g'| |dq|                                                          (1)
//! ```
//!
//! in a tangent column `(dq, dv)`. No shorter step leaves less. Where the gap hardly moves that is no rounding any more: the derivative itself is
//! not known then, and the step fails.

use crate::law::is_unbounded;

use super::engine::{Engine, Trial};

/// So many times (1) is what an error of the tangent may be rounding.
const SEVERAL: f64 = 8.0;
/// More than this is not taken for rounding.
const LARGEST: f64 = 1e-4;

impl<const S: usize> Engine<S> {
    /// (1) of the levels that the trial begins or ends on, relative to the base frequency.
    pub(super) fn level_noise(&mut self) -> f64 {
        let landing = self.trial.landing;
        let phase = self.phase();
        let end = phase + self.trial.width;
        let mut most = 0.0_f64;
        for contact in 0..self.here.on.len() {
            let lands = landing.filter(|(of, _)| *of == contact);
            let begins = self.here.on[contact].map(|level| (level, self.here.gaps[contact].rate));
            let ends = lands.map(|(_, level)| {
                let Trial { q, v, .. } = &self.trial;
                (level, self.field.gap(contact, q, v, end).rate)
            });
            for (level, rate) in [begins, ends].into_iter().flatten() {
                let facts = self.field.law(contact).facts();
                let of = &self.field.contacts[contact];
                let value = of.levels[level];
                if value == 0.0 || !is_unbounded(facts, level, &of.arguments) {
                    continue;
                }
                let piece = self.here.pieces[contact];
                let beside = if piece == level {
                    value.next_down()
                } else {
                    value.next_up()
                };
                let [at, beside] =
                    [value, beside].map(|gap| self.field.force(contact, piece, gap, rate));
                self.pushed.fill(0.0);
                let push = (beside - at) / rate;
                self.field.push(contact, phase, push, &mut self.pushed);
                let pushed = self.pushed.iter();
                most = pushed.fold(most, |most, x| most.max(x.abs()));
            }
        }
        let noise = SEVERAL * most / self.field.base().abs();
        if noise <= LARGEST { noise } else { 0.0 }
    }
}
