//! Test functions of a branch. What a change of sign means is told by the [engine](crate::branches::engine).
//!
//! With the map `M` of [`equations`](super::equations) and the slope `l'` of the parameter along the branch:
//!
//! | event | test function |
//! |---|---|
//! | fold | `l'` |
//! | branch point | `b = det(M - I) / l'`, the determinant of the bordered matrix of Newton's method but for a factor |
//! | period doubling | `det(M + I)`; with odd symmetry the symmetry breaks there |
//! | Neimark-Sacker | the product of `mu_i mu_j - 1` over all pairs of multipliers, if the pair that vanishes is complex |
//! | grazing | none: the number of times that a gap crosses a level changes |
//!
//! At a fold `b` stays away from zero. Where both `l'` and `b` change their sign, a branch ends on another one, as of twice the
//! period at a period doubling; or there is a fold, and a crossing beside it.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4 (test functions);
//! Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems, for the determinant.

use nalgebra::DMatrix;

use crate::branches::problem::{self as engine, Watched};
use crate::event::EventKind;
use crate::numeric::spectrum::eigenvalues;
use crate::orbit::stability::product_of_pairs;

/// The test functions at one orbit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tests {
    slope: f64,
    /// `det(M - I)`
    minus: f64,
    /// `det(M + I)`
    plus: f64,
    /// The product of `mu_i mu_j - 1`, and whether the pair that is nearest to one is complex.
    pairs: f64,
    pub(super) complex: bool,
}

/// Which of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Test {
    Slope,
    /// `b`
    Bordered,
    Plus,
    Pairs,
}

/// Those that are watched, in the order of [`Test::watched`].
pub(super) fn watched(half: bool) -> [Watched; 3] {
    let plus = if half {
        EventKind::SymmetryBreaking
    } else {
        EventKind::PeriodDoubling
    };
    let of = |kind| Watched {
        kind,
        bordered: kind == EventKind::BranchPoint,
    };
    [EventKind::BranchPoint, plus, EventKind::NeimarkSacker].map(of)
}

impl Test {
    /// By its place among those that are watched.
    pub(super) fn watched(index: usize) -> Self {
        match index {
            0 => Self::Bordered,
            1 => Self::Plus,
            _ => Self::Pairs,
        }
    }

    pub(super) fn of(test: engine::Test) -> Self {
        match test {
            engine::Test::Slope => Self::Slope,
            engine::Test::Watched(index) => Self::watched(index),
        }
    }
}

impl Tests {
    pub(super) fn of(map: Option<&DMatrix<f64>>, slope: f64) -> Self {
        let determinant = |shift: f64| {
            map.map_or(f64::NAN, |map| {
                let shifted = map + DMatrix::identity(map.nrows(), map.ncols()) * shift;
                shifted.determinant()
            })
        };
        let (pairs, complex) =
            map.map_or((f64::NAN, false), |map| product_of_pairs(&eigenvalues(map)));
        Self {
            slope,
            minus: determinant(-1.0),
            plus: determinant(1.0),
            pairs,
            complex,
        }
    }

    pub(super) fn value(&self, test: Test) -> f64 {
        match test {
            Test::Slope => self.slope,
            Test::Bordered => self.minus / self.slope,
            Test::Plus => self.plus,
            Test::Pairs => self.pairs,
        }
    }
}
