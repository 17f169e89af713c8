//! Requests by the contact equation. What it does not do itself goes on by shooting.

use super::by_shooting;
use super::sealed::Follow;
use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Request;
use crate::contact_equation::problem::ContactProblem;
use crate::contact_equation::{ContactEquation, compute};
use crate::error::Error;
use crate::event::Side;
use crate::model::error::ModelError;
use crate::shooting::compute::Followed;
use crate::shooting::{Asked, Shooting};

impl Follow for ContactEquation {
    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        let asked = Asked::of(request, &Shooting::new()).problem(value, value)?;
        let problem = ContactProblem::new(asked, request.tolerance)?;
        let guess = by_shooting::with_series(request, value)?;
        compute::orbit(&problem, &guess, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        if request.keep.is_some() {
            let why = "a branch that is kept in a file while it is followed";
            return Err(ModelError::NoContactEquation { why }.into());
        }
        let shooting = Shooting::new();
        let (range, asked) = Asked::of(request, &shooting).ranged()?;
        let problem = ContactProblem::new(asked, request.tolerance)?;
        let guess = by_shooting::with_series(request, range[0])?;
        let followed = Followed {
            branch: compute::branch(&problem, &guess, range, visit)?,
            rest: None,
        };
        Ok(by_shooting::with_request(followed, request, shooting))
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
