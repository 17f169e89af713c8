//! What a fit says of itself: where derivatives, degrees of freedom or deviations are wanting, and beside other fits.

use std::f64::consts::TAU;

use hertzian_fit::{Comparison, DataSet, Fit, Fitted, Jump, Loss, Sweep};

use crate::common::normal;
use crate::linear::{Linear, TRUTH, omegas, response, value};

const MODEL: Linear = Linear {
    m: 1.1,
    c: 0.1,
    k: 4.0,
    f: 0.9,
};

/// Peak-to-peak values with normal noise of a part of each.
fn with_noise(omegas: &[f64], part: f64, seed: u64) -> Vec<f64> {
    let mut normal = normal(seed);
    let values = omegas.iter().map(|&omega| {
        let value = 2.0 * response(TRUTH, omega)[0];
        value * (1.0 + part * normal())
    });
    values.collect()
}

hertzian::oscillator! {
    /// A stop whose force jumps where it is touched: below, the motion is that of a linear oscillator.
    Preloaded(x) {
        param zeta in 0.0..;
        param play > 0;
        param drive;
        law stop(gap) { gap > play => 0.3 + 4*(gap - play), else => 0 }
        ddot(x) + 2*zeta*dot(x) + x + stop(x) = drive*cos(omega*t);
    }
}

/// A sweep that falls leaves the linear motion where that reaches the stop: `(drive / play)^2 = (1 - w^2)^2 + (2 zeta w)^2`. What was measured before says what
/// the damping is, and the place of the jump alone what the play is.
#[test]
fn a_jump_where_a_stop_is_touched_is_fitted() {
    let (zeta, drive) = (0.05_f64, 0.3_f64);
    let size = |omega: f64| drive / (1.0 - omega * omega).hypot(2.0 * zeta * omega);
    let half = 1.0 - 2.0 * zeta * zeta;
    let jump = (half + (half * half - 1.0 + drive * drive).sqrt()).sqrt();
    let omegas: Vec<f64> = (0..12).map(|i| 1.14 + 0.015 * f64::from(i)).collect();
    let values: Vec<f64> = omegas.iter().map(|&omega| 2.0 * size(omega)).collect();
    let set = DataSet::new("x:p2p", omegas, values).deviation(1e-3);
    let set = set.sweep(Sweep::Falling).jump(Jump::at(jump, 0.002));
    let start = Preloaded {
        zeta: 0.06,
        play: 0.97,
        drive,
    };
    let fitted = Fit::of(&start).data(set).free("zeta").free("play");
    let fitted = fitted.run().expect("a fit");
    assert!(fitted.converged && fitted.untold.is_empty(), "{fitted}");
    assert!((value(&fitted, "zeta") - zeta).abs() < 1e-5, "{fitted}");
    assert!((value(&fitted, "play") - 1.0).abs() < 1e-5, "{fitted}");
    // The closed form says how the place moves with the play: so far does its deviation move the estimate, the damping known as well as it is.
    let by_play = (2.0 * drive * drive)
        / (2.0 * jump * (2.0 * (1.0 - jump * jump) - 4.0 * zeta * zeta)).abs();
    let error = fitted.estimate("play").unwrap().error.expect("an error");
    assert!((error * by_play / 0.002 - 1.0).abs() < 0.2, "{fitted}");
}

/// `impulse = 2 pi load / omega`, since the mean force is the load.
#[test]
fn impulses_are_fitted_and_numbers_of_impacts_refused() {
    hertzian::oscillator! {
        Loaded(x) {
            param load;
            law contact(gap) { gap > 0 => 0.1*dot(gap) + gap, else => 0 }
            ddot(x) + contact(x) = 1.3*cos(omega*t) + load;
        }
    }
    let omegas = [1.4, 1.45, 1.5, 1.55];
    let values = omegas.map(|omega| TAU * 1.2 / omega);
    let fit = |wanted: &str| {
        let fit = Fit::of(&Loaded { load: 1.0 }).free("load");
        fit.data(DataSet::new(wanted, omegas, values)).run()
    };
    let fitted = fit("contact:impulse").expect("a fit");
    assert!((value(&fitted, "load") - 1.2).abs() < 1e-7, "{fitted}");
    assert!(fitted.untold.is_empty(), "{fitted}");
    let error = fit("contact:impacts").expect_err("a refusal").to_string();
    assert!(error.contains("a number of impacts is whole"), "{error}");
}

/// Two values and two parameters: the curve passes both, and nothing is left to tell how far values scatter. With deviations errors follow from these.
#[test]
fn as_many_parameters_as_values_have_no_errors_without_deviations() {
    let omegas = [1.7, 2.3];
    let values = with_noise(&omegas, 0.0, 1);
    let set = DataSet::new("x:p2p", omegas, values);
    let fit = |set: DataSet| Fit::of(&MODEL).data(set).free("k").free("f").run();
    let fitted = fit(set.clone()).expect("a fit");
    for name in ["k", "f"] {
        let estimate = fitted.estimate(name).expect(name);
        assert_eq!(
            (estimate.error, estimate.interval),
            (None, None),
            "{fitted}"
        );
        assert!(!estimate.undetermined);
    }
    let said = fitted.to_string();
    assert!(said.contains("without a standard error"), "{said}");
    assert!(said.contains("as many parameters as values"), "{said}");
    let known = fit(set.deviation(0.01)).expect("a fit");
    let error = known.estimate("k").expect("k").error;
    assert!(error.is_some_and(|error| error > 1e-4), "{known}");
}

