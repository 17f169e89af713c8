//! Forces whose slopes jump where a rate is zero: orbits, errors and events against shooting, which ends steps there.

use super::events_agree;
use crate::numeric::spectrum::distance;
use crate::system::System;
use crate::{Branch, ContactEquation, FrequencyResponse, Shooting, Stop};

crate::oscillator! {
    /// A contact with damping that does not pull, and a damper in one direction.
    Kinked(x) {
        law stop(gap) { gap > 0 => max(0, 3*gap + 4*gap*dot(gap)), else => 0 }
        law damper(gap) { 0.4*max(0, dot(gap)) }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.3) + damper(x) = 0.8*cos(omega*t);
    }
}

crate::oscillator! {
    /// A drag with the square of the rate: the second derivative of the force jumps.
    Drag(x) {
        law drag(gap) { 0.01*abs(dot(gap))*dot(gap) }
        ddot(x) + 0.009*dot(x) + x + drag(x) = 1.5*cos(omega*t) + 0.6*sin(3*omega*t);
    }
}

crate::oscillator! {
    /// Two equal masses, and a damper in one direction between them, which has nothing to do.
    Twins(x, y) {
        law damper(gap) { max(0, dot(gap)) }
        law stop(gap) { gap > 0 => 2*gap^1.5, else => 0 }
        ddot(x) + 0.1*dot(x) + x + damper(x - y) + stop(x - 0.4) = 0.3*cos(omega*t);
        ddot(y) + 0.1*dot(y) + y - damper(x - y) + stop(y - 0.4) = 0.3*cos(omega*t);
    }
}

fn errors_hold(system: &dyn System, range: [f64; 2], tolerance: f64) -> Branch {
    let [from, to] = range;
    let request = FrequencyResponse::of(system).from(from).to(to);
    let request = request.tolerance(tolerance);
    let branch = request.clone().by(ContactEquation::new()).run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    let exact = FrequencyResponse::of(system).by(Shooting::new().tolerance(1e-13));
    for point in branch.points.iter().step_by(9) {
        let there = exact.clone().near_orbit(&point.orbit).orbit(point.value);
        let there = there.unwrap();
        let error = (point.peak_to_peak() / there.peak_to_peak() - 1.0).abs();
        let stated = point.error.unwrap();
        assert!(stated < 2.0 * tolerance, "{}: {stated:e}", point.value);
        assert!(
            error < stated + 1e-13,
            "{}: {error:e} {stated:e}",
            point.value
        );
        let [own, of_truth] = [point, &there].map(|point| &point.stability.multipliers);
        let apart = distance(own, of_truth);
        // Those of shooting err as well, by little.
        let [stated, beside] = [point, &there].map(|point| point.stability.error);
        assert!(beside < 1e-9, "{}: {beside:e}", point.value);
        let stated = stated + beside;
        assert!(
            apart < stated + 1e-12,
            "{}: {apart:e} {stated:e}",
            point.value
        );
    }
    branch
}

#[test]
fn errors_beside_kinks_hold() {
    for tolerance in [1e-6, 1e-9] {
        let kinked = errors_hold(&Kinked {}, [1.4, 0.65], tolerance);
        assert!(kinked.points.len() < 150);
        errors_hold(&Drag {}, [0.48, 0.4], tolerance);
    }
}

#[test]
fn events_beside_kinks_are_those_of_shooting() {
    let model = Kinked {};
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let request = FrequencyResponse::of(&model).from(0.6).to(1.4);
        events_agree(&request.tolerance(tolerance));
    }
}

/// Its multipliers are not defined: what is between the masses is linear on neither side.
#[test]
fn a_rate_that_is_zero_but_for_rounding_has_no_kinks() {
    let request = FrequencyResponse::of(&Twins {}).stability(false);
    let branch = request.clone().from(0.7).to(1.4).by(ContactEquation::new());
    let branch = branch.run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    assert!(branch.points.len() < 200, "{}", branch.points.len());
    let exact = request.by(Shooting::new().tolerance(1e-13));
    for point in branch.points.iter().step_by(9) {
        let there = exact.clone().near_orbit(&point.orbit).orbit(point.value);
        let there = there.unwrap();
        let error = (point.peak_to_peak() / there.peak_to_peak() - 1.0).abs();
        let stated = point.error.unwrap();
        assert!(stated < 1e-6 && error < stated + 1e-13, "{}", point.value);
    }
}

crate::oscillator! {
    /// Two equal stops and a drag on both sides: `-x(t + T/2)` is a motion, too.
    Even(x) {
        law drag(gap) { 0.1*abs(dot(gap))*dot(gap) }
        law stop(gap) { gap > 0.5 => 3*(gap - 0.5)^1.5, -0.5 <= gap <= 0.5 => 0, gap < -0.5 => -(3*(-gap - 0.5)^1.5) }
        ddot(x) + 0.05*dot(x) + x + drag(x) + stop(x) = 0.5*cos(omega*t);
    }
}

/// An orbit that comes back mirrored after half of a period has one extreme in that half: its error is of both.
#[test]
fn errors_of_mirrored_orbits_beside_kinks_hold() {
    errors_hold(&Even {}, [0.9, 1.5], 1e-6);
    let request = FrequencyResponse::of(&Even {}).from(0.9).to(1.5);
    let branch = request.accuracy_of("x").by(ContactEquation::new());
    let branch = branch.run().unwrap();
    assert!(branch.points.len() < 150);
    let mut errors = branch.points.iter().map(|point| point.error.unwrap());
    assert!(errors.all(|error| error < 1e-6));
}

crate::oscillator! {
    /// Dry friction, rounded over a small part of the rates.
    Rounded(x) {
        param width > 0;
        law friction(gap) { 0.3*tanh(dot(gap)/width) }
        law stop(gap) { gap > 0 => 2*gap^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + x + friction(x) + stop(x - 0.4) = cos(omega*t) + 0.3*cos(2*omega*t);
    }
}

/// A slope that is steep for a moment is seen by the multipliers: what is stated of them holds, and is small.
#[test]
fn errors_beside_a_steep_rate_hold() {
    for width in [1e-1, 1e-2, 1e-3, 1e-4] {
        let model = Rounded { width };
        let branch = errors_hold(&model, [1.6, 1.4], 1e-6);
        assert!(
            branch.points.len() < 100,
            "{width}: {}",
            branch.points.len()
        );
        let mut errors = branch.points.iter().map(|point| point.stability.error);
        assert!(errors.all(|error| error < 1e-3), "{width}");
    }
}
