//! What mathematics says is kept, or lost at a known rate.

use std::f64::consts::TAU;

use super::{OneSided, flow, one_sided};
use crate::time::{Flow, Stretch, Tangent};

/// Without damping and excitation the energy stays, over a hundred thousand periods and about as many contacts.
#[test]
fn energy_does_not_drift() {
    let model = OneSided {
        zeta: 0.0,
        load: 1.0,
        drive: 0.0,
    };
    let energy = |[x, v]: [f64; 2]| 0.5 * v * v + 0.5 * x.max(0.0).powi(2) - x;
    let mut flow = flow(&model, 1.0);
    let mut state = [-2.0, 0.3];
    let before = energy(state);
    let mut largest = 0.0_f64;
    for _ in 0..100 {
        flow.advance(0.0, 1000.0 * TAU, &mut state, None, None)
            .unwrap();
        largest = largest.max((energy(state) / before - 1.0).abs());
    }
    let work = flow.work();
    assert!(work.switches > 100_000);
    let rounding = work.steps as f64 * f64::EPSILON;
    assert!(largest < rounding, "{largest:e} {rounding:e}");
}

/// The map contracts areas by the exponential of the integrated divergence: `-2 zeta` times the time in contact.
#[test]
fn areas_shrink_by_the_time_in_contact() {
    for drive in [0.5, 1.0, 1.78] {
        let model = one_sided(drive);
        let mut flow = flow(&model, 1.0);
        let mut contact = 0.0;
        let mut see = |stretch: &dyn Stretch| {
            let (from, to) = stretch.phases();
            let mut state = [0.0; 2];
            stretch.state(0.5 * (from + to), &mut state);
            if state[0] > 0.0 {
                contact += to - from;
            }
        };
        let mut tangent = Tangent::of_state(1, None);
        let mut state = [-0.33, 0.33];
        flow.advance(
            0.0,
            4.0 * TAU,
            &mut state,
            Some(&mut tangent),
            Some(&mut see),
        )
        .unwrap();
        let [a, b, c, d] = tangent.columns[..] else {
            unreachable!()
        };
        let area = a * d - b * c;
        let expected = (-2.0 * model.zeta * contact).exp();
        assert!((area / expected - 1.0).abs() < 1e-12, "{area} {expected}");
    }
}
