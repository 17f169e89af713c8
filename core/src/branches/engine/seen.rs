//! Points of a branch with their test functions, and what changes of sign between two of them mean.

use nalgebra::Complex;

use crate::branches::problem::{BranchProblem, Change, Test, TestValue};
use crate::continuation::follow::CurvePoint;
use crate::event::EventKind;

/// A point of the branch with its test functions.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Seen {
    pub(super) point: CurvePoint,
    pub(super) values: Vec<TestValue>,
    /// Logarithms of the complex multipliers with a positive imaginary part.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) pairs: Option<Vec<Complex<f64>>>,
    /// Whether the parameter falls, as the last slope says that is no rounding: where a branch is vertical, as with orbits of any size at a
    /// parametric resonance of a linear stretch, no sign of a slope means anything.
    pub(super) falls: Option<bool>,
}

/// A touch whose level is crossed from there on to the last point.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Crossed {
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub(super) touch: Seen,
    /// How far the last point is behind it, in the norm of the unknowns that both were found in; zero where that is not known.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
    pub(super) way: f64,
    /// Its place is not known in the present unknowns, and it has those of the last point.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) displaced: bool,
    /// The force jumps there: determinants come from infinity behind it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) jumps: bool,
}

impl Crossed {
    /// A touch so far before the last point, at which no force jumps.
    pub(super) fn at(touch: Seen, way: f64) -> Self {
        Self {
            touch,
            way,
            displaced: false,
            jumps: false,
        }
    }

    /// After a change of unknowns: its multipliers are known still, and how far the last point is behind it.
    pub(super) fn displaced_to(mut self, last: &CurvePoint) -> Self {
        self.touch.point = last.clone();
        self.displaced = true;
        self
    }

    /// Whether it may be one: it may have been read from a file.
    pub(super) fn is_possible(&self) -> bool {
        self.way.is_finite()
    }
}

/// The point before the first one that is remembered, where that has other unknowns. What multipliers were there counts still, and which way the parameter went.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Former {
    pub(super) values: Vec<TestValue>,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) pairs: Option<Vec<Complex<f64>>>,
    /// The slope of the parameter.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
    pub(super) slope: Option<f64>,
    /// How long the step from it was, in the norm of its unknowns: that of others is another one by less than second differences are trusted to.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) way: f64,
}

impl Former {
    /// As a point that is as far from another one as the step was long.
    pub(super) fn before(self, next: &Seen) -> Seen {
        let mut point = next.point.clone();
        let slope = self.slope.map(|slope| slope * point.scale.parameter);
        if let Some(of_parameter) = point.tangent.last_mut() {
            *of_parameter = slope.unwrap_or(f64::NAN);
        }
        Seen {
            point,
            values: self.values,
            pairs: self.pairs,
            falls: next.falls,
        }
    }

    /// Whether it may be one of so many test functions: it may have been read from a file.
    pub(super) fn is_possible(&self, tests: usize) -> bool {
        let slopes = self.slope.is_none_or(f64::is_finite);
        slopes && self.values.len() == tests && self.way.is_finite() && self.way > 0.0
    }
}

impl Seen {
    /// Whether the parameter `falls` is what is known from the way to it.
    pub(super) fn at(
        problem: &mut dyn BranchProblem,
        point: &CurvePoint,
        falls: Option<bool>,
    ) -> Self {
        let values = (0..problem.watched().len()).map(|index| problem.test(index, point));
        let values = values.collect();
        let pairs = problem.pairs(point);
        let slope = point.unless_rounding(problem.slope(point), problem.vanishing());
        Self {
            point: point.clone(),
            values,
            pairs,
            falls: slope.map(|slope| slope < 0.0).or(falls),
        }
    }

    /// Number of pairs outside of the unit circle.
    fn outside(&self) -> Option<usize> {
        let pairs = self.pairs.as_ref()?.iter();
        Some(pairs.filter(|pair| pair.re > 0.0).count())
    }

    pub(super) fn value(&self, test: Test) -> TestValue {
        match test {
            Test::Slope => TestValue::plain(self.point.parameter_slope()),
            Test::Watched(index) => self.values[index],
        }
    }
}

/// Whether it is the modulus of a multiplier that changes its sign.
pub(super) fn is_modulus(change: &Change) -> bool {
    change.kind == EventKind::NeimarkSacker
}

/// Whether a test function is negative at two points of a branch, or the parameter falls; `None` where that is not known, or rounding.
pub(super) fn signs(
    problem: &dyn BranchProblem,
    ends: [&Seen; 2],
    test: Test,
) -> Option<[bool; 2]> {
    let Test::Watched(index) = test else {
        return Some([ends[0].falls?, ends[1].falls?]);
    };
    let values = ends.map(|seen| seen.values[index]);
    let known = values.iter().all(|value| value.is_known());
    let [a, b] = values.map(|value| value.mantissa.abs());
    let tells = known && a.max(b) > problem.noise(index);
    tells.then(|| values.map(TestValue::is_negative))
}

/// What changes its sign from one point to the next, and what that means. Without the bordered determinant every turn counts as a
/// fold.
pub(super) fn changes(problem: &dyn BranchProblem, a: &Seen, b: &Seen) -> Vec<Change> {
    let differs = |test: Test| signs(problem, [a, b], test).is_some_and(|[x, y]| x != y);
    let turned = differs(Test::Slope);
    let watched = problem.watched();
    let bordered = watched.iter().position(|watched| watched.bordered);
    let crossed = bordered.filter(|index| differs(Test::Watched(*index)));
    let mut changes = Vec::new();
    match (turned, crossed) {
        (true, crossed) => changes.push(Change {
            test: Test::Slope,
            kind: crossed.map_or(EventKind::Fold, |_| EventKind::BranchPoint),
        }),
        (false, Some(index)) => changes.push(Change {
            test: Test::Watched(index),
            kind: EventKind::BranchPoint,
        }),
        (false, None) => {}
    }
    let mut moduli = Vec::new();
    for (index, watched) in watched.iter().enumerate() {
        let test = Test::Watched(index);
        if !watched.bordered && differs(test) {
            let kind = watched.kind;
            let change = Change { test, kind };
            let found = if is_modulus(&change) {
                &mut moduli
            } else {
                &mut changes
            };
            found.push(change);
        }
    }
    // Every other change of sign takes one multiplier across the unit circle, and none that is complex.
    let explained = moduli.len() <= changes.len() && (changes.len() - moduli.len()) % 2 == 0;
    if !explained || a.outside() != b.outside() {
        changes.append(&mut moduli);
    }
    changes
}
