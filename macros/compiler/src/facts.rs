//! What is known of a law without evaluating it: the facts of the contract, derived.

mod limit;
mod terms;

use std::collections::HashMap;

use hertzian_contract::law::{
    ArgumentFacts, LawFacts, LevelFacts, PieceFacts, RateDependence, Variation,
};
use hertzian_contract::system::Bound;

use crate::dag::{Dag, Id, Rational, Variable};
use crate::differentiate::differentiate;
use crate::ir::{Law, Level};
use crate::simplify::{expand, is_zero};

pub use limit::{Limit, Ranges, at as limit_at};

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
    let facts: Vec<PieceFacts> = (0..pieces.len())
        .map(|index| {
            let lower = index.checked_sub(1).map(|below| law.levels[below].value);
            let upper = law.levels.get(index).map(|level| level.value);
            piece_facts(dag, &pieces[index], lower, upper)
        })
        .collect();
    let rate = rate_dependence(dag, pieces);
    let odd = is_odd(dag, law, &levels);
    LawFacts::new(law.name.clone(), levels, facts)
        .arguments(arguments(law))
        .rate(rate)
        .odd(odd)
}

/// The arguments, with their ranges as far as they are known.
fn arguments(law: &Law) -> impl Iterator<Item = ArgumentFacts> {
    let names = law.arguments.iter().enumerate();
    names.map(|(index, name)| {
        let argument = ArgumentFacts::named(name.clone().into());
        match law.ranges.get(index) {
            Some(&(minimum, maximum)) => argument.range(minimum, maximum),
            None => argument,
        }
    })
}

fn piece_facts(dag: &mut Dag, piece: &Piece, lower: Option<Id>, upper: Option<Id>) -> PieceFacts {
    let [force, by_gap, by_rate] =
        [piece.force, piece.by_gap, piece.by_rate].map(|id| variation(dag, id));
    let by_argument = piece.by_argument.iter().map(|&id| variation(dag, id));
    PieceFacts::smooth(0)
        .force(force)
        .slopes(by_gap, by_rate)
        .by_argument(by_argument.collect::<Vec<_>>())
        .terms(terms::of_piece(dag, piece, lower, upper))
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
    LevelFacts::default()
        .belongs_above(level.belongs_above)
        .force_jumps(jump(forces).0)
        .by_gap_jumps(by_gap_jumps)
        .by_rate_jumps(jump([below.by_rate, above.by_rate]).0)
        .unbounded_by_gap(unbounded_by_gap)
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
