//! Orbits whose motion is known in closed form.

use std::f64::consts::{PI, TAU};

use hertzian::observe::{amplitudes, phases};
use hertzian::{FrequencyResponse, Stop, Verdict};

use crate::response::{CONTACT, Duffing, Fractional, Linear, OneSided};

#[test]
fn a_linear_oscillator_has_its_closed_form() {
    let model = Linear {
        zeta: 0.05,
        drive: 0.3,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.5)
        .to(1.5)
        .harmonics(3)
        .run()
        .unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    assert!(branch.events.is_empty() && branch.turns.is_empty());
    for point in &branch.points {
        let omega = point.omega();
        let (stiffness, damping) = (1.0 - omega * omega, 0.1 * omega);
        let amplitude = 0.3 / stiffness.hypot(damping);
        let series = point.orbit.series(0).unwrap();
        assert!((amplitudes(series)[1] - amplitude).abs() < 1e-12 * amplitude);
        assert!((phases(series)[1] - damping.atan2(stiffness)).abs() < 1e-12);
        assert!((point.peak_to_peak() - 2.0 * amplitude).abs() < 1e-12 * amplitude);
        assert_eq!(point.stability.verdict, Verdict::Stable);
        // Both multipliers are exp((-zeta +- i sqrt(1 - zeta^2)) 2 pi / omega).
        let modulus = (-0.05 * TAU / omega).exp();
        for multiplier in &point.stability.multipliers {
            assert!((multiplier.norm() - modulus).abs() < 1e-13);
        }
        let power = 0.1 * (omega * amplitude).powi(2) / 2.0;
        assert!((point.observed.dissipated_power.unwrap() - power).abs() < 1e-12);
    }
}

#[test]
fn a_fraction_of_the_frequency_sets_the_base() {
    let model = Fractional {};
    let branch = FrequencyResponse::of(&model)
        .from(1.0)
        .to(1.2)
        .harmonics(4)
        .run()
        .unwrap();
    let point = &branch.points[0];
    assert!((point.orbit.base - 1.0 / 3.0).abs() < 1e-15);
    let forced: f64 = 2.0 / 3.0;
    let amplitude = 1.0 / (1.0 - forced * forced).hypot(0.2 * forced);
    assert!((amplitudes(point.orbit.series(0).unwrap())[2] - amplitude).abs() < 1e-12);
}

/// Without drive the orbit is the state at rest: `x = W^(1/alpha)`, with multipliers of the linearised system.
#[test]
fn without_drive_the_orbit_rests() {
    let model = OneSided {
        drive: 0.0,
        load: 2.0,
        ..CONTACT
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.6)
        .to(1.6)
        .harmonics(3)
        .run()
        .unwrap();
    let rest = 2.0_f64.powf(1.0 / 1.5);
    for point in &branch.points {
        let motion = point.motion();
        assert!((motion.mean.unwrap() - rest).abs() < 1e-12);
        assert!(motion.peak_to_peak() < 1e-12);
        assert_eq!(point.observed.contacts[0].fraction, 1.0);
        assert_eq!(point.observed.contacts[0].count, 1);
        assert!((point.observed.contacts[0].peak_force - 2.0).abs() < 1e-11);
        assert!(
            (point.stability.multipliers[0].norm() - (-0.032 * TAU / point.omega()).exp()).abs()
                < 1e-9
        );
    }
}

/// Without damping the linear response has multipliers on the unit circle, so no verdict is possible.
#[test]
fn without_damping_there_is_no_verdict() {
    let model = Linear {
        zeta: 0.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.3)
        .to(0.8)
        .harmonics(1)
        .run()
        .unwrap();
    for point in &branch.points {
        assert_eq!(point.stability.verdict, Verdict::Undecided);
        assert!((point.stability.multipliers[0].norm() - 1.0).abs() < 1e-14);
    }
}

/// One harmonic: for `x^3` the balance is `(1 - w^2) a + 3/4 a^3 = A` when there is no damping.
#[test]
fn one_harmonic_of_a_cubic_is_the_textbook_formula() {
    let model = Duffing {
        zeta: 0.0,
        drive: 0.2,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.3)
        .to(0.9)
        .harmonics(1)
        .run()
        .unwrap();
    for point in &branch.points {
        let a = point.orbit.series(0).unwrap()[1];
        let omega = point.omega();
        let balance = (1.0 - omega * omega) * a + 0.75 * a.powi(3);
        assert!((balance - 0.2).abs() < 1e-12);
    }
}

/// A frequency is an angle per time: a period of the excitation is `2 pi / omega`.
#[test]
fn states_are_those_of_time() {
    let model = Linear {
        zeta: 0.05,
        drive: 0.3,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.5)
        .to(0.6)
        .harmonics(1)
        .run()
        .unwrap();
    let orbit = &branch.points[0].orbit;
    let (x0, v0) = orbit.state_at(0, 0.0).unwrap();
    let (x1, v1) = orbit.state_at(0, PI / 0.5).unwrap();
    assert!((x0 + x1).abs() < 1e-15 && (v0 + v1).abs() < 1e-15);
}

hertzian::oscillator! {
    /// A linear oscillator under a load that shifts it far.
    Loaded(x) {
        param load;
        ddot(x) + 0.02*dot(x) + x = load + 0.1*cos(omega*t);
    }
}

/// The resonance is ten high whatever the load is: a large mean does not hide it from the steps.
#[test]
fn a_resonance_is_not_stepped_over_under_a_heavy_load() {
    for load in [0.0, 100.0, 1000.0, 1e6] {
        let model = Loaded { load };
        let branch = FrequencyResponse::of(&model)
            .from(0.5)
            .to(1.5)
            .harmonics(1)
            .samples(16)
            .run()
            .unwrap();
        let highest = branch
            .points
            .iter()
            .map(hertzian::Point::peak_to_peak)
            .fold(0.0, f64::max);
        assert!((highest - 10.0).abs() < 0.05, "load {load}: {highest}");
    }
}

/// The response of a linear oscillator vanishes with its drive; the branch passes through rest in ordinary steps.
#[test]
fn a_sweep_passes_through_rest() {
    let model = Linear {
        zeta: 0.05,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model)
        .vary("drive")
        .omega(0.8)
        .harmonics(1)
        .samples(16);
    for (from, to) in [(-0.1, 0.1), (0.1, 0.0), (0.0, 0.1)] {
        let branch = request.clone().from(from).to(to).run().unwrap();
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        assert!(
            branch.points.len() < 500,
            "{from} to {to}: {} points",
            branch.points.len()
        );
    }
}
