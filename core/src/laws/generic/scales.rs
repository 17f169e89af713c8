//! Where a law may change fast: what its data tell of its scales.
//!
//! A sum of powers of the distance from a level changes on the scale of that distance, and rules graded towards the level see it.
//! A hyperbolic tangent, an exponential, a sine, a quotient or a power of anything else brings a scale of its own, which may be
//! far smaller than the motion, so that samples of force and slopes may pass it without a trace. Its *operand* does not hide: it
//! is smooth where the function of it is sharp. Where an operand `u` is and how fast it changes says whether samples are close
//! enough:
//!
//! | function | changes while | samples must be closer than |
//! |---|---|---|
//! | `tanh u` | `u` passes zero, with `e^(-2 abs u)` | a part of `1`, more where `u` is large |
//! | `exp u` | `u` is not far below zero | a part of `1`, more where `u` is far below zero |
//! | `sin u`, `cos u` | always | a part of `1` |
//! | a power of `u` that is no whole positive one | `u` is near zero, its branch point or pole | a part of `abs u` |
//! | `abs u`, `sgn u` | `u` changes its sign | nothing is close enough |
//!
//! Between two samples `u` is taken to lie no farther from theirs than the largest difference of neighbours there, so that the tip
//! of a bump between two samples of equal size is not missed.
//!
//! Source: Trefethen (2013), Approximation Theory and Approximation Practice, chapter 8: what an analytic function asks for is
//! the distance of its nearest singularity from the interval.

use super::consistent::check;
use super::program::{BLOCK, Inputs, Program, Slot, Values, needed, varying};
use super::{LawData, Node};
use crate::law::Law;

/// Beyond this operand a hyperbolic tangent is constant to rounding.
const SATURATED: f64 = 20.0;
/// Below the negative of this an exponential is nothing.
pub(super) const VANISHED: f64 = 60.0;
/// Samples may be farther apart by `e^(abs u / FADES)` where a function fades: as the sixth root of what is left of its slope.
const FADES: f64 = 4.0;
/// Powers of the distance from a level by which an operand that vanishes there is divided, at most.
const ORDERS: i32 = 4;
/// An operand that is smaller than this part of its values beside a level vanishes there.
const VANISHES: f64 = 1e-5;
/// Operands beyond this are as good as infinite: a quotient by them is nothing.
const ENDLESS: f64 = 1e100;
/// Values that are the same but for rounding.
const SAME: f64 = 1e-9;

/// What is done with an operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Saturates,
    Grows,
    Oscillates,
    Base,
    Bends,
}

/// The operands of one piece.
#[derive(Debug, Clone)]
struct Piece {
    program: Program,
    kinds: Vec<Kind>,
    /// For the arguments at hand: how often each operand vanishes at the lower and at the upper level of the piece, where grading
    /// takes care of it.
    orders: Vec<[i32; 2]>,
    /// Operands that are more than a power of the distance from a level.
    sharp: Vec<bool>,
}

/// The operands of a law whose functions may be sharp.
#[derive(Debug, Clone)]
pub(crate) struct Scales {
    pieces: Vec<Piece>,
    arguments: Vec<f64>,
    levels: Vec<f64>,
    /// Whether the orders belong to the arguments.
    known: bool,
    slots: Vec<Slot>,
    values: Vec<f64>,
}

/// What samples show of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sight {
    /// Everything.
    Clear,
    /// A slope may jump or bend between two of them.
    Bent,
    /// Something may lie between two of them.
    Missed,
}

impl Scales {
    /// Those of a law; `None` if no function of it brings a scale of its own, or if the law has no data,
    /// or data that do not describe it.
    pub(crate) fn of(law: &dyn Law) -> Option<Self> {
        let data = law.data()?;
        check(law.facts(), data).ok()?;
        let pieces: Vec<Piece> = (0..data.pieces.len())
            .map(|index| Piece::of(data, index))
            .collect();
        if pieces.iter().all(|piece| piece.kinds.is_empty()) {
            return None;
        }
        let most = pieces.iter().map(|piece| piece.program.slots()).max();
        Some(Self {
            pieces,
            arguments: Vec::new(),
            levels: Vec::new(),
            known: false,
            slots: vec![[0.0; BLOCK]; most.unwrap_or(0)],
            values: Vec::new(),
        })
    }

    /// Whether a piece has such functions, for the arguments at hand.
    pub(crate) fn any(&self, piece: usize) -> bool {
        self.pieces[piece].sharp.contains(&true)
    }

    /// How many pieces there are, how many operands a piece has, what is done with one of them, whether it is sharp for
    /// the arguments at hand, and its values at gaps and rates: of a base their size.
    pub(super) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    pub(super) fn features(&self, piece: usize) -> usize {
        self.pieces[piece].kinds.len()
    }

    pub(super) fn kind(&self, piece: usize, feature: usize) -> Kind {
        self.pieces[piece].kinds[feature]
    }

    pub(super) fn is_sharp(&self, piece: usize, feature: usize) -> bool {
        self.pieces[piece].sharp[feature]
    }

