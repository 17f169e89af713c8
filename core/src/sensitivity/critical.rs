//! Where a multiplier crosses the unit circle, how its place moves, and how a fold moves along the branch.
//!
//! With `mu'` of [`multipliers`](super::multipliers) along the tangents `s_lambda` and `s_p` of the branch at fixed values of all others,
//!
//! ```text
//! |mu(lambda, p)| = 1,       dlambda/dp = - Re(mu_p / mu) / Re(mu_lambda / mu).                               (1)
//! ```
//!
//! Where the multiplier is one, as where a symmetry breaks, `F_s` is singular along `v` and has its range across `w`. There
//!
//! ```text
//! [ F_s  w ] [ s' ]   [ -F_p ]
//! [ v^T  0 ] [ g  ] = [   0  ],        g = 0 by the symmetry,                                                 (2)
//! ```
//!
//! and the part of `s'` along `v` that is missing does not change the multiplier: by the symmetry it is an even function of it. A parameter that
//! breaks the symmetry, as a load does where there was none, has `g` not zero: beside its value no branches cross, and the place has no
//! derivative by it. At a fold
//! (2) with `F_p + F_lambda dlambda/dp` for `F_p` gives the motion of the orbit but for its part `c` along `v`, which keeps the multiplier at one:
//!
//! ```text
//! c = - mu' / mu'_v       with mu' along the direction of (2), mu'_v along v.                                (3)
//! ```
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4; Kuznetsov (2004), Elements of
//! Applied Bifurcation Theory, section 7.4 (systems with a symmetry).

use nalgebra::{DMatrix, DVector};

use super::change::{Centre, Crossed, seen};
use super::cycle::{Cycle, Evaluated};
use super::error::SensitivityError;
use super::fold::{Moving, null_vectors};
use super::multipliers::{self, Multiplier};
use super::orbit::Start;
use super::reader::Along;
use crate::event::EventKind;
use crate::system::Variable;

/// Steps of Newton's method along the branch.
const STEPS: usize = 12;
/// A step below this part of the value is none.
const LAST: f64 = 1e-11;
/// One below this part is the last, if it is not shorter than half of the one before: what is left is noise.
const NEAR: f64 = 1e-7;
/// The place is looked for within this part of the value.
const FARTHEST: f64 = 1e-2;
/// A multiplier is taken to be the one that crosses within this distance of where it should.
const BESIDE: f64 = 0.1;
/// A parameter leaves a symmetry as it is if `w^T F_p` is no larger part of `F_p`, both in units of states.
const LEAVES: f64 = 1e-6;

/// What crosses the unit circle, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Crosses {
    /// At one, without a fold.
    One,
    MinusOne,
    /// A pair.
    Pair,
}

impl Crosses {
    /// At an event of orbits that are the same again after so many parts of their period; `None` of an event of another sort.
    pub(super) fn at(kind: EventKind, parts: usize) -> Option<Self> {
        Some(match kind {
            // Over the whole period a multiplier counts as often as the orbit has parts.
            EventKind::PeriodDoubling if parts.is_multiple_of(2) => Self::One,
            EventKind::PeriodDoubling => Self::MinusOne,
            EventKind::SymmetryBreaking => Self::One,
            EventKind::NeimarkSacker => Self::Pair,
            _ => return None,
        })
    }

    /// How far a multiplier is from where it should cross.
    fn distance(self, multiplier: &Multiplier) -> f64 {
        let value = multiplier.value;
        match self {
            Self::One => (value - 1.0).norm(),
            Self::MinusOne => (value + 1.0).norm(),
            Self::Pair if value.im > 0.0 => (value.norm() - 1.0).abs(),
            Self::Pair => f64::INFINITY,
        }
    }
}

/// The left and the right null vector, in units of states.
type Null = (DVector<f64>, DVector<f64>);

