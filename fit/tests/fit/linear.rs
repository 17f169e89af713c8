//! What a fit says, of a linear oscillator whose response is known in closed form.

use std::ops::ControlFlow;

use hertzian_fit::{Comparison, DataSet, Fit, Fitted, Loss, Sweep};

use crate::common::normal;

hertzian::oscillator! {
    /// `m x'' + c x' + k x = f cos omega t`.
    pub Linear(x) {
        param m = 1 > 0;
        param c = 0.1 in 0.0..;
        param k = 4 > 0;
        param f = 1;
        ddot(x)*m + c*dot(x) + k*x = f*cos(omega*t);
    }
}

pub fn omegas() -> Vec<f64> {
    (0..16).map(|i| 1.2 + 0.1 * f64::from(i)).collect()
}

/// Amplitude and phase lag.
pub fn response([m, c, k, f]: [f64; 4], omega: f64) -> [f64; 2] {
    let (real, imaginary) = (k - m * omega * omega, c * omega);
    [f / real.hypot(imaginary), imaginary.atan2(real)]
}

fn amplitudes(truth: [f64; 4]) -> DataSet {
    let values: Vec<f64> = omegas()
        .iter()
        .map(|&omega| 2.0 * response(truth, omega)[0])
        .collect();
    DataSet::new("x:p2p", omegas(), values)
}

pub fn value(fitted: &Fitted, name: &str) -> f64 {
    fitted.estimate(name).expect(name).value
}

pub const TRUTH: [f64; 4] = [1.1, 0.15, 4.4, 0.9];

#[test]
fn what_cannot_be_told_apart_is_said() {
    let fit = Fit::of(&Linear::default()).data(amplitudes(TRUTH));
    let fit = fit.free("m").free("c").free("k").free("f");
    let fitted = fit.run().expect("a fit");
    // All four by one factor change nothing.
    assert_eq!(fitted.untold.len(), 1, "{:?}", fitted.untold);
    for name in ["m", "c", "k", "f"] {
        assert!(fitted.untold[0].contains(name), "{}", fitted.untold[0]);
        assert_eq!(fitted.estimate(name).expect(name).error, None);
    }
    assert!(
        fitted.untold[0].starts_with("the data do not tell "),
        "{}",
        fitted.untold[0]
    );
    assert!(
        fitted
            .to_string()
            .contains("which the data do not determine")
    );
    let ratio = value(&fitted, "k") / value(&fitted, "m");
    assert!((ratio - 4.0).abs() < 1e-6, "{ratio}");
    // With one of them known the others are.
    let known = fit.fixed("m").run().expect("a fit");
    assert_eq!(known.untold, Vec::<String>::new());
    assert!((value(&known, "k") - 4.0).abs() < 1e-6);
    assert!((value(&known, "f") - 0.9 / 1.1).abs() < 1e-6);
}

#[test]
fn amplitudes_and_phases_of_several_levels_are_fitted_together() {
    let levels = [0.5, 2.0];
    let mut fit = Fit::of(&Linear {
        m: 1.0,
        c: 0.1,
        k: 4.0,
        f: 1.0,
    })
    .free("c")
    .free("k");
    for (number, level) in levels.into_iter().enumerate() {
        let truth = [1.0, 0.15, 4.4, level];
        let phases: Vec<f64> = omegas()
            .iter()
            .map(|&omega| response(truth, omega)[1])
            .collect();
        fit = fit
            .data(amplitudes(truth).named(format!("amplitude {number}")))
            // An angle may be given with any number of turns.
            .data(
                DataSet::new(
                    "x:phase1",
                    omegas(),
                    phases
                        .iter()
                        .map(|phase| phase - std::f64::consts::TAU)
                        .collect::<Vec<_>>(),
                )
                .named(format!("phase {number}")),
            );
    }
    let fitted = fit.own_in("f", [0.1, 5.0]).run().expect("a fit");
    assert!((value(&fitted, "c") - 0.15).abs() < 1e-6, "{fitted}");
    assert!((value(&fitted, "k") - 4.4).abs() < 1e-6, "{fitted}");
    for (number, level) in levels.iter().enumerate() {
        assert!(
            (value(&fitted, &format!("f of amplitude {number}")) / level - 1.0).abs() < 1e-6,
            "{fitted}"
        );
    }
    // A phase says nothing of the level.
    assert!(
        fitted
            .untold
            .contains(&"the data say nothing of f of phase 0".to_owned()),
        "{fitted}"
    );
    assert_eq!(
        fitted.estimate("f of phase 0").expect("an estimate").error,
        None
    );
}

