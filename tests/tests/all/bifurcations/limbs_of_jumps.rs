//! Steps from one limb of a branch to another where the force of a stop begins with a jump, and folds beside its touches.
//!
//! Folds are those of motions in closed form from switch to switch, the exponential of the matrix of each piece, with the derivative of the map over a period
//! and its jumps at switches: `det(M - I) = 0` and the orbit by Newton's method in state and frequency, from a settled motion along its branch.

use hertzian::{ContactEquation, EventKind, FrequencyResponse, Shooting, System};

use crate::bifurcations::limbs::agrees;
use crate::bifurcations::preloads::{Masses, Preloads, assert_places};

hertzian::oscillator! {
    /// Before a stop whose force begins with a jump.
    Preload(x) {
        param drive;
        param p;
        law stop(gap) { gap >= 0 => p + 4*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 1) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A tip before a sample that attracts it and sticks to it.
    Adhesive(x) {
        param distance;
        param free;
        law surface(gap) { gap > 0 => 0.3*gap^1.5 - 0.15, else => -0.02*(0.4 - gap)^-2 }
        ddot(x) + dot(x)/60 + x + surface(x - distance) = free/60*cos(omega*t);
    }
}

/// Both ways and by both methods the branch has the same events, and in a window it folds at these places alone.
fn assert_folds(system: &dyn System, range: [f64; 2], window: [f64; 2], expected: &[f64]) {
    agrees(system, range);
    let request = FrequencyResponse::of(system).from(range[1]).to(range[0]);
    let by_shooting = request.clone().by(Shooting::new()).run().unwrap();
    let by_contact_equation = request.by(ContactEquation::new()).run().unwrap();
    for branch in [by_shooting, by_contact_equation] {
        assert_places(&branch, EventKind::Fold, window, expected, 5e-12);
    }
}

/// A closed curve, with folds at 0.54749 and 0.56990, comes as near to the branch as 0.002 of the frequency: steps of the usual length lead onto it, and from it
/// to the limb behind the fold. Nothing but a determinant tells.
#[test]
fn a_closed_curve_beside_the_branch_is_not_followed() {
    let system = &Preloads {
        drive: 0.6482,
        p: 0.2897,
    };
    assert_folds(system, [0.4, 2.2], [0.4, 0.8], &[0.571_904_822_713]);
}

/// Upwards, at 0.452, updates of which the first is small lead along the plane of a step to orbits that were passed before, where the tangent
/// leads back to the start.
#[test]
fn a_step_does_not_lead_to_orbits_that_were_passed() {
    let system = &Preload {
        drive: 0.9284,
        p: 0.473,
    };
    assert_folds(system, [0.4, 2.2], [0.4, 0.8], &[0.577_265_578_409_5]);
}

/// Between the fold and the touch at 0.51693 the branch bends so sharply that no orbit is found in the middle of the step.
#[test]
fn a_fold_before_a_touch_is_found() {
    let system = &Preload {
        drive: 0.7346,
        p: 0.5282,
    };
    assert_folds(system, [0.4, 2.2], [0.4, 0.8], &[0.508_231_932_931_2]);
}

/// The same where the force is no straight line beyond its jump.
#[test]
fn a_fold_before_a_touch_of_an_adhesive_sample_is_found() {
    let system = &Adhesive {
        distance: 1.7774,
        free: 2.1625,
    };
    agrees(system, [0.8, 1.2]);
}

/// Two folds, at 1.32308 and 1.32314, lie between two points at which the parameter falls, before a touch at 1.32029.
#[test]
fn two_folds_before_a_touch_are_found() {
    let system = &Preload {
        drive: 0.7548,
        p: 0.1722,
    };
    agrees(system, [0.4, 2.2]);
    let request = FrequencyResponse::of(system).from(0.4).to(2.2);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    assert_eq!(branch.events(EventKind::Fold).count(), 3);
}

/// Downwards, behind the fold at 0.53108, some of the heights on the way to the touch at 0.57688 have no orbit by shooting: the way to it is narrowed without them, to
/// an end.
#[test]
fn a_way_to_a_touch_comes_to_an_end() {
    let system = &Preloads {
        drive: 0.6697,
        p: 0.2881,
    };
    agrees(system, [0.4, 2.2]);
}

/// Two folds, at 1.205468 and 1.205480, are in the step before a point at which the contact equation goes over to other unknowns: the step is looked at once
/// more in these.
#[test]
fn two_folds_before_other_unknowns_are_found() {
    let system = &Preload {
        drive: 0.4681,
        p: 0.0411,
    };
    agrees(system, [0.4, 2.2]);
    let request = FrequencyResponse::of(system).from(0.4).to(2.2);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    assert_eq!(branch.events(EventKind::Fold).count(), 3);
}

/// Downwards the moduli of a pair fall below one and rise again, from 1.41554 to 1.41532, before the contact equation goes over to other nodes.
#[test]
fn two_bifurcations_before_other_unknowns_are_found() {
    let system = &Masses {
        drive: 0.439,
        preload: 0.1407,
    };
    agrees(system, [0.5, 2.2]);
    let request = FrequencyResponse::of(system).from(2.2).to(0.5);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    assert_eq!(branch.events(EventKind::NeimarkSacker).count(), 5);
}
