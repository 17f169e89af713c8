//! Recognising what is known already.

use crate::flow::shooting::{Cycle, CycleEvent};

/// Values and states of one event, found on two branches, differ by no more than this part, or by their stated errors.
const SAME: f64 = 1e-6;

/// Whether an event at the end of a branch is this event of a more regular one.
pub(super) fn is_same_place(end: &CycleEvent, event: &CycleEvent) -> bool {
    let (a, b) = (end.cycle.value, event.cycle.value);
    let error = (end.error + event.error).min(SAME * b.abs().max(SAME));
    (a - b).abs() <= SAME * b.abs() + error && visits(&end.cycle, event.cycle.state())
}

/// Whether an orbit passes through a state at the beginning of one of its segments.
pub(super) fn visits(cycle: &Cycle, state: &[f64]) -> bool {
    let size = cycle
        .extremes
        .iter()
        .fold(0.0, |size: f64, extremes| size.max(extremes.peak_to_peak()));
    let n = state.len() / 2;
    cycle.states().any(|other| {
        let mut pairs = other.iter().zip(state).enumerate();
        pairs.all(|(i, (x, y))| {
            let unit = if i < n { 1.0 } else { cycle.omega };
            // At a branch point states are known to the root of what the value is known to.
            (x - y).abs() <= SAME.sqrt() * size * unit
        })
    })
}
