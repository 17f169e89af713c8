//! Two coordinates, and a declaration whose own period is not that of the excitation.

use std::f64::consts::TAU;

use super::stated::assert_stated;
use hertzian::time;
use hertzian::{EventKind, FrequencyResponse, Shooting, Stop, Verdict};
use hertzian_tests::TwoMasses;

/// The Neimark-Sacker bifurcation at omega 0.61861 and the period doubling at 0.73878 are from an independent computation, to
/// five digits. The system is piecewise affine.
#[test]
fn two_masses_lose_stability_where_they_should() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(0.5)
        .to(1.0)
        .run()
        .unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
    let doubles = branch
        .events(EventKind::PeriodDoubling)
        .map(|event| event.point.value);
    assert!(
        doubles
            .into_iter()
            .any(|value| (value - 0.73878).abs() < 1e-5)
    );
    // The Neimark-Sacker bifurcation is between verdicts.
    let omega = 0.61861;
    let passes = branch.points.windows(2).any(|pair| {
        let [before, behind] = [&pair[0], &pair[1]].map(|cycle| cycle.stability.verdict);
        let between = pair[0].value < omega && omega < pair[1].value;
        between && before == Verdict::Unstable && behind == Verdict::Stable
    });
    assert!(passes);
}

/// Folds by shooting, in one segment and in four, and by the balance.
#[test]
fn folds_of_two_masses_are_those_of_the_balance() {
    let model = TwoMasses {
        stop: 10.0,
        drive: 0.1,
    };
    let by_balance = FrequencyResponse::of(&model).from(0.5).to(1.0);
    let by_balance = by_balance.stability(false).run().unwrap();
    let folds: Vec<_> = by_balance.folds().collect();
    for segments in [1, 4] {
        let request = FrequencyResponse::of(&model).by(Shooting::new().segments(segments));
        let branch = request.from(0.5).to(1.0).run().unwrap();
        assert_eq!(branch.folds().count(), folds.len());
        for (fold, expected) in branch.folds().zip(&folds) {
            let error = (fold.point.value - expected.point.value).abs();
            assert!(error <= fold.error + expected.error, "{fold} {expected}");
            assert!(fold.error < 1e-11, "{fold}");
        }
    }
}

hertzian::oscillator! {
    /// Excited at omega and at two fifths of it: the motion repeats after five periods of the excitation.
    Fractions(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*(cos(omega*t) + cos(2/5*omega*t));
    }
}

#[test]
fn a_period_is_that_of_the_declaration() {
    let model = Fractions {
        zeta: 0.1,
        drive: 0.1,
    };
    let cycle = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .orbit(0.9)
        .unwrap();
    assert_eq!(cycle.orbit.period, 1);
    // The phase of the flow is that of the declaration too.
    let mut flow = time::of(&model, 0.9, 1e-10).unwrap();
    let mut state = [0.0, 0.0];
    for _ in 0..40 {
        flow.advance(0.0, TAU, &mut state, None, None).unwrap();
    }
    for (x, settled) in cycle.orbit.state().iter().zip(state) {
        assert!((x - settled).abs() < 1e-8, "{cycle:?} {state:?}");
    }
    let expected = (-TAU * 5.0 / 0.9 * 2.0 * 0.1_f64).exp();
    let product: hertzian::Complex<f64> = cycle.stability.multipliers.iter().product();
    assert!((product - expected).norm() < 1e-10, "{product} {expected}");
}

/// Between closed forms there is nothing but rounding, also beside a grazing orbit, where multipliers depend on its distance
/// from the level by a root.
#[test]
fn rounding_is_stated() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let branch = request.clone().from(0.5).to(0.7).run().unwrap();
    for cycle in &branch.points {
        let again = request
            .clone()
            .by(Shooting::new().segments(3))
            .near_orbit(&cycle.orbit);
        assert_stated(cycle, &again.orbit(cycle.value).unwrap());
    }
}
