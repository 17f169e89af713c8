//! Branches that begin where a symmetry breaks.

use crate::{
    Branch, ContactEquation, EventKind, FrequencyResponse, OrbitMethodKind, Shooting, Side,
};

crate::oscillator! {
    /// Equal stops on both sides.
    Mirrored(x) {
        law stop(gap) { gap > 0 => 4*gap^1.5, else => 0 }
        ddot(x) + 0.08*dot(x) + x + stop(x - 0.4) - stop(-x - 0.4) = cos(omega*t);
    }
}

/// Kinds and values of the events of a branch.
fn events(branch: &Branch) -> Vec<(EventKind, f64)> {
    let events = branch.events.iter();
    events
        .map(|event| (event.kind, event.point.value))
        .collect()
}

/// Beside the event the orbit that has the symmetry is as near as that which has not: the branch is one of the latter, with the events that shooting
/// finds on it.
#[test]
fn what_begins_where_a_symmetry_breaks_does_not_have_it() {
    let request = FrequencyResponse::of(&Mirrored {}).from(1.2).to(0.6);
    let branch = request.clone().by(ContactEquation::new()).run().unwrap();
    let broken = branch.events(EventKind::SymmetryBreaking);
    let broken: Vec<_> = broken.collect();
    assert_eq!(broken.len(), 2);
    for event in broken {
        for side in [Side::One, Side::Other] {
            let own = branch.switch(event, side).unwrap();
            assert_eq!(own.method(), Some(OrbitMethodKind::ContactEquation));
            assert!(own.points.iter().all(|point| point.orbit.parts == 1));
            let aside = own.points.iter().map(|point| {
                let motion = &point.observed.motions[0];
                (motion.minimum + motion.maximum).abs() / motion.peak_to_peak()
            });
            assert!(aside.fold(0.0, f64::max) > 0.05);
            let exact = request.clone().by(Shooting::new().tolerance(1e-12));
            let exact = exact.switch(event, side).unwrap();
            let (own, exact) = (events(&own), events(&exact));
            assert_eq!(own.len(), exact.len(), "{own:?} {exact:?}");
            for (own, exact) in own.iter().zip(&exact) {
                assert_eq!(own.0, exact.0);
                assert!((own.1 - exact.1).abs() < 1e-8, "{own:?} {exact:?}");
            }
        }
    }
}
