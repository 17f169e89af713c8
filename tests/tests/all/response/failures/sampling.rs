//! Samples: folds of a force that jumps, and a stiffness that has no bound.

use hertzian::stability::Method;
use hertzian::{Aft, FrequencyResponse, Shooting, Stop};

use super::models::{OneSided, answer, distance, first, linear, shown, start};

/// Wang et al. (2021), Fig. 5a, has two folds: exactly at 0.960163672 and 0.715119550, of the balance with 10 harmonics at
/// 0.960163099 and 0.714851667 (reference values). The sampled residual jumps, and its branch turns where it does.
#[test]
fn samples_invent_folds() {
    let model = linear(0.1);
    let request = FrequencyResponse::of(&model).from(1.4).to(0.705);
    let request = request.harmonics(10).stability(false);
    let exact = request.run().unwrap();
    let folds: Vec<_> = exact.folds().map(|fold| fold.point.value).collect();
    println!("from switch to switch: folds {folds:.6?}, no turns");
    assert!(exact.turns.is_empty() && folds.len() == 2);
    for (fold, expected) in folds.iter().zip([0.714_851_667, 0.960_163_099]) {
        assert!((fold - expected).abs() < 1e-8, "{folds:?}");
    }
    // With 256 and 512 the steps that are made happen to lead over all jumps but those beside the folds.
    for samples in [384, 1024] {
        let sampled = request.clone().aft(Aft::Sampled).samples(samples);
        let branch = sampled.max_points(3000).run().unwrap();
        let turns: Vec<_> = branch.turns.iter().map(|turn| turn.value).collect();
        println!("{samples} samples: turns {turns:.4?}, {}", branch.stopped);
        // Not one of these is a fold, and the branch turns too often or is lost.
        assert_eq!(branch.folds().count(), 0);
        assert!(turns.len() > 2 || branch.stopped != Stop::ReachedEnd);
    }
}

/// Exponent 0.6: the stiffness is unbounded where contact begins, and what a sample beside the level says of it is chance.
#[test]
fn samples_of_an_unbounded_stiffness_are_erratic() {
    let (drive, omega) = (1.0, 0.7);
    let model = OneSided {
        zeta: 0.032,
        alpha: 0.6,
        load: 1.0,
        drive,
    };
    let request = FrequencyResponse::of(&model).vary("drive").omega(omega);
    let request = request.from(drive).to(1.01 * drive);
    let branch = first(&request);
    let orbit = &branch.points[0].orbit;
    let exact = FrequencyResponse::of(&model)
        .by(Shooting::new().tolerance(1e-11))
        .near_orbit(orbit);
    let exact = exact.orbit(omega).unwrap().stability;
    let method = Method::Hill;
    let request = request.harmonics(20);
    let hill = |request: &FrequencyResponse| {
        let branch = start(request).ok()?;
        let found = answer(&branch, method).uncorrected;
        Some(distance(&found, &exact.multipliers))
    };
    // Where samples let the search for an orbit fail, there is no error.
    let mut errors = Vec::new();
    for samples in [256, 512, 1024, 2048, 4096, 8192] {
        let error = hill(&request.clone().aft(Aft::Sampled).samples(samples));
        println!(
            "Hill with 20 harmonics from {samples} samples: {}",
            shown(error)
        );
        errors.extend(error);
    }
    assert!(errors.iter().filter(|error| **error > 1e-2).count() > 2);
    assert!(!errors.is_sorted_by(|a, b| a >= b), "{errors:?}");
    let switched = hill(&request).unwrap();
    let default = &branch.points[0].stability;
    let error = distance(&default.multipliers, &exact.multipliers);
    println!(
        "from switch to switch: {switched:.1e}; default {error:.1e}, estimate {:.1e}",
        default.error
    );
    assert!(switched < 1e-4 && error < default.error && default.error < 1e-3);
}
