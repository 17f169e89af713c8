//! Branches that nothing leads to: Wang et al. (2021), Fig. 9, drive 1.
//!
//! Exact values as in `cascade` (`periodic_solutions` of the reference values).

use hertzian::bifurcation::{Bifurcations, Diagram, Origin};
use hertzian::flow::basin::{Axis, Basin, Grid};
use hertzian::{Complex, Shooting, Verdict};

use crate::cascade::OneSided;

/// Period, multiplier of the pair with a positive imaginary part, peak-to-peak, at frequency one.
const AT_FREQUENCY_1: [(usize, [f64; 2], f64); 3] = [
    (
        1,
        [-0.655_596_449_627_929_2, 0.615_582_920_279_132_8],
        5.065_330_201_056_806,
    ),
    (
        2,
        [-0.524_746_191_089_171_2, 0.733_336_154_170_019_1],
        16.346_705_117_805_29,
    ),
    (
        3,
        [-0.380_774_924_593_537_2, 0.817_888_662_584_343_5],
        40.702_307_432_878_71,
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

fn passes_exactly(diagram: &Diagram, model: &OneSided, period: usize) -> Vec<(f64, Complex<f64>)> {
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
                found.push((cycle.peak_to_peak(), cycle.stability.multipliers[0]));
            }
        }
    }
    found
}

#[test]
fn periods_one_to_five_of_figure_9() {
    let model = OneSided {
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
    for (period, [re, im], peak_to_peak) in AT_FREQUENCY_1 {
        let exact = Complex::new(re, im);
        let passes = passes_exactly(&diagram, &model, period);
        let is_it = |(size, m): &(f64, Complex<f64>)| {
            let m = Complex::new(m.re, m.im.abs());
            (size - peak_to_peak).abs() < 1e-9 * peak_to_peak && (m - exact).norm() < 1e-9
        };
        assert!(passes.iter().any(is_it), "period {period}: {passes:?}");
    }
}
