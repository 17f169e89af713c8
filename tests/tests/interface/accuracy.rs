//! Accuracy that is asked of one output, and the error that is stated of it, against shooting to eleven digits.

use hertzian::{
    Branch, ContactEquation, FrequencyResponse, HarmonicBalance, OrbitMethod, Shooting,
};

hertzian::oscillator! {
    /// The two masses move together but for a little.
    Pair(x, y) {
        param zeta in 0.0..;
        law stop(gap) { gap > 0 => 0.2*dot(gap) + 20*gap, else => 0 }
        ddot(x) + zeta*dot(x) + x + 30*(x - y) + stop(x - 0.8) = 0.3*cos(omega*t);
        ddot(y) + zeta*dot(y) + 30*(y - x) = 0;
        output slip = y - x;
        output pushes = force(stop);
        output shock = ddot(x);
    }
}

hertzian::oscillator! {
    /// Stiffness in contact that grows as the root of the gap.
    Ball(x) {
        law contact(gap) { gap > 0 => 0.1*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = 0.4*cos(omega*t) + 1;
        output speed = dot(x);
        output pushes = force(contact);
        output place = x;
    }
}

const PAIR: Pair = Pair { zeta: 0.05 };
/// Where the stop is hit.
const VALUES: [f64; 3] = [0.65, 0.7, 0.75];

/// Peak-to-peak of a signal of the orbit at a value, known to eleven digits.
fn known<M: OrbitMethod>(request: &FrequencyResponse<M>, name: &str, value: f64) -> f64 {
    let exact = request.clone().by(Shooting::new()).tolerance(1e-11);
    let orbit = exact.orbit(value).expect("an orbit");
    let reading = exact.reading(name, &orbit).expect("a signal");
    reading.motion.peak_to_peak()
}

/// The error of a signal at a value is below what is stated, and that below the tolerance; harmonics of the orbit, if it has them.
fn keeps<M: OrbitMethod>(
    request: &FrequencyResponse<M>,
    name: &str,
    value: f64,
    tolerance: f64,
) -> usize {
    let exact = known(request, name, value);
    let request = request.clone().tolerance(tolerance).accuracy_of(name);
    let orbit = request.orbit(value).expect("an orbit");
    let found = request.measured(&name.parse().expect("a name"), &orbit);
    let found = found.expect("a signal").expect("a number");
    let (error, stated) = ((found / exact - 1.0).abs(), orbit.error.expect("an error"));
    assert!(
        error <= stated + 1e-11,
        "{name} at {value}: {error:e} {stated:e}"
    );
    assert!(stated <= tolerance, "{name} at {value}: {stated:e}");
    orbit.orbit.harmonics()
}

#[test]
fn harmonics_follow_the_error_of_the_output() {
    let request = FrequencyResponse::of(&PAIR).from(0.4).to(0.9);
    for value in VALUES {
        let plain = request
            .clone()
            .tolerance(1e-3)
            .orbit(value)
            .expect("an orbit");
        for name in ["x", "slip", "pushes", "shock"] {
            let harmonics = keeps(&request, name, value, 1e-3);
            if name == "shock" {
                assert!(harmonics > plain.orbit.harmonics(), "{harmonics}");
            }
        }
        keeps(&request, "slip", value, 1e-5);
    }
    let request = FrequencyResponse::of(&Ball {}).from(0.6).to(1.3);
    for value in [0.75, 1.1] {
        for name in ["x", "speed", "pushes"] {
            keeps(&request, name, value, 1e-5);
        }
    }
}

#[test]
fn shooting_and_the_contact_equation_state_the_error_of_the_output() {
    let request = FrequencyResponse::of(&PAIR).from(0.4).to(0.9);
    for value in VALUES {
        for name in ["y", "slip", "pushes", "shock"] {
            keeps(&request.clone().by(Shooting::new()), name, value, 1e-4);
            keeps(
                &request.clone().by(ContactEquation::new()),
                name,
                value,
                1e-4,
            );
        }
    }
    let request = FrequencyResponse::of(&Ball {}).from(0.6).to(1.3);
    for name in ["speed", "pushes", "place", "x"] {
        keeps(&request.clone().by(Shooting::new()), name, 0.75, 1e-5);
        keeps(
            &request.clone().by(ContactEquation::new()),
            name,
            0.75,
            1e-5,
        );
    }
}

/// Every orbit of a branch has the error of the output, and says so.
fn branch<M: OrbitMethod>(request: &FrequencyResponse<M>) -> Branch {
    let branch = request.run().expect("a branch");
    assert_eq!(branch.accuracy_of(), Some("slip"));
    assert!(branch.points.iter().all(|point| point.error < Some(1e-4)));
    assert!(
        branch
            .to_csv()
            .lines()
            .next()
            .expect("names")
            .contains(",error_of_slip,")
    );
    branch
}

#[test]
fn the_order_of_calls_does_not_matter() {
    let request = FrequencyResponse::of(&PAIR).from(0.5).to(0.55);
    let (one, other) = (
        request
            .clone()
            .accuracy_of("slip")
            .tolerance(1e-4)
            .by(HarmonicBalance::new()),
        request
            .clone()
            .by(HarmonicBalance::new())
            .tolerance(1e-4)
            .accuracy_of("slip"),
    );
    assert_eq!(branch(&one).points, branch(&other).points);
    let (one, other) = (
        request
            .clone()
            .accuracy_of("slip")
            .by(Shooting::new())
            .tolerance(1e-4),
        request
            .by(Shooting::new())
            .accuracy_of("slip")
            .tolerance(1e-4),
    );
    assert_eq!(branch(&one).points, branch(&other).points);
}

/// What goes on from a branch has the same accuracy.
#[test]
fn a_branch_keeps_what_its_accuracy_is_of() {
    let request = FrequencyResponse::of(&PAIR).from(0.65).to(0.66);
    let request = request.accuracy_of("slip").tolerance(1e-4);
    let whole = branch(&request);
    let at = whole.at(0.655).expect("orbits");
    let exact = known(&request, "slip", 0.655);
    let found = at[0].observed.outputs[0].peak_to_peak();
    assert!((found / exact - 1.0).abs() < at[0].error.expect("an error"));
    let longer = whole.resume().to(0.662).run().expect("a branch");
    assert_eq!(longer.accuracy_of(), Some("slip"));
    let coarser = whole.resume().tolerance(1e-3).run().expect("a branch");
    assert_eq!(coarser.accuracy_of(), Some("slip"));
    assert!(coarser.points.iter().all(|point| point.error < Some(1e-3)));
    let plain = FrequencyResponse::of(&PAIR).from(0.5).to(0.52).run();
    assert_eq!(plain.expect("a branch").accuracy_of(), None);
}

#[test]
fn what_has_no_accuracy_is_refused() {
    for name in ["slipp", "stop", ""] {
        let request = FrequencyResponse::of(&PAIR).from(0.5).to(0.55);
        let error = request.accuracy_of(name).run().expect_err("no such output");
        let said = error.to_string();
        assert!(said.contains("slip, pushes, shock, x, y"), "{said}");
    }
}

/// Where extremes of an output change alike, its peak-to-peak changes less by chance than either does.
#[test]
fn an_error_is_not_small_by_chance() {
    let request = FrequencyResponse::of(&Ball {}).from(0.6).to(1.3);
    for value in [0.97818, 0.9792] {
        keeps(
            &request.clone().by(ContactEquation::new()),
            "speed",
            value,
            1e-4,
        );
    }
}

/// Before a fold most of the error is along the branch: of an output that is a coordinate as much as of that.
#[test]
fn the_first_orbit_of_a_branch_has_its_error_along_the_branch_too() {
    let request = FrequencyResponse::of(&Ball {}).by(ContactEquation::new());
    let request = request.from(0.978_170_2).to(0.6).max_points(2);
    let [place, x] = ["place", "x"].map(|name| {
        let branch = request.clone().accuracy_of(name).run();
        branch.expect("a branch").points[0].error.expect("an error")
    });
    assert!((place / x - 1.0).abs() < 1e-3, "{place:e} {x:e}");
}

hertzian::oscillator! {
    /// A stop that is not reached.
    Hard(x) {
        law stop(gap) { gap > 0 => gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + x^3 + stop(x - 50) = 0.3*cos(omega*t);
        output speed = dot(x);
        output pushes = force(stop);
    }
}

#[test]
fn events_by_shooting_have_the_error_of_the_output() {
    let request = FrequencyResponse::of(&Hard {}).from(1.0).to(2.2);
    let request = request.by(Shooting::new());
    let speed = |branch: &Branch| -> Vec<_> {
        let folds = branch.folds().map(|fold| &fold.point);
        folds
            .map(|at| (at.observed.outputs[0].peak_to_peak(), at.error))
            .collect()
    };
    let exact = request.clone().tolerance(1e-11).run().expect("a branch");
    let coarse = request.tolerance(1e-3).accuracy_of("speed");
    let found = speed(&coarse.run().expect("a branch"));
    assert_eq!(found.len(), 2);
    for ((found, stated), (exact, _)) in found.into_iter().zip(speed(&exact)) {
        let (error, stated) = ((found / exact - 1.0).abs(), stated.expect("an error"));
        assert!(error <= stated, "{error:e} {stated:e}");
    }
    // A force that is zero is known.
    let pushes = coarse.accuracy_of("pushes").run().expect("a branch");
    let errors = pushes.folds().map(|fold| fold.point.error);
    assert!(errors.eq([Some(0.0), Some(0.0)]));
}

/// What is computed of an orbit or an event by shooting, whatever found it, has the same accuracy, and refuses the same names.
#[test]
fn what_shooting_completes_has_a_name_too() {
    let request = FrequencyResponse::of(&Hard {}).from(1.0).to(2.2);
    let request = request.by(Shooting::new()).tolerance(1e-3);
    let branch = request.run().expect("a branch");
    let fold = branch.folds().next().expect("a fold");
    let wrong = request.accuracy_of("sped");
    let errors = [
        wrong.complete(&fold.point).err(),
        wrong.reading("speed", &fold.point).err(),
        wrong.track(fold, "omega", [1.0, 2.0]).err(),
    ];
    for error in errors {
        let said = error.expect("no such output").to_string();
        assert!(said.contains("speed, pushes, x"), "{said}");
    }
}
