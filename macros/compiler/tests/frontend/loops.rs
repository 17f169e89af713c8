//! Arrays and loops.

use crate::{assert_model, faults, model};

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
