//! How slowly gaps pass levels where the force jumps.
//!
//! A gap that passes a level with the slope `r`, while its second derivative `a` slows it down, would turn beyond it at the height
//!
//! ```text
//! r^2 / (2 |a|)                                                                                                (1)
//! ```
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::Run;
use crate::contact_equation::skeleton::placement::Told;

/// A pair whose `H`, or the root of it, is less is near its touch.
const WIDE: f64 = 0.03;
/// How fast a slope changes is seen over this, in radians.
const SHORT: f64 = 1e-4;

impl Run<'_> {
    /// How slowly a gap passes a level where the force jumps while it is slowed down: the height (1) at which it would turn, in units
    /// of half of the gap's range, with its slope `r` by the phase and how fast that changes, `a`, before the level.
    pub(super) fn slowest(&mut self, u: &[f64]) -> f64 {
        self.equations.compute(u, false);
        if self.equations.failed || !self.equations.is_in_order() {
            return f64::INFINITY;
        }
        let motion = Motion::of(&self.equations);
        let found = motion.gap_extremes().concat();
        let skeleton = &self.equations.skeleton;
        let heights = skeleton.switches.iter().enumerate().map(|(index, switch)| {
            let contact = switch.contact;
            let size = 0.5 * self.range(&found, contact);
            let Some(interval) = skeleton.before(index) else {
                return f64::INFINITY;
            };
            let [from, to] = motion.phases(interval);
            let width = (to - from).min(SHORT);
            let slope = |phase: f64| motion.gap(contact, interval, phase)[1];
            let (before, rate) = (slope(to - width), slope(to));
            let change = (rate - before) / width;
            let slowed = rate * change < 0.0 && self.has_leap(contact, switch.level);
            // A pair passes as slowly as its gap has gone beyond the level.
            let other = match switch.told {
                Told::First { other, .. } => Some(other),
                Told::Second { .. } => Some(index),
                Told::Alone => None,
            };
            let wide = other.is_none_or(|other| u[skeleton.slot(other)] > WIDE);
            if slowed && wide && width > 0.0 {
                0.5 * rate * rate / change.abs() / size
            } else {
                f64::INFINITY
            }
        });
        heights.fold(f64::INFINITY, f64::min)
    }
}
