//! Ranges in which a mass vanishes.

use crate::{faults, model};

#[test]
fn ranges_that_admit_a_singular_mass_are_refused() {
    for (parameters, masses, message) in [
        (
            "param m in 0.0..;",
            "m",
            "singular at `m = 0`, which this range admits: write `param m > 0;`",
        ),
        (
            "param m >= 0;",
            "m",
            "singular at `m = 0`, which this range admits: write `param m > 0;`",
        ),
        (
            "param m in 0.0..=2.0;",
            "2*m",
            "singular at `m = 0`, which this range admits: let it begin above 0",
        ),
        (
            "param m in -1.0..2.0;",
            "m",
            "singular at `m = 0`, which this range admits: write `param m > 0;`",
        ),
        (
            "param e in 0.0..=1.0;",
            "(1 - e)",
            "singular at `e = 1`, which this range admits: write `param e in 0.0..1.0;`",
        ),
        (
            "param e <= 1;",
            "(1 - e)",
            "singular at `e = 1`, which this range admits: write `param e < 1;`",
        ),
        (
            "param a in 0.0..; param b in 0.0..;",
            "(a + b)",
            "singular where `a` and `b` are all zero, which their ranges admit: write `param a > 0;`",
        ),
    ] {
        let text = faults(&format!(
            "M(x) {{ {parameters} {masses}*ddot(x) + x = 0; }}"
        ));
        assert_eq!(text, format!("the mass matrix is {message}"));
    }
    let coupled = "M(x, y) { param c in 0.0..=1.0;
        ddot(x) + c*ddot(y) + x = 0; ddot(y) + c*ddot(x) + y = 0; }";
    assert!(faults(coupled).contains("`c = 1`"));
    let with_units = "M(x: m) { param m: kg in 0.0..; param k: N/m; m*ddot(x) + k*x = 0; }";
    assert!(faults(with_units).ends_with("write `param m: kg > 0;`"));
    let two = "M(x, y) { param m in 0.0..; param n in 0.0..;
        m*ddot(x) + x = 0; n*ddot(y) + y = 0; }";
    assert_eq!(faults(two).lines().count(), 2);
}

#[test]
fn masses_that_cannot_vanish_or_have_no_range_are_kept() {
    for (parameters, mass) in [
        ("param m;", "m"),
        ("param m > 0;", "m"),
        ("param m in 0.5..;", "m"),
        ("param e in 0.0..1.0;", "(1 - e)"),
        ("param a in 0.0..;", "(1 + a)"),
        ("param a in 0.0..; param m > 0;", "(m + a)"),
        ("param a in 0.0..; param m;", "(m + a)"),
    ] {
        model(&format!("M(x) {{ {parameters} {mass}*ddot(x) + x = 0; }}"));
    }
    model("M(x) { param k in 0.0..; ddot(x) + k*x = 0; }");
}

#[test]
fn negative_masses_are_refused() {
    for (parameters, mass, message) in [
        ("", "-1", "the mass of `x` is negative: change the signs"),
        (
            "param m < 0;",
            "m",
            "the mass of `x` is negative: change the signs",
        ),
        (
            "param m > 0;",
            "-2*m",
            "the mass of `x` is negative: change the signs",
        ),
        (
            "param m = -1;",
            "m",
            "with the defaults of the parameters the mass of `x` is -1: ",
        ),
        (
            "param m = 1; param e = 3;",
            "(m - e)",
            "with the defaults of the parameters the mass of `x` is -2: ",
        ),
    ] {
        let text = faults(&format!(
            "M(x) {{ {parameters} {mass}*ddot(x) + x^3 = cos(omega*t); }}"
        ));
        assert!(text.contains(message), "{text}\nwith {mass}");
    }
    // Signs are known of equations with one inertia.
    model("M(x, y) { ddot(x) - ddot(y) + x = 0; ddot(y) - 2*ddot(x) + y = 0; }");
    model("M(x) { param m; m*ddot(x) + x = 0; }");
}
