//! Steps within which an extreme of a gap passes a narrow place of its law.
//!
//! A law without levels can change as abruptly as one with them: a hyperbolic tangent, an exponential or a quotient of a small width
//! `w` (see [`narrow`](crate::laws::generic::narrow)). While an extreme of the gap comes to such a place and goes beyond it, the branch may
//! turn twice and its orbits lose and regain stability, all while the extreme moves by a few widths. A step is as long as the branch before
//! allowed, and neither its ends nor differences of three points know of the place. But the extreme does: along the branch it goes
//! through the place steadily, even where the parameter turns back. So a step in which it [goes through](Narrow::is_leapt_over) more than a part of the place is made
//! again, shorter, and orbits whose extreme is at
//!
//! ```text
//! g(tau*) = place + j w,        j = -2, -1, 0, 1, 2                                                            (1)
//! ```
//!
//! as far as they are between both ends, are computed by Newton's method with (1) as its border, as orbits that [touch](super::grazing_search) a
//! level are, and divide the step. Where the branch turns sharply between two of them, or before the first one, more of them follow.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2: at a touch the
//! distance of the extreme, not the parameter, tells the orbits apart.

use super::Engine;
use super::grazing::Gaps;
use super::seen::Seen;
use crate::branches::extreme::{Extreme, pairs};
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Border, Newton};
use crate::continuation::problem::Norm;
use crate::laws::generic::narrow::Narrow;
use crate::numeric::linear::dot;
use crate::numeric::roots::{Bracket, Place};

/// Gaps of (1) are looked at up to this one.
const FARTHEST: i32 = 2;
/// A step in which an extreme moves by fewer widths sees the place.
const SEEN: f64 = 1.5;
/// A gap of (1) is reached if it is nearer than this part of the width, after so many corrections at most.
const REACHED: f64 = 0.25;
const CORRECTIONS: usize = 8;
/// So many orbits, at most.
const ORBITS: usize = 30;
/// Points whose extremes are remembered: those of the last step, and the next one.
const READ: usize = 3;
/// A step is made shorter so often for a narrow place at most: one of a thousandth of it is come to so.
pub(super) const NARROWED: usize = 12;
/// No step that is shorter than this is made again.
const SHORTEST: f64 = 1e-4;
/// Along the tangent by less than this part of the step.
const SHORT: f64 = 0.5;
/// Between orbits whose tangents have a product below this another one is computed, unless the extreme moves by less than this part of
/// its distance or of the width.
const TURNED: f64 = 0.5;
const CLOSEST: f64 = 0.02;
/// An orbit farther from the beginning of a part than so many steps is another one.
const APART: f64 = 2.0;

/// Where the next orbit of a step is sought.
struct Target {
    /// As it is at the orbits before and behind.
    ends: [Extreme; 2],
    /// The gap that it is to have, and how near.
    gap: f64,
    near: f64,
    /// Where that is on the way to the end of the step.
    part: f64,
}

/// A narrow place of the law of a contact.
struct NarrowPlace {
    contact: usize,
    narrow: Narrow,
}

impl Engine {
    /// Whether the step to a point that is not kept yet goes through more of a narrow place than it may. Then the walk is to go back: what happens in the
    /// place is seen where there are points in it, and orbits of (1) may be out of reach from outside of it.
    pub(super) fn leaps_over_narrow(
        &mut self,
        problem: &mut dyn BranchProblem,
        next: &CurvePoint,
    ) -> bool {
        if !problem.resolves_sharp() {
            return false;
        }
        let last = self.seen.last().map(|seen| seen.point.clone());
        let Some(before) = last.filter(|last| last.u.len() == next.u.len()) else {
            return false;
        };
        let ends = [&before, next].map(|point| self.plain_at(problem, point));
        let [Some(here), Some(there)] = ends else {
            return false;
        };
        let difference = step(&here, &there).difference();
        let places = places_between(problem, &here, &there);
        let leapt = pairs(&here.extremes, &there.extremes).any(|[extreme, end]| {
            let mut of_contact = places
                .iter()
                .filter(|place| place.contact == extreme.contact);
            of_contact.any(|place| place.narrow.is_leapt_over([extreme.gap(), end.gap()]))
        });
        let leaps = leapt
            && self.narrowed < NARROWED
            && Norm::of(problem.equations()).length(before.scale, &difference) > SHORTEST
            && self.go_back(problem, next);
        self.narrowed += usize::from(leaps);
        leaps
    }

