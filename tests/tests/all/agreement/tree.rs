//! Evaluates the nodes of a law in any kind of numbers.

use hertzian::generic::{LawData, Node};

/// Numbers that nodes can be evaluated in.
pub trait Numbers: Copy {
    fn number(value: f64) -> Self;
    fn add(self, other: Self) -> Self;
    fn negate(self) -> Self;
    fn multiply(self, other: Self) -> Self;
    fn divide(self, other: Self) -> Self;
    fn absolute(self) -> Self;
    fn sign(self) -> Self;
    fn integer(self, exponent: i32) -> Self;
    fn power(self, exponent: Self) -> Self;
    fn power_log(self, exponent: Self) -> Self;
    fn sine(self) -> Self;
    fn cosine(self) -> Self;
    fn exponential(self) -> Self;
    fn tanh(self) -> Self;
}

/// The values of all nodes.
pub fn evaluate<N: Numbers>(data: &LawData, gap: N, rate: N, arguments: &[N]) -> Vec<N> {
    let mut values: Vec<N> = Vec::with_capacity(data.nodes.len());
    for node in data.nodes.iter() {
        let value = match *node {
            Node::Number(value) => N::number(value),
            Node::Gap => gap,
            Node::Rate => rate,
            Node::Argument(index) => arguments[index],
            Node::Add(a, b) => values[a].add(values[b]),
            Node::Subtract(a, b) => values[a].add(values[b].negate()),
            Node::Multiply(a, b) => values[a].multiply(values[b]),
            Node::Divide(a, b) => values[a].divide(values[b]),
            Node::Negate(a) => values[a].negate(),
            Node::Absolute(a) => values[a].absolute(),
            Node::Sign(a) => values[a].sign(),
            Node::Integer(a, exponent) => values[a].integer(exponent),
            Node::Power(a, b) => values[a].power(values[b]),
            Node::PowerLog(a, b) => values[a].power_log(values[b]),
            Node::Sine(a) => values[a].sine(),
            Node::Cosine(a) => values[a].cosine(),
            Node::Exponential(a) => values[a].exponential(),
            Node::Tanh(a) => values[a].tanh(),
            _ => panic!("{node:?} is a node that is not known here"),
        };
        values.push(value);
    }
    values
}
