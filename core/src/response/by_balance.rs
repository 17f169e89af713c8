//! Requests by the harmonic balance.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use super::both_ways::{BothWays, Part, Way};
use super::by_shooting;
use super::following::{Following, Left, begin};
use super::sealed::Follow;
use crate::balance::Parity;
use crate::balance::start::{Moving, start, without_symmetry};
use crate::balance_branch::branch_switch::switch_branch;
use crate::balance_branch::check::Asked;
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::motion;
use crate::balance_branch::options::HarmonicBalance;
use crate::balance_branch::run::{Followed, Rest, Run};
use crate::branches::branch::{Branch, Further};
use crate::branches::error::Attempts;
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::{Guess, Request};
use crate::continuation::follow::{FollowOptions, Start};
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::{EventKind, Side};
use crate::model::request::RequestError;
use crate::orbit::observe::Accuracy;
use crate::shooting::Shooting;

impl Follow for HarmonicBalance {
    fn for_diagram(self) -> Self {
        self.bifurcations(true)
    }

    fn accurate_in(self, accuracy: Accuracy) -> Self {
        Self { accuracy, ..self }
    }

    fn is_balance(&self, _request: &Request) -> bool {
        true
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        let aside = Asked::of(request, self).aside(value)?;
        let request = Request {
            from: Some(value),
            to: Some(aside),
            ..request.clone()
        };
        let branch = self.run(&request, &mut |_| ControlFlow::Break(()))?;
        let none = || Attempts::default().without_period(request.period(), value);
        let first = branch.points.into_iter().next();
        first.ok_or_else(|| none().into())
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        let started = Instant::now();
        let request = &with_series(request, self, request.from)?;
        let asked = Asked::of(request, self);
        let (context, options) = asked.check()?;
        let mut statistics = Statistics::default();
        let first = first(asked, &context, options, &mut statistics)?;
        begin(asked.request, || {
            further(asked, context.clone(), Left::Nothing)
        })?;
        let run = Run::new(&context, options, &first);
        let followed = run.follow(Start::Near(first), visit)?;
        let mut branch = as_branch(asked, context.clone(), followed);
        branch.statistics += statistics;
        branch.elapsed = started.elapsed();
        Ok(branch)
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let started = Instant::now();
        let asked = Asked::of(request, self);
        asked.has(event)?;
        let event = &in_series(request, event)?;
        let request = &Request {
            period: Some(event.period_of_branch()),
            near: None,
            ..request.clone()
        };
        let asked = Asked::of(request, self);
        let (mut context, options) = asked.check()?;
        let stride = with_resolution_of(&mut context, event, request.period());
        let point = switch_branch(&context, event, stride, side.sign())?;
        begin(asked.request, || {
            further(asked, context.clone(), Left::Nothing)
        })?;
        let run = Run::new(&context, options, &point.u);
        let followed = run.follow(Start::Along(Box::new(point)), visit)?;
        let mut branch = as_branch(asked, context.clone(), followed);
        branch.elapsed = started.elapsed();
        Ok(branch)
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        let both = BothWays::through(request, value)?;
        let request = &with_series(request, self, Some(value))?;
        both_ways(Asked::of(request, self), None, &both, visit)
    }
}

/// The branch through the orbit at a value, or what is left of it.
///
/// # Errors
/// If there is no such orbit, or what it goes on from does not belong to it.
pub(super) fn both_ways(
    asked: Asked<'_>,
    known: Option<&Branch>,
    both: &BothWays<Rest>,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let started = Instant::now();
    let range = asked.request.range()?;
    let (context, mut options) = asked.check()?;
    options.from = both.value;
    let mut statistics = Statistics::default();
    let mut found = None;
    let follow = |way: Way, known: Option<(&Branch, &Rest)>| {
        // Each part ends where the range does.
        let [from, to] = way.of(range);
        let ends = FollowOptions {
            from,
            to,
            ..options
        };
        if let Some((branch, rest)) = known {
            let followed = go_on(&context, ends, branch, rest, &mut *visit)?;
            return Ok(gathered(asked, followed));
        }
        let begun = match found.take() {
            Some(begun) => begun,
            None => first(asked, &context, options, &mut statistics)?,
        };
        let point = context.along(&begun, (to - from).signum(), both.value)?;
        let run = Run::new(&context, ends, &begun);
        found = Some(begun);
        let followed = run.follow(Start::Along(Box::new(point)), &mut *visit)?;
        Ok(gathered(asked, followed))
    };
    let (mut branch, left) = both.follow(known, &asked.request.cancel, follow)?;
    branch.statistics += statistics;
    branch.elapsed = started.elapsed();
    branch.further = further(asked, context, Left::BothWays(Box::new(left)));
    Ok(branch)
}

/// Goes on with a branch that was interrupted; its context has the resolution that it was followed with.
///
/// # Errors
/// If what it goes on from does not belong to it.
pub(super) fn resume(
    asked: Asked<'_>,
    context: BranchContext,
    branch: &Branch,
    rest: &Rest,
    visit: See<'_>,
) -> Result<Branch, Error> {
    let started = Instant::now();
    let (_, options) = asked.check()?;
    let context = BranchContext {
        cancel: asked.request.cancel.clone(),
        keep: asked.request.keep.clone(),
        ..context
    };
    begin(asked.request, || {
        further(asked, context.clone(), Left::Nothing)
    })?;
    let followed = go_on(&context, options, branch, rest, visit)?;
    let mut resumed = as_branch(asked, context.clone(), followed);
    resumed.elapsed = started.elapsed();
    Ok(resumed)
}