    /// The step between two points, divided at the orbits at which extremes are in narrow places of their laws.
    pub(super) fn through_narrow(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [a, b]: [Seen; 2],
    ) -> Vec<Seen> {
        let ends = [&a, &b].map(|seen| self.plain_at(problem, &seen.point));
        let mut parts = vec![a, b];
        let [Some(before), Some(next)] = ends else {
            return parts;
        };
        let places = places_between(problem, &before, &next);
        let longest = APART * apart(newton, &before, &next);
        let mut gaps = vec![before, next];
        let mut part = 0;
        while part + 1 < parts.len() && parts.len() < ORBITS {
            let pair = [&gaps[part], &gaps[part + 1]];
            let target = next_target(pair, &places)
                .or_else(|| middle(pair, &places).filter(|_| turns(newton, pair)));
            let found = target.and_then(|target| self.orbit_at(problem, newton, pair, &target));
            let Some(found) = found.filter(|found| apart(newton, pair[0], found) <= longest) else {
                part += 1;
                continue;
            };
            let seen = Seen::at(problem, &found.point, parts[part].falls);
            parts.insert(part + 1, seen);
            gaps.insert(part + 1, found);
        }
        parts
    }

    /// The extremes at a point as they are, which are read once.
    fn plain_at(&mut self, problem: &mut dyn BranchProblem, point: &CurvePoint) -> Option<Gaps> {
        let mut known = self.plain.iter();
        if let Some(known) = known.find(|gaps| gaps.point == *point) {
            return Some(known.clone());
        }
        let mut extremes = Vec::new();
        let point = point.clone();
        let known = problem.plain_extremes(&point.u, &mut extremes);
        let gaps = known.then_some(Gaps { point, extremes })?;
        if self.plain.len() == READ {
            self.plain.remove(0);
        }
        self.plain.push(gaps.clone());
        Some(gaps)
    }

    /// The orbit at a target between two others: what the linear form of the extreme at the first of them has to be there. Of states where
    /// segments begin, far from the extreme, it tells the gap to first order only, so that its value is interpolated.
    fn orbit_at(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [here, next]: [&Gaps; 2],
        target: &Target,
    ) -> Option<Gaps> {
        let (scale, options) = (here.point.scale, self.options.newton);
        let mut form = vec![0.0; here.point.u.len()];
        let [mut extreme, end] = target.ends;
        let of_states = Extreme {
            of_states: true,
            ..extreme
        };
        if !problem.extreme_form(&here.point.u, &of_states, scale.parameter, &mut form) {
            return None;
        }
        let ends = [(here, extreme), (next, end)].map(|(gaps, extreme)| Place {
            x: dot(&form, &gaps.point.u),
            value: extreme.gap() - target.gap,
        });
        let onward = end.gap() - extreme.gap();
        let mut bracket = Bracket::new(ends[0], ends[1], 0.0);
        let first = bracket.at(bracket.part());
        let ahead = (first - ends[0].x) / dot(&form, &here.point.tangent);
        let mut at = target.start(newton, step(here, next), ahead);
        let mut extremes = Vec::new();
        for _ in 0..CORRECTIONS {
            let value = bracket.at(bracket.part());
            let border = Border { row: &form, value };
            let solved = newton.correct(problem.equations(), &mut at, border, scale, options);
            solved.ok()?;
            problem.plain_extremes(&at, &mut extremes);
            extreme = *extreme.nearest(&extremes)?;
            let above = extreme.gap() - target.gap;
            if above.abs() <= target.near {
                let mut tangent = vec![0.0; at.len()];
                if !newton.tangent(problem.equations(), &at, &mut tangent, true)
                    || !problem.extreme_form(&at, &extreme, scale.parameter, &mut form)
                {
                    return None;
                }
                // The extreme goes on.
                let way = (dot(&form, &tangent) * onward).signum();
                let length = newton.norm().length(scale, &tangent);
                for t in &mut tangent {
                    *t *= way / length;
                }
                let point = CurvePoint {
                    u: at,
                    tangent,
                    scale,
                };
                return Some(Gaps { point, extremes });
            }
            bracket.take(Place {
                x: value,
                value: above,
            });
        }
        None
    }
}

