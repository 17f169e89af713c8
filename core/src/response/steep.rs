//! Shooting, and the harmonic balance where that finds no orbit to begin with or leads no further: for laws whose stiffness is unbounded on both sides of a level.
//!
//! Where the motion comes to a height `h` beyond such a level, `gap^a` with `a` below one on both sides, it stays there for a time that goes
//! as `h^(1/2)`, and its stiffness goes as `h^(a - 1)`. So the impulse of a perturbation there, and with it the monodromy, goes as
//!
//! ```text
//! h^(a - 1/2)                                                                                                 (1)
//! ```
//!
//! (`a = 0.6`: a change of the height by a thousandth is seen as one by a half). Without a gap that opens, the same stretch is lost on the other
//! side at once. The contact equation, whose unknowns are the ends of both, divides its steps there, sometimes until none is left. Shooting has no
//! unknown for a stretch, and goes over it.
//!
//! Source of the time beyond the level: Nordmark (1991), J. Sound Vib. 145, 279; what a power of the gap makes of it is (1).

use super::in_turn::{first_found, may_break};
use super::otherwise::{again, is_lost, is_whole, reach};
use super::sealed::Follow;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Request;
use crate::error::Error;
use crate::event::Side;
use crate::orbit::observe::Accuracy;
use crate::shooting::Shooting;

/// Shooting, and a balance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steep {
    pub(super) shooting: Shooting,
    pub(super) balance: HarmonicBalance,
}

impl Steep {
    fn found<T>(
        &self,
        request: &Request,
        unseen: bool,
        find: impl FnMut(&dyn Follow) -> Result<T, Error>,
    ) -> Result<T, Error> {
        first_found(&self.shooting, &self.balance, request, unseen, find)
    }
}

impl Follow for Steep {
    fn accurate_in(self, accuracy: Accuracy) -> Self {
        Self {
            shooting: self.shooting.accurate_in(accuracy),
            balance: self.balance.accurate_in(accuracy),
        }
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        // Shooting begins with an orbit of the balance.
        self.balance.orbit(request, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        let unseen = may_break(request, &self.balance);
        let found = self.found(request, unseen, |method| method.run(request, &mut *visit))?;
        // A file holds what was followed in it.
        if !is_lost(&found) || request.keep.is_some() || request.cancel.is_cancelled() {
            return Ok(found);
        }
        let other = self
            .balance
            .run(request, &mut |progress| visit(again(progress)));
        Ok(match other {
            Ok(other) if is_whole(&other) || reach(&other.points) > reach(&found.points) => {
                other.after(&found)
            }
            Ok(other) => found.after(&other),
            Err(_) => found,
        })
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let unseen = !request.stability && event.point.orbit.recurrence().stride() > 1;
        self.found(request, unseen, |method| {
            method.switch(request, event, side, &mut *visit)
        })
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        let unseen = may_break(request, &self.balance);
        self.found(request, unseen, |method| {
            method.through(request, value, &mut *visit)
        })
    }
}
