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

mod broyden;
mod error;
mod rounding;
mod tangent;
#[cfg(test)]
mod tests;
mod updates;

use broyden::Broyden;
pub use error::NewtonError;
use updates::Updates;

use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::{Norm, Problem, Scale};
use crate::continuation::statistics::Statistics;
use crate::numeric::linear::dot;

/// When to stop, and how carefully to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonOptions {
    /// Converged when the update, in units of the scale, is at most this.
    pub tolerance: f64,
    /// Give up after this many updates; after twice as many, if updates share factors.
    pub iterations: usize,
    /// Halve updates that do not reduce the residual: for starts far from the solution.
    pub damped: bool,
}

impl NewtonOptions {
    /// Updates at most.
    fn most(&self) -> usize {
        self.iterations * if self.damped { 1 } else { CHORD_PATIENCE }
    }
}

/// A successful iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Converged {
    /// Number of updates.
    pub iterations: usize,
    /// Length of the first update: how far the start was off.
    pub first: f64,
    /// Length of the last update.
    pub update: f64,
}

/// Workspace for one problem; no method allocates.
#[derive(Debug)]
pub struct Newton {
    jacobian: Jacobian,
    residual: Vec<f64>,
    update: Vec<f64>,
    trial: Vec<f64>,
    border: Vec<f64>,
    norm: Norm,
    /// The updates made with the factors at hand.
    memory: Broyden,
    /// What counts as one for each extended unknown.
    units: Vec<f64>,
    /// The scale of the factors at hand.
    scale: Scale,
    /// How far the unknowns have moved since the factors were made, in units of the scale.
    drift: f64,
    /// Largest ratio of successive updates with the factors at hand, which tells how much the matrix has changed since they were made.
    changed: f64,
    /// Largest ratio of successive updates in the last correction, where the Jacobian leaves something out.
    contraction: f64,
    /// What the last correction left, estimated, in units of the scale.
    left: f64,
    /// What rounding of the residual makes of an update, where the last correction ended there; zero otherwise.
    rounding: f64,
    /// Work done so far.
    pub statistics: Statistics,
    /// The same in multiplications, estimated.
    pub operations: u64,
}

/// What may be left after the last update, as a part of the tolerance.
const REMAINDER: f64 = 1e-5;
/// Updates that shrink by at least this factor keep the factors they were made with (a chord iteration).
const CHORD: f64 = 0.2;
/// The first update must be at most this long for the second to use its factors.
const CHORD_START: f64 = 0.05;
/// Further updates that a chord iteration is allowed for each that Newton's method is.
const CHORD_PATIENCE: usize = 2;
/// So much of a contraction is remembered after a correction that was too short to show it.
const LASTING: f64 = 0.5;
/// Updates that shrink by less than this do not shrink: that is rounding.
const STAGNANT: f64 = 0.9;
/// A matrix has changed noticeably since its factors were made where updates with them shrink more slowly than by this.
const CHANGED: f64 = 0.03;
/// Where an update above the tolerance is more than this part of the one before, the residual may be nothing but rounding.
const STEADY: f64 = 0.1;
/// The last row of (1).
#[derive(Debug, Clone, Copy)]
pub struct Border<'a> {
    /// `b`
    pub row: &'a [f64],
    /// `beta`
    pub value: f64,
}

impl Newton {
    /// Workspace for `n` unknowns and a parameter.
    pub fn new(problem: &dyn Problem) -> Self {
        let n = problem.unknowns();
        Self {
            jacobian: Jacobian::new(problem.partition()),
            residual: vec![0.0; n + 1],
            update: vec![0.0; n + 1],
            trial: vec![0.0; n + 1],
            border: vec![0.0; n + 1],
            norm: Norm::of(problem),
            memory: Broyden::new(n + 1),
            units: vec![1.0; n + 1],
            scale: Scale::UNIT,
            drift: f64::INFINITY,
            changed: 0.0,
            contraction: 0.0,
            left: 0.0,
            rounding: 0.0,
            statistics: Statistics::default(),
            operations: 0,
        }
    }

