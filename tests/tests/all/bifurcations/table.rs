//! Table 1 of Wang et al. (2021): multipliers of the orbit of period eight near its fold, by the balance and by shooting.
//!
//! The values that the paper prints are off by up to 3e-3, more than ten harmonics per period of the excitation leave out here.
//! Exact values as in `cascade`.

use hertzian::{EventKind, FrequencyResponse, Shooting};

use crate::bifurcations::cascade::{MODEL, PERIOD_8_FOLD};

/// Drive, state at phase zero, exact multipliers, and those that the paper prints.
type Row = (f64, [f64; 2], [f64; 2], [f64; 2]);
const TABLE: [Row; 3] = [
    (
        1.7798,
        [-0.330_466_471_111_865_8, 0.333_494_239_641_907_6],
        [0.990_263_429_435_609_6, 0.186_012_521_175_605_96],
        [0.9920, 0.1857],
    ),
    (
        1.77982,
        [-0.344_162_498_155_966_2, 0.334_790_473_810_001_07],
        [0.990_563_979_830_023_9, 0.185_799_858_213_994_64],
        [0.9927, 0.1854],
    ),
    (
        1.779_835,
        [-0.359_930_367_591_290_4, 0.336_589_677_479_782_7],
        [0.996_523_747_851_76, 0.184_458_432_999_697_83],
        [0.9991, 0.1839],
    ),
];

/// Printed with `--nocapture`: exact, the paper's, those of the balance with ten harmonics a period, and refined.
#[test]
fn multipliers_of_period_8() {
    println!("drive       exact               paper            10 harmonics        refined");
    let mut by_balance = 0;
    for (drive, state, exact, paper) in TABLE {
        let shooting = FrequencyResponse::of(&MODEL)
            .by(Shooting::new())
            .vary("drive")
            .omega(1.0)
            .period(8);
        let known = shooting.near_state(&state).orbit(drive).unwrap();
        let point = FrequencyResponse::of(&MODEL)
            .by(Shooting::new())
            .vary("drive")
            .omega(1.0)
            .complete(&known)
            .unwrap();
        let balance = FrequencyResponse::of(&MODEL).vary("drive").omega(1.0);
        let balance = balance.near_orbit(&point.orbit).harmonics(10).max_points(2);
        let branch = balance.from(drive).to(drive + 1e-5).run();
        // The balance's own fold may lie before this drive.
        let coarse = branch.map(|branch| branch.points[0].clone());
        let refined = coarse.as_ref().ok().map(|coarse| {
            let request = FrequencyResponse::of(&MODEL)
                .by(Shooting::new())
                .vary("drive")
                .omega(1.0);
            request.near_orbit(&coarse.orbit).orbit(drive).unwrap()
        });
        by_balance += usize::from(refined.is_some());
        let refined = refined.unwrap_or(known);
        let text = |m: &[hertzian::Complex<f64>]| format!("{:.6} {:.6}", m[0].re, m[1].re);
        let coarse = coarse.map_or_else(
            |error| error.to_string(),
            |coarse| text(&coarse.stability.multipliers),
        );
        let [a, b] = exact;
        let [p, q] = paper;
        let fine = text(&refined.stability.multipliers);
        println!("{drive:<9} {a:.6} {b:.6}   {p:.4} {q:.4}   {coarse}   {fine}");
        for (found, expected) in refined.stability.multipliers.iter().zip(exact) {
            assert!((found - expected).norm() < 1e-9, "{refined:?}");
        }
    }
    assert!(by_balance >= 2);
}

/// Twenty harmonics a period put the fold within 1e-5, and shooting from there within 1e-11.
#[test]
fn the_fold_of_period_8_by_balance_and_refined() {
    let (drive, state, ..) = TABLE[0];
    let shooting = FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let cycle = shooting
        .clone()
        .period(8)
        .near_state(&state)
        .orbit(drive)
        .unwrap();
    let point = shooting.complete(&cycle).unwrap();
    let balance = FrequencyResponse::of(&MODEL).vary("drive").omega(1.0);
    let balance = balance
        .near_orbit(&point.orbit)
        .harmonics(20)
        .stability(false);
    let branch = balance.from(drive).to(1.79).run().unwrap();
    let fold = branch.folds().next().unwrap();
    let error = (fold.point.value - PERIOD_8_FOLD.drive).abs();
    assert!(error < 1e-5 && error <= fold.error, "{fold} {error:.1e}");
    let before = &branch.points[0].orbit;
    let refined = shooting
        .near_orbit(before)
        .from(drive)
        .to(1.78)
        .run()
        .unwrap();
    let fold = refined.events(EventKind::Fold).next().unwrap();
    let error = (fold.point.value - PERIOD_8_FOLD.drive).abs();
    assert!(error < 1e-11, "{fold} {error:.1e}");
}
