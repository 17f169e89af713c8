//! Declarations and what they are lowered to.

use hertzian_compiler::dag::Variable;
use hertzian_contract::system::Place;

use crate::{assert_model, faults, model, summary};

#[test]
fn a_law_with_two_pieces() {
    assert_model(
        "pub OneSided(x) {
            /// damping ratio
            param zeta in 0.0..;
            param load; param drive;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0, }
            ddot(x) + contact(x) = drive*cos(omega*t) + load;
        }",
        &[
            "M00 = 1",
            "f0 cos1 = drive",
            "f0 = load",
            "d0 column 0 = 1",
            "a0 0 = zeta",
            "e0 row 0 = 1",
            "contact: 0 | > 0 | g^1.5 + 2*zeta*r",
        ],
    );
}

#[test]
fn the_form_of_the_paper() {
    assert_model(
        "P(x) { param zeta; param alpha > 0; param load; param drive;
            ddot(x) + 2*zeta*H(x)*dot(x) + H(x)*sgn(x)*|x|^alpha = drive*cos(omega*t) + load; }",
        &[
            "M00 = 1",
            "f0 cos1 = drive",
            "f0 = load",
            "d0 column 0 = 1",
            "a0 0 = zeta",
            "a0 1 = alpha",
            "e0 row 0 = 1",
            "force 1: 0 | > 0 | g^alpha + 2*zeta*r",
        ],
    );
}

#[test]
fn smooth_terms_of_one_gap_share_a_law_and_leave_their_linear_part() {
    assert_model(
        "A(x) { ddot(x) + x^3 + x + (x^2-1)*dot(x) + |dot(x)|*dot(x) + tanh(x) = 0; }",
        &[
            "M00 = 1",
            "K00 = 1",
            "C00 = -1",
            "d0 column 0 = 1",
            "e0 row 0 = 1",
            "force 1: g^3 + r*g^2 + r*|r| + tanh(g)",
        ],
    );
}

#[test]
fn nested_switches_are_resolved_from_the_inside() {
    assert_model(
        "A(x) { param alpha > 0; ddot(x) + ||x|-1|^alpha = 0; }",
        &[
            "M00 = 1",
            "d0 column 0 = 1",
            "a0 0 = alpha",
            "e0 row 0 = 1",
            "force 1: (-g - 1)^alpha | > -1 | (g + 1)^alpha | > 0 | (1 - g)^alpha | > 1 | (g - 1)^alpha",
        ],
    );
}

#[test]
fn a_force_between_two_coordinates_is_one_contact() {
    assert_model(
        "C(x, y) { ddot(x) + (x-y)^3 + x - y = 0; ddot(y) + (y-x)^3 + y - x = cos(2/5*omega*t) + cos(omega*t)^2; }",
        &[
            "M00 = 1",
            "K00 = 1",
            "K01 = -1",
            "M11 = 1",
            "K11 = 1",
            "K10 = -1",
            "f1 cos2 = 1",
            "f1 = 0.5",
            "f1 cos10 = 0.5",
            "d0 column 0 = 1",
            "d0 column 1 = -1",
            "e0 row 0 = 1",
            "e0 row 1 = -1",
            "force 1: g^3",
        ],
    );
}

#[test]
fn a_moving_gap_has_harmonic_directions() {
    assert_model(
        "B(x, y) { param k; param c; param e;
            law hertz(g, s) { g > 0 => s*g^1.5, else => 0 }
            ddot(x) + hertz(x*cos(omega*t) + y*sin(omega*t) - c, k)*cos(omega*t) = e*omega^2*cos(omega*t + pi/3);
            ddot(y) + hertz(x*cos(omega*t) + y*sin(omega*t) - c, k)*sin(omega*t) = 0; }",
        &[
            "M00 = 1",
            "f0 cos1 = e*omega^2*cos(1/3*pi)",
            "f0 sin1 = -e*omega^2*sin(1/3*pi)",
            "M11 = 1",
            "d0 column 0 cos1 = 1",
            "d0 column 1 sin1 = 1",
            "delta0 = c",
            "a0 0 = k",
            "e0 row 0 cos1 = 1",
            "e0 row 1 sin1 = 1",
            "hertz: 0 | > 0 | s*g^1.5",
        ],
    );
}

#[test]
fn a_linear_law_becomes_coefficients() {
    assert_model(
        "M(x) { param k; law s(u) { k*u + 2*dot(u) + 1 } ddot(x) + s(x - cos(omega*t)) = 0; }",
        &[
            "M00 = 1",
            "K00 = k",
            "f0 cos1 = k",
            "C00 = 2",
            "f0 sin1 = -2*omega",
            "f0 = -1",
        ],
    );
}

#[test]
fn harmonic_stiffness_is_a_coefficient_and_harmonic_damping_a_law() {
    assert_model(
        "M(x) { param e; ddot(x) + (1 + e*cos(2*omega*t))*(x + dot(x)) = 0; }",
        &[
            "M00 = 1",
            "K00 = 1",
            "C00 = 1",
            "K00 cos2 = e",
            "d0 column 0 = 1",
            "e0 row 0 cos2 = e",
            "damper: r",
        ],
    );
}

