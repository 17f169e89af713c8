//! The one-sided oscillator with exponent one, damping ratio 0.032, load 1 and frequency 1: Wang et al. (2021), Fig. 8a.
//!
//! Exact values: computed independently of this project from the closed-form flow between switches, in 80-bit arithmetic,
//! confirmed with 60 digits (`amplitude_sweep` of the reference values).

use std::ops::ControlFlow;

use hertzian::bifurcation::{Bifurcations, Diagram, Origin, Reason};
use hertzian::time;
use hertzian::time::stroboscope::Stroboscope;
use hertzian::{Chosen, Event, EventKind, OrbitMethod, Stop};
use hertzian_tests::{OneSidedLinear, nearest};

pub const MODEL: OneSidedLinear = OneSidedLinear {
    zeta: 0.032,
    load: 1.0,
    drive: 0.1,
};

/// The drive at a bifurcation, and the multiplier that is not plus or minus one.
pub struct Exact {
    pub drive: f64,
    pub multiplier: f64,
}

pub const A1: Exact = Exact {
    drive: 1.282_584_167_663_767,
    multiplier: -0.817_945_968_917_093,
};
pub const A4: Exact = Exact {
    drive: 1.531_044_135_499_983,
    multiplier: -0.635_978_721_580_046,
};
pub const A6: Exact = Exact {
    drive: 1.880_077_405_264_828,
    multiplier: -0.639_583_443_698_677,
};
pub const PERIOD_2_UPPER_FOLD: Exact = Exact {
    drive: 2.009_554_757_004_067,
    multiplier: 0.669_036_304_237_398,
};
pub const PERIOD_2_LOWER_FOLD: Exact = Exact {
    drive: 0.294_528_806_187_216,
    multiplier: 0.795_091_307_354_537,
};
pub const PERIOD_8_FOLD: Exact = Exact {
    drive: 1.779_836_025_884_334,
    multiplier: 0.183_740_023_455_888,
};

pub fn diagram(depth: usize) -> Diagram {
    diagram_by(Chosen::new(), depth)
}

pub fn diagram_by<M: OrbitMethod>(method: M, depth: usize) -> Diagram {
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(0.1).to(2.0).depth(depth).by(method);
    request.run().unwrap()
}

/// One of the events is the exact one, as close as the doubled precision of the flow allows.
fn assert_found<'e>(
    events: impl Iterator<Item = &'e Event>,
    kind: EventKind,
    exact: &Exact,
) -> &'e Event {
    let of_kind = events.filter(|event| event.kind == kind);
    let nearest = nearest(of_kind, exact.drive, |event| event.point.value).unwrap();
    let error = (nearest.point.value - exact.drive).abs();
    assert!(error < 1e-11, "{nearest}: {error:.1e}");
    assert!(error <= nearest.error, "{nearest}: {error:.1e}");
    let critical = if kind == EventKind::Fold { 1.0 } else { -1.0 };
    let multipliers = &nearest.point.stability.multipliers;
    for (found, expected) in multipliers.iter().zip([critical, exact.multiplier]) {
        assert!(
            (found - expected).norm() < 1e-9,
            "{nearest}: {multipliers:?}"
        );
    }
    nearest
}

