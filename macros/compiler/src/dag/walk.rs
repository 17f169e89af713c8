//! What is asked of an expression: its variables, its value, itself with parts replaced.

use std::collections::{BTreeSet, HashMap};

use super::{Dag, Function, Id, Node, Variable};

impl Dag {
    /// Every expression that `roots` consist of, themselves included, operands first.
    pub fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        let mut found: BTreeSet<Id> = BTreeSet::new();
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            if found.insert(id) {
                pending.extend(self.operands(id));
                self.charge(1);
            }
        }
        found.into_iter().collect()
    }

    /// The variables of an expression, in order.
    pub fn variables(&self, id: Id) -> Vec<Variable> {
        let found: BTreeSet<Variable> = self
            .reachable(&[id])
            .into_iter()
            .filter_map(|id| match self.node(id) {
                Node::Variable(variable) => Some(*variable),
                _ => None,
            })
            .collect();
        found.into_iter().collect()
    }

    /// Whether an expression contains a variable.
    pub fn depends_on(&self, id: Id, variable: Variable) -> bool {
        self.variables(id).contains(&variable)
    }

    /// The expression with variables replaced.
    pub fn substitute(&mut self, id: Id, by: &HashMap<Variable, Id>) -> Id {
        self.substituted(id, by)[&id]
    }

    /// What every part of an expression becomes when variables are replaced.
    pub(crate) fn substituted(&mut self, id: Id, by: &HashMap<Variable, Id>) -> HashMap<Id, Id> {
        let replacements = self
            .reachable(&[id])
            .into_iter()
            .filter_map(|id| match self.node(id) {
                Node::Variable(variable) => by.get(variable).map(|&value| (id, value)),
                _ => None,
            })
            .collect();
        self.rebuilt(id, replacements)
    }

    /// The expression with every occurrence of `from` replaced by `to`.
    pub fn replace(&mut self, id: Id, from: Id, to: Id) -> Id {
        self.rebuild(id, HashMap::from([(from, to)]))
    }

    /// Rebuilds an expression from its leaves, with `rebuilt` given in advance.
    pub(crate) fn rebuild(&mut self, id: Id, rebuilt: HashMap<Id, Id>) -> Id {
        self.rebuilt(id, rebuilt)[&id]
    }

    /// The same, and what every part of it has become.
    pub(crate) fn rebuilt(&mut self, id: Id, mut rebuilt: HashMap<Id, Id>) -> HashMap<Id, Id> {
        for current in self.reachable(&[id]) {
            if rebuilt.contains_key(&current) {
                continue;
            }
            let value = self.rebuild_node(current, &rebuilt);
            rebuilt.insert(current, value);
        }
        rebuilt
    }

    /// One node with its operands replaced; `new` has an entry for each of them.
    pub(crate) fn rebuild_node(&mut self, id: Id, new: &HashMap<Id, Id>) -> Id {
        let all = |operands: &[Id]| {
            operands
                .iter()
                .map(|operand| new[operand])
                .collect::<Vec<_>>()
        };
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Variable(_) => id,
            Node::Sum(terms) => {
                let terms = all(terms);
                self.sum(&terms)
            }
            Node::Product(factors) => {
                let factors = all(factors);
                self.product(&factors)
            }
            Node::Power(base, exponent) => self.power(new[base], new[exponent]),
            Node::PowerLog(base, exponent) => self.power_log(new[base], new[exponent]),
            Node::Call(function, operand) => self.call(*function, new[operand]),
        }
    }

    /// The value of an expression, with the guarded powers of the generated code.
    pub fn evaluate(&self, id: Id, variables: &dyn Fn(Variable) -> f64) -> f64 {
        let mut values: HashMap<Id, f64> = HashMap::new();
        for current in self.reachable(&[id]) {
            let value = match self.node(current) {
                Node::Number(number) => number.to_f64(),
                Node::Pi => std::f64::consts::PI,
                Node::Variable(variable) => variables(*variable),
                Node::Sum(terms) => terms.iter().map(|term| values[term]).sum(),
                Node::Product(factors) => factors.iter().map(|factor| values[factor]).product(),
                Node::Power(base, exponent) => {
                    let whole = self
                        .as_number(*exponent)
                        .and_then(super::Rational::to_integer);
                    match whole {
                        Some(exponent) => guarded_integer_power(values[base], exponent),
                        None => guarded_power(values[base], values[exponent]),
                    }
                }
                Node::PowerLog(base, exponent) => {
                    let base = values[base];
                    if base > 0.0 {
                        base.powf(values[exponent]) * base.ln()
                    } else {
                        0.0
                    }
                }
                Node::Call(function, operand) => call(*function, values[operand]),
            };
            values.insert(current, value);
        }
        values[&id]
    }
}

fn guarded_integer_power(base: f64, exponent: i32) -> f64 {
    if base == 0.0 && exponent < 0 {
        0.0
    } else {
        base.powi(exponent)
    }
}

fn guarded_power(base: f64, exponent: f64) -> f64 {
    if base > 0.0 {
        base.powf(exponent)
    } else if exponent == 0.0 {
        1.0
    } else {
        0.0
    }
}

fn call(function: Function, x: f64) -> f64 {
    match function {
        Function::Absolute => x.abs(),
        Function::Sign if x == 0.0 => 0.0,
        Function::Sign => x.signum(),
        Function::Step => f64::from(x > 0.0),
        Function::Sine => x.sin(),
        Function::Cosine => x.cos(),
        Function::Exponential => x.exp(),
        Function::Tanh => x.tanh(),
    }
}
