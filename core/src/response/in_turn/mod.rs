//! A method, and the harmonic balance where it leads no further.
//!
//! What the first method has found stands until the balance is whole or comes farther: in memory, and in a file where the branch is
//! kept. So whatever interrupts it, it goes on to what an uninterrupted run gives: by the first method as long as that is not lost,
//! then by a balance from the first orbit on, and by the same balance where that has come farther already. A balance that takes many times as many
//! orbits to come as far is given up: where motions rest against a force that jumps it creeps, and resolves nothing.

mod farther;
mod patience;
#[cfg(test)]
mod tests;

use std::ops::ControlFlow;
use std::sync::Arc;

use super::sealed::Follow;
use super::{by_contact_equation, by_shooting};
use crate::balance::Parity;
use crate::balance_branch::check::Asked;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::{Branch, Further};
use crate::branches::checkpoint::Keep;
use crate::branches::point::{Event, Point};
use crate::branches::progress::{Progress, See, Stage};
use crate::branches::request::Request;
use crate::contact_equation::ContactEquation;
use crate::continuation::stop::Stop;
use crate::error::Error;
use crate::event::Side;
use crate::orbit::observe::Accuracy;
use crate::response::following::Left;
use crate::shooting::Shooting;
use farther::Farther;
use patience::Patience;

/// What is tried where the first method leads no further.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Otherwise {
    pub(super) balance: HarmonicBalance,
    /// How the first method ended, where the balance was tried and interrupted before it came as far.
    pub(super) lost: Option<Stop>,
}

/// The method that is asked first.
#[derive(Debug, Clone, Copy)]
pub(super) enum First {
    ContactEquation(ContactEquation),
    Shooting(Shooting),
}

impl First {
    fn method(&self) -> &dyn Follow {
        match self {
            Self::ContactEquation(equation) => equation,
            Self::Shooting(shooting) => shooting,
        }
    }

    /// The branch from one end of the range to the other, which knows what is tried where it is lost.
    fn run(self, request: &Request, otherwise: Otherwise, visit: See<'_>) -> Result<Branch, Error> {
        let otherwise = Some(otherwise);
        match self {
            Self::ContactEquation(equation) => {
                by_contact_equation::run(request, equation, otherwise, visit)
            }
            Self::Shooting(shooting) => by_shooting::run(request, shooting, otherwise, visit),
        }
    }

    /// What it takes to go on with a branch that is at its end.
    fn further(self, request: &Request, otherwise: Otherwise) -> Further {
        let otherwise = Some(otherwise);
        match self {
            Self::ContactEquation(equation) => {
                by_contact_equation::further(request, equation, Left::Nothing, otherwise)
            }
            Self::Shooting(shooting) => {
                by_shooting::further(request, shooting, Left::Nothing, otherwise)
            }
        }
    }
}

/// A method, and a balance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Either {
    first: First,
    balance: HarmonicBalance,
}

impl Follow for Either {
    fn accurate_in(self, accuracy: Accuracy) -> Self {
        let first = match self.first {
            First::ContactEquation(equation) => {
                First::ContactEquation(equation.accurate_in(accuracy))
            }
            First::Shooting(shooting) => First::Shooting(shooting.accurate_in(accuracy)),
        };
        Self {
            first,
            balance: self.balance.accurate_in(accuracy),
        }
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        // Both methods begin with an orbit of the balance.
        self.balance.orbit(request, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        if may_break(request, &self.balance) {
            return self.first_found(request, true, |method| method.run(request, &mut *visit));
        }
        let found = self.first.run(request, self.otherwise(None), &mut *visit);
        self.or_balance(request, found, visit)
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        // Of an odd symmetry nothing is left there that the balance would look for.
        let unseen = !request.stability && event.point.orbit.recurrence().stride() > 1;
        self.first_found(request, unseen, |method| {
            method.switch(request, event, side, &mut *visit)
        })
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        self.first_found(request, may_break(request, &self.balance), |method| {
            method.through(request, value, &mut *visit)
        })
    }
}

impl Either {
    pub(super) fn of(first: First, balance: HarmonicBalance) -> Self {
        Self { first, balance }
    }

    /// The same, where bifurcations are wanted of the balance or not; as it was asked for where nothing is said.
    pub(super) fn bifurcations(self, wanted: Option<bool>) -> Self {
        let wanted = wanted.unwrap_or(self.balance.bifurcations);
        Self {
            balance: self.balance.bifurcations(wanted),
            ..self
        }
    }

