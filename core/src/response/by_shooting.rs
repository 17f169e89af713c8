//! Requests by shooting, and curves in two parameters, which are always followed by it.

use std::sync::Arc;

use super::branch::Following;
use super::sealed::Follow;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::{Branch, Further};
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::{Guess, Request};
use crate::error::Error;
use crate::event::{EventKind, Side};
use crate::model::request::RequestError;
use crate::model::validate;
use crate::shooting::{
    Asked, BifurcationCurve, Plane, Shooting, bifurcation_curve, complete, compute, with_states,
};

impl Follow for Shooting {
    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        let problem = Asked {
            request,
            shooting: self,
        }
        .problem(value, value)?;
        compute::orbit(&problem, &guess(request, value)?, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        let (range, problem) = Asked {
            request,
            shooting: self,
        }
        .ranged()?;
        let guess = guess(request, range[0])?;
        let branch = compute::branch(&problem, &guess, range, visit)?;
        Ok(with_request(branch, request, *self))
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        Asked {
            request,
            shooting: self,
        }
        .belongs(&event.point)?;
        let doubles = event.kind == EventKind::PeriodDoubling;
        let period = event.point.orbit.period * if doubles { 2 } else { 1 };
        let (shooting, request) = of_period(*self, request, period);
        let (range, problem) = Asked {
            request: &request,
            shooting: &shooting,
        }
        .ranged()?;
        let event = with_states(&problem, event);
        let branch = compute::branch_at(&problem, &event, side.sign(), range, visit)?;
        Ok(with_request(branch, &request, shooting))
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        let ([from, to], problem) = Asked {
            request,
            shooting: self,
        }
        .ranged()?;
        validate::option(
            "through",
            value,
            from.min(to)..=from.max(to),
            "must be between from and to",
        )?;
        let guess = guess(request, value)?;
        let branch = compute::branch_through(&problem, &guess, value, [from, to], visit)?;
        Ok(with_request(branch, request, *self))
    }
}

/// The second parameter of a curve, and its range.
#[derive(Clone, Copy)]
pub(super) struct Second<'n> {
    pub(super) name: &'n str,
    pub(super) range: [f64; 2],
}

/// The curve of bifurcations through an event.
///
/// # Errors
/// If a parameter or an option is not usable, or there is no such curve.
pub(super) fn track(
    request: &Request,
    shooting: Shooting,
    event: &Event,
    second: Second<'_>,
    visit: See<'_>,
) -> Result<BifurcationCurve, Error> {
    Asked {
        request,
        shooting: &shooting,
    }
    .belongs(&event.point)?;
    let (shooting, request) = of_period(shooting, request, event.point.orbit.period);
    let asked = Asked {
        request: &request,
        shooting: &shooting,
    };
    let (range, problem) = asked.ranged()?;
    let facts = request.system.facts();
    let variable = validate::variable(facts, Some(second.name))?;
    validate::range(facts, variable, second.range[0], second.range[1])?;
    if variable == problem.variable {
        let name = second.name.to_owned();
        let must = "must be another one than what the branch varies";
        return Err(RequestError::Varied { name, must }.into());
    }
    let plane = Plane {
        system: request.system.as_ref(),
        second: variable,
        name: second.name.to_owned(),
        ranges: [range, second.range],
    };
    bifurcation_curve::track(&problem, &with_states(&problem, event), &plane, visit)
}

/// An orbit with its series and everything that is read off.
///
/// # Errors
/// If its motion cannot be computed.
pub(super) fn completed(
    request: &Request,
    shooting: Shooting,
    point: &Point,
) -> Result<Point, Error> {
    let (shooting, request) = of_period(shooting, request, point.orbit.period);
    let asked = Asked {
        request: &request,
        shooting: &shooting,
    };
    asked.belongs(point)?;
    complete::complete(&asked.problem(point.value, point.value)?, point)
}

/// The same request for orbits of another period, with as many segments as it has periods.
pub(super) fn of_period(
    shooting: Shooting,
    request: &Request,
    period: usize,
) -> (Shooting, Request) {
    let shooting = Shooting {
        segments: None,
        ..shooting
    };
    let request = Request {
        period: Some(period),
        near: None,
        ..request.clone()
    };
    (shooting, request)
}

/// What the orbit at a value is near: as given, or found by the balance.
fn guess(request: &Request, value: f64) -> Result<Guess, Error> {
    if let Some(guess) = &request.near {
        return Ok(guess.clone());
    }
    let request = Request {
        from: None,
        to: None,
        stability: false,
        tolerance: GUESSED,
        ..request.clone()
    };
    let point = HarmonicBalance::new().orbit(&request, value)?;
    Ok(Guess::Orbit(point.orbit))
}

/// Accuracy of a first orbit that is corrected afterwards.
const GUESSED: f64 = 1e-6;

fn with_request(branch: Branch, request: &Request, shooting: Shooting) -> Branch {
    Branch {
        further: Further {
            system: Some(Arc::clone(&request.system)),
            request: Some(Arc::new(Following::Shooting(
                request.afterwards(),
                shooting,
            ))),
        },
        ..branch
    }
}
