//! The contact equation, and the harmonic balance where it leads no further.
//!
//! What the contact equation has found stands until the balance is whole or comes farther: in memory, and in a file where the branch is
//! kept. So whatever interrupts it, it goes on to what an uninterrupted run gives: by the contact equation as long as that is not lost,
//! then by a balance from the first orbit on, and by the same balance where that has come farther already.

#[cfg(test)]
mod tests;

use std::sync::{Arc, Mutex, PoisonError};

use super::by_contact_equation;
use super::in_turn::{first_found, may_break};
use super::sealed::Follow;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::{Branch, Further, Model};
use crate::branches::checkpoint::{Keep, Rest};
use crate::branches::point::{Event, Point};
use crate::branches::progress::{Progress, See, Stage};
use crate::branches::record::Kept;
use crate::branches::request::Request;
use crate::contact_equation::ContactEquation;
use crate::continuation::stop::Stop;
use crate::error::Error;
use crate::event::Side;
use crate::orbit::observe::Accuracy;

/// What is tried where the contact equation leads no further.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Otherwise {
    pub(super) balance: HarmonicBalance,
    /// How the contact equation ended, where the balance was tried and interrupted before it came as far.
    pub(super) lost: Option<Stop>,
}

/// The contact equation, and a balance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Either {
    equation: ContactEquation,
    balance: HarmonicBalance,
}

impl Follow for Either {
    fn accurate_in(self, accuracy: Accuracy) -> Self {
        Self {
            equation: self.equation.accurate_in(accuracy),
            balance: self.balance.accurate_in(accuracy),
        }
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        // The contact equation begins with an orbit of the balance.
        self.balance.orbit(request, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        if may_break(request, &self.balance) {
            return self.balance.run(request, visit);
        }
        let otherwise = Some(self.otherwise(None));
        let found = by_contact_equation::run(request, self.equation, otherwise, &mut *visit);
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
    pub(super) fn of(equation: ContactEquation, balance: HarmonicBalance) -> Self {
        Self { equation, balance }
    }

    fn first_found<T>(
        &self,
        request: &Request,
        unseen: bool,
        find: impl FnMut(&dyn Follow) -> Result<T, Error>,
    ) -> Result<T, Error> {
        first_found(&self.equation, &self.balance, request, unseen, find)
    }

    /// What the contact equation has found, or where it is lost what the balance finds.
    ///
    /// # Errors
    /// Those of the balance, where the contact equation has found nothing.
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
        let mut once_more = |progress: Progress<'_>| visit(again(progress));
        let other = match self.balance.run(&tried, &mut once_more) {
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
        let otherwise = Some(self.otherwise(Some(found.stopped)));
        Branch {
            stopped,
            further: by_contact_equation::further(request, self.equation, None, otherwise),
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

/// The same of what is followed once more.
pub(super) fn again(progress: Progress<'_>) -> Progress<'_> {
    let stage = match progress.stage {
        Stage::Branch => Stage::Again,
        other => other,
    };
    Progress { stage, ..progress }
}

/// Whether a branch ended because nothing further was found.
pub(super) fn is_lost(branch: &Branch) -> bool {
    matches!(
        branch.stopped,
        Stop::StepTooShort { .. } | Stop::Motion { .. }
    )
}

/// Whether a branch ended by itself, and not because somebody or something ended it.
pub(super) fn is_whole(branch: &Branch) -> bool {
    !is_lost(branch) && !branch.stopped.can_be_resumed()
}

/// How far a branch has come from its first orbit.
pub(super) fn reach(points: &[Point]) -> f64 {
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

/// Keeps a branch from where it comes farther than the one that is kept until then.
#[derive(Debug)]
struct Farther {
    by: Arc<dyn Keep>,
    than: f64,
    /// What the branch is, until it takes the other one's place.
    head: Mutex<Option<Head>>,
}

/// What a branch that is kept begins with.
#[derive(Debug)]
struct Head {
    model: Model,
    varied: String,
    further: Further,
}

impl Farther {
    fn new(by: &Arc<dyn Keep>, than: f64) -> Arc<Self> {
        Arc::new(Self {
            by: Arc::clone(by),
            than,
            head: Mutex::default(),
        })
    }

    /// Takes the place of what is kept, unless that is done.
    ///
    /// # Errors
    /// If the branch cannot be kept.
    fn take(&self) -> Result<(), Error> {
        let mut head = self.head.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(Head {
            model,
            varied,
            further,
        }) = head.as_ref()
        {
            self.by.begin(model, varied, further)?;
        }
        *head = None;
        Ok(())
    }

    fn waits(&self) -> bool {
        let head = self.head.lock().unwrap_or_else(PoisonError::into_inner);
        head.is_some()
    }

    /// Every orbit is the last one once.
    fn comes_farther(&self, points: &[Point]) -> bool {
        let ends = points.first().zip(points.last());
        ends.is_some_and(|(first, last)| (last.value - first.value).abs() > self.than)
    }
}

impl Keep for Farther {
    fn begin(&self, model: &Model, varied: &str, further: &Further) -> Result<(), Error> {
        let head = Head {
            model: model.clone(),
            varied: varied.to_owned(),
            further: further.clone(),
        };
        *self.head.lock().unwrap_or_else(PoisonError::into_inner) = Some(head);
        Ok(())
    }

    fn keep(&self, kept: Kept<'_>, rest: &dyn Rest) -> bool {
        if self.waits() && !self.comes_farther(kept.points) {
            return true;
        }
        self.take().is_ok() && self.by.keep(kept, rest)
    }

    fn end(&self, branch: &Branch) -> bool {
        self.by.end(branch)
    }

    fn failure(&self) -> Option<Error> {
        self.by.failure()
    }
}
