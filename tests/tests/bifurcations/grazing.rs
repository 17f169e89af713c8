//! Where a gap touches a level.

use hertzian::flow::shooting::CycleEvent;
use hertzian::{EventKind, Shooting};

use crate::cascade::MODEL;

fn grazings(events: &[CycleEvent]) -> Vec<&CycleEvent> {
    let grazing = |event: &&CycleEvent| matches!(event.kind, EventKind::Grazing { .. });
    events.iter().filter(grazing).collect()
}

/// As long as contact lasts, the motion is that of a linear oscillator at resonance, of amplitude `A / (2 zeta)`: it touches zero
/// at `A = 2 zeta W`.
#[test]
fn contact_is_lost_where_the_linear_motion_reaches_zero() {
    let shooting = Shooting::of(&MODEL).vary("drive").omega(1.0);
    let branch = shooting.from(0.02).to(0.2).run().unwrap();
    let [grazing] = grazings(&branch.events)[..] else {
        panic!("{:?}", branch.events);
    };
    let error = (grazing.cycle.value - 2.0 * 0.032).abs();
    assert!(
        error < 1e-10 && error <= grazing.error,
        "{grazing} {error:.1e}"
    );
    assert_eq!(grazing.kind, EventKind::Grazing { turns: false });
    assert!(grazing.cycle.extremes[0].minimum.abs() < 1e-9);
    // Before it nothing switches, behind it twice a period.
    let (before, behind) = branch.cycles.split_at(grazing.after);
    assert!(before.iter().all(|cycle| cycle.switches == 0));
    assert!(behind.iter().all(|cycle| cycle.switches == 2));
}
