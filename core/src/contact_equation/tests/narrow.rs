//! Places of laws that are far narrower than a motion, and what a branch does while an extreme passes them.

use crate::{
    Branch, ContactEquation, Event, EventKind, FrequencyResponse, HarmonicBalance, Shooting,
};

/// Stated errors are no bounds: of two hundred values one may be off by more times as much.
const EXCEEDED: f64 = 3.0;

crate::oscillator! {
    /// A force that is there within a thousandth of the motion alone.
    Bump(x) {
        law bump(gap) { 0.8274/(1 + (gap/0.00104)^8) }
        1.381*ddot(x) + 0.01259*dot(x) + 1.885*x + 2/3*bump(2/3*x - 0.4515) = 1.13*cos(omega*t) - 0.5047;
    }
}

/// Two folds and two doublings lie within some widths of the place that the largest displacement passes there, and a step of ten
/// times that shows none of them: every method finds them both ways.
#[test]
fn events_in_a_narrow_place_are_found_both_ways_by_every_method() {
    let system = Bump {};
    let request = |from, to| FrequencyResponse::of(&system).from(from).to(to);
    let events = |branch: Branch| {
        let events = branch.events.iter();
        let known = |e: &Event| (e.point.value, e.kind, e.error);
        let mut events: Vec<_> = events.map(known).collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events
    };
    let mut found = Vec::new();
    for [from, to] in [[1.3, 1.7], [1.7, 1.3]] {
        let request = request(from, to);
        let solved = request.clone().by(ContactEquation::new()).run().unwrap();
        let moved = request.clone().by(Shooting::new()).run().unwrap();
        found.extend([events(solved), events(moved)]);
        // The balance locates folds.
        let balanced = request.by(HarmonicBalance::new()).run().unwrap();
        let folds = balanced.folds().map(|fold| [fold.point.value, fold.error]);
        let mut folds: Vec<[f64; 2]> = folds.collect();
        folds.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(folds.len(), 2);
        let of_first = found[0].iter().filter(|e| e.1 == EventKind::Fold);
        for (a, [value, error]) in of_first.zip(folds) {
            let apart = (a.0 - value).abs();
            assert!(
                apart <= EXCEEDED * (a.2 + error),
                "{a:?} {value} {error:.1e}"
            );
            assert!(error < 1e-6, "{value} {error:.1e}");
        }
    }
    for other in &found {
        assert_eq!(other.len(), 4, "{found:?}");
        for (a, b) in found[0].iter().zip(other) {
            assert!(a.1 == b.1 && (a.0 - b.0).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}