/// From a small drive, with nothing else given: periods one, two, four and eight, the folds beyond the end of the range too.
#[test]
fn the_cascade_is_followed_by_itself() {
    let diagram = diagram(3);
    let events = |period: usize| {
        let branches = diagram.branches.iter();
        let branches = branches.filter(move |branch| branch.period() == period);
        branches.flat_map(|branch| &branch.branch.events)
    };
    assert_found(events(1), EventKind::PeriodDoubling, &A1);
    assert_found(events(2), EventKind::PeriodDoubling, &A4);
    assert_found(events(2), EventKind::PeriodDoubling, &A6);
    let fold = assert_found(events(2), EventKind::Fold, &PERIOD_2_UPPER_FOLD);
    assert!(fold.point.value > 2.0);
    assert_found(events(2), EventKind::Fold, &PERIOD_2_LOWER_FOLD);
    assert_found(events(8), EventKind::Fold, &PERIOD_8_FOLD);
    for branch in &diagram.branches {
        let expected = 1 << branch.depth;
        assert_eq!(branch.period(), expected);
        assert!(
            branch
                .branch
                .points
                .iter()
                .all(|c| c.orbit.period == expected)
        );
        if let Origin::Event {
            branch: parent,
            event,
            ..
        } = branch.origin
        {
            let parent = &diagram.branches[parent].branch.events[event];
            assert_eq!(parent.kind, EventKind::PeriodDoubling);
            let first = branch.branch.points[0].value;
            assert!(
                (first - parent.point.value).abs() < 1e-2,
                "{first} {parent}"
            );
        }
    }
}

/// Beside a touch the branch of period four turns twice within 6.5e-7 of the drive: two folds, which closed-form flows between switches have at
/// the extremes of the drive over the displacement (`brentq` for switches, `fsolve` for orbits, a polynomial through nine of them; scipy).
#[test]
fn folds_on_both_sides_of_a_touch_are_found() {
    let diagram = diagram(2);
    let branches = diagram.branches.iter();
    let four = branches.filter(|branch| branch.period() == 4);
    let folds: Vec<f64> = four
        .flat_map(|branch| branch.branch.folds())
        .map(|event| event.point.value)
        .collect();
    for exact in [1.532_673_386_71, 1.532_674_035_26] {
        let nearest = nearest(folds.iter(), exact, |fold| **fold).unwrap();
        assert!((nearest - exact).abs() < 3e-11, "{nearest} {exact}");
    }
}

/// Period four joins A4 with A6, so it is followed once; what is left out is said.
#[test]
fn what_is_known_is_not_followed_again() {
    let diagram = diagram(2);
    let [_, two, four, ..] = &diagram.branches[..] else {
        panic!("{} branches", diagram.branches.len());
    };
    let Stop::Joined { period: 2, .. } = four.branch.stopped else {
        panic!("{}", four.branch.stopped);
    };
    let joint = four.branch.events.last().unwrap();
    assert_eq!(joint.kind, EventKind::BranchPoint);
    let error = (joint.point.value - A6.drive).abs();
    assert!(error < 1e-11 && error <= joint.error, "{joint} {error:.1e}");
    let at_a6 = two
        .branch
        .events
        .iter()
        .position(|event| (event.point.value - A6.drive).abs() < 1e-9);
    let known = diagram.omitted.iter().find(|omitted| omitted.branch == 1);
    let known = known.unwrap();
    assert_eq!(Some(known.event), at_a6);
    assert_eq!(known.reason, Reason::BranchEnds { branch: 2 });
    let deep = diagram.omitted.iter().filter(|o| o.reason == Reason::Depth);
    // Four on the first branch of period four, and one on that which begins beyond the lower fold.
    assert_eq!(deep.count(), 5);
    assert_eq!(
        diagram.branches.iter().map(|branch| branch.depth).max(),
        Some(2)
    );
}

/// Each branch begins where the one before it doubles; that of period 16 is confirmed by the map itself.
#[test]
fn as_far_as_period_16() {
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let diagram = request.from(1.2).to(1.6).depth(4).run().unwrap();
    let first = |period: usize| {
        let mut branches = diagram.branches.iter();
        branches.find(|branch| branch.period() == period).unwrap()
    };
    for period in [2, 4, 8, 16] {
        let doubles = first(period / 2).branch.events(EventKind::PeriodDoubling);
        let begins = first(period).branch.points[0].value;
        let apart = doubles.map(|event| (event.point.value - begins).abs());
        let nearest = apart.fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-2, "{period} {nearest:.1e}");
    }
    let cycles = &first(16).branch.points;
    let cycle = &cycles[cycles.len() / 2];
    let model = OneSidedLinear {
        drive: cycle.value,
        ..MODEL
    };
    let mut map = Stroboscope::new(time::of(&model, 1.0, 1e-10).unwrap());
    let mut state = cycle.orbit.state();
    let apart = |state: &[f64]| {
        (state[0] - cycle.orbit.state()[0]).hypot(state[1] - cycle.orbit.state()[1])
    };
    for passed in 1..=16 {
        map.map(&mut state).unwrap();
        let returned = apart(&state) < 1e-9;
        assert_eq!(returned, passed == 16, "{passed} {:.1e}", apart(&state));
    }
}

