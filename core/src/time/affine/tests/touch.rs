//! Touches, and contacts that are hardly more.

use super::flow;
use crate::oscillator;
use crate::time::{Flow, FlowError};

oscillator! {
    /// A thrown mass below a stop that pushes back at first touch.
    pub(super) Thrown(x) {
        /// weight
        param weight;
        /// force of the stop at first touch
        param preload;
        /// stiffness of the stop
        param stiffness;

        /// gap > 0 is penetration
        law stop(gap) { gap > 0 => preload + stiffness*gap, else => 0 }

        ddot(x) + stop(x) = -weight;
    }
}

fn thrown(preload: f64) -> Thrown {
    Thrown {
        weight: 1.0,
        preload,
        stiffness: 1.0,
    }
}

/// `x = t - t^2/2 - 1/2` touches zero at the time one.
#[test]
fn a_touch_is_no_crossing() {
    let model = thrown(0.0);
    let mut flow = flow(&model, 1.0);
    let mut state = [-0.5, 1.0];
    flow.advance(0.0, 3.0, &mut state, None, None).unwrap();
    assert_eq!(flow.work().switches, 0);
    assert!((state[0] + 2.0).abs() < 1e-15 && (state[1] + 2.0).abs() < 1e-15);
}

/// A little faster and it enters, a little slower and it does not; either way the motion is hardly another.
#[test]
fn grazing_is_resolved() {
    for preload in [0.0, 0.5] {
        for excess in [1e-4, 1e-6, 1e-9, 1e-12] {
            for sign in [1.0, -1.0] {
                let model = thrown(preload);
                let mut flow = flow(&model, 1.0);
                let speed = 1.0 + sign * excess;
                let mut state = [-0.5, speed];
                flow.advance(0.0, 3.0, &mut state, None, None).unwrap();
                assert_eq!(
                    flow.work().switches,
                    if sign > 0.0 { 2 } else { 0 },
                    "{excess}"
                );
                // A stop that is left as fast as it was met: only the time in it differs from that of the free mass.
                let impact = (speed * speed - 1.0).max(0.0).sqrt();
                let weight = 1.0 + preload;
                let held = 2.0 * (impact / weight).atan();
                let late = held - 2.0 * impact;
                let t = 3.0 - late;
                let exact = [-0.5 + speed * t - 0.5 * t * t, speed - t];
                for (found, exact) in state.iter().zip(exact) {
                    assert!(
                        (found - exact).abs() < 1e-15 * (10.0 + 1.0 / impact.max(excess)),
                        "{preload} {excess} {found} {exact}"
                    );
                }
            }
        }
    }
}

/// Rest at a level that the force pushes towards from both sides has no motion to follow.
#[test]
fn chatter_is_reported() {
    let model = Thrown {
        weight: -1.0,
        preload: 2.0,
        stiffness: 1.0,
    };
    let mut flow = flow(&model, 1.0);
    let mut state = [0.0, 0.0];
    let result = flow.advance(0.0, 1.0, &mut state, None, None);
    assert!(
        matches!(result, Err(FlowError::TooManySwitches { .. })),
        "{result:?}"
    );
}

/// A motion that overflows ends with the last state that is a number.
#[test]
fn overflow_is_reported() {
    let model = Thrown {
        weight: 0.0,
        preload: 0.0,
        stiffness: -1.0,
    };
    let mut flow = flow(&model, 1.0);
    let mut state = [1.0, 1.0];
    let result = flow.advance(0.0, 1e4, &mut state, None, None);
    assert!(
        matches!(result, Err(FlowError::NotFinite { .. })),
        "{result:?}"
    );
    assert!(state.iter().all(|x| x.is_finite()));
}