/// Data with noise of a hundredth, one value of which is wrong by a half.
fn with_outlier() -> DataSet {
    let mut normal = normal(7);
    let values: Vec<f64> = omegas()
        .iter()
        .enumerate()
        .map(|(index, &omega)| {
            let value = 2.0 * response(TRUTH, omega)[0] * (1.0 + 0.01 * normal());
            if index == 3 { 1.5 * value } else { value }
        })
        .collect();
    let deviations: Vec<f64> = omegas()
        .iter()
        .map(|&omega| 0.02 * response(TRUTH, omega)[0])
        .collect();
    DataSet::new("x:p2p", omegas(), values).deviations(deviations)
}

#[test]
fn an_outlier_is_named_and_a_robust_loss_does_not_follow_it() {
    let model = Linear {
        m: 1.1,
        c: 0.1,
        k: 4.0,
        f: 0.9,
    };
    let fit = Fit::of(&model).data(with_outlier()).free("c").free("k");
    let squares = fit.run().expect("a fit");
    let outliers: Vec<usize> = squares.sets[0]
        .values
        .iter()
        .filter(|value| value.is_outlier)
        .map(|value| value.row)
        .collect();
    assert!(outliers.contains(&3), "{squares}");
    assert!(
        squares
            .probability
            .is_some_and(|probability| probability < 1e-6)
    );
    let robust = fit.loss(Loss::Huber(1.5)).run().expect("a fit");
    let apart = |fitted: &Fitted| (value(fitted, "k") - 4.4).abs();
    assert!(
        apart(&robust) < 0.01 && apart(&robust) < 0.2 * apart(&squares),
        "{robust}{squares}"
    );
    let estimate = robust.estimate("k").expect("k");
    let [low, high] = estimate.interval.expect("an interval");
    assert!((low..=high).contains(&4.4), "{robust}");
}

#[test]
fn a_parameter_ends_at_its_range_and_a_comparison_says_what_it_is_worth() {
    let model = Linear {
        m: 1.1,
        c: 0.1,
        k: 4.0,
        f: 0.9,
    };
    let fit = Fit::of(&model)
        .data(amplitudes(TRUTH).deviation(0.1))
        .free_in("c", [0.16, 0.5])
        .free("k");
    let fitted = fit.run().expect("a fit");
    let c = fitted.estimate("c").expect("c");
    assert!(
        c.at_limit && c.error.is_none() && (c.value - 0.16).abs() < 1e-9,
        "{fitted}"
    );
    assert!(fitted.estimate("k").expect("k").error.is_some());
    // Without a wrong value of `c` the sum of squares is nothing.
    let free = Fit::of(&model)
        .data(amplitudes(TRUTH).deviation(0.1))
        .free("c")
        .free("k")
        .run()
        .expect("a fit");
    let held = free.without("c", 0.16).expect("a fit");
    let comparison = Comparison::of(&[("free", &free), ("c = 0.16", &held)]);
    assert_eq!(comparison.fits[1].parameters, 1);
    assert!((comparison.fits[1].chi_square - fitted.chi_square).abs() < 1e-3 * fitted.chi_square);
    assert_eq!(comparison.fits[0].criterion, 0.0);
    assert!(
        comparison.fits[1]
            .probability
            .is_some_and(|probability| probability < 0.05),
        "{comparison}"
    );
}

