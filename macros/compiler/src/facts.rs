//! What is known of a law without evaluating it: `hertzian::law::LawFacts`, derived.

mod limit;
mod terms;

use std::collections::HashMap;

use crate::dag::{Dag, Id, Rational, Variable};
use crate::differentiate::differentiate;
use crate::ir::{Bound, Law, Level};
use crate::simplify::{expand, is_zero};

pub use limit::{Limit, Ranges, at as limit_at};
pub use terms::{Exponent, Quantity, Term};

/// What is known of a law.
#[derive(Debug, Clone)]
pub struct LawFacts {
    /// One entry per level.
    pub levels: Vec<LevelFacts>,
    /// One entry per piece.
    pub pieces: Vec<PieceFacts>,
    /// How the force depends on the rate.
    pub rate: RateDependence,
    /// `phi(-g, -r) = -phi(g, r)`
    pub odd: bool,
}

/// How a force depends on the rate of its gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum RateDependence {
    None,
    Linear,
    General,
}

/// What happens where two pieces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, clippy::struct_excessive_bools)]
pub struct LevelFacts {
    pub belongs_above: bool,
    pub force_jumps: bool,
    pub by_gap_jumps: bool,
    pub by_rate_jumps: bool,
    pub unbounded_by_gap: bool,
}

/// What is known of one piece.
#[derive(Debug, Clone)]
#[allow(missing_docs)]
pub struct PieceFacts {
    pub affine: bool,
    pub force: Variation,
    pub by_gap: Variation,
    pub by_rate: Variation,
    pub by_argument: Vec<Variation>,
    pub terms: Vec<Term>,
}

/// How a quantity varies over a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Variation {
    Zero,
    Constant,
    Varying,
}

/// A piece and its derivatives.
#[derive(Debug, Clone)]
pub struct Piece {
    /// `phi`
    pub force: Id,
    /// `d phi / d gap`
    pub by_gap: Id,
    /// `d phi / d rate`
    pub by_rate: Id,
    /// `d phi / d argument`
    pub by_argument: Vec<Id>,
}

impl Piece {
    /// Differentiates the force of a piece.
    pub fn of(dag: &mut Dag, force: Id, arguments: usize) -> Self {
        Self {
            force,
            by_gap: differentiate(dag, force, Variable::Gap),
            by_rate: differentiate(dag, force, Variable::Rate),
            by_argument: (0..arguments)
                .map(|index| differentiate(dag, force, Variable::Argument(index)))
                .collect(),
        }
    }

    /// Force, by gap, by rate, by each argument.
    pub fn outputs(&self) -> Vec<Id> {
        let mut outputs = vec![self.force, self.by_gap, self.by_rate];
        outputs.extend(&self.by_argument);
        outputs
    }
}

/// Derives the facts of a law from its pieces and their derivatives.
pub fn derive(dag: &mut Dag, law: &Law, pieces: &[Piece]) -> LawFacts {
    let ranges = Ranges(&law.ranges);
    let levels = law
        .levels
        .iter()
        .enumerate()
        .map(|(index, level)| level_facts(dag, *level, &pieces[index], &pieces[index + 1], ranges))
        .collect::<Vec<_>>();
    let facts = (0..pieces.len())
        .map(|index| {
            let lower = index.checked_sub(1).map(|below| law.levels[below].value);
            let upper = law.levels.get(index).map(|level| level.value);
            piece_facts(dag, &pieces[index], lower, upper)
        })
        .collect();
    let rate = rate_dependence(dag, pieces);
    let odd = is_odd(dag, law, &levels);
    LawFacts {
        levels,
        pieces: facts,
        rate,
        odd,
    }
}

fn piece_facts(dag: &mut Dag, piece: &Piece, lower: Option<Id>, upper: Option<Id>) -> PieceFacts {
    let force = variation(dag, piece.force);
    let by_gap = variation(dag, piece.by_gap);
    let by_rate = variation(dag, piece.by_rate);
    PieceFacts {
        affine: by_gap != Variation::Varying && by_rate != Variation::Varying,
        force,
        by_gap,
        by_rate,
        by_argument: piece
            .by_argument
            .iter()
            .map(|&id| variation(dag, id))
            .collect(),
        terms: terms::of_piece(dag, piece, lower, upper),
    }
}

