//! Doublings of the period located by the harmonic balance itself.

use hertzian::flow::shooting::Side;
use hertzian::{EventKind, FrequencyResponse, Stop};

use crate::cascade::{A1, A4, A6, MODEL};
use crate::symmetry::{HARDENING, HARDENING_EVENTS, Hardening};

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
    let Stop::Joined { period: 2, value } = four.stopped else {
        panic!("{}", four.stopped);
    };
    assert!((value - A6.drive).abs() < 1e-3, "{value}");
}

/// Figure 2a: both asymmetric branches go from one point of broken symmetry to the other.
#[test]
fn the_balance_switches_to_orbits_without_the_symmetry() {
    let model = Hardening {
        zeta: 0.01,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model)
        .tolerance(1e-8)
        .from(0.45)
        .to(0.3);
    let branch = request.run().unwrap();
    let breaks = branch
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SymmetryBreaking);
    let breaks: Vec<_> = breaks.collect();
    for (event, exact) in breaks.iter().zip(HARDENING) {
        let error = (event.point.value - exact).abs();
        assert!(error < 1e-6, "{event} {error:.1e}");
    }
    let sides = [Side::One, Side::Other].map(|side| request.switch(breaks[0], side).unwrap());
    for side in &sides {
        let Stop::Joined { value, .. } = side.stopped else {
            panic!("{}", side.stopped);
        };
        assert!((value - HARDENING[1]).abs() < 1e-4, "{value}");
        let folds: Vec<_> = side.folds().collect();
        assert_eq!(folds.len(), 2);
        for (fold, (_, omega, peak_to_peak)) in folds.iter().zip(HARDENING_EVENTS) {
            assert!((fold.point.value - omega).abs() < 1e-6, "{fold}");
            assert!(
                (fold.point.peak_to_peak() - peak_to_peak).abs() < 1e-6,
                "{fold}"
            );
        }
    }
    let means = [&sides[0], &sides[1]].map(|side| side.points[5].motion().mean);
    assert!(
        (means[0] + means[1]).abs() < 1e-6 * means[0].abs().max(1e-3),
        "{means:?}"
    );
}
