//! Orbits of which a part of the period is followed, and that come back with coordinates in each other's place, against the flow in closed form.

use std::f64::consts::TAU;

use super::first_of;
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::branches::solve;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::orbit::positions::positions;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::system::System;
use crate::{FrequencyResponse, Shooting, time};

crate::oscillator! {
    /// Two equal masses before stops, of which each moves as the other one half a period later, with the other sign.
    Opposite(x, y) {
        law right(g) { g > 0 => 20*g, else => 0 }
        law left(g) { g < 0 => 20*g, else => 0 }
        ddot(x) + 0.1*dot(x) + x - 0.5*(y - x) + right(x - 0.5) = cos(omega*t) + 0.2*sin(2*omega*t);
        ddot(y) + 0.1*dot(y) + y + 0.5*(y - x) + left(y + 0.5) = cos(omega*t) - 0.2*sin(2*omega*t);
    }
}

crate::oscillator! {
    /// Three masses in a ring, of which each moves as the next one a third of a period later.
    Ring(x, y, z) {
        law first(g) { g > 0 => 20*g, else => 0 }
        law second(g) { g > 0 => 20*g, else => 0 }
        law third(g) { g > 0 => 20*g, else => 0 }
        ddot(x) + 0.1*dot(x) + x + 0.5*(2*x - y - z) + 0.05*dot(x - y) + first(x - 0.6) = cos(omega*t);
        ddot(y) + 0.1*dot(y) + y + 0.5*(2*y - z - x) + 0.05*dot(y - z) + second(y - 0.6) = cos(omega*t - 2*pi/3);
        ddot(z) + 0.1*dot(z) + z + 0.5*(2*z - x - y) + 0.05*dot(z - x) + third(z - 0.6) = cos(omega*t + 2*pi/3);
    }
}

/// Positions at many phases, before the part that is followed, in it and behind it, all at once and one by one.
fn positions_are_those_of_the_flow(system: &dyn System, omega: f64, recurrence: &Recurrence) {
    let (mut equations, mut u) = first_of(system, None, omega, [16, 1], recurrence);
    let mut newton = Newton::new(&equations);
    let options = NewtonOptions {
        tolerance: 1e-12,
        iterations: 20,
        damped: false,
    };
    solve::at_value(&mut equations, &mut newton, &mut u, options).unwrap();
    equations.compute(&u, false);
    assert!(!equations.failed);
    let motion = Motion::of(&equations);
    // Of a part of the period in which a stop is reached and left.
    assert!(motion.intervals() > 2 && equations.skeleton.length < 0.6 * TAU);
    let shooting = FrequencyResponse::of(system).by(Shooting::new());
    let exact = shooting.tolerance(1e-12).orbit(omega).unwrap();
    let coordinates = exact.orbit.coordinates();
    let mut flow = time::of(system, omega, 1e-12).unwrap();
    let phases: Vec<f64> = (0..60)
        .map(|sample| 0.37 * f64::from(sample) - 7.0)
        .collect();
    let found = positions(&motion, &phases);
    let mut own = vec![0.0; 2 * coordinates];
    for (phase, found) in phases.iter().zip(found.chunks_exact(coordinates)) {
        let mut state = exact.orbit.state();
        flow.advance(0.0, phase.rem_euclid(TAU), &mut state, None, None)
            .unwrap();
        motion.at(*phase, &mut own);
        for ((found, own), exact) in found.iter().zip(&own).zip(&state) {
            assert!((found - exact).abs() < 1e-9, "{phase}: {found} {exact}");
            assert!((found - own).abs() < 1e-12, "{phase}: {found} {own}");
        }
    }
}

#[test]
fn two_masses_that_change_places() {
    let half = Recurrence {
        period: 1,
        parts: 2,
        image: SignedPermutation::of(vec![(1, -1), (0, -1)]),
    };
    positions_are_those_of_the_flow(&Opposite {}, 1.1, &half);
}

/// Forwards and backwards around the ring are not the same.
#[test]
fn three_masses_that_take_each_others_place() {
    let third = Recurrence {
        period: 1,
        parts: 3,
        image: SignedPermutation::of(vec![(2, 1), (0, 1), (1, 1)]),
    };
    positions_are_those_of_the_flow(&Ring {}, 1.1, &third);
}
