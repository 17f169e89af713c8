//! Grazing between two points of a branch.
//!
//! Where the force jumps at the level, or its slope does not exist there, the branch has a corner at the touch: beyond it the orbit
//! moves as the root of the distance, and the branch may turn back. But up to the touch it is smooth, and the distance of the
//! extreme from the level is a linear form of the orbit once its phase is known,
//!
//! ```text
//! d(tau*) . q(tau*) - delta(tau*) - level = 0,                                                                 (1)
//! ```
//!
//! which closes the equations of the orbit, as its value of the parameter or a step along the branch does. They are solved from the end of
//! the step where the level is not crossed, with the phase of the extreme from the orbit before.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing), and 7.1
//! (corners of branches).

use super::Run;
use super::event_monitor::{Found, Test};
use super::events::FOLD_TOLERANCE;
use super::gap_extremes::{Extreme, GapExtremes, Passage, crossings, distinct, is_copy, passed};
use crate::balance::{Balance, Resolution};
use crate::branches::point::Event;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::event::{EventKind, Turn};

/// Values that differ by this part of the range are one.
const SAME: f64 = 1e-9;
/// Extremes that are so near to their levels, in units of the gap, at an orbit that touches one, touch as well: Newton's method leaves
/// less between copies.
const AT_ONCE: f64 = 1e-8;
/// A slope that is smaller where the branch turns does not jump there.
const STEEP: f64 = 1e-6;
/// The extreme is brought so close to its level, in units of the gap, from its side of it.
const AIM: f64 = 1e-12;
/// Each orbit is so much closer than the one before, so that none of them crosses the level on the way.
const CLOSER: f64 = 0.03;
/// Orbits on the way, at most.
const ORBITS: usize = 16;
/// An orbit farther from where it was sought than so many steps is another one.
const FARTHEST: f64 = 3.0;

impl<'a> Run<'a> {
    /// Where an extreme of a gap reaches a level, and whether that is where the branch `turned` back without a fold.
    pub(super) fn grazing(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        gaps: &mut GapExtremes<'a>,
        [before, next]: &mut [Vec<Extreme>; 2],
        turned: Option<Turn>,
    ) {
        gaps.read(&step.before.u, before);
        gaps.read(&step.next.u, next);
        let kind = EventKind::Grazing { turns: false };
        let (first, after) = (self.events.len(), self.points.len() - 1);
        let mut found = passed(before, next);
        if found.is_empty() && crossings(before) != crossings(next) {
            self.omit(kind, step, f64::NAN);
        }
        while let Some(&passage) = found.first() {
            let known = self.events.len();
            self.locate_grazing(balance, newton, step, gaps, &passage);
            if self.events.len() == known {
                found.retain(|other| !is_copy(&passage, other));
            } else {
                found = self.count_contacts(gaps, before, found);
                self.drop_known(first);
            }
        }
        // What was located nowhere may be where the branch turned.
        let omitted = self.turns.iter_mut().filter(|turn| turn.after == after);
        for turn in omitted.filter(|turn| turn.kind == kind) {
            turn.kind = EventKind::Grazing {
                turns: turned.is_some(),
            };
        }
        if let Some(turned) = turned {
            self.turns_at_grazing(first, step, &turned);
        }
    }

    /// Counts the contacts that touch at the last event, of which the first that was `found` led to it, and returns what touches
    /// elsewhere. Contacts that are copies of each other, and orbits with a symmetry, touch in several places at once: one event.
    fn count_contacts(
        &mut self,
        gaps: &mut GapExtremes<'_>,
        extremes: &mut Vec<Extreme>,
        found: Vec<Passage>,
    ) -> Vec<Passage> {
        let (Some(event), Some(&first)) = (self.events.last_mut(), found.first()) else {
            return Vec::new();
        };
        let mut u = event.point.orbit.series.clone();
        u.push(event.point.value);
        gaps.read(&u, extremes);
        let (at_once, later): (Vec<_>, Vec<_>) = found.into_iter().partition(|other| {
            let there = other.before.nearest(extremes);
            let there = there.or(other.next.nearest(extremes));
            *other == first || there.is_some_and(|there| there.above.abs() <= AT_ONCE)
        });
        event.contacts = distinct(&at_once);
        later
    }

    /// Drops the last event if it is one of those from the `first` on.
    fn drop_known(&mut self, first: usize) {
        let range = (self.options.to - self.options.from).abs();
        let Some((last, known)) = self.events[first..].split_last() else {
            return;
        };
        let value = last.point.value;
        let is_known = |other: &Event| (other.point.value - value).abs() <= SAME * range;
        if known.iter().any(is_known) {
            self.events.pop();
        }
    }