/// `F_s x = right`, by (2) where null vectors are given.
fn solved(
    cycle: &Cycle,
    jacobian: &DMatrix<f64>,
    right: &DVector<f64>,
    null: Option<&Null>,
) -> Result<DVector<f64>, SensitivityError> {
    let singular = SensitivityError::Singular;
    let Some((left, vector)) = null else {
        return jacobian.clone().lu().solve(right).ok_or(singular);
    };
    let n = right.len();
    let scaled = cycle.scaled(jacobian);
    let size = scaled.norm();
    let mut matrix = DMatrix::zeros(n + 1, n + 1);
    matrix.view_mut((0, 0), (n, n)).copy_from(&scaled);
    matrix.view_mut((0, n), (n, 1)).copy_from(&(left * size));
    let row = vector.transpose() * size;
    matrix.view_mut((n, 0), (1, n)).copy_from(&row);
    let mut all = DVector::zeros(n + 1);
    all.rows_mut(0, n).copy_from(&cycle.in_units(right));
    let found = matrix.lu().solve(&all).ok_or(singular)?;
    Ok(cycle.out_of_units(&found.rows(0, n).into_owned()))
}

/// An orbit with the multiplier that crosses.
struct Critical {
    evaluated: Evaluated,
    crossed: Crossed,
    multiplier: Multiplier,
    null: Option<Null>,
}

impl Critical {
    /// Finds the orbit at the present values, with derivatives by variables.
    fn of(
        cycle: &mut Cycle,
        states: &mut [f64],
        crosses: Crosses,
        variables: &[Variable],
    ) -> Result<Self, SensitivityError> {
        let null = if crosses == Crosses::One {
            let evaluated = cycle.evaluate(states, &[], &[])?;
            Some(null_vectors(&cycle.scaled(&evaluated.jacobian))?)
        } else {
            None
        };
        cycle.solve_by(states, |cycle, jacobian, right| {
            solved(cycle, jacobian, right, null.as_ref())
        })?;
        let (evaluated, crossed) = seen(cycle, states, variables)?;
        let multiplier = nearest(cycle, &evaluated, crosses)?;
        Ok(Self {
            evaluated,
            crossed,
            multiplier,
            null,
        })
    }

    /// Whether one of the variables breaks the symmetry: `g` of (2) is not zero.
    fn is_unfolded_by(&self, cycle: &Cycle, index: usize) -> bool {
        let by = cycle.in_units(&self.evaluated.by[index]);
        let null = self.null.as_ref();
        null.is_some_and(|(left, _)| left.dot(&by).abs() > LEAVES * by.norm())
    }

    /// `Re(mu'/mu)` by each of the variables, and its error; no numbers where one breaks the symmetry.
    fn slopes(
        &self,
        cycle: &mut Cycle,
        states: &[f64],
        variables: &[Variable],
    ) -> Result<Vec<(f64, f64)>, SensitivityError> {
        let matrices = cycle.matrices(&self.evaluated);
        let crossed = self.crossed.clone();
        let centre = Centre::known(cycle, states, variables, &self.evaluated, crossed);
        let bend = self.multiplier.bend(cycle, &centre, &matrices)?;
        let value = self.multiplier.value;
        let slope = |index: usize| {
            if self.is_unfolded_by(cycle, index) {
                return Ok((f64::NAN, f64::NAN));
            }
            let jacobian = &self.evaluated.jacobian;
            let right = -&self.evaluated.by[index];
            let mut weights = vec![0.0; variables.len()];
            weights[index] = 1.0;
            let along = Along {
                states: solved(cycle, jacobian, &right, self.null.as_ref())?,
                weights,
            };
            let (slope, error) = bend.slope(&along);
            Ok(((slope / value).re, error / value.norm()))
        };
        (0..variables.len()).map(slope).collect()
    }
}

/// The multiplier that crosses.
///
/// # Errors
/// If none is near where it should cross, or it is a repeated one.
fn nearest(
    cycle: &Cycle,
    evaluated: &Evaluated,
    crosses: Crosses,
) -> Result<Multiplier, SensitivityError> {
    let matrix = multipliers::product(&cycle.matrices(evaluated));
    let all = multipliers::of(&matrix).into_iter();
    let nearest = all.min_by(|a, b| crosses.distance(a).total_cmp(&crosses.distance(b)));
    let found = nearest.filter(|found| crosses.distance(found) < BESIDE);
    let found = found.ok_or(SensitivityError::NoCrossing)?;
    if found.is_repeated() {
        return Err(SensitivityError::Repeated);
    }
    Ok(found)
}

