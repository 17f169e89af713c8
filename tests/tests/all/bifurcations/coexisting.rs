//! Branches that nothing leads to: Wang et al. (2021), Fig. 9, drive 1.
//!
//! Exact values as in `cascade` (`periodic_solutions` of the reference values).

use std::f64::consts::PI;

use hertzian::attractors::basin::{Axis, Basin, Grid};
use hertzian::bifurcation::{Bifurcations, Diagram, DiagramBranch, Origin};
use hertzian::{Complex, FrequencyResponse, Point, Shooting, Verdict};
use hertzian_tests::OneSidedLinear;

use crate::bifurcations::curves::Hertz;

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

fn basin(model: &OneSidedLinear) -> Basin {
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(48);
    let grid = Grid::new(vec![0.0, 0.0], axis(0, -150.0, 30.0), axis(1, -16.0, 16.0));
    Basin::of(model).grid(grid).longest(5).patience(3000)
}

/// The orbits of a period at frequency one, on all branches.
fn at_frequency_1(diagram: &Diagram, model: &OneSidedLinear, period: usize) -> Vec<Point> {
    let mut found = Vec::new();
    for branch in diagram
        .branches
        .iter()
        .filter(|branch| branch.period() == period)
    {
        for pair in branch.branch.points.windows(2) {
            if (pair[0].value - 1.0) * (pair[1].value - 1.0) > 0.0 {
                continue;
            }
            let near = FrequencyResponse::of(model)
                .by(Shooting::new())
                .period(period)
                .near_state(&pair[0].orbit.state());
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
    let diagram = request.search(1.0, basin(&model)).run().unwrap();
    for period in 1..=5 {
        let branches = diagram
            .branches
            .iter()
            .filter(|branch| branch.period() == period);
        assert!(branches.count() > 0, "period {period}");
    }
    for period in 3..=5 {
        let found = |origin: Origin| matches!(origin, Origin::Attractor { value } if value == 1.0);
        let mut branches = diagram
            .branches
            .iter()
            .filter(|branch| branch.period() == period);
        assert!(
            branches.any(|branch| found(branch.origin)),
            "period {period}"
        );
    }
    for (period, [re, im], peak_to_peak, points) in AT_FREQUENCY_1 {
        let exact = Complex::new(re, im);
        let passes = at_frequency_1(&diagram, &model, period);
        let is_it = |cycle: &&Point| {
            let m = cycle.stability.multipliers[0];
            let m = Complex::new(m.re, m.im.abs());
            (cycle.peak_to_peak() - peak_to_peak).abs() < 1e-9 * peak_to_peak
                && (m - exact).norm() < 1e-9
        };
        let cycle = passes.iter().find(is_it);
        let cycle = cycle.unwrap_or_else(|| panic!("period {period}: {passes:?}"));
        assert_eq!(cycle.stability.verdict, Verdict::Stable);
        // Figure 9b: the points of its Poincare section.
        assert_eq!(cycle.orbit.states().count(), period);
        for point in points {
            let is_at =
                |state: &[f64]| (0..2).all(|i| (state[i] - point[i]).abs() < 1e-9 * peak_to_peak);
            assert!(cycle.orbit.states().any(is_at), "{period} {point:?}");
        }
    }
    for period in 1..=5 {
        let passes = at_frequency_1(&diagram, &model, period);
        let stable = |cycle: &&Point| cycle.stability.verdict == Verdict::Stable;
        let mut count = 0;
        for cycle in passes.iter().filter(stable) {
            assert_settles(cycle);
            count += 1;
        }
        assert!(count > 0, "{period}");
    }
}

/// The state a time later under `x'' = cos t + 1`, or with `0.064 x' + x` on the left in contact: closed forms written out.
fn later([x, v]: [f64; 2], t: f64, s: f64, contact: bool) -> [f64; 2] {
    if !contact {
        let (rise, end) = ((t + s).sin() - t.sin(), t + s);
        return [
            x + v * s + 0.5 * s * s - end.cos() + t.cos() - s * t.sin(),
            v + s + rise,
        ];
    }
    let zeta: f64 = 0.032;
    let nu = (1.0 - zeta * zeta).sqrt();
    // At resonance the drive is met by the damping alone.
    let forced = |t: f64| [1.0 + t.sin() / (2.0 * zeta), t.cos() / (2.0 * zeta)];
    let [p, q] = forced(t);
    let a = x - p;
    let b = (v - q + zeta * a) / nu;
    let (sine, cosine) = (nu * s).sin_cos();
    let decay = (-zeta * s).exp();
    let [p, q] = forced(t + s);
    let y = decay * (a * cosine + b * sine);
    let rate = decay * nu * (b * cosine - a * sine) - zeta * y;
    [p + y, q + rate]
}

/// The state so many periods later, in steps in which a change of sign is bisected.
fn simulated(mut state: [f64; 2], periods: usize) -> [f64; 2] {
    const STEPS: usize = 600;
    let step = 2.0 * PI / STEPS as f64;
    for index in 0..periods * STEPS {
        let begin = (index % STEPS) as f64 * step;
        let mut passed = 0.0;
        // No orbit crosses three times in one step.
        for _ in 0..3 {
            let contact = state[0] > 0.0 || state[0] == 0.0 && state[1] > 0.0;
            let left = step - passed;
            let ahead = later(state, begin + passed, left, contact);
            if (ahead[0] > 0.0) == contact {
                state = ahead;
                break;
            }
            let (mut low, mut high) = (0.0, left);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let there = later(state, begin + passed, middle, contact);
                let side = if (there[0] > 0.0) == contact {
                    &mut low
                } else {
                    &mut high
                };
                *side = middle;
            }
            state = [0.0, later(state, begin + passed, high, contact)[1]];
            passed += high;
        }
    }
    state
}

/// A motion that begins beside an orbit settles to it, and neighbours return as the multipliers say: by a simulation that has nothing
/// but its equations in common with the rest.
fn assert_settles(cycle: &Point) {
    let (period, size) = (cycle.orbit.period, cycle.peak_to_peak());
    let state = [cycle.orbit.state()[0], cycle.orbit.state()[1]];
    let beside = [state[0] + 1e-5 * size, state[1]];
    let settled = simulated(beside, 400 * period);
    for i in 0..2 {
        let error = (settled[i] - state[i]).abs();
        assert!(error < 1e-10 * size, "{period} {error:e}");
    }
    let h = 1e-5 * size;
    let column = |i: usize| {
        let moved = |by: f64| {
            let mut state = state;
            state[i] += by;
            simulated(state, period)
        };
        let (ahead, behind) = (moved(h), moved(-h));
        [0, 1].map(|k| (ahead[k] - behind[k]) / (2.0 * h))
    };
    let [a, b] = [column(0), column(1)];
    let (trace, determinant) = (a[0] + b[1], a[0] * b[1] - a[1] * b[0]);
    let [m, n] = [0, 1].map(|k| cycle.stability.multipliers[k]);
    assert!((m + n - trace).norm() < 1e-6, "{period} {trace}");
    assert!(
        (m * n - determinant).norm() < 1e-6,
        "{period} {determinant}"
    );
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
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(32);
    let grid = Grid::new(
        vec![0.0, 0.0],
        axis(0, -1.2 * height(at), 0.0),
        axis(1, -PI / at, PI / at),
    );
    let basin = Basin::of(&model).grid(grid).longest(1).patience(3000);
    let request = Bifurcations::of(&model).from(0.3).to(0.18).depth(0);
    let diagram = request.search(at, basin).run().unwrap();
    let detached = |branch: &&DiagramBranch| {
        matches!(branch.origin, Origin::Attractor { .. })
            && branch
                .branch
                .points
                .iter()
                .any(|cycle| cycle.peak_to_peak() > 0.5 * height(at))
    };
    let branches: Vec<_> = diagram.branches.iter().filter(detached).collect();
    let [branch] = branches[..] else {
        panic!(
            "{} of {}, {:?}",
            branches.len(),
            diagram.branches.len(),
            diagram.missed
        );
    };
    // It comes from low frequencies, turns at the limit, and goes back there.
    let folds: Vec<_> = branch.branch.folds().collect();
    let [fold] = folds[..] else {
        panic!("{:?}", branch.branch.events);
    };
    assert!((fold.point.value / limit - 1.0).abs() < 0.05, "{fold}");
    for cycle in &branch.branch.points {
        let ratio = cycle.peak_to_peak() / height(cycle.value);
        assert!((ratio - 1.0).abs() < 0.15, "{} {ratio}", cycle.value);
    }
    let first = &diagram.branches[0].branch.points;
    assert!(
        first
            .iter()
            .all(|cycle| cycle.peak_to_peak() < 0.5 * height(cycle.value))
    );
}
