//! What is said where multipliers cross the unit circle and no event was located.

use super::Engine;
use crate::branches::moduli;
use crate::branches::point::{Event, Point};
use crate::branches::problem::BranchProblem;
use crate::branches::record::Kept;
use crate::branches::stability::Verdict;
use crate::event::{EventKind, Turn};

impl Engine {
    /// Multipliers that cross the unit circle in the last step, at no place that was found, do so where the one level is touched in it
    /// at which they jump, or nearly.
    pub(super) fn place_turns(&mut self, problem: &mut dyn BranchProblem) {
        for unlocated in self.unlocated.drain(..) {
            let touch = corner_touch(problem, unlocated.after);
            let record = problem.record_mut();
            let of_multipliers = matches!(
                unlocated.kind,
                EventKind::PeriodDoubling | EventKind::SymmetryBreaking | EventKind::NeimarkSacker
            );
            let place = record.turns.iter().position(|turn| *turn == unlocated);
            if let (Some(place), Some((_, value)), true) = (place, touch, of_multipliers) {
                record.turns[place].value = value;
            }
        }
    }

    /// Says where a verdict changes that nothing recorded explains, if all events are looked for.
    pub(super) fn explain_verdict(&mut self, problem: &mut dyn BranchProblem) {
        let mut watched = problem.watched().iter();
        if !watched.any(|watched| watched.kind == EventKind::NeimarkSacker) {
            return;
        }
        let jumps = problem.force_jumps();
        let Kept {
            points,
            events,
            turns,
        } = problem.kept();
        let decided = |point: &&Point| point.stability.verdict != Verdict::Undecided;
        let Some(last) = points.last().filter(decided) else {
            return;
        };
        // At first whatever is before it.
        let first = || {
            points[..points.len() - 1]
                .iter()
                .rposition(|point| decided(&point))
        };
        let before = self.decided.replace(points.len());
        let Some(before) = before.or_else(|| first().map(|place| place + 1)) else {
            return;
        };
        if before >= points.len() {
            return;
        }
        let other = &points[before - 1];
        // Multipliers jump at a touch where the force does, and nowhere else.
        let explains = |kind: EventKind, after: usize| {
            let touches = matches!(kind, EventKind::Grazing { .. });
            after >= before && (jumps || !touches)
        };
        if other.stability.verdict == last.stability.verdict
            || events.iter().any(|event| explains(event.kind, event.after))
            || turns.iter().any(|turn| explains(turn.kind, turn.after))
        {
            return;
        }
        let multipliers = [other, last].map(|point| &point.stability.multipliers);
        let [a, b] = multipliers.map(|multipliers| moduli::nearest(multipliers));
        let kind = if a.1 < b.1 {
            moduli::crossing(multipliers[0], a.0)
        } else {
            moduli::crossing(multipliers[1], b.0)
        };
        let (place, middle) = (points.len() - 1, 0.5 * (other.value + last.value));
        // At a touch where the stiffness is unbounded multipliers change faster than can be resolved.
        let (after, value) = corner_touch(problem, before).unwrap_or((place, middle));
        let turn = Turn {
            kind,
            value,
            test: f64::NAN,
            after,
        };
        problem.record_mut().turns.push(turn);
    }
}

/// Where the one level is touched behind so many points, if a branch may have a corner where one is: the number of points before it, and the
/// value.
fn corner_touch(problem: &dyn BranchProblem, from: usize) -> Option<(usize, f64)> {
    let touches = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    let events = problem.record().events.iter().filter(touches);
    let mut found = events.filter(|event| event.after >= from);
    match (problem.corners(), found.next(), found.next()) {
        (true, Some(touch), None) => Some((touch.after, touch.point.value)),
        _ => None,
    }
}
