//! A branch that comes to a fold which it has passed before.
//!
//! That a curve closes is told by its first point. Where a step leads from one branch onto another one that is closed, as where both come near each
//! other beside a touch, the first point is not on it, and the walk would go around for ever. But a curve passes each of its folds once: where one
//! is passed again, the same way and with the same motion, the same orbits follow.

use super::Engine;
use crate::branches::point::Event;
use crate::branches::problem::BranchProblem;
use crate::branches::record::Record;
use crate::event::EventKind;

/// Values at one fold differ by so many times the errors that are stated of both, or by this part, at most.
const SAME: f64 = 3.0;
const ROUNDING: f64 = 1e-12;
/// Extremes of motions at one fold differ by this part of peak-to-peak at most: the motion there is known to the root of what the value is.
const ALIKE: f64 = 1e-6;

impl Engine {
    /// Whether a fold behind so many events is one of these. Then it is no event once more, and neither is what was found behind it; the branch
    /// ends with the last point before it.
    pub(super) fn comes_round(problem: &mut dyn BranchProblem, known: usize) -> bool {
        let record = problem.record();
        let later = known.min(record.events.len());
        let (before, found) = record.events.split_at(later);
        let again = found.iter().position(|event| {
            event.kind == EventKind::Fold
                && before.iter().any(|other| is_same(record, event, other))
        });
        let Some(again) = again.map(|again| later + again) else {
            return false;
        };
        let record = problem.record_mut();
        let points = record.events[again].after;
        record.events.truncate(again);
        record.points.truncate(points);
        record.turns.retain(|turn| turn.after < points);
        true
    }
}

/// Whether two folds are one, passed the same way.
fn is_same(record: &Record, a: &Event, b: &Event) -> bool {
    let rises = |event: &Event| {
        Some(record.points.get(event.after.checked_sub(1)?)?.value < event.point.value)
    };
    let [here, there] = [&a.point, &b.point];
    let errors = SAME * (a.error + b.error) + ROUNDING * here.value.abs();
    let motions = [here, there].map(|point| &point.observed.motions);
    a.kind == b.kind
        && rises(a) == rises(b)
        && errors.is_finite()
        && (here.value - there.value).abs() <= errors
        && here.orbit.period == there.orbit.period
        && !motions[0].is_empty()
        && motions[0].iter().zip(motions[1]).all(|(a, b)| {
            let apart = (a.maximum - b.maximum)
                .abs()
                .max((a.minimum - b.minimum).abs());
            apart <= ALIKE * here.size()
        })
}
