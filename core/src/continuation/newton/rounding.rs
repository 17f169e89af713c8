//! Where rounding of the residual keeps updates from becoming small.
//!
//! The tolerance is relative to what oscillates, rounding is relative to the whole: to means, offsets and forces. A small motion about
//! a static state is known to fewer digits than are asked for. A solution is then one whose residual is not larger than the rounding of
//! the terms it is summed from.
//!
//! Source: Higham (2002), Accuracy and Stability of Numerical Algorithms, section 25.2 (the limiting residual of Newton's method).

use super::{Newton, NewtonError, largest};
use crate::continuation::problem::{Problem, Scale};

/// An update of so many times what one rounding of each term makes is still its doing. Chosen, not derived: a residual of [`ROUNDINGS`]
/// could make as many times that.
const EXPLAINED: f64 = 16.0;
/// What conditioning may make of rounding. Where it takes more, as beside a branch point, it is the matrix and not the size of the terms
/// that keeps updates from shrinking.
const CONDITION: f64 = 1e3;
/// A residual of so many roundings of its terms is nothing but rounding: sums over harmonics and nodes add up.
const ROUNDINGS: f64 = 64.0;
/// Where one rounding of each term moves a solution by more than this part of its size, it is none.
const MOST: f64 = 0.1;

impl Newton {
    /// Whether the residual at `u` is nothing but rounding, and an update of this size what it makes of it. If so, keeps the latter.
    pub(super) fn is_rounding(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        update: f64,
        tolerance: f64,
    ) -> bool {
        let n = self.norm.unknowns();
        let before = problem.operations();
        let known = problem.terms(u, &mut self.trial[..n]);
        self.operations += problem.operations() - before;
        let within = |(r, terms): (&f64, &f64)| r.abs() <= ROUNDINGS * f64::EPSILON * terms;
        if !known || !self.residual[..n].iter().zip(&self.trial).all(within) {
            return false;
        }
        let largest = self.trial[..n].iter().copied().fold(0.0, f64::max);
        if CONDITION * f64::EPSILON * largest <= tolerance * self.jacobian.smallest_equation() {
            return false;
        }
        let size = self.made_by_rounding(self.scale);
        let explained = size.is_finite() && update <= EXPLAINED * size;
        if explained {
            self.rounding = size;
        }
        explained
    }

    /// Size of the update that one rounding of each of the terms in `trial` makes.
    fn made_by_rounding(&mut self, scale: Scale) -> f64 {
        let n = self.norm.unknowns();
        for (to, r) in self.trial[..n].iter_mut().zip(&self.residual) {
            *to = (f64::EPSILON * *to).copysign(*r);
        }
        self.trial[n] = 0.0;
        let mut made = std::mem::take(&mut self.trial);
        self.solve(&mut made);
        let size = self.norm.length(scale, &made);
        self.trial = made;
        size
    }

    /// Refuses a solution of which rounding leaves nothing: where terms of a high power cancel, residuals and updates may vanish far from
    /// any solution. To be asked right after [`correct`](Self::correct).
    ///
    /// # Errors
    /// [`NewtonError::NotConverged`] with what rounding makes of an update.
    pub fn is_told_from_rounding(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
    ) -> Result<(), NewtonError> {
        let n = self.norm.unknowns();
        let before = problem.operations();
        let known = problem.terms(u, &mut self.trial[..n]);
        self.operations += problem.operations() - before;
        if !known {
            return Ok(());
        }
        let residual = largest(&self.trial[..n]) * f64::EPSILON;
        let own = self.norm.scale_at(u, self.scale.parameter, &mut [0.0; 2]);
        // A small motion about a state is measured by the whole.
        let update = self.made_by_rounding(Scale {
            oscillation: own.mean,
            ..own
        });
        if update <= MOST {
            return Ok(());
        }
        Err(NewtonError::NotConverged {
            iterations: 0,
            update,
            residual,
        })
    }

    /// What rounding of the residual makes of an update, in the units of what oscillates, where the last correction ended there; zero
    /// otherwise.
    pub fn rounding_size(&self) -> f64 {
        self.rounding * self.scale.oscillation
    }
}