/// How a quantity varies, decided on its expanded form.
pub fn variation(dag: &mut Dag, id: Id) -> Variation {
    let expanded = expand(dag, id);
    if dag.as_number(expanded).is_some_and(Rational::is_zero) {
        Variation::Zero
    } else if dag.depends_on(expanded, Variable::Gap) || dag.depends_on(expanded, Variable::Rate) {
        Variation::Varying
    } else {
        Variation::Constant
    }
}

/// Compares the one-sided limits at a level. The force is compared at zero rate.
fn level_facts(
    dag: &mut Dag,
    level: Level,
    below: &Piece,
    above: &Piece,
    ranges: Ranges<'_>,
) -> LevelFacts {
    let still = dag.integer(0);
    let still = HashMap::from([(Variable::Rate, still)]);
    let forces = [below.force, above.force].map(|force| dag.substitute(force, &still));
    let mut jump = |sides: [Id; 2]| {
        let limits = sides.map(|side| limit::at(dag, side, level.value, ranges));
        match limits {
            [Limit::Finite(left), Limit::Finite(right)] => {
                let difference = dag.difference(right, left);
                (
                    !is_zero(dag, difference, &|trial, variable| {
                        ranges.probe(trial, variable)
                    }),
                    false,
                )
            }
            _ => (true, true),
        }
    };
    let (by_gap_jumps, unbounded_by_gap) = jump([below.by_gap, above.by_gap]);
    LevelFacts {
        belongs_above: level.belongs_above,
        force_jumps: jump(forces).0,
        by_gap_jumps,
        by_rate_jumps: jump([below.by_rate, above.by_rate]).0,
        unbounded_by_gap,
    }
}

/// How the force depends on the rate, decided on the expanded derivatives.
pub fn rate_dependence(dag: &mut Dag, pieces: &[Piece]) -> RateDependence {
    let variations: Vec<Id> = pieces
        .iter()
        .map(|piece| expand(dag, piece.by_rate))
        .collect();
    let zero = dag.integer(0);
    if variations.iter().all(|&by_rate| by_rate == zero) {
        RateDependence::None
    } else if variations
        .iter()
        .all(|&by_rate| !dag.depends_on(by_rate, Variable::Rate))
    {
        RateDependence::Linear
    } else {
        RateDependence::General
    }
}

/// Levels and pieces are mirrored into each other. Proved by multiplying out; what is not proved is not claimed.
fn is_odd(dag: &mut Dag, law: &Law, levels: &[LevelFacts]) -> bool {
    let zero = dag.integer(0);
    let count = law.levels.len();
    for index in 0..count {
        let (level, mirror) = (law.levels[index], law.levels[count - 1 - index]);
        let sum = dag.sum(&[level.value, mirror.value]);
        let jumps = levels[index].force_jumps || levels[index].by_rate_jumps;
        if expand(dag, sum) != zero || (jumps && level.belongs_above == mirror.belongs_above) {
            return false;
        }
    }
    let (gap, rate) = (dag.variable(Variable::Gap), dag.variable(Variable::Rate));
    let mirror = HashMap::from([
        (Variable::Gap, dag.negate(gap)),
        (Variable::Rate, dag.negate(rate)),
    ]);
    (0..=count).all(|index| {
        let mirrored = dag.substitute(law.pieces[index], &mirror);
        let sum = dag.sum(&[mirrored, law.pieces[count - index]]);
        expand(dag, sum) == zero
    })
}

/// Whether a range lies wholly above a value.
pub(crate) fn is_above(minimum: Bound, value: f64) -> bool {
    match minimum {
        Bound::Unbounded => false,
        Bound::Included(bound) => bound > value,
        Bound::Excluded(bound) => bound >= value,
    }
}
