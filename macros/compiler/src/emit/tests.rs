//! Operations, run by the letter, against the expressions they were lowered from.

use super::tape::{Operation, Style, Tape};
use crate::dag::{Dag, Function, Id, Rational, Variable};

/// Runs a tape at a gap, a rate and one argument, with the guards of `hertzian::emitted`.
fn run(tape: &Tape, at: [f64; 3]) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::new();
    for &operation in &tape.operations {
        let v = |position: usize| values[position];
        values.push(match operation {
            Operation::Number(number) => number,
            Operation::Input(Variable::Gap) => at[0],
            Operation::Input(Variable::Rate) => at[1],
            Operation::Input(_) => at[2],
            Operation::Add(a, b) => v(a) + v(b),
            Operation::Subtract(a, b) => v(a) - v(b),
            Operation::Multiply(a, b) => v(a) * v(b),
            Operation::Divide(a, b) => v(a) / v(b),
            Operation::Negate(a) => -v(a),
            Operation::Integer(a, exponent) => v(a).powi(exponent),
            Operation::Power(a, b) if v(a) > 0.0 => v(a).powf(v(b)),
            Operation::PowerLog(a, b) if v(a) > 0.0 => v(a).powf(v(b)) * v(a).ln(),
            Operation::Raise(a, log, b) if v(a) > 0.0 => (v(b) * v(log)).exp(),
            Operation::Nearest(a, low, high) => (-v(a)).round().clamp(v(low), v(high)),
            Operation::Over(a, b) if v(b) > 0.0 => v(a) / v(b),
            Operation::Shift {
                power, base, steps, ..
            } if v(base) > 0.0 => v(power) * v(base).powf(v(steps)),
            Operation::Power(..)
            | Operation::PowerLog(..)
            | Operation::Raise(..)
            | Operation::Over(..)
            | Operation::Shift { .. } => 0.0,
            Operation::Root(a) => v(a).max(0.0).sqrt(),
            Operation::CubeRoot(a) => v(a).max(0.0).cbrt(),
            Operation::Reciprocal(a) if v(a) == 0.0 => 0.0,
            Operation::Reciprocal(a) => 1.0 / v(a),
            Operation::Logarithm(a) => {
                if v(a) > 0.0 {
                    v(a).ln()
                } else {
                    0.0
                }
            }
            Operation::Call(Function::Sine, a) => v(a).sin(),
            Operation::Call(Function::Sign, a) => {
                if v(a) == 0.0 {
                    0.0
                } else {
                    v(a).signum()
                }
            }
            Operation::Call(Function::Absolute, a) => v(a).abs(),
            Operation::Call(Function::Step, a) => f64::from(v(a) > 0.0),
            Operation::Call(function, _) => unreachable!("{function:?} is not in these tests"),
        });
    }
    tape.roots.iter().map(|&root| values[root]).collect()
}

fn agree(dag: &mut Dag, roots: &[Id], at: [f64; 3]) {
    for style in [Style::Code, Style::Data] {
        let tape = Tape::of(dag, roots, style);
        for (&root, value) in roots.iter().zip(run(&tape, at)) {
            let expected = dag.evaluate(root, &|variable| match variable {
                Variable::Gap => at[0],
                Variable::Rate => at[1],
                _ => at[2],
            });
            let name = |variable: Variable| format!("{variable:?}");
            let bound = 1e-14 * (1.0 + expected.abs());
            let text = dag.display(root, &name);
            assert!(
                (value - expected).abs() <= bound,
                "{style:?} {text} at {at:?}: {value}, not {expected}"
            );
        }
    }
}

#[test]
fn powers_of_every_kind_are_lowered_to_their_value() {
    let dag = &mut Dag::default();
    let (gap, alpha) = (
        dag.variable(Variable::Gap),
        dag.variable(Variable::Argument(0)),
    );
    let mut roots = Vec::new();
    for base in [gap, alpha] {
        for text in [
            "2", "3", "7", "-1", "-2", "-5", "0.5", "1.5", "2.5", "-0.5", "-1.5", "0.25", "1.75",
            "0.6", "1.6", "-0.4", "0.123",
        ] {
            let exponent = dag.number(Rational::from_decimal(text).expect("a literal"));
            roots.push(dag.power(base, exponent));
            roots.push(dag.power_log(base, exponent));
        }
        for (numerator, denominator) in [(1, 3), (2, 3), (5, 3), (-4, 3)] {
            let exponent = dag.number(Rational::new(numerator, denominator).expect("not zero"));
            roots.push(dag.power(base, exponent));
        }
    }
    for offset in [-2, -1, 0, 1] {
        let offset = dag.integer(offset);
        let exponent = dag.sum(&[alpha, offset]);
        roots.push(dag.power(gap, exponent));
        roots.push(dag.power_log(gap, exponent));
    }
    for gap in [1e-3, 0.4, 1.0, 2.5] {
        agree(dag, &roots, [gap, 0.0, 1.3]);
    }
    // At the level itself: what is unbounded is zero by definition.
    for &root in &roots {
        let tape = Tape::of(dag, &[root], Style::Code);
        assert!(run(&tape, [0.0, 0.0, 1.3])[0].is_finite());
    }
}

#[test]
fn one_logarithm_and_one_exponential_serve_force_and_derivatives() {
    let dag = &mut Dag::default();
    let (gap, alpha) = (
        dag.variable(Variable::Gap),
        dag.variable(Variable::Argument(0)),
    );
    let one = dag.integer(1);
    let force = dag.power(gap, alpha);
    let lowered = dag.difference(alpha, one);
    let power = dag.power(gap, lowered);
    let roots = [
        force,
        dag.product(&[alpha, power]),
        dag.power_log(gap, alpha),
    ];
    let tape = Tape::of(dag, &roots, Style::Code);
    let count =
        |wanted: fn(&Operation) -> bool| tape.operations.iter().filter(|o| wanted(o)).count();
    assert_eq!(
        count(|operation| matches!(operation, Operation::Logarithm(_))),
        1
    );
    assert_eq!(
        count(|operation| matches!(operation, Operation::Raise(..))),
        1
    );
}

#[test]
fn sums_products_and_steps_keep_their_value() {
    let dag = &mut Dag::default();
    let (gap, rate) = (dag.variable(Variable::Gap), dag.variable(Variable::Rate));
    let argument = dag.variable(Variable::Argument(0));
    let difference = dag.difference(gap, rate);
    let negative = dag.negate(difference);
    let step = dag.call(Function::Step, difference);
    let no_step = dag.call(Function::Step, negative);
    let quotient = dag.quotient(negative, argument);
    let scaled = dag.product(&[quotient, step, gap]);
    let sum = dag.sum(&[scaled, no_step, negative]);
    for rate in [-0.5, 0.4, 0.7] {
        agree(
            dag,
            &[difference, negative, step, no_step, quotient, scaled, sum],
            [0.4, rate, 1.3],
        );
    }
}
