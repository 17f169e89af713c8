//! What follows from the lengths of intervals alone is kept from pass to pass, and is that of the present linear part and lengths.

use super::first;
use crate::system::System;

crate::oscillator! {
    /// Two masses whose modes change with what couples them; the second meets a ball.
    Ball(x, y) {
        param coupling = 0.4;
        law ball(g) { g > 0 => 30*g^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + x + coupling*(x - y) = 0.2*cos(omega*t);
        ddot(y) + 0.04*dot(y) + 9*y - coupling*(x - y) + ball(y - 0.02) = 0;
    }
}

crate::oscillator! {
    /// A rotor in a clearance that turns with the phase; nothing but walls holds it in one direction.
    Turned(x, y) {
        param coupling = 0.4;
        law ball(g) { g > 0 => 30*g^1.5, else => 0 }
        law wall(g) { g > 0 => 20*g^1.5, else => 0 }
        ddot(x) + 0.3*dot(x) + coupling*x + cos(omega*t)*ball(x*cos(omega*t) + y*sin(omega*t) - 0.02) = 0.2*cos(omega*t);
        ddot(y) + 0.3*dot(y) + wall(y - 0.1) - wall(-y - 0.1) + sin(omega*t)*ball(x*cos(omega*t) + y*sin(omega*t) - 0.02) = 0.2*sin(omega*t);
    }
}

#[test]
fn passes_are_those_of_new_equations() {
    for vary in [Some("coupling"), None] {
        passes_are_new(&Ball::default(), vary);
        passes_are_new(&Turned::default(), vary);
    }
}

fn passes_are_new(system: &dyn System, vary: Option<&str>) {
    let (mut equations, u) = first(system, vary, 1.1, [16, 2]);
    let skeleton = &equations.skeleton;
    assert!(skeleton.forces > 0);
    let (n, switch) = (skeleton.unknowns(), skeleton.order);
    // Another linear part or frequency, another length, other forces.
    let moves = [(n, 0.05), (switch, 1e-3), (n - 1, 1e-2)];
    for (place, by) in moves {
        let mut moved = u.clone();
        moved[place] += by;
        for u in [&u, &moved, &u] {
            for derivatives in [false, true, false] {
                let mut other = equations.on(equations.skeleton.clone(), u[n]).unwrap();
                equations.pass(u, derivatives);
                other.pass(u, derivatives);
                assert!(!equations.failed);
                assert_eq!(equations.residual, other.residual, "{vary:?} {place}");
                if derivatives {
                    assert_eq!(equations.matrix, other.matrix, "{vary:?} {place}");
                }
            }
        }
    }
}
