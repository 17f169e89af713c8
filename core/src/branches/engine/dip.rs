//! Orbits inside a step where a function has the other sign than at both ends.
//!
//! Where the [heights](super::heights) of a function above zero at three successive points leave open whether it comes down to zero between two of
//! them, the orbit there is computed, and both parts are looked at with what is known then, until one has the other sign or all stay above. Orbits
//! that were looked at for one function are known to all others.

use super::Engine;
use super::heights::{Height, in_doubt};
use super::seen::Seen;
use super::sought::{Sought, noise_of};
use super::step_parts::{distance, is_on_way, step_between};
use crate::branches::problem::{BranchProblem, TestValue};
use crate::continuation::locate::inside;
use crate::continuation::newton::Newton;

/// So many orbits, and until they come this near to each other, as a part of the step.
pub(super) const LOOKS: usize = 6;
pub(super) const CLOSE: f64 = 1e-3;

/// In which of two steps an orbit is looked for.
#[derive(Debug, Clone, Copy)]
pub(super) enum Within {
    Both,
    First,
    /// Of the first, whose first point has other unknowns, the length is known and no orbit.
    Last(f64),
}

/// Where an orbit of the other sign was found.
pub(super) enum Dip {
    /// In the last step.
    Last(Seen),
    /// In the one before.
    Before(Seen),
}

/// An orbit that was looked at within two steps.
#[derive(Clone)]
pub(super) struct Look {
    /// How far it is behind the first point.
    place: f64,
    seen: Seen,
    /// Its tangent leads along the step.
    on_way: bool,
    /// All that is known where the step begins is known of it.
    is_whole: bool,
}

/// A step in which a test function may come down to zero.
struct Descent<'s> {
    between: [&'s Seen; 2],
    /// Where it begins, and its length.
    from: f64,
    whole: f64,
    sought: Sought,
    kinks: bool,
    sign: f64,
    reference: f64,
}

impl Descent<'_> {
    /// How far the function is above zero at an orbit; `None` where that tells nothing.
    fn height(&self, look: &Look) -> Option<f64> {
        let tells = look.is_whole && (look.on_way || !self.kinks);
        let value = tells.then(|| self.sought.value(&look.seen))?;
        let height = self.sign * value.relative_to(self.reference);
        (!height.is_nan()).then_some(height)
    }

    fn is_within(&self, place: f64) -> bool {
        place > self.from && place < self.from + self.whole
    }
}

impl Engine {
    /// An orbit inside one of two steps where a test function has the other sign than at all their ends.
    pub(super) fn dip(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        looks: &mut Vec<Look>,
        sought: Sought,
    ) -> Option<Dip> {
        self.dip_within(problem, newton, points, Within::Both, looks, sought)
    }

    /// The same in one of them, or both.
    pub(super) fn dip_within(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        within: Within,
        looks: &mut Vec<Look>,
        sought: Sought,
    ) -> Option<Dip> {
        let values = points.map(|seen| sought.value(seen));
        let sign = values[1].mantissa.signum();
        let alike = |value: &TestValue| sign * value.mantissa > 0.0;
        if points[0].point.u.len() != points[1].point.u.len() || !values.iter().all(alike) {
            return None;
        }
        let reference = values.iter().map(|value| value.exponent);
        let reference = reference.fold(f64::NEG_INFINITY, f64::max);
        let heights = values.map(|value| sign * value.relative_to(reference));
        let length = |i: usize| distance(newton, &points[i].point, &points[i + 1].point);
        let (steps, first) = match within {
            Within::Both => (&[1, 0][..], length(0)),
            Within::First => (&[0][..], length(0)),
            Within::Last(way) => (&[1][..], way),
        };
        let lengths = [first, length(1)];
        let places = [0.0, lengths[0], lengths[0] + lengths[1]];
        let known = [0, 1, 2].map(|i| Height {
            place: places[i],
            height: heights[i],
        });
        let noise = match sought {
            Sought::Test(test) => noise_of(problem, test, points[1]),
            Sought::Meeting(_) => 0.0,
        };
        for &first in steps {
            let descent = Descent {
                between: [points[first], points[first + 1]],
                from: places[first],
                whole: lengths[first],
                sought,
                kinks: sought.may_have_kinks(problem),
                sign,
                reference,
            };
            if heights[first].min(heights[first + 1]) <= noise {
                continue;
            }
            if let Some(found) = self.lowest(problem, newton, &descent, &known, looks) {
                return Some(if first == 1 {
                    Dip::Last(found)
                } else {
                    Dip::Before(found)
                });
            }
        }
        None
    }

    /// An orbit of the other sign in a step, if its heights do not exclude it. What is looked at is known to what is looked for next.
    fn lowest(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        descent: &Descent<'_>,
        known: &[Height; 3],
        looks: &mut Vec<Look>,
    ) -> Option<Seen> {
        let Descent { from, whole, .. } = *descent;
        let close = CLOSE * whole;
        let is_open = in_doubt(known, [from, from + whole], close, descent.kinks).is_some();
        let mut known = known.to_vec();
        let mut found = None;
        for look in looks.iter().filter(|look| look.on_way) {
            let Some(height) = descent.height(look) else {
                continue;
            };
            if height < 0.0 {
                if descent.is_within(look.place) {
                    found = found.or(Some(look));
                }
                continue;
            }
            let place = look.place;
            let near = |other: &Height| (other.place - place).abs() < CLOSE * whole;
            if known.iter().any(near) {
                continue;
            }
            let next = known.iter().position(|other| other.place > place);
            known.insert(next.unwrap_or(known.len()), Height { place, height });
        }
        if let Some(found) = found {
            // What its own heights leave no doubt of may have another sign for its unknowns alone.
            return is_open.then(|| found.seen.clone());
        }
        for _ in 0..LOOKS {
            let place = in_doubt(&known, [from, from + whole], close, descent.kinks)?;
            let look = self.look(problem, newton, descent, place)?;
            let height = descent.height(&look);
            looks.push(look.clone());
            let height = height?;
            if height < 0.0 {
                return Some(look.seen);
            }
            let next = known.iter().position(|other| other.place > place)?;
            known.insert(next, Height { place, height });
        }
        None
    }

    /// The orbit at a place of a step, with its test functions.
    fn look(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        descent: &Descent<'_>,
        place: f64,
    ) -> Option<Look> {
        let ends = step_between(descent.between);
        let part = (place - descent.from) / descent.whole;
        // What is only looked at leaves the walk as it is.
        let contraction = newton.contraction();
        let point = inside(problem.equations(), newton, ends, part, self.options.newton);
        newton.remember_contraction(contraction);
        let point = point?;
        let begin = descent.between[0];
        let on_way = is_on_way(newton, ends, &point);
        let seen = Seen::at(problem, &point, begin.falls);
        let mut pairs = seen.values.iter().zip(&begin.values);
        // A part without a value would hide what changes its sign there.
        let is_whole = pairs.all(|(here, there)| here.is_known() || !there.is_known());
        Some(Look {
            place,
            seen,
            on_way,
            is_whole,
        })
    }
}
