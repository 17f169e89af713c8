//! Largest and smallest of two, kinks, and polynomials of several coordinates.

use crate::{assert_model, faults, model};

#[test]
fn extrema_of_the_gap_are_pieces() {
    assert_model(
        "M(x) { param k > 0; param stop > 0; param n > 0;
            ddot(x) + k*max(0, x - stop)^n + min(2*x, x) + max(k, 1)*x = max(1, 2); }",
        &[
            "M00 = 1",
            "K00 = k*(0.5*sgn(k - 1) + 0.5) + 0.5 - 0.5*sgn(k - 1)",
            "f0 = 2",
            "d0 column 0 = 1",
            "a0 0 = k",
            "a0 1 = stop",
            "a0 2 = n",
            "e0 row 0 = 1",
            "force 1: 2*g | > 0 | g | > stop | g + k*(g - stop)^n",
        ],
    );
}

#[test]
fn a_force_without_tension_has_a_kink_in_its_rate() {
    let law = "M(x) { param k > 0; param c in 0.0..;
        law contact(gap) { gap > 0 => max(0, k*gap^1.5*(1 + c*dot(gap))), else => 0 }
        ddot(x) + contact(x) = 0; }";
    assert_model(
        law,
        &[
            "M00 = 1",
            "d0 column 0 = 1",
            "a0 0 = k",
            "a0 1 = c",
            "e0 row 0 = 1",
            "contact: 0 | > 0 | k*g^1.5*(c*r + 1)*(0.5*sgn(c*r + 1) + 0.5)",
        ],
    );
    for smooth in [
        "gap > 0 => max(0, k*gap + c*dot(gap)), else => 0",
        "gap > 0 => k*gap*max(-1, c*dot(gap)^3) + |gap + dot(gap)|, else => 0",
        "gap > 0 => min(k*gap^1.5, c - dot(gap)), else => 0",
    ] {
        model(&law.replace(
            "gap > 0 => max(0, k*gap^1.5*(1 + c*dot(gap))), else => 0",
            smooth,
        ));
    }
}

#[test]
fn polynomials_of_several_coordinates_are_taken_apart() {
    assert_model(
        "Coupled(x, y) { param k;
            ddot(x) + k*x*y^2 = 0;
            ddot(y) + k*x^2*y = 0; }",
        &[
            "M00 = 1",
            "M11 = 1",
            "d0 column 0 = 1",
            "e0 row 0 = -1/3*k",
            "d1 column 0 = 1",
            "d1 column 1 = 1",
            "e1 row 0 = 1/6*k",
            "e1 row 1 = 1/6*k",
            "d2 column 0 = 1",
            "d2 column 1 = -1",
            "e2 row 0 = 1/6*k",
            "e2 row 1 = -1/6*k",
            "d3 column 1 = 1",
            "e3 row 1 = -1/3*k",
            "force 1: g^3",
        ],
    );
    let three = model(
        "A(x, y, z) { ddot(x) + x*y*z + (x + y)^2*(z - 1) + dot(x)*dot(y) = 0; ddot(y) = 0; ddot(z) = 0; }",
    );
    assert!(three.laws.len() >= 3);
    let text = faults("A(x, y) { ddot(x) + x*dot(y) = 0; ddot(y) + x*|y| = 0; }");
    assert_eq!(text.lines().count(), 2, "{text}");
}
