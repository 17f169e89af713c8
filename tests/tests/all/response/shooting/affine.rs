//! The one-sided oscillator with exponent one, damping ratio 0.032, load 1 and frequency 1: Wang et al. (2021), Fig. 8 and
//! Table 1.
//!
//! Exact values: computed independently of this project from the closed-form flow between switches, in 80-bit arithmetic,
//! confirmed with 60 digits (`amplitude_sweep`, `period_8` and `periodic_solutions` of the reference values).
#![allow(
    clippy::unreadable_literal,
    clippy::excessive_precision,
    reason = "numbers as they were published, to be searched for"
)]

use hertzian::{
    Branch, Complex, Event, EventKind, FrequencyResponse, OrbitError, Point, Shooting, Verdict,
};
use hertzian_tests::OneSidedLinear;

const MODEL: OneSidedLinear = OneSidedLinear {
    zeta: 0.032,
    load: 1.0,
    drive: 1.0,
};

/// A bifurcation: value of the drive, state at phase zero, and the multiplier that is not plus or minus one.
struct Exact {
    drive: f64,
    state: [f64; 2],
    multiplier: f64,
}

const A1: Exact = Exact {
    drive: 1.282584167663767668720010816491575130915,
    state: [
        -2.508552764323553207239007678676144,
        0.15845858191845207491988235020849467,
    ],
    multiplier: -0.8179459689170937318036895,
};
const A4: Exact = Exact {
    drive: 1.531044135499983048113838266945532267642,
    state: [
        -0.096568334976684316346436887715757315,
        0.28305968832414577147363757942599226,
    ],
    multiplier: -0.6359787215800466843544429,
};
const A6: Exact = Exact {
    drive: 1.880077405264828834615984361649762885244,
    state: [
        0.87769417752927682558837903059438111,
        0.21833748603697650475065830514756271,
    ],
    multiplier: -0.6395834436986777526734474,
};
const PERIOD_2_UPPER_FOLD: Exact = Exact {
    drive: 2.009554757004067907775848413121047814393,
    state: [
        2.0046658401792253536314458573912848,
        0.17379307106961038237033384864963839,
    ],
    multiplier: 0.6690363042373984899291034,
};
const PERIOD_2_LOWER_FOLD: Exact = Exact {
    drive: 0.2945288061872164957446820226475077835495,
    state: [
        1.1159876223936257591715531535031934,
        4.5930137541905651581432195723191286,
    ],
    multiplier: 0.7950913073545377276245668,
};
const PERIOD_8_FOLD: Exact = Exact {
    drive: 1.779836025884334199953192596795194040977,
    state: [
        -0.36438558687433484266068027708093519,
        0.33718297916760341397235901385698036,
    ],
    multiplier: 0.1837400234558880978440711,
};

/// Orbits of period eight in Table 1: drive, state at phase zero, multipliers. The paper prints the multipliers of a balance.
const TABLE_1: [(f64, [f64; 2], [f64; 2]); 3] = [
    (
        1.7798,
        [-0.33046647111186583064, 0.33349423964190761326],
        [0.9902634294356096, 0.18601252117560596],
    ),
    (
        1.77982,
        [-0.3441624981559662589, 0.33479047381100781377],
        [0.9905639798300239, 0.18579985821399464],
    ),
    (
        1.779835,
        [-0.35993036759129042753, 0.33658967747978272458],
        [0.99652374785176, 0.18445843299969783],
    ),
];

fn shooting() -> FrequencyResponse<Shooting> {
    FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0)
}

/// The event is the exact one to 1e-11, and to the error that it states.
fn assert_exact(event: &Event, kind: EventKind, exact: &Exact) {
    assert_eq!(event.kind, kind, "{event}");
    let error = (event.point.value - exact.drive).abs();
    assert!(error < 1e-11, "{event}: {error:.1e}");
    assert!(
        error <= event.error && event.error < 1e-11,
        "{event}: {error:.1e}"
    );
    let critical = if kind == EventKind::Fold { 1.0 } else { -1.0 };
    let multipliers = &event.point.stability.multipliers;
    for (found, expected) in multipliers.iter().zip([critical, exact.multiplier]) {
        assert!((found - expected).norm() < 1e-9, "{event}: {multipliers:?}");
    }
    // Orbits of longer periods may be found from another phase on.
    if event.point.orbit.period == 1 {
        for (found, expected) in event.point.orbit.state().iter().zip(exact.state) {
            assert!((found - expected).abs() < 1e-9, "{event}");
        }
    }
}

/// Not one turn that is no fold.
fn assert_smooth(branch: &Branch) {
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
}

#[test]
fn period_1_doubles_at_a1() {
    // Also in two segments, which are two problems of another size.
    for segments in [1, 2] {
        let request = shooting()
            .by(Shooting::new().segments(segments))
            .from(1.0)
            .to(1.4);
        let branch = request.run().unwrap();
        assert_smooth(&branch);
        let [doubling] = &branch.events[..] else {
            panic!("{:?}", branch.events);
        };
        assert_exact(doubling, EventKind::PeriodDoubling, &A1);
        for cycle in &branch.points {
            let stable = cycle.value < A1.drive;
            let expected = if stable {
                Verdict::Stable
            } else {
                Verdict::Unstable
            };
            assert_eq!(cycle.stability.verdict, expected, "{cycle:?}");
        }
    }
}

/// The branch that is born at A1, from a state near it to three digits.
#[test]
fn period_2_doubles_at_a4_and_a6_and_folds() {
    let request = shooting().period(2).near_state(&[-0.097, 0.283]);
    let branch = request.from(1.52).to(2.2).run().unwrap();
    assert_smooth(&branch);
    let grazing = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    let events: Vec<_> = branch.events.iter().filter(|e| !grazing(e)).collect();
    let [a4, a6, fold, ..] = events[..] else {
        panic!("{events:?}");
    };
    assert_exact(a4, EventKind::PeriodDoubling, &A4);
    assert_exact(a6, EventKind::PeriodDoubling, &A6);
    assert_exact(fold, EventKind::Fold, &PERIOD_2_UPPER_FOLD);
}

