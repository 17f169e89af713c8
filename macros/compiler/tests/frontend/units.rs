//! Units and defaults.

use crate::{faults, model};

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
    let text = |index: usize| model.parameters[index].unit.as_str();
    assert_eq!((text(2), text(3)), ("N/mm^(3/2)", ""));
    assert_eq!(model.units, ["mm"]);
    let defaults: Vec<Option<f64>> = model.parameters.iter().map(|item| item.default).collect();
    assert_eq!(defaults[..4], [Some(1e-3), None, Some(1e9), Some(0.3)]);
}

#[test]
fn faults_of_units_are_at_their_terms() {
    for (from, to, message) in [
        (
            "c*dot(x)",
            "c*x",
            "`c*x` is in N*s, and what stands before it is in N:",
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
        (
            "push +",
            "2 + push +",
            "`push` is in N, and what stands before it has no unit",
        ),
        (
            "push +",
            "push + 0.1 +",
            "`0.1` has no unit, and what stands before it is in N",
        ),
        ("= 1e9 in", "= -1 in", "outside of its range"),
        ("(3/2)", "(3/0)", "exponent of a unit is a fraction"),
        ("(3/2)", "x", "exponent of a unit is a number"),
    ] {
        assert!(SPRUNG.contains(from));
        let text = faults(&SPRUNG.replacen(from, to, 1));
        assert!(text.contains(message), "{text}\nwith {to}");
    }
}
