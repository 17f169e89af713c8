//! Branches that nothing leads to: Wang et al. (2021), Fig. 9, drive 1.
//!
//! Exact values as in `cascade` (`periodic_solutions` of the reference values).

use std::f64::consts::PI;

use hertzian::bifurcation::{Bifurcations, Diagram, Limb, Origin};
use hertzian::flow::basin::{Axis, Basin, Grid};
use hertzian::flow::shooting::Cycle;
use hertzian::{Complex, Shooting, Verdict};
use hertzian_tests::OneSidedLinear;

use crate::curves::Hertz;

/// Period, multiplier of the pair with a positive imaginary part, peak-to-peak, and the states once in every period of the
/// excitation, the points of figure 9b, at frequency one.
type Known = (usize, [f64; 2], f64, &'static [[f64; 2]]);
const AT_FREQUENCY_1: [Known; 3] = [
    (
        1,
        [-0.655_596_449_627_929_2, 0.615_582_920_279_132_8],
        5.065_330_201_056_806,
        &[[-1.999_776_122_757_642_7, 0.178_235_874_603_685_45]],
    ),
    (
        2,
        [-0.524_746_191_089_171_2, 0.733_336_154_170_019_1],
        16.346_705_117_805_29,
        &[
            [-5.632_060_192_753_841, 3.526_590_078_650_18],
            [-8.051_070_357_195_234, -2.756_595_228_529_407],
        ],
    ),
    (
        3,
        [-0.380_774_924_593_537_2, 0.817_888_662_584_343_5],
        40.702_307_432_878_71,
        &[
            [-31.334_287_816_436_888, 0.605_360_285_158_400_4],
            [-7.791_488_165_000_865, 6.888_545_592_337_987],
            [-15.398_669_863_515_478, -5.677_825_022_021_186],
        ],
    ),
];

fn basin() -> Basin {
    let axis = |entry, from, to| Axis {
        entry,
        from,
        to,
        count: 48,
    };
    let grid = Grid {
        start: vec![0.0, 0.0],
        columns: axis(0, -150.0, 30.0),
        rows: axis(1, -16.0, 16.0),
    };
    Basin {
        longest: 5,
        patience: 3000,
        ..Basin::new(grid)
    }
}

/// The orbits of a period at frequency one, on all branches.
fn at_frequency_1(diagram: &Diagram, model: &OneSidedLinear, period: usize) -> Vec<Cycle> {
    let mut found = Vec::new();
    for limb in diagram
        .branches
        .iter()
        .filter(|limb| limb.period() == period)
    {
        for pair in limb.branch.cycles.windows(2) {
            if (pair[0].value - 1.0) * (pair[1].value - 1.0) > 0.0 {
                continue;
            }
            let near = Shooting::of(model).period(period).near(pair[0].state());
            if let Ok(cycle) = near.orbit(1.0) {
                assert_ne!(cycle.stability.verdict, Verdict::Undecided);
                found.push(cycle);
            }
        }
    }
    found
}

#[test]
fn periods_one_to_five_of_figure_9() {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let request = Bifurcations::of(&model).from(2.2).to(0.4).depth(1);
    let diagram = request.search(1.0, basin()).run().unwrap();
    for period in 1..=5 {
        let limbs = diagram
            .branches
            .iter()
            .filter(|limb| limb.period() == period);
        assert!(limbs.count() > 0, "period {period}");
    }
    for period in 3..=5 {
        let found = |origin: Origin| matches!(origin, Origin::Attractor { value } if value == 1.0);
        let mut limbs = diagram
            .branches
            .iter()
            .filter(|limb| limb.period() == period);
        assert!(limbs.any(|limb| found(limb.origin)), "period {period}");
    }
    for (period, [re, im], peak_to_peak, points) in AT_FREQUENCY_1 {
        let exact = Complex::new(re, im);
        let passes = at_frequency_1(&diagram, &model, period);
        let is_it = |cycle: &&Cycle| {
            let m = cycle.stability.multipliers[0];
            let m = Complex::new(m.re, m.im.abs());
            (cycle.peak_to_peak() - peak_to_peak).abs() < 1e-9 * peak_to_peak
                && (m - exact).norm() < 1e-9
        };
        let cycle = passes.iter().find(is_it);
        let cycle = cycle.unwrap_or_else(|| panic!("period {period}: {passes:?}"));
        assert_eq!(cycle.stability.verdict, Verdict::Stable);
        // Figure 9b: the points of its Poincare section.
        assert_eq!(cycle.states().count(), period);
        for point in points {
            let is_at =
                |state: &[f64]| (0..2).all(|i| (state[i] - point[i]).abs() < 1e-9 * peak_to_peak);
            assert!(cycle.states().any(is_at), "{period} {point:?}");
        }
    }
    // Of the longer periods nothing is known from elsewhere but that they exist and attract.
    for period in [4, 5] {
        let passes = at_frequency_1(&diagram, &model, period);
        let stable = |cycle: &&Cycle| cycle.stability.verdict == Verdict::Stable;
        assert!(passes.iter().any(|cycle| stable(&cycle)), "{period}");
    }
}

/// The bouncing limit: a flight under the load `W` that ends with the speed `v` takes `2 v / W`, from a height of `v^2 / 2 W`. The drive
/// `A` gives it at most `2 pi A v / (omega pi)` in a period, and contact takes `zeta v^2 t`. A Hertzian contact of stiffness one lasts
/// `t = 2.943 (5/4)^(2/5) v^(-1/5)`. So large orbits exist only above a speed, where both are equal, which is below a frequency,
/// `2 pi / omega = 2 v / W + t`: for `zeta = 0.032`, `A = 0.1`, `W = 1` at 0.260. Nothing leads there from small ones.
#[test]
fn the_detached_branch_of_a_hertzian_contact() {
    let model = Hertz {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let (at, limit) = (0.2, 0.260);
    let height = |omega: f64| 0.5 * (PI / omega).powi(2);
    let axis = |entry, from, to| Axis {
        entry,
        from,
        to,
        count: 32,
    };
    let grid = Grid {
        start: vec![0.0, 0.0],
        columns: axis(0, -1.2 * height(at), 0.0),
        rows: axis(1, -PI / at, PI / at),
    };
    let basin = Basin {
        longest: 1,
        patience: 3000,
        ..Basin::new(grid)
    };
    let request = Bifurcations::of(&model).from(0.3).to(0.18).depth(0);
    let diagram = request.search(at, basin).run().unwrap();
    let detached = |limb: &&Limb| {
        matches!(limb.origin, Origin::Attractor { .. })
            && limb
                .branch
                .cycles
                .iter()
                .any(|cycle| cycle.peak_to_peak() > 0.5 * height(at))
    };
    let limbs: Vec<_> = diagram.branches.iter().filter(detached).collect();
    let [limb] = limbs[..] else {
        panic!(
            "{} of {}, {:?}",
            limbs.len(),
            diagram.branches.len(),
            diagram.missed
        );
    };
    // It comes from low frequencies, turns at the limit, and goes back there.
    let folds: Vec<_> = limb.branch.folds().collect();
    let [fold] = folds[..] else {
        panic!("{:?}", limb.branch.events);
    };
    assert!((fold.cycle.value / limit - 1.0).abs() < 0.05, "{fold}");
    for cycle in &limb.branch.cycles {
        let ratio = cycle.peak_to_peak() / height(cycle.value);
        assert!((ratio - 1.0).abs() < 0.15, "{} {ratio}", cycle.value);
    }
    let first = &diagram.branches[0].branch.cycles;
    assert!(
        first
            .iter()
            .all(|cycle| cycle.peak_to_peak() < 0.5 * height(cycle.value))
    );
}
