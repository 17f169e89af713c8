//! Parameters of data without noise.

use std::time::Instant;

use hertzian_fit::Fit;

use crate::common::{Backlash, OneSided, TwoMasses, sets};

fn fit(of: &dyn hertzian::System, data: &str) -> Fit {
    sets(data).into_iter().fold(Fit::of(of), Fit::data)
}

/// Recovers parameters, with the search done by itself.
fn assert_recovered(fit: &Fit, expected: &[(&str, f64)]) {
    let fitted = fit.run().expect("a fit");
    assert!(fitted.converged && fitted.untold.is_empty(), "{fitted}");
    for &(name, value) in expected {
        let found = fitted.estimate(name).expect(name).value;
        assert!(
            (found - value).abs() < 1e-6 * value.abs(),
            "{name}: {found} instead of {value}"
        );
    }
}

#[test]
fn one_sided_hertz() {
    let start = OneSided {
        alpha: 1.3,
        zeta: 0.05,
        load: 0.8,
        drive: 0.1,
        stiffness: 1.0,
    };
    let fit = fit(&start, include_str!("measured/one-sided.csv"))
        .free("alpha")
        .free("zeta")
        .free("load");
    assert_recovered(&fit, &[("alpha", 1.5), ("zeta", 0.032), ("load", 1.0)]);
}

#[test]
fn backlash() {
    let start = Backlash {
        zeta: 0.08,
        stiffness: 1.0,
        play: 0.4,
        load: 0.3,
        drive: 0.15,
    };
    let fit = fit(&start, include_str!("measured/backlash.csv"))
        .free("zeta")
        .free("stiffness")
        .free("play");
    assert_recovered(&fit, &[("zeta", 0.05), ("stiffness", 1.3), ("play", 0.3)]);
}

#[test]
fn two_masses() {
    let start = TwoMasses {
        stop: 2.0,
        distance: 0.4,
        coupling: 0.6,
        zeta: 0.015,
        drive: 0.12,
    };
    let fit = fit(&start, include_str!("measured/two-masses.csv"))
        .free("stop")
        .free("distance");
    assert_recovered(&fit, &[("stop", 3.0), ("distance", 0.5)]);
}

/// Three levels of the drive with 60 values each, four free parameters, in five seconds of one core: where the environment asks for it, since other
/// work takes its time.
#[test]
fn three_levels_in_five_seconds() {
    if std::env::var_os("HERTZIAN_SECONDS").is_none() {
        return;
    }
    let start = OneSided {
        alpha: 1.4,
        zeta: 0.04,
        load: 1.1,
        drive: 0.1,
        stiffness: 1.1,
    };
    let fit = fit(&start, include_str!("measured/levels.csv"));
    let fit = fit
        .free("alpha")
        .free("zeta")
        .free("load")
        .free("stiffness");
    let begin = Instant::now();
    assert_recovered(
        &fit,
        &[
            ("alpha", 1.5),
            ("zeta", 0.032),
            ("load", 1.0),
            ("stiffness", 1.0),
        ],
    );
    let took = begin.elapsed();
    println!("{took:?}");
    assert!(took.as_secs_f64() < 5.0, "{took:?}");
}
