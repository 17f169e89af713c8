//! What follows from the lengths of intervals alone is kept from pass to pass, and is that of the present linear part and lengths.

use super::first;

crate::oscillator! {
    /// Two masses whose modes change with what couples them; the second meets a ball.
    Ball(x, y) {
        param coupling = 0.4;
        law ball(g) { g > 0 => 30*g^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + x + coupling*(x - y) = 0.2*cos(omega*t);
        ddot(y) + 0.04*dot(y) + 9*y - coupling*(x - y) + ball(y - 0.02) = 0;
    }
}

#[test]
fn passes_are_those_of_new_equations() {
    for vary in [Some("coupling"), None] {
        let (mut equations, u) = first(&Ball::default(), vary, 1.1, [16, 2]);
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
}