#[test]
fn compound_exponents_become_arguments() {
    assert_model(
        "M(x) { param a > 0; param b > 0; law c(g, n) { g > 0 => g^(2*n) + g^a*g^b, else => 0 } ddot(x) + c(x, 3*a) = 0; }",
        &[
            "M00 = 1",
            "d0 column 0 = 1",
            "a0 0 = 3*a",
            "a0 1 = 6*a",
            "a0 2 = a + b",
            "e0 row 0 = 1",
            "c: 0 | > 0 | g^(2*n) + g^(a + b)",
        ],
    );
}

#[test]
fn precedence_is_that_of_mathematics() {
    let written = "M(x) { ddot(x) - x^2^3 + 2*-x/3 + -x^4 - (x - 1)*2 = 0; }";
    assert_eq!(
        model(written).equation,
        "ddot(x) - x^2^3 + 2*(-x)/3 + (-x^4) - (x - 1)*2 = 0"
    );
    let lines = summary(&model(written));
    assert!(lines.contains(&"K00 = -8/3".to_owned()), "{lines:?}");
    assert!(
        lines.contains(&"force 1: g^8 + g^4".to_owned()),
        "{lines:?}"
    );
}

#[test]
fn all_faults_are_reported_at_once() {
    let text = faults(
        "M(x) { param a; law c(g) { g > 0 => g^a } ddot(x) + c(x) + x^1.5 = cos(sqrt(2)*omega*t) + t; }",
    );
    assert_eq!(text.lines().count(), 4, "{text}");
    for word in [
        "quasi-periodic",
        "grows with time",
        "no piece holds",
        "may be negative",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

/// The force of a polynomial is the polynomial: compared where all coordinates have values, by the pieces of its laws.
#[test]
fn polynomials_of_several_coordinates_are_taken_apart() {
    let values = [0.7_f64, -1.3, 0.4, 0.9];
    let [x, y, z, w] = values;
    for (text, expected) in [
        ("(1+x)*(1+y)*(1+z)", (1.0 + x) * (1.0 + y) * (1.0 + z)),
        ("(2-x)*(1+y)", (2.0 - x) * (1.0 + y)),
        ("(x*y+1)^3", (x * y + 1.0).powi(3)),
        ("(x+y*z-2)^2*w", (x + y * z - 2.0).powi(2) * w),
        ("(1+x*y*z*w)^2", (1.0 + x * y * z * w).powi(2)),
        ("x^2*y^2*z^2*w^2", (x * y * z * w).powi(2)),
        ("x^5*y*z*w", x.powi(5) * y * z * w),
    ] {
        let model = model(&format!(
            "M(x, y, z, w) {{ ddot(x) + {text} = 0; ddot(y) = 0; ddot(z) = 0; ddot(w) = 0; }}"
        ));
        let number = |id| model.dag.evaluate(id, &|_| f64::NAN);
        let mut sum = 0.0;
        let mut gaps = vec![0.0; model.contacts.len()];
        let mut factors = vec![0.0; model.contacts.len()];
        for &(place, id) in &model.coefficients {
            match place {
                Place::Stiffness { row: 0, column, .. } => sum += number(id) * values[column],
                Place::Load { row: 0, .. } => sum -= number(id),
                Place::GapDirection {
                    contact, column, ..
                } => gaps[contact] += number(id) * values[column],
                Place::ForceDirection {
                    contact, row: 0, ..
                } => factors[contact] += number(id),
                _ => {}
            }
        }
        for (index, contact) in model.contacts.iter().enumerate() {
            let gap = |variable| {
                if variable == Variable::Gap {
                    gaps[index]
                } else {
                    f64::NAN
                }
            };
            sum += factors[index] * model.dag.evaluate(model.laws[contact.law].pieces[0], &gap);
        }
        assert!(
            (sum - expected).abs() < 1e-11,
            "{text}: {sum}, not {expected}"
        );
    }
    assert!(faults("M(x, y) { ddot(x) + x^8*y = 0; ddot(y) = 0; }").contains("up to the degree 8"));
}

/// Numbers that are no fraction of 127 bits.
#[test]
fn numbers_of_any_size_are_coefficients() {
    let text = "M(x) {
        param a = 2.0806986619772685e-26 in 5e-324..1e300;
        law f(gap) { gap > 1e-300 => 1e300*gap^1.5, else => 0 }
        ddot(x) + 1e-300*dot(x) + a*x + 3e-77*x + 1e-99*x^3 + 1e200*1e-201*(x + 3e-40*x) + f(x) = 2.0806986619772685e-26*cos(omega*t) - 1.2345678901234567e-310;
    }";
    let parameter = &model(text).parameters[0];
    assert_eq!(parameter.default, Some(2.080_698_661_977_268_5e-26));
    assert_model(
        text,
        &[
            "M00 = 1",
            "C00 = 1e-300",
            "K00 = a + 1e200*1e-201 + 1e200*1e-201*3e-40 + 3e-77",
            "f0 cos1 = 2.0806986619772685e-26",
            "f0 = -1.23456789012346e-310",
            "d0 column 0 = 1",
            "e0 row 0 = 1",
            "d1 column 0 = 1",
            "e1 row 0 = 1e-99",
            "f: 0 | > 1e-300 | 1e300*g^1.5",
            "force 1: g^3",
        ],
    );
}