/// The whole structure of figure 8a, on one core: 2 seconds were allowed for it. Only where that was asked for, on a machine that
/// does nothing else.
#[test]
fn figure_8a_in_two_seconds() {
    let elapsed = diagram(3).elapsed.as_secs_f64();
    println!("figure 8a: {elapsed:.2} s");
    if std::env::var_os("HERTZIAN_SECONDS").is_some() {
        assert!(elapsed < 2.0, "{elapsed} s");
    }
}

#[test]
fn a_budget_is_kept_and_said() {
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(0.1).to(2.0);
    let few = request.clone().max_branches(2).run().unwrap();
    assert_eq!(few.branches.len(), 2);
    assert!(few.omitted.iter().all(|o| o.reason == Reason::Budget));
    assert_eq!(few.omitted.len(), 3);
    let short = request.max_points(100).run().unwrap();
    let points = short
        .branches
        .iter()
        .map(|branch| branch.branch.points.len());
    assert!(points.sum::<usize>() <= 100);
    let said = short.omitted.iter().any(|o| o.reason == Reason::Budget);
    let cut = short.branches.iter().any(|branch| {
        branch.branch.stopped
            == Stop::PointLimit {
                points: branch.branch.points.len(),
            }
    });
    assert!(said || cut);
}

/// The first branch leaves half of the orbits to those that begin at it, and has all that nobody else needs.
#[test]
fn a_first_branch_leaves_orbits_to_others() {
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(0.1).to(2.0).largest_step(7e-4);
    let alone = request.clone().depth(0);
    let whole = alone.run().unwrap();
    let count = whole.branches[0].branch.points.len();
    // Of fewer it has all.
    assert!(count > 2000);
    let enough = alone.max_points(count).run().unwrap();
    assert_eq!(enough.branches.len(), 1);
    assert_eq!(
        enough.branches[0].branch.points,
        whole.branches[0].branch.points
    );
    assert_eq!(
        enough.branches[0].branch.events,
        whole.branches[0].branch.events
    );
    assert_eq!(enough.branches[0].branch.stopped, Stop::ReachedEnd);
    assert_eq!(enough.omitted.len(), whole.omitted.len());
    let most = 2 * (count - 1);
    let shared = request.depth(1).max_points(most).run().unwrap();
    let [first, others @ ..] = &shared.branches[..] else {
        panic!("no branch");
    };
    assert!(!others.is_empty());
    let others = others.iter().map(|branch| branch.branch.points.len());
    assert!(others.sum::<usize>() + first.branch.points.len() <= most);
}

/// A caller that stops in the second branch gets the first one and that much of the second; the rest is named.
#[test]
fn an_interrupted_search_keeps_what_it_has() {
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(1.0).to(1.6).depth(2);
    let diagram = request.run_with(|progress| {
        let beyond = |point: &hertzian::Point| point.orbit.period == 2 && point.value > 1.4;
        if progress.point.is_some_and(beyond) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let diagram = diagram.unwrap();
    let [one, two] = &diagram.branches[..] else {
        panic!("{} branches", diagram.branches.len());
    };
    assert_eq!(one.branch.stopped, Stop::ReachedEnd);
    assert_eq!(two.branch.stopped, Stop::Interrupted);
    assert!(two.branch.points.last().unwrap().value > 1.4);
    let interrupted = |reason: &Reason| *reason == Reason::Interrupted;
    assert!(diagram.omitted.iter().all(|left| interrupted(&left.reason)));
}
