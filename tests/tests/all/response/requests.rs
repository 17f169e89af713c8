//! What is refused, what is left out, and what comes back.

use std::ops::ControlFlow;

use hertzian::{
    FrequencyResponse, HarmonicBalance, ModelError, RequestError, Stop, Verdict, oscillator,
};

use crate::response::{CONTACT, Fractional, OneSided, Pair};

/// What a request is refused with.
fn refused<E: std::error::Error + Clone + 'static>(request: &FrequencyResponse) -> E {
    let error = request.run().unwrap_err();
    let room = error.downcast_ref::<E>().cloned();
    room.unwrap_or_else(|| panic!("{error:#?}"))
}

#[test]
fn bad_requests_are_refused_before_any_work() {
    let good = || FrequencyResponse::of(&CONTACT).from(0.6).to(1.6);
    assert!(matches!(
        refused(&FrequencyResponse::of(&CONTACT)),
        RequestError::Missing { name: "from", .. }
    ));
    assert!(matches!(
        refused(&FrequencyResponse::of(&CONTACT).from(1.0)),
        RequestError::Missing { name: "to", .. }
    ));
    assert_eq!(
        refused::<RequestError>(&good().to(0.6)),
        RequestError::EmptyRange { value: 0.6 }
    );
    assert!(matches!(
        refused(&good().from(0.0)),
        RequestError::Option {
            name: "omega",
            value: 0.0,
            ..
        }
    ));
    assert!(matches!(
        refused(&good().to(f64::NAN)),
        RequestError::Option { name: "omega", .. }
    ));
    assert!(matches!(
        refused(&good().to(f64::INFINITY)),
        RequestError::Option { name: "omega", .. }
    ));
    assert!(matches!(
        refused(&good().harmonics(0)),
        RequestError::Option {
            name: "harmonics",
            ..
        }
    ));
    assert!(matches!(
        refused(&good().period(0)),
        RequestError::Option { name: "period", .. }
    ));
    assert!(matches!(
        refused(&good().tolerance(f64::NAN)),
        RequestError::Option {
            name: "tolerance",
            ..
        }
    ));
    assert!(matches!(
        refused(&good().tolerance(0.0)),
        RequestError::Option {
            name: "tolerance",
            ..
        }
    ));
    assert!(matches!(
        refused(&good().max_points(0)),
        RequestError::Option {
            name: "max_points",
            ..
        }
    ));
    assert!(matches!(
        refused(&good().harmonics(10).samples(16)),
        RequestError::Samples {
            samples: 16,
            least: 42,
            harmonics: 10
        }
    ));
    assert!(matches!(
        refused(&good().harmonics(5000)),
        RequestError::Unknowns {
            unknowns: 10_001,
            ..
        }
    ));
    assert!(matches!(
        refused(&good().vary("lode")),
        RequestError::UnknownParameter { .. }
    ));
    assert!(matches!(
        refused(&good().vary("drive")),
        RequestError::Missing { name: "omega", .. }
    ));
    assert!(matches!(
        refused(&good().vary("zeta").omega(1.0).from(-1.0)),
        RequestError::Parameter { .. }
    ));
}

#[test]
fn unusable_parameters_are_refused_with_their_range() {
    let negative = OneSided {
        zeta: -0.1,
        ..CONTACT
    };
    let error: RequestError = refused(&FrequencyResponse::of(&negative).from(0.6).to(1.6));
    assert_eq!(
        error.to_string(),
        "parameter zeta = -0.1 is outside its range [0, inf)"
    );
    let nan = OneSided {
        load: f64::NAN,
        ..CONTACT
    };
    assert!(matches!(
        refused(&FrequencyResponse::of(&nan).from(0.6).to(1.6)),
        RequestError::Parameter { .. }
    ));
    let fast = Fractional {};
    assert!(matches!(
        refused(&FrequencyResponse::of(&fast).from(0.6).to(1.6).harmonics(1)),
        RequestError::Harmonics {
            harmonics: 1,
            highest: 2
        }
    ));
}

#[test]
fn what_cannot_be_represented_is_refused() {
    let model = Pair {
        mass: 1.0,
        pulse: 0.1,
    };
    let good = || FrequencyResponse::of(&model).from(0.6).to(1.6);
    assert!(matches!(
        refused(&good().harmonics(5)),
        RequestError::Harmonics {
            harmonics: 5,
            highest: 7
        }
    ));
    assert!(matches!(
        refused(&good().omega(1.0)),
        RequestError::Option { name: "omega", .. }
    ));
    assert!(matches!(
        refused(&good().samples(10_000_000).period(30)),
        RequestError::Option {
            name: "samples",
            ..
        }
    ));
    let singular = Pair {
        mass: 0.0,
        pulse: 0.1,
    };
    assert_eq!(
        refused::<ModelError>(&FrequencyResponse::of(&singular).from(0.6).to(1.6)),
        ModelError::SingularMass { determinant: 0.0 }
    );
}

oscillator! {
    /// A linear oscillator without damping: its amplitude is `drive / |1 - omega^2|`.
    Undamped(x) {
        param drive;
        ddot(x) + x = drive*cos(omega*t);
    }
}

