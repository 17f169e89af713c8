//! What is said of a request that cannot be fulfilled.

use hertzian::FrequencyResponse;
use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::error::ErrorKind;
use hertzian::structure::{DMatrix, Structure, parameter};

hertzian::oscillator! {
    Linear(x) {
        param drive;
        ddot(x) + 0.1*dot(x) + x = drive*cos(omega*t);
    }
}

const MODEL: Linear = Linear { drive: 0.1 };

#[test]
fn a_missing_end_is_named() {
    let of = || FrequencyResponse::of(&MODEL);
    for (request, expected) in [
        (
            of().to(2.0),
            "the range is not complete: `from(...)` has not been called",
        ),
        (
            of().from(0.5),
            "the range is not complete: `to(...)` has not been called",
        ),
        (
            of().vary("drive").from(0.1).to(0.2),
            "there is one excitation frequency, and it is not known: `omega(...)` has not been called",
        ),
    ] {
        let error = request.run().expect_err("something is missing");
        assert_eq!(error.to_string(), expected);
    }
}

hertzian::oscillator! {
    Pair(x, y) {
        param m;
        param coupling;
        m*ddot(x) + coupling*ddot(y) + 0.1*dot(x) + x = cos(omega*t);
        coupling*ddot(x) + 2*ddot(y) + 0.1*dot(y) + y = 0;
    }
}

#[test]
fn masses_are_positive() {
    for (m, coupling, expected) in [
        (-3.0, 0.0, "the mass of x is -3e0, and a mass is positive"),
        // The eigenvalues of [2 3; 3 2] are 5 and -1.
        (2.0, 3.0, "has the eigenvalue -"),
    ] {
        let model = Pair { m, coupling };
        let response = FrequencyResponse::of(&model).from(0.5).to(0.6).run();
        let text = response.expect_err("it has no sense").to_string();
        assert!(text.contains(expected), "{text}");
    }
    let model = Pair {
        m: 2.0,
        coupling: 1.0,
    };
    let response = FrequencyResponse::of(&model).from(0.1).to(0.2).run();
    assert!(response.is_ok());
}

#[test]
fn a_file_that_cannot_be_written_is_named_once() {
    let branch = FrequencyResponse::of(&MODEL).from(0.5).to(0.6).run();
    let branch = branch.expect("it is linear");
    let folder = std::env::temp_dir();
    let text = branch.plot(&folder).expect_err("a folder").to_string();
    let start = format!("cannot write {}: ", folder.display());
    let reason = text.strip_prefix(&start).expect("it begins so");
    assert!(!reason.contains("cannot write"), "{text}");
}

hertzian::oscillator! {
    /// Where its law is zero a motion from rest stays at rest.
    Plate(x) {
        law stop(gap) { gap > 0 => gap, else => 0 }
        ddot(x) + stop(x) = 0;
    }
}

/// A program reads the numbers of errors whose enums are private, whichever room says no.
#[test]
fn numbers_of_every_room_are_read() {
    let one = DMatrix::identity(2, 2);
    let structure = || Structure::of(&one, &(0.1 * &one), &one);
    let load = |at| (0, 1, parameter("drive", at));
    let error = [load(0.5), load(0.75)]
        .into_iter()
        .fold(structure(), |to, (coordinate, harmonic, amplitude)| {
            to.cosine(coordinate, harmonic, amplitude)
        })
        .build()
        .expect_err("two values of one name");
    assert_eq!(error.kind(), ErrorKind::Model);
    assert_eq!(error.variant(), "TwoValues");
    assert_eq!(error.values(), [("first", 0.5), ("second", 0.75)]);

    let free = FreeOscillation::of(&Plate {}).from(-1.0).to(2.0);
    let error = free.run().expect_err("nothing moves");
    assert_eq!(
        (error.kind(), error.variant()),
        (ErrorKind::NoOrbit, "NeverAtRest")
    );
    assert_eq!(error.values(), [("position", -1.0)]);

    let resonance = PhaseResonance::of(&MODEL).vary("drive").to(0.2);
    let error = resonance.between(2.0, 3.0).run();
    let error = error.expect_err("it is at one");
    let expected = [("value", 0.1), ("from", 2.0), ("to", 3.0)];
    assert_eq!(
        (error.variant(), error.values()),
        ("NoResonance", expected.to_vec())
    );
}

/// The least value of a linear oscillator is its closed form, with the sign turned round.
#[test]
fn numbers_of_a_chart_are_read() {
    use hertzian::chart::{Scale, View};

    let branch = FrequencyResponse::of(&MODEL).from(0.5).to(0.6).run();
    let branch = branch.expect("it is linear");
    let minimum = "x:min".parse().expect("a measure");
    let view = View::new().of(minimum).scale(Scale::Decibel);
    let error = branch.chart_of(&view).expect_err("it is negative");
    let at = error.value("at").expect("where");
    let amplitude = 0.1 / (1.0 - at * at).hypot(0.1 * at);
    let value = error.value("value").expect("the value");
    assert_eq!(error.variant(), "NotPositive");
    assert!((value + amplitude).abs() < 1e-6, "{value} {amplitude}");
}
