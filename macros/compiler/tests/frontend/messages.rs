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

#[test]
fn what_is_long_is_quoted_in_part() {
    let lets: Vec<String> = (1..147)
        .map(|i| format!("let a{i} = a{0}*a{0};", i - 1))
        .collect();
    let doubling = format!(
        "M(x) {{ let a0 = x + 1; {} ddot(x) + x + a146 = cos(omega*t); }}",
        lets.join(" ")
    );
    let long = "x + ".repeat(5000);
    for text in [
        doubling,
        format!("M(x, y) {{ ddot(x) + tanh({long} y) = 0; ddot(y) + ({long} 1)^0.5 = 0; }}"),
        format!("M(x) {{ param {} = 1; ddot(x) = 0; }}", "a".repeat(5000)),
        format!("M(x) {{ ddot(x) + {} = 0; }}", "9".repeat(5000)),
        format!("M(x) {{ ddot(x) + 1{} = 0; }}", "z".repeat(5000)),
        format!("M(x) {{ ddot(x) + {}(x) = 0; }}", "f".repeat(5000)),
        format!("M(x: m) {{ ddot(x) + {long} 1 = 0; }}"),
    ] {
        let said = faults(&text);
        assert!(said.len() < 700, "{} characters: {said}", said.len());
    }
    assert!(faults("M(x) { ddot(x) + (x*y)^0.5 = 0; }").contains("unknown name `y`"));
}

#[test]
fn many_faults_are_not_all_listed() {
    let text = faults(&format!("M(x) {{ {} ddot(x) = 0; }}", ";".repeat(1000)));
    assert_eq!(text.lines().count(), 64);
    assert!(text.ends_with("(what is wrong beyond this is not listed)"));
}

#[test]
fn what_would_take_long_is_refused() {
    let factors: Vec<String> = (0..900).map(|i| format!("*(x + {i})")).collect();
    let factors = factors.concat();
    assert_message(
        &format!("M(x) {{ ddot(x) + x{factors} = 0; }}"),
        "this would take too long to compile: write it with fewer terms, factors and pieces, or attach laws to matrices with a `Structure`",
    );
    let parameters: Vec<String> = (0..513).map(|i| format!("param a{i};")).collect();
    let parameters = parameters.concat();
    assert_message(
        &format!("M(x) {{ {parameters} ddot(x) = 0; }}"),
        "more than 512 declarations of a parameter: use numbers, or attach laws to matrices with a `Structure`",
    );
    assert_message(
        &format!("M(x) {{ ddot(x) + {} = 0; }}", "x+".repeat(40_000)),
        "more than 65536 names, numbers and marks: write what repeats as a loop",
    );
    assert_message(
        "M(x) { ddot(x) + for i in 0..4000 { for j in 0..1 { i*j*x*1*2*3*4*5*6*7*8*9*10*11*12*13*14*15*16*17*18*19*20*21*22*23*24*25*26*27*28*29*30*31*32*33*34*35*36*37*38*39*40 } } = 0; }",
        "more than 4096 repetitions, all loops taken together: loops are written out while compiling; make the range smaller",
    );
}

#[test]
fn names_that_generated_code_needs_are_refused() {
    assert_message(
        "usize(x) { ddot(x) = 0; }",
        "`usize` is a type of Rust, which generated code uses: choose another name, as in `Oscillator`",
    );
    assert_message(
        "M(r#in) { ddot(r#in) = 0; }",
        "names are words of mathematics, without `r#`: write `in_` or another name",
    );
    assert_message(
        "Self(x) { ddot(x) = 0; }",
        "`Self` is a word of Rust: choose another name",
    );
    for name in [
        "Vec", "Option", "std", "core", "hertzian", "Some", "String", "Node",
    ] {
        compile(
            &format!("{name}(x) {{ param f64; param usize; ddot(x) + f64*x^usize = 0; }}")
                .replace("usize", "bool")
                .replace("^bool", "^3 + bool"),
        )
        .expect("a name like any other");
    }
}

#[test]
fn what_was_meant_is_found() {
    let law = "law contact(gap) { gap > 0 => gap^1.5, else => 0 }";
    assert_message(
        &format!("M(x) {{ {law} ddot(x) + h(x) = 0; }}"),
        "unknown function `h`: did you mean the law `contact`, which is never called?",
    );
    assert_message(
        &format!("M(x) {{ {law} ddot(x) + contact(x) + h(x) = 0; }}"),
        "unknown function `h`: did you mean `H`?",
    );
    assert!(faults("M(x) { ddot(x) + q(x) = 0; }").contains("the functions are dot, ddot"));
    assert_message(
        "M(x [mm]) { ddot(x) = 0; }",
        "a unit is written after a colon: `x: mm`",
    );
    assert_message(
        "M(x) { param k [N/m^1.5]; ddot(x) + k*x = 0; }",
        "a unit is written after a colon: `k: N/m^1.5`",
    );
    assert!(faults("M(x[0]) { ddot(x[0]) = 0; }").contains("a length of at least one"));
}

#[test]
fn a_frequency_is_no_angle() {
    for phase in ["omega", "2*omega", "omega/3 + phi"] {
        assert_message(
            &format!("M(x) {{ param phi; ddot(x) + phi*x = cos({phase}); }}"),
            &format!(
                "`{phase}` is a frequency, not an angle, and this does not change with time: did you mean `omega*t`, as in `cos(omega*t)`?"
            ),
        );
    }
    // The phase of a delay.
    let text = "M(x) { param delay; ddot(x) + x = cos(omega*delay)*cos(omega*t) + sin(omega*t + omega*delay); }";
    compile(text).expect("an angle");
}

/// Every double is a number; what none holds is refused, in a range as in an equation.
#[test]
fn numbers_beyond_all_doubles_are_refused() {
    for number in ["1e309", "1.8e308", "1e-324", "2e-400", "1e99999999999"] {
        let message = format!(
            "`{number}` is out of range: numbers are zero or between 4.9e-324 and 1.8e308 in size"
        );
        assert_message(&format!("M(x) {{ ddot(x) + {number}*x = 0; }}"), &message);
        assert_message(
            &format!("M(x) {{ param a < {number}; ddot(x) + a*x = 0; }}"),
            &message,
        );
        assert_message(
            &format!("M(x) {{ param a = {number}; ddot(x) + a*x = 0; }}"),
            &message,
        );
    }
    assert_message(
        "M(x) { ddot(x) + x = cos(1e-300*omega*t); }",
        "a frequency is out of all proportion to omega",
    );
    assert_message(
        "M(x[3]) { for j in 0..1e300 { ddot(x[j]) + x[j] = 0; } }",
        "the end of a range must be a whole number, and this is 1e300",
    );
}
