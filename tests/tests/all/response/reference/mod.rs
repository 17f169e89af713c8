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

use hertzian::{Branch, EventKind, FrequencyResponse, OrbitMethod};

/// An event of a branch, by either method.
#[derive(Debug, Clone)]
struct Found {
    kind: EventKind,
    value: f64,
    error: f64,
}

/// A request from either end of a range, by one method.
fn from_either_end<M: OrbitMethod + Clone>(
    request: &FrequencyResponse<M>,
    [from, to]: [f64; 2],
) -> [Branch; 2] {
    [[from, to], [to, from]].map(|[from, to]| request.clone().from(from).to(to).run().unwrap())
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

/// As near to a touch at which the branch turns a fold may be one event with it, and others beside any touch too.
const ONE_WITH_TOUCH: f64 = 2e-8;

/// The same where what is beside a touch may be one event with it.
fn all_found_or_touched(found: &[Found], known: &[(EventKind, f64)], digits: f64) {
    let touched = |value: f64| {
        found.iter().any(|event| {
            let touches = matches!(event.kind, EventKind::Grazing { .. });
            touches && (event.value - value).abs() <= ONE_WITH_TOUCH
        })
    };
    let apart = known.iter().filter(|(_, value)| !touched(*value));
    let apart: Vec<(EventKind, f64)> = apart.copied().collect();
    all_found(found, &apart, digits);
}
