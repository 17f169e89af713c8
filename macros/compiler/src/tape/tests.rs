//! Operations, run by the letter, against the expressions they were lowered from.

use super::powers::Plan;
use super::{Operation, Style, Tape};
use crate::dag::{Dag, Function, Id, Rational, Variable};

/// Runs a tape at a gap, a rate and one argument, with the guards of `hertzian::emitted`; bases and powers are planned.
fn run(tape: &Tape, planned: [&[f64]; 2], at: [f64; 3]) -> Vec<f64> {
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
            Operation::Power(..) | Operation::PowerLog(..) => 0.0,
            Operation::Logarithm(position) => {
                let base = planned[0][position];
                if base <= 0.0 { 0.0 } else { base.ln() }
            }
            Operation::Planned(position) => planned[1][position],
            Operation::Root(a) => v(a).max(0.0).sqrt(),
            Operation::CubeRoot(a) => v(a).max(0.0).cbrt(),
            Operation::Reciprocal(a) if v(a) == 0.0 => 0.0,
            Operation::Reciprocal(a) => 1.0 / v(a),
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

/// Lowers expressions and runs them at a gap, a rate and one argument. What is planned is planned for all of them; each is run
/// alone, with nothing but what it is said to use.
fn lower_and_run(dag: &mut Dag, roots: &[Id], style: Style, at: [f64; 3]) -> Vec<f64> {
    let plan = match style {
        Style::Code => Plan::of(dag, roots),
        Style::Data => Plan::default(),
    };
    let alone = |&root: &Id| {
        let tape = Tape::with(dag, &[root], style, &plan);
        let value = |id: Id| dag.evaluate(id, &|variable| valued(variable, at));
        let [logarithms, used] = plan.uses(dag, &[root]);
        let mut bases = vec![f64::NAN; plan.bases.len()];
        for base in logarithms {
            bases[base] = value(plan.bases[base]);
        }
        let mut powers = vec![f64::NAN; plan.exponents.len()];
        for group in &plan.groups {
            for power in group.first..group.first + group.count {
                let (base, exponent) =
                    (value(plan.bases[group.base]), value(plan.exponents[power]));
                let steps = exponent - value(plan.exponents[group.first]);
                assert_eq!(steps, (power - group.first) as f64, "exponents count up");
                if used.contains(&power) {
                    powers[power] = if base > 0.0 { base.powf(exponent) } else { 0.0 };
                }
            }
        }
        run(&tape, [&bases, &powers], at)[0]
    };
    roots.iter().map(alone).collect()
}

fn valued(variable: Variable, at: [f64; 3]) -> f64 {
    match variable {
        Variable::Gap => at[0],
        Variable::Rate => at[1],
        _ => at[2],
    }
}

fn agree(dag: &mut Dag, roots: &[Id], at: [f64; 3]) {
    for style in [Style::Code, Style::Data] {
        let values = lower_and_run(dag, roots, style, at);
        for (&root, value) in roots.iter().zip(values) {
            let expected = dag.evaluate(root, &|variable| valued(variable, at));
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
            roots.push(dag.power_log(base, exponent));
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
        assert!(lower_and_run(dag, &[root], Style::Code, [0.0, 0.0, 1.3])[0].is_finite());
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
    let plan = Plan::of(dag, &roots);
    assert_eq!(plan.bases, [gap]);
    assert_eq!(plan.exponents, [lowered, alpha]);
    assert_eq!(plan.groups.len(), 1);
    let uses = |root: Id| plan.uses(dag, &[root]);
    assert_eq!(uses(roots[0]), [vec![], vec![1]]);
    assert_eq!(uses(roots[1]), [vec![], vec![0]]);
    assert_eq!(uses(roots[2]), [vec![0], vec![1]]);
}

#[test]
fn powers_between_two_of_a_group_are_planned_with_it() {
    let dag = &mut Dag::default();
    let gap = dag.variable(Variable::Gap);
    let mut power = |text: &str| {
        let exponent = dag.number(Rational::from_decimal(text).expect("a literal"));
        dag.power(gap, exponent)
    };
    let roots = ["-1.4", "0.6", "9.6", "0.2", "1.5"].map(&mut power);
    let plan = Plan::of(dag, &roots);
    let exponents = plan
        .exponents
        .iter()
        .map(|&exponent| dag.evaluate(exponent, &|_| 0.0));
    let groups: Vec<_> = plan
        .groups
        .iter()
        .map(|group| (group.first, group.count))
        .collect();
    assert_eq!(exponents.collect::<Vec<_>>(), [-1.4, -0.4, 0.6, 9.6, 0.2]);
    assert_eq!(groups, [(0, 3), (3, 1), (4, 1)]);
    assert!(plan.groups.iter().all(|group| !group.cube_root));
}

#[test]
fn one_cube_root_serves_its_powers() {
    let dag = &mut Dag::default();
    let gap = dag.variable(Variable::Gap);
    let roots = [1, 2, 4, 5, -4].map(|thirds| {
        let exponent = dag.number(Rational::new(thirds, 3).expect("not zero"));
        dag.power(gap, exponent)
    });
    let plan = Plan::of(dag, &roots);
    assert_eq!(plan.bases, [gap]);
    assert!(matches!(plan.groups.as_slice(), [group] if group.cube_root && group.count == 1));
    assert!(
        roots
            .iter()
            .all(|&root| plan.uses(dag, &[root]) == [vec![], vec![0]])
    );
    agree(dag, &roots, [0.7, 0.0, 1.3]);
}

#[test]
fn powers_of_powers_and_of_arguments_are_not_planned() {
    let dag = &mut Dag::default();
    let (gap, alpha) = (
        dag.variable(Variable::Gap),
        dag.variable(Variable::Argument(0)),
    );
    let inner = dag.power(gap, alpha);
    let sum = dag.sum(&[alpha, inner]);
    let roots = [dag.power(sum, alpha), dag.power(alpha, alpha)];
    let plan = Plan::of(dag, &roots);
    assert_eq!(plan.bases, [gap]);
    agree(dag, &roots, [0.7, 0.0, 1.3]);
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
