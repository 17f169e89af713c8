//! Approaches an orbit that touches a level.
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

use super::zero::{Aim, root};
use crate::branches::extreme::{Bend, Extreme, Passage};
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Border, Converged, Newton, NewtonOptions};
use crate::numeric::linear::dot;

/// The extreme is brought so close to its level, in units of the gap, from its side of it.
const AIM: f64 = 1e-12;
/// It touches when it is so close, and is as close as can be told when it does not come this much closer any more, or at so many times
/// what was aimed at.
const TOUCHES: f64 = 1e-10;
const NEARER: f64 = 0.5;
const ROUNDED: f64 = 3.0;
/// Each orbit is so much closer than the one before, so that none of them crosses the level on the way.
const CLOSER: f64 = 0.03;
/// Newton's method goes on at the touch until its first update is no longer than this, or not so much shorter than the one before.
const EXACT: f64 = 1e-12;
/// Orbits on the way, at most.
const ORBITS: usize = 16;
/// Two touches are told from each other by so many times their errors.
const ERRORS: f64 = 10.0;
/// Where an extreme jumps by less than this part of what it rises by from either end of a step, it goes through its level there.
const SMALL: f64 = 1e-3;

/// An extreme at other unknowns.
pub(super) fn again(
    problem: &mut dyn BranchProblem,
    u: &[f64],
    extreme: &Extreme,
) -> Option<Extreme> {
    let mut extremes = Vec::new();
    let known = problem.extremes(u, &mut extremes);
    if extreme.begins {
        problem.add_beginnings(u, &mut extremes);
    }
    extreme.nearest(&extremes).filter(|_| known).copied()
}

/// Where an extreme goes through its level between both ends of a step, which it is followed along.
pub(super) fn on_the_way(
    problem: &mut dyn BranchProblem,
    newton: &mut Newton,
    step: Step<'_>,
    passage: Passage,
    options: NewtonOptions,
) -> Option<Reached> {
    // As near as rounding allows, or else as near as touches, or as orbits are known.
    let searches = [(ROUNDED * AIM, false), (TOUCHES, false), (TOUCHES, true)];
    searches.into_iter().find_map(|(aim, jumps)| {
        on_the_way_to(
            problem,
            newton,
            step,
            passage,
            Sought { aim, jumps },
            options,
        )
    })
}

/// How near an extreme is to come to its level, and whether it may jump across it by little.
#[derive(Debug, Clone, Copy)]
struct Sought {
    aim: f64,
    jumps: bool,
}

/// The same, where it comes that near to its level.
fn on_the_way_to(
    problem: &mut dyn BranchProblem,
    newton: &mut Newton,
    step: Step<'_>,
    Passage { before, next }: Passage,
    Sought { aim, jumps }: Sought,
    options: NewtonOptions,
) -> Option<Reached> {
    let [from, to] = step.parameters();
    let mut extremes = Vec::new();
    let mut extreme = before;
    let above = |problem: &mut (dyn BranchProblem + '_), at: &CurvePoint| {
        problem.extremes(&at.u, &mut extremes);
        extreme.nearest(&extremes).map_or(f64::NAN, |found| {
            // The next one is looked for where this one was.
            extreme = *found;
            found.above
        })
    };
    let aim = if problem.corners() {
        Aim::Below(aim)
    } else {
        Aim::Beside(aim)
    };
    let root = root(problem, newton, step, options, aim, above)?;
    let Located { test, jump, .. } = root.located;
    let rate = ((to - from) / (next.above - before.above)).abs();
    // Of orbits that are known less well extremes may jump as little, where equations with more nodes have no jump.
    let jumps_little = jumps
        && extreme.bend != Bend::Corner
        && jump > 0.0
        && jump <= SMALL * before.above.abs().min(next.above.abs());
    let left = if jumps_little { jump } else { test.abs() };
    (left <= TOUCHES || jumps_little).then_some(Reached {
        located: root.located,
        extreme,
        error: root.error + ROUNDED * left * rate,
        rate,
    })
}

/// Where the search for an orbit that touches a level begins, and how far it may lead.
#[derive(Clone, Copy)]
pub(super) struct Approach<'p> {
    pub(super) from: &'p CurvePoint,
    pub(super) extreme: Extreme,
    pub(super) farthest: f64,
}