/// Where a multiplier crosses near a place, and how that moves.
///
/// # Errors
/// If there is no such place, the multiplier is a repeated one, or motions cannot be continued.
pub(super) fn crossing(
    cycle: &mut Cycle,
    start: Start,
    crosses: Crosses,
    variables: &[Variable],
) -> Result<Moving, SensitivityError> {
    let varied = cycle.varied;
    let Start {
        mut states,
        mut value,
    } = start;
    let first = value;
    let mut before = f64::INFINITY;
    for _ in 0..STEPS {
        cycle.set(varied, value)?;
        let critical = Critical::of(cycle, &mut states, crosses, &[varied])?;
        let (slope, _) = critical.slopes(cycle, &states, &[varied])?[0];
        let step = -critical.multiplier.value.norm().ln() / slope;
        let length = (step / value).abs();
        if length <= LAST || (length <= NEAR && length >= 0.5 * before) {
            return moves(cycle, states, value, crosses, variables);
        }
        value += step;
        let passed = (value - first).abs();
        if passed.is_nan() || passed > FARTHEST * first.abs() {
            break;
        }
        before = length;
    }
    Err(SensitivityError::NoCrossing)
}

/// (1)
fn moves(
    cycle: &mut Cycle,
    mut states: Vec<f64>,
    value: f64,
    crosses: Crosses,
    variables: &[Variable],
) -> Result<Moving, SensitivityError> {
    let all: Vec<Variable> = std::iter::once(cycle.varied)
        .chain(variables.iter().copied())
        .collect();
    let critical = Critical::of(cycle, &mut states, crosses, &all)?;
    let slopes = critical.slopes(cycle, &states, &all)?;
    let (own, own_error) = slopes[0];
    let by = slopes[1..].iter().map(|(slope, _)| -slope / own).collect();
    let errors = slopes[1..].iter().map(|(slope, error)| {
        let by = slope / own;
        (error + by.abs() * own_error) / own.abs()
    });
    let errors = errors.collect();
    Ok(Moving {
        states,
        value,
        by,
        errors,
        near: None,
    })
}

/// How the orbit at a fold moves with every variable.
pub(super) struct Bends {
    /// The directions of (2), by all variables; the last is `v`.
    pub(super) directions: Vec<Along>,
    /// (3) of all but the last, with errors.
    pub(super) along: Vec<[f64; 2]>,
}

/// The same at a fold whose place moves in a known way, by variables among which is what is varied; by that nothing moves.
///
/// # Errors
/// If the multiplier is a repeated one, or motions cannot be continued.
pub(super) fn bends(
    cycle: &mut Cycle,
    fold: &Moving,
    variables: &[Variable],
) -> Result<Bends, SensitivityError> {
    let varied = cycle.varied;
    let own = variables.iter().position(|variable| *variable == varied);
    let own = own.ok_or(SensitivityError::Singular)?;
    cycle.set(varied, fold.value)?;
    let (evaluated, crossed) = seen(cycle, &fold.states, variables)?;
    let null = null_vectors(&cycle.scaled(&evaluated.jacobian))?;
    let multiplier = nearest(cycle, &evaluated, Crosses::One)?;
    let still = Along {
        states: DVector::zeros(cycle.unknowns()),
        weights: vec![0.0; variables.len()],
    };
    let mut places = fold.by.iter();
    let mut directions = Vec::with_capacity(variables.len() + 1);
    for index in 0..variables.len() {
        let mut along = still.clone();
        if index != own {
            let place = places.next().copied().unwrap_or(f64::NAN);
            let right = -(&evaluated.by[index] + &evaluated.by[own] * place);
            along.states = solved(cycle, &evaluated.jacobian, &right, Some(&null))?;
            along.weights[index] = 1.0;
            along.weights[own] = place;
        }
        directions.push(along);
    }
    let mut last = still;
    last.states = cycle.out_of_units(&null.1);
    let matrices = cycle.matrices(&evaluated);
    let centre = Centre::known(cycle, &fold.states, variables, &evaluated, crossed);
    let bend = multiplier.bend(cycle, &centre, &matrices)?;
    let (slope, slope_error) = bend.slope(&last);
    let mut along = Vec::with_capacity(variables.len());
    for (index, direction) in directions.iter().enumerate() {
        if index == own {
            along.push([0.0; 2]);
            continue;
        }
        let (moved, error) = bend.slope(direction);
        let c = -moved.re / slope.re;
        along.push([c, (error + c.abs() * slope_error) / slope.re.abs()]);
    }
    directions.push(last);
    Ok(Bends { directions, along })
}