/// A parameter at the end of its range costs as much as any other: where it is of no use the larger fit is worse by two.
#[test]
fn a_parameter_at_its_limit_counts_for_the_criterion() {
    let set = DataSet::new("x:p2p", omegas(), with_noise(&omegas(), 0.01, 3));
    let fit = Fit::of(&MODEL).data(set).free("k");
    let larger = fit.clone().free_in("c", [0.16, 0.5]).run().expect("a fit");
    assert!(larger.estimate("c").expect("c").at_limit, "{larger}");
    let smaller = larger.without("c", 0.16).expect("a fit");
    let all = Comparison::of(&[("larger", &larger), ("smaller", &smaller)]);
    assert!((all.fits[0].criterion - 2.0).abs() < 1e-3, "{all}");
    assert_eq!(all.fits[1].criterion, 0.0, "{all}");
}

/// One set is known to two per cent, and that is stated; the other is good to 1e-5, and nothing is stated of it. It counts as it scatters: the fit is that
/// in which this is stated too.
#[test]
fn a_set_without_deviations_counts_as_it_scatters_beside_one_that_has_them() {
    let good = with_noise(&omegas(), 1e-5, 5);
    let poor = with_noise(&omegas(), 0.02, 6);
    let deviations: Vec<f64> = omegas()
        .iter()
        .map(|&w| 0.02 * response(TRUTH, w)[0])
        .collect();
    let halves: Vec<f64> = poor.iter().map(|value| 0.5 * value).collect();
    let poor = DataSet::new("x:h1", omegas(), halves).deviations(deviations);
    let good = DataSet::new("x:p2p", omegas(), good);
    let fit = |good: DataSet| {
        let fit = Fit::of(&MODEL).free("c").free("k").data(poor.clone());
        fit.data(good).run().expect("a fit")
    };
    let found = fit(good.clone());
    let deviation = found.sets[1].values[0].deviation;
    // A mean over values of noise that is a part of each, the largest of which count.
    assert!((3e-6..1e-4).contains(&deviation), "{found}");
    // The usual deviation of places becomes smaller with that of values, which is a hundredth of the largest at first.
    let largest = found.sets[1]
        .values
        .iter()
        .fold(0.0, |m: f64, own| m.max(own.value));
    let places = 0.001 * deviation / (0.01 * largest);
    let stated = fit(good.deviation(deviation).place_deviation(places));
    for name in ["c", "k"] {
        let [a, b] = [&found, &stated].map(|fit| fit.estimate(name).expect(name));
        let [error, other] = [a, b].map(|own| own.error.expect("an error"));
        assert!((a.value - b.value).abs() < 0.1 * error, "{found}{stated}");
        assert!((error / other - 1.0).abs() < 0.1, "{found}{stated}");
    }
    let k = found.estimate("k").expect("k");
    let error = k.error.expect("an error");
    assert!(
        (k.value - 4.4).abs() < 4.0 * error && error < 1e-4,
        "{found}"
    );
    assert!(found.to_string().contains("weighed    x:p2p"), "{found}");
}

/// Six of forty values are wrong by two fifths: the robust scatter does not follow them, and each is an outlier beside it. The others are none.
#[test]
fn outliers_do_not_hide_each_other_from_a_robust_loss() {
    let omegas: Vec<f64> = (0..40).map(|i| 1.2 + 0.04 * f64::from(i)).collect();
    let wrong = [4, 11, 17, 22, 30, 36];
    let mut values = with_noise(&omegas, 0.005, 9);
    for index in wrong {
        values[index] *= 1.4;
    }
    let set = DataSet::new("x:p2p", omegas, values);
    let fit = Fit::of(&MODEL).data(set).free("c").free("k");
    let fitted = fit.loss(Loss::Huber(1.5)).run().expect("a fit");
    let values = &fitted.sets[0].values;
    let found: Vec<usize> = values
        .iter()
        .filter(|v| v.is_outlier)
        .map(|v| v.row)
        .collect();
    assert_eq!(found, wrong, "{fitted}");
}

/// From estimates of which each data set has its own a fit goes on with those, and what is not free cannot be left out.
#[test]
fn what_is_left_out_begins_at_all_estimates() {
    let levels = [0.3, 0.9];
    let sets = levels.map(|level| {
        let values = omegas()
            .into_iter()
            .map(|omega| 2.0 * response([1.1, 0.15, 4.4, level], omega)[0]);
        let values: Vec<f64> = values.collect();
        DataSet::new("x:p2p", omegas(), values).named(format!("level {level}"))
    });
    let fit = Fit::of(&MODEL).free("c").free("k").own_in("f", [0.1, 5.0]);
    let fitted = sets.into_iter().fold(fit, Fit::data).run().expect("a fit");
    let less = fitted.without("c", 0.15).expect("a fit");
    let sum = |fitted: &Fitted| fitted.chi_square;
    assert!(sum(&less) < 1e-6 && less.starts.len() == 1, "{less}");
    for (level, place) in levels.iter().zip(&less.starts[0].values[1..]) {
        assert!((place / level - 1.0).abs() < 1e-3, "{:?}", less.starts);
    }
    let error = fitted.without("m", 1.0).expect_err("a refusal").to_string();
    assert_eq!(
        error,
        "free parameter m: it is not free, so that nothing is left out: there are c, k, f"
    );
}