/// The branch of large orbits, which the balance finds by itself.
#[test]
fn period_2_folds_at_small_drive() {
    let branch = shooting().period(2).from(1.0).to(0.2).run().unwrap();
    assert_smooth(&branch);
    let [fold] = &branch.events[..] else {
        panic!("{:?}", branch.events);
    };
    assert_exact(fold, EventKind::Fold, &PERIOD_2_LOWER_FOLD);
}

/// Period two ends where period one doubles.
#[test]
fn period_2_joins_period_1_at_a1() {
    let request = shooting().period(2).near_state(&[-0.097, 0.283]);
    let branch = request.from(1.52).to(1.1).run().unwrap();
    let joint = branch.events.last().unwrap();
    assert_eq!(joint.kind, EventKind::BranchPoint);
    let error = (joint.point.value - A1.drive).abs();
    assert!(error < 1e-11, "{joint} {error:.1e}");
    assert!(
        error <= joint.error && joint.error < 1e-11,
        "{joint} {error:.1e}"
    );
    // It lies behind the last orbit of the branch.
    assert_eq!(joint.after, branch.points.len());
    let last = branch.points.last().unwrap();
    assert!(last.value > joint.point.value);
}

/// From a state near it to three digits.
#[test]
fn period_8_folds_beyond_table_1() {
    let request = shooting().period(8).near_state(&[-0.330, 0.333]);
    let branch = request.from(1.7798).to(1.7799).run().unwrap();
    assert_smooth(&branch);
    let [fold] = &branch.events[..] else {
        panic!("{:?}", branch.events);
    };
    assert_exact(fold, EventKind::Fold, &PERIOD_8_FOLD);
}

#[test]
fn multipliers_of_table_1_and_no_solution_at_the_last() {
    // From one orbit to the next, the first from three digits.
    let mut near = vec![-0.330, 0.333];
    for (drive, state, multipliers) in TABLE_1 {
        let cycle = shooting().period(8).near_state(&near).orbit(drive).unwrap();
        for (found, expected) in cycle.orbit.state().iter().zip(state) {
            let error = (found - expected).abs();
            assert!(
                error < 1e-10 && error <= cycle.error.unwrap() * cycle.peak_to_peak(),
                "{error:.1e} {cycle:?}"
            );
        }
        assert_eq!(cycle.stability.verdict, Verdict::Stable);
        for (found, expected) in cycle.stability.multipliers.iter().zip(multipliers) {
            let error = (found - expected).norm();
            assert!(
                error < 1e-9 && error <= cycle.stability.error,
                "{error:.1e} {cycle:?}"
            );
        }
        near = cycle.orbit.state();
    }
    let request = shooting().period(8).near_state(&near);
    let error = request.orbit(1.77983603).unwrap_err();
    let Some(&OrbitError::Beyond { value, fold }) = error.downcast_ref() else {
        panic!("{error}");
    };
    assert_eq!(value, 1.77983603);
    assert!((fold - PERIOD_8_FOLD.drive).abs() < 1e-11, "{fold}");
    assert_eq!(
        error.to_string(),
        "no periodic orbit at 1.77983603 near the given one: its branch turns back at 1.779836025884, 4.1e-9 away"
    );
}

/// Periods one, two and three at drive 1: multiplier of the pair with positive imaginary part, peak-to-peak.
const AT_DRIVE_1: [(usize, [f64; 2], f64); 3] = [
    (
        1,
        [-0.6555964496279292, 0.6155829202791328],
        5.065330201056806,
    ),
    (
        2,
        [-0.5247461910891712, 0.7333361541700191],
        16.34670511780529,
    ),
    (
        3,
        [-0.3807749245935372, 0.8178886625843435],
        40.70230743287871,
    ),
];

fn assert_known(cycle: &Point, [re, im]: [f64; 2], peak_to_peak: f64) {
    let found = cycle.stability.multipliers[0];
    let error = (found - Complex::new(re, im)).norm();
    assert!(error < 1e-11, "{error:.1e} {cycle:?}");
    assert!(error <= cycle.stability.error, "{error:.1e} {cycle:?}");
    assert_eq!(cycle.stability.verdict, Verdict::Stable);
    let error = (cycle.peak_to_peak() - peak_to_peak).abs();
    assert!(error < 1e-12 * peak_to_peak, "{error:.1e}");
}

#[test]
fn orbits_of_the_balance_are_refined() {
    // The balance finds another orbit of period three.
    for (period, multiplier, peak_to_peak) in &AT_DRIVE_1[..2] {
        let request = FrequencyResponse::of(&MODEL).vary("drive").omega(1.0);
        let request = request.period(*period).harmonics(10).max_points(2);
        let branch = request.from(1.0).to(1.1).run().unwrap();
        let orbit = &branch.points[0].orbit;
        let cycle = shooting().near_orbit(orbit).orbit(1.0).unwrap();
        assert_known(&cycle, *multiplier, *peak_to_peak);
    }
}

#[test]
fn period_3_is_found_from_a_state_near_it() {
    let (period, multiplier, peak_to_peak) = AT_DRIVE_1[2];
    for segments in [1, 3, 7] {
        let request = shooting()
            .period(period)
            .by(Shooting::new().segments(segments));
        let cycle = request.near_state(&[-31.3, 0.605]).orbit(1.0).unwrap();
        assert_known(&cycle, multiplier, peak_to_peak);
    }
}
