//! The shaft whose balls go round: what the bearing carries.

use super::agree;
use crate::passing_balls::{MASSES, shaft};
use hertzian::{ContactEquation, FrequencyResponse};
use hertzian_structure::Reduction;

/// In the mean over a period nothing is accelerated: a spring carries the weight of what is before it less the mean force of the bearing, and the end
/// sags by the sum of what springs are stretched by.
#[test]
fn the_bearing_carries_what_the_sag_says() {
    let structure = shaft().unwrap();
    let whole = Reduction::to(2.0).modes(2 * MASSES).steps(0);
    let whole = whole.run(&structure).unwrap();
    let model = whole.structure(&structure).unwrap();
    let request = FrequencyResponse::of(&model).by(ContactEquation::new());
    let request = request.accuracy_of("down").stability(false);
    let branch = request.from(0.5).to(0.5001).max_points(2).run().unwrap();
    let point = &branch.points[0];
    let mean = |name: &str| {
        let reading = branch.reading(name, point).unwrap();
        reading.motion.mean.unwrap()
    };
    // Springs and masses are n of each, of the stiffness n and the mass 1/n.
    let n = MASSES as f64;
    let sag = mean("down");
    let of_weight: f64 = (1..=MASSES).map(|i| i as f64 / n / n).sum();
    let carried = of_weight - sag;
    let turns = (0..8).map(|ball| {
        let angle = std::f64::consts::TAU / 8.0 * f64::from(ball);
        let force = branch.reading(&format!("ball{ball}"), point).unwrap();
        // The mean of force times cos(angle + 2/5 omega t), whose harmonic is the second one of a fifth of the speed.
        let (c, s) = (force.series[3], force.series[4]);
        0.5 * (c * angle.cos() - s * angle.sin())
    });
    agree(turns.sum::<f64>(), carried, 1e-7);
    assert!(mean("across").abs() < 0.1 * sag, "{}", mean("across"));
}