    pub(super) fn operand(
        &mut self,
        piece: usize,
        feature: usize,
        gap: &[f64],
        rate: &[f64],
    ) -> Vec<f64> {
        self.run(piece, gap, rate);
        self.divide(piece, gap);
        let values = self.values[feature * gap.len()..][..gap.len()].iter();
        let of_base = self.kind(piece, feature) == Kind::Base;
        values.map(|u| if of_base { u.abs() } else { *u }).collect()
    }

    /// Whether the slope of the force jumps on a piece, where an operand changes its sign.
    pub(crate) fn bends(&self, piece: usize) -> bool {
        self.pieces[piece].kinds.contains(&Kind::Bends)
    }

    /// Whether it does so on any.
    pub(crate) fn bends_anywhere(&self) -> bool {
        (0..self.pieces()).any(|piece| self.bends(piece))
    }

    /// Values of these operands along a motion, one after the other.
    pub(crate) fn bending(
        &mut self,
        piece: usize,
        gap: &[f64],
        rate: &[f64],
    ) -> impl Iterator<Item = &[f64]> {
        self.run(piece, gap, rate);
        let operands = self.values.chunks_exact(gap.len());
        let kinds = self.pieces[piece].kinds.iter();
        let bending = operands
            .zip(kinds)
            .filter(|(_, kind)| **kind == Kind::Bends);
        bending.map(|(operand, _)| operand)
    }

    /// Takes arguments and levels.
    pub(crate) fn set(&mut self, arguments: &[f64], levels: &[f64]) {
        if self.known && self.arguments == arguments && self.levels == levels {
            return;
        }
        self.known = true;
        self.arguments.clear();
        self.arguments.extend_from_slice(arguments);
        self.levels.clear();
        self.levels.extend_from_slice(levels);
        for piece in 0..self.pieces.len() {
            for side in 0..2 {
                self.find_orders(piece, side);
            }
            self.find_sharp(piece);
        }
    }

    /// The level at an end of a piece.
    pub(super) fn level(&self, piece: usize, side: usize) -> Option<f64> {
        let index = if side == 0 {
            piece.checked_sub(1)?
        } else {
            piece
        };
        self.levels.get(index).copied()
    }

    fn find_orders(&mut self, piece: usize, side: usize) {
        let Some(level) = self.level(piece, side) else {
            return;
        };
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let reach = 1e-4 * if level == 0.0 { 1.0 } else { level.abs() };
        let beside = [1e-9, 1e-3, 2e-3, 1.0].map(|part| level + sign * part * reach);
        self.run(piece, &beside, &[0.0; 4]);
        let of = &mut self.pieces[piece];
        for (feature, orders) in of.orders.iter_mut().enumerate() {
            let [at, near, farther, far] = std::array::from_fn(|j| self.values[4 * feature + j]);
            let vanishes = at.abs() <= VANISHES * near.abs().max(far.abs());
            let order = (farther / near).abs().log2().round();
            orders[side] = if vanishes && order >= 1.0 {
                order.min(f64::from(ORDERS)) as i32
            } else {
                0
            };
        }
    }

    /// A power of the distance from a level is one wherever it is divided by itself.
    fn find_sharp(&mut self, piece: usize) {
        let level = [0, 1].into_iter().find_map(|side| self.level(piece, side));
        let Some(level) = level else {
            return;
        };
        let scale = if level == 0.0 { 1.0 } else { level.abs() };
        let gap = [0.3, 1e-3, -0.7, 5.0, -40.0, 1e3].map(|part| level + part * scale);
        self.run(piece, &gap, &[0.0, 1.0, -2.0, 0.01, 30.0, -0.1]);
        self.divide(piece, &gap);
        let of = &mut self.pieces[piece];
        let values = self.values.chunks_exact(gap.len());
        for ((sharp, orders), values) in of.sharp.iter_mut().zip(&of.orders).zip(values) {
            let same = |value: &f64| (value - values[0]).abs() <= SAME * values[0].abs();
            *sharp = *orders == [0; 2] || !values.iter().all(same);
        }
    }

    /// Values of all operands of a piece, one after the other.
    fn run(&mut self, piece: usize, gap: &[f64], rate: &[f64]) {
        let Self {
            pieces,
            arguments,
            slots,
            values,
            ..
        } = self;
        let Piece { program, kinds, .. } = &pieces[piece];
        values.clear();
        values.resize(kinds.len() * gap.len(), 0.0);
        let inputs = |from: usize, to: usize| Inputs {
            arguments,
            gap: &gap[from..to],
            rate: &rate[from..to],
        };
        program.run_hoisted(inputs(0, gap.len().min(1)), slots);
        for from in (0..gap.len()).step_by(BLOCK) {
            let to = (from + BLOCK).min(gap.len());
            let block = inputs(from, to);
            program.run_block(block, slots);
            for feature in 0..kinds.len() {
                let to = &mut values[feature * gap.len() + from..][..to - from];
                match program.output(feature, block, slots) {
                    Values::Scalar(value) => to.fill(value),
                    Values::Block(of) => to.copy_from_slice(of),
                }
            }
        }
    }

