//! The state at rest: the balance with no harmonics is the static equilibrium under the mean load, switches and moving
//! contacts included.
//!
//! Newton's method starts from where the residual is smallest among amplitudes in geometric sequence along the residual
//! itself.

use super::StartRequest;
use super::effort::Effort;
use super::fixed::{Fixed, geometric};
use crate::newton::NewtonError;

/// So many of the amplitudes are tried.
const TRIALS: usize = 6;

/// The static equilibrium, a balance of no harmonics; or what the last attempt to find it said.
pub(super) fn at_rest(
    request: StartRequest<'_>,
    effort: &mut Effort,
) -> Result<Vec<f64>, NewtonError> {
    let mut fixed = Fixed::new(request, 0);
    let origin = fixed.zeros();
    let n = origin.len() - 1;
    let at_origin = fixed.residual(&origin, effort);
    if at_origin == 0.0 {
        return Ok(origin);
    }
    let direction: Vec<f64> = fixed.residual.iter().map(|r| -r / at_origin).collect();
    let mut along = |s: f64| {
        let mut u = origin.clone();
        for i in 0..n {
            u[i] = s * direction[i];
        }
        (fixed.residual(&u, effort), u)
    };
    let mut trials: Vec<_> = geometric()
        .map(&mut along)
        .filter(|(r, _)| r.is_finite())
        .collect();
    trials.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found = Err(NewtonError::NotFinite { iterations: 0 });
    for (_, mut u) in trials.into_iter().take(TRIALS) {
        found = fixed.solve(&mut u, request.damped(60), effort).map(|()| u);
        if found.is_ok() || effort.is_spent() {
            break;
        }
    }
    found
}
