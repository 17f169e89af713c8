//! Against values known from elsewhere: event-located DOP853 in 80-bit arithmetic, and closed forms in 60 digits.
#![allow(
    clippy::unreadable_literal,
    reason = "numbers as they were published, to be searched for"
)]

use std::f64::consts::TAU;

use super::*;
use crate::by_hand::PowerForm;

/// A fold of Wang et al. (2021) returns to itself after a period, and has the multiplier one.
#[test]
fn folds_return_to_themselves() {
    for (alpha, load, omega, start) in [
        (
            1.5,
            0.0,
            1.332696002393464,
            [-0.1072263737497, 4.73653814692191],
        ),
        (
            1.5,
            1.0,
            1.158212487926707,
            [-0.52997004361605, 0.43708586658379],
        ),
        (
            0.6,
            0.0,
            0.704927892945083,
            [0.53161336679721, 5.24219765787477],
        ),
    ] {
        let model = PowerForm::new(false, alpha, 0.01, load, 0.1);
        let mut flow = Integrated::new(&model, &model.values, omega, 1e-12).unwrap();
        let mut state = start;
        let mut tangent = Tangent::of_state(1, None);
        flow.advance(0.0, TAU, &mut state, Some(&mut tangent), None)
            .unwrap();
        let error = (state[0] - start[0]).hypot(state[1] - start[1]);
        assert!(error < 1e-12, "{error:e}");
        let [a, b, c, d] = tangent.columns[..] else {
            unreachable!()
        };
        let characteristic = (a - 1.0) * (d - 1.0) - b * c;
        assert!(characteristic.abs() < 1e-10, "{characteristic:e}");
    }
}
