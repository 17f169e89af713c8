//! Beads that part in every period, whose contacts stand here one by one.

use super::{Equations, agree, extremes_and_rms, period};
use crate::chain_of_beads::Beads;
use hertzian::{FrequencyResponse, Verdict};

const DRIVE: f64 = 0.1;

/// How far each contact is pressed, from that of the actuator to that of the wall.
fn pressed(actuator: f64, x: &[f64]) -> [f64; 5] {
    let places = [actuator, x[0], x[1], x[2], x[3], 0.0];
    std::array::from_fn(|contact| 1.0 + places[contact] - places[contact + 1])
}

#[test]
fn stable_motions_are() {
    let model = Beads {
        drive: DRIVE,
        ..Beads::default()
    };
    let branch = FrequencyResponse::of(&model).from(1.7).to(1.5).run();
    let branch = branch.expect("a branch");
    let points = branch.at(1.57).expect("orbits");
    assert_eq!(points.len(), 3);
    // Forces are continuous where contacts open, so that steps go over it.
    let slope = |time: f64, state: &[f64], _: &[bool]| {
        let pressed = pressed(DRIVE * (1.57 * time).cos(), state);
        let force = pressed.map(|gap| 2.0 / 3.0 * gap.max(0.0).powf(1.5));
        let rates = state[4..].iter().copied();
        let accelerations =
            (0..4).map(|bead| force[bead] - force[bead + 1] - 0.03 * state[4 + bead]);
        rates.chain(accelerations).collect()
    };
    let equations = Equations {
        slope: &slope,
        levels: &|_| Vec::new(),
    };
    let stable = |point: &&hertzian::Point| point.stability.verdict == Verdict::Stable;
    let mut opens = Vec::new();
    for point in points.iter().filter(stable) {
        let period = period(&point.orbit);
        let settled = equations.after(&point.orbit.state(), period, 100);
        let states = equations.states(&settled, period, 2000);
        let [low, high, _] = extremes_and_rms(&states, 3);
        agree(point.observed.outputs[0].peak_to_peak(), high - low, 1e-5);
        opens.push(
            point
                .observed
                .contacts
                .iter()
                .any(|contact| contact.fraction < 1.0),
        );
    }
    opens.sort_unstable();
    assert_eq!(opens, [false, true]);
}
