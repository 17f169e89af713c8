//! Doublings of the period and crossings located by the harmonic balance itself, and the branches that begin there.

use hertzian::{Event, EventKind, FrequencyResponse, OrbitError, Side, Stop, System};
use hertzian_tests::{TwoMasses, nearest};

use crate::bifurcations::cascade::{A1, A4, A6, MODEL};
use crate::bifurcations::crossing::{AT, Pitchfork, Transcritical};
use crate::bifurcations::symmetry::{
    Events, HARDENING, HARDENING_EVENTS, Hardening, SOFTENING, SOFTENING_EVENTS, Softening,
};

/// The error is that of the harmonics left out: it is stated, and falls with the tolerance.
#[test]
fn period_1_doubles_in_the_balance() {
    let errors = [1e-6, 1e-8].map(|tolerance| {
        let request = FrequencyResponse::of(&MODEL).vary("drive").omega(1.0);
        let request = request.tolerance(tolerance).doublings(true);
        let branch = request.from(1.0).to(1.5).run().unwrap();
        let [event] = &branch.events[..] else {
            panic!("{:?}", branch.events);
        };
        assert_eq!(event.kind, EventKind::PeriodDoubling);
        assert!(event.test.abs() < 1e-10, "{event}");
        let error = (event.point.value - A1.drive).abs();
        assert!(error <= event.error, "{event} {error:.1e}");
        error
    });
    let [coarse, fine] = errors;
    assert!(
        coarse < 1e-5 && fine < 0.1 * coarse,
        "{coarse:.1e} {fine:.1e}"
    );
}

/// From period one over two to four, which joins A4 with A6. The errors are those of twenty harmonics per period.
#[test]
fn the_balance_switches_to_longer_periods() {
    let request = FrequencyResponse::of(&MODEL).vary("drive").omega(1.0);
    let request = request.harmonics(20).doublings(true).from(1.0).to(2.1);
    let one = request.run().unwrap();
    let doubling = one.events.first().unwrap();
    assert_eq!(doubling.kind, EventKind::PeriodDoubling);
    let two = request.switch(doubling, Side::One).unwrap();
    assert!(two.points.iter().all(|point| point.orbit.period == 2));
    let first = two.points[0].value;
    assert!((first - doubling.point.value).abs() < 1e-2, "{first}");
    let of_kind = |kind| two.events.iter().filter(move |event| event.kind == kind);
    let doublings: Vec<_> = of_kind(EventKind::PeriodDoubling).collect();
    assert!(doublings.len() >= 2, "{}", doublings.len());
    for (event, exact) in doublings.iter().zip([A4, A6]) {
        let error = (event.point.value - exact.drive).abs();
        assert!(error < 1e-4 && error <= event.error, "{event} {error:.1e}");
    }
    let fold = of_kind(EventKind::Fold).next().unwrap();
    assert!(
        (fold.point.value - 2.009_554_757_004_067).abs() < 1e-4,
        "{fold}"
    );
    let four = request.clone().stability(false).doublings(false);
    let four = four.switch(doublings[0], Side::One).unwrap();
    assert!(four.points.iter().all(|point| point.orbit.period == 4));
    let Stop::Joined {
        period: 2, value, ..
    } = four.stopped
    else {
        panic!("{}", four.stopped);
    };
    assert!((value - A6.drive).abs() < 1e-3, "{value}");
}

