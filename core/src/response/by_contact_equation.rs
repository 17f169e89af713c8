//! Requests by the contact equation. What it does not do itself goes on by shooting.

use std::sync::Arc;

use super::by_shooting;
use super::following::{Following, begin};
use super::in_turn::Otherwise;
use super::sealed::Follow;
use crate::branches::branch::{Branch, Further};
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Request;
use crate::contact_equation::compute::{Followed, Guesses, Untouched};
use crate::contact_equation::problem::ContactProblem;
use crate::contact_equation::{ContactEquation, Rest, compute};
use crate::error::Error;
use crate::event::Side;
use crate::orbit::observe::Accuracy;
use crate::shooting::{Asked, Shooting};

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
        self.shooting().switch(request, event, side, visit)
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        self.shooting().through(request, value, visit)
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
    begin(request, || further(request, equation, None, otherwise))?;
    let guesses = Guesses {
        untouched,
        first: first.as_ref(),
        better: &mut || equation.shooting().orbit(request, range[0]),
    };
    let followed = compute::branch(&problem, guesses, range, visit)?;
    Ok(with_request(followed, request, equation, otherwise))
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
    begin(request, || further(request, equation, None, otherwise))?;
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
        further: further(request, equation, followed.rest, otherwise),
        ..followed.branch
    }
}

/// What it takes to go on with a branch.
pub(super) fn further(
    request: &Request,
    equation: ContactEquation,
    rest: Option<Box<Rest>>,
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