    /// What the first method finds, or else the balance; the other way round where something would stay unseen.
    ///
    /// # Errors
    /// Those of the balance, or of a request that was cancelled.
    fn first_found<T>(
        &self,
        request: &Request,
        unseen: bool,
        mut find: impl FnMut(&dyn Follow) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let mut methods: [&dyn Follow; 2] = [self.first.method(), &self.balance];
        if unseen {
            methods.reverse();
        }
        let found = find(methods[0]);
        if found.is_ok() || request.cancel.is_cancelled() {
            return found;
        }
        let other = find(methods[1]);
        // The balance says why there is none.
        if unseen { other.or(found) } else { other }
    }

    /// What the first method has found, or where it is lost what the balance finds.
    ///
    /// # Errors
    /// Those of the balance, where the first method has found nothing.
    pub(super) fn or_balance(
        &self,
        request: &Request,
        found: Result<Branch, Error>,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        match found {
            Ok(found) if is_lost(&found) => self.beyond(request, found, visit),
            Err(_) if !request.cancel.is_cancelled() => self.balance.run(request, visit),
            found => found,
        }
    }

    /// What the balance finds in place of a branch that is lost, if it is whole or comes farther. Where the balance is interrupted before,
    /// that branch is, and the balance is left of it.
    ///
    /// # Errors
    /// If a branch that was kept in a file cannot be kept any more.
    pub(super) fn beyond(
        &self,
        request: &Request,
        found: Branch,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let than = reach(&found.points);
        let farther = request.keep.as_ref().map(|keep| Farther::new(keep, than));
        let tried = Request {
            keep: farther.clone().map(|farther| farther as Arc<dyn Keep>),
            ..request.clone()
        };
        let mut patience = Patience::with(found.points.len(), than);
        let mut once_more = |progress: Progress<'_>| {
            if patience.ends(&progress) {
                return ControlFlow::Break(());
            }
            visit(again(progress))
        };
        let other = match self.balance.run(&tried, &mut once_more) {
            Ok(other) if patience.has_ended() => return Ok(found.after(&other)),
            Ok(other) => other,
            Err(_) if request.cancel.is_cancelled() => {
                return Ok(self.left(request, found, Stop::Interrupted));
            }
            Err(_) => return Ok(found),
        };
        if is_whole(&other) || reach(&other.points) > than {
            if let Some(farther) = farther {
                farther.take()?;
            }
            return Ok(other.after(&found));
        }
        let found = found.after(&other);
        if other.stopped.can_be_resumed() {
            return Ok(self.left(request, found, other.stopped));
        }
        Ok(found)
    }

    /// A lost branch of which the balance is left, which ended so.
    fn left(&self, request: &Request, found: Branch, stopped: Stop) -> Branch {
        let otherwise = self.otherwise(Some(found.stopped));
        Branch {
            stopped,
            further: self.first.further(request, otherwise),
            ..found
        }
    }

    fn otherwise(&self, lost: Option<Stop>) -> Otherwise {
        Otherwise {
            balance: self.balance,
            lost,
        }
    }
}

/// Whether orbits may lose a symmetry on a branch unseen: the contact equation and shooting see that by multipliers alone, and the
/// balance by its equations.
fn may_break(request: &Request, balance: &HarmonicBalance) -> bool {
    let asked = Asked::of(request, balance);
    !request.stability
        && asked.check().is_ok_and(|(context, _)| {
            let resolution = context.resolution;
            resolution.parity == Parity::Odd || resolution.stride > 1
        })
}

/// The same of what is followed once more.
fn again(progress: Progress<'_>) -> Progress<'_> {
    let stage = match progress.stage {
        Stage::Branch => Stage::Again,
        other => other,
    };
    Progress { stage, ..progress }
}

/// Whether a branch ended because nothing further was found.
fn is_lost(branch: &Branch) -> bool {
    matches!(
        branch.stopped,
        Stop::StepTooShort { .. } | Stop::Motion { .. }
    )
}

/// Whether a branch ended by itself, and not because somebody or something ended it.
fn is_whole(branch: &Branch) -> bool {
    !is_lost(branch) && !branch.stopped.can_be_resumed()
}

/// How far a branch has come from its first orbit.
fn reach(points: &[Point]) -> f64 {
    let values = || points.iter().map(|point| point.value);
    let first = values().next().unwrap_or(f64::NAN);
    values().fold(0.0, |most, value| most.max((value - first).abs()))
}

impl Branch {
    /// The same with what another one cost that was followed before it.
    pub(super) fn after(mut self, before: &Self) -> Self {
        self.statistics += before.statistics;
        self.work += before.work;
        self.elapsed += before.elapsed;
        self
    }
}
