//! Requests by shooting, and curves in two parameters, which are always followed by it.

use std::sync::Arc;

use super::both_ways::{BothWays, Part, Way};
use super::following::{Following, Left, begin};
use super::in_turn::Otherwise;
use super::sealed::Follow;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::{Branch, Further, Source};
use crate::branches::observed::Motion;
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::{Guess, Request};
use crate::error::Error;
use crate::event::Side;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::orbit::observe::{Accuracy, Reading};
use crate::shooting::compute::{self, Followed};
use crate::shooting::signals::Found;
use crate::shooting::{
    Asked, BifurcationCurve, Plane, Rest, Shooting, bifurcation_curve, complete, with_states,
};
use crate::time::signals::Asked as Signal;

impl Follow for Shooting {
    fn accurate_in(self, accuracy: Accuracy) -> Self {
        Self { accuracy, ..self }
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        let problem = Asked::of(request, self).problem(value, value)?;
        compute::orbit(&problem, &guess(request, value)?, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        run(request, *self, None, visit)
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        Asked::of(request, self).belongs(&event.point)?;
        let period = event.period_of_branch();
        let (shooting, request) = of_period(*self, request, period);
        let (range, problem) = Asked::of(&request, &shooting).ranged()?;
        let event = with_states(&problem, event);
        begin(&request, || {
            further(&request, shooting, Left::Nothing, None)
        })?;
        let followed = compute::branch_at(&problem, &event, side.sign(), range, visit)?;
        Ok(with_request(followed, &request, shooting, None))
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        let both = BothWays::through(request, value)?;
        both_ways(request, *self, None, &both, visit)
    }
}

/// The branch from one end of the range to the other, and what is tried where it leads no further.
///
/// # Errors
/// If the request is not usable, or there is no first orbit.
pub(super) fn run(
    request: &Request,
    shooting: Shooting,
    otherwise: Option<Otherwise>,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = Asked::of(request, &shooting).ranged()?;
    let guess = guess(request, range[0])?;
    begin(request, || {
        further(request, shooting, Left::Nothing, otherwise)
    })?;
    let followed = compute::branch(&problem, &guess, range, visit)?;
    Ok(with_request(followed, request, shooting, otherwise))
}

/// The branch through the orbit at a value, or what is left of it.
///
/// # Errors
/// If there is no such orbit, or what it goes on from does not belong to it.
pub(super) fn both_ways(
    request: &Request,
    shooting: Shooting,
    known: Option<&Branch>,
    both: &BothWays<Rest>,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = Asked::of(request, &shooting).ranged()?;
    let mut found = None;
    let follow = |way: Way, known: Option<(&Branch, &Rest)>| {
        // Each part ends where the range does.
        let range = way.of(range);
        let Followed { branch, rest } = if let Some((branch, rest)) = known {
            compute::resume(&problem, branch, rest, range, &mut *visit)?
        } else {
            let begun = match found.take() {
                Some(guess) => guess,
                None => guess(request, both.value)?,
            };
            let begun = found.insert(begun);
            compute::branch_from(&problem, begun, both.value, range, &mut *visit)?
        };
        Ok(Part { branch, rest })
    };
    let (branch, left) = both.follow(known, &request.cancel, follow)?;
    let left = Left::BothWays(Box::new(left));
    Ok(Branch {
        further: further(request, shooting, left, None),
        ..branch
    })
}

/// Goes on with a branch that was interrupted.
///
/// # Errors
/// If what it goes on from does not belong to it.
pub(super) fn resume(
    request: &Request,
    shooting: Shooting,
    otherwise: Option<Otherwise>,
    branch: &Branch,
    rest: &Rest,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = Asked::of(request, &shooting).ranged()?;
    begin(request, || {
        further(request, shooting, Left::Nothing, otherwise)
    })?;
    let followed = compute::resume(&problem, branch, rest, range, visit)?;
    Ok(with_request(followed, request, shooting, otherwise))
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
    Asked::of(request, &shooting).belongs(&event.point)?;
    let (shooting, request) = of_period(shooting, request, event.point.orbit.period);
    let asked = Asked::of(&request, &shooting);
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
    let shooting = as_known(shooting, &request, point);
    let asked = Asked::of(&request, &shooting);
    asked.belongs(point)?;
    complete::complete(&asked.problem(point.value, point.value)?, point)
}

/// A signal of an orbit that is known by its states.
///
/// # Errors
/// If the orbit is not one of the system, or its motion cannot be computed.
pub(super) fn reading(
    request: &Request,
    shooting: Shooting,
    point: &Point,
    source: Source,
) -> Result<Reading, Error> {
    let (shooting, request) = of_period(shooting, request, point.orbit.period);
    let shooting = as_known(shooting, &request, point);
    let asked = Asked::of(&request, &shooting);
    asked.belongs(point)?;
    let problem = asked.problem(point.value, point.value)?;
    let found = complete::reading(&problem, point, signal(source))?;
    Ok(read(found, point))
}

/// What a source is along a motion.
pub(super) fn signal(source: Source) -> Signal {
    match source {
        Source::Output(index) => Signal::Output(index),
        Source::Coordinate(index) => Signal::Coordinate(index),
        Source::Contact(index) => Signal::Contact(index),
    }
}

/// The first of what was found along the motion of an orbit.
pub(super) fn read(found: Vec<Found>, point: &Point) -> Reading {
    let nothing = || Found {
        motion: Motion::of(&[]),
        series: Vec::new(),
    };
    let Found { motion, series } = found.into_iter().next().unwrap_or_else(nothing);
    Reading {
        motion,
        series,
        base: point.orbit.base,
    }
}

/// Shooting with a flow whose tolerance is a tenth of the stated error of an orbit, where that is finer than what was asked for.
fn as_known(shooting: Shooting, request: &Request, point: &Point) -> Shooting {
    let tolerance = shooting.flow_tolerance(request.tolerance);
    let known = point
        .error
        .filter(|error| error.is_finite() && *error > 0.0);
    let finer = known.map_or(tolerance, |error| (FINER * error).max(FINEST));
    shooting.tolerance(finer.min(tolerance))
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
    Ok(Guess::Orbit(balanced(request, value)?.orbit))
}

/// The orbit at a value that others begin at, with its series: as the balance finds it, or from an orbit or a state that is given.
pub(super) fn with_series(request: &Request, value: f64) -> Result<Point, Error> {
    if request.near.is_some() {
        let shooting = Shooting::new();
        let problem = Asked::of(request, &shooting).problem(value, value)?;
        let point = compute::orbit(&problem, &guess(request, value)?, value)?;
        return complete::complete(&problem, &point);
    }
    balanced(request, value)
}

/// As the balance finds it.
fn balanced(request: &Request, value: f64) -> Result<Point, Error> {
    let request = Request {
        from: None,
        to: None,
        stability: false,
        tolerance: GUESSED,
        ..request.clone()
    };
    HarmonicBalance::new().orbit(&request, value)
}

/// The flow errs by this part of the stated error of an orbit.
const FINER: f64 = 0.1;
/// No smaller tolerance is asked for on that account.
const FINEST: f64 = 1e-13;
/// Accuracy of a first orbit that is corrected afterwards.
const GUESSED: f64 = 1e-6;

fn with_request(
    followed: Followed,
    request: &Request,
    shooting: Shooting,
    otherwise: Option<Otherwise>,
) -> Branch {
    let Followed { branch, rest } = followed;
    Branch {
        further: further(request, shooting, Left::one_way(rest), otherwise),
        ..branch
    }
}

/// What it takes to go on with a branch.
pub(super) fn further(
    request: &Request,
    shooting: Shooting,
    rest: Left<Rest>,
    otherwise: Option<Otherwise>,
) -> Further {
    let following = Following::Shooting {
        request: request.afterwards(),
        shooting,
        rest,
        otherwise,
    };
    Further::of(Arc::clone(&request.system), Arc::new(following))
}
