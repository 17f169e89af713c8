//! Where a function of phase and state vanishes along a motion.
//!
//! Along each smooth stretch `g` is sampled; a change of sign is closed in to the last bits of
//! the phase. Where `g` has the same sign at two samples, comes nearer to zero behind the first and goes away from it before the
//! second, its extremum between them is closed in as well, so that two crossings in quick succession are not lost.
//!
//! Source of the iteration: Chandrupatla (1997), Advances in Engineering Software 28, 145.

use std::f64::consts::TAU;

use super::Section;
use crate::time::Stretch;

/// Samples in one period, at least.
const SAMPLES: f64 = 64.0;
/// Part of the distance of two samples over which a slope is taken: a dip that ends within it has a depth of about its square.
const ASIDE: f64 = 1e-5;
/// Golden section: each step keeps this part of an interval.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// What is remembered along a motion.
pub(super) struct Search<'s, 'a> {
    section: &'s Section<'a>,
    /// Room.
    state: Vec<f64>,
    /// Whether the motion was above the surface when last it was not on it.
    side: Option<bool>,
    /// `g` at the end of what has been scanned. It is carried from stretch to stretch, since rounding could change its sign
    /// where one is evaluated by the other's polynomial.
    last: f64,
    /// Where `g` was not a number first.
    pub(super) undefined: Option<f64>,
}

impl<'s, 'a> Search<'s, 'a> {
    /// From a state at a phase.
    pub(super) fn new(section: &'s Section<'a>, phase: f64, state: &[f64]) -> Self {
        let mut search = Self {
            section,
            state: state.to_vec(),
            side: None,
            last: (section.function)(phase, state),
            undefined: None,
        };
        search.undefined = search.last.is_nan().then_some(phase);
        search.passed(search.last);
        search
    }

    fn value(&mut self, stretch: &dyn Stretch, phase: f64) -> f64 {
        stretch.state(phase, &mut self.state);
        let value = (self.section.function)(phase, &self.state);
        if value.is_nan() {
            self.undefined.get_or_insert(phase);
        }
        value
    }

    /// Whether the side changes at a value; on the surface it does not.
    fn passed(&mut self, value: f64) -> bool {
        if value == 0.0 || value.is_nan() {
            return false;
        }
        let above = value > 0.0;
        self.side.replace(above).is_some_and(|side| side != above)
    }

    /// Shows the crossings on a stretch: phase, state, and whether `g` rises.
    pub(super) fn scan(&mut self, stretch: &dyn Stretch, see: &mut dyn FnMut(f64, &[f64], bool)) {
        let (from, to) = stretch.phases();
        if to <= from {
            return;
        }
        let count = ((to - from) / TAU * SAMPLES).ceil().max(2.0);
        let at = |i: f64| {
            if i == count {
                to
            } else {
                from + (to - from) * (i / count)
            }
        };
        let mut here = (from, self.last);
        for i in 1..=count as usize {
            let phase = at(i as f64);
            let next = (phase, self.value(stretch, phase));
            if let Some(extreme) = self.dip(stretch, here, next) {
                self.cross(stretch, here, extreme, see);
                self.cross(stretch, extreme, next, see);
            } else {
                self.cross(stretch, here, next, see);
            }
            here = next;
        }
        self.last = here.1;
    }

    /// The extremum between two places that are not on different sides, if it may lie on the other side.
    fn dip(
        &mut self,
        stretch: &dyn Stretch,
        from: (f64, f64),
        to: (f64, f64),
    ) -> Option<(f64, f64)> {
        let sign = if from.1 == 0.0 { to.1 } else { from.1 }.signum();
        if from.1 * to.1 < 0.0 || sign.is_nan() {
            return None;
        }
        let aside = ASIDE * (to.0 - from.0);
        // The value at the start may be that of the stretch before, and differ from this one by rounding.
        let behind = self.value(stretch, from.0 + aside) - self.value(stretch, from.0);
        if sign * behind >= 0.0 {
            return None;
        }
        let before = to.1 - self.value(stretch, to.0 - aside);
        if sign * before <= 0.0 {
            return None;
        }
        let extreme = self.extremum(stretch, from.0, to.0, sign > 0.0);
        (sign * extreme.1 < 0.0).then_some(extreme)
    }

    /// Shows the crossing between two places, if there is one.
    fn cross(
        &mut self,
        stretch: &dyn Stretch,
        from: (f64, f64),
        to: (f64, f64),
        see: &mut dyn FnMut(f64, &[f64], bool),
    ) {
        if self.passed(to.1) && self.section.counts(to.1 > 0.0) {
            let phase = self.zero(stretch, from, to);
            stretch.state(phase, &mut self.state);
            see(phase, &self.state, to.1 > 0.0);
        }
    }

    /// The phase between two of different sign where `g` is nearest to zero: Chandrupatla's choice between inverse quadratic
    /// interpolation and bisection.
    fn zero(&mut self, stretch: &dyn Stretch, from: (f64, f64), to: (f64, f64)) -> f64 {
        // It may lie on the surface itself, and has no sign there.
        if from.1 == 0.0 {
            return from.0;
        }
        let (mut a, mut b) = (from, to);
        let mut t = 0.5;
        for _ in 0..100 {
            let phase = a.0 + t * (b.0 - a.0);
            let new = (phase, self.value(stretch, phase));
            if new.1 == 0.0 {
                return phase;
            }
            let old = if (new.1 > 0.0) == (a.1 > 0.0) {
                a
            } else {
                std::mem::replace(&mut b, a)
            };
            a = new;
            let width = (b.0 - a.0).abs();
            if width <= 2.0 * f64::EPSILON * a.0.abs().max(b.0.abs()) {
                break;
            }
            let xi = (a.0 - b.0) / (old.0 - b.0);
            let phi = (a.1 - b.1) / (old.1 - b.1);
            let interpolates = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
            t = if interpolates {
                let by_old = a.1 / (b.1 - a.1) * (old.1 / (b.1 - old.1));
                let by_b =
                    (old.0 - a.0) / (b.0 - a.0) * (a.1 / (old.1 - a.1)) * (b.1 / (old.1 - b.1));
                by_old + by_b
            } else {
                0.5
            };
            let least = f64::EPSILON * a.0.abs() / width;
            t = t.clamp(least, 1.0 - least);
        }
        if a.1.abs() < b.1.abs() { a.0 } else { b.0 }
    }

    /// The smallest `g` between two phases, or the largest: by golden section, until the sign changes.
    fn extremum(&mut self, stretch: &dyn Stretch, from: f64, to: f64, least: bool) -> (f64, f64) {
        let sign = if least { 1.0 } else { -1.0 };
        let (mut low, mut high) = (from, to);
        let mut place = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let mut value = (self.value(stretch, place.0), self.value(stretch, place.1));
        while high - low > 1e-8 * (to - from) {
            if sign * value.0.min(value.1) < 0.0 && sign * value.0.max(value.1) < 0.0 {
                break;
            }
            if sign * value.0 < sign * value.1 {
                high = place.1;
                place = (high - GOLDEN * (high - low), place.0);
                value = (self.value(stretch, place.0), value.0);
            } else {
                low = place.0;
                place = (place.1, low + GOLDEN * (high - low));
                value = (value.1, self.value(stretch, place.1));
            }
        }
        if sign * value.0 < sign * value.1 {
            (place.0, value.0)
        } else {
            (place.1, value.1)
        }
    }
}
