//! What the error of the flow does to an orbit, its multipliers and its events.
//!
//! A flow with a tolerance is compared with one of a tolerance [`RATIO`] times as large: what that changes is `RATIO` times the
//! error, as long as errors are proportional to the tolerance. A closed form errs by rounding only; what rounding does is seen
//! from equations that are [disturbed](super::equations::Equations::disturbance) by much more. Both are multiplied by
//! [`SAFETY`].
//!
//! For multipliers of a closed form a bound takes less time. Rounding moves the entries of `M` by
//! `eps |M|`, and the orbit by `eps |M| |s| / min |1 - mu|`, relative to its size, which changes `M` by about `|M|` times as
//! much.

use nalgebra::{Complex, DMatrix};

use super::equations::{Equations, Frame, Span};
use super::setting::Setting;
use crate::error::Error;
use crate::flow::Work;
use crate::newton::{Newton, NewtonOptions};
use crate::stability::{Stability, distance, eigenvalues};

/// Ratio of the two tolerances.
const RATIO: f64 = 1e4;
/// No flow is asked for a larger tolerance.
const LOOSEST: f64 = 1e-4;
/// By how much the error may be larger than the ratio says.
const SAFETY: f64 = 10.0;
/// Rounding errors of a closed form over a period, together, in units of the largest state.
const ROUNDING: f64 = 50.0 * f64::EPSILON;
/// Disturbance of a closed form, in the same units.
const DISTURBANCE: f64 = 1e-9;

/// Equations that are as wrong as those of an orbit, many times over.
pub(super) struct Companion<'a> {
    pub(super) equations: Equations<'a>,
    pub(super) newton: Newton,
    pub(super) options: NewtonOptions,
    /// Errors of the orbit are this part of what differs here.
    pub(super) part: f64,
    exact: bool,
}

/// What is known of an orbit's accuracy.
pub(super) struct Judged {
    pub(super) stability: Stability,
    /// Error of the states, of velocities in units of the frequency.
    pub(super) error: f64,
}

impl<'a> Companion<'a> {
    /// Of the equations over this span, at orbits of this size.
    pub(super) fn new(
        setting: &Setting<'a>,
        span: Span,
        frame: Frame,
        size: f64,
    ) -> Result<Self, Error> {
        let exact = setting.source.exact;
        let fine = setting.source.tolerance;
        let tolerance = if exact {
            fine
        } else {
            (RATIO * fine).min(LOOSEST)
        };
        let mut equations = Equations::new(setting, tolerance, span, frame)?;
        let part = if exact {
            equations.disturbance = DISTURBANCE * size;
            SAFETY * ROUNDING * equations.frame.ratio / DISTURBANCE
        } else {
            SAFETY * fine / tolerance
        };
        Ok(Self {
            newton: Newton::new(&equations),
            options: setting.newton(tolerance, equations.frame.ratio),
            equations,
            part: part.min(1.0),
            exact,
        })
    }

    /// The verdict on the orbit `u` with the map `M`, and its error.
    pub(super) fn judge(&mut self, u: &[f64], map: &DMatrix<f64>) -> Judged {
        let half = self.equations.span.half;
        let multipliers = multipliers(map, half);
        if multipliers.is_empty() {
            return Judged {
                stability: Stability::unknown(),
                error: f64::INFINITY,
            };
        }
        let size = u[..u.len() - 1]
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let ratio = self.equations.frame.ratio;
        let (by_rounding, mut error) = rounding(map, &multipliers, half, ratio);
        error *= size;
        let mut spread = by_rounding;
        if !self.exact {
            if let Some((other, moved)) = self.differing(u) {
                spread += self.part * distance(&multipliers, &other);
                error += self.part * moved;
            } else {
                spread = f64::INFINITY;
                error = f64::INFINITY;
            }
        }
        Judged {
            stability: Stability::of(multipliers, spread),
            error,
        }
    }

    /// The multipliers of these equations at the same parameter, and how far the orbit moved.
    fn differing(&mut self, u: &[f64]) -> Option<(Vec<Complex<f64>>, f64)> {
        let mut other = u.to_vec();
        super::solve::at_value(
            &mut self.equations,
            &mut self.newton,
            &mut other,
            self.options,
        )
        .ok()?;
        let map = self.equations.map(&other, &mut |_| {}).ok()?;
        let moved = self.equations.apart(u, &other);
        Some((multipliers(&map, self.equations.span.half), moved))
    }

    pub(super) fn work(&self) -> Work {
        self.equations.flow.work()
    }
}

/// Multipliers over the whole period, largest first.
pub(super) fn multipliers(map: &DMatrix<f64>, half: bool) -> Vec<Complex<f64>> {
    let mut values = eigenvalues(map);
    if half {
        for value in &mut values {
            *value *= *value;
        }
    }
    values
}

/// Errors that rounding leaves in the multipliers, and in the states relative to the size of their oscillation.
fn rounding(
    map: &DMatrix<f64>,
    multipliers: &[Complex<f64>],
    half: bool,
    ratio: f64,
) -> (f64, f64) {
    let size = map.norm().max(1.0);
    let nearest = multipliers
        .iter()
        .map(|m| (m - 1.0).norm())
        .fold(f64::INFINITY, f64::min);
    // Where a multiplier is one, an error moves the orbit by its root only: the branch bends away.
    let states = ROUNDING * ratio * size / nearest.max(ROUNDING.sqrt());
    let delta = ROUNDING * size + states * size;
    let disturbed = |sign: f64| {
        let entries = DMatrix::from_fn(map.nrows(), map.ncols(), |i, j| {
            let alternating = if (i + j).is_multiple_of(2) { 1.0 } else { sign };
            map[(i, j)] + delta * alternating
        });
        distance(multipliers, &self::multipliers(&entries, half))
    };
    (disturbed(1.0).max(disturbed(-1.0)), states)
}
