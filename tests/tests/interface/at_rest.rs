//! The error that is stated of an output that does not move, by all methods.

use hertzian::{ContactEquation, FrequencyResponse, HarmonicBalance, OrbitMethod, Point, Shooting};

hertzian::oscillator! {
    /// A stop that is not reached, a pull that is constant, and two masses that move alike: the weight on one of them is carried.
    Alike(x, y) {
        param cubic;
        law stop(gap) { gap > 0 => 10*gap, else => 0 }
        law weight(gap) { gap > -100 => 3, else => 0 }
        ddot(x) + 0.1*dot(x) + x + cubic*x^3 + stop(x - 50) = 0.3*cos(omega*t);
        ddot(y) + 0.1*dot(y) + y + cubic*y^3 + weight(y) = 0.3*cos(omega*t) + 3;
        output pushes = force(stop);
        output pulls = force(weight);
        output apart = y - x;
        output beside = 2 + (y - x);
    }
}

hertzian::oscillator! {
    /// Two masses hang alike on one that is stopped; another one stays where it is.
    Straight(x, y, z, still) {
        law reached(gap) { gap > 0 => 5*gap, else => 0 }
        law stop(gap) { gap > 0 => 10*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + reached(x - 0.5) + stop(x - 50) - 0.3*y - 0.3*z = 0.3*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 4*y - 0.3*x = 0;
        ddot(z) + 0.1*dot(z) + 4*z - 0.3*x = 0;
        ddot(still) + 0.1*dot(still) + 5*still = 1;
        output pushes = force(stop);
        output apart = z - y;
        output beside = 2 + (z - y);
    }
}

const ALIKE: Alike = Alike { cubic: 0.3 };
const VALUE: f64 = 0.9;

/// The orbit with the accuracy of an output.
fn orbit<M: OrbitMethod>(request: &FrequencyResponse<M>, name: &str) -> Point {
    let request = request.clone().accuracy_of(name);
    request.orbit(VALUE).expect("an orbit")
}

/// A force that is zero has no error, and one that is constant none but rounding; of a difference that is zero but for rounding, the error is
/// not said to be less than that.
fn is_honest<M: OrbitMethod>(request: &FrequencyResponse<M>, outputs: &[&str]) {
    let plain = request.orbit(VALUE).expect("an orbit");
    for (index, &name) in outputs.iter().enumerate() {
        let orbit = orbit(request, name);
        let error = orbit.error.expect("an error");
        let motion = orbit.observed.outputs[index];
        let wrong = motion.maximum - motion.minimum;
        let largest = motion.maximum.abs().max(motion.minimum.abs());
        match name {
            "pushes" => assert_eq!((error, wrong, largest), (0.0, 0.0, 0.0)),
            "pulls" | "beside" => assert!(error <= 1e-8, "{name}: {error:e}"),
            _ => {}
        }
        if name == "apart" {
            // Not known at all, if it is not zero to the last bit.
            assert!(error == 0.0 && wrong == 0.0 || error >= 1.0, "{error:e}");
        } else {
            assert!(wrong <= error * largest, "{name}: {error:e} {motion:?}");
        }
        assert!(
            orbit.orbit.harmonics() <= plain.orbit.harmonics(),
            "{name}: {}",
            orbit.orbit.harmonics()
        );
    }
}

#[test]
fn by_the_balance() {
    let request = FrequencyResponse::of(&ALIKE).from(0.5).to(1.5);
    is_honest(&request, &["pushes", "pulls", "apart", "beside"]);
    let request = FrequencyResponse::of(&Straight {}).from(0.5).to(1.5);
    let request = request.tolerance(1e-3);
    is_honest(&request, &["pushes", "apart", "beside"]);
}

/// Orbits between those of a branch, and those of the branch, take no harmonics for noise.
#[test]
fn of_a_branch_by_the_balance() {
    let most = |request: &FrequencyResponse<HarmonicBalance>| {
        let branch = request.run().expect("a branch");
        let between = branch.at(0.937).expect("orbits");
        let points = branch.points.iter().chain(&between);
        points.map(|point| point.orbit.harmonics()).max()
    };
    let alike = FrequencyResponse::of(&ALIKE).by(HarmonicBalance::new());
    let alike = alike.from(0.9).to(1.0);
    let straight = FrequencyResponse::of(&Straight {}).by(HarmonicBalance::new());
    let straight = straight.from(0.9).to(0.95);
    for (request, names) in [
        (
            alike.tolerance(1e-4),
            &["pushes", "pulls", "apart", "beside"][..],
        ),
        (straight.tolerance(1e-3), &["pushes", "apart", "beside"]),
    ] {
        let plain = most(&request);
        for &name in names {
            let harmonics = most(&request.clone().accuracy_of(name));
            assert!(harmonics <= plain, "{name}: {harmonics:?}");
        }
    }
}

#[test]
fn by_shooting() {
    let request = FrequencyResponse::of(&ALIKE).from(0.5).to(1.5);
    let request = request.by(Shooting::new());
    is_honest(&request, &["pushes", "pulls", "apart", "beside"]);
    let request = FrequencyResponse::of(&Straight {}).from(0.5).to(1.5);
    let request = request.by(Shooting::new());
    is_honest(&request, &["pushes", "apart", "beside"]);
}

#[test]
fn by_the_contact_equation() {
    let request = FrequencyResponse::of(&Straight {}).from(0.5).to(1.5);
    let request = request.by(ContactEquation::new());
    is_honest(&request, &["pushes", "apart", "beside"]);
}

/// A coordinate that does not move is measured by the largest one.
#[test]
fn a_coordinate_at_rest_is_known_as_well_as_others() {
    let request = FrequencyResponse::of(&Straight {}).from(0.5).to(1.5);
    let request = request.tolerance(1e-3).accuracy_of("still");
    let errors = [
        request.orbit(VALUE).expect("an orbit").error,
        request
            .clone()
            .by(Shooting::new())
            .orbit(VALUE)
            .expect("an orbit")
            .error,
        request
            .by(ContactEquation::new())
            .orbit(VALUE)
            .expect("an orbit")
            .error,
    ];
    assert!(errors.iter().all(|error| *error < Some(1e-3)), "{errors:?}");
}
