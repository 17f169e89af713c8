//! Straight-line programs over blocks of samples: what the interpreter runs.
//!
//! A program holds the operations that its outputs need and no others. Those that depend on numbers and arguments
//! alone are *hoisted*: they run once per call, on one value. The others run once per block, each over the whole block
//! before the next starts, so that the cost of decoding an operation is shared by [`BLOCK`] samples.
//!
//! Powers are computed by the library's power function, one by one, except for exponents 1/2 and 3/2: the interpreter is
//! what generated code is checked against, so it does not share the logarithm that generated code shares.

use std::ops::Range;

use super::Node;
use crate::laws::emitted::{exponential, power, reciprocal, sign};

/// Samples per block. A slot takes 512 bytes, so programs of some sixty operations stay in the first level of the
/// cache.
pub(super) const BLOCK: usize = 64;

/// The values of one operation over a block; a hoisted operation uses the first entry only.
pub(super) type Slot = [f64; BLOCK];

/// Operations in the order of their execution, and where the outputs are.
#[derive(Debug, Clone)]
pub(super) struct Program {
    /// The result of step `i` goes to slot `i`.
    steps: Vec<Step>,
    /// The number of steps that are hoisted; they come first.
    hoisted: usize,
    outputs: Vec<Operand>,
}

/// What a program is run on: at most [`BLOCK`] samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inputs<'a> {
    pub(super) arguments: &'a [f64],
    pub(super) gap: &'a [f64],
    pub(super) rate: &'a [f64],
}

/// The values of an operand over a block.
#[derive(Debug, Clone, Copy)]
pub(super) enum Values<'a> {
    /// The same for every sample.
    Scalar(f64),
    /// One per sample.
    Block(&'a [f64]),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Step {
    operation: Operation,
    left: Operand,
    /// Equal to `left` where the operation has one operand.
    right: Operand,
}

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Operand {
    Gap,
    Rate,
    /// The result of a hoisted step.
    Scalar(usize),
    /// The result of a step per block.
    Block(usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Operation {
    Number(f64),
    Argument(usize),
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Absolute,
    Sign,
    Integer(i32),
    /// Guarded `left^right`.
    Power,
    /// Guarded `left^(1/2)`.
    Root,
    /// Guarded `left^(3/2)`.
    ThreeHalves,
    /// `left * ln right`, zero unless `right` is positive. With a guarded power on the left it is the derivative of
    /// that power by its exponent, and the power is computed once.
    TimesLog,
    Sine,
    Cosine,
    Exponential,
    Tanh,
}

impl Program {
    /// The program that computes the given nodes, which are there and come after their operands.
    pub(super) fn new(nodes: &[Node], outputs: &[usize]) -> Self {
        let needed = needed(nodes, outputs);
        let varying = varying(nodes);
        let mut builder = Builder {
            nodes,
            steps: Vec::new(),
            operands: vec![Operand::Gap; nodes.len()],
        };
        let chosen = |hoisted: bool| {
            let (needed, varying) = (&needed, &varying);
            (0..nodes.len()).filter(move |&i| needed[i] && varying[i] != hoisted)
        };
        for position in chosen(true) {
            builder.translate(position, Operand::Scalar);
        }
        let hoisted = builder.steps.len();
        for position in chosen(false) {
            builder.translate(position, Operand::Block);
        }
        Self {
            outputs: outputs.iter().map(|&node| builder.operands[node]).collect(),
            steps: builder.steps,
            hoisted,
        }
    }

    /// The number of slots a run needs.
    pub(super) fn slots(&self) -> usize {
        self.steps.len()
    }

    /// Whether no output depends on gap or rate.
    pub(super) fn is_constant(&self) -> bool {
        let constant = |output: &Operand| matches!(output, Operand::Scalar(_));
        self.outputs.iter().all(constant)
    }

    /// Runs what does not depend on the samples; it must precede the blocks of a call.
    pub(super) fn run_hoisted(&self, inputs: Inputs<'_>, slots: &mut [Slot]) {
        self.run(0..self.hoisted, 1, inputs, slots);
    }

    /// Runs one block.
    pub(super) fn run_block(&self, inputs: Inputs<'_>, slots: &mut [Slot]) {
        self.run(
            self.hoisted..self.steps.len(),
            inputs.gap.len(),
            inputs,
            slots,
        );
    }

    /// The values of an output after a run.
    pub(super) fn output<'a>(
        &self,
        index: usize,
        inputs: Inputs<'a>,
        slots: &'a [Slot],
    ) -> Values<'a> {
        self.outputs[index].values(inputs.gap.len(), inputs, slots)
    }

    fn run(&self, steps: Range<usize>, length: usize, inputs: Inputs<'_>, slots: &mut [Slot]) {
        for position in steps {
            let step = self.steps[position];
            let (before, result) = slots.split_at_mut(position);
            let left = step.left.values(length, inputs, before);
            let right = step.right.values(length, inputs, before);
            let result = &mut result[0][..length];
            step.operation.run(left, right, inputs.arguments, result);
        }
    }
}

