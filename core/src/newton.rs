//! Newton's method on a bordered system.
//!
//! For `n` equations `R(u) = 0` in `n + 1` extended unknowns and one linear condition `b . u = beta`:
//!
//! ```text
//! [ R_u ]        [ R(u)         ]
//! [ b^T ] du = - [ b . u - beta ]                                                                            (1)
//! ```
//!
//! Source: Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems; the border is the
//! unit vector of the parameter to solve at a fixed parameter, and a tangent for a step of pseudo-arclength.

use crate::continuation::problem::{Norm, Problem, Scale};
use crate::linear::{Lu, Matrix, Singular};
use crate::statistics::Statistics;

/// When to stop, and how carefully to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonOptions {
    /// Converged when the update, in units of the scale, is at most this.
    pub tolerance: f64,
    /// Give up after this many updates.
    pub iterations: usize,
    /// Halve updates that do not reduce the residual: for starts far from the solution.
    pub damped: bool,
}

/// A successful iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Converged {
    /// Number of updates.
    pub iterations: usize,
    /// Length of the last update.
    pub update: f64,
}

/// Why an iteration ended without a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NewtonError {
    /// The updates did not become small.
    NotConverged {
        /// Number of updates.
        iterations: usize,
        /// Length of the last update.
        update: f64,
        /// Largest residual.
        residual: f64,
    },
    /// The bordered matrix is singular.
    Singular {
        /// After this many updates.
        iterations: usize,
        /// Where elimination stopped.
        at: Singular,
    },
    /// The residual is not a number.
    NotFinite {
        /// After this many updates.
        iterations: usize,
    },
}

impl std::fmt::Display for NewtonError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotConverged {
                iterations,
                update,
                residual,
            } => write!(
                f,
                "Newton's method did not converge in {iterations} iterations: last update {update:.1e}, residual {residual:.1e}"
            ),
            Self::Singular { iterations, at } => write!(
                f,
                "the Jacobian is singular after {iterations} iterations: pivot {:.1e} in column {}",
                at.pivot, at.column
            ),
            Self::NotFinite { iterations } => {
                write!(
                    f,
                    "the residual is not finite after {iterations} iterations"
                )
            }
        }
    }
}

impl std::error::Error for NewtonError {}

/// Room for one problem; no method allocates.
#[derive(Debug)]
pub struct Newton {
    matrix: Matrix,
    lu: Lu,
    residual: Vec<f64>,
    update: Vec<f64>,
    trial: Vec<f64>,
    norm: Norm,
    /// The scale of the factors at hand.
    scale: Scale,
    /// Work done so far.
    pub statistics: Statistics,
}

/// The last row of (1).
#[derive(Debug, Clone, Copy)]
pub struct Border<'a> {
    /// `b`
    pub row: &'a [f64],
    /// `beta`
    pub value: f64,
}

impl Newton {
    /// Room for `n` unknowns and a parameter.
    pub fn new(problem: &impl Problem) -> Self {
        let n = problem.unknowns();
        Self {
            matrix: Matrix::zeros(n + 1),
            lu: Lu::new(n + 1),
            residual: vec![0.0; n + 1],
            update: vec![0.0; n + 1],
            trial: vec![0.0; n + 1],
            norm: Norm::of(problem),
            scale: Scale::UNIT,
            statistics: Statistics::default(),
        }
    }

    /// The problem's norm.
    pub fn norm(&self) -> &Norm {
        &self.norm
    }

    /// Solves (1) repeatedly until the update is small; `u` is the start and becomes the solution. The factors of the
    /// last matrix are kept for [`Newton::solve_bordered`].
    ///
    /// # Errors
    /// [`NewtonError`]; `u` then holds the last iterate.
    pub fn correct(
        &mut self,
        problem: &mut impl Problem,
        u: &mut [f64],
        border: Border<'_>,
        scale: Scale,
        options: NewtonOptions,
    ) -> Result<Converged, NewtonError> {
        self.scale = scale;
        let mut previous = f64::INFINITY;
        let mut updates = 0;
        let mut size = f64::INFINITY;
        for iteration in 0..options.iterations {
            self.linearise(problem, u, border)
                .map_err(|error| error.after(iteration))?;
            self.update.copy_from_slice(&self.residual);
            self.lu.solve(&self.matrix, &mut self.update);
            unscale(&self.norm, scale, &mut self.update);
            size = self.norm.length(scale, &self.update);
            if !size.is_finite() {
                return Err(NewtonError::NotFinite {
                    iterations: iteration,
                });
            }
            if size <= options.tolerance {
                subtract(u, &self.update, 1.0);
                return Ok(Converged {
                    iterations: iteration + 1,
                    update: size,
                });
            }
            if options.damped {
                self.damped_update(problem, u, border);
            } else {
                if iteration > 1 && size > 2.0 * previous {
                    break;
                }
                subtract(u, &self.update, 1.0);
            }
            updates = iteration + 1;
            previous = size;
        }
        Err(NewtonError::NotConverged {
            iterations: updates,
            update: size,
            residual: largest(&self.residual),
        })
    }

