//! Requests by the contact equation.
//!
//! A branch that begins at an event of another one has its first orbit from shooting, which steps off the event in states, and is followed by the contact equation
//! from there. Where there is no contact equation of the first orbit of a branch, shooting follows it, and is its
//! [method](Branch::method).

use std::sync::Arc;

use super::both_ways::{BothWays, Part, Way};
use super::by_shooting;
use super::following::{Following, Left, begin};
use super::in_turn::Otherwise;
use super::sealed::Follow;
use crate::branches::branch::{Branch, Further};
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Request;
use crate::branches::solve::Toward;
use crate::contact_equation::completed::Solved;
use crate::contact_equation::compute::{Followed, Guesses, Untouched};
use crate::contact_equation::problem::ContactProblem;
use crate::contact_equation::{ContactEquation, Rest, compute};
use crate::error::Error;
use crate::event::Side;
use crate::orbit::observe::Accuracy;
use crate::shooting::{self, Asked, Shooting, with_states};

impl Follow for ContactEquation {
    fn accurate_in(self, accuracy: Accuracy) -> Self {
        Self { accuracy }
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        let asked = Asked::of(request, &self.shooting())
            .held()
            .problem(value, value)?;
        let problem = ContactProblem::new(asked, request.tolerance);
        let (untouched, first) = start(&problem, request, value)?;
        let guesses = Guesses {
            untouched,
            first: first.as_ref(),
            like: None,
            better: &mut || self.shooting().orbit(request, value),
        };
        compute::orbit(&problem, guesses, value)
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
        let found = switch(request, *self, event, side, &mut *visit);
        or_shooting(request, found, || {
            self.shooting().switch(request, event, side, visit)
        })
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        let both = BothWays::through(request, value)?;
        let found = both_ways(request, *self, None, &both, &mut *visit);
        or_shooting(request, found, || {
            self.shooting().through(request, value, visit)
        })
    }
}

impl ContactEquation {
    /// The range, and what is computed with in it.
    ///
    /// # Errors
    /// If the request is not usable, or there is no contact equation of the system.
    pub(super) fn problem(self, request: &Request) -> Result<([f64; 2], ContactProblem), Error> {
        let (range, asked) = Asked::of(request, &self.shooting()).held().ranged()?;
        Ok((range, ContactProblem::new(asked, request.tolerance)))
    }

    /// Shooting with the accuracy of the same.
    pub(super) fn shooting(self) -> Shooting {
        Shooting {
            accuracy: self.accuracy,
            ..Shooting::new()
        }
    }
}

/// The branch from one end of the range to the other, and what is tried where it leads no further.
///
/// # Errors
/// If the request is not usable, there is no contact equation of the system, or no first orbit.
pub(super) fn run(
    request: &Request,
    equation: ContactEquation,
    otherwise: Option<Otherwise>,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = equation.problem(request)?;
    let (untouched, first) = start(&problem, request, range[0])?;
    begin(request, || {
        further(request, equation, Left::Nothing, otherwise)
    })?;
    let guesses = Guesses {
        untouched,
        first: first.as_ref(),
        like: None,
        better: &mut || equation.shooting().orbit(request, range[0]),
    };
    let followed = compute::branch(&problem, guesses, range, visit)?;
    Ok(with_request(followed, request, equation, otherwise))
}

