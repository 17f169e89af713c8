//! Systems whose stiffness varies in time, against shooting.

use super::{derivatives_are_those_of_differences, errors_hold, events_agree};
use crate::{ContactEquation, EventKind, FrequencyResponse};

crate::oscillator! {
    /// A mesh whose stiffness varies, with a stop.
    Mesh(x) {
        param variation;
        law stop(g) { g > 0 => 4*g + 0.1*g*dot(g), else => 0 }
        ddot(x) + 0.08*dot(x) + (1 + variation*cos(omega*t))*x + stop(x - 0.6) = 0.2 + 0.1*cos(omega*t);
    }
}

crate::oscillator! {
    /// Two coordinates that a stiffness couples with two harmonics, and a contact of exponent 3/2.
    Shaft(x, y) {
        param variation;
        law hertz(g) { g > 0 => 5*g^1.5, else => 0 }
        let pull = variation*(cos(2*omega*t) + 0.5*sin(omega*t))*(x - y);
        ddot(x) + 0.1*dot(x) + x + (x - y) + pull = 0.3*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.5*y - (x - y) - pull - hertz(-y - 0.2) = 0.1*sin(2*omega*t);
    }
}

crate::oscillator! {
    /// Nothing but the stiffness moves it.
    Mathieu(x) {
        param variation;
        ddot(x) + 0.1*dot(x) + (1 + variation*cos(omega*t))*x = 0.3*cos(omega*t);
    }
}

#[test]
fn matrices_are_those_of_differences() {
    let mesh = Mesh { variation: 0.3 };
    derivatives_are_those_of_differences(&mesh, None, 0.7, 1);
    derivatives_are_those_of_differences(&mesh, Some("variation"), 0.7, 2);
    let shaft = Shaft { variation: 0.2 };
    derivatives_are_those_of_differences(&shaft, None, 0.9, 2);
    derivatives_are_those_of_differences(&shaft, Some("variation"), 0.9, 1);
}

#[test]
fn orbits_are_those_of_shooting_and_their_errors_hold() {
    let (mesh, shaft) = (Mesh { variation: 0.3 }, Shaft { variation: 0.2 });
    let by = ContactEquation::new;
    errors_hold(&FrequencyResponse::of(&mesh).from(0.6).to(1.2).by(by()));
    errors_hold(&FrequencyResponse::of(&shaft).from(0.6).to(1.2).by(by()));
    let varied = FrequencyResponse::of(&mesh).vary("variation").omega(0.8);
    errors_hold(&varied.from(0.0).to(0.6).by(by()));
}

#[test]
fn events_are_those_of_shooting() {
    let (mesh, shaft) = (Mesh { variation: 0.3 }, Shaft { variation: 0.2 });
    events_agree(&FrequencyResponse::of(&mesh).from(0.4).to(2.2));
    events_agree(&FrequencyResponse::of(&shaft).from(0.5).to(1.6));
}

/// The first region of instability of an oscillator with damping, twice its frequency, ends where a multiplier is at minus one: both
/// methods say at the same values.
#[test]
fn a_parametric_resonance_is_a_pair_of_doublings() {
    let mathieu = Mathieu { variation: 0.6 };
    let request = FrequencyResponse::of(&mathieu).from(1.5).to(2.6);
    events_agree(&request);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    let kinds: Vec<_> = branch.events.iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [EventKind::PeriodDoubling; 2]);
}
