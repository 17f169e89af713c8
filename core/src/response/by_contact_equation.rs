//! Requests by the contact equation. What it does not do itself goes on by shooting.

use std::sync::Arc;

use super::by_shooting;
use super::following::Following;
use super::sealed::Follow;
use crate::branches::branch::{Branch, Further, Model};
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Request;
use crate::contact_equation::compute::Followed;
use crate::contact_equation::problem::ContactProblem;
use crate::contact_equation::{ContactEquation, Rest, compute};
use crate::error::Error;
use crate::event::Side;
use crate::shooting::{Asked, Shooting};

impl Follow for ContactEquation {
    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        let asked = Asked::of(request, &Shooting::new()).problem(value, value)?;
        let problem = ContactProblem::new(asked, request.tolerance)?;
        let guess = by_shooting::with_series(request, value)?;
        compute::orbit(&problem, &guess, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        let (range, problem) = problem(request)?;
        let guess = by_shooting::with_series(request, range[0])?;
        begin(request, *self)?;
        let followed = compute::branch(&problem, &guess, range, visit)?;
        Ok(with_request(followed, request, *self))
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        Shooting::new().switch(request, event, side, visit)
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        Shooting::new().through(request, value, visit)
    }
}

/// The range, and what is computed with in it.
///
/// # Errors
/// If the request is not usable, or there is no contact equation of the system.
pub(super) fn problem(request: &Request) -> Result<([f64; 2], ContactProblem), Error> {
    let (range, asked) = Asked::of(request, &Shooting::new()).ranged()?;
    Ok((range, ContactProblem::new(asked, request.tolerance)?))
}

/// Goes on with a branch that was interrupted.
///
/// # Errors
/// If what it goes on from does not belong to it.
pub(super) fn resume(
    request: &Request,
    equation: ContactEquation,
    branch: &Branch,
    rest: &Rest,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let (range, problem) = problem(request)?;
    begin(request, equation)?;
    let followed = compute::resume(&problem, branch, rest, range, visit)?;
    Ok(with_request(followed, request, equation))
}

/// Tells what keeps the branch what it is.
fn begin(request: &Request, equation: ContactEquation) -> Result<(), Error> {
    let Some(keep) = &request.keep else {
        return Ok(());
    };
    let model = Model::of(request.system.as_ref());
    keep.begin(&model, &request.varied(), &further(request, equation, None))
}

fn with_request(followed: Followed, request: &Request, equation: ContactEquation) -> Branch {
    Branch {
        further: further(request, equation, followed.rest),
        ..followed.branch
    }
}

/// What it takes to go on with a branch.
fn further(request: &Request, equation: ContactEquation, rest: Option<Box<Rest>>) -> Further {
    let following = Following::ContactEquation {
        request: request.afterwards(),
        equation,
        rest,
    };
    Further::of(Arc::clone(&request.system), Arc::new(following))
}
