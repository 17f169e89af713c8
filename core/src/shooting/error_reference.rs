//! What the error of the flow does to an orbit, its multipliers and its events.
//!
//! A flow with a tolerance is compared with a finer one: the orbit is corrected for it, and what that changes is the error. What
//! is reported then is the corrected orbit, so that the error stated is rather that of the orbit before.
//!
//! Where no finer flow can be asked for, the reference is a coarser one; the orbit itself is reported then, and the error is that
//! of the coarser one.
//!
//! A closed form errs by rounding only. What that does is seen from equations that are
//! [disturbed](super::equations::Equations::disturbance) by much more. Besides, rounding moves the entries of `M` by `eps |M|`,
//! and the orbit by `eps |M| / min |1 - mu|` relative to its size, which changes `M` by about `|M|` times as much.

use nalgebra::{Complex, DMatrix};

use super::equations::{Equations, Frame, Span};
use super::problem::ShootingProblem;
use crate::branches::moduli::{self, multipliers};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::error::Error;
use crate::time::Work;

/// Ratio of the two tolerances.
const FINER: f64 = 1e-2;
/// No flow is asked for a smaller tolerance.
const FINEST: f64 = 1e-14;
/// By how much an error may be larger than a tolerance.
const SAFETY: f64 = 10.0;
/// Rounding errors of a flow over a period, together, in units of the largest state.
pub(super) const ROUNDING: f64 = 50.0 * f64::EPSILON;
/// Disturbance of a closed form, in the same units.
const DISTURBANCE: f64 = 1e-9;
/// An update of this size leaves the square of it.
pub(super) const ONE_UPDATE: f64 = 1e-3;

/// Equations of the same orbits that are finer, or, of a closed form, disturbed.
pub(super) struct ErrorReference {
    pub(super) equations: Equations,
    pub(super) newton: Newton,
    pub(super) options: NewtonOptions,
    /// Errors of events are this part of what differs here.
    pub(super) part: f64,
    /// These equations are finer: what is reported are their orbits.
    pub(super) finer: bool,
    /// Errors that the flow leaves, in units of the oscillation, and what rounding has in them.
    pub(super) noise: f64,
    pub(super) rounding: f64,
}

/// An orbit of the reference's equations.
pub(super) struct Corrected {
    pub(super) u: Vec<f64>,
    /// Multipliers before the correction.
    pub(super) multipliers: Vec<Complex<f64>>,
}

impl ErrorReference {
    /// Of the equations over this span, at orbits of this size.
    pub(super) fn new(
        problem: &ShootingProblem,
        span: Span,
        frame: Frame,
        size: f64,
    ) -> Result<Self, Error> {
        let exact = problem.source.exact;
        let finer = !exact && FINER * problem.source.tolerance >= FINEST;
        let ratio = if finer || exact { FINER } else { 1.0 / FINER };
        let tolerance = (ratio * problem.source.tolerance).max(FINEST);
        let rounding = ROUNDING * frame.ratio;
        let mut equations = Equations::new(problem, tolerance, span, frame)?;
        let (part, noise) = if exact {
            equations.disturbance = DISTURBANCE * size;
            ((SAFETY * rounding / DISTURBANCE).min(1.0), rounding)
        } else {
            (
                1.0,
                rounding + SAFETY * tolerance.min(problem.source.tolerance),
            )
        };
        Ok(Self {
            newton: Newton::new(&equations),
            options: problem.newton(tolerance, equations.frame.ratio),
            equations,
            part,
            finer,
            noise,
            rounding,
        })
    }

    /// The orbit of these equations near `u`, at the same parameter.
    pub(super) fn correct(&mut self, u: &[f64]) -> Option<Corrected> {
        let mut corrected = u.to_vec();
        let options = NewtonOptions {
            tolerance: self.options.tolerance.max(ONE_UPDATE),
            ..self.options
        };
        let (equations, newton) = (&mut self.equations, &mut self.newton);
        crate::branches::solve::at_value(equations, newton, &mut corrected, options).ok()?;
        Some(Corrected {
            u: corrected,
            multipliers: multipliers(&equations.product, equations.span.recurrence.parts),
        })
    }

    /// The multipliers that those of an orbit are compared with: before the correction, or of the other orbit.
    pub(super) fn multipliers_beside(&mut self, corrected: &Corrected) -> Vec<Complex<f64>> {
        if self.finer {
            return corrected.multipliers.clone();
        }
        let map = self.equations.map(&corrected.u, &mut |_| {});
        map.map_or_else(
            |_| Vec::new(),
            |map| multipliers(&map, self.equations.span.recurrence.parts),
        )
    }

    /// Errors that the flow leaves in the multipliers of a map, and in the states relative to the size of their oscillation.
    pub(super) fn errors(&self, map: &DMatrix<f64>, multipliers: &[Complex<f64>]) -> (f64, f64) {
        let parts = self.equations.span.recurrence.parts;
        let size = map.norm().max(1.0);
        // The equations are those of the part that is followed.
        let nearest = moduli::of_map(map).into_iter().map(|m| (m - 1.0).norm());
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        // Where a multiplier is one, an error moves the orbit by its root only: the branch bends away.
        let states = self.noise * size / nearest.max(self.noise.sqrt());
        let delta = (self.noise + states) * size;
        (moved(map, multipliers, parts, delta), states)
    }

    pub(super) fn work(&self) -> Work {
        self.equations.flow.work()
    }
}

/// How far multipliers move when the entries of their map do.
pub(super) fn moved(map: &DMatrix<f64>, found: &[Complex<f64>], parts: usize, by: f64) -> f64 {
    let disturbed = |sign: f64| {
        let entries = DMatrix::from_fn(map.nrows(), map.ncols(), |i, j| {
            let alternating = if (i + j).is_multiple_of(2) { 1.0 } else { sign };
            map[(i, j)] + by * alternating
        });
        moduli::distance(found, &multipliers(&entries, parts), map.nrows())
    };
    disturbed(1.0).max(disturbed(-1.0))
}
