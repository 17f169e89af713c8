//! The first orbit of a branch, without a guess from the user.
//!
//! 1. *At rest* ([`rest`]): the static equilibrium under the mean load.
//! 2. *Linear response*: one step of Newton's method from rest is the response of the system linearised there; the
//!    iteration goes on from it.
//! 3. *Equivalent linearisation* ([`equivalent`]): where the stiffness at rest is zero or unbounded, the balance in the
//!    harmonics of the load alone.
//! 4. *Homotopy* ([`homotopy`]): in the drive, from the state at rest; then in the frequency, from higher ones.
//! 5. *Motions* ([`motion`]): what motions from rest settle to.
//!
//! An orbit of period `n` is found from the one of period one, disturbed in its lowest subharmonic ([`longer`]).
//!
//! One without the odd symmetry of its system from the one that has it, disturbed in what that does not have ([`broken`]).
//!
//! No search takes more work than [`effort`] allows.

mod broken;
mod effort;
mod equivalent;
mod fixed;
mod homotopy;
mod longer;
mod motion;
mod rest;

use crate::balance::aft::Aft;
use crate::balance::{Parity, Resolution};
use crate::cancel::Cancel;
use crate::continuation::newton::{NewtonError, NewtonOptions};
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::model::layout::Layout;
use crate::system::{System, Variable};
use effort::Effort;
use equivalent::equivalent_linearisation;
use fixed::{Fixed, spread};
use rest::at_rest;

/// Where to start, and how finely.
#[derive(Clone, Copy)]
pub(crate) struct StartRequest<'a> {
    pub(crate) system: &'a dyn System,
    pub(crate) parameters: &'a [f64],
    pub(crate) omega: f64,
    pub(crate) variable: Variable,
    pub(crate) value: f64,
    pub(crate) resolution: Resolution,
    pub(crate) newton: NewtonOptions,
    /// How motions are computed, where they can be.
    pub(crate) motion: Option<&'a Motion<'a>>,
    /// Ends the search.
    pub(crate) cancel: &'a Cancel,
}

/// Moves a state in time.
pub(crate) type Motion<'a> = dyn Fn(Moving<'_>) -> Moved + 'a;

/// A state at phase zero, and how far it is to move.
pub(crate) struct Moving<'s> {
    /// Where what is varied has this value.
    pub(crate) value: f64,
    pub(crate) variable: Variable,
    pub(crate) omega: f64,
    /// Positions, then velocities.
    pub(crate) state: &'s mut [f64],
    /// Periods of the declaration that are passed, and those that are recorded after them.
    pub(crate) skipped: usize,
    pub(crate) recorded: usize,
    /// Positions in each of those.
    pub(crate) samples: usize,
    /// Multiplications that it may take.
    pub(crate) most: u64,
}

/// What came of it.
pub(crate) struct Moved {
    /// Positions at equal distances over the periods recorded, coordinate by coordinate, unless the motion could not be continued.
    pub(crate) positions: Option<Vec<f64>>,
    /// Multiplications that it took, about.
    pub(crate) operations: u64,
}

impl StartRequest<'_> {
    /// Newton's method from far away.
    fn damped(&self, iterations: usize) -> NewtonOptions {
        NewtonOptions {
            iterations,
            damped: true,
            ..self.newton
        }
    }
}

/// Extended unknowns of an orbit at the requested value.
pub(crate) fn start(
    request: StartRequest<'_>,
    statistics: &mut Statistics,
) -> Result<Vec<f64>, Error> {
    let period = request.resolution.period;
    let resolution = Resolution {
        harmonics: (request.resolution.harmonics / period).max(1),
        period: 1,
        ..request.resolution
    };
    let simple = StartRequest {
        resolution,
        ..request
    };
    let mut effort = Effort::of(effort::LIMIT, request.cancel);
    let found = orbit_of_period_one(simple, &mut effort);
    *statistics += effort.statistics;
    let found = found.map_err(|reason| effort.error(request.value, reason))?;
    if period == 1 {
        return Ok(found);
    }
    let mut effort = Effort::of(effort::LIMIT, request.cancel);
    let longer = longer::orbit(request, &found, &mut effort);
    *statistics += effort.statistics;
    longer.map_err(|attempts| attempts.without_period(period, request.value).into())
}

/// Positions in which a system rests under its mean loads.
///
/// # Errors
/// If none is found.
pub(crate) fn rest(
    system: &dyn System,
    parameters: &[f64],
    cancel: &Cancel,
) -> Result<Vec<f64>, Error> {
    let divisor = system.facts().divisor as usize;
    let resolution = Resolution {
        harmonics: divisor,
        core: divisor,
        parity: Parity::All,
        stride: 1,
        samples: 8 * divisor,
        aft: Aft::Switched,
        period: 1,
    };
    let omega = 1.0;
    let request = StartRequest {
        system,
        parameters,
        omega,
        variable: Variable::Omega,
        value: omega,
        resolution,
        newton: NewtonOptions {
            tolerance: 1e-12,
            iterations: 60,
            damped: true,
        },
        motion: None,
        cancel,
    };
    let mut effort = Effort::of(effort::LIMIT, cancel);
    let mut found = at_rest(request, &mut effort).map_err(|reason| effort.error(omega, reason))?;
    found.truncate(system.facts().coordinates.len());
    Ok(found)
}

/// Extended unknowns of an orbit of period one without the odd symmetry, if one is found near the symmetric one.
pub(crate) fn without_symmetry(
    request: StartRequest<'_>,
    symmetric: &[f64],
    statistics: &mut Statistics,
) -> Option<Vec<f64>> {
    let mut effort = Effort::of(effort::LIMIT, request.cancel);
    let found = broken::orbit(request, symmetric, &mut effort);
    *statistics += effort.statistics;
    found
}