/// Both asymmetric branches go from one point of broken symmetry to the other, through all events that are known. They are followed from
/// events found by odd harmonics, and from crossings found by all.
fn assert_asymmetric_branches(
    request: &FrequencyResponse,
    event: &Event,
    exact: [f64; 2],
    (events, unlisted): (Events<'_>, usize),
) {
    let sides = [Side::One, Side::Other].map(|side| request.switch(event, side).unwrap());
    for side in &sides {
        let Stop::Joined {
            period: 1, value, ..
        } = side.stopped
        else {
            panic!("{}", side.stopped);
        };
        let joined = exact
            .iter()
            .find(|exact| (event.point.value - *exact).abs() > 1e-3);
        assert!((value - joined.unwrap()).abs() < 1e-6, "{value}");
        for (kind, omega, peak_to_peak) in events {
            let event = nearest(side.events(*kind), *omega, |event| event.point.value).unwrap();
            let error = (event.point.value - omega).abs();
            assert!(
                error < 1e-6 && error <= 3.0 * event.error,
                "{event} {error:.1e}"
            );
            let error = (event.point.peak_to_peak() - peak_to_peak).abs();
            assert!(error < 1e-6, "{event} {error:.1e}");
        }
        let found =
            [EventKind::Fold, EventKind::PeriodDoubling].map(|kind| side.events(kind).count());
        assert_eq!(
            found.iter().sum::<usize>(),
            events.len() + unlisted,
            "{:?}",
            side.events
        );
    }
    // They are mirror images.
    let means = [&sides[0], &sides[1]].map(|side| side.points[5].motion().mean.unwrap());
    assert!(
        (means[0] + means[1]).abs() < 1e-6 * means[0].abs().max(1e-3),
        "{means:?}"
    );
}

fn assert_symmetry_breaks(
    system: &dyn System,
    [from, to]: [f64; 2],
    exact: [f64; 2],
    events: (Events<'_>, usize),
) {
    let request = FrequencyResponse::of(system).tolerance(1e-7);
    let request = request.stability(false).doublings(true);
    let request = request.from(from).to(to);
    let branch = request.run().unwrap();
    let breaks: Vec<_> = branch.events(EventKind::SymmetryBreaking).collect();
    assert_eq!(breaks.len(), 2);
    for (event, exact) in breaks.iter().zip(exact) {
        let error = (event.point.value - exact).abs();
        assert!(error < 1e-6 && error <= event.error, "{event} {error:.1e}");
    }
    assert_asymmetric_branches(&request, breaks[0], exact, events);
}

#[test]
fn symmetry_breaks_in_figure_2a_by_the_balance() {
    let (zeta, drive) = (0.01, 0.1);
    let model = Hardening { zeta, drive };
    assert_symmetry_breaks(&model, [0.45, 0.3], HARDENING, (HARDENING_EVENTS, 0));
}

/// The list of the softening spring lacks two folds that are 1.3e-4 apart.
#[test]
fn symmetry_breaks_in_figure_2b_by_the_balance() {
    let (zeta, drive) = (0.01, 0.1);
    let model = Softening { zeta, drive };
    assert_symmetry_breaks(&model, [1.05, 0.82], SOFTENING, (SOFTENING_EVENTS, 2));
}

/// Figure 2a again: with all harmonics the broken symmetry is a crossing, and the same branches lead away from either.
#[test]
fn the_balance_switches_where_the_symmetric_branch_is_crossed() {
    let (zeta, drive) = (0.01, 0.1);
    let model = Hardening { zeta, drive };
    let request = FrequencyResponse::of(&model).symmetric(false);
    let request = request.bifurcations(true).from(0.41).to(0.34);
    let branch = request.run().unwrap();
    let crossings: Vec<_> = branch.events(EventKind::BranchPoint).collect();
    assert_eq!(crossings.len(), 2);
    for crossing in crossings {
        assert_asymmetric_branches(&request, crossing, HARDENING, (HARDENING_EVENTS, 0));
    }
}

/// Both directions of the branch that crosses another one at [`AT`], whose orbits are known.
fn assert_crossed(system: &dyn System, kind: EventKind, expected: impl Fn(f64, f64) -> f64) {
    let request = FrequencyResponse::of(system).bifurcations(true);
    let request = request.from(2.0).to(2.6);
    let branch = request.run().unwrap();
    let crossing = branch.events(kind).next().unwrap();
    let error = (crossing.point.value - AT).abs();
    assert!(
        error < 1e-9 && error <= crossing.error,
        "{crossing} {error:.1e}"
    );
    let branches = [Side::One, Side::Other].map(|side| request.switch(crossing, side).unwrap());
    let signs = [&branches[0], &branches[1]]
        .map(|branch| branch.points[0].orbit.series(1).unwrap()[0].signum());
    assert_eq!(signs[0], -signs[1]);
    for (branch, sign) in branches.iter().zip(signs) {
        assert!(matches!(
            branch.stopped,
            Stop::ReachedEnd | Stop::LeftAtStart
        ));
        for point in &branch.points {
            let y = point.orbit.series(1).unwrap();
            let error = (y[0] - expected(point.value, sign)).abs();
            assert!(error < 1e-8, "{} {error:.1e}", point.value);
            assert!(y[1..].iter().all(|x| x.abs() < 1e-8));
        }
    }
}

#[test]
fn the_balance_switches_where_branches_cross() {
    assert_crossed(
        &Pitchfork { at: AT },
        EventKind::SymmetryBreaking,
        |omega, side| side * (omega - AT).sqrt(),
    );
    assert_crossed(
        &Transcritical { at: AT },
        EventKind::BranchPoint,
        |omega, _| AT - omega,
    );
}

/// At a fold no other branch begins.
#[test]
fn there_is_nothing_to_switch_to_at_a_fold() {
    let (zeta, drive) = (0.01, 0.1);
    let model = Hardening { zeta, drive };
    let request = FrequencyResponse::of(&model).stability(false);
    let request = request.from(0.7).to(1.7);
    let branch = request.run().unwrap();
    let fold = branch.folds().next().unwrap();
    let error = request.switch(fold, Side::One).unwrap_err();
    assert!(
        matches!(error.downcast_ref(), Some(OrbitError::NoBranch { .. })),
        "{error}"
    );
}

/// At 0.73878 the period of two masses with a stop doubles, by an independent computation with five digits. The orbit in contact at
/// 0.7348 is one of several there, with a core of harmonics that has to grow.
#[test]
fn a_doubling_is_found_from_an_orbit_beside_it() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).harmonics(60);
    let to = request.clone().stability(false).from(0.55).to(0.7348);
    let to = to.run().unwrap();
    let last = to.points.last().unwrap();
    assert_eq!(last.value, 0.7348);
    let branch = request.bifurcations(true).near_orbit(&last.orbit);
    let branch = branch.from(0.7348).to(0.75).run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    let [doubling] = &branch.events[..] else {
        panic!("{:?}", branch.events);
    };
    assert_eq!(doubling.kind, EventKind::PeriodDoubling);
    let error = (doubling.point.value - 0.73878).abs();
    assert!(
        error < 5e-6 + doubling.error && doubling.error < 2e-4,
        "{doubling}"
    );
}