    /// Solves with the matrix of the last [`Newton::correct`] and a right-hand side that is zero but for the border.
    /// With a unit value there, the result is the tangent of the solution curve, not yet normalised.
    pub fn solve_border(&self, tangent: &mut [f64]) {
        tangent.fill(0.0);
        if let Some(last) = tangent.last_mut() {
            *last = 1.0;
        }
        self.solve(tangent);
    }

    /// Solves with the matrix of the last [`Newton::correct`], in place.
    pub fn solve(&self, vector: &mut [f64]) {
        self.lu.solve(&self.matrix, vector);
        unscale(&self.norm, self.scale, vector);
    }

    /// Writes `psi` with `psi^T R_u = 0` and `psi^T R_lambda = 1`, which exists at a fold: there a small residual `r`
    /// moves the parameter of the fold by `-psi . r`. The last entry is the defect, zero at the fold itself.
    pub fn left_null_vector(&self, psi: &mut [f64]) {
        psi.fill(0.0);
        if let Some(last) = psi.last_mut() {
            *last = self.scale.parameter;
        }
        self.lu.solve_transposed(&self.matrix, psi);
    }

    /// Fills and factorises the bordered matrix at `u`, with columns in units of the scale.
    fn linearise(
        &mut self,
        problem: &mut impl Problem,
        u: &[f64],
        border: Border<'_>,
    ) -> Result<(), NewtonError> {
        let n = self.norm.unknowns();
        self.matrix.clear();
        problem.evaluate(u, &mut self.residual[..n], Some(&mut self.matrix));
        self.statistics.jacobians += 1;
        self.matrix.row_mut(n).copy_from_slice(border.row);
        self.residual[n] = crate::linear::dot(border.row, u) - border.value;
        if !largest(&self.residual).is_finite() {
            return Err(NewtonError::NotFinite { iterations: 0 });
        }
        for row in 0..=n {
            let entries = self.matrix.row_mut(row);
            for (column, x) in entries.iter_mut().enumerate() {
                *x *= self.norm.unit(self.scale, column);
            }
        }
        self.statistics.factorisations += 1;
        self.lu
            .factorise(&mut self.matrix)
            .map_err(|at| NewtonError::Singular { iterations: 0, at })
    }

    /// Takes the longest of the halved updates that reduces the residual, or the shortest.
    fn damped_update(&mut self, problem: &mut impl Problem, u: &mut [f64], border: Border<'_>) {
        let n = self.norm.unknowns();
        let before = norm(&self.residual);
        let mut factor = 1.0;
        for _ in 0..12 {
            self.trial.copy_from_slice(u);
            subtract(&mut self.trial, &self.update, factor);
            problem.evaluate(&self.trial, &mut self.residual[..n], None);
            self.statistics.residuals += 1;
            self.residual[n] = crate::linear::dot(border.row, &self.trial) - border.value;
            if norm(&self.residual) < (1.0 - 1e-4 * factor) * before {
                break;
            }
            factor *= 0.5;
        }
        u.copy_from_slice(&self.trial);
    }
}

impl NewtonError {
    fn after(self, iterations: usize) -> Self {
        match self {
            Self::Singular { at, .. } => Self::Singular { iterations, at },
            Self::NotFinite { .. } => Self::NotFinite { iterations },
            other @ Self::NotConverged { .. } => other,
        }
    }
}

/// From units of the scale to the units of the unknowns.
fn unscale(norm: &Norm, scale: Scale, vector: &mut [f64]) {
    for (unknown, x) in vector.iter_mut().enumerate() {
        *x *= norm.unit(scale, unknown);
    }
}

fn subtract(u: &mut [f64], update: &[f64], factor: f64) {
    for (x, d) in u.iter_mut().zip(update) {
        *x -= factor * d;
    }
}

/// Largest entry by size; not a number as soon as one entry is not.
fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |m: f64, x| {
        if x.abs() <= m || m.is_nan() {
            m
        } else {
            x.abs()
        }
    })
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
