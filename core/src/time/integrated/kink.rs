//! Where a slope of a force jumps on a step.
//!
//! The force of `max(0, dot(gap))` is continuous, and its slope jumps where the rate is zero. Between the last node of a step and its end no
//! node sees that, and what perturbations lose there is a part of the step, far more than its estimated error. So the operand of the
//! absolute value, which is smooth, is followed as gaps are beside levels ([`crossing`](super::crossing)), and steps end where it changes
//! its sign.

use super::engine::Engine;
use super::roots;
use super::step_control::SHORTEST;

/// An operand smaller than this part of its largest value on the step is zero: the step begins or ends there.
const ZERO: f64 = 1e-11;
/// A step that goes on for less than this part of itself ends there.
const ENDS: f64 = 1e-10;

impl<const S: usize> Engine<S> {
    /// The part of the trial after which the slope of a force first jumps.
    pub(super) fn kink(&mut self) -> Option<f64> {
        let map = self.tables[self.trial.table].map;
        let end = self.phase() + self.trial.width;
        let mut first: Option<f64> = None;
        for (contact, scales) in self.sharp.iter_mut().enumerate() {
            let piece = self.here.pieces[contact];
            let Some(scales) = scales.as_mut().filter(|scales| scales.bends(piece)) else {
                continue;
            };
            let start = self.here.gaps[contact];
            let (q, v) = (&self.trial.q, &self.trial.v);
            let end = self.field.gap(contact, q, v, end);
            let [gaps, rates] = self.batch.contacts[contact].motion();
            let [gap, rate] = &mut self.motion;
            for (to, nodes, ends) in [
                (&mut *gap, gaps, [start.value, end.value]),
                (&mut *rate, rates, [start.rate, end.rate]),
            ] {
                to[1..=S].copy_from_slice(nodes);
                (to[0], to[S + 1]) = (ends[0], ends[1]);
            }
            for operand in scales.bending(piece, gap, rate) {
                let largest = operand.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let noise = ZERO * largest;
                let begins = operand.iter().find(|x| x.abs() > 2.0 * noise);
                let Some(begins) = begins else { continue };
                let sign = begins.signum();
                for (value, x) in self.values.iter_mut().zip(operand) {
                    *value = sign * x;
                }
                if operand[0].abs() <= 2.0 * noise {
                    self.values[0] = 0.0;
                }
                self.rule
                    .in_bernstein_form(&self.values, noise, &mut self.coefficients);
                if let Some(u) = roots::first(&self.coefficients) {
                    first = Some(first.map_or(u, |first| first.min(u)));
                }
            }
        }
        let part = map.place(first?);
        let shortest = SHORTEST * self.phase().abs().max(1.0);
        let goes_on = part * self.trial.width.abs() > shortest;
        (goes_on && part < 1.0 - ENDS).then_some(part)
    }
}