/// An orbit of period one, by whatever finds it.
fn orbit_of_period_one(
    request: StartRequest<'_>,
    effort: &mut Effort,
) -> Result<Vec<f64>, NewtonError> {
    let rest = at_rest(request, effort);
    let met = match near(request, &rest, effort) {
        Err(met) => met,
        found => return found,
    };
    if let Ok(rest) = &rest
        && let Some(found) = homotopy::in_drive(request, rest, effort)
    {
        return Ok(found);
    }
    if let Some(found) = homotopy::in_frequency(request, effort) {
        return Ok(found);
    }
    if request.cancel.is_cancelled() {
        return Err(met);
    }
    let mut further = Effort::of(effort::LIMIT_OF_MOTIONS, request.cancel);
    let found = settled(request, rest.ok(), &mut further);
    effort.statistics += further.statistics;
    found.ok_or(met)
}

/// An orbit that motions from the state at rest and from the origin lead to.
fn settled(
    request: StartRequest<'_>,
    rest: Option<Vec<f64>>,
    effort: &mut Effort,
) -> Option<Vec<f64>> {
    let origin = vec![0.0; Layout::of(request.system).coordinates];
    let mut from = vec![origin];
    let rest = rest.map(|mut rest| {
        rest.truncate(from[0].len());
        rest
    });
    if let Some(rest) = rest.filter(|rest| *rest != from[0]) {
        from.insert(0, rest);
    }
    motion::orbit(request, &from, effort)
}

/// An orbit near the state at rest, or near those of the equivalent linearisation.
fn near(
    request: StartRequest<'_>,
    rest: &Result<Vec<f64>, NewtonError>,
    effort: &mut Effort,
) -> Result<Vec<f64>, NewtonError> {
    let mut full = Fixed::new(request, request.resolution.harmonics);
    let mut met = match rest {
        Ok(rest) => {
            let undamped = NewtonOptions {
                iterations: 8,
                damped: false,
                ..request.newton
            };
            let mut u = spread(rest, &full);
            match full.solve(&mut u, undamped, effort) {
                Ok(()) => return Ok(u),
                Err(error) => error,
            }
        }
        Err(error) => *error,
    };
    for candidate in equivalent_linearisation(request, rest.as_deref().ok(), effort) {
        if effort.is_spent() {
            break;
        }
        let mut u = spread(&candidate, &full);
        match full.solve(&mut u, request.damped(40), effort) {
            Ok(()) => return Ok(u),
            Err(error) => met = error,
        }
    }
    Err(met)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance::Parity;
    use crate::balance::aft::Aft;
    use crate::branches::error::OrbitError;
    use crate::error::ErrorKind;
    use crate::testing::by_hand::PowerForm;

    fn request<'a>(system: &'a PowerForm, period: usize, cancel: &'a Cancel) -> StartRequest<'a> {
        StartRequest {
            system,
            parameters: &system.values,
            omega: 0.8,
            variable: Variable::Omega,
            value: 0.8,
            resolution: Resolution {
                harmonics: 10 * period,
                core: 10 * period,
                parity: Parity::All,
                stride: 1,
                samples: 64,
                aft: Aft::Switched,
                period,
            },
            newton: NewtonOptions {
                tolerance: 1e-9,
                iterations: 12,
                damped: false,
            },
            motion: None,
            cancel,
        }
    }

    /// Without a load nothing is found from rest, so that the search goes on until it may not.
    #[test]
    fn a_search_ends_at_its_limit_and_says_so() {
        let cancel = Cancel::new();
        let system = PowerForm::new(false, 0.6, 0.01, 0.0, 0.1);
        let mut effort = Effort::of(1, &cancel);
        let reason = orbit_of_period_one(request(&system, 1, &cancel), &mut effort).unwrap_err();
        let error = effort.error(0.8, reason);
        assert_eq!(error.kind(), ErrorKind::Limit);
        let Some(&OrbitError::SearchLimit {
            evaluations,
            multiplications: 1,
            ..
        }) = error.downcast_ref()
        else {
            panic!("{reason}");
        };
        // The sequences of amplitudes, and what one attempt took.
        assert!(evaluations < 800, "{evaluations}");
        let mut effort = Effort::of(effort::LIMIT, &cancel);
        assert!(orbit_of_period_one(request(&system, 1, &cancel), &mut effort).is_ok());
        assert!(!effort.is_spent());
    }

    #[test]
    fn attempts_at_a_longer_period_are_counted() {
        let cancel = Cancel::new();
        let system = PowerForm::new(true, 1.0, 0.032, 1.0, 0.1);
        let mut effort = Effort::of(effort::LIMIT, &cancel);
        let simple = orbit_of_period_one(request(&system, 1, &cancel), &mut effort).unwrap();
        let whole = longer::orbit(request(&system, 2, &cancel), &simple, &mut effort).unwrap_err();
        assert_eq!((whole.planned, whole.made), (64, 64));
        assert!(whole.shorter > 32, "{whole:?}");
        let mut effort = Effort::of(1, &cancel);
        let part = longer::orbit(request(&system, 2, &cancel), &simple, &mut effort).unwrap_err();
        assert_eq!(part.made, 1);
        let told = part.without_period(2, 1.0).to_string();
        assert!(
            told.contains(": a search may take no more work after 1 of 64 attempts"),
            "{told}"
        );
    }
}
