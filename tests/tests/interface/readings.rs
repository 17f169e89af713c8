//! What is read off an orbit, against the same orbit by another method to more digits.

use hertzian::{ContactEquation, FrequencyResponse, Shooting};

hertzian::oscillator! {
    /// Two modes, the second one ten times as fast, which a contact couples, and which are hardly damped.
    TwoModes(x, y) {
        law contact(gap) { gap > 0 => 9*gap^1.3275, else => 0 }
        ddot(x) + 0.0206*dot(x) + x - contact(-x - y - 0.2526) = 0.06*cos(omega*t);
        ddot(y) + 0.203*dot(y) + 97*y - contact(-x - y - 0.2526) = 0.06*cos(omega*t);
        output tip = x + y;
    }
}

/// The state of an orbit errs as the orbit does, and a motion from it by many times that before it is over. What is read has the error that
/// is stated nevertheless.
#[test]
fn what_is_read_is_as_near_as_is_stated() {
    let request = FrequencyResponse::of(&TwoModes {}).from(1.6).to(1.0);
    let equation = request.clone().by(ContactEquation::new());
    let branch = equation.accuracy_of("tip").run().expect("a branch");
    let exact = request.by(Shooting::new()).tolerance(1e-9);
    let mut worst = 0.0_f64;
    for point in branch.points.iter().step_by(7) {
        let near = exact.clone().near_orbit(&point.orbit);
        let Ok(same) = near.orbit(point.value) else {
            continue;
        };
        let tip = |reading: hertzian::observe::Reading| reading.motion.peak_to_peak();
        let known = tip(near.reading("tip", &same).expect("a reading"));
        let found = tip(branch.reading("tip", point).expect("a reading"));
        let stated = point.error.expect("an error") * known;
        worst = worst.max((found - known).abs() / (stated + 1e-9 * known));
    }
    assert!(worst < 1.0, "{worst}");
}
