//! A curve of bifurcations in two parameters, as a problem of continuation.
//!
//! The first parameter `lambda` becomes an unknown, and an equation more says that the orbit is a bifurcation: with the map `M`
//! of [`equations`](crate::shooting::equations),
//!
//! ```text
//! F(s, lambda; mu) = 0,     g(s, lambda; mu) = det(M -+ I) = 0                                               (1)
//! ```
//!
//! with a minus for folds and a plus for period doublings and broken symmetry; for grazing `g` is that of [`grazing_condition`](super::grazing_condition). `M` has the order of a state, so its determinant
//! is as good as the scalar of a bordered system, and is never undefined. Derivatives of `F` by `s` and `lambda` are those of the
//! flow; those by `mu`, and all of `g`, are central differences of `F` and `M`, which are exact themselves: the law's second
//! derivatives are not needed, and need not exist.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4; Kuznetsov (2004),
//! Elements of Applied Bifurcation Theory, section 10.3 (augmented systems).

use nalgebra::DMatrix;

use super::grazing_condition::GrazingCondition;
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::shooting::equations::Equations;
use crate::shooting::problem::ShootingProblem;
use crate::system::Variable;

/// Steps of differences, relative to what counts as one.
const STEP: f64 = 1e-5;

/// What is zero along the curve.
#[derive(Clone)]
pub(super) enum Condition<'a> {
    /// `det(M + shift I)`, with a shift of `-1` or `1`.
    Multiplier(f64),
    /// The distance of a gap from a level, at this frequency unless it is varied.
    Grazing(Box<GrazingCondition<'a>>, f64),
}

/// The equations (1). The last of the extended unknowns is `mu`, the one before `lambda`.
pub(super) struct Curve<'a> {
    pub(super) equations: Equations,
    pub(super) second: Variable,
    pub(super) condition: Condition<'a>,
    /// What counts as one: of the orbit, of `lambda`, of `mu`.
    pub(super) units: [f64; 3],
    inner: Jacobian,
    room: Vec<f64>,
    ahead: Vec<f64>,
    behind: Vec<f64>,
    moved: Vec<f64>,
    column: Vec<f64>,
}

impl<'a> Curve<'a> {
    pub(super) fn new(
        equations: Equations,
        second: Variable,
        condition: Condition<'a>,
        units: [f64; 3],
    ) -> Self {
        let n = equations.unknowns();
        Self {
            inner: Jacobian::new(Partition::dense(n)),
            room: vec![0.0; n],
            ahead: vec![0.0; n],
            behind: vec![0.0; n],
            moved: vec![0.0; n + 2],
            column: vec![0.0; n + 1],
            equations,
            second,
            condition,
            units,
        }
    }

    /// The same equations, with a flow of their own.
    ///
    /// # Errors
    /// If there is no flow.
    pub(super) fn again(&self, problem: &ShootingProblem) -> Result<Self, Error> {
        let equations = self.equations.again(problem)?;
        Ok(self.with(equations))
    }

    /// The same curve by other equations.
    pub(super) fn with(&self, equations: Equations) -> Self {
        Self::new(equations, self.second, self.condition.clone(), self.units)
    }

    /// Remembers where a gap has the extreme that touches, for what follows.
    pub(super) fn follow(&mut self, u: &[f64]) {
        if let Condition::Grazing(grazing, omega) = &mut self.condition {
            grazing.follow(&mut self.equations, u, *omega, self.second);
        }
    }

    /// `F` at extended unknowns into `room`, with `M` and the derivatives of `F`; returns `g`.
    fn evaluate_at(&mut self, u: &[f64], to: Part) -> f64 {
        let n = self.room.len();
        if let Err(failure) = self.equations.flow.set(self.second, u[n + 1]) {
            self.equations.failure = Some(failure);
            return f64::NAN;
        }
        self.inner.clear();
        let residual = match to {
            Part::Here => &mut self.room,
            Part::Ahead => &mut self.ahead,
            Part::Behind => &mut self.behind,
        };
        let inner = Some(&mut self.inner);
        self.equations.evaluate(&u[..=n], residual, inner);
        if self.equations.failure.is_some() {
            return f64::NAN;
        }
        match &mut self.condition {
            Condition::Multiplier(shift) => determinant(&self.equations.product, *shift),
            Condition::Grazing(grazing, omega) => {
                grazing.distance(&mut self.equations, u, *omega, self.second)
            }
        }
    }

    /// `M` at a solution.
    pub(super) fn map(&mut self, u: &[f64]) -> Option<DMatrix<f64>> {
        let g = self.evaluate_at(u, Part::Here);
        g.is_finite().then(|| self.equations.product.clone())
    }

    /// Length of a difference in the direction of an unknown.
    fn step(&self, unknown: usize) -> f64 {
        let n = self.room.len();
        let unit = match unknown.checked_sub(n) {
            None => {
                let order = self.equations.order();
                let velocity = unknown % order >= order / 2;
                let rate = if velocity {
                    self.equations.frame.omega
                } else {
                    1.0
                };
                self.units[0] * rate
            }
            Some(parameter) => self.units[1 + parameter],
        };
        STEP * unit
    }
}

/// Where a residual goes.
#[derive(Clone, Copy)]
enum Part {
    Here,
    Ahead,
    Behind,
}

/// `det(M + shift I)`
pub(super) fn determinant(map: &DMatrix<f64>, shift: f64) -> f64 {
    (map + DMatrix::identity(map.nrows(), map.ncols()) * shift).determinant()
}

impl Problem for Curve<'_> {
    fn unknowns(&self) -> usize {
        self.room.len() + 1
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let n = self.room.len();
        let g = self.evaluate_at(u, Part::Here);
        residual[..n].copy_from_slice(&self.room);
        residual[n] = g;
        let Some(jacobian) = jacobian else {
            return;
        };
        for i in 0..n {
            // The last column of the inner matrix is its border, the derivative by lambda.
            let (from, to) = (self.inner.core_mut().row_mut(i), jacobian.core_mut());
            to.row_mut(i)[..=n].copy_from_slice(&from[..=n]);
        }
        let mut column = std::mem::take(&mut self.column);
        let mut moved = std::mem::take(&mut self.moved);
        moved.copy_from_slice(u);
        for unknown in 0..n + 2 {
            let step = self.step(unknown);
            moved[unknown] = u[unknown] + step;
            let ahead = self.evaluate_at(&moved, Part::Ahead);
            moved[unknown] = u[unknown] - step;
            let behind = self.evaluate_at(&moved, Part::Behind);
            moved[unknown] = u[unknown];
            let slope = (ahead - behind) / (2.0 * step);
            if unknown <= n {
                jacobian.core_mut().row_mut(n)[unknown] = slope;
            } else {
                column[n] = slope;
                let pairs = self.ahead.iter().zip(&self.behind);
                for (to, (a, b)) in column.iter_mut().zip(pairs) {
                    *to = (a - b) / (2.0 * step);
                }
            }
        }
        jacobian.set_column(&column);
        (self.moved, self.column) = (moved, column);
    }

    fn is_cancelled(&self) -> bool {
        self.equations.is_cancelled()
    }

    fn weights(&self, weights: &mut [f64]) {
        let n = self.room.len();
        self.equations.weights(&mut weights[..n]);
        let unit = self.units[0] / self.units[1];
        weights[n] = unit * unit;
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }
}
