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
    let refused = [
        "",
        "x",
        ".",
        "e5",
        "1e",
        "1e+",
        "inf",
        "NaN",
        "1e309",
        "1e400",
        "-1e309",
        "1e99999999999",
        "1e-324",
        "2e-400",
        "1e-99999999999",
    ];
    for text in refused {
        assert_eq!(Rational::from_decimal(text), None, "{text}");
    }
}

/// Where a fraction does not fit, literals are the nearest doubles.
#[test]
fn literals_of_any_size_are_numbers() {
    let texts = [
        "2.0806986619772685e-26",
        "1e-300",
        "1e300",
        "1.7976931348623157e308",
        "2.2250738585072014e-308",
        "5e-324",
        "2.5e-324",
        "1.2345678901234567e-310",
        "-2.0806986619772685e-26",
        "1e99",
        "1e-99",
        "0.1234567890123456789012345678901234567890123",
        "123456789012345678901234567890123456789012345",
        "1_0.000_000_000_000_000_000_000_000_000_000_000_000_001",
    ];
    for text in texts {
        let value: f64 = text.replace('_', "").parse().expect("a literal");
        let number = Rational::from_decimal(text).unwrap_or_else(|| panic!("{text}"));
        assert_eq!(number.to_f64().to_bits(), value.to_bits(), "{text}");
        assert_eq!(number.is_negative(), value < 0.0, "{text}");
        assert_eq!(number.is_positive(), value > 0.0, "{text}");
        assert_eq!(
            number.sign(),
            Rational::integer(value.signum() as i128),
            "{text}"
        );
    }
    for text in [
        "0e-99",
        "0e99999999999",
        "0.0000000000000000000000000000000000000000000000",
    ] {
        assert_eq!(Rational::from_decimal(text), Some(Rational::ZERO), "{text}");
    }
    // A double that is a fraction is one.
    let one = Rational::from_decimal("1.50000000000000000000000000000000000000000000001");
    assert_eq!(one, Some(ratio(3, 2)));
}

/// Arithmetic of doubles is exact or not done.
#[test]
fn doubles_keep_their_value() {
    let small = Rational::from_decimal("1e-300").expect("a literal");
    let large = Rational::from_decimal("1e300").expect("a literal");
    let opposite = small.negate().expect("any sign");
    assert_eq!(small.checked_add(Rational::ZERO), Some(small));
    assert_eq!(small.checked_add(opposite), Some(Rational::ZERO));
    assert_eq!(small.checked_mul(Rational::integer(-1)), Some(opposite));
    assert_eq!(small.checked_mul(Rational::ZERO), Some(Rational::ZERO));
    assert_eq!(small.integer_power(1), Some(small));
    assert_eq!(small.integer_power(0), Some(Rational::ONE));
    assert_eq!(opposite.absolute(), Some(small));
    for none in [
        small.checked_add(small),
        small.checked_mul(large),
        small.reciprocal(),
        large.integer_power(2),
    ] {
        assert_eq!(none, None);
    }
    let dag = &mut Dag::default();
    let (number, x) = (dag.number(small), gap(dag));
    let scaled = dag.product(&[number, x]);
    assert_eq!(dag.quotient(scaled, number), x);
    let ordered = [
        opposite,
        Rational::ZERO,
        small,
        ratio(1, i128::MAX),
        Rational::ONE,
        large,
    ];
    assert!(ordered.is_sorted() && large > Rational::integer(i128::MAX));
    assert_eq!(
        [small, opposite, large].map(|number| number.to_string()),
        ["1e-300", "-1e-300", "1e300"]
    );
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
