//! Trees by the contact equation alone: what begins at its events, and what passes an orbit, is followed by it too, and is what shooting finds.

use std::ops::ControlFlow;

use hertzian::bifurcation::{Diagram, Origin};
use hertzian::{
    Branch, ContactEquation, EventKind, FrequencyResponse, OrbitMethod, OrbitMethodKind, Point,
    Shooting, Stop, System,
};
use hertzian_tests::nearest;

use crate::bifurcations::by_contact_equation::{ends_at_a_doubling, is_exact, same};
use crate::bifurcations::cascade::{
    A1, A4, A6, MODEL, PERIOD_2_LOWER_FOLD, PERIOD_2_UPPER_FOLD, PERIOD_8_FOLD, diagram_by,
};

hertzian::oscillator! {
    /// A stop at one side.
    pub Stopped(x) {
        param drive;
        param k;
        law stop(gap, c) { gap > 0 => c*gap, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x - 1, k) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A round stop at one side.
    pub RoundStop(x) {
        param drive;
        param k;
        law stop(gap, c) { gap > 0 => c*gap^1.5, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x - 1, k) = drive*cos(omega*t);
    }
}

/// Orbits of two branches that are one differ by this part of their size.
const NEAR: f64 = 1e-9;

fn is_by_contact(branch: &Branch) {
    assert_eq!(branch.method(), Some(OrbitMethodKind::ContactEquation));
}

/// Each event of either branch is one of the other, within three times what both state: that is what rounding leaves too.
fn have_equal_events(one: &Branch, other: &Branch) {
    for [one, other] in [[one, other], [other, one]] {
        for event in &one.events {
            let found = same(other.events.iter(), event);
            let found = found.unwrap_or_else(|| panic!("period {}: {event}", one.period()));
            let apart = (found.point.value - event.point.value).abs();
            assert!(
                apart <= 3.0 * (found.error + event.error),
                "{found} {event} {apart:.1e}"
            );
        }
        assert!(one.turns.is_empty(), "{:?}", one.turns);
    }
}

/// Orbits of a branch, every so many, are those of another one at their values: of all but an end.
fn passes(branch: &Branch, every: usize, other: &Branch) {
    let (mut compared, mut tried) = (0, 0);
    for point in branch.points.iter().skip(1).step_by(every) {
        tried += 1;
        let there = other.at(point.value).unwrap();
        let size = point.peak_to_peak();
        let nearest = nearest(there.iter(), size, |found| found.peak_to_peak());
        // An end of one branch may be beyond that of the other.
        let Some(nearest) = nearest else { continue };
        compared += 1;
        let apart = (nearest.peak_to_peak() / size - 1.0).abs();
        assert!(
            apart < NEAR,
            "period {} {}: {apart:.1e}",
            branch.period(),
            point.value
        );
    }
    let period = branch.period();
    assert!(
        compared > 0 && compared + 2 >= tried,
        "period {period}: {compared} of {tried}"
    );
}

/// Where a branch of a diagram begins: the period and the value of the event.
fn begins(diagram: &Diagram, origin: Origin) -> Option<(usize, f64)> {
    let Origin::Event { branch, event, .. } = origin else {
        return None;
    };
    let event = &diagram.branches[branch].branch.events[event];
    Some((event.point.orbit.period, event.point.value))
}

/// Figure 8a of Wang et al. (2021): the doublings up to period eight, one branch after the other.
#[test]
fn the_tree_of_figure_8a_by_the_contact_equation_is_that_of_shooting() {
    let own = diagram_by(ContactEquation::new(), 3);
    let shot = diagram_by(Shooting::new(), 3);
    assert_eq!((own.branches.len(), shot.branches.len()), (7, 7));
    for (branch, known) in own.branches.iter().zip(&shot.branches) {
        is_by_contact(&branch.branch);
        assert_eq!(branch.period(), known.period());
        let origins = [begins(&own, branch.origin), begins(&shot, known.origin)];
        if let [Some((period, value)), Some((other, expected))] = origins {
            assert_eq!(period, other);
            assert!((value - expected).abs() < NEAR, "{value} {expected}");
            let first = branch.branch.points[0].value;
            assert!((first - value).abs() < 1e-2, "{first} {value}");
        } else {
            assert_eq!(origins, [None, None]);
        }
        have_equal_events(&branch.branch, &known.branch);
        ends_at_a_doubling(&branch.branch, &own);
        passes(&branch.branch, 7, &known.branch);
        passes(&known.branch, 7, &branch.branch);
    }
    let events = |period: usize| {
        let branches = own.branches.iter().filter(move |of| of.period() == period);
        branches.flat_map(|of| &of.branch.events)
    };
    is_exact(events(1), EventKind::PeriodDoubling, &A1);
    is_exact(events(2), EventKind::PeriodDoubling, &A4);
    is_exact(events(2), EventKind::PeriodDoubling, &A6);
    is_exact(events(2), EventKind::Fold, &PERIOD_2_UPPER_FOLD);
    is_exact(events(2), EventKind::Fold, &PERIOD_2_LOWER_FOLD);
    is_exact(events(8), EventKind::Fold, &PERIOD_8_FOLD);
}

/// Drive, peak-to-peak and leading multiplier of both orbits of period eight below their fold; computed independently of this project from the
/// closed-form flow between switches, in 80-bit arithmetic (`period_8` of the reference values).
const PERIOD_8: [(f64, f64, f64); 4] = [
    (1.7798, 10.690_565_660_231_417, 0.990_263_429_435_609_6),
    (1.7798, 10.709_494_051_088_356, 1.034_938_331_267_823),
    (1.779_835, 10.696_825_674_829_805, 0.996_523_747_851_76),
    (1.779_835, 10.700_583_087_154_753, 1.004_195_396_753_012_4),
];

/// Beside the fold of Table 1 both orbits of period eight are there, with their sizes.
#[test]
fn both_orbits_of_period_8_are_on_the_branch() {
    let own = diagram_by(ContactEquation::new(), 3);
    let eight = own.branches.iter().filter(|of| of.period() == 8);
    let branches: Vec<&Branch> = eight.map(|of| &of.branch).collect();
    for (drive, size, multiplier) in PERIOD_8 {
        let points = branches.iter().flat_map(|branch| branch.at(drive).unwrap());
        let points: Vec<Point> = points.collect();
        let point = nearest(points.iter(), size, |point| point.peak_to_peak()).unwrap();
        let apart = (point.peak_to_peak() / size - 1.0).abs();
        assert!(apart < 1e-10, "{drive}: {apart:.1e}");
        let found = point.stability.multipliers[0];
        assert!((found - multiplier).norm() < 1e-6, "{found} {multiplier}");
    }
}

/// From orbits of longer periods that touch the level, both ways: the branch that they are on.
#[test]
fn branches_go_both_ways_from_touching_orbits() {
    let shot = diagram_by(Shooting::new(), 3);
    let mut tried = 0;
    for known in shot.branches.iter().filter(|known| known.period() > 1) {
        let touches = known.branch.events.iter();
        for touch in touches.filter(|event| matches!(event.kind, EventKind::Grazing { .. })) {
            let request = FrequencyResponse::of(&MODEL).by(ContactEquation::new());
            let request = request.vary("drive").omega(1.0).from(0.1).to(2.19);
            let request = request.near_orbit(&touch.point.orbit);
            let branch = request.through(touch.point.value).unwrap();
            is_by_contact(&branch);
            assert_eq!(branch.period(), known.period());
            for event in &known.branch.events {
                // Where the branch begins or ends it is not one of its events from the other side.
                if event.kind != EventKind::BranchPoint {
                    assert!(
                        same(branch.events.iter(), event).is_some(),
                        "{touch}: {event}"
                    );
                }
            }
            tried += 1;
        }
    }
    assert!(tried >= 5, "{tried}");
}

/// A request for orbits of a period of a model near a state, at frequencies on both sides of a closed branch.
fn near<M: OrbitMethod>(
    model: &dyn System,
    method: M,
    period: usize,
    state: &[f64],
) -> FrequencyResponse<M> {
    let request = FrequencyResponse::of(model).by(method).period(period);
    request.near_state(state).from(1.2).to(6.0).max_points(500)
}

/// Orbits of three periods between two folds, on closed branches, on which contacts begin and end: round once from each of three places, with the same
/// events.
#[test]
fn closed_branches_are_gone_round_once() {
    let stopped = Stopped { drive: 1.0, k: 4.0 };
    let stiff = Stopped {
        drive: 1.0,
        k: 30.0,
    };
    let round = RoundStop { drive: 1.0, k: 4.0 };
    let models: [(&dyn System, f64, [f64; 2]); 4] = [
        (
            &stopped,
            1.628_700_130_763_463_6,
            [-1.817_154_425_382_608, -0.131_192_465_916_098],
        ),
        (
            &stopped,
            3.398_618_456_038_771,
            [-1.324_615_867_740_703_8, 1.231_949_834_587_917_8],
        ),
        (
            &stiff,
            3.4,
            [-0.855_720_993_914_434_7, -1.085_600_038_064_131],
        ),
        (
            &round,
            3.290_282_041_017_566,
            [1.348_676_602_662_157, 0.576_708_684_879_641_7],
        ),
    ];
    for (model, value, state) in models {
        let shot = near(model, Shooting::new(), 3, &state)
            .through(value)
            .unwrap();
        assert_eq!(shot.stopped, Stop::Closed);
        let count = shot.points.len();
        for place in [0, count / 3, 2 * count / 3] {
            let point = &shot.points[place];
            let request = near(model, ContactEquation::new(), 3, &point.orbit.state());
            let branch = request.through(point.value).unwrap();
            is_by_contact(&branch);
            assert_eq!(
                (branch.begin, branch.stopped),
                (None, Stop::Closed),
                "{place}"
            );
            have_equal_events(&branch, &shot);
        }
    }
}

/// Interrupted anywhere, written, read and resumed, it closes where it would have closed.
#[test]
fn a_closed_branch_is_resumed() {
    let model = Stopped { drive: 1.0, k: 4.0 };
    let (value, state) = (
        3.398_618_456_038_771,
        [-1.324_615_867_740_703_8, 1.231_949_834_587_917_8],
    );
    let request = near(&model, ContactEquation::new(), 3, &state);
    let whole = request.through(value).unwrap();
    assert_eq!(whole.stopped, Stop::Closed);
    let path = std::env::temp_dir().join(format!("hertzian-closed-{}.json", std::process::id()));
    for orbits in (1..whole.points.len()).step_by(5) {
        let mut seen = 0;
        let part = request.through_with(value, |_| {
            seen += 1;
            if seen < orbits {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        });
        let part = part.unwrap();
        assert_eq!(part.stopped, Stop::Interrupted);
        part.write(&path).unwrap();
        let mut read = Branch::read(&path).unwrap();
        read.attach(&model).unwrap();
        for resumed in [part.resume().run().unwrap(), read.resume().run().unwrap()] {
            assert_eq!(resumed.stopped, Stop::Closed, "{orbits}");
            assert!(resumed.points == whole.points, "{orbits}");
            assert!(resumed.events == whole.events, "{orbits}");
        }
    }
    std::fs::remove_file(path).unwrap();
}
