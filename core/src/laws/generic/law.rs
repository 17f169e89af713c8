//! A law that is evaluated by running its data.

use std::cell::RefCell;

use super::consistent::{DataError, check};
use super::program::{BLOCK, Inputs, Program, Slot, Values};
use super::{LawData, Node};
use crate::law::{Derivatives, Law, LawFacts, On, Parts};

/// A law that is evaluated by interpreting its [`LawData`].
///
/// Programs for every kind of call are made once, when the law is. A call walks over its samples in blocks; with
/// [`On::AllPieces`] a block is evaluated on the pieces that occur in it, and each sample takes the value of its own.
/// The working memory is one per thread: it grows when a law first needs more, and is kept, so that repeated calls do
/// not allocate.
#[derive(Debug, Clone)]
pub struct InterpretedLaw {
    facts: LawFacts,
    data: LawData,
    levels: Program,
    levels_by: Vec<Program>,
    pieces: Vec<Piece>,
    parts: Option<Box<[InterpretedLaw; 2]>>,
}

/// The programs of one piece, by kind of call.
#[derive(Debug, Clone)]
struct Piece {
    /// Outputs: force.
    force: Program,
    /// Outputs: force, by gap, by rate.
    derivatives: Program,
    /// For each argument. Outputs: force, by gap, by rate, by that argument.
    by_argument: Vec<Program>,
}

/// The kinds of call, each with its own programs.
#[derive(Debug, Clone, Copy)]
enum Call {
    Force,
    Derivatives,
    By(usize),
}

/// Working memory of a call.
struct Scratch {
    slots: Vec<Slot>,
    levels: Vec<f64>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> =
        const { RefCell::new(Scratch { slots: Vec::new(), levels: Vec::new() }) };
}

impl InterpretedLaw {
    /// A law of given facts and data, without [`parts`](Law::parts).
    ///
    /// # Errors
    /// If facts and data do not describe one law: their counts of levels, pieces or arguments differ, a node does not
    /// come after its operands, a position or the index of an argument is out of range, or a level depends on gap or
    /// rate. What the compiler makes is never so.
    pub fn new(facts: LawFacts, data: LawData) -> Result<Self, DataError> {
        check(&facts, &data)?;
        Ok(Self::compiled(facts, data))
    }

    /// The same of facts and data that are known to describe one law.
    pub(super) fn compiled(facts: LawFacts, data: LawData) -> Self {
        let nodes = &data.nodes;
        let values: Vec<usize> = data.levels.iter().map(|level| level.value).collect();
        let levels_by = |argument| {
            let outputs: Vec<usize> = data
                .levels
                .iter()
                .map(|level| level.by_argument[argument])
                .collect();
            constant(nodes, &outputs)
        };
        Self {
            levels: constant(nodes, &values),
            levels_by: (0..facts.arguments.len()).map(levels_by).collect(),
            pieces: data
                .pieces
                .iter()
                .map(|piece| {
                    let basic = [piece.force, piece.by_gap, piece.by_rate];
                    let by = |&by: &usize| Program::new(nodes, &[&basic[..], &[by]].concat());
                    Piece {
                        force: Program::new(nodes, &basic[..1]),
                        derivatives: Program::new(nodes, &basic),
                        by_argument: piece.by_argument.iter().map(by).collect(),
                    }
                })
                .collect(),
            parts: None,
            facts,
            data,
        }
    }

    /// The same law with the spring and the primitive of [`Law::parts`].
    #[must_use]
    pub fn with_parts(self, spring: Self, primitive: Self) -> Self {
        Self {
            parts: Some(Box::new([spring, primitive])),
            ..self
        }
    }

    /// The interpreted twin of a law, made from the law's own facts and data; `None` if it or one of its parts has no data, or
    /// data that do not describe it.
    pub fn of(law: &dyn Law) -> Option<Self> {
        let twin = |law: &dyn Law| Self::new(law.facts().clone(), law.data()?.clone()).ok();
        let whole = twin(law)?;
        Some(match law.parts() {
            None => whole,
            Some(parts) => whole.with_parts(twin(parts.spring)?, twin(parts.primitive)?),
        })
    }

    fn evaluate(&self, call: Call, on: On, inputs: Inputs<'_>, out: &mut [&mut [f64]]) {
        SCRATCH.with_borrow_mut(|scratch| match on {
            On::Piece(piece) => self.on_piece(piece, call, inputs, scratch, out),
            On::AllPieces if self.pieces.len() == 1 => {
                self.on_piece(0, call, inputs, scratch, out);
            }
            On::AllPieces => self.on_all_pieces(call, inputs, scratch, out),
        });
    }

    fn on_piece(
        &self,
        piece: usize,
        call: Call,
        inputs: Inputs<'_>,
        scratch: &mut Scratch,
        out: &mut [&mut [f64]],
    ) {
        let program = self.pieces[piece].program(call);
        let slots = scratch.slots(program.slots());
        program.run_hoisted(inputs, slots);
        for (start, block) in blocks(inputs) {
            program.run_block(block, slots);
            for (index, out) in out.iter_mut().enumerate() {
                let out = &mut out[start..start + block.gap.len()];
                copy(program.output(index, block, slots), out);
            }
        }
    }

