//! Continuous springs without a load: Wang et al. (2021), Fig. 2, damping ratio 0.01, drive 0.1. Their orbits have an odd
//! symmetry, and lose it where two branches of orbits without it cross.
//!
//! Exact values: computed independently of this project by event-located integration in 80-bit arithmetic, errors below 1e-12
//! (`frequency_response` of the reference values).

use hertzian::bifurcation::Bifurcations;
use hertzian::{Event, EventKind, Stop, System};
use hertzian_tests::nearest;

hertzian::oscillator! {
    pub Hardening(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    pub Softening(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^0.6 = drive*cos(omega*t);
    }
}

/// Events of the branches without the symmetry: where, and peak-to-peak.
pub type Events<'e> = &'e [(EventKind, f64, f64)];
pub const HARDENING_EVENTS: Events<'static> = &[
    (EventKind::Fold, 0.382_084_326_345_429, 0.831_452_991_128_14),
    (EventKind::Fold, 0.385_408_321_288_445, 0.815_360_413_849_17),
];
pub const SOFTENING_EVENTS: Events<'static> = &[
    (EventKind::Fold, 0.902_396_742_342_991, 0.137_655_259_145_97),
    (EventKind::Fold, 0.934_177_569_964_217, 0.095_132_668_619_52),
    (
        EventKind::PeriodDoubling,
        0.904_833_344_193_996,
        0.074_872_299_018_87,
    ),
    (
        EventKind::PeriodDoubling,
        0.896_507_260_971_036,
        0.074_008_284_715_89,
    ),
];
pub const HARDENING: [f64; 2] = [0.402_310_407_656_194, 0.353_730_954_670_214];
pub const SOFTENING: [f64; 2] = [0.973_916_250_536_018, 0.868_864_958_044_575];

fn assert_symmetry_breaks(
    system: &dyn System,
    [from, to]: [f64; 2],
    exact: [f64; 2],
    (events, unlisted): (Events<'_>, usize),
) {
    let request = Bifurcations::of(system).from(from).to(to).depth(1);
    let diagram = request.run().unwrap();
    let breaks: Vec<_> = diagram.branches[0]
        .branch
        .events(EventKind::SymmetryBreaking)
        .collect();
    assert_eq!(breaks.len(), 2);
    for (event, exact) in breaks.iter().zip(exact) {
        let error = (event.point.value - exact).abs();
        assert!(error < 1e-9, "{event} {error:.1e}");
        assert!(error <= event.error + 1e-12, "{event} {error:.1e}");
    }
    // Both asymmetric branches go from one to the other.
    let asymmetric = &diagram.branches[1..];
    assert_eq!(asymmetric.len(), 2);
    for branch in asymmetric {
        assert!(
            branch
                .branch
                .points
                .iter()
                .all(|cycle| !cycle.orbit.symmetric)
        );
        let Stop::Joined {
            period: 1,
            symmetric: true,
            ..
        } = branch.branch.stopped
        else {
            panic!("{}", branch.branch.stopped);
        };
        let (joint, found) = branch.branch.events.split_last().unwrap();
        // Where the displacement touches zero, between the pieces of the spring, is of no interest here.
        let grazing = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
        let found: Vec<_> = found.iter().filter(|event| !grazing(event)).collect();
        for (kind, omega, peak_to_peak) in events {
            let event = nearest(branch.branch.events(*kind), *omega, |event| {
                event.point.value
            });
            let event = event.unwrap();
            let error = (event.point.value - omega).abs();
            assert!(error < 1e-11, "{event} {error:.1e}");
            let error = (event.point.peak_to_peak() - peak_to_peak).abs();
            assert!(error < 1e-9, "{event} {error:.1e}");
        }
        // The list of the softening spring lacks two folds that are 1.3e-4 apart.
        assert_eq!(found.len(), events.len() + unlisted);
        let critical = |event: &Event| event.point.stability.multipliers[0].norm();
        assert!(
            found
                .iter()
                .all(|event| (critical(event) - 1.0).abs() < 1e-9)
        );
        let error = (joint.point.value - exact[1]).abs();
        assert!(error < 1e-9, "{joint} {error:.1e}");
    }
    // They are mirror images: what is the largest displacement of one is the smallest of the other.
    let extremes =
        |branch: usize, index: usize| asymmetric[branch].branch.points[index].observed.motions[0];
    for index in 0..asymmetric[0].branch.points.len() {
        let (one, other) = (extremes(0, index), extremes(1, index));
        assert!(
            (one.maximum + other.minimum).abs() < 1e-8,
            "{one:?} {other:?}"
        );
        assert!(
            (one.minimum + other.maximum).abs() < 1e-8,
            "{one:?} {other:?}"
        );
    }
}

#[test]
fn symmetry_breaks_in_figure_2a() {
    let model = Hardening {
        zeta: 0.01,
        drive: 0.1,
    };
    assert_symmetry_breaks(&model, [0.45, 0.3], HARDENING, (HARDENING_EVENTS, 0));
}

#[test]
fn symmetry_breaks_in_figure_2b() {
    let model = Softening {
        zeta: 0.01,
        drive: 0.1,
    };
    assert_symmetry_breaks(&model, [1.05, 0.82], SOFTENING, (SOFTENING_EVENTS, 2));
}