    /// The problem's norm.
    pub fn norm(&self) -> &Norm {
        &self.norm
    }

    /// Size of the residual of the equations alone, which is written.
    pub fn size_of_residual(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        values: &mut [f64],
    ) -> f64 {
        let (statistics, operations) = (&mut self.statistics, &mut self.operations);
        residual(problem, u, values, statistics, operations);
        norm(values)
    }

    /// Solves (1) repeatedly until the update is small; `u` is the start and becomes the solution. The factors of the
    /// last matrix are kept for [`Newton::solve`].
    ///
    /// As long as the updates shrink fast, the factors of the first are used again (Deuflhard (2011), Newton Methods for
    /// Nonlinear Problems, section 2.1.3: the simplified Newton method and its contraction).
    ///
    /// # Errors
    /// [`NewtonError`]; `u` then holds the last iterate.
    pub fn correct(
        &mut self,
        problem: &mut dyn Problem,
        u: &mut [f64],
        border: Border<'_>,
        scale: Scale,
        options: NewtonOptions,
    ) -> Result<Converged, NewtonError> {
        self.scale = scale;
        self.norm.write_units(scale, &mut self.units);
        self.memory.clear();
        self.rounding = 0.0;
        problem.prepare(u);
        let mut updates = Updates::after(std::mem::take(&mut self.contraction));
        let mut size = f64::INFINITY;
        let mut renew = true;
        for _ in 0..options.most() {
            if problem.is_cancelled() {
                let iterations = updates.count;
                return Err(NewtonError::Cancelled { iterations });
            }
            size = self
                .look(problem, u, border, renew, options.damped)
                .map_err(|error| error.after(updates.count))?;
            updates.first.get_or_insert(size);
            if !renew {
                self.changed = self.changed.max(size / updates.previous);
            }
            if self.ends(problem, u, size, &updates, options.tolerance) {
                updates.count += 1;
                problem.found(u);
                return Ok(updates.converged(size));
            }
            if options.damped {
                self.damped_update(problem, u, border);
            } else {
                if updates.grow_to(size, self.jacobian.is_exact()) {
                    break;
                }
                subtract(u, &self.update, 1.0);
                self.memory.remember(&self.norm, scale, &self.update);
                renew = self.renews(size, &updates, renew);
            }
            self.drift += size;
            updates.take(size);
        }
        if size <= options.tolerance {
            // They shrink slowly, but what was asked for is reached.
            self.left = left(size, updates.before);
            problem.found(u);
            return Ok(updates.converged(size));
        }
        Err(NewtonError::NotConverged {
            iterations: updates.count,
            update: size,
            residual: largest(&self.residual),
        })
    }

    /// The scale of where the first update leads, in place of one that unknowns without a size do not tell; `None` where there is none, or
    /// it leads nowhere.
    pub fn linear_response(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        border: Border<'_>,
        scale: Scale,
    ) -> Option<Scale> {
        self.scale = scale;
        self.norm.write_units(scale, &mut self.units);
        self.look(problem, u, border, true, true).ok()?;
        self.trial.copy_from_slice(u);
        subtract(&mut self.trial, &self.update, 1.0);
        self.norm.size_at(&self.trial, scale.parameter)
    }

    /// Evaluates the equations, with a new matrix or without, and writes the update that they ask for; returns its size.
    fn look(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        border: Border<'_>,
        renew: bool,
        plain: bool,
    ) -> Result<f64, NewtonError> {
        if renew {
            self.linearise(problem, u, border)?;
        } else {
            self.evaluate(problem, u, border)?;
        }
        self.next_update(plain);
        let size = self.norm.length(self.scale, &self.update);
        if size.is_finite() {
            Ok(size)
        } else {
            Err(NewtonError::NotFinite { iterations: 0 })
        }
    }