    /// What samples of a motion on one piece, in its order, show of the law if operands may change by a `part` of what is said
    /// above from one to the next.
    pub(crate) fn look(&mut self, piece: usize, gap: &[f64], rate: &[f64], part: f64) -> Sight {
        if !self.any(piece) || gap.len() < 2 {
            return Sight::Clear;
        }
        self.run(piece, gap, rate);
        self.divide(piece, gap);
        let count = gap.len();
        let of = &self.pieces[piece];
        let features = of.kinds.iter().zip(&of.sharp);
        let features = features.zip(self.values.chunks_exact(count));
        let features = features.filter(|((_, sharp), _)| **sharp);
        let sights = features.map(|((&kind, _), values)| kind.sight(values, part));
        sights.max().unwrap_or(Sight::Clear)
    }

    /// Divides operands that vanish at a level by their power of the distance from it.
    fn divide(&mut self, piece: usize, gap: &[f64]) {
        for side in 0..2 {
            let Some(level) = self.level(piece, side) else {
                continue;
            };
            let orders = &self.pieces[piece].orders;
            for (orders, values) in orders.iter().zip(self.values.chunks_exact_mut(gap.len())) {
                if orders[side] == 0 {
                    continue;
                }
                for (value, gap) in values.iter_mut().zip(gap) {
                    let distance = gap - level;
                    if distance != 0.0 {
                        *value /= distance.powi(orders[side]);
                    }
                }
            }
        }
    }
}

impl Piece {
    fn of(data: &LawData, index: usize) -> Self {
        let piece = &data.pieces[index];
        let nodes = &data.nodes;
        let needed = needed(nodes, &[piece.force, piece.by_gap, piece.by_rate]);
        let varies = varying(nodes);
        let mut operands: Vec<(usize, Kind)> = Vec::new();
        for position in (0..nodes.len()).filter(|&position| needed[position]) {
            let found = match nodes[position] {
                Node::Tanh(a) => Some((a, Kind::Saturates)),
                Node::Exponential(a) => Some((a, Kind::Grows)),
                Node::Sine(a) | Node::Cosine(a) => Some((a, Kind::Oscillates)),
                Node::Absolute(a) | Node::Sign(a) => Some((a, Kind::Bends)),
                Node::Divide(_, b) => Some((b, Kind::Base)),
                Node::Integer(a, exponent) if exponent < 0 => Some((a, Kind::Base)),
                Node::Power(a, b) | Node::PowerLog(a, b) if !is_whole(nodes[b]) => {
                    Some((a, Kind::Base))
                }
                _ => None,
            };
            let found = found.filter(|&(operand, _)| varies[operand]);
            operands.extend(found.filter(|found| !operands.contains(found)));
        }
        let (outputs, kinds): (Vec<usize>, Vec<Kind>) = operands.into_iter().unzip();
        Self {
            program: Program::new(nodes, &outputs),
            orders: vec![[0; 2]; kinds.len()],
            sharp: vec![true; kinds.len()],
            kinds,
        }
    }
}

/// An exponent that is known to be whole and not negative.
fn is_whole(exponent: Node) -> bool {
    matches!(exponent, Node::Number(value) if value >= 0.0 && value.fract() == 0.0)
}

impl Kind {
    /// What the values of an operand at samples tell.
    fn sight(self, values: &[f64], part: f64) -> Sight {
        let last = values.len() - 2;
        let value = |j: usize| match self {
            Self::Base => values[j].clamp(-ENDLESS, ENDLESS),
            _ => values[j],
        };
        let difference = |j: usize| (value(j + 1) - value(j)).abs();
        let mut worst = Sight::Clear;
        for j in 0..=last {
            let before = difference(j.saturating_sub(1));
            let change = difference(j).max(before).max(difference((j + 1).min(last)));
            let (a, b) = (value(j), value(j + 1));
            let (low, high) = (a.min(b) - change, a.max(b) + change);
            let nearest = if low <= 0.0 && high >= 0.0 {
                0.0
            } else {
                low.abs().min(high.abs())
            };
            let close = |scale: f64| {
                // Not a number: nothing is known of it.
                if change <= part * scale {
                    Sight::Clear
                } else {
                    Sight::Missed
                }
            };
            let sight = match self {
                _ if change == 0.0 => Sight::Clear,
                Self::Saturates if nearest >= SATURATED => Sight::Clear,
                Self::Saturates => close((nearest / FADES).exp()),
                Self::Grows if high <= -VANISHED => Sight::Clear,
                Self::Grows => close((-high.min(0.0) / (2.0 * FADES)).exp()),
                Self::Oscillates => close(1.0),
                Self::Base => close(nearest),
                Self::Bends if nearest > 0.0 => Sight::Clear,
                Self::Bends => Sight::Bent,
            };
            worst = worst.max(sight);
        }
        worst
    }
}
