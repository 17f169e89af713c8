//! What is said of a request that cannot be fulfilled.

use hertzian::FrequencyResponse;

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

#[cfg(feature = "plot")]
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
