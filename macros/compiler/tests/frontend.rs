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
fn arrays_are_written_out() {
    assert_model(
        "Chain(x[3], y) { param k > 0; param drive;
            law contact(gap) { gap > 0 => k*gap^1.5, else => 0 }
            ddot(x[0]) - contact(x[0] - x[1]) = drive*cos(omega*t);
            for j in 1..=2 {
                let last = 2;
                ddot(x[j]) + contact(x[j - 1] - x[j]) + (last - j)*x[last] = 0;
            }
            ddot(y) + 2*dot(x[2*1]) + y = 0;
        }",
        &[
            "M00 = 1",
            "f0 cos1 = drive",
            "M11 = 1",
            "K12 = 1",
            "M22 = 1",
            "M33 = 1",
            "C32 = 2",
            "K33 = 1",
            "d0 column 0 = 1",
            "d0 column 1 = -1",
            "a0 0 = k",
            "e0 row 0 = -1",
            "e0 row 1 = 1",
            "d1 column 1 = 1",
            "d1 column 2 = -1",
            "a1 0 = k",
            "e1 row 2 = 1",
            "contact: 0 | > 0 | k*g^1.5",
        ],
    );
    let names = model("A(x[2], y) { for j in 0..2 { ddot(x[j]) + x[j] = 0; } ddot(y) = 0; }");
    assert_eq!(names.coordinates, ["x[0]", "x[1]", "y"]);
    assert_eq!(
        names.equation,
        "for j in 0..2 { ddot(x[j]) + x[j] = 0; }\nddot(y) = 0"
    );
}

#[test]
fn loops_in_expressions_are_sums() {
    let sum = "M(x) { ddot(x) + for j in 1..=3 { j*x + for i in 0..j { (i + 1)*x^2 } } = for j in 1..4 { cos(j*omega*t)/j }; }";
    assert_model(
        sum,
        &[
            "M00 = 1",
            "K00 = 6",
            "f0 cos1 = 1",
            "f0 cos2 = 0.5",
            "f0 cos3 = 1/3",
            "d0 column 0 = 1",
            "e0 row 0 = 10",
            "force 1: g^2",
        ],
    );
    assert_eq!(
        model(sum).equation,
        "ddot(x) + for j in 1..=3 { j*x + for i in 0..j { (i + 1)*x^2 } } = for j in 1..4 { cos(j*omega*t)/j }"
    );
}

#[test]
fn an_equation_may_begin_with_a_sum() {
    let text = "M(x) { for j in 0..3 { j*x } + ddot(x) = 0; }";
    assert_model(text, &["K00 = 3", "M00 = 1"]);
    let nothing = "M(x) { for j in 3..3 { j*x } + ddot(x) = 0; }";
    assert_model(nothing, &["M00 = 1"]);
}

const ROTOR: &str = "Rotor(x, y) {
    param m > 0; param k > 0; param clearance; param c; param e;
    let cage = 2/5*omega*t;
    law ball(gap) { gap > 0 => k*gap^1.5, else => 0 }
    m*ddot(x) + c*dot(x) + for j in 0..8 {
        let angle = cage + 2*pi*j/8;
        cos(angle)*ball(x*cos(angle) + y*sin(angle) - clearance)
    } = m*e*omega^2*cos(omega*t);
    m*ddot(y) + c*dot(y) + for j in 0..8 {
        let angle = cage + 2*pi*j/8;
        sin(angle)*ball(x*cos(angle) + y*sin(angle) - clearance)
    } = m*e*omega^2*sin(omega*t);
}";

#[test]
fn eight_moving_contacts_compile_quickly() {
    let start = std::time::Instant::now();
    let rotor = model(ROTOR);
    assert_eq!(
        (rotor.contacts.len(), rotor.laws.len(), rotor.divisor),
        (8, 1, 5)
    );
    assert!(start.elapsed().as_millis() < 200, "{:?}", start.elapsed());
}