    /// Makes the update and ends with it, if nothing worth another one is left then, or rounding is all that the residual is.
    fn ends(
        &mut self,
        problem: &mut dyn Problem,
        u: &mut [f64],
        size: f64,
        updates: &Updates,
        tolerance: f64,
    ) -> bool {
        let previous = updates.previous;
        if size <= tolerance && self.is_last(size, updates, tolerance) {
            self.contraction = self.contraction.max(updates.usual * LASTING);
            self.left = left(size, previous);
        } else if size > tolerance
            && size > STEADY * previous
            && self.is_rounding(problem, u, size, tolerance)
        {
            self.left = size.max(self.rounding);
        } else {
            return false;
        }
        subtract(u, &self.update, 1.0);
        self.drift += size;
        true
    }

    /// Whether the next update needs a new matrix, after one of a size with a matrix that was `renewed` for it or not.
    fn renews(&mut self, size: f64, updates: &Updates, renewed: bool) -> bool {
        if !updates.previous.is_finite() {
            return size > CHORD_START;
        }
        let ratio = size / updates.previous;
        if !self.jacobian.is_exact() {
            self.contraction = self.contraction.max(ratio);
        }
        ratio > CHORD && (self.jacobian.is_exact() || !renewed)
    }

    /// Writes the update that the residual asks for.
    fn next_update(&mut self, plain: bool) {
        self.update.copy_from_slice(&self.residual);
        self.jacobian.solve(&mut self.update);
        unscale(&self.units, &mut self.update);
        if !plain {
            self.memory
                .improve(&self.norm, self.scale, &mut self.update);
        }
    }

    /// Whether an update is the last one worth making: what is left after it, as the updates shrink, is far below the
    /// tolerance, or rounding keeps them from shrinking. What the Jacobian leaves out need not contract in every norm at once.
    fn is_last(&self, size: f64, updates: &Updates, tolerance: f64) -> bool {
        let &Updates {
            previous,
            before,
            usual,
            ..
        } = updates;
        if !previous.is_finite() {
            return size <= REMAINDER * tolerance;
        }
        let ratio = size / previous;
        let (ratio, largest) = if self.jacobian.is_exact() {
            (ratio, 0.5 / STAGNANT * previous)
        } else if before.is_finite() {
            (ratio.max(usual), previous.max(before))
        } else {
            (ratio.max(usual), f64::INFINITY)
        };
        size * ratio <= REMAINDER * tolerance || size > STAGNANT * largest
    }

    /// Largest ratio of successive updates in the last correction where the Jacobian leaves something out; zero otherwise.
    pub fn contraction(&self) -> f64 {
        self.contraction
    }

    /// Whether an exact matrix has changed noticeably since its factors were made, as the updates of the last correction tell: the ratio of
    /// two with the same factors is the change, relative to what is least of the matrix.
    pub fn has_changed(&self) -> bool {
        self.jacobian.is_exact() && self.changed > CHANGED
    }

    /// As after a correction with this ratio: nothing else of one correction is used by the next.
    pub fn remember_contraction(&mut self, contraction: f64) {
        self.contraction = contraction;
    }

    /// How far from the solution the last correction ended, estimated, in the units of what oscillates: a mean over coordinates and time.
    pub fn left_in_oscillation(&self) -> f64 {
        self.left * self.scale.oscillation
    }

    /// The same as a change of the parameter.
    pub fn left_in_parameter(&self) -> f64 {
        self.left * self.scale.parameter
    }

    /// Solves with the matrix of the last [`Newton::correct`], in place.
    pub fn solve(&mut self, vector: &mut [f64]) {
        self.jacobian.solve(vector);
        unscale(&self.units, vector);
    }

