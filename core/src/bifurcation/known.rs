//! Recognising what is known already.

use super::diagram::Limb;
use crate::shooting::{Cycle, CycleEvent, Shooting};

/// Values of one event, found on two branches, differ by no more than this part of the range, or by their stated errors.
const SAME: f64 = 1e-6;
/// Stated errors are heeded up to this part of the range.
const LARGEST: f64 = 1e-3;

/// Whether an event at the end of a branch is this event of a more regular one, in a range of some length.
pub(super) fn is_same_place(end: &CycleEvent, event: &CycleEvent, range: f64) -> bool {
    let (a, b) = (end.cycle.value, event.cycle.value);
    let error = (end.error + event.error).min(LARGEST * range);
    (a - b).abs() <= SAME * range + error && visits(&end.cycle, event.cycle.state())
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

/// Whether an orbit is on a branch: one of those near its value leads to it.
pub(super) fn contains(shooting: &Shooting, limb: &Limb, orbit: &Cycle) -> bool {
    if limb.period() != orbit.period {
        return false;
    }
    let passes = |pair: &&[Cycle]| {
        let [a, b] = [pair[0].value, pair[1].value];
        (a - orbit.value) * (b - orbit.value) <= 0.0
    };
    limb.branch.cycles.windows(2).filter(passes).any(|pair| {
        let nearer = |cycle: &Cycle| (cycle.value - orbit.value).abs();
        let start = if nearer(&pair[0]) < nearer(&pair[1]) {
            &pair[0]
        } else {
            &pair[1]
        };
        let request = shooting.clone().period(orbit.period).near(start.state());
        let found = request.orbit(orbit.value);
        found.is_ok_and(|found| visits(&found, orbit.state()) || is_later(shooting, &found, orbit))
    })
}

/// Whether a symmetric orbit of several periods begins in another one of them: its segments are parts of half of it, which need not
/// be whole periods.
fn is_later(shooting: &Shooting, found: &Cycle, orbit: &Cycle) -> bool {
    let several = orbit.symmetric && orbit.period > 1;
    several
        && shooting
            .returns(orbit)
            .is_ok_and(|states| states.iter().any(|state| visits(found, state)))
}
