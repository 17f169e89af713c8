//! The branches of Figs. 8a and 9a of Wang et al. (2021) by the contact equation alone: every event that shooting has and no more, through
//! every touch, and the exact ones among them.

use hertzian::bifurcation::Diagram;
use hertzian::{
    Branch, ContactEquation, Event, EventKind, FrequencyResponse, Point, Shooting, Stop,
};
use hertzian_tests::{OneSidedLinear, nearest};

use crate::bifurcations::cascade::{
    A1, A4, A6, Exact, MODEL, PERIOD_2_LOWER_FOLD, PERIOD_2_UPPER_FOLD, PERIOD_8_FOLD, diagram_by,
};

/// Events of two branches that are one are that near to each other.
const NEAR: f64 = 1e-9;

/// The branch through an orbit of Fig. 8a, from it on towards both ends of the range.
fn both_ways(point: &Point, period: usize) -> [Branch; 2] {
    [0.05, 2.05].map(|to| {
        let request = FrequencyResponse::of(&MODEL).by(ContactEquation::new());
        let request = request.vary("drive").omega(1.0).period(period);
        let request = request
            .near_state(&point.orbit.state())
            .from(point.value)
            .to(to);
        request.max_points(1000).run().unwrap()
    })
}

/// Where a branch ends on one of shorter orbits there is a branch point, which is the doubling of the latter.
pub fn ends_at_a_doubling(branch: &Branch, diagram: &Diagram) {
    let Stop::Joined { value, .. } = branch.stopped else {
        return;
    };
    let shorter = diagram
        .branches
        .iter()
        .filter(|of| of.period() < branch.period());
    let events = shorter.flat_map(|of| of.branch.events(EventKind::PeriodDoubling));
    let doubling = nearest(events, value, |event| event.point.value).unwrap();
    let joint = branch.events.last().unwrap();
    assert_eq!(joint.kind, EventKind::BranchPoint);
    let apart = (joint.point.value - doubling.point.value).abs();
    assert!(
        apart < 1e-8 && apart <= joint.error + doubling.error,
        "{joint} {doubling}"
    );
}

/// The nearest event of a kind.
pub fn same<'e>(events: impl Iterator<Item = &'e Event>, wanted: &Event) -> Option<&'e Event> {
    let of_kind = events.filter(|event| event.kind == wanted.kind);
    // A branch may have two at one value.
    let near = of_kind.filter(|event| {
        (event.point.value - wanted.point.value).abs() < NEAR
            && (event.point.peak_to_peak() / wanted.point.peak_to_peak() - 1.0).abs() < 1e-6
    });
    near.min_by(|a, b| {
        let far = |event: &&Event| (event.point.value - wanted.point.value).abs();
        far(a).total_cmp(&far(b))
    })
}

/// From the first, the middle and the last orbit of each branch of the tree that shooting finds, the contact equation goes both ways: what it finds
/// are the events of that branch, and all of them.
#[test]
fn the_tree_of_figure_8a_is_that_of_shooting() {
    let diagram = diagram_by(Shooting::new(), 3);
    assert_eq!(diagram.branches.len(), 7);
    for tree in &diagram.branches {
        let points = &tree.branch.points;
        let starts = [0, points.len() / 2, points.len() - 1];
        let walks: Vec<Branch> = starts
            .into_iter()
            .flat_map(|place| both_ways(&points[place], tree.period()))
            .collect();
        let joints = |event: &&Event| event.kind != EventKind::BranchPoint;
        for walk in &walks {
            assert!(walk.turns.is_empty(), "{:?}", walk.turns);
            ends_at_a_doubling(walk, &diagram);
            // The range of the tree.
            let inside = walk.events.iter().filter(joints);
            for event in inside.filter(|event| (0.1..2.0).contains(&event.point.value)) {
                let known = same(tree.branch.events.iter(), event);
                assert!(known.is_some(), "period {}: {event}", tree.period());
            }
        }
        for event in tree.branch.events.iter().filter(joints) {
            let found = same(walks.iter().flat_map(|walk| &walk.events), event);
            let found = found.unwrap_or_else(|| panic!("period {}: {event}", tree.period()));
            let apart = (found.point.value - event.point.value).abs();
            assert!(
                apart <= 3.0 * (found.error + event.error),
                "{found} {event}"
            );
        }
    }
}

/// To rounding, and within what is stated.
pub fn is_exact<'e>(events: impl Iterator<Item = &'e Event>, kind: EventKind, exact: &Exact) {
    let of_kind = events.filter(|event| event.kind == kind);
    let found = nearest(of_kind, exact.drive, |event| event.point.value).unwrap();
    let error = (found.point.value - exact.drive).abs();
    assert!(
        error < 1e-12 && error <= found.error + 1e-15,
        "{found}: {error:.1e}"
    );
}

#[test]
fn exact_values_of_figure_8a_are_found() {
    let diagram = diagram_by(Shooting::new(), 3);
    let of = |period: usize| {
        let mut branches = diagram.branches.iter().filter(|of| of.period() == period);
        let walks = branches.by_ref().flat_map(|of| {
            let points = &of.branch.points;
            both_ways(&points[points.len() / 2], period)
        });
        let walks: Vec<Branch> = walks.collect();
        walks
            .into_iter()
            .flat_map(|walk| walk.events)
            .collect::<Vec<_>>()
    };
    let [one, two, eight] = [1, 2, 8].map(of);
    is_exact(one.iter(), EventKind::PeriodDoubling, &A1);
    is_exact(two.iter(), EventKind::PeriodDoubling, &A4);
    is_exact(two.iter(), EventKind::PeriodDoubling, &A6);
    is_exact(two.iter(), EventKind::Fold, &PERIOD_2_UPPER_FOLD);
    is_exact(two.iter(), EventKind::Fold, &PERIOD_2_LOWER_FOLD);
    is_exact(eight.iter(), EventKind::Fold, &PERIOD_8_FOLD);
}

/// Fig. 9a: a drive as large as the load, over a resonance and what is above and below it, from both ends.
#[test]
fn figure_9a_is_that_of_shooting() {
    let model = OneSidedLinear {
        drive: 1.0,
        ..MODEL
    };
    for [from, to] in [[0.4, 2.6], [2.6, 0.4]] {
        let request = FrequencyResponse::of(&model)
            .from(from)
            .to(to)
            .max_points(2000);
        let branch = request.clone().by(ContactEquation::new()).run().unwrap();
        let shot = request.by(Shooting::new()).run().unwrap();
        assert_eq!(branch.stopped, shot.stopped);
        let both = [&branch, &shot];
        for [one, other] in [both, [&shot, &branch]] {
            for event in &one.events {
                let found = same(other.events.iter(), event);
                let found = found.unwrap_or_else(|| panic!("{event} from {from}"));
                let apart = (found.point.value - event.point.value).abs();
                assert!(
                    apart <= 3.0 * (found.error + event.error),
                    "{found} {event}"
                );
            }
        }
        assert!(branch.turns.is_empty() && !branch.events.is_empty());
    }
}
