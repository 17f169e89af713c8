//! Derivatives and rewriting, tried on random expressions against numbers.

use crate::models::Sketch;
use hertzian_compiler::dag::{Dag, Function, Id, Rational, Variable};
use hertzian_compiler::differentiate::differentiate;
use hertzian_compiler::emit::emit;
use hertzian_compiler::simplify::{expand, factor, is_zero};
use hertzian_contract::system::Bound;
use proptest::prelude::*;
use quote::quote;

/// A random expression that is defined, and smooth, for positive variables.
#[derive(Debug, Clone)]
enum Tree {
    Number(i32, i32),
    Variable(usize),
    Sum(Vec<Tree>),
    Product(Vec<Tree>),
    Quotient(Box<Tree>, Box<Tree>),
    Power(Box<Tree>, i32, i32),
    RuntimePower(Box<Tree>, Box<Tree>),
    Logarithm(Box<Tree>, i32),
    Call(Function, Box<Tree>),
}

const VARIABLES: [Variable; 3] = [Variable::Gap, Variable::Rate, Variable::Argument(0)];

fn trees() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (-5..=5, 1..=4).prop_map(|(numerator, denominator)| Tree::Number(numerator, denominator)),
        (0..3_usize).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(4, 24, 3, |inner| {
        let boxed = inner.clone().prop_map(Box::new);
        let function = prop_oneof![
            Just(Function::Sine),
            Just(Function::Cosine),
            Just(Function::Tanh),
            Just(Function::Absolute),
        ];
        prop_oneof![
            prop::collection::vec(inner.clone(), 2..4).prop_map(Tree::Sum),
            prop::collection::vec(inner.clone(), 2..4).prop_map(Tree::Product),
            (boxed.clone(), boxed.clone()).prop_map(|(a, b)| Tree::Quotient(a, b)),
            (boxed.clone(), -3..=6, 1..=3).prop_map(|(a, n, d)| Tree::Power(a, n, d)),
            (boxed.clone(), boxed.clone()).prop_map(|(a, b)| Tree::RuntimePower(a, b)),
            (boxed.clone(), -1..=2).prop_map(|(a, e)| Tree::Logarithm(a, e)),
            (function, boxed).prop_map(|(function, a)| Tree::Call(function, a)),
        ]
    })
}

/// `1 + x^2`, so that every base and divisor is positive.
fn positive(dag: &mut Dag, tree: &Tree) -> Id {
    let inner = build(dag, tree);
    let square = dag.product(&[inner, inner]);
    let one = dag.integer(1);
    dag.sum(&[one, square])
}

fn build(dag: &mut Dag, tree: &Tree) -> Id {
    match tree {
        Tree::Number(numerator, denominator) => ratio(dag, *numerator, *denominator),
        Tree::Variable(index) => dag.variable(VARIABLES[*index]),
        Tree::Sum(terms) => {
            let terms: Vec<Id> = terms.iter().map(|term| build(dag, term)).collect();
            dag.sum(&terms)
        }
        Tree::Product(factors) => {
            let factors: Vec<Id> = factors.iter().map(|factor| build(dag, factor)).collect();
            dag.product(&factors)
        }
        Tree::Quotient(a, b) => {
            let (a, b) = (build(dag, a), positive(dag, b));
            dag.quotient(a, b)
        }
        Tree::Power(base, numerator, denominator) => {
            let (base, exponent) = (positive(dag, base), ratio(dag, *numerator, *denominator));
            dag.power(base, exponent)
        }
        Tree::RuntimePower(base, exponent) => {
            let (base, exponent) = (positive(dag, base), build(dag, exponent));
            let exponent = dag.call(Function::Tanh, exponent);
            dag.power(base, exponent)
        }
        Tree::Logarithm(base, exponent) => {
            let (base, exponent) = (positive(dag, base), dag.integer(*exponent));
            dag.power_log(base, exponent)
        }
        Tree::Call(function, operand) => {
            let operand = build(dag, operand);
            dag.call(*function, operand)
        }
    }
}

