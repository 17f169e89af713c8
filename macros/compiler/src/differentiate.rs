//! Exact derivatives.

use std::collections::HashMap;

use crate::dag::{Dag, Function, Id, Node, Rational, Variable};

/// The derivative of an expression by a variable.
///
/// `|x|' = sgn(x)`, and the derivatives of `sgn` and `H` are zero: exact everywhere but at the switch itself, which
/// lowering has turned into levels. Powers follow, for a base `u` and an exponent `a`,
///
/// ```text
/// (u^a)'      = a u^(a-1) u' + u^a ln u a'
/// (u^a ln u)' = (a u^(a-1) ln u + u^(a-1)) u' + u^a (ln u)^2 a'
/// ```
pub fn differentiate(dag: &mut Dag, id: Id, by: Variable) -> Id {
    let mut derivatives: HashMap<Id, Id> = HashMap::new();
    for current in dag.reachable(&[id]) {
        let derivative = match dag.node(current).clone() {
            Node::Number(_) | Node::Pi => dag.integer(0),
            Node::Variable(variable) => dag.integer(i32::from(variable == by)),
            Node::Sum(terms) => {
                let terms: Vec<Id> = terms.iter().map(|term| derivatives[term]).collect();
                dag.sum(&terms)
            }
            Node::Product(factors) => product(dag, &factors, &derivatives),
            Node::Power(base, exponent) => power(
                dag,
                base,
                exponent,
                derivatives[&base],
                derivatives[&exponent],
            ),
            Node::PowerLog(base, exponent) => power_log(
                dag,
                base,
                exponent,
                derivatives[&base],
                derivatives[&exponent],
            ),
            Node::Call(function, operand) => {
                let outer = call(dag, function, current, operand);
                dag.product(&[outer, derivatives[&operand]])
            }
        };
        derivatives.insert(current, derivative);
    }
    derivatives[&id]
}

fn product(dag: &mut Dag, factors: &[Id], derivatives: &HashMap<Id, Id>) -> Id {
    let mut terms = Vec::new();
    for (index, factor) in factors.iter().enumerate() {
        if is_zero(dag, derivatives[factor]) {
            continue;
        }
        let mut term = factors.to_vec();
        term[index] = derivatives[factor];
        terms.push(dag.product(&term));
    }
    dag.sum(&terms)
}

fn power(dag: &mut Dag, base: Id, exponent: Id, base_by: Id, exponent_by: Id) -> Id {
    let mut terms = Vec::new();
    if !is_zero(dag, base_by) {
        let lowered = less_one(dag, exponent);
        let lowered = dag.power(base, lowered);
        terms.push(dag.product(&[exponent, lowered, base_by]));
    }
    if !is_zero(dag, exponent_by) {
        let logarithm = dag.power_log(base, exponent);
        terms.push(dag.product(&[logarithm, exponent_by]));
    }
    dag.sum(&terms)
}

fn power_log(dag: &mut Dag, base: Id, exponent: Id, base_by: Id, exponent_by: Id) -> Id {
    let mut terms = Vec::new();
    if !is_zero(dag, base_by) {
        let lowered = less_one(dag, exponent);
        let logarithm = dag.power_log(base, lowered);
        terms.push(dag.product(&[exponent, logarithm, base_by]));
        let plain = dag.power(base, lowered);
        terms.push(dag.product(&[plain, base_by]));
    }
    if !is_zero(dag, exponent_by) {
        let zero = dag.integer(0);
        let once = dag.power_log(base, exponent);
        let again = dag.power_log(base, zero);
        terms.push(dag.product(&[once, again, exponent_by]));
    }
    dag.sum(&terms)
}

fn call(dag: &mut Dag, function: Function, whole: Id, operand: Id) -> Id {
    match function {
        Function::Absolute => dag.call(Function::Sign, operand),
        Function::Sign | Function::Step => dag.integer(0),
        Function::Sine => dag.call(Function::Cosine, operand),
        Function::Cosine => {
            let sine = dag.call(Function::Sine, operand);
            dag.negate(sine)
        }
        Function::Exponential => whole,
        Function::Tanh => {
            let one = dag.integer(1);
            let square = dag.product(&[whole, whole]);
            dag.difference(one, square)
        }
    }
}

fn less_one(dag: &mut Dag, exponent: Id) -> Id {
    let one = dag.integer(1);
    dag.difference(exponent, one)
}

fn is_zero(dag: &Dag, id: Id) -> bool {
    dag.as_number(id) == Some(Rational::ZERO)
}
