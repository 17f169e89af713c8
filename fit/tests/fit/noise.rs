//! Estimates from data with noise: how far they scatter, and how far their intervals say so.

use hertzian_fit::{Fit, Fitted, Jump};

use crate::common::{OneSided, noisy, normal};

/// Standard deviation of where a sweep jumps.
const JUMP: f64 = 0.002;

const TRUTH: [(&str, f64); 3] = [("alpha", 1.5), ("zeta", 0.032), ("load", 1.0)];

/// How many repetitions: a few, or as many as the environment says.
fn repetitions() -> usize {
    let asked = std::env::var("HERTZIAN_REPETITIONS").ok();
    asked.and_then(|count| count.parse().ok()).unwrap_or(2)
}

fn fitted(number: usize) -> Fitted {
    let start = OneSided {
        alpha: 1.45,
        zeta: 0.035,
        load: 0.97,
        drive: 0.1,
        stiffness: 1.0,
    };
    let sets = noisy(include_str!("measured/one-sided.csv"), 0.01, number as u64);
    // Where the sweeps jump, by an independent computation: folds of table 5b in the README.
    let mut normal = normal(number as u64 + 1_000_000);
    let mut jump = |fold: f64| Jump::at(fold + JUMP * normal(), JUMP);
    let folds = [1.144_516_913_8, 0.685_842_254];
    let sets = sets
        .into_iter()
        .zip(folds)
        .map(|(set, fold)| set.jump(jump(fold)));
    let fit = sets.fold(Fit::of(&start), Fit::data);
    let fit = fit.free("alpha").free("zeta").free("load");
    fit.run().expect("a fit")
}

/// Noise of one per cent of each value: estimates are not biased by more than three of their standard errors, intervals of 95 % hold the truth in
/// 90 to 98 % of all repetitions, and sums of squares are as large as they should be.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let count = repetitions();
    let mut inside = [0_usize; 3];
    let mut sums = [[0.0; 2]; 3];
    let mut squares = 0.0;
    for number in 0..count {
        let fitted = fitted(number);
        assert!(fitted.converged, "{number}");
        squares += fitted.chi_square / fitted.degrees as f64;
        for (index, (name, truth)) in TRUTH.iter().enumerate() {
            let estimate = fitted.estimate(name).expect(name);
            let (error, [low, high]) = (
                estimate.error.expect("an error"),
                estimate.interval.expect("an interval"),
            );
            let apart = (estimate.value - truth) / error;
            assert!(
                apart.abs() < 5.0,
                "repetition {number}, {name}: {apart} standard errors"
            );
            inside[index] += usize::from((low..=high).contains(truth));
            sums[index][0] += apart;
            sums[index][1] += apart * apart;
        }
        println!(
            "{number}: {:.3} {:?} {}",
            fitted.chi_square / fitted.degrees as f64,
            fitted.estimates.iter().map(|e| e.value).collect::<Vec<_>>(),
            fitted.trials
        );
    }
    let n = count as f64;
    for (index, (name, _)) in TRUTH.iter().enumerate() {
        let [sum, square] = sums[index];
        let (mean, part) = (sum / n, inside[index] as f64 / n);
        println!(
            "{name}: mean {mean:.3}, spread {:.3} standard errors, inside {part:.3}",
            (square / n - mean * mean).sqrt()
        );
        assert!(
            mean.abs() < 3.0 / n.sqrt(),
            "{name} is biased by {mean} standard errors"
        );
        if count >= 100 {
            assert!(
                (0.90..=0.98).contains(&part),
                "{name}: the truth is inside in {part}"
            );
        }
    }
    println!("chi-square per degree {:.3}", squares / n);
    // Its standard deviation is the root of 2 / 57.
    assert!(
        (squares / n - 1.0).abs() < 4.0 * (2.0 / 59.0 / n).sqrt(),
        "{squares}"
    );
}
