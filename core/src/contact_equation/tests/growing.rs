//! Extremes of gaps in motions that grow beyond all bounds, as those of equations that are not solved may: they are found, or not, by a search that ends.

use super::first;
use crate::contact_equation::orbit::motion::Motion;

crate::oscillator! {
    /// A slow mode, and one that is a thousand times as fast and may ring up.
    Ringing(x, y) {
        param damping;
        law stop(g) { g > 0 => 2000*g, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x + 0.4*y - 0.5) = 0.3*cos(omega*t);
        ddot(y) + damping*dot(y) + 1_000_000*y + 0.4*stop(x + 0.4*y - 0.5) = 0;
    }
}

const OMEGA: f64 = 1.1;

/// Phases of the extremes of the gap at this damping, in the motion that begins as one at a damping of 0.2 does.
fn extremes(damping: f64) -> Vec<f64> {
    let system = Ringing { damping: 0.2 };
    let (mut equations, mut u) = first(&system, Some("damping"), OMEGA, [16, 1]);
    let last = u.len() - 1;
    assert_eq!(u[last], 0.2);
    u[last] = damping;
    equations.compute(&u, false);
    let found = &Motion::of(&equations).gap_extremes()[0];
    found.iter().map(|extreme| extreme.phase).collect()
}

/// Values and rates leave the range of numbers, and their bounds before them.
#[test]
fn a_motion_beyond_all_bounds_is_searched_to_an_end() {
    for damping in [-250.0, -400.0, -1000.0] {
        let phases = extremes(damping);
        assert!(phases.iter().all(|phase| phase.is_finite()));
    }
}