impl Operand {
    fn values<'a>(self, length: usize, inputs: Inputs<'a>, slots: &'a [Slot]) -> Values<'a> {
        match self {
            Self::Gap => Values::Block(inputs.gap),
            Self::Rate => Values::Block(inputs.rate),
            Self::Scalar(slot) => Values::Scalar(slots[slot][0]),
            Self::Block(slot) => Values::Block(&slots[slot][..length]),
        }
    }
}

impl Operation {
    fn run(self, left: Values<'_>, right: Values<'_>, arguments: &[f64], result: &mut [f64]) {
        match self {
            Self::Number(number) => result.fill(number),
            Self::Argument(index) => result.fill(arguments[index]),
            Self::Add => pairs(left, right, result, |a, b| a + b),
            Self::Subtract => pairs(left, right, result, |a, b| a - b),
            Self::Multiply => pairs(left, right, result, |a, b| a * b),
            Self::Divide => pairs(left, right, result, |a, b| a / b),
            Self::Negate => each(left, result, |a| -a),
            Self::Absolute => each(left, result, f64::abs),
            Self::Sign => each(left, result, sign),
            Self::Integer(2) => each(left, result, |a| a * a),
            Self::Integer(3) => each(left, result, |a| a * a * a),
            Self::Integer(exponent @ 0..) => each(left, result, |a| a.powi(exponent)),
            Self::Integer(exponent) => each(left, result, |a| reciprocal(a.powi(-exponent))),
            Self::Power => pairs(left, right, result, power),
            Self::Root => each(left, result, |a| if a > 0.0 { a.sqrt() } else { 0.0 }),
            Self::ThreeHalves => each(left, result, |a| if a > 0.0 { a * a.sqrt() } else { 0.0 }),
            Self::TimesLog => pairs(
                left,
                right,
                result,
                |a, b| {
                    if b > 0.0 { a * b.ln() } else { 0.0 }
                },
            ),
            Self::Sine => each(left, result, f64::sin),
            Self::Cosine => each(left, result, f64::cos),
            Self::Exponential => each(left, result, exponential),
            Self::Tanh => each(left, result, f64::tanh),
        }
    }
}

fn each(of: Values<'_>, result: &mut [f64], f: impl Fn(f64) -> f64) {
    match of {
        Values::Scalar(a) => result.fill(f(a)),
        Values::Block(a) => {
            for (result, &a) in result.iter_mut().zip(a) {
                *result = f(a);
            }
        }
    }
}

fn pairs(left: Values<'_>, right: Values<'_>, result: &mut [f64], f: impl Fn(f64, f64) -> f64) {
    match (left, right) {
        (Values::Scalar(a), right) => each(right, result, |b| f(a, b)),
        (left, Values::Scalar(b)) => each(left, result, |a| f(a, b)),
        (Values::Block(a), Values::Block(b)) => {
            for ((result, &a), &b) in result.iter_mut().zip(a).zip(b) {
                *result = f(a, b);
            }
        }
    }
}

/// Translates nodes to steps.
struct Builder<'a> {
    nodes: &'a [Node],
    steps: Vec<Step>,
    /// Where the value of each translated node is.
    operands: Vec<Operand>,
}

