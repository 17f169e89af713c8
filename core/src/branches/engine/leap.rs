//! Steps that lead from one limb of a branch to another.
//!
//! Where a branch turns twice within a step, Newton's method may come to the limb behind both folds, and if that goes on almost where the
//! first one would have gone, neither values nor tangents at both ends tell. But the gaps that passed their levels on the way did so at
//! some orbits. If the parameter goes the same way at both ends and never turns, these orbits have values between those of both, and at
//! each of them a gap is on the side of its level that belongs to the order of the values. Otherwise the branch has turned, and the step
//! is made again, shorter.
//!
//! So it is where the branch is crossed at no place that can be found, or where a gap passes its level and the branch turns at none: test functions
//! are continuous along a limb, but where a touch is a corner of it. Behind one fold the walk would go back along the limb that it was to come to,
//! with the parameter as before: the bordered determinant alone changes its sign.
//!
//! Where one gap alone passes a level, the orbit is looked for if the distance from the level, a linear form of the orbit, says that it
//! is not within the step, or hardly.

use super::Engine;
use super::grazing_search::{Approach, Reached};
use super::seen::{Seen, changes};
use super::zero::is_crossing;
use crate::branches::extreme::{Bend, Extreme, Passage, crossings, is_copy, passed};
use crate::branches::problem::{BranchProblem, Change, Test};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::Newton;
use crate::event::EventKind;
use crate::numeric::linear::dot;

/// A touch that is to be expected farther away than this part of the step is located.
const FAR: f64 = 0.8;
/// An orbit farther from where it was sought than so many steps is another one.
const FARTHEST: f64 = 3.0;
/// A gap that is nearer to its level, in units of its range, is on either side.
const TOUCHES: f64 = 1e-8;
/// The step that is made instead, as a part of the one that led too far; and the shortest that is made again.
const AGAIN: f64 = 0.2;
const SHORTEST: f64 = 1e-4;

impl Engine {
    /// Whether the step to a point that is not kept yet has left out two turns, or leads to another limb. Then the walk is to go back.
    pub(super) fn leaps(&mut self, problem: &mut dyn BranchProblem, next: &CurvePoint) -> bool {
        if !problem.seeks_touches() {
            return false;
        }
        let last = self.seen.last().map(|seen| seen.point.clone());
        let Some(before) = last.filter(|last| last.u.len() == next.u.len()) else {
            return false;
        };
        let vanishing = problem.vanishing();
        let slopes = [&before, next].map(|at| at.known_slope(vanishing));
        let same_way = matches!(slopes, [Some(here), Some(there)] if here * there > 0.0);
        let gaps = [&before, next].map(|at| self.gaps_at(problem, at));
        let [Some(here), Some(there)] = gaps else {
            return false;
        };
        let step = Step {
            before: &before,
            next,
        };
        let mut newton = Newton::new(problem.equations());
        let length = newton.norm().length(before.scale, &step.difference());
        let through = without_copies(passed(&here.extremes, &there.extremes));
        // Touches where the force jumps are looked for by themselves, and test functions jump there.
        let is_apart =
            through.is_empty() && crossings(&here.extremes) == crossings(&there.extremes);
        if problem.force_jumps() && !is_apart {
            return false;
        }
        let is_long = length.min(self.shortest_asked(problem)) > SHORTEST;
        if is_long
            && !through.iter().any(is_corner)
            && self.jumps(problem, &mut newton, next, through.is_empty())
        {
            problem.count(&newton);
            self.ask_again(problem, before, AGAIN * length);
            return true;
        }
        let in_doubt = is_long
            && same_way
            && match &through[..] {
                [] => false,
                [one] => is_expected_far(problem, step, one, length),
                _ => true,
            };
        let leaps = in_doubt && {
            let touches = through.iter().filter_map(|passage| {
                let reached = self.reached(problem, &mut newton, step, passage, length)?;
                Some(Touched::of(problem, step, passage, &reached))
            });
            let touches: Vec<Touched> = touches.collect();
            touches.iter().any(Touched::is_outside)
                || touches
                    .iter()
                    .any(|touch| touches.iter().any(|other| touch.contradicts(other)))
        };
        problem.count(&newton);
        if leaps {
            self.ask_again(problem, before, AGAIN * length);
        }
        leaps
    }

