//! Laws and coefficients as data: one list of operations, and where in it each result is.
//!
//! Generated code carries these data for the interpreter, and a declaration that is read at run time is made of them, so
//! both come from here.

use std::borrow::Cow;

use hertzian_contract::data::{LawData, LevelData, Node, PieceData};
use hertzian_contract::law::{LawFacts, Variation};

use crate::dag::{Dag, Function, Id, Variable};
use crate::differentiate::differentiate;
use crate::facts::{Piece, derive, variation};
use crate::ir::{Law, Model};
use crate::primitive;
use crate::simplify::{expand, factor};
use crate::tape::{Operation, Style, Tape};

/// A law with its derivatives, as expressions and as data.
#[derive(Debug, Clone)]
pub struct Member {
    /// The law.
    pub law: Law,
    /// What is known of it.
    pub facts: LawFacts,
    /// Its pieces, in the form to be computed.
    pub pieces: Vec<Piece>,
    /// Its levels, and their derivatives by each argument.
    pub levels: Vec<(Id, Vec<Id>)>,
    /// The levels among the nodes of the family.
    pub level_data: Vec<LevelData>,
    /// The pieces among the nodes of the family.
    pub piece_data: Vec<PieceData>,
}

/// A law and, where it is linear in its rate, the spring and the primitive it consists of; they share their nodes.
#[derive(Debug, Clone)]
pub struct Family {
    /// The operations.
    pub nodes: Vec<Node>,
    /// The law itself.
    pub whole: Member,
    /// Spring and primitive.
    pub parts: Option<[Member; 2]>,
}

/// The coefficients of a model, and their derivatives.
#[derive(Debug, Clone)]
pub struct Coefficients {
    /// The operations.
    pub nodes: Vec<Node>,
    /// Where each coefficient is.
    pub values: Vec<usize>,
    /// By the frequency.
    pub by_omega: Vec<usize>,
    /// By each parameter.
    pub by_parameter: Vec<Vec<usize>>,
}

impl Family {
    /// Differentiates a law, finds its parts, and lowers all of them.
    pub fn of(dag: &mut Dag, law: &Law) -> Self {
        let parts = primitive::parts(dag, law);
        let mut whole = Member::of(dag, law);
        let mut parts =
            parts.map(|(spring, primitive)| [spring, primitive].map(|part| Member::of(dag, &part)));
        if let Some([_, primitive]) = &mut parts {
            for (integral, piece) in primitive.pieces.iter_mut().zip(&whole.pieces) {
                integral.by_gap = piece.by_rate;
            }
        }
        let mut roots = whole.roots();
        for part in parts.iter().flatten() {
            roots.extend(part.roots());
        }
        let tape = Tape::of(dag, &roots, Style::Data);
        let mut positions = tape.roots.iter().copied();
        whole.place(&mut positions);
        for part in parts.iter_mut().flatten() {
            part.place(&mut positions);
        }
        Self {
            nodes: nodes(&tape, usize::MAX),
            whole,
            parts,
        }
    }
}

impl Member {
    fn of(dag: &mut Dag, law: &Law) -> Self {
        let count = law.arguments.len();
        let mut pieces: Vec<Piece> = law
            .pieces
            .iter()
            .map(|&force| Piece::of(dag, force, count))
            .collect();
        for piece in &mut pieces {
            simplify(dag, piece);
        }
        let levels = law
            .levels
            .iter()
            .map(|level| {
                let by = |index| differentiate(dag, level.value, Variable::Argument(index));
                (level.value, (0..count).map(by).collect())
            })
            .collect();
        Self {
            facts: derive(dag, law, &pieces),
            law: law.clone(),
            pieces,
            levels,
            level_data: Vec::new(),
            piece_data: Vec::new(),
        }
    }

    /// All expressions, in the order in which [`Member::place`] takes their positions.
    fn roots(&self) -> Vec<Id> {
        let mut roots = Vec::new();
        for (value, by_argument) in &self.levels {
            roots.push(*value);
            roots.extend(by_argument);
        }
        roots.extend(self.pieces.iter().flat_map(Piece::outputs));
        roots
    }

