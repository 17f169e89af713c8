//! Models of the literature against events of the differential equations that were computed by other programs.
//!
//! The events are from event-driven shooting with an exact flow or DOP853 in extended precision, confirmed each by a second method
//! as said beside it (harmonic balance with Hill's determinant, Chebyshev collocation); none of them knows this library. Digits
//! are those that both agree in. One run over the range finds every event, and each is within its stated error.

mod beam;
mod bearing;
mod chain;
mod gears;
mod two_masses;

use hertzian::{Branch, EventKind};

/// An event of a branch, by either method.
#[derive(Debug, Clone)]
struct Found {
    kind: EventKind,
    value: f64,
    error: f64,
}

fn of_shooting(branch: &Branch) -> Vec<Found> {
    let events = branch.events.iter().map(|event| Found {
        kind: event.kind,
        value: event.point.value,
        error: event.error,
    });
    events.collect()
}

/// Every known event is found, within the error that is stated for it and the digits of what is known.
fn all_found(found: &[Found], known: &[(EventKind, f64)], digits: f64) {
    for (kind, value) in known {
        let alike = found.iter().filter(|event| event.kind == *kind);
        let Some(event) = hertzian_tests::nearest(alike, *value, |event| event.value) else {
            panic!("{kind} at {value} is missing among {found:#?}");
        };
        let apart = (event.value - value).abs();
        assert!(
            apart <= event.error + digits,
            "{kind} at {value}: {apart:.1e} away, with {:.1e} stated, among {found:#?}",
            event.error
        );
    }
}