/// An orbit that touches a level, on the side where it does not cross it. Along its tangent the extreme rises.
pub(super) struct Reached {
    pub(super) located: Located,
    pub(super) extreme: Extreme,
    /// What is left of the way, in the parameter.
    pub(super) error: f64,
    /// What the parameter changes by while the extreme rises by half of the gap's range.
    pub(super) rate: f64,
}

impl Reached {
    /// What is varied there.
    pub(super) fn value(&self) -> f64 {
        self.located.point.parameter()
    }

    /// Whether it is told from another one by both of their errors, and by no less than that.
    pub(super) fn is_apart(&self, other: &Self, least: f64) -> bool {
        let errors = ERRORS * (self.error + other.error);
        (self.value() - other.value()).abs() > errors.max(least)
    }
}

/// Unknowns at which an extreme touches, found by updates of which the first was so long.
struct Touching {
    u: Vec<f64>,
    extreme: Extreme,
    update: f64,
}

impl Approach<'_> {
    /// The orbit whose extreme reaches its level, by Newton's method with (1) as its border; `None` if that leads elsewhere.
    pub(super) fn close_in(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        options: NewtonOptions,
    ) -> Option<Reached> {
        let Self {
            from, mut extreme, ..
        } = *self;
        let scale = from.scale;
        let mut u = from.u.clone();
        let mut form = vec![0.0; u.len()];
        let mut before = f64::INFINITY;
        // What touches, and how long the first update was that led there.
        let mut touching: Option<Touching> = None;
        for _ in 0..ORBITS {
            let aim = extreme.above.signum() * (CLOSER * extreme.above.abs()).max(AIM);
            if !problem.extreme_form(&u, &extreme, scale.parameter, &mut form) {
                break;
            }
            let border = Border {
                row: &form,
                value: dot(&form, &u) + aim - extreme.above,
            };
            let corrected = newton.correct(problem.equations(), &mut u, border, scale, options);
            let Ok(Converged { first, .. }) = corrected else {
                break;
            };
            let Some(found) = again(problem, &u, &extreme) else {
                break;
            };
            extreme = found;
            let height = extreme.above.abs();
            // As near as rounding allows, if that is near enough.
            let nearer = height > ROUNDED * AIM && height < NEARER * before;
            before = height;
            if nearer || height > TOUCHES {
                continue;
            }
            // It was solved for as well as an orbit of the branch, and a touch is to be known better. Where the force jumps, an iterate beyond the
            // level has a matrix that is almost unbounded, and updates with it are short whatever is left: the first one, from this side, tells.
            let last = touching.as_ref().map_or(f64::INFINITY, |last| last.update);
            touching = Some(Touching {
                u: u.clone(),
                extreme,
                update: first,
            });
            if first <= EXACT || first >= NEARER * last {
                break;
            }
        }
        self.reached(problem, newton, touching?)
    }

    /// The orbit that was reached and that an update so long has led to, unless it is too far away.
    fn reached(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        Touching { u, extreme, update }: Touching,
    ) -> Option<Reached> {
        let (from, scale) = (self.from, self.from.scale);
        let pairs = u.iter().zip(&from.u);
        let moved: Vec<f64> = pairs.map(|(x, y)| x - y).collect();
        let mut tangent = vec![0.0; u.len()];
        if newton.norm().length(scale, &moved) > self.farthest
            || !newton.tangent(problem.equations(), &u, &mut tangent, true)
        {
            return None;
        }
        let rate = tangent[tangent.len() - 1].abs();
        // The first update that led there is what it was off by before, and hardly more than that is left.
        let left = newton.left_in_parameter().max(update * scale.parameter);
        let error = ROUNDED * extreme.above.abs() * rate + left;
        let length = newton.norm().length(scale, &tangent);
        for t in &mut tangent {
            *t /= length;
        }
        let located = Located {
            point: CurvePoint { u, tangent, scale },
            test: extreme.above,
            vanishes: true,
            jump: 0.0,
        };
        Some(Reached {
            located,
            extreme,
            error,
            rate,
        })
    }
}
