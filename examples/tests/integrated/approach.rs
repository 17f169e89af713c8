//! The tip above a surface, in units of its free resonance and of nanometres.

use super::{Equations, extremes_and_rms};
use crate::approach::Approached;
use hertzian::FrequencyResponse;

#[test]
fn motions_at_a_distance_come_back_from_either_side() {
    let model = Approached::default();
    let request = FrequencyResponse::of(&model).vary("distance").omega(1e6);
    let slope = |time: f64, state: &[f64], sides: &[bool]| {
        let gap = state[0] - 5.0;
        let surface = if sides[0] {
            0.1 * gap.powf(1.5) - 0.004 / 0.165_f64.powi(2)
        } else {
            -0.004 / (0.165 - gap).powi(2)
        };
        let drive = 10.0 / 400.0 * time.cos();
        vec![state[1], drive - state[1] / 400.0 - state[0] - surface]
    };
    let levels = |state: &[f64]| vec![state[0] - 5.0];
    let equations = Equations {
        slope: &slope,
        levels: &levels,
    };
    let mut sizes = Vec::new();
    for (from, to) in [(14.0, -2.0), (-2.0, 14.0)] {
        let branch = request.clone().from(from).to(to).run().expect("a branch");
        for point in branch.at(5.0).expect("orbits") {
            let state = point.orbit.state();
            let start = [state[0], state[1] / 1e6];
            let states = equations.states(&start, std::f64::consts::TAU, 10_000);
            let [low, high, _] = extremes_and_rms(&states, 0);
            let end = states.last().expect("an end");
            for (end, start) in end.iter().zip(start) {
                assert!((end - start).abs() < 1e-4, "{end}, {start}");
            }
            assert!((point.peak_to_peak() - (high - low)).abs() < 1e-4 * (high - low));
            sizes.push(high - low);
        }
    }
    // Three orbits, met in another order from the other side.
    let mut both = [0, 3].map(|first| sizes[first..first + 3].to_vec());
    for sizes in &mut both {
        sizes.sort_by(f64::total_cmp);
    }
    assert!(
        both[0]
            .iter()
            .zip(&both[1])
            .all(|(a, b)| (a - b).abs() < 1e-4)
    );
    assert_eq!(sizes.len(), 6);
}