/// Follows what is left of a branch.
///
/// # Errors
/// If what it goes on from does not belong to it.
fn go_on(
    context: &BranchContext,
    options: FollowOptions,
    branch: &Branch,
    rest: &Rest,
    visit: See<'_>,
) -> Result<Followed, Error> {
    let first = branch.points.first().ok_or(RequestError::Rest)?;
    let first = context.unknowns_of(&first.orbit, first.value);
    let run = Run::new(context, options, &first).resumed(rest, branch.kept());
    run.ok_or(RequestError::Rest)?.resume(rest, visit)
}

/// Unknowns of the first orbit.
fn first(
    asked: Asked<'_>,
    context: &BranchContext,
    options: FollowOptions,
    statistics: &mut Statistics,
) -> Result<Vec<f64>, Error> {
    if let Some(orbit) = asked.near() {
        return Ok(context.unknowns_of(orbit, options.from));
    }
    let motion = |moving: Moving<'_>| motion::moved(context, moving);
    let request = context.start_request(options, &motion);
    let found = start(request, statistics)?;
    let broken = context.asymmetric;
    let broken = broken.then(|| without_symmetry(request, &found, statistics));
    Ok(broken.flatten().unwrap_or(found))
}

/// Takes symmetry and harmonics from the orbit at an event, of which a branch of this period begins; the stride of the event's own orbit.
fn with_resolution_of(context: &mut BranchContext, event: &Event, period: usize) -> usize {
    let doubles = event.kind == EventKind::PeriodDoubling;
    // Of the system, where orbits of period one may have it.
    let odd = context.asymmetric || context.resolution.parity == Parity::Odd;
    context.resolution.parity = Parity::All;
    context.asymmetric = odd && !doubles;
    let orbit = &event.point.orbit;
    let recurrence = orbit.recurrence();
    let stride = recurrence.stride();
    context.resolution.stride = if doubles {
        recurrence.doubled().stride()
    } else {
        stride
    };
    if let Some(chooser) = &context.chooser {
        let times = period / orbit.period;
        context.resolution.harmonics = chooser.admitted(times * orbit.harmonics());
    }
    stride
}

/// The branch that a run gives.
fn as_branch(asked: Asked<'_>, context: BranchContext, followed: Followed) -> Branch {
    let Part { branch, rest } = gathered(asked, followed);
    Branch {
        further: further(asked, context, Left::one_way(rest)),
        ..branch
    }
}

/// What a run has gathered.
fn gathered(asked: Asked<'_>, followed: Followed) -> Part<Rest> {
    let Followed {
        stopped,
        mut record,
        statistics,
        mut rest,
    } = followed;
    record.sort(rest.as_mut().map(|rest| rest.kept()));
    let request = asked.request;
    let branch = Branch {
        statistics,
        ..record.into_branch(request.system.as_ref(), request.varied(), stopped)
    };
    Part { branch, rest }
}

/// What it takes to go on with a branch.
fn further(asked: Asked<'_>, context: BranchContext, rest: Left<Rest>) -> Further {
    // What is asked of the branch later is not part of this run.
    let request = asked.request.afterwards();
    let context = BranchContext {
        cancel: request.cancel.clone(),
        keep: None,
        ..context
    };
    let system = Arc::clone(&request.system);
    let following = Following::Balance {
        context: Box::new(context),
        request,
        balance: *asked.balance,
        rest,
    };
    Further::of(system, Arc::new(following))
}

/// The same request with the series of the orbit that it begins near.
///
/// # Errors
/// If the request is not usable, or an orbit is given by states and there is none like it.
fn with_series(
    request: &Request,
    balance: &HarmonicBalance,
    value: Option<f64>,
) -> Result<Request, Error> {
    let (Some(guess), Some(value)) = (&request.near, value) else {
        return Ok(request.clone());
    };
    if matches!(guess, Guess::Orbit(orbit) if orbit.has_series()) {
        return Ok(request.clone());
    }
    // What is wrong is said before any work.
    let alone = &Request {
        near: None,
        period: Some(request.period()),
        ..request.clone()
    };
    Asked::of(alone, balance).check()?;
    let quick = Request {
        stability: false,
        ..request.clone()
    };
    let point = Shooting::new().orbit(&quick, value)?;
    let orbit = by_shooting::completed(&quick, Shooting::new(), &point)?.orbit;
    Ok(Request {
        near: Some(Guess::Orbit(orbit)),
        ..request.clone()
    })
}

/// An event with the series of its orbit.
///
/// # Errors
/// If it is not one of this request, its motion cannot be computed, or branches cross there, whose direction is known in states only.
fn in_series(request: &Request, event: &Event) -> Result<Event, Error> {
    if event.point.orbit.states.is_empty() {
        return Ok(event.clone());
    }
    let orbit = &event.point.orbit;
    let breaks = event.kind == EventKind::SymmetryBreaking && !orbit.image.is_minus();
    if breaks || event.kind == EventKind::BranchPoint {
        return Err(RequestError::Option {
            name: "event",
            value: event.point.value,
            must: "is a crossing that shooting found: switch there by shooting",
        }
        .into());
    }
    Ok(Event {
        point: by_shooting::completed(request, Shooting::new(), &event.point)?,
        tangent: Vec::new(),
        ..event.clone()
    })
}