/// What is read of an orbit that is known by its states, solved for again. `None` where it is not found by the contact equation.
///
/// # Errors
/// If the orbit is not one of the system.
pub(super) fn solved<T>(
    request: &Request,
    equation: ContactEquation,
    point: &Point,
    read: impl FnOnce(&Solved<'_>) -> T,
) -> Result<Option<T>, Error> {
    let (shooting, request) =
        by_shooting::of_period(equation.shooting(), request, point.orbit.period);
    let asked = Asked::of(&request, &shooting).held();
    asked.belongs(point)?;
    let Ok(asked) = asked.problem(point.value, point.value) else {
        return Ok(None);
    };
    let problem = ContactProblem::new(asked, request.tolerance);
    Ok(Solved::of(&problem, point).as_ref().map(read))
}

/// What the contact equation has found, or else what shooting finds.
///
/// # Errors
/// Those of the contact equation, where shooting finds nothing either.
fn or_shooting(
    request: &Request,
    found: Result<Branch, Error>,
    shoot: impl FnOnce() -> Result<Branch, Error>,
) -> Result<Branch, Error> {
    found.or_else(|reason| {
        if request.cancel.is_cancelled() {
            return Err(reason);
        }
        shoot().map_err(|_| reason)
    })
}

/// The branch that begins at an event, on one side of it.
///
/// # Errors
/// If the request is not usable, there is no contact equation of the system, or no first orbit.
fn switch(
    request: &Request,
    equation: ContactEquation,
    event: &Event,
    side: Side,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let shooting = equation.shooting();
    Asked::of(request, &shooting).belongs(&event.point)?;
    let (_, request) = by_shooting::of_period(shooting, request, event.period_of_branch());
    let (range, problem) = equation.problem(&request)?;
    let event = with_states(&problem.asked, event);
    let length = (range[1] - range[0]).abs();
    let (first, toward) =
        shooting::compute::beginning(&problem.asked, &event, side.sign(), length)?;
    begin(&request, || {
        further(&request, equation, Left::Nothing, None)
    })?;
    let value = first.value;
    let guesses = Guesses {
        untouched: None,
        first: Some(&first),
        like: Some(first.orbit.recurrence()),
        better: &mut || Ok(first.clone()),
    };
    let followed = compute::branch_from(&problem, guesses, value, toward, range, visit)?;
    Ok(with_request(followed, &request, equation, None))
}

/// The branch through the orbit at a value, or what is left of it.
///
/// # Errors
/// If there is no such orbit, or what it goes on from does not belong to it.
pub(super) fn both_ways(
    request: &Request,
    equation: ContactEquation,
    known: Option<&Branch>,
    both: &BothWays<Rest>,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = equation.problem(request)?;
    let value = both.value;
    let mut found = None;
    let follow = |way: Way, known: Option<(&Branch, &Rest)>| {
        // Each part ends where the range does.
        let range = way.of(range);
        let Followed { branch, rest } = if let Some((branch, rest)) = known {
            compute::resume(&problem, branch, rest, range, &mut *visit)?
        } else {
            let (untouched, first) = match found.take() {
                Some(first) => (None, Some(first)),
                None => start(&problem, request, value)?,
            };
            let guesses = Guesses {
                untouched,
                first: first.as_ref(),
                like: None,
                better: &mut || equation.shooting().orbit(request, value),
            };
            let toward = Toward {
                side: (range[1] - range[0]).signum(),
                range: (range[1] - range[0]).abs(),
            };
            let followed =
                compute::branch_from(&problem, guesses, value, toward, range, &mut *visit)?;
            found = first;
            followed
        };
        Ok(Part { branch, rest })
    };
    let (branch, left) = both.follow(known, &request.cancel, follow)?;
    let left = Left::BothWays(Box::new(left));
    Ok(Branch {
        further: further(request, equation, left, None),
        ..branch
    })
}

/// What a branch begins with: the linear response where that meets no contact and nothing else is asked for, or an orbit by another method.
fn start<'p>(
    problem: &'p ContactProblem,
    request: &Request,
    value: f64,
) -> Result<(Option<Untouched<'p>>, Option<Point>), Error> {
    let untouched = if request.near.is_none() {
        compute::untouched(problem, value)
    } else {
        None
    };
    if untouched.is_some() {
        return Ok((untouched, None));
    }
    let first = by_shooting::with_series(request, value)?;
    Ok((None, Some(first)))
}

/// Goes on with a branch that was interrupted.
///
/// # Errors
/// If what it goes on from does not belong to it.
pub(super) fn resume(
    request: &Request,
    equation: ContactEquation,
    otherwise: Option<Otherwise>,
    branch: &Branch,
    rest: &Rest,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = equation.problem(request)?;
    begin(request, || {
        further(request, equation, Left::Nothing, otherwise)
    })?;
    let followed = compute::resume(&problem, branch, rest, range, visit)?;
    Ok(with_request(followed, request, equation, otherwise))
}

fn with_request(
    followed: Followed,
    request: &Request,
    equation: ContactEquation,
    otherwise: Option<Otherwise>,
) -> Branch {
    Branch {
        further: further(request, equation, Left::one_way(followed.rest), otherwise),
        ..followed.branch
    }
}

/// What it takes to go on with a branch.
pub(super) fn further(
    request: &Request,
    equation: ContactEquation,
    rest: Left<Rest>,
    otherwise: Option<Otherwise>,
) -> Further {
    let following = Following::ContactEquation {
        request: request.afterwards(),
        equation,
        rest,
        otherwise,
    };
    Further::of(Arc::clone(&request.system), Arc::new(following))
}
