//! What a beginner writes, and what is said of it: one message for one mistake, with what to write instead.

use crate::{compile, faults};

fn assert_message(text: &str, expected: &str) {
    assert_eq!(faults(text), expected, "{text}");
}

#[test]
fn methods_are_written_as_powers_and_functions() {
    for (of, method, meant) in [
        ("x", ".powi(3)", "x^3"),
        ("x", ".powf(1.5)", "x^1.5"),
        ("x", ".powf(-a)", "x^(-a)"),
        ("(x - 1)", ".powi(2)", "(x - 1)^2"),
        ("x", ".abs()", "|x|"),
        ("x", ".signum()", "sgn(x)"),
        ("x", ".max(0)", "max(x, 0)"),
        ("x", ".cbrt()", "x^(1/3)"),
        ("dot(x)", ".tanh()", "tanh(dot(x))"),
        ("2.0", ".sqrt()", "sqrt(2.0)"),
    ] {
        assert_message(
            &format!("M(x) {{ param a > 0; ddot(x) + {of}{method} + a = 0; }}"),
            &format!("there are no methods here, as `{method}` would be: write `{meant}`"),
        );
    }
    let text = faults("M(x) { ddot(x) + x.powi(2).sqrt() + 2*x.exp_m1() = 0; }");
    let expected = "there are no methods here, as `.powi(2)` would be: write `x^2`\n\
        there are no methods here, as `.sqrt()` would be: write `sqrt(x^2)`\n\
        there are no methods here, as `.exp_m1()` would be: write a function, as in `sqrt(x)`";
    assert_eq!(text, expected);
    assert_message(
        "M(x) { ddot(x) + self.k*x = 0; }",
        "there are no fields here, as `k` would be: declare a parameter, and write its name alone",
    );
}

#[test]
fn an_equation_has_two_sides() {
    let message =
        "an equation has two sides: where nothing stands on the right, end it with `= 0;`";
    for text in [
        "M(x) { ddot(x) + x; }",
        "M(x) { ddot(x) + x }",
        "M(x[3]) { for j in 0..3 { ddot(x[j]) + x[j]; } }",
    ] {
        assert_message(text, message);
    }
}

#[test]
fn what_multiplies_the_time_is_the_frequency() {
    for phase in ["w*t", "2*w*t + pi", "t*w", "2*pi*w*t", "3*(w*t)"] {
        assert_message(
            &format!("M(x) {{ ddot(x) + x = cos({phase}); }}"),
            "unknown name `w`: the frequency of excitation is called `omega`, as in `cos(omega*t)`",
        );
    }
    assert_message(
        "M(x) { let phase = w*t; ddot(x) + x = sin(phase); }",
        "unknown name `w`: the frequency of excitation is called `omega`, as in `cos(omega*t)`",
    );
    assert_message(
        "M(x) { ddot(x) + x = cos(order*omega*t); }",
        "unknown name `order`: declare it with `param order;`",
    );
    assert_message(
        "M(x) { let phase = w*t; let w = 2*omega; ddot(x) + x = sin(phase); }",
        "`w` is used before its `let`: move the `let` up",
    );
}

#[test]
fn a_law_in_a_model_has_names_only() {
    let law = |argument: &str| {
        format!(
            "M(x) {{ param k > 0; law stop(gap, {argument}) {{ gap > 0 => gap^n, else => 0 }} ddot(x) + stop(x, k) = 0; }}"
        )
    };
    compile(&law("n")).expect("it is sound");
    for range in ["n > 1", "n >= 1", "n < 2", "n in 1..=3"] {
        assert_message(
            &law(range),
            "no range is written here: inside a model the ranges of the parameters that a call passes count, as in `param n > 1;`",
        );
    }
    assert_message(
        &law("n = 3"),
        "no default is written here: every call passes a value, as in `contact(x, 1.5)`",
    );
    assert_message(
        &law("n: 1"),
        "no unit is written here: what is passed in a call has one",
    );
}
