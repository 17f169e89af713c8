//! First orbits, and what is said where there is none.

use hertzian::error::ErrorKind;
use hertzian::{FrequencyResponse, HarmonicBalance, NewtonError, OrbitError, System, Verdict};
use hertzian_tests::TwoMasses;

use crate::response::{CONTACT, Continuous, Duffing, Linear, OneSided, Pair};

/// No load: the stiffness at rest vanishes for exponents above one and is unbounded below one.
#[test]
fn without_load_a_start_is_found() {
    for (alpha, omega) in [(1.5, 0.6), (1.5, 3.0), (0.6, 0.66), (0.6, 1.4), (3.0, 0.5)] {
        let model = Continuous {
            zeta: 0.01,
            alpha,
            load: 0.0,
            drive: 0.1,
        };
        let branch = FrequencyResponse::of(&model)
            .by(HarmonicBalance::new())
            .from(omega)
            .to(1.01 * omega)
            .run()
            .unwrap();
        let point = &branch.points[0];
        assert_eq!(point.omega(), omega, "{alpha}");
        assert!(point.peak_to_peak() > 1e-4);
        let power = point.observed.input_power.unwrap() - point.observed.dissipated_power.unwrap();
        assert!(power.abs() < 1e-12, "{alpha} {power}");
    }
}

/// `x'' + x + x^3` has no scale of its own but one: over twelve decades of drive an orbit is found, and for the small
/// ones it is the linear response.
#[test]
fn tiny_and_huge_drives() {
    for exponent in -6..=6 {
        let drive = 10_f64.powi(exponent);
        let model = Duffing { zeta: 0.05, drive };
        let branch = FrequencyResponse::of(&model)
            .from(0.4)
            .to(0.41)
            .run()
            .unwrap();
        let point = &branch.points[0];
        if exponent <= -4 {
            let amplitude = drive / (1.0 - 0.16_f64).hypot(0.04);
            assert!((point.peak_to_peak() / (2.0 * amplitude) - 1.0).abs() < 1e-6);
        }
        let (input, output) = (
            point.observed.input_power.unwrap(),
            point.observed.dissipated_power.unwrap(),
        );
        assert!(
            (input - output).abs() < 1e-11 * input.abs().max(point.observed.contacts[0].peak_force)
        );
    }
}

/// The coexisting orbit of period two at drive 1, omega 1, alpha 1. Its exact peak-to-peak is known from the closed-form
/// flow between switches; a sampled balance of the jump in damping reaches three digits.
#[test]
fn an_orbit_of_period_two_is_found() {
    let model = OneSided {
        alpha: 1.0,
        drive: 1.0,
        ..CONTACT
    };
    let branch = FrequencyResponse::of(&model)
        .vary("drive")
        .omega(1.0)
        .from(1.0)
        .to(1.1)
        .period(2)
        .samples(1024)
        .harmonics(10)
        .run()
        .unwrap();
    let point = &branch.points[0];
    assert_eq!(point.orbit.base, 0.5);
    assert!(
        (point.peak_to_peak() - PERIOD_2_PEAK_TO_PEAK).abs() < 0.01,
        "{}",
        point.peak_to_peak()
    );
    assert_eq!(point.observed.contacts[0].count, 1);
}

const PERIOD_2_PEAK_TO_PEAK: f64 = 16.346_705_117_805_29;

/// An undamped resonance has no orbit, nothing holds a contact that is pulled away, and the square of a huge load is
/// infinite: the error is what an attempt met, with numbers.
#[test]
fn a_start_that_is_not_found_says_why() {
    let reason = |system: &dyn System, from: f64| {
        let request = FrequencyResponse::of(system).from(from).to(1.5);
        let error = match request.run() {
            Err(error) => error,
            Ok(branch) => panic!("{} points", branch.points.len()),
        };
        assert_eq!(error.kind(), ErrorKind::NoOrbit);
        match error.downcast_ref() {
            Some(&OrbitError::NoStart { value, reason }) if value == from => reason,
            _ => panic!("{error}"),
        }
    };
    let resonant = Linear {
        zeta: 0.0,
        drive: 0.1,
    };
    let pulled = OneSided {
        load: -1.0,
        ..CONTACT
    };
    for (system, from) in [(&resonant as &dyn System, 1.0), (&pulled, 0.5)] {
        let met = reason(system, from);
        assert!(
            matches!(met, NewtonError::Singular { pivot, .. } if pivot == 0.0),
            "{met}"
        );
    }
    let huge = Duffing {
        zeta: 0.05,
        drive: 1e300,
    };
    let met = reason(&huge, 0.5);
    assert!(matches!(met, NewtonError::NotFinite { .. }), "{met}");
}

/// A frequency so low that a step of the monodromy overflows: no verdict, and no hang.
#[test]
fn a_vanishing_frequency_ends() {
    let model = Pair {
        mass: 1.0,
        pulse: 0.0,
    };
    for omega in [1e-45, 1e-12] {
        let branch = FrequencyResponse::of(&model)
            .from(omega)
            .to(2.0 * omega)
            .run();
        if let Ok(branch) = branch {
            assert!(branch.points[0].stability.verdict != Verdict::Unstable);
        }
    }
}

hertzian::oscillator! {
    /// Beside its resonance the linear motion meets the stop, and says nothing of the orbit.
    CubicWithStop(x) {
        param drive;
        law hertz(gap) { gap > 0 => 5*gap^1.5, else => 0 }
        ddot(x) + 0.04*dot(x) + x + 0.3*x^3 + hertz(x - 0.8) = drive*cos(omega*t);
    }
}

/// A start costs little wherever it is, and finds an orbit of the branch that begins far from the resonance. Harmonics are few again
/// where contact is lost.
#[test]
fn a_start_beside_a_resonance_is_cheap() {
    let model = CubicWithStop { drive: 0.1 };
    let request = FrequencyResponse::of(&model).by(HarmonicBalance::new());
    let request = request.to(1.6);
    let whole = request.clone().from(0.3).run().unwrap();
    for omega in [0.9, 1.0, 1.05, 1.1, 1.3] {
        let only = request.clone().from(omega);
        let first = only.run_with(|_| std::ops::ControlFlow::Break(()));
        let first = first.unwrap();
        assert!(
            first.statistics.jacobians < 150,
            "{omega}: {}",
            first.statistics.jacobians
        );
        let found = first.points[0].peak_to_peak();
        let expected = whole.at(omega).unwrap();
        let near = expected
            .iter()
            .any(|point| (found / point.peak_to_peak() - 1.0).abs() < 2e-6);
        assert!(near, "{omega}: {found}");
    }
    let branch = request.from(1.0).run().unwrap();
    assert_eq!(branch.points.last().unwrap().orbit.harmonics(), 5);
}

/// A stop a thousand times stiffer than the springs couples all harmonics: the homotopy in the drive must not leave any out.
#[test]
fn an_orbit_against_a_stiff_stop_is_found() {
    let model = TwoMasses {
        stop: 1000.0,
        drive: 1.0,
    };
    for omega in [0.3, 0.5] {
        let request = FrequencyResponse::of(&model).harmonics(60);
        let request = request.stability(false).from(omega).to(omega + 0.1);
        let first = request.run_with(|_| std::ops::ControlFlow::Break(()));
        let first = first.unwrap();
        assert!(first.statistics.jacobians < 500);
        let observed = &first.points[0].observed;
        assert!(observed.motions[0].maximum > 1.0);
        let power = observed.input_power.unwrap() - observed.dissipated_power.unwrap();
        assert!(power.abs() < 1e-11, "{power}");
    }
}