#[test]
fn faults_of_loops_are_reported_once() {
    for (text, message) in [
        (
            "C(x[4]) { for j in 0..4 { ddot(x[j]) + x[j] - x[j + 1] = 0; } }",
            "there is no `x[4]`",
        ),
        (
            "C(x[4]) { for j in 0..4 { ddot(x[j]) + tan(x[j]) = 0; } }",
            "unknown function `tan`",
        ),
        (
            "C(x[4]) { for j in 0..4 { ddot(x[j]) + x[j]^1.5 = 0; } }",
            "may be negative",
        ),
        (
            "C(x[4]) { for j in 0..3 { ddot(x[j]) = 0; } }",
            "coordinate `x[3]` has no equation",
        ),
        (
            "C(x[4]) { for j in 0..5 { ddot(x[0]) + j*x[1] = 0; } }",
            "one equation too many",
        ),
        (
            "C(x) { param n; ddot(x) + for j in 0..n { j*x } = 0; }",
            "known while compiling",
        ),
        (
            "C(x) { ddot(x) + for j in 0..9/2 { j*x } = 0; }",
            "must be a whole number",
        ),
        (
            "C(x) { ddot(x) + for j in 0..100000 { j*x } = 0; }",
            "more than 4096 repetitions",
        ),
        (
            "C(x) { ddot(x) + for j in 0..8 { x } = 0; }",
            "index `j` of this loop is never used",
        ),
        (
            "C(x, j) { ddot(x) + for j in 0..8 { j*x } = 0; ddot(j) = 0; }",
            "name of a coordinate",
        ),
        (
            "C(x[2]) { ddot(x) = 0; ddot(x[1]) = 0; }",
            "array of 2 coordinates",
        ),
        ("C(x) { ddot(x[0]) = 0; }", "single coordinate"),
        ("C(x[0]) { ddot(x[0]) = 0; }", "length of at least one"),
        (
            "C(x[2000]) { for j in 0..2000 { ddot(x[j]) = 0; } }",
            "more than 1024 coordinates",
        ),
    ] {
        let faults = faults(text);
        assert_eq!(faults.lines().count(), 1, "{faults}\nin {text}");
        assert!(faults.contains(message), "{faults}\nin {text}");
    }
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

const SPRUNG: &str = "Sprung(x: mm) {
    param m: t = 1e-3 > 0;
    param c: N*s/mm in 0.0..;
    param k: N/mm^(3/2) = 1e9 in 0.0..;
    param kappa: 1 = 0.3;
    param n: 1 > 0;
    param length: mm = 1 > 0;
    param drive: N;
    param offset: mm > 0;
    law contact(gap, exponent) {
        gap > offset => k*(gap - offset)^1.5*(1 + (|gap|/length)^exponent),
        else => 0,
    }
    let push = drive*cos(omega*t + kappa);
    m*ddot(x) + c*dot(x) + contact(x, n) + sqrt(m*k/m)*max(0, x)^(3/2)*k^0.5 = push + for j in 1..3 { drive/j };
}";

#[test]
fn units_agree_and_are_kept() {
    let model = model(SPRUNG);
    let text = |index: usize| model.parameters[index].documentation.as_str();
    assert_eq!((text(2), text(3)), ("[N/mm^(3/2)]", ""));
    let defaults: Vec<Option<f64>> = model.parameters.iter().map(|item| item.default).collect();
    assert_eq!(defaults[..4], [Some(1e-3), None, Some(1e9), Some(0.3)]);
}

#[test]
fn faults_of_units_are_at_their_terms() {
    for (from, to, message) in [
        (
            "c*dot(x)",
            "c*x",
            "`c*x` is in N*s, and what stands before it in N",
        ),
        (
            "n: 1 > 0",
            "n: m > 0",
            "an exponent must be a plain number, and `exponent` is in m",
        ),
        (
            "(|gap|/length)^exponent",
            "|gap|^exponent + gap/length",
            "divide by a reference value",
        ),
        ("x: mm", "x: m", "cannot be added or compared"),
        ("mm)", "inch)", "unknown unit `inch`: known are kg"),
        ("N*s/mm", "Nm*s", "unknown unit `Nm`: did you mean `N`?"),
        (
            "omega*t + kappa",
            "t*kappa",
            "the argument of `cos` must be a plain number, and `t*kappa` is in s",
        ),
        ("gap > offset", "gap > kappa", "cannot be added or compared"),
        ("kappa: 1", "kappa", "parameter `kappa` has no unit"),
        ("push +", "2 + push +", "cannot be added"),
        ("= 1e9 in", "= -1 in", "outside of its range"),
        ("(3/2)", "(3/0)", "exponent of a unit is a fraction"),
        ("(3/2)", "x", "exponent of a unit is a number"),
    ] {
        assert!(SPRUNG.contains(from));
        let text = faults(&SPRUNG.replacen(from, to, 1));
        assert!(text.contains(message), "{text}\nwith {to}");
    }
}

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
