//! What is read off an orbit, against the same orbit by another method to more digits.

use hertzian::{ContactEquation, FrequencyResponse, Shooting, System};

hertzian::oscillator! {
    /// Two modes, the second one ten times as fast, which a contact couples, and which are hardly damped.
    TwoModes(x, y) {
        law contact(gap) { gap > 0 => 9*gap^1.3275, else => 0 }
        ddot(x) + 0.0206*dot(x) + x - contact(-x - y - 0.2526) = 0.06*cos(omega*t);
        ddot(y) + 0.203*dot(y) + 97*y - contact(-x - y - 0.2526) = 0.06*cos(omega*t);
        output tip = x + y;
    }
}

hertzian::oscillator! {
    /// The same with the small coordinate first, and their difference.
    FastFirst(y, x) {
        law contact(gap) { gap > 0 => 9*gap^1.3275, else => 0 }
        ddot(y) + 0.203*dot(y) + 97*y - contact(-x - y - 0.2526) = 0.06*cos(omega*t);
        ddot(x) + 0.0206*dot(x) + x - contact(-x - y - 0.2526) = 0.06*cos(omega*t);
        output tip = y - 0.01*x;
    }
}

/// How far peak-to-peak of a signal, and its root of the mean square where an orbit is completed, are from those of the same orbit to more
/// digits, in what is stated; and of how many orbits.
fn off(system: &dyn System, signal: &str, asked: Option<&str>) -> (f64, usize) {
    let request = FrequencyResponse::of(system).from(1.6).to(1.0);
    let exact = request.clone().by(Shooting::new()).tolerance(1e-9);
    let mut equation = request.by(ContactEquation::new());
    if let Some(asked) = asked {
        equation = equation.accuracy_of(asked);
    }
    let branch = equation.run().expect("a branch");
    let (mut worst, mut compared) = (0.0_f64, 0);
    for point in branch.points.iter().step_by(7) {
        let near = exact.clone().near_orbit(&point.orbit);
        let Ok(same) = near.orbit(point.value) else {
            continue;
        };
        compared += 1;
        let known = near.reading(signal, &same).expect("a reading").motion;
        let found = branch.reading(signal, point).expect("a reading").motion;
        let size = known.peak_to_peak();
        let of = if asked.is_some() {
            size
        } else {
            point.peak_to_peak().max(size)
        };
        let error = point.error.filter(|error| error.is_finite());
        let stated = error.expect("an error") * of + 1e-9 * size;
        let apart = found.peak_to_peak() - known.peak_to_peak();
        worst = worst.max(apart.abs() / stated);
        let [found, known] = [branch.complete(point), near.complete(&same)];
        let [found, known] = [found, known].map(|point| point.expect("an orbit").motion().rms);
        let apart = found
            .zip(known)
            .map_or(f64::INFINITY, |(found, known)| found - known);
        if asked.is_none() {
            worst = worst.max(apart.abs() / stated);
        }
    }
    (worst, compared)
}

/// The state of an orbit errs as the orbit does, and a motion from it by many times that before it is over. What is read has the error that
/// is stated nevertheless.
#[test]
fn what_is_read_is_as_near_as_is_stated() {
    for (system, signal, asked) in [
        (&TwoModes {} as &dyn System, "tip", Some("tip")),
        (&TwoModes {}, "x", None),
        (&FastFirst {}, "tip", Some("tip")),
        (&FastFirst {}, "y", None),
    ] {
        let (worst, compared) = off(system, signal, asked);
        assert!(compared > 15, "{compared}");
        assert!(worst < 1.0, "{signal}: {worst}");
    }
}
