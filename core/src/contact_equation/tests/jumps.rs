//! Forces that jump at a level, against shooting: branches go through corners, or turn in them.

use super::{derivatives_are_those_of_differences, errors_hold, events_agree};
use crate::{ContactEquation, EventKind, FrequencyResponse};

crate::oscillator! {
    /// A tip that sticks: its force jumps where it comes off.
    Adhesive(x) {
        param adhesion;
        law tip(gap) { gap > 0 => gap^1.5 - adhesion, else => 0 }
        ddot(x) + 0.04*dot(x) + 0.05*x + tip(x) = 1 + 0.2*cos(omega*t);
    }
}

crate::oscillator! {
    /// A stop that is pressed on.
    Preloaded(x) {
        param preload;
        law stop(gap) { gap > 0 => 4*gap + preload, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.5) = 0.2 + 0.5*cos(omega*t);
    }
}

crate::oscillator! {
    /// Two of these, with different loads on them.
    Between(x) {
        param load;
        law stops(gap) {
            gap > 1 => 5*(gap - 1) + 0.1,
            -1 <= gap && gap <= 1 => 0,
            else => 5*(gap + 1) - 0.1,
        }
        ddot(x) + 0.06*dot(x) + x + stops(x) = load + 0.6*cos(omega*t);
    }
}

crate::oscillator! {
    /// The one mass hits a stop, the other one comes off a tip.
    Pair(x, y) {
        law stop(gap) { gap > 0 => 6*gap + 0.1*gap*dot(gap) + 0.2, else => 0 }
        law tip(gap) { gap > 0 => 3*gap^1.5 - 0.1, else => 0 }
        ddot(x) + 0.1*dot(x) + x + (x - y) + stop(x - 0.4) = 0.4*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.5*y - (x - y) - tip(-y) = 0.2;
    }
}

const ADHESIVE: Adhesive = Adhesive { adhesion: 0.3 };
const PRELOADED: Preloaded = Preloaded { preload: 0.3 };
const BETWEEN: Between = Between { load: 0.1 };

#[test]
fn matrices_are_those_of_differences() {
    derivatives_are_those_of_differences(&PRELOADED, None, 1.2, 1);
    derivatives_are_those_of_differences(&PRELOADED, Some("preload"), 1.2, 1);
    derivatives_are_those_of_differences(&Pair {}, None, 1.1, 1);
}

#[test]
fn orbits_are_those_of_shooting_and_their_errors_hold() {
    let by = ContactEquation::new;
    errors_hold(&FrequencyResponse::of(&PRELOADED).from(0.7).to(1.2).by(by()));
    errors_hold(&FrequencyResponse::of(&Pair {}).from(0.8).to(1.4).by(by()));
}

/// Touches of either kind, from either side: the issue of a branch that was lost on both sides of one is the first of these.
#[test]
fn branches_go_through_corners_as_by_shooting() {
    for [from, to] in [[0.5, 1.6], [1.6, 0.5]] {
        events_agree(&FrequencyResponse::of(&ADHESIVE).from(from).to(to));
    }
    for [from, to] in [[0.5, 2.5], [2.5, 0.5]] {
        events_agree(&FrequencyResponse::of(&PRELOADED).from(from).to(to));
        events_agree(&FrequencyResponse::of(&BETWEEN).from(from).to(to));
    }
    let varied = FrequencyResponse::of(&PRELOADED).vary("preload").omega(1.1);
    events_agree(&varied.from(0.0).to(1.0));
}

#[test]
fn several_coordinates_and_contacts_go_through_corners() {
    for [from, to] in [[0.4, 2.5], [2.5, 0.4]] {
        events_agree(&FrequencyResponse::of(&Pair {}).from(from).to(to));
    }
}

/// Equal stops: the part of the period after which the orbit comes back is followed, and one of two touches at once is found.
#[test]
fn equal_stops_are_touched_at_once() {
    let model = Between { load: 0.0 };
    let request = FrequencyResponse::of(&model).from(2.5).to(0.6);
    events_agree(&request);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    let touches = branch
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Grazing { .. }));
    assert!(touches.count() > 0);
}
