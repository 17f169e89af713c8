//! Where a function of phase and state vanishes along a motion.
//!
//! Along each smooth stretch `g` is sampled; a change of sign is closed in to the last bits of
//! the phase. Where `g` has the same sign at two samples, comes nearer to zero behind the first and goes away from it before the
//! second, its extremum between them is closed in as well, so that two crossings in quick succession are not lost.

use std::f64::consts::TAU;

use super::Section;
use crate::numeric::roots::{self, Place};
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
    /// Workspace.
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

    fn place(&mut self, stretch: &dyn Stretch, phase: f64) -> Place {
        Place {
            x: phase,
            value: self.value(stretch, phase),
        }
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
        let mut here = Place {
            x: from,
            value: self.last,
        };
        for i in 1..=count as usize {
            let phase = at(i as f64);
            let next = self.place(stretch, phase);
            if let Some(extreme) = self.dip(stretch, here, next) {
                self.cross(stretch, here, extreme, see);
                self.cross(stretch, extreme, next, see);
            } else {
                self.cross(stretch, here, next, see);
            }
            here = next;
        }
        self.last = here.value;
    }

    /// The extremum between two places that are not on different sides, if it may lie on the other side.
    fn dip(&mut self, stretch: &dyn Stretch, from: Place, to: Place) -> Option<Place> {
        let begins = if from.value == 0.0 { to } else { from };
        let sign = begins.value.signum();
        if from.value * to.value < 0.0 || sign.is_nan() {
            return None;
        }
        let aside = ASIDE * (to.x - from.x);
        // The value at the start may be that of the stretch before, and differ from this one by rounding.
        let behind = self.value(stretch, from.x + aside) - self.value(stretch, from.x);
        if sign * behind >= 0.0 {
            return None;
        }
        let before = to.value - self.value(stretch, to.x - aside);
        if sign * before <= 0.0 {
            return None;
        }
        let extreme = self.extremum(stretch, from.x, to.x, sign > 0.0);
        (sign * extreme.value < 0.0).then_some(extreme)
    }

    /// Shows the crossing between two places, if there is one.
    fn cross(
        &mut self,
        stretch: &dyn Stretch,
        from: Place,
        to: Place,
        see: &mut dyn FnMut(f64, &[f64], bool),
    ) {
        let rises = to.value > 0.0;
        if self.passed(to.value) && self.section.counts(rises) {
            // `from` may lie on the surface itself. Without a value there is no place, and the search ends with that.
            let zero = roots::root(from, to, 0.0, |phase| self.value(stretch, phase));
            if let Some(phase) = zero {
                stretch.state(phase, &mut self.state);
                see(phase, &self.state, rises);
            }
        }
    }

    /// The smallest `g` between two phases, or the largest: by golden section, until the sign changes.
    fn extremum(&mut self, stretch: &dyn Stretch, from: f64, to: f64, least: bool) -> Place {
        let sign = if least { 1.0 } else { -1.0 };
        let (mut low, mut high) = (from, to);
        let mut left = self.place(stretch, high - GOLDEN * (high - low));
        let mut right = self.place(stretch, low + GOLDEN * (high - low));
        while high - low > 1e-8 * (to - from) {
            if sign * left.value < 0.0 && sign * right.value < 0.0 {
                break;
            }
            if sign * left.value < sign * right.value {
                high = right.x;
                right = left;
                left = self.place(stretch, high - GOLDEN * (high - low));
            } else {
                low = left.x;
                left = right;
                right = self.place(stretch, low + GOLDEN * (high - low));
            }
        }
        if sign * left.value < sign * right.value {
            left
        } else {
            right
        }
    }
}
