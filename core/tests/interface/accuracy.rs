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
    for name in ["speed", "pushes"] {
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
