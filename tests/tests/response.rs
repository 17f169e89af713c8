//! The public interface of the runtime: closed forms, edges, errors, and what comes back.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use hertzian::error::NewtonError;
use hertzian::observe::{amplitudes, phases};
use hertzian::{Aft, Error, FrequencyResponse, Stop, System, Verdict};

hertzian::oscillator! {
    /// Nothing but linear terms.
    Linear(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// The paper's Eq. (1).
    OneSided(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^alpha, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    Continuous(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param load;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    Duffing(x) {
        param zeta in 0.0..;
        param drive;
        ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Force at twice a third of the frequency: the orbit needs three excitation periods.
    Fractional(x) {
        ddot(x) + 0.2*dot(x) + x = cos(2/3*omega*t);
    }
}

const CONTACT: OneSided = OneSided {
    zeta: 0.032,
    alpha: 1.5,
    load: 1.0,
    drive: 0.1,
};

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
        let series = point.orbit.series(0);
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
        assert!((point.observed.dissipated_power - power).abs() < 1e-12);
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
    assert!((amplitudes(point.orbit.series(0))[2] - amplitude).abs() < 1e-12);
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
        assert!((motion.mean - rest).abs() < 1e-12);
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
            .from(omega)
            .to(1.01 * omega)
            .run()
            .unwrap();
        let point = &branch.points[0];
        assert_eq!(point.omega(), omega, "{alpha}");
        assert!(point.peak_to_peak() > 1e-4);
        let power = point.observed.input_power - point.observed.dissipated_power;
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
        let (input, output) = (point.observed.input_power, point.observed.dissipated_power);
        assert!(
            (input - output).abs() < 1e-11 * input.abs().max(point.observed.contacts[0].peak_force)
        );
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
        let a = point.orbit.series(0)[1];
        let omega = point.omega();
        let balance = (1.0 - omega * omega) * a + 0.75 * a.powi(3);
        assert!((balance - 0.2).abs() < 1e-12);
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

#[test]
fn a_sweep_of_the_drive_is_the_same_curve() {
    let by_omega = FrequencyResponse::of(&CONTACT)
        .from(0.6)
        .to(1.0)
        .run()
        .unwrap();
    let target = by_omega.at(0.8).unwrap();
    let by_drive = FrequencyResponse::of(&CONTACT)
        .vary("drive")
        .omega(0.8)
        .from(0.01)
        .to(0.2)
        .run()
        .unwrap();
    let found = by_drive.at(0.1).unwrap();
    assert!((found[0].peak_to_peak() - target[0].peak_to_peak()).abs() < 1e-9);
    assert_eq!(by_drive.varied, "drive");
    assert_eq!(found[0].omega(), 0.8);
    assert_eq!(found[0].value, 0.1);
    assert_eq!(found[0].parameters[3], 0.1);
}

#[test]
fn every_solution_at_a_value_is_returned() {
    let model = Continuous {
        zeta: 0.01,
        alpha: 1.5,
        load: 0.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.6)
        .to(1.7)
        .run()
        .unwrap();
    let three = branch.at(1.1).unwrap();
    assert_eq!(three.len(), 3);
    assert_eq!(
        three
            .iter()
            .map(|p| p.stability.verdict)
            .collect::<Vec<_>>(),
        [Verdict::Stable, Verdict::Unstable, Verdict::Stable]
    );
    assert!(three.iter().all(|point| point.omega() == 1.1));
    assert_eq!(branch.at(1.5).unwrap().len(), 1);
    assert!(branch.at(2.0).unwrap().is_empty());
    assert_eq!(branch.at(0.6).unwrap().len(), 1);
}

/// An undamped resonance has no orbit, nothing holds a contact that is pulled away, and the square of a huge load is
/// infinite: the error is what an attempt met, with numbers.
#[test]
fn a_start_that_is_not_found_says_why() {
    let reason = |system: &dyn System, from: f64| {
        let request = FrequencyResponse::of(system).from(from).to(1.5);
        match request.run() {
            Err(Error::NoStart { value, reason }) if value == from => reason,
            Err(error) => panic!("{error}"),
            Ok(branch) => panic!("{} points", branch.points.len()),
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
            matches!(met, NewtonError::Singular { at, .. } if at.pivot == 0.0),
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

#[test]
fn generated_and_interpreted_models_give_one_curve() {
    let interpreted = CONTACT.generic();
    let request = |system| FrequencyResponse::of(system).from(1.2).to(1.5).harmonics(8);
    let a = request(&CONTACT as &dyn System).run().unwrap();
    let b = request(&interpreted).run().unwrap();
    assert_eq!(a.points.len(), b.points.len());
    for (p, q) in a.points.iter().zip(&b.points) {
        assert!((p.peak_to_peak() - q.peak_to_peak()).abs() < 1e-12);
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
        matches!(error, Error::Option { name: "period", .. }),
        "{error}"
    );
    let of_another = FrequencyResponse::of(&NEIGHBOURS).near_orbit(&orbit.orbit);
    let expected = Error::State {
        entries: 2,
        expected: 4,
    };
    assert_eq!(of_another.orbit(1.5).unwrap_err(), expected);
}

hertzian::oscillator! {
    Neighbours(x, y) {
        ddot(x) + 0.1*dot(x) + 2*x - y = cos(omega*t);
        ddot(y) + 0.1*dot(y) + 2*y - x = 0;
    }
}

const NEIGHBOURS: Neighbours = Neighbours {};

#[test]
fn bad_requests_are_refused_before_any_work() {
    let good = || FrequencyResponse::of(&CONTACT).from(0.6).to(1.6);
    let refused = |request: FrequencyResponse<'_>| request.run().unwrap_err();
    assert_eq!(
        refused(FrequencyResponse::of(&CONTACT)),
        Error::Missing { name: "from" }
    );
    assert_eq!(
        refused(FrequencyResponse::of(&CONTACT).from(1.0)),
        Error::Missing { name: "to" }
    );
    assert_eq!(refused(good().to(0.6)), Error::EmptyRange { value: 0.6 });
    assert!(matches!(
        refused(good().from(0.0)),
        Error::Option {
            name: "omega",
            value: 0.0,
            ..
        }
    ));
    assert!(matches!(
        refused(good().to(f64::NAN)),
        Error::Option { name: "omega", .. }
    ));
    assert!(matches!(
        refused(good().to(f64::INFINITY)),
        Error::Option { name: "omega", .. }
    ));
    assert!(matches!(
        refused(good().harmonics(0)),
        Error::Option {
            name: "harmonics",
            ..
        }
    ));
    assert!(matches!(
        refused(good().period(0)),
        Error::Option { name: "period", .. }
    ));
    assert!(matches!(
        refused(good().tolerance(f64::NAN)),
        Error::Option {
            name: "tolerance",
            ..
        }
    ));
    assert!(matches!(
        refused(good().tolerance(0.0)),
        Error::Option {
            name: "tolerance",
            ..
        }
    ));
    assert!(matches!(
        refused(good().max_points(0)),
        Error::Option {
            name: "max_points",
            ..
        }
    ));
    assert!(matches!(
        refused(good().harmonics(10).samples(16)),
        Error::Samples {
            samples: 16,
            least: 42,
            harmonics: 10
        }
    ));
    assert!(matches!(
        refused(good().harmonics(5000)),
        Error::Unknowns {
            unknowns: 10_001,
            ..
        }
    ));
    assert!(matches!(
        refused(good().vary("lode")),
        Error::UnknownParameter { .. }
    ));
    assert_eq!(
        refused(good().vary("drive")),
        Error::Missing { name: "omega" }
    );
    assert!(matches!(
        refused(good().vary("zeta").omega(1.0).from(-1.0)),
        Error::Parameter { .. }
    ));
}

#[test]
fn unusable_parameters_are_refused_with_their_range() {
    let refused = |request: FrequencyResponse<'_>| request.run().unwrap_err();
    let negative = OneSided {
        zeta: -0.1,
        ..CONTACT
    };
    let error = refused(FrequencyResponse::of(&negative).from(0.6).to(1.6));
    assert_eq!(
        error.to_string(),
        "parameter zeta = -0.1 is outside its range [0, inf)"
    );
    let nan = OneSided {
        load: f64::NAN,
        ..CONTACT
    };
    assert!(matches!(
        refused(FrequencyResponse::of(&nan).from(0.6).to(1.6)),
        Error::Parameter { .. }
    ));
    let fast = Fractional {};
    assert!(matches!(
        refused(FrequencyResponse::of(&fast).from(0.6).to(1.6).harmonics(1)),
        Error::Harmonics {
            harmonics: 1,
            highest: 2
        }
    ));
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
    let (x0, v0) = orbit.state(0, 0.0);
    let (x1, v1) = orbit.state(0, PI / 0.5);
    assert!((x0 + x1).abs() < 1e-15 && (v0 + v1).abs() < 1e-15);
}

/// Near a fold there are three orbits on one side and one on the other; all are found, and none twice.
#[test]
fn every_solution_is_returned_beside_a_fold() {
    let model = Continuous {
        zeta: 0.01,
        alpha: 1.5,
        load: 0.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.6)
        .to(1.7)
        .harmonics(10)
        .samples(512)
        .run()
        .unwrap();
    let folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    let (upper, lower) = (folds[0].max(folds[1]), folds[0].min(folds[1]));
    for distance in [1e-3, 1e-4, 3e-5, 1e-5, 1e-6] {
        for (value, count) in [
            (upper - distance, 3),
            (upper + distance, 1),
            (lower + distance, 3),
            (lower - distance, 1),
        ] {
            let found = branch.at(value).unwrap();
            let sizes: Vec<f64> = found.iter().map(hertzian::Point::peak_to_peak).collect();
            assert_eq!(found.len(), count, "{value}: {sizes:?}");
            assert!(found.iter().all(|point| point.value == value));
            assert!(
                sizes
                    .windows(2)
                    .all(|pair| (pair[0] - pair[1]).abs() > 1e-6),
                "{sizes:?}"
            );
        }
    }
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

hertzian::oscillator! {
    /// A pair of linear oscillators, with a stiffness that pulses at a multiple of the excitation.
    Pair(x, y) {
        param mass;
        param pulse;
        mass*ddot(x) + 0.1*dot(x) + (1 + pulse*cos(7*omega*t))*x + 0.2*(x - y) = cos(omega*t);
        ddot(y) + 0.1*dot(y) + y + 0.2*(y - x) = 0;
    }
}

#[test]
fn what_cannot_be_represented_is_refused() {
    let refused = |request: FrequencyResponse<'_>| request.run().unwrap_err();
    let model = Pair {
        mass: 1.0,
        pulse: 0.1,
    };
    let good = || FrequencyResponse::of(&model).from(0.6).to(1.6);
    assert!(matches!(
        refused(good().harmonics(5)),
        Error::Harmonics {
            harmonics: 5,
            highest: 7
        }
    ));
    assert!(matches!(
        refused(good().omega(1.0)),
        Error::Option { name: "omega", .. }
    ));
    assert!(matches!(
        refused(good().samples(10_000_000).period(30)),
        Error::Option {
            name: "samples",
            ..
        }
    ));
    let singular = Pair {
        mass: 0.0,
        pulse: 0.1,
    };
    assert_eq!(
        refused(FrequencyResponse::of(&singular).from(0.6).to(1.6)),
        Error::SingularMass { determinant: 0.0 }
    );
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

/// All three methods agree where contact is not lost.
#[test]
fn methods_agree_on_a_smooth_orbit() {
    let at = |aft| {
        let request = FrequencyResponse::of(&CONTACT)
            .from(1.5)
            .to(1.6)
            .harmonics(8);
        let branch = request.aft(aft).stability(false).run().unwrap();
        branch.points[0].peak_to_peak()
    };
    let switched = at(Aft::Switched);
    for aft in [Aft::Sampled, Aft::Primitive] {
        assert!((at(aft) / switched - 1.0).abs() < 1e-10, "{aft}");
    }
}

/// An odd system with one harmonic is not perfect: its next harmonic is the third.
#[test]
fn one_harmonic_of_an_odd_system_states_its_error() {
    let model = Duffing {
        zeta: 0.05,
        drive: 1.0,
    };
    let request = FrequencyResponse::of(&model).from(0.5).to(0.6);
    let one = request.clone().harmonics(1).run().unwrap().points[0].clone();
    let many = request.harmonics(21).run().unwrap().points[0].clone();
    let off = (one.peak_to_peak() / many.peak_to_peak() - 1.0).abs();
    let stated = one.error.unwrap();
    assert!(off > 0.05 && stated > off / 3.0, "{off} {stated}");
}
