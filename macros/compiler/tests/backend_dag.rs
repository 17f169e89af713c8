//! Canonical forms and exact numbers.

use hertzian_compiler::dag::{Dag, Function, Id, Rational, Variable};

fn ratio(numerator: i128, denominator: i128) -> Rational {
    Rational::new(numerator, denominator).expect("a small fraction")
}

fn name(variable: Variable) -> String {
    format!("{variable:?}").to_lowercase()
}

fn gap(dag: &mut Dag) -> Id {
    dag.variable(Variable::Gap)
}

fn number(dag: &mut Dag, numerator: i128, denominator: i128) -> Id {
    dag.number(ratio(numerator, denominator))
}

#[test]
fn decimal_literals_are_exact() {
    for (text, expected) in [
        ("1.5", ratio(3, 2)),
        ("2e-3", ratio(1, 500)),
        ("1_000", ratio(1000, 1)),
        ("0.10", ratio(1, 10)),
        ("1.25E2", ratio(125, 1)),
        ("3.", ratio(3, 1)),
    ] {
        assert_eq!(Rational::from_decimal(text), Some(expected), "{text}");
    }
    for text in ["", "x", "1e99", "1e-99", "1e99999999999"] {
        assert_eq!(Rational::from_decimal(text), None, "{text}");
    }
}

#[test]
fn conversion_to_f64_rounds_as_the_standard_library_does() {
    for text in [
        "0.1",
        "0.3",
        "1.7976931",
        "0.12345678901234567890123456789012345",
        "7e-20",
    ] {
        let exact = Rational::from_decimal(text).expect("fits");
        assert_eq!(
            exact.to_f64(),
            text.parse::<f64>().expect("a literal"),
            "{text}"
        );
    }
    assert_eq!(ratio(-(1 << 53) - 1, 1).to_f64(), -(2.0_f64.powi(53)));
    assert_eq!(ratio(i128::MAX, 3).to_f64(), i128::MAX as f64 / 3.0);
}

#[test]
fn arithmetic_that_does_not_fit_says_so() {
    let huge = Rational::integer(i128::MAX);
    assert_eq!(huge.checked_add(Rational::ONE), None);
    assert_eq!(huge.checked_mul(Rational::integer(2)), None);
    assert_eq!(
        huge.checked_mul(huge.reciprocal().expect("not zero")),
        Some(Rational::ONE)
    );
    assert_eq!(Rational::integer(i128::MIN).negate(), None);
    assert_eq!(Rational::ZERO.reciprocal(), None);
    assert!(huge > ratio(i128::MAX - 1, 1));
    assert!(ratio(1, 3) < ratio(i128::MAX / 3 + 1, i128::MAX));
    assert!(ratio(-1, 3) < ratio(-1, 4));
}

#[test]
fn an_overflowing_sum_stays_unevaluated() {
    let dag = &mut Dag::default();
    let huge = number(dag, i128::MAX, 1);
    let sum = dag.sum(&[huge, huge]);
    assert_eq!(dag.as_number(sum), None);
    assert_eq!(dag.evaluate(sum, &|_| 0.0), 2.0 * i128::MAX as f64);
    let product = dag.product(&[huge, huge]);
    assert_eq!(dag.as_number(product), None);
}

#[test]
fn like_terms_and_powers_are_collected() {
    let dag = &mut Dag::default();
    let x = gap(dag);
    let (two, three, five) = (dag.integer(2), dag.integer(3), dag.integer(5));
    let terms = [dag.product(&[two, x]), dag.product(&[three, x])];
    assert_eq!(dag.sum(&terms), dag.product(&[five, x]));
    assert_eq!(dag.product(&[x, x]), dag.power(x, two));
    let half = number(dag, 1, 2);
    let root = dag.power(x, half);
    assert_eq!(dag.product(&[root, root]), x);
    let minus = dag.integer(-1);
    let reciprocal = dag.power(x, minus);
    let three_halves = number(dag, 3, 2);
    let power = dag.power(x, three_halves);
    assert_eq!(dag.product(&[power, reciprocal]), root);
    assert_eq!(dag.difference(x, x), dag.integer(0));
    let difference = dag.difference(x, two);
    let opposite = dag.difference(two, x);
    assert_eq!(dag.negate(difference), opposite);
    let root_of_two = dag.power(two, half);
    assert_eq!(
        dag.product(&[root_of_two, x, root_of_two]),
        dag.product(&[two, x])
    );
    let absolute = dag.call(Function::Absolute, x);
    assert_eq!(dag.product(&[absolute, x, absolute]), dag.power(x, three));
}

#[test]
fn powers_of_powers_respect_signs() {
    let dag = &mut Dag::default();
    let x = gap(dag);
    let (two, half) = (dag.integer(2), number(dag, 1, 2));
    let square = dag.power(x, two);
    assert_eq!(dag.power(square, half), dag.call(Function::Absolute, x));
    let root = dag.power(x, half);
    assert_eq!(dag.power(root, two), x);
    let negative = dag.negate(x);
    assert_eq!(dag.power(negative, two), square);
    assert_ne!(dag.power(negative, half), root);
}

#[test]
fn functions_know_their_parity() {
    let dag = &mut Dag::default();
    let x = gap(dag);
    let one = dag.integer(1);
    let difference = dag.difference(x, one);
    let opposite = dag.difference(one, x);
    for function in [Function::Sine, Function::Tanh, Function::Sign] {
        let value = dag.call(function, difference);
        assert_eq!(dag.call(function, opposite), dag.negate(value));
    }
    for function in [Function::Cosine, Function::Absolute] {
        let value = dag.call(function, difference);
        assert_eq!(dag.call(function, opposite), value);
    }
    assert_ne!(
        dag.call(Function::Step, opposite),
        dag.call(Function::Step, difference)
    );
}

#[test]
fn replacing_is_by_value() {
    let dag = &mut Dag::default();
    let x = gap(dag);
    let step = dag.call(Function::Step, x);
    let product = dag.product(&[step, x]);
    let one = dag.integer(1);
    assert_eq!(dag.replace(product, step, one), x);
    let rate = dag.variable(Variable::Rate);
    let by = std::collections::HashMap::from([(Variable::Gap, rate)]);
    assert_eq!(dag.substitute(x, &by), rate);
    assert!(dag.depends_on(product, Variable::Gap) && !dag.depends_on(product, Variable::Rate));
}

#[test]
fn display_reads_as_written() {
    let dag = &mut Dag::default();
    let x = gap(dag);
    let rate = dag.variable(Variable::Rate);
    let zeta = dag.variable(Variable::Argument(0));
    let (two, exponent) = (dag.integer(2), number(dag, 3, 2));
    let damping = dag.product(&[two, zeta, rate]);
    let spring = dag.power(x, exponent);
    let force = dag.difference(spring, damping);
    assert_eq!(dag.display(force, &name), "gap^1.5 - 2*argument(0)*rate");
    let inverse = dag.quotient(zeta, force);
    assert_eq!(
        dag.display(inverse, &name),
        "argument(0)/(gap^1.5 - 2*argument(0)*rate)"
    );
}

#[test]
fn deep_expressions_do_not_exhaust_the_stack() {
    let dag = &mut Dag::default();
    let mut deep = gap(dag);
    let one = dag.integer(1);
    for _ in 0..20_000 {
        let sine = dag.call(Function::Sine, deep);
        deep = dag.sum(&[sine, one]);
    }
    assert!(dag.evaluate(deep, &|_| 0.5).is_finite());
    assert!(dag.depends_on(deep, Variable::Gap));
}