impl Target {
    /// Near the orbit: on along the tangent, or where that leads too far, as at the beginning of a long step, towards its end.
    fn start(&self, newton: &Newton, step: Step<'_>, ahead: f64) -> Vec<f64> {
        let from = step.before;
        let chord = step.difference();
        let short = SHORT * newton.norm().length(from.scale, &chord);
        let (direction, part) = if (0.0..short).contains(&ahead) {
            (&from.tangent, ahead)
        } else {
            (&chord, self.part)
        };
        let pairs = from.u.iter().zip(direction);
        pairs.map(|(x, y)| x + part * y).collect()
    }
}

/// The step from one orbit to another.
fn step<'g>(here: &'g Gaps, next: &'g Gaps) -> Step<'g> {
    Step {
        before: &here.point,
        next: &next.point,
    }
}

/// How far one orbit is from another.
fn apart(newton: &Newton, here: &Gaps, next: &Gaps) -> f64 {
    let difference = step(here, next).difference();
    newton.norm().length(here.point.scale, &difference)
}

/// Whether the branch turns so much from one orbit to another that what is between them cannot be located by its place along the tangent.
fn turns(newton: &Newton, [here, next]: [&Gaps; 2]) -> bool {
    let (a, b) = (&here.point, &next.point);
    newton.norm().product(a.scale, &a.tangent, &b.tangent) < TURNED
}

/// The narrow places near the ways of all extremes from one orbit to another.
fn places_between(problem: &mut dyn BranchProblem, before: &Gaps, next: &Gaps) -> Vec<NarrowPlace> {
    let mut places: Vec<NarrowPlace> = Vec::new();
    for [extreme, there] in pairs(&before.extremes, &next.extremes) {
        let ways = [extreme.gap(), there.gap()];
        let moved = (ways[1] - ways[0]).abs();
        let range = [ways[0].min(ways[1]) - moved, ways[0].max(ways[1]) + moved];
        let of_contact = places
            .iter()
            .filter(|place| place.contact == extreme.contact);
        let mut found: Vec<Narrow> = of_contact.map(|place| place.narrow).collect();
        let known = found.len();
        problem.narrow_places(&before.point.u, extreme.contact, range, &mut found);
        places.extend(found[known..].iter().map(|narrow| NarrowPlace {
            contact: extreme.contact,
            narrow: *narrow,
        }));
    }
    places
}

/// The nearest gap of (1) on the way from one orbit to another, if any extreme passes its place too fast.
fn next_target([here, next]: [&Gaps; 2], places: &[NarrowPlace]) -> Option<Target> {
    let mut nearest: Option<Target> = None;
    for [extreme, there] in pairs(&here.extremes, &next.extremes) {
        let (from, way) = (extreme.gap(), there.gap() - extreme.gap());
        let of_contact = places
            .iter()
            .filter(|place| place.contact == extreme.contact);
        for NarrowPlace { narrow, .. } in
            of_contact.filter(|place| way.abs() > SEEN * place.narrow.width)
        {
            let near = REACHED * narrow.width;
            let beside = 2.0 * near / way.abs();
            let gaps = (-FARTHEST..=FARTHEST).map(|j| narrow.at + f64::from(j) * narrow.width);
            let ahead = gaps.map(|gap| ((gap - from) / way, gap));
            for (part, gap) in ahead.filter(|(part, _)| *part > beside && *part < 1.0 - beside) {
                if nearest.as_ref().is_none_or(|other| part < other.part) {
                    nearest = Some(Target {
                        ends: [*extreme, *there],
                        gap,
                        near,
                        part,
                    });
                }
            }
        }
    }
    nearest
}

/// Half of the way that an extreme goes near a place, in the distance from it or, of one that comes from afar, in its logarithm.
fn middle([here, next]: [&Gaps; 2], places: &[NarrowPlace]) -> Option<Target> {
    let mut most = CLOSEST;
    let mut found = None;
    for [extreme, there] in pairs(&here.extremes, &next.extremes) {
        let of_contact = places
            .iter()
            .filter(|place| place.contact == extreme.contact);
        for NarrowPlace { narrow, .. } in of_contact {
            let [from, to] = [extreme, there].map(|extreme| extreme.gap() - narrow.at);
            let moved = (to - from).abs() / from.abs().min(to.abs()).max(narrow.width);
            if moved <= most {
                continue;
            }
            most = moved;
            let height = if from * to > narrow.width * narrow.width {
                from.signum() * (from * to).sqrt()
            } else {
                0.5 * (from + to)
            };
            found = Some(Target {
                ends: [*extreme, *there],
                gap: narrow.at + height,
                near: REACHED * (height - from).abs().min((to - height).abs()),
                part: (height - from) / (to - from),
            });
        }
    }
    found
}