    /// Marks the event, of those from the `first` on, at which the branch turned, if there is one: at a corner the slope jumps, and
    /// the value there is beyond those of both ends of the step.
    fn turns_at_grazing(&mut self, first: usize, step: Step<'_>, turned: &Turn) {
        let range = (self.options.to - self.options.from).abs();
        let [a, b] = step.parameters();
        let jumps = turned.test.abs() > STEEP;
        let is_turn = |value: f64| {
            (jumps && (value <= a.min(b) || value >= a.max(b)))
                || (value - turned.value).abs() <= SAME * range
        };
        let mut events = self.events[first..].iter_mut();
        if let Some(event) = events.find(|event| is_turn(event.point.value)) {
            // That is where the branch turned, and why.
            event.kind = EventKind::Grazing { turns: true };
            self.turns.retain(|turn| turn != turned);
        }
    }

    /// Locates where one extreme reaches its level: from the end of the step where the level is not crossed there, or anywhere between
    /// both ends.
    fn locate_grazing(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        gaps: &mut GapExtremes<'a>,
        Passage { before, next }: &Passage,
    ) {
        let kind = EventKind::Grazing { turns: false };
        let (from, extreme) = if before.is_clear() {
            (step.before, before)
        } else {
            (step.next, next)
        };
        let farthest = FARTHEST * newton.norm().length(from.scale, &step.difference());
        let (options, after) = (self.options.newton, self.points.len() - 1);
        let mut closed_in = |balance: &mut Balance<'_>, newton: &mut Newton| {
            let extreme = *extreme;
            let approach = Approach {
                from,
                extreme,
                farthest,
            };
            close_in(balance, newton, gaps, approach, options)
        };
        if let Some(found) = closed_in(balance, newton) {
            let mut test = Test::Extreme(gaps, *extreme);
            let located = &found;
            let found = Found {
                kind,
                located,
                after,
            };
            return self.located(balance, newton, step, &mut test, &found);
        }
        if self.resolution.core < self.resolution.harmonics {
            // What core and tail cannot locate, the whole system may.
            let mut whole = self.context.balance(Resolution {
                core: self.resolution.harmonics,
                ..self.resolution
            });
            let mut newton = Newton::new(&whole);
            let found = closed_in(&mut whole, &mut newton);
            if let Some(located) = &found {
                let mut test = Test::Extreme(gaps, *extreme);
                let found = Found {
                    kind,
                    located,
                    after,
                };
                self.located(&mut whole, &mut newton, step, &mut test, &found);
            }
            self.statistics += newton.statistics;
            if found.is_some() {
                return;
            }
        }
        let mut test = Test::Extreme(gaps, *before);
        self.event(balance, newton, step, kind, &mut test);
    }
}

/// Where the search for an orbit that touches a level begins, and how far it may lead.
#[derive(Clone, Copy)]
struct Approach<'p> {
    from: &'p CurvePoint,
    extreme: Extreme,
    farthest: f64,
}

/// The orbit whose extreme reaches its level, by Newton's method with (1) as its border; `None` if that leads elsewhere.
fn close_in(
    balance: &mut Balance<'_>,
    newton: &mut Newton,
    gaps: &mut GapExtremes<'_>,
    approach: Approach<'_>,
    options: NewtonOptions,
) -> Option<Located> {
    let Approach {
        from,
        mut extreme,
        farthest,
    } = approach;
    let scale = from.scale;
    let mut u = from.u.clone();
    let mut row = vec![0.0; u.len()];
    let mut extremes = Vec::new();
    for _ in 0..ORBITS {
        let aim = extreme.above.signum() * (CLOSER * extreme.above.abs()).max(AIM);
        gaps.form(&u, &extreme, scale.parameter, &mut row);
        let border = Border {
            row: &row,
            value: crate::numeric::linear::dot(&row, &u) + aim - extreme.above,
        };
        newton
            .correct(balance, &mut u, border, scale, options)
            .ok()?;
        gaps.read(&u, &mut extremes);
        extreme = *extreme.nearest(&extremes)?;
        if extreme.above.abs() > FOLD_TOLERANCE {
            continue;
        }
        let pairs = u.iter().zip(&from.u);
        let moved: Vec<f64> = pairs.map(|(x, y)| x - y).collect();
        let mut tangent = vec![0.0; u.len()];
        if newton.norm().length(scale, &moved) > farthest
            || !newton.tangent(balance, &u, &mut tangent, true)
        {
            return None;
        }
        let length = newton.norm().length(scale, &tangent);
        for t in &mut tangent {
            *t /= length;
        }
        return Some(Located {
            point: CurvePoint { u, tangent, scale },
            test: extreme.above,
            vanishes: true,
        });
    }
    None
}