impl Builder<'_> {
    /// Appends the steps of one node; `place` names the slot of a step.
    fn translate(&mut self, position: usize, place: fn(usize) -> Operand) {
        let at = |operand: usize| self.operands[operand];
        let one = |operation, a| (operation, at(a), at(a));
        let two = |operation, a, b| (operation, at(a), at(b));
        let none = |operation| (operation, Operand::Gap, Operand::Gap);
        let (operation, left, right) = match self.nodes[position] {
            Node::Gap => return self.operands[position] = Operand::Gap,
            Node::Rate => return self.operands[position] = Operand::Rate,
            Node::Number(number) => none(Operation::Number(number)),
            Node::Argument(index) => none(Operation::Argument(index)),
            Node::Add(a, b) => two(Operation::Add, a, b),
            Node::Subtract(a, b) => two(Operation::Subtract, a, b),
            Node::Multiply(a, b) => two(Operation::Multiply, a, b),
            Node::Divide(a, b) => two(Operation::Divide, a, b),
            Node::Negate(a) => one(Operation::Negate, a),
            Node::Absolute(a) => one(Operation::Absolute, a),
            Node::Sign(a) => one(Operation::Sign, a),
            Node::Integer(a, exponent) => one(Operation::Integer(exponent), a),
            Node::Power(a, b) => self.power(a, b),
            Node::PowerLog(a, b) => {
                let (operation, left, right) = self.power(a, b);
                let power = self.push(operation, left, right, place);
                (Operation::TimesLog, power, self.operands[a])
            }
            Node::Sine(a) => one(Operation::Sine, a),
            Node::Cosine(a) => one(Operation::Cosine, a),
            Node::Exponential(a) => one(Operation::Exponential, a),
            Node::Tanh(a) => one(Operation::Tanh, a),
            // Of a later version of the contract, which this one is not built with.
            _ => none(Operation::Number(f64::NAN)),
        };
        self.operands[position] = self.push(operation, left, right, place);
    }

    /// A power, by a square root where its exponent is known to allow that.
    fn power(&self, base: usize, exponent: usize) -> (Operation, Operand, Operand) {
        let operand = self.operands[base];
        match by_root(self.nodes[exponent]) {
            Some(operation) => (operation, operand, operand),
            None => (Operation::Power, operand, self.operands[exponent]),
        }
    }

    /// The result of a step, which is appended unless it is there already.
    fn push(
        &mut self,
        operation: Operation,
        left: Operand,
        right: Operand,
        place: fn(usize) -> Operand,
    ) -> Operand {
        let step = Step {
            operation,
            left,
            right,
        };
        let known = self.steps.iter().position(|&known| known == step);
        place(known.unwrap_or_else(|| {
            self.steps.push(step);
            self.steps.len() - 1
        }))
    }
}

/// The operation for a power whose exponent is the given node, if there is a quicker one than the general power.
fn by_root(exponent: Node) -> Option<Operation> {
    match exponent {
        Node::Number(0.5) => Some(Operation::Root),
        Node::Number(1.5) => Some(Operation::ThreeHalves),
        _ => None,
    }
}

/// The operands of a node that its steps read.
fn operands(nodes: &[Node], position: usize) -> [Option<usize>; 2] {
    match nodes[position] {
        Node::Power(a, b) | Node::PowerLog(a, b) => {
            [Some(a), Some(b).filter(|&b| by_root(nodes[b]).is_none())]
        }
        node => node.operands(),
    }
}

/// Which nodes the outputs need.
pub(super) fn needed(nodes: &[Node], outputs: &[usize]) -> Vec<bool> {
    let mut needed = vec![false; nodes.len()];
    for &output in outputs {
        needed[output] = true;
    }
    for position in (0..nodes.len()).rev() {
        if needed[position] {
            for operand in operands(nodes, position).into_iter().flatten() {
                debug_assert!(
                    operand < position,
                    "node {position} does not come after its operand {operand}"
                );
                needed[operand] = true;
            }
        }
    }
    needed
}

/// Which nodes depend on gap or rate.
pub(super) fn varying(nodes: &[Node]) -> Vec<bool> {
    let mut varying = vec![false; nodes.len()];
    for position in 0..nodes.len() {
        let from_operands = operands(nodes, position)
            .into_iter()
            .flatten()
            .any(|operand| varying[operand]);
        varying[position] = from_operands || matches!(nodes[position], Node::Gap | Node::Rate);
    }
    varying
}
