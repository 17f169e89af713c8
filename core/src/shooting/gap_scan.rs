//! The extremes of a gap along an orbit: where its rate vanishes. Where it may do so twice between two samples it is followed to where it is nearest to
//! zero.

use std::f64::consts::TAU;

use super::equations::Equations;
use crate::branches::recurrence::Recurrence;
use crate::numeric::peak;
use crate::numeric::roots::{self, Place};
use crate::time::Stretch;
use crate::time::gap::Gap;

/// Samples of the rate in one period of the system.
const SAMPLES: f64 = 64.0;
/// Accuracy of the phase of an extreme, in parts of the distance of two samples.
const LOCATED: f64 = 1e-9;
/// Slopes of a rate are differences over this part of that distance.
const SHORT: f64 = 1e-4;
/// Tangents that meet above this part of the smaller one of two rates tell that the rate does not vanish between them: it is above them where it
/// is convex.
const BOUND: f64 = 0.5;

/// An extreme of a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extreme {
    /// Phase since the beginning of the orbit.
    pub(super) passed: f64,
    /// The gap there.
    pub(super) gap: f64,
    pub(super) largest: bool,
}

/// Reads the extremes of a gap off an orbit, from stretch to stretch.
struct Scan<'s> {
    gap: &'s Gap,
    state: &'s mut [f64],
    see: &'s mut dyn FnMut(Extreme),
    /// The phase since the beginning.
    passed: f64,
    /// The rate where the last stretch ended. It is carried to the next one: where a step ends at an extreme, rounding could change its
    /// sign.
    last: Option<f64>,
    /// Phases where what is followed of the orbit begins and ends, and the states there.
    ends: [f64; 2],
    first: &'s mut [f64],
    end: &'s mut [f64],
}

/// Where a rate that has one sign at both ends has the other between them, if it does: two extremes are between two samples there. It comes
/// nearest to zero between ends from which it falls, and at least about as near as the tangents there meet.
fn across([a, b]: [Place; 2], mut rate: impl FnMut(f64) -> f64) -> Option<Place> {
    let width = b.x - a.x;
    let (short, sign) = (SHORT * width, a.value.signum());
    let fall = sign * (a.value - rate(a.x + short)) / short;
    let rise = sign * (b.value - rate(b.x - short)) / short;
    let (high, end) = (a.value.abs(), b.value.abs());
    // high - fall x = end - rise (width - x)
    let meet = high - fall * (high - end + rise * width) / (fall + rise);
    if fall.min(rise) <= 0.0 || meet > BOUND * high.min(end) {
        return None;
    }
    let mut found = None;
    let ends = [a, b].map(|end| Place {
        value: -end.value.abs(),
        ..end
    });
    peak::largest(
        |x| {
            let value = rate(x);
            if sign * value < 0.0 && found.is_none() {
                found = Some(Place { x, value });
            }
            -sign * value
        },
        ends,
        None,
    );
    found
}

impl Scan<'_> {
    fn stretch(&mut self, stretch: &dyn Stretch) {
        let (from, to) = stretch.phases();
        let (gap, state) = (self.gap, &mut *self.state);
        let mut at = |phase: f64| {
            stretch.state(phase, state);
            gap.at(phase, state)
        };
        let parts = (SAMPLES * (to - from) / TAU).ceil().max(2.0);
        let mut before = Place {
            x: from,
            value: self.last.unwrap_or_else(|| at(from).1),
        };
        // A dip of the rate between two samples is at most as deep as it changes over the ones before, where it is a parabola.
        let mut change = f64::INFINITY;
        let mut part = 1.0;
        while part <= parts {
            let x = from + (to - from) * (part / parts);
            let value = at(x).1;
            let next = Place { x, value };
            let between = (before.value * value > 0.0
                && before.value.abs().min(value.abs()) <= change)
                .then(|| across([before, next], |phase| at(phase).1));
            let places = [before, between.flatten().unwrap_or(next), next];
            for ends in places.windows(2) {
                let [a, b] = [ends[0], ends[1]];
                let within = LOCATED * (next.x - before.x);
                let zero = (a.value * b.value < 0.0)
                    .then(|| roots::root(a, b, within, |phase| at(phase).1));
                if let Some(phase) = zero.flatten() {
                    (self.see)(Extreme {
                        passed: self.passed + phase - from,
                        gap: at(phase).0,
                        largest: a.value > 0.0,
                    });
                }
            }
            change = (value - before.value).abs();
            // Between two switches at one phase there is no rate.
            if value.abs() > 0.0 {
                before = next;
            }
            part += 1.0;
        }
        if self.last.is_none() {
            self.ends[0] = from;
            stretch.state(from, self.first);
        }
        self.last = Some(before.value);
        self.ends[1] = to;
        stretch.state(to, self.end);
        self.passed += to - from;
    }

    /// The extremes where what is followed of the orbit ends and begins again: there its image goes on, and came from. Of all of an orbit
    /// both are one.
    fn close(&mut self, recurrence: &Recurrence) -> Option<()> {
        let rate = self.last?;
        let image = &recurrence.image;
        let (gap, [begin, end]) = (self.gap, self.ends);
        let coordinates = self.state.len() / 2;
        for (i, x) in self.state.iter_mut().enumerate() {
            let (place, sign) = image.state_entry(i, coordinates);
            *x = sign * self.first[place];
        }
        let after = gap.at(end, self.state).1;
        if rate * after < 0.0 || after == 0.0 && rate != 0.0 {
            (self.see)(Extreme {
                passed: self.passed,
                gap: gap.at(end, self.end).0,
                largest: rate > 0.0,
            });
        }
        if recurrence.parts == 1 {
            return Some(());
        }
        for (i, x) in self.end.iter().enumerate() {
            let (place, sign) = image.state_entry(i, coordinates);
            self.state[place] = sign * x;
        }
        let before = gap.at(begin, self.state).1;
        let (gap, first) = gap.at(begin, self.first);
        if before * first < 0.0 || first == 0.0 && before != 0.0 {
            (self.see)(Extreme {
                passed: 0.0,
                gap,
                largest: before > 0.0,
            });
        }
        Some(())
    }
}

/// Room for three states.
pub(super) struct Room<'s> {
    pub(super) state: &'s mut [f64],
    pub(super) first: &'s mut [f64],
    pub(super) end: &'s mut [f64],
}

/// Shows all extremes of a gap along an orbit. As long as the orbit does not close, the rate has two values where it ends and
/// begins again, with an extreme between them if their signs differ.
pub(super) fn extremes(
    gap: &Gap,
    equations: &mut Equations,
    u: &[f64],
    room: Room<'_>,
    see: &mut dyn FnMut(Extreme),
) -> Option<()> {
    let Room { state, first, end } = room;
    let mut scan = Scan {
        gap,
        state,
        see,
        passed: 0.0,
        last: None,
        ends: [0.0; 2],
        first,
        end,
    };
    if let Err(failure) = equations.trace(u, &mut |stretch| scan.stretch(stretch)) {
        equations.failure = Some(failure);
        return None;
    }
    scan.close(&equations.span.recurrence)
}