#[test]
fn what_is_broken_off_keeps_the_best() {
    let fit = Fit::of(&Linear::default())
        .data(amplitudes(TRUTH))
        .free("c")
        .free("k");
    let mut count = 0;
    let fitted = fit.run_with(|_| {
        count += 1;
        if count < 3 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    let fitted = fitted.expect("the best until then");
    assert!(!fitted.converged && fitted.trials < 6, "{fitted}");
    assert!(fitted.to_string().contains("unfinished"));
    // Cancelled before anything is found.
    let cancel = hertzian::Cancel::new();
    cancel.cancel();
    let error = fit.cancel(&cancel).run().expect_err("nothing");
    assert_eq!(error.to_string(), "cancelled before anything was found");
}

#[test]
fn what_cannot_be_fitted_is_refused_in_a_sentence() {
    let fit = || Fit::of(&Linear::default()).data(amplitudes(TRUTH));
    let refused = |fit: Fit| fit.run().expect_err("a refusal").to_string();
    let cases: [(Fit, &str); 12] = [
        (fit(), "no parameter is free: name at least one"),
        (Fit::of(&Linear::default()).free("k"), "there are no data"),
        (
            fit().free("q"),
            "free parameter q: the model has none of that name: there are m, c, k, f",
        ),
        (
            fit().free_in("k", [2.0, 1.0]),
            "free parameter k: the range from 2 to 1 is empty",
        ),
        (
            fit().free_in("k", [-2.0, -1.0]),
            "free parameter k: -1.5, in the middle of its range, is not admitted by its declaration",
        ),
        (
            fit().free("k").data(amplitudes(TRUTH)),
            "data set x:p2p: another set has this name: give each its own",
        ),
        (
            Fit::of(&Linear::default())
                .data(DataSet::new("y:p2p", [1.0], [1.0]))
                .free("k"),
            "data set y:p2p: no output, coordinate or contact is called y: there are x",
        ),
        (
            Fit::of(&Linear::default())
                .data(DataSet::new("x:p2p", [1.0, 2.0], [1.0]))
                .free("k"),
            "data set x:p2p: 2 places and 1 values",
        ),
        (
            Fit::of(&Linear::default())
                .data(DataSet::new("x:p2p", [-1.0], [1.0]))
                .free("k"),
            "data set x:p2p: a frequency is -1: it must be positive",
        ),
        (
            Fit::of(&Linear::default())
                .data(DataSet::new("x:p2p", [1.0], [1.0]))
                .free("k")
                .free("c"),
            "2 parameters are free, and there are only 1 measured values",
        ),
        (
            fit()
                .free("k")
                .data(amplitudes(TRUTH).named("other").at("k", 3.0)),
            "free parameter k: data set other says what it is: leave that out, or do not free it",
        ),
        (
            Fit::of(&Linear::default())
                .data(
                    amplitudes(TRUTH)
                        .sweep(Sweep::Settled)
                        .jump(hertzian_fit::Jump::at(2.0, 0.1)),
                )
                .free("k"),
            "data set x:p2p: it has a jump: say whether the sweep rose or fell",
        ),
    ];
    for (fit, said) in cases {
        assert_eq!(refused(fit), said);
    }
}

/// Of a curve with two peaks a linear oscillator has one.
#[test]
fn a_model_that_does_not_describe_the_data_is_said() {
    let sizes: Vec<f64> = (0..16)
        .map(|i| if i % 8 == 3 { 5.0 } else { 1.0 })
        .collect();
    let fit = Fit::of(&Linear::default()).data(DataSet::new("x:p2p", omegas(), sizes));
    let fitted = fit.free("c").free("k").starts(2).run().expect("a fit");
    assert!(fitted.scatter > 5.0, "{fitted}");
    let said = fitted.to_string();
    assert!(
        said.contains("\npoor       the curve does not pass the data"),
        "{said}"
    );
}
