//! Beyond a touch of a level at which the force jumps, or its slope is unbounded.
//!
//! An orbit whose extreme is by `h` beyond the level is there for a time that goes as the root of `h`, and the jump of the force gives it
//! an impulse that does so too. With the equations `R(u) = 0` as they are without it, and `v` what the jump does to them,
//!
//! ```text
//! R(u) + sqrt(h) v + O(h) = 0,    h = d . (u - u_0)                                                            (1)
//! ```
//!
//! at the touch `u_0`, so that `h` is quadratic in the arc length and the branch goes on as
//!
//! ```text
//! u = u_0 - sqrt(h) w + O(h),    R_u w = v,    d . w = 0                                                       (2)
//! ```
//!
//! which is a corner of any angle. If it is sharper than a right one, no plane across the tangent before it cuts the branch behind it, and
//! steps of arc length end. But `h` itself goes through zero from one side to the other. At a prescribed `h`, where `sqrt(h)` is
//! constant, the equations are as well conditioned as those of the touch. The orbit is sought from (2) with the matrix of the touch: one
//! side is reached from the other with steps along the tangent, which bring `h` to what is wanted, and steps that solve (1).
//!
//! Where the force goes as `g^p` beyond the level, its impulse goes as `h^(p + 1/2)` in place of the root in (1). With `p` below a half the
//! branch has the same corner. Below one its slope is continuous, but it goes to its limit as `h^(p - 1/2)`, which at `p = 0.6` is still a
//! fortieth of what it is at a height of one when rounding hides `h`: no step of arc length sees that the branch bends. So such a touch is passed in the
//! same way, where steps fail.
//!
//! By shooting the branch has a kink too where a gap passes a level at which the force jumps just where its unknowns begin to tell the orbit. Nothing
//! happens to the orbit there, but Newton's method may fail beside it: it is passed in the same way.
//!
//! If the force on the other side pulls the gap on, motions that pass the level go far away however slowly they pass it: then there is
//! no orbit at a small `h`, and the branch ends.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (the square root) and 7.1
//! (corners of branches); Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (a border that is not the
//! tangent).

use super::corner_search::{Beside, Corner, CornerSearch};
use super::grazing::Gaps;
use super::grazing_search::Approach;
use super::grazing_within_step::Steps;
use super::seen::{Crossed, Seen};
use super::step_parts::distance;
use super::{Engine, Looked};
use crate::branches::extreme::{Bend, Extreme, passed};
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::{CurvePoint, Step, Stop};
use crate::continuation::locate::ArcLength;
use crate::continuation::newton::Newton;
use crate::continuation::problem::Norm;
use crate::numeric::linear::dot;

/// A corner is looked for as far ahead as so many times the step that failed.
const REACH: f64 = 2.0;
/// A step so much shorter is worth another look.
const SHORTER: f64 = 0.1;
/// An orbit farther away than so many times that is another one.
const FARTHEST: f64 = 10.0;
/// Extremes that are farther from their level, in units of the gap, are not those that a step fails at.
const NEAR: f64 = 0.2;
/// Kinks where nothing touches are looked for where so short a step fails.
const SHORTEST: f64 = 1e-3;
/// Where the slope is unbounded the branch is smooth at last, and steps lead on unless they fail when they are so short.
const BENDS_WITHIN: f64 = 1e-5;
/// Where a step leads over a level at which the branch has a corner and none is found, it is made again, so much shorter; down to this length where the force
/// jumps there.
const AGAIN: f64 = 0.2;
const SHORTEST_AGAIN: f64 = 1e-7;
/// A corner that is farther away than this is none of the branch if test functions jump on the way to it.
const FAR_LIMB: f64 = 1e-4;
/// A step that is made again for what is within it is shorter by as much, and by as much if that is not known.
const LONGEST: f64 = 0.95;
const HALF: f64 = 0.5;
/// Behind a corner the first step is at most so many times as long as what the walk goes on behind it.
const ONWARD: f64 = 2.0;
/// A walk that ends nearer to a touch than this ends there.
const PULLED: f64 = 1e-5;

/// A corner, and where the walk goes on behind it.
pub(super) struct Passed {
    pub(super) corner: Corner,
    pub(super) next: Beside,
    /// How far that is behind it.
    way: f64,
    /// The extreme that leads to it, at the point before, and how far that may be.
    pub(super) extreme: Extreme,
    pub(super) length: f64,
}

/// What is tried out on the way.
pub(super) struct Tried<'p> {
    pub(super) problem: &'p mut dyn BranchProblem,
    pub(super) newton: Newton,
    coupled: bool,
}

impl<'p> Tried<'p> {
    /// With all of the equations in the matrix.
    fn begin(problem: &'p mut dyn BranchProblem) -> Self {
        let coupled = problem.couple_fully_once(true);
        Self {
            newton: Newton::new(problem.equations()),
            problem,
            coupled,
        }
    }

