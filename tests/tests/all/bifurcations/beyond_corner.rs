//! Events between a touch at which the force jumps and the next point of the branch.
//!
//! The values are of motions in closed form from switch to switch, the exponential of the matrix of each piece, with the derivative of the map over a
//! period and its jumps at switches: `det(M + I) = 0` by the secant method in the frequency, about an orbit of Newton's method on the state.

use hertzian::{ContactEquation, EventKind, FrequencyResponse, Shooting, Stop, System};

use crate::bifurcations::preloads::{Masses, Preloads, assert_places};

/// Both ways, by both methods: the doublings within a window are those that are known, and the branch goes on to the end.
fn assert_doublings(system: &dyn System, range: [f64; 2], window: [f64; 2], expected: &[f64]) {
    let [low, high] = range;
    for [from, to] in [[low, high], [high, low]] {
        let request = FrequencyResponse::of(system).from(from).to(to);
        let moved = request.clone().by(Shooting::new()).run().unwrap();
        let solved = request.by(ContactEquation::new()).run().unwrap();
        for branch in [moved, solved] {
            assert_eq!(branch.stopped, Stop::ReachedEnd);
            assert_eq!(branch.turns, []);
            assert_places(&branch, EventKind::PeriodDoubling, window, expected, 2e-12);
        }
    }
}

/// The touch is at 0.83012: two doublings on its side where the stop is reached, within one step.
#[test]
fn two_doublings_beside_a_touch_are_found() {
    let exact = [
        0.842_243_884_976_7,
        0.856_384_604_605_3,
        0.907_323_132_899_3,
    ];
    let system = &Preloads {
        drive: 0.6031,
        p: 0.164,
    };
    assert_doublings(system, [0.4, 2.2], [0.82, 1.0], &exact);
}

/// The other stop is touched at 0.98197. From the left, a step across it fails to find the touch at first.
#[test]
fn a_touch_that_is_far_within_a_step_hides_no_doubling() {
    let system = &Preloads {
        drive: 0.2302,
        p: 0.1604,
    };
    assert_doublings(system, [0.4, 2.2], [0.95, 1.0], &[0.983_741_590_762_3]);
}

/// The touch is at 0.95897.
#[test]
fn two_doublings_of_two_masses_beside_a_touch_are_found() {
    let exact = [
        0.960_284_358_230_0,
        0.963_018_199_642_2,
        1.004_652_409_337_2,
    ];
    let system = &Masses {
        drive: 0.1861,
        preload: 0.0646,
    };
    assert_doublings(system, [0.5, 2.2], [0.95, 1.05], &exact);
}

/// With a preload of 0.05 the branch bends by more than a right angle within a hundredth of its range behind the touch at 0.85769: a step of the usual
/// length from there leads back to the side that is clear. And two folds at 1.21906 are within 1e-6 of each other beside the touch
/// at 1.21857.
#[test]
fn a_branch_that_bends_behind_a_touch_is_not_followed_back() {
    let system = Preloads {
        drive: 0.5,
        p: 0.05,
    };
    let mut all: Vec<Vec<f64>> = Vec::new();
    for [from, to] in [[0.4, 2.2], [2.2, 0.4]] {
        let request = FrequencyResponse::of(&system).from(from).to(to);
        let moved = request.clone().by(Shooting::new()).run().unwrap();
        let solved = request.by(ContactEquation::new()).run().unwrap();
        for branch in [moved, solved] {
            assert_eq!(branch.stopped, Stop::ReachedEnd);
            assert_eq!(branch.turns, []);
            let mut values: Vec<f64> = branch
                .events
                .iter()
                .map(|event| event.point.value)
                .collect();
            values.sort_by(f64::total_cmp);
            all.push(values);
        }
    }
    for values in &all {
        assert_eq!(values.len(), 9, "{values:?}");
        for (a, b) in values.iter().zip(&all[0]) {
            assert!((a - b).abs() < 1e-10, "{a} {b}");
        }
    }
}

/// A Hertzian contact is reached just before the stop with a preload, within one step: where the linear response `0.3 / |1 - w^2 + 0.1 i w|` is as large as
/// its gap. Behind it the motion is not linear: the touch of the stop is known by two methods.
#[test]
fn another_contact_that_is_touched_beside_a_corner_is_located() {
    hertzian::oscillator! {
        Both(x) {
            law stop(gap) { gap >= 0 => 0.05 + 4*gap, else => 0 }
            law hertz(gap) { gap > 0 => 5*gap^1.5, else => 0 }
            ddot(x) + 0.1*dot(x) + x + stop(x - 1) + hertz(-x - 0.998) = 0.3*cos(omega*t);
        }
    }
    let middle: f64 = 1.0 - 0.5 * 0.1 * 0.1;
    let root = (middle * middle - 1.0 + (0.3_f64 / 0.998).powi(2)).sqrt();
    for ([from, to], square) in [([0.4, 1.0], middle - root), ([2.2, 0.9], middle + root)] {
        let request = FrequencyResponse::of(&Both {}).from(from).to(to);
        let moved = request.clone().by(Shooting::new()).run().unwrap();
        let solved = request.by(ContactEquation::new()).run().unwrap();
        let [moved, solved] = [moved, solved].map(|branch| {
            let touches = branch.events.iter();
            let touches = touches.filter(|event| matches!(event.kind, EventKind::Grazing { .. }));
            let values: Vec<f64> = touches.map(|event| event.point.value).collect();
            assert_eq!(values.len(), 2, "{values:?}");
            let error = (values[0] - square.sqrt()).abs();
            assert!(error < 1e-11, "{values:?}: {error:.1e}");
            values
        });
        assert!((moved[1] - solved[1]).abs() < 1e-11, "{moved:?} {solved:?}");
    }
}