fn ratio(dag: &mut Dag, numerator: i32, denominator: i32) -> Id {
    dag.number(Rational::new(numerator.into(), denominator.into()).expect("not zero"))
}

/// The value of a tree without the graph, by the definition of each operation.
fn direct(tree: &Tree, at: &[f64; 3]) -> f64 {
    let positive = |tree: &Tree| 1.0 + direct(tree, at).powi(2);
    match tree {
        Tree::Number(numerator, denominator) => f64::from(*numerator) / f64::from(*denominator),
        Tree::Variable(index) => at[*index],
        Tree::Sum(terms) => terms.iter().map(|term| direct(term, at)).sum(),
        Tree::Product(factors) => factors.iter().map(|factor| direct(factor, at)).product(),
        Tree::Quotient(a, b) => direct(a, at) / positive(b),
        Tree::Power(base, numerator, denominator) => {
            positive(base).powf(f64::from(*numerator) / f64::from(*denominator))
        }
        Tree::RuntimePower(base, exponent) => positive(base).powf(direct(exponent, at).tanh()),
        Tree::Logarithm(base, exponent) => positive(base).powi(*exponent) * positive(base).ln(),
        Tree::Call(function, operand) => {
            let x = direct(operand, at);
            match function {
                // Of so large an angle rounding leaves nothing; such a case is passed over.
                Function::Sine | Function::Cosine if x.abs() > 1e3 => f64::NAN,
                Function::Sine => x.sin(),
                Function::Cosine => x.cos(),
                Function::Tanh => x.tanh(),
                _ => x.abs(),
            }
        }
    }
}

fn value(dag: &Dag, id: Id, at: &[f64; 3]) -> f64 {
    dag.evaluate(id, &|variable| match variable {
        Variable::Gap => at[0],
        Variable::Rate => at[1],
        _ => at[2],
    })
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs() + b.abs())
}

/// How much values beside each other differ: where terms of a sum cancel, as those of a polynomial of high degree do, by what is rounded.
fn rounding(dag: &Dag, id: Id, at: &[f64; 3]) -> f64 {
    let beside = (0..16).map(|step| {
        let factor = 1.0 + 1e-14 * f64::from(step);
        value(dag, id, &at.map(|x| factor * x))
    });
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in beside {
        if value.is_nan() {
            return f64::NAN;
        }
        (low, high) = (low.min(value), high.max(value));
    }
    high - low
}

