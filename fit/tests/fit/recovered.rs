//! Parameters of data without noise.

use hertzian_fit::{Fit, Fitted};

use crate::common::{Backlash, OneSided, TwoMasses, sets};

fn assert_near(fitted: &Fitted, expected: &[(&str, f64)], tolerance: f64) {
    for &(name, value) in expected {
        let found = fitted.estimate(name).expect(name).value;
        assert!(
            (found - value).abs() < tolerance * value.abs(),
            "{name}: {found} instead of {value}"
        );
    }
}

fn fit(of: &dyn hertzian::System, data: &str) -> Fit {
    sets(data).into_iter().fold(Fit::of(of), Fit::data)
}

fn run(fit: Fit) -> Fitted {
    let t = std::time::Instant::now();
    let fitted = fit
        .run_with(|p| {
            println!("{p:?} {:?}", t.elapsed());
            std::ops::ControlFlow::Continue(())
        })
        .expect("a fit");
    println!(
        "{:?} {:?} {:?} {} {}",
        fitted.estimates, fitted.rejected, fitted.singular_values, fitted.scatter, fitted.converged
    );
    println!("{:?}", fitted.starts);
    for s in &fitted.sets {
        for v in &s.values {
            println!(
                "{:.6} {:.6} {:?} {:e}",
                v.place, v.value, v.foot, v.residual
            );
        }
    }
    fitted
}

#[test]
fn one_sided_hertz() {
    let start = OneSided {
        alpha: 1.3,
        zeta: 0.05,
        load: 0.8,
        drive: 0.1,
    };
    let fit = fit(&start, include_str!("measured/one-sided.csv"))
        .free("alpha")
        .free("zeta")
        .free("load");
    assert_near(
        &run(fit),
        &[("alpha", 1.5), ("zeta", 0.032), ("load", 1.0)],
        1e-6,
    );
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
    assert_near(
        &run(fit),
        &[("zeta", 0.05), ("stiffness", 1.3), ("play", 0.3)],
        1e-6,
    );
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
    assert_near(&run(fit), &[("stop", 3.0), ("distance", 0.5)], 1e-6);
}

#[test]
fn levels() {
    let start = OneSided {
        alpha: 1.7,
        zeta: 0.04,
        load: 1.1,
        drive: 0.1,
    };
    let fit = fit(&start, include_str!("measured/levels.csv"))
        .free("alpha")
        .free("zeta")
        .free("load");
    assert_near(
        &run(fit),
        &[("alpha", 1.5), ("zeta", 0.032), ("load", 1.0)],
        1e-6,
    );
}