    fn end(self) {
        self.problem.count(&self.newton);
        if self.coupled {
            self.problem.couple_fully_once(false);
        }
    }
}

impl Engine {
    /// Looks for a corner of the branch ahead of a point where a step of some length failed.
    pub(super) fn corner_ahead(
        &mut self,
        problem: &mut dyn BranchProblem,
        at: &CurvePoint,
        step: f64,
    ) -> bool {
        let looked = self.looked.take().filter(|looked| looked.at == at.u);
        let enough = |looked: &Looked| step > SHORTER * looked.step;
        if !problem.corners() || looked.as_ref().is_some_and(enough) {
            self.looked = looked;
            return false;
        }
        self.looked = Some(Looked {
            at: at.u.clone(),
            step,
        });
        let ahead = ahead(problem, at, step);
        self.pass(problem, at, &ahead)
    }

    /// Looks for a corner in the step to a point that is not kept yet.
    pub(super) fn corner_before(
        &mut self,
        problem: &mut dyn BranchProblem,
        next: &CurvePoint,
    ) -> bool {
        if !problem.corners() {
            return false;
        }
        let last = self.seen.last().map(|seen| seen.point.clone());
        let Some(before) = last.filter(|last| last.u.len() == next.u.len()) else {
            return false;
        };
        let [Some(here), Some(there)] = [&before, next].map(|at| self.gaps_at(problem, at)) else {
            return false;
        };
        let norm = Norm::of(problem.equations());
        let step = Step {
            before: &before,
            next,
        };
        let length = norm.length(before.scale, &step.difference());
        let through = passed(&here.extremes, &there.extremes).into_iter();
        let through = through.map(|passage| (length, passage.before));
        let bent = through.filter(|(_, extreme)| extreme.bend == Bend::Corner);
        let through: Vec<_> = bent.collect();
        if through.is_empty() {
            if problem.force_jumps() {
                let within = self.corner_within(problem, [here, there], length);
                if let Some((before, way)) = within
                    && self.shortest_asked(problem) > SHORTEST_AGAIN
                {
                    self.ask_at_most(problem, before, way, LONGEST);
                }
            }
            return self.back.is_some();
        }
        let passed = self.pass(problem, &before, &through);
        let jumps = through.iter().any(|(_, extreme)| extreme.jumps);
        let shortest = if jumps { SHORTEST_AGAIN } else { SHORTEST };
        if !passed && length.min(self.shortest_asked(problem)) > shortest {
            // Another limb, or a touch that is too far to be found from here.
            self.ask_again(problem, before, AGAIN * length);
        }
        passed || self.back.is_some()
    }

    /// The point before a step so long, and a shorter step from there, if an extreme goes through a level at which the force jumps and back between both
    /// ends, or may do so: to where it is beyond the level.
    fn corner_within(
        &mut self,
        problem: &mut dyn BranchProblem,
        [here, there]: [Gaps; 2],
        length: f64,
    ) -> Option<(CurvePoint, f64)> {
        let earlier = self.seen.len().checked_sub(2)?;
        let earlier = self.seen[earlier].point.clone();
        let ends = [self.gaps_at(problem, &earlier)?, here, there];
        let ends = ends.map(|mut gaps| {
            gaps.extremes.retain(|extreme| extreme.jumps);
            gaps
        });
        let before = ends[1].point.clone();
        let mut newton = Newton::new(problem.equations());
        let mut steps = Steps::new(&newton, ends)?;
        steps.divide_last(problem, &mut newton, self.options.newton);
        problem.count(&newton);
        let [way, shortest] = match &steps.parts[1][..] {
            [_, inner, _, ..] => {
                let way = distance(&newton, &before, &inner.point);
                [way.min(LONGEST * length), SHORTEST_AGAIN]
            }
            // At a corner on the way there the branch leaves the step.
            _ => [steps.doubt?.min(HALF * length), SHORTEST],
        };
        (way > shortest).then_some((before, way))
    }

    /// Why a walk ended, with the reason if that is a touch behind which there are no orbits near by.
    pub(super) fn named(&self, problem: &mut dyn BranchProblem, stop: Stop) -> Stop {
        let (Stop::StepTooShort { value, .. }, Some(last)) = (stop, self.seen.last()) else {
            return stop;
        };
        if !problem.force_jumps() {
            return stop;
        }
        let u = &last.point.u;
        let mut extremes = Vec::new();
        problem.extremes(u, &mut extremes);
        let touches = |extreme: &Extreme| extreme.jumps && extreme.above.abs() < PULLED;
        if extremes.iter().any(touches) || problem.slowest(u) < PULLED {
            return Stop::PulledOn { value };
        }
        stop
    }