    /// Sampled evaluation. The slots of the pieces lie one after the other, so that hoisted values outlast a block.
    fn on_all_pieces(
        &self,
        call: Call,
        inputs: Inputs<'_>,
        scratch: &mut Scratch,
        out: &mut [&mut [f64]],
    ) {
        let programs = || self.pieces.iter().map(|piece| piece.program(call));
        let needed = programs().map(Program::slots).sum::<usize>();
        scratch.slots(needed.max(self.levels.slots()));
        let Scratch { slots, levels } = scratch;

        levels.resize(self.facts.levels.len(), 0.0);
        run_constant(&self.levels, inputs, slots, levels);
        let mut start_of_slots = 0;
        for program in programs() {
            program.run_hoisted(inputs, &mut slots[start_of_slots..]);
            start_of_slots += program.slots();
        }
        for (start, block) in blocks(inputs) {
            let length = block.gap.len();
            let chosen = &self.pieces_of(block.gap, levels)[..length];
            let mut start_of_slots = 0;
            for (piece, program) in programs().enumerate() {
                if chosen.contains(&piece) {
                    let slots = &mut slots[start_of_slots..];
                    program.run_block(block, slots);
                    for (index, out) in out.iter_mut().enumerate() {
                        let values = program.output(index, block, slots);
                        select(values, piece, chosen, &mut out[start..start + length]);
                    }
                }
                start_of_slots += program.slots();
            }
        }
    }

    /// The piece of every gap of a block: the number of levels it lies above.
    fn pieces_of(&self, gap: &[f64], levels: &[f64]) -> [usize; BLOCK] {
        let mut pieces = [0; BLOCK];
        for (&level, facts) in levels.iter().zip(self.facts.levels.iter()) {
            for (piece, &gap) in pieces.iter_mut().zip(gap) {
                *piece += usize::from(gap > level || (facts.belongs_above && gap == level));
            }
        }
        pieces
    }
}

impl Law for InterpretedLaw {
    fn facts(&self) -> &LawFacts {
        &self.facts
    }

    fn data(&self) -> Option<&LawData> {
        Some(&self.data)
    }

    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        evaluate_constant(&self.levels, arguments, levels);
    }

    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) {
        evaluate_constant(&self.levels_by[argument], arguments, by_argument);
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        let inputs = Inputs {
            arguments,
            gap,
            rate,
        };
        self.evaluate(Call::Force, on, inputs, &mut [force]);
    }

    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        let inputs = Inputs {
            arguments,
            gap,
            rate,
        };
        let out = &mut [out.force, out.by_gap, out.by_rate];
        self.evaluate(Call::Derivatives, on, inputs, out);
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        let inputs = Inputs {
            arguments,
            gap,
            rate,
        };
        let out = &mut [out.force, out.by_gap, out.by_rate, by_argument];
        self.evaluate(Call::By(argument), on, inputs, out);
    }

    fn parts(&self) -> Option<Parts<'_>> {
        self.parts
            .as_deref()
            .map(|[spring, primitive]| Parts::new(spring, primitive))
    }
}

impl Piece {
    fn program(&self, call: Call) -> &Program {
        match call {
            Call::Force => &self.force,
            Call::Derivatives => &self.derivatives,
            Call::By(argument) => &self.by_argument[argument],
        }
    }
}

impl Scratch {
    /// At least this many slots.
    fn slots(&mut self, count: usize) -> &mut [Slot] {
        if self.slots.len() < count {
            self.slots.resize(count, [0.0; BLOCK]);
        }
        &mut self.slots
    }
}

/// The blocks of a batch, each with the position of its first sample.
fn blocks(inputs: Inputs<'_>) -> impl Iterator<Item = (usize, Inputs<'_>)> {
    let chunks = inputs.gap.chunks(BLOCK).zip(inputs.rate.chunks(BLOCK));
    chunks.enumerate().map(move |(index, (gap, rate))| {
        let arguments = inputs.arguments;
        let block = Inputs {
            arguments,
            gap,
            rate,
        };
        (index * BLOCK, block)
    })
}

fn copy(values: Values<'_>, out: &mut [f64]) {
    match values {
        Values::Scalar(value) => out.fill(value),
        Values::Block(values) => out.copy_from_slice(values),
    }
}

/// Copies the values of the samples that lie on `piece`.
fn select(values: Values<'_>, piece: usize, chosen: &[usize], out: &mut [f64]) {
    match values {
        Values::Scalar(value) => {
            for (out, &chosen) in out.iter_mut().zip(chosen) {
                *out = if chosen == piece { value } else { *out };
            }
        }
        Values::Block(values) => {
            for ((out, &chosen), &value) in out.iter_mut().zip(chosen).zip(values) {
                *out = if chosen == piece { value } else { *out };
            }
        }
    }
}

/// A program whose outputs depend on arguments alone.
pub(super) fn constant(nodes: &[Node], outputs: &[usize]) -> Program {
    let program = Program::new(nodes, outputs);
    debug_assert!(program.is_constant(), "a level depends on gap or rate");
    program
}

/// Runs a program made by [`constant`].
fn run_constant(program: &Program, inputs: Inputs<'_>, slots: &mut [Slot], out: &mut [f64]) {
    program.run_hoisted(inputs, slots);
    for (index, out) in out.iter_mut().enumerate() {
        copy(
            program.output(index, inputs, slots),
            std::slice::from_mut(out),
        );
    }
}

/// Runs a program made by [`constant`], in the working memory of the thread.
pub(super) fn evaluate_constant(program: &Program, arguments: &[f64], out: &mut [f64]) {
    let inputs = Inputs {
        arguments,
        gap: &[],
        rate: &[],
    };
    SCRATCH.with_borrow_mut(|scratch| {
        run_constant(program, inputs, scratch.slots(program.slots()), out);
    });
}