#[test]
fn a_resonance_without_damping_has_no_end() {
    for (drive, from, to) in [(1.0, 0.5, 1.5), (1e-9, 0.5, 1.5), (1.0, 1.5, 0.5)] {
        let model = Undamped { drive };
        let branch = FrequencyResponse::of(&model)
            .from(from)
            .to(to)
            .run()
            .unwrap();
        let Stop::Unbounded { value, growth } = branch.stopped else {
            panic!("{:?}", branch.stopped);
        };
        assert!((value - 1.0).abs() < 1e-9 && growth > 1e10);
        let point = &branch.points[branch.points.len() / 2];
        let exact = 2.0 * drive / (1.0 - point.value * point.value).abs();
        assert!((point.peak_to_peak() / exact - 1.0).abs() < 1e-6);
    }
}

#[test]
fn what_was_computed_comes_back() {
    let limited = FrequencyResponse::of(&CONTACT)
        .from(0.6)
        .to(1.6)
        .max_points(5)
        .run()
        .unwrap();
    assert_eq!(limited.stopped, Stop::PointLimit { points: 5 });
    assert_eq!(limited.points.len(), 5);
    let mut seen = 0;
    let interrupted = FrequencyResponse::of(&CONTACT)
        .from(0.6)
        .to(1.6)
        .run_with(|_| {
            seen += 1;
            if seen == 3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })
        .unwrap();
    assert_eq!(interrupted.stopped, Stop::Interrupted);
    assert_eq!(interrupted.points.len(), 3);
    assert!(interrupted.statistics.jacobians > 0 && interrupted.statistics.monodromies == 3);
}

/// The same request gives the same numbers, to the last bit.
#[test]
fn results_repeat() {
    let run = || {
        FrequencyResponse::of(&CONTACT)
            .from(0.9)
            .to(1.2)
            .harmonics(5)
            .run()
            .unwrap()
    };
    assert_eq!(run().points, run().points);
}

/// Without multipliers the same points, and nothing is said of stability.
#[test]
fn stability_can_be_left_out() {
    let request = FrequencyResponse::of(&CONTACT)
        .from(0.9)
        .to(1.0)
        .harmonics(5);
    let (with, without) = (
        request.run().unwrap(),
        request.clone().stability(false).run().unwrap(),
    );
    assert_eq!(with.points.len(), without.points.len());
    for (a, b) in with.points.iter().zip(&without.points) {
        assert_eq!(a.orbit, b.orbit);
        assert_eq!(b.stability.verdict, Verdict::Undecided);
        assert!(b.stability.multipliers.is_empty());
        assert!(a.error.is_some() && b.error.is_none());
    }
    assert_eq!(without.statistics.monodromies, 0);
}

/// No step takes more than 0.15 times the largest step's part of the range.
#[test]
fn steps_are_bounded() {
    let request = FrequencyResponse::of(&CONTACT)
        .from(0.9)
        .to(1.0)
        .harmonics(5)
        .stability(false);
    let branch = request.clone().largest_step(0.02).run().unwrap();
    for pair in branch.points.windows(2) {
        assert!((pair[1].value - pair[0].value).abs() < 0.1 * 0.15 * 0.02 * 1.5);
    }
    assert!(branch.points.len() > request.run().unwrap().points.len());
    for step in [0.0, -1.0, 2.0, f64::NAN] {
        assert!(request.clone().largest_step(step).run().is_err());
    }
}

/// One orbit, without a range around it: that of the branch, and near another one if asked for.
#[test]
fn an_orbit_at_a_value_is_that_of_the_branch() {
    let request = FrequencyResponse::of(&CONTACT);
    let orbit = request.orbit(1.5).unwrap();
    let branch = request.clone().from(1.5).to(1.6).run().unwrap();
    let apart = (orbit.peak_to_peak() - branch.points[0].peak_to_peak()).abs();
    assert!(apart < 1e-6 * orbit.peak_to_peak(), "{apart:.1e}");
    let near = request.near_orbit(&orbit.orbit);
    let again = near.orbit(1.501).unwrap();
    assert!((again.peak_to_peak() / orbit.peak_to_peak() - 1.0).abs() < 0.05);
    let error = near.clone().period(2).orbit(1.501).unwrap_err();
    assert!(
        matches!(
            error.downcast_ref(),
            Some(RequestError::Option { name: "period", .. })
        ),
        "{error}"
    );
    let of_another = FrequencyResponse::of(&NEIGHBOURS).near_orbit(&orbit.orbit);
    let expected = RequestError::State {
        entries: 2,
        expected: 4,
    };
    let error = of_another.orbit(1.5).unwrap_err();
    assert_eq!(error.downcast_ref(), Some(&expected));
}

hertzian::oscillator! {
    Neighbours(x, y) {
        ddot(x) + 0.1*dot(x) + 2*x - y = cos(omega*t);
        ddot(y) + 0.1*dot(y) + 2*y - x = 0;
    }
}

const NEIGHBOURS: Neighbours = Neighbours {};

/// Multipliers are asked of an orbit of another system.
#[test]
fn multipliers_of_an_orbit_of_another_system_are_refused() {
    let request = FrequencyResponse::of(&CONTACT).by(HarmonicBalance::new());
    let branch = request.from(1.5).to(1.6).run().unwrap();
    let other = FrequencyResponse::of(&NEIGHBOURS).orbit(1.5).unwrap();
    let error = branch
        .multipliers(&other, hertzian::Method::Default)
        .unwrap_err();
    let expected = RequestError::State {
        entries: 4,
        expected: 2,
    };
    assert_eq!(error.downcast_ref(), Some(&expected));
    let own = &branch.points[0];
    assert!(own.orbit.series(0).is_some());
    assert_eq!(own.orbit.series(1), None);
    assert!(branch.multipliers(own, hertzian::Method::Default).is_ok());
}