    /// Writes `psi` with `psi^T R_u = 0` and `psi^T R_lambda = 1`, which exists at a fold: there a small residual `r`
    /// moves the parameter of the fold by `-psi . r`. The last entry is the defect, zero at the fold itself.
    pub fn left_null_vector(&mut self, psi: &mut [f64]) {
        psi.fill(0.0);
        if let Some(last) = psi.last_mut() {
            *last = self.scale.parameter;
        }
        self.jacobian.solve_transposed(psi);
    }

    /// Fills and factorises the bordered matrix at `u`, with columns in units of the scale.
    fn linearise(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        border: Border<'_>,
    ) -> Result<(), NewtonError> {
        let n = self.norm.unknowns();
        self.jacobian.clear();
        let before = problem.operations();
        problem.evaluate(u, &mut self.residual[..n], Some(&mut self.jacobian));
        self.statistics.jacobians += 1;
        self.operations += problem.operations() - before + self.jacobian.operations();
        self.close(u, border)?;
        self.border.copy_from_slice(border.row);
        self.jacobian.set_border(border.row);
        self.jacobian.scale_columns(&self.units);
        self.statistics.factorisations += 1;
        self.drift = 0.0;
        self.changed = 0.0;
        self.memory.clear();
        self.jacobian
            .factorise()
            .map_err(|at| NewtonError::Singular {
                iterations: 0,
                column: at.column,
                pivot: at.pivot,
            })
    }

    /// Evaluates the residual at `u` alone.
    fn evaluate(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        border: Border<'_>,
    ) -> Result<(), NewtonError> {
        let n = self.norm.unknowns();
        let (statistics, operations) = (&mut self.statistics, &mut self.operations);
        residual(problem, u, &mut self.residual[..n], statistics, operations);
        self.close(u, border)
    }

    /// The residual of the border; an error if any is not finite.
    fn close(&mut self, u: &[f64], border: Border<'_>) -> Result<(), NewtonError> {
        let n = self.norm.unknowns();
        self.residual[n] = dot(border.row, u) - border.value;
        if largest(&self.residual).is_finite() {
            Ok(())
        } else {
            Err(NewtonError::NotFinite { iterations: 0 })
        }
    }

    /// Takes the longest of the halved updates that reduces the residual, or the shortest.
    fn damped_update(&mut self, problem: &mut dyn Problem, u: &mut [f64], border: Border<'_>) {
        let n = self.norm.unknowns();
        let before = norm(&self.residual);
        let mut factor = 1.0;
        for _ in 0..12 {
            if problem.is_cancelled() {
                break;
            }
            self.trial.copy_from_slice(u);
            subtract(&mut self.trial, &self.update, factor);
            let (statistics, operations) = (&mut self.statistics, &mut self.operations);
            residual(
                problem,
                &self.trial,
                &mut self.residual[..n],
                statistics,
                operations,
            );
            self.residual[n] = dot(border.row, &self.trial) - border.value;
            if norm(&self.residual) < (1.0 - 1e-4 * factor) * before {
                break;
            }
            factor *= 0.5;
        }
        u.copy_from_slice(&self.trial);
    }
}

/// What is left behind an update, if those to come go on shrinking at the same rate: `q / (1 - q)` times its size. The first and only
/// one was small enough for all of it, and updates that do not shrink are rounding, of their own size.
fn left(size: f64, previous: f64) -> f64 {
    let ratio = size / previous;
    if ratio < STAGNANT {
        size * ratio / (1.0 - ratio)
    } else {
        size
    }
}

/// Evaluates the residual alone, and counts that.
fn residual(
    problem: &mut dyn Problem,
    u: &[f64],
    residual: &mut [f64],
    statistics: &mut Statistics,
    operations: &mut u64,
) {
    let before = problem.operations();
    problem.evaluate(u, residual, None);
    statistics.residuals += 1;
    *operations += problem.operations() - before;
}

/// From units of the scale to the units of the unknowns.
fn unscale(units: &[f64], vector: &mut [f64]) {
    for (x, unit) in vector.iter_mut().zip(units) {
        *x *= unit;
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