/// A fourth-order central difference, from the trees themselves; `None` where two step sizes disagree.
fn difference(tree: &Tree, at: &[f64; 3], index: usize) -> Option<f64> {
    let central = |step: f64| {
        let shifted = |by: f64| {
            let mut at = *at;
            at[index] += by * step;
            direct(tree, &at)
        };
        (8.0 * (shifted(1.0) - shifted(-1.0)) - (shifted(2.0) - shifted(-2.0))) / (12.0 * step)
    };
    let (coarse, fine) = (central(4e-4), central(2e-4));
    // Beside a large constant the difference is lost to rounding.
    let small = direct(tree, at).abs() < 1e4;
    (small && close(coarse, fine, 1e-7)).then_some(fine)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn canonical_forms_keep_the_value(tree in trees(), at in [0.2..1.5_f64, 0.2..1.5, 0.2..1.5]) {
        let dag = &mut Dag::default();
        let id = build(dag, &tree);
        let expected = direct(&tree, &at);
        prop_assume!(expected.is_finite() && expected.abs() < 1e6);
        prop_assert!(close(value(dag, id, &at), expected, 1e-8));
        let factored = factor(dag, id);
        prop_assert!(close(value(dag, factored, &at), expected, 1e-8));
        let expanded = expand(dag, id);
        let rounded = rounding(dag, expanded, &at);
        prop_assume!(rounded.is_finite());
        let off = (value(dag, expanded, &at) - expected).abs();
        prop_assert!(off <= 1e-8 * (1.0 + expected.abs()) + 10.0 * rounded, "{} and {}", off, rounded);
    }

    #[test]
    fn derivatives_agree_with_differences(tree in trees(), at in [0.2..1.5_f64, 0.2..1.5, 0.2..1.5]) {
        let dag = &mut Dag::default();
        let id = build(dag, &tree);
        for (index, variable) in VARIABLES.into_iter().enumerate() {
            let derivative = differentiate(dag, id, variable);
            let derivative = factor(dag, derivative);
            if let Some(expected) = difference(&tree, &at, index).filter(|d| d.abs() < 1e4) {
                let exact = value(dag, derivative, &at);
                prop_assert!(close(exact, expected, 1e-5), "{} against {}", exact, expected);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_law_can_be_emitted(below in trees(), above in trees()) {
        let any = (Bound::Unbounded, Bound::Unbounded);
        let mut sketch = Sketch::new(&[("a", any)]);
        let pieces = [build(&mut sketch.dag, &below), build(&mut sketch.dag, &above)];
        let level = sketch.argument(0);
        let law = sketch.law("any", &[(level, false)], &pieces);
        let tokens = emit(&quote!(::hertzian), &sketch.model("Any", law));
        prop_assert!(syn::parse2::<syn::File>(tokens).is_ok());
    }
}

#[test]
fn derivative_by_the_exponent_is_the_power_times_its_logarithm() {
    let dag = &mut Dag::default();
    let (gap, alpha) = (
        dag.variable(Variable::Gap),
        dag.variable(Variable::Argument(0)),
    );
    let power = dag.power(gap, alpha);
    let by = differentiate(dag, power, Variable::Argument(0));
    assert_eq!(by, dag.power_log(gap, alpha));
    let both = differentiate(dag, by, Variable::Gap);
    let at = [0.7, 0.0, 1.3];
    let expected = 1.3 * 0.7_f64.powf(0.3) * 0.7_f64.ln() + 0.7_f64.powf(0.3);
    assert!(close(value(dag, both, &at), expected, 1e-14));
}

#[test]
fn absolute_value_has_the_sign_as_derivative() {
    let dag = &mut Dag::default();
    let rate = dag.variable(Variable::Rate);
    let absolute = dag.call(Function::Absolute, rate);
    let drag = dag.product(&[absolute, rate]);
    let derivative = differentiate(dag, drag, Variable::Rate);
    for speed in [-2.0, 0.0, 3.0_f64] {
        assert_eq!(
            value(dag, derivative, &[0.0, speed, 0.0]),
            2.0 * speed.abs()
        );
    }
}

#[test]
fn identities_are_recognised() {
    let dag = &mut Dag::default();
    let gap = dag.variable(Variable::Gap);
    let (one, two, four, eight) = (
        dag.integer(1),
        dag.integer(2),
        dag.integer(4),
        dag.integer(8),
    );
    let sum = dag.sum(&[gap, one]);
    let square = dag.power(sum, two);
    let own = dag.product(&[gap, gap]);
    let twice = dag.product(&[two, gap]);
    let polynomial = dag.sum(&[own, twice, one]);
    let difference = dag.difference(square, polynomial);
    assert_eq!(expand(dag, difference), dag.integer(0));
    let probe = |trial: usize, _| 0.3 + trial as f64;
    let exponent = ratio(dag, 3, 2);
    let scaled = dag.product(&[four, gap]);
    let (left, right) = (dag.power(scaled, exponent), dag.power(gap, exponent));
    let right = dag.product(&[eight, right]);
    let difference = dag.difference(left, right);
    assert!(is_zero(dag, difference, &probe));
    assert!(!is_zero(dag, left, &probe));
}

#[test]
fn common_factors_are_taken_out() {
    let dag = &mut Dag::default();
    let (gap, rate) = (dag.variable(Variable::Gap), dag.variable(Variable::Rate));
    let exponent = ratio(dag, 3, 2);
    let power = dag.power(gap, exponent);
    let damped = dag.product(&[power, rate]);
    let sum = dag.sum(&[power, damped]);
    let factored = factor(dag, sum);
    let name = |variable: Variable| format!("{variable:?}").to_lowercase();
    assert_eq!(dag.display(factored, &name), "gap^1.5*(rate + 1)");
}
