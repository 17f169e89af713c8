//! The state at rest: the balance with no harmonics is the static equilibrium under the mean load, switches and moving
//! contacts included.
//!
//! Newton's method starts from where the residual is smallest among amplitudes in geometric sequence along the residual
//! itself. Where nothing stiff holds the system at first, as inside a backlash, the residual is the same for all of them, and its
//! derivatives vanish. Then it starts from where the residual along the sequence changes its sign, between the amplitudes on both sides
//! of the first contact.

use super::StartRequest;
use super::effort::Effort;
use super::fixed::{Fixed, geometric};
use crate::continuation::newton::NewtonError;
use crate::numeric::linear::dot;
use crate::numeric::roots::{self, Place};

/// Amplitudes that Newton's method is tried from, at most.
const TRIALS: usize = 6;
/// Accuracy of the amplitude at which the residual changes its sign, in parts of the distance of those tried.
const CLOSE: f64 = 1e-12;

/// The static equilibrium, a balance of no harmonics; or what the last attempt to find it said.
pub(super) fn at_rest(
    request: StartRequest<'_>,
    effort: &mut Effort,
) -> Result<Vec<f64>, NewtonError> {
    let mut line = Line::new(request, effort);
    if line.at_origin == 0.0 {
        return Ok(line.origin);
    }
    let trials = geometric().map(|s| line.at(s, effort));
    let trials: Vec<Along> = trials.filter(|trial| trial.size.is_finite()).collect();
    let mut smallest: Vec<&Along> = trials.iter().collect();
    smallest.sort_by(|a, b| a.size.total_cmp(&b.size));
    let mut found = Err(NewtonError::NotFinite { iterations: 0 });
    // Where rounding hides the residual a trial comes last.
    let at_origin = line.at_origin;
    let mut hidden = Vec::new();
    let mut known = Vec::new();
    for trial in smallest {
        if known.len() == TRIALS {
            break;
        }
        let is_known = line.fixed.is_known(&trial.u, at_origin, effort);
        if is_known { &mut known } else { &mut hidden }.push(trial);
    }
    for trial in known.into_iter().chain(hidden).take(TRIALS) {
        found = line.solved(trial.u.clone(), request, effort);
        if found.is_ok() || effort.is_spent() {
            return found;
        }
    }
    let changes = trials
        .windows(2)
        .filter(|pair| pair[0].against < 0.0 && pair[1].against >= 0.0);
    for pair in changes {
        let from = line.between([&pair[0], &pair[1]], effort);
        found = line.solved(from, request, effort);
        if found.is_ok() || effort.is_spent() {
            break;
        }
    }
    found
}

/// The line from the origin along the residual there.
struct Line<'a> {
    fixed: Fixed<'a>,
    origin: Vec<f64>,
    direction: Vec<f64>,
    at_origin: f64,
}

/// The residual at an amplitude.
struct Along {
    s: f64,
    u: Vec<f64>,
    size: f64,
    /// Its part in the direction of the line.
    against: f64,
}

impl<'a> Line<'a> {
    fn new(request: StartRequest<'a>, effort: &mut Effort) -> Self {
        let mut fixed = Fixed::new(request, 0);
        let origin = fixed.zeros();
        let at_origin = fixed.residual(&origin, effort);
        let direction = fixed.residual.iter().map(|r| -r / at_origin).collect();
        Self {
            fixed,
            origin,
            direction,
            at_origin,
        }
    }

    fn at(&mut self, s: f64, effort: &mut Effort) -> Along {
        let mut u = self.origin.clone();
        for (to, x) in u.iter_mut().zip(&self.direction) {
            *to = s * x;
        }
        let size = self.fixed.residual(&u, effort);
        let against = dot(&self.fixed.residual, &self.direction);
        Along {
            s,
            u,
            size,
            against,
        }
    }

    /// Where the residual changes its sign between two amplitudes.
    fn between(&mut self, ends: [&Along; 2], effort: &mut Effort) -> Vec<f64> {
        let [low, high] = ends.map(|end| Place {
            x: end.s,
            value: end.against,
        });
        let within = CLOSE * (high.x - low.x);
        let bracket = roots::closed(low, high, within, |s| self.at(s, effort).against);
        let s = bracket.map_or(high.x, |bracket| bracket.end(true));
        self.at(s, effort).u
    }

    fn solved(
        &mut self,
        mut u: Vec<f64>,
        request: StartRequest<'_>,
        effort: &mut Effort,
    ) -> Result<Vec<f64>, NewtonError> {
        let options = request.damped(60);
        self.fixed.solve(&mut u, options, effort).map(|()| u)
    }
}
