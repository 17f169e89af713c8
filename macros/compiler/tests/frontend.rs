//! From declarations to checked models.

use std::str::FromStr;

use hertzian_compiler::dag::{Id, Variable};
use hertzian_compiler::ir::{Model, Place};
use proc_macro2::TokenStream;

fn compile(text: &str) -> Result<Model, String> {
    let tokens = TokenStream::from_str(text).map_err(|fault| fault.to_string())?;
    hertzian_compiler::compile(tokens).map_err(|errors| errors.to_string())
}

fn model(text: &str) -> Model {
    compile(text).unwrap_or_else(|errors| panic!("{errors}\nin {text}"))
}

/// Everything lowered, one line each.
fn summary(model: &Model) -> Vec<String> {
    let parameter = |variable: Variable| match variable {
        Variable::Parameter(index) => model.parameters[index].name.to_string(),
        Variable::Omega => "omega".to_owned(),
        other => format!("{other:?}"),
    };
    let mut lines = Vec::new();
    for (place, id) in &model.coefficients {
        let value = model.dag.display(*id, &parameter);
        let wave = |wave: &hertzian_compiler::ir::Wave| {
            let name = if wave.sine { "sin" } else { "cos" };
            if wave.harmonic == 0 {
                String::new()
            } else {
                format!(" {name}{}", wave.harmonic)
            }
        };
        lines.push(match place {
            Place::Mass { row, column } => format!("M{row}{column} = {value}"),
            Place::Damping { row, column } => format!("C{row}{column} = {value}"),
            Place::Stiffness {
                row,
                column,
                wave: w,
            } => format!("K{row}{column}{} = {value}", wave(w)),
            Place::Load { row, wave: w } => format!("f{row}{} = {value}", wave(w)),
            Place::ForceDirection {
                contact,
                row,
                wave: w,
            } => format!("e{contact} row {row}{} = {value}", wave(w)),
            Place::GapDirection {
                contact,
                column,
                wave: w,
            } => {
                format!("d{contact} column {column}{} = {value}", wave(w))
            }
            Place::Offset { contact, wave: w } => format!("delta{contact}{} = {value}", wave(w)),
            Place::Argument { contact, index } => format!("a{contact} {index} = {value}"),
        });
    }
    for law in &model.laws {
        let argument = |variable: Variable| match variable {
            Variable::Gap => "g".to_owned(),
            Variable::Rate => "r".to_owned(),
            Variable::Argument(index) => law.arguments[index].clone(),
            other => format!("{other:?}"),
        };
        let show = |id: Id| model.dag.display(id, &argument);
        let mut line = format!("{}: {}", law.name, show(law.pieces[0]));
        for (level, &piece) in law.levels.iter().zip(&law.pieces[1..]) {
            let relation = if level.belongs_above { ">=" } else { ">" };
            let (value, force) = (show(level.value), show(piece));
            line = format!("{line} | {relation} {value} | {force}");
        }
        lines.push(line);
    }
    lines
}

fn assert_model(text: &str, expected: &[&str]) {
    let lines = summary(&model(text));
    assert_eq!(lines, expected, "in {text}");
}

fn faults(text: &str) -> String {
    compile(text)
        .err()
        .unwrap_or_else(|| panic!("no fault in {text}"))
}

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
