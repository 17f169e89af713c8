//! The bolted joint, in SI units.

use super::{Equations, agree, extremes_and_rms, period};
use crate::bolted_joint::BoltedJoint;
use hertzian::{FrequencyResponse, Verdict};

#[test]
fn both_stable_motions_are() {
    let branch = FrequencyResponse::of(&BoltedJoint::default());
    let branch = branch.from(2000.0).to(3000.0).run().expect("a branch");
    let points = branch.at(2500.0).expect("orbits");
    let slope = |time: f64, state: &[f64], sides: &[bool]| {
        let joint = if sides[0] {
            1e9 * state[0].powf(1.5)
        } else {
            0.0
        };
        let drive = 1000.0 + 300.0 * (2500.0 * time).cos();
        vec![
            state[1],
            (drive - 100.0 * state[1] - 5e6 * state[0] - joint) / 2.0,
        ]
    };
    let levels = |state: &[f64]| vec![state[0]];
    let equations = Equations {
        slope: &slope,
        levels: &levels,
    };
    let stable = points
        .iter()
        .filter(|point| point.stability.verdict == Verdict::Stable);
    let mut opens = Vec::new();
    for point in stable {
        let period = period(&point.orbit);
        let settled = equations.after(&point.orbit.state(), period, 150);
        let [low, high, _] = extremes_and_rms(&equations.states(&settled, period, 2000), 0);
        let [opening, pressing] = [0, 1].map(|output| point.observed.outputs[output]);
        agree(opening.maximum, -1e6 * low, 1e-4);
        agree(pressing.maximum, 1e6 * high.powf(1.5), 1e-5);
        opens.push(low < 0.0);
    }
    assert_eq!(opens, [false, true]);
}
