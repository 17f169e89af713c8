//! Hash-consed expressions in canonical form.
//!
//! Equal expressions have equal positions, and operands come before their use, so a walk in order of position is a walk
//! from leaves to root and needs no recursion.
//!
//! # Canonical form
//!
//! - Sums and products are flattened and sorted; numbers, zeros and ones are folded; like terms are collected
//!   (`2 x + 3 x = 5 x`) and powers of one base are merged (`x x^2 = x^3`); a number times a sum is multiplied out.
//! - Powers of one base are merged *as limits*: `g^1.5 g^-1 = g^0.5`, `x x^-1 = 1`. The two sides can differ only where
//!   the base is zero, where the guarded negative power is defined as zero by fiat and the limit is the better value.
//! - A power that is not an integer has a base that is not negative where it is used, so `(x^a)^b = x^(a b)`, but
//!   `(x^2)^(1/2) = |x|`.
//! - Exact numbers that would not fit into 128 bits stay unevaluated.

mod construct;
mod display;
mod rational;
mod walk;

use std::cell::Cell;
use std::collections::HashMap;

pub use rational::Rational;

/// Position of an expression in its [`Dag`]. Equal expressions have equal positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub(crate) u32);

/// What an expression may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variable {
    /// Gap of a law.
    Gap,
    /// Rate of the gap.
    Rate,
    /// Base of powers of several pieces of a law, on each piece its own.
    Base(usize),
    /// Argument of a law.
    Argument(usize),
    /// Parameter of the model.
    Parameter(usize),
    /// Excitation frequency.
    Omega,
    /// Time.
    Time,
    /// Coordinate `q_i`.
    Coordinate(usize),
    /// Its first derivative by time.
    Velocity(usize),
    /// Its second derivative by time.
    Acceleration(usize),
}

impl Variable {
    /// Whether it changes from sample to sample of a law.
    pub fn varies(self) -> bool {
        matches!(self, Self::Gap | Self::Rate | Self::Base(_))
    }
}

/// Functions of one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Function {
    Absolute,
    Sign,
    /// Heaviside step: one for a positive operand, zero otherwise.
    Step,
    Sine,
    Cosine,
    Exponential,
    Tanh,
}

/// One expression; operands are positions. Sums and products are flattened, sorted and have at least two operands.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Node {
    Number(Rational),
    /// The number pi.
    Pi,
    Variable(Variable),
    Sum(Vec<Id>),
    /// A number, if there is one, comes first.
    Product(Vec<Id>),
    /// Guarded power; quotients are powers of exponent -1.
    Power(Id, Id),
    /// `base^exponent * ln(base)`, guarded: what the derivative of a power by its exponent is.
    PowerLog(Id, Id),
    Call(Function, Id),
}

/// The graph: every expression once.
#[derive(Debug, Default, Clone)]
pub struct Dag {
    nodes: Vec<Node>,
    positions: HashMap<Node, Id>,
    /// Operands read and written so far.
    work: Cell<u64>,
    /// The most there may be; `None` without a limit.
    budget: Option<u64>,
}

impl Dag {
    /// The node at a position.
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// The value of a number; `None` for any other expression.
    pub fn as_number(&self, id: Id) -> Option<Rational> {
        match self.node(id) {
            Node::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// The operands of a node.
    pub fn operands(&self, id: Id) -> Vec<Id> {
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Variable(_) => Vec::new(),
            Node::Sum(operands) | Node::Product(operands) => operands.clone(),
            Node::Power(base, exponent) | Node::PowerLog(base, exponent) => vec![*base, *exponent],
            Node::Call(_, operand) => vec![*operand],
        }
    }

    /// Limits the work from here on. Once it is spent, whatever is built is zero and worth nothing: who sets a budget asks
    /// [`Dag::is_spent`] before the result is used.
    pub(crate) fn set_budget(&mut self, budget: Option<u64>) {
        self.work.set(0);
        self.budget = budget;
    }

    /// Whether the budget has been spent.
    pub(crate) fn is_spent(&self) -> bool {
        self.budget.is_some_and(|budget| self.work.get() > budget)
    }

    /// Notes work.
    fn charge(&self, operands: usize) {
        self.work
            .set(self.work.get().saturating_add(operands as u64));
    }

    /// The position of a node that is canonical already.
    pub(crate) fn intern(&mut self, node: Node) -> Id {
        if let Some(&id) = self.positions.get(&node) {
            return id;
        }
        let id =
            Id(u32::try_from(self.nodes.len())
                .expect("fewer than 2^32 expressions fit into memory"));
        self.nodes.push(node.clone());
        self.positions.insert(node, id);
        id
    }
}
