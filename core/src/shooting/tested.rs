//! Test functions of a branch: what changes its sign from one orbit to the next, and what that means.
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

/// A test function that changed its sign, and what that means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Change {
    pub(super) test: Test,
    pub(super) kind: EventKind,
}

impl Change {
    /// A branch that another one meets or crosses.
    pub(super) const BRANCHES: Self = Self {
        test: Test::Bordered,
        kind: EventKind::BranchPoint,
    };
    /// A branch that turns where it meets another one.
    pub(super) const TURNED: Self = Self {
        test: Test::Slope,
        kind: EventKind::BranchPoint,
    };
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

    /// What changes its sign from one orbit to the next. Without maps every turn counts as a fold. Without damping the product of
    /// pairs is rounding all along, and so is what is below `noise` at both orbits.
    pub(super) fn changes(a: Self, b: Self, half: bool, noise: f64) -> Vec<Change> {
        let turned = (a.slope < 0.0) != (b.slope < 0.0);
        let minus = a.minus * b.minus < 0.0;
        let known = !a.minus.is_nan() && !b.minus.is_nan();
        let mut changes = Vec::new();
        if turned && (minus || !known) {
            changes.push(Change {
                test: Test::Slope,
                kind: EventKind::Fold,
            });
        } else if turned {
            changes.push(Change::TURNED);
        } else if minus {
            changes.push(Change::BRANCHES);
        }
        if a.plus * b.plus < 0.0 {
            let kind = if half {
                EventKind::SymmetryBreaking
            } else {
                EventKind::PeriodDoubling
            };
            let test = Test::Plus;
            changes.push(Change { test, kind });
        }
        if a.pairs * b.pairs < 0.0 && a.pairs.abs().max(b.pairs.abs()) > noise {
            changes.push(Change {
                test: Test::Pairs,
                kind: EventKind::NeimarkSacker,
            });
        }
        changes
    }
}