    /// Whether the branch turns or is crossed between the last point and another one at no place that can be found: test functions jump from one
    /// limb to another. A turn is asked for where a gap passes its level, where the parameter goes the other way behind it, since the walk has
    /// gone round the fold; and where the bordered determinant changes its sign with it.
    pub(super) fn jumps(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        next: &CurvePoint,
        only_crossed: bool,
    ) -> bool {
        let Some(last) = self.seen.last().cloned() else {
            return false;
        };
        let next = Seen::at(problem, next, self.falls);
        let mut found = changes(problem, &last, &next);
        let turns = |change: &Change| change.test == Test::Slope;
        let folds = |change: &Change| turns(change) && change.kind == EventKind::Fold;
        if only_crossed && found.iter().any(folds) {
            return false;
        }
        found.retain(|change| turns(change) || is_crossing(problem, *change));
        found
            .into_iter()
            .any(|change| self.jumps_at(problem, newton, [&last, &next], change))
    }

    /// The orbit at which an extreme touches its level.
    fn reached(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        passage: &Passage,
        length: f64,
    ) -> Option<Reached> {
        let (from, extreme) = passage.clear_end(step);
        let approach = Approach {
            from,
            extreme,
            farthest: FARTHEST * length,
        };
        approach.close_in(problem, newton, self.options.newton)
    }
}

/// An orbit at which one of the gaps touches its level.
struct Touched<'p> {
    passage: &'p Passage,
    /// Where its value is, from zero at the beginning of the step to one at its end, and its error.
    part: f64,
    error: f64,
    extremes: Vec<Extreme>,
}

impl<'p> Touched<'p> {
    fn of(
        problem: &mut dyn BranchProblem,
        step: Step<'_>,
        passage: &'p Passage,
        reached: &Reached,
    ) -> Self {
        let [from, to] = step.parameters();
        let point = &reached.located.point;
        let mut extremes = Vec::new();
        problem.extremes(&point.u, &mut extremes);
        Self {
            passage,
            part: (point.parameter() - from) / (to - from),
            error: (reached.error / (to - from)).abs(),
            extremes,
        }
    }

    fn is_outside(&self) -> bool {
        self.part < -self.error || self.part > 1.0 + self.error
    }

    /// Whether the other gap is here where it is at the end of the step that lies beyond its own touch.
    fn contradicts(&self, other: &Self) -> bool {
        let Passage { before, next } = other.passage;
        let apart = self.part - other.part;
        if apart.abs() <= self.error + other.error {
            return false;
        }
        let elsewhere = if apart > 0.0 { before } else { next };
        let here = before.nearest(&self.extremes);
        here.or(next.nearest(&self.extremes))
            .is_some_and(|here| here.above * elsewhere.above > 0.0 && here.above.abs() > TOUCHES)
    }
}

/// Whether the branch may turn at the touch itself.
fn is_corner(passage: &Passage) -> bool {
    let ends = [&passage.before, &passage.next];
    ends.iter().any(|extreme| extreme.bend == Bend::Corner)
}

/// One passage of each that are copies of each other.
fn without_copies(found: Vec<Passage>) -> Vec<Passage> {
    let mut kept: Vec<Passage> = Vec::new();
    for passage in found {
        if !kept.iter().any(|other| is_copy(other, &passage)) {
            kept.push(passage);
        }
    }
    kept
}

/// Whether an extreme comes to its level outside of the step, or near its other end, as it moves where it is clear.
fn is_expected_far(
    problem: &mut dyn BranchProblem,
    step: Step<'_>,
    passage: &Passage,
    length: f64,
) -> bool {
    let (from, extreme) = passage.clear_end(step);
    let mut form = vec![0.0; from.u.len()];
    if !problem.extreme_form(&from.u, &extreme, from.scale.parameter, &mut form) {
        return false;
    }
    let distance = -extreme.above / dot(&form, &from.tangent);
    let ahead = if from.u == step.before.u {
        distance
    } else {
        -distance
    };
    !(0.0..FAR * length).contains(&ahead)
}
