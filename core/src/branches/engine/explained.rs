//! What is said where multipliers cross the unit circle and no event was located.

use super::Engine;
use super::grazing::{Bent, Gaps};
use crate::branches::extreme::{Bend, crossings, passed};
use crate::branches::moduli;
use crate::branches::point::Point;
use crate::branches::problem::BranchProblem;
use crate::branches::record::Kept;
use crate::branches::stability::Verdict;
use crate::continuation::follow::CurvePoint;
use crate::event::{EventKind, Turn};

/// A point that has no place in the unknowns of the next one, with the extremes of its gaps where touches are looked for.
#[derive(Debug)]
pub(super) struct Displaced {
    pub(super) point: CurvePoint,
    pub(super) gaps: Option<Gaps>,
}

impl Engine {
    /// Multipliers that cross the unit circle in the last step, at no place that was found, do so where a level is touched in it at which they
    /// jump, or nearly, if that is one place.
    pub(super) fn place_turns(&mut self, problem: &mut dyn BranchProblem) {
        for unlocated in self.unlocated.drain(..) {
            let touch = one_bent(&self.bent, unlocated.after);
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

    /// Says what happened in a step that could not be looked at, as far as its ends tell: that a level was touched, or that the branch turned.
    pub(super) fn say_unseen(&mut self, problem: &mut dyn BranchProblem, at: &CurvePoint) {
        let Some(Displaced { point, gaps }) = self.displaced.take() else {
            return;
        };
        let touched = gaps.is_some_and(|before| {
            let next = self.gaps_at(problem, at);
            next.is_some_and(|next| {
                let ends = [&before.extremes, &next.extremes].map(|extremes| &extremes[..]);
                let [here, there] = ends.map(crossings);
                here != there || !passed(ends[0], ends[1]).is_empty()
            })
        });
        let vanishing = problem.vanishing();
        let slopes = [&point, at].map(|at| at.known_slope(vanishing));
        let turned = matches!(slopes, [Some(here), Some(there)] if here * there < 0.0);
        let kind = match (touched, turned) {
            (true, turns) => EventKind::Grazing { turns },
            (false, true) => EventKind::Fold,
            (false, false) => return,
        };
        let turn = Turn {
            kind,
            value: 0.5 * (point.parameter() + at.parameter()),
            test: f64::NAN,
            after: problem.points() - 1,
        };
        problem.record_mut().turns.push(turn);
    }

    /// Says where a verdict changes that nothing recorded explains, if all events are looked for.
    pub(super) fn explain_verdict(&mut self, problem: &mut dyn BranchProblem) {
        let mut watched = problem.watched().iter();
        if !watched.any(|watched| watched.kind == EventKind::NeimarkSacker) {
            return;
        }
        let corners = problem.corners();
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
        // Multipliers jump at a touch that is a corner, and nowhere else. Which level is touched at a place that is none is not known.
        let explains = |kind: EventKind, after: usize, jumps: bool| {
            let touches = matches!(kind, EventKind::Grazing { .. });
            after >= before && (jumps || !touches)
        };
        let corner = |bent: &Bent| bent.after >= before && bent.bend == Bend::Corner;
        if other.stability.verdict == last.stability.verdict
            || self.bent.iter().any(corner)
            || events
                .iter()
                .any(|event| explains(event.kind, event.after, false))
            || turns
                .iter()
                .any(|turn| explains(turn.kind, turn.after, corners))
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
        let (after, value) = one_bent(&self.bent, before).unwrap_or((place, middle));
        let turn = Turn {
            kind,
            value,
            test: f64::NAN,
            after,
        };
        problem.record_mut().turns.push(turn);
    }
}

/// The one touch behind so many points at which multipliers jump, or nearly: the number of points before it, and the value.
fn one_bent(bent: &[Bent], from: usize) -> Option<(usize, f64)> {
    let mut found = bent.iter().filter(|bent| bent.after >= from);
    match (found.next(), found.next()) {
        (Some(bent), None) => Some((bent.after, bent.value)),
        _ => None,
    }
}