    fn place(&mut self, positions: &mut impl Iterator<Item = usize>) {
        let mut take = |count: usize| -> Vec<usize> { positions.by_ref().take(count).collect() };
        let count = self.law.arguments.len();
        self.level_data = (0..self.levels.len())
            .map(|_| LevelData::new(take(1)[0], take(count)))
            .collect();
        self.piece_data = (0..self.pieces.len())
            .map(|_| {
                let own = [(); 3].map(|()| take(1)[0]);
                PieceData::new(own, take(count))
            })
            .collect();
    }

    /// The law as data, among the nodes of its family.
    pub fn data(&self, nodes: impl Into<Cow<'static, [Node]>>) -> LawData {
        let (levels, pieces) = (self.level_data.iter(), self.piece_data.iter());
        LawData::new(nodes, levels.cloned(), pieces.cloned())
    }
}

impl Coefficients {
    /// Differentiates and lowers the coefficients of a model.
    pub fn of(model: &mut Model) -> Self {
        let values: Vec<Id> = model.coefficients.iter().map(|&(_, id)| id).collect();
        let count = model.parameters.len();
        let variables = std::iter::once(Variable::Omega).chain((0..count).map(Variable::Parameter));
        let mut roots = values.clone();
        for by in variables {
            for &value in &values {
                roots.push(differentiate(&mut model.dag, value, by));
            }
        }
        let tape = Tape::of(&mut model.dag, &roots, Style::Data);
        let mut positions = tape.roots.iter().copied();
        let mut take = || -> Vec<usize> { positions.by_ref().take(values.len()).collect() };
        Self {
            nodes: nodes(&tape, count),
            values: take(),
            by_omega: take(),
            by_parameter: (0..count).map(|_| take()).collect(),
        }
    }
}

/// Whether the derivatives of laws and coefficients, and what is known of them, can be had with so many operands read and written: a
/// product of many factors is short, and its second derivative is not.
pub(crate) fn derivatives_fit(model: &Model, budget: u64) -> bool {
    let mut trial = model.clone();
    trial.dag.set_budget(Some(budget));
    for law in &model.laws {
        let _ = Family::of(&mut trial.dag, law);
        if trial.dag.is_spent() {
            return false;
        }
    }
    let _ = Coefficients::of(&mut trial);
    !trial.dag.is_spent()
}

/// Puts every output of a piece into the form to be computed.
fn simplify(dag: &mut Dag, piece: &mut Piece) {
    let outputs = [&mut piece.force, &mut piece.by_gap, &mut piece.by_rate];
    for output in outputs.into_iter().chain(piece.by_argument.iter_mut()) {
        // What does not vary is written without gap and rate, even where that takes multiplying out.
        if variation(dag, *output) != Variation::Varying {
            *output = expand(dag, *output);
        }
        *output = factor(dag, *output);
    }
}

/// The operations of a tape; `omega` is the argument that stands for the frequency.
fn nodes(tape: &Tape, omega: usize) -> Vec<Node> {
    let operations = tape.operations.iter();
    operations
        .map(|&operation| match operation {
            Operation::Number(value) => Node::Number(value),
            Operation::Input(Variable::Gap) => Node::Gap,
            Operation::Input(Variable::Rate) => Node::Rate,
            Operation::Input(Variable::Argument(index) | Variable::Parameter(index)) => {
                Node::Argument(index)
            }
            Operation::Input(Variable::Omega) => Node::Argument(omega),
            Operation::Add(a, b) => Node::Add(a, b),
            Operation::Subtract(a, b) => Node::Subtract(a, b),
            Operation::Multiply(a, b) => Node::Multiply(a, b),
            Operation::Divide(a, b) => Node::Divide(a, b),
            Operation::Negate(a) => Node::Negate(a),
            Operation::Integer(a, exponent) => Node::Integer(a, exponent),
            Operation::Power(a, b) => Node::Power(a, b),
            Operation::PowerLog(a, b) => Node::PowerLog(a, b),
            Operation::Call(Function::Absolute, a) => Node::Absolute(a),
            Operation::Call(Function::Sign, a) => Node::Sign(a),
            Operation::Call(Function::Sine, a) => Node::Sine(a),
            Operation::Call(Function::Cosine, a) => Node::Cosine(a),
            Operation::Call(Function::Exponential, a) => Node::Exponential(a),
            Operation::Call(Function::Tanh, a) => Node::Tanh(a),
            other => unreachable!("{other:?} is not an operation of data"),
        })
        .collect()
}