    /// Passes the nearest corner to which one of these extremes leads: records it, and remembers a point behind it to go on from.
    fn pass(
        &mut self,
        problem: &mut dyn BranchProblem,
        at: &CurvePoint,
        extremes: &[(f64, Extreme)],
    ) -> bool {
        if extremes.is_empty() {
            return false;
        }
        let mut tried = Tried::begin(problem);
        let found = extremes.iter().filter_map(|(length, extreme)| {
            let mut search = self.search(&mut tried, at, *extreme, *length);
            let corner = search.corner()?;
            let next = search.behind(&corner)?;
            let distance = search.distance(at, &corner.end);
            let way = search.distance(&corner.begin, &next.point);
            Some((
                distance,
                Passed {
                    corner,
                    next,
                    way,
                    length: *length,
                    extreme: *extreme,
                },
            ))
        });
        let nearest = found.min_by(|a, b| a.0.total_cmp(&b.0));
        // Where the equations hold no more at a touch, something else comes first, and the way to it is to be gone in shorter steps.
        let nearest = nearest.filter(|(_, passed)| {
            let touch = &passed.corner.touch.located.point;
            let mut both = [touch, &passed.next.point].into_iter();
            both.all(|at| tried.problem.describes(at))
        });
        let passed = nearest.filter(|(distance, passed)| {
            let end = &passed.corner.end;
            // From where the level is not crossed the branch is smooth up to the touch.
            let is_far = passed.extreme.is_clear() && *distance > FAR_LIMB;
            let Tried {
                problem, newton, ..
            } = &mut tried;
            !(is_far && self.jumps(*problem, newton, end, false))
        });
        let passed = passed.map(|(_, passed)| passed);
        if let Some(passed) = &passed {
            let after = tried.problem.points();
            self.behind = self.keep_corner(&mut tried, at, passed, after);
            self.seen.clear();
            self.gaps.clear();
            self.touched.clear();
            self.crossed = self.crossed_at(&mut tried, passed);
            self.refused = true;
        }
        tried.end();
        let found = passed.is_some();
        self.passed = passed.map(|passed| (passed.next.point, ONWARD * passed.way));
        found
    }

    /// The touch at a corner behind which the level is crossed, for the step from where the walk goes on.
    fn crossed_at(&self, tried: &mut Tried<'_>, passed: &Passed) -> Option<Crossed> {
        let Passed {
            corner,
            next,
            extreme,
            ..
        } = passed;
        let point = &corner.touch.located.point;
        let behind = self.behind.as_ref()?;
        let is_followed = extreme.is_clear() && extreme.bend == Bend::Corner && !extreme.begins;
        is_followed.then(|| {
            let touch = Seen {
                point: point.clone(),
                ..behind.clone()
            };
            let along = ArcLength::over(
                &tried.newton,
                Step {
                    before: point,
                    next: &next.point,
                },
            );
            Crossed {
                jumps: true,
                ..Crossed::at(touch, along.at(&next.point.u))
            }
        })
    }

    /// The search for the corner that an extreme leads to, on a way of some length.
    pub(super) fn search<'s>(
        &self,
        tried: &'s mut Tried<'_>,
        from: &'s CurvePoint,
        extreme: Extreme,
        length: f64,
    ) -> CornerSearch<'s> {
        CornerSearch {
            problem: &mut *tried.problem,
            newton: &mut tried.newton,
            options: self.options.newton,
            range: [self.options.from, self.options.to],
            approach: Approach {
                from,
                extreme,
                farthest: FARTHEST * length,
            },
        }
    }
}

/// The extremes that come to levels where the branch may have a corner, the nearest first, with the length of the way to them.
fn ahead(problem: &mut dyn BranchProblem, at: &CurvePoint, step: f64) -> Vec<(f64, Extreme)> {
    let mut extremes = Vec::new();
    let mut ahead: Vec<(f64, Extreme)> = Vec::new();
    let mut form = vec![0.0; at.u.len()];
    problem.extremes(&at.u, &mut extremes);
    if step < SHORTEST {
        problem.add_beginnings(&at.u, &mut extremes);
    }
    for extreme in extremes {
        let bends = match extreme.bend {
            Bend::Corner => true,
            Bend::Steep => step < BENDS_WITHIN,
            Bend::Root | Bend::Smooth => false,
        };
        if !bends || extreme.above.abs() > NEAR {
            continue;
        }
        let range = at.scale.parameter;
        let known = problem.extreme_form(&at.u, &extreme, range, &mut form);
        let distance = -extreme.above / dot(&form, &at.tangent);
        if known && distance > 0.0 && distance < REACH * step {
            ahead.push((distance.max(step), extreme));
        }
    }
    ahead.sort_by(|a, b| a.0.total_cmp(&b.0));
    ahead
}
