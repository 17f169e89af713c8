//! Hill's method: exponents sorted by their imaginary part or by their eigenvectors, and coefficients from samples.

use hertzian::stability::Method;
use hertzian::{Aft, FrequencyResponse, Verdict};

use super::models::{answer, distance, first, linear};
use super::oracle::{EXACT, Switches, pair, paper};

/// Two real negative multipliers, near the period doubling at A = 1.282584: the exponents of both have copies with imaginary parts
/// plus and minus a half, and the two copies of one may come first. More harmonics do not help.
#[test]
fn one_of_two_negative_multipliers_is_taken_twice() {
    let (model, oracle) = (linear(1.28), paper(1.28));
    let state = oracle.orbit([-2.508_552_764_3, 0.158_458_581_9], 1, 4000);
    let exact = oracle.multipliers(state, 1, 4000, Switches::Exact);
    assert!(exact.iter().all(|m| m.im == 0.0 && m.re < -0.8));
    println!("harmonics, by imaginary part, by weighted mean, by symmetry, default, its estimate");
    for harmonics in [5, 10, 20, 40] {
        let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
        let branch = first(&request.from(1.28).to(1.3).harmonics(harmonics));
        let [by_imaginary_part, by_weighted_mean, by_symmetry, default] = [
            Method::HillImaginaryPart,
            Method::HillWeightedMean,
            Method::Hill,
            Method::Default,
        ]
        .map(|method| answer(&branch, method));
        let error = |multipliers: &[_]| distance(multipliers, &exact);
        println!(
            "{harmonics}, {:.2}, {:.2}, {:.1e}, {:.1e}, {:.1e} {}",
            error(&by_imaginary_part.uncorrected),
            error(&by_weighted_mean.uncorrected),
            error(&by_symmetry.uncorrected),
            error(&default.stability.multipliers),
            default.stability.error,
            default.stability.verdict
        );
        for wrong in [&by_imaginary_part, &by_weighted_mean] {
            let [a, b] = wrong.uncorrected[..] else {
                panic!("{wrong:?}");
            };
            assert!((a - b).norm() < 0.02, "{a} {b}");
            assert!((0.12..0.19).contains(&error(&wrong.uncorrected)));
            // The product of the multipliers is known and tells.
            assert!(wrong.stability.error > 0.12);
        }
        assert!(error(&default.stability.multipliers) < default.stability.error);
        assert_ne!(default.stability.verdict, Verdict::Unstable);
        if harmonics >= 10 {
            assert_eq!(default.stability.verdict, Verdict::Stable);
        }
    }
}

/// Coefficients from samples of a force that jumps: what a sample near the switch is worth does not depend on the harmonics.
#[test]
fn samples_of_a_heaviside_function_leave_a_floor() {
    let model = linear(1.0);
    let exact = pair(EXACT[0].1);
    let error = |harmonics, aft, method| {
        let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
        let request = request.from(1.0).to(1.01).harmonics(harmonics);
        let branch = first(&request.aft(aft).samples(4096));
        let answer = answer(&branch, method);
        let corrected = distance(&answer.stability.multipliers, &exact);
        (distance(&answer.uncorrected, &exact), corrected, answer)
    };
    let hill = Method::Hill;
    println!(
        "harmonics, from 4096 samples, its estimate, from exact switching, default, its estimate"
    );
    for harmonics in [20, 40, 80] {
        let (sampled, _, of_samples) = error(harmonics, Aft::Sampled, hill);
        let (switched, ..) = error(harmonics, Aft::Switched, hill);
        let (_, default, answer) = error(harmonics, Aft::Switched, Method::Default);
        println!(
            "{harmonics}, {sampled:.1e}, {:.1e}, {switched:.1e}, {default:.1e}, {:.1e}",
            of_samples.stability.error, answer.stability.error
        );
        assert!((1e-4..1e-3).contains(&sampled), "{sampled:e}");
        assert!(switched < 1e-5 && default < answer.stability.error);
        assert!(default < 1e-5, "{default:e}");
    }
}
