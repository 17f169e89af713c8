//! Going on with a branch: where it was interrupted, beyond its range, or anew with other options.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::both_ways::{begins_at, is_left};
use super::following::{Following, Left, by_any, by_one};
use super::in_turn::Either;
use super::sealed::Follow;
use super::{by_balance, by_contact_equation, by_shooting};
use crate::balance_branch::check::Asked;
use crate::branches::branch::Branch;
use crate::branches::checkpoint::Keep;
use crate::branches::progress::{Progress, See};
use crate::branches::request::{Guess, Request};
use crate::cancel::Cancel;
use crate::continuation::follow::Stop;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::validate;

/// How to go on with a branch, set up step by step, then [run](Resume::run): see [`Branch::resume`].
#[derive(Debug, Clone)]
pub struct Resume<'b> {
    branch: &'b Branch,
    to: Option<f64>,
    max_points: Option<usize>,
    tolerance: Option<f64>,
    largest_step: Option<f64>,
    bifurcations: Option<bool>,
    cancel: Cancel,
    keep: Option<Arc<dyn Keep>>,
}

impl Branch {
    /// Goes on with this branch, by what it was asked for. Nothing but its number of points is changed by default: where it was
    /// interrupted, or met its limit of points, it goes on with the step that it was in, and what comes of it is what an uninterrupted
    /// run gives, to the last bit. A branch from a file takes its model first, by [`attach`](Self::attach).
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.5*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let request = FrequencyResponse::of(&Duffing { drive: 0.2 }).from(0.5).to(1.5);
    /// let whole = request.clone().run()?;
    /// let most = whole.points.len() / 2 + 1;
    /// let part = request.max_points(most).run()?;
    /// assert_eq!(part.points.len(), most);
    /// let resumed = part.resume().run()?;
    /// assert_eq!(resumed.points, whole.points);
    /// // Beyond the end of its range, and once more with another tolerance.
    /// let longer = whole.resume().to(1.8).run()?;
    /// assert_eq!(longer.at(1.7)?.len(), 1);
    /// let finer = whole.resume().tolerance(1e-9).run()?;
    /// assert!(finer.points.iter().all(|point| point.error.unwrap() < 1e-9));
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    pub fn resume(&self) -> Resume<'_> {
        Resume {
            branch: self,
            to: None,
            max_points: None,
            tolerance: None,
            largest_step: None,
            bifurcations: None,
            cancel: Cancel::new(),
            keep: None,
        }
    }

    /// With what follows behind its last orbit, which is the first of that.
    fn with(&self, mut on: Self) -> Self {
        let shift = self.points.len().saturating_sub(1);
        let mut branch = self.clone();
        branch.points.extend(on.points.drain(..).skip(1));
        branch.events.extend(on.events.drain(..).map(|mut event| {
            event.after += shift;
            event
        }));
        branch.turns.extend(on.turns.drain(..).map(|mut turn| {
            turn.after += shift;
            turn
        }));
        branch.statistics += on.statistics;
        branch.work += on.work;
        branch.elapsed += on.elapsed;
        Self {
            stopped: on.stopped,
            // What the new part goes on from counts the points of that part alone.
            further: self.further.clone(),
            ..branch
        }
    }
}

impl Resume<'_> {
    hertzian_contract::setters! { self:
        /// Goes on to this value, beyond the range that it was asked for.
        to(value: f64) { self.to = Some(value) }

        /// The branch has no more points than this, those that it has included. Default: as many more as it was asked for where it met
        /// that limit, and otherwise as it was asked for. Where it was followed both ways, as by
        /// [`through`](crate::FrequencyResponse::through), the limit is that of each part, and what a part has is counted for itself.
        max_points(points: usize) { self.max_points = Some(points) }

        /// Follows the branch once more from its first orbit, with another accuracy of the output.
        tolerance(tolerance: f64) { self.tolerance = Some(tolerance) }

        /// Follows the branch once more from its first orbit, with another largest step.
        largest_step(step: f64) { self.largest_step = Some(step) }

        /// Follows the branch once more from its first orbit, and looks for all bifurcations, or for folds alone. Shooting always looks
        /// for all.
        bifurcations(wanted: bool) { self.bifurcations = Some(wanted) }

        /// What is computed ends when this token is cancelled.
        cancel(cancel: &Cancel) { self.cancel = cancel.clone() }
    }

    /// Keeps it by this, if by anything.
    pub(crate) fn kept_by(self, keep: Option<Arc<dyn Keep>>) -> Self {
        Self { keep, ..self }
    }

    /// Goes on.
    ///
    /// # Errors
    /// If an option is not usable, the branch was read from a file and has no [model](Branch::attach), or there is nothing to go on to: a
    /// branch that has reached the end of its range goes on [to](Self::to) a value beyond it.
    pub fn run(&self) -> Result<Branch, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let following = self.branch.following()?;
        let asked = following.request();
        let limited = |end: Stop| matches!(end, Stop::PointLimit { .. });
        let more = self.most_points(following, limited).unwrap_or(0);
        let most = asked.max_points.saturating_add(more);
        let request = Request {
            max_points: self.max_points.unwrap_or(most),
            tolerance: self.tolerance.unwrap_or(asked.tolerance),
            largest_step: self.largest_step.unwrap_or(asked.largest_step),
            cancel: self.cancel.clone(),
            keep: self.keep.clone(),
            ..asked.clone()
        };
        let again = self.tolerance.or(self.largest_step).is_some() || self.bifurcations.is_some();
        let farther = self.to.is_some() && self.to != asked.to;
        if let Some(most) = self.max_points.filter(|_| !again) {
            let has = self.most_points(following, Stop::can_be_resumed);
            let least = has.unwrap_or(self.branch.points.len()) as f64 + 1.0;
            let must = "must be more than the points that the branch has";
            validate::option("max_points", most as f64, least..=f64::INFINITY, must)?;
        }
        let found = if again {
            self.again(following, &request, &mut visit)
        } else if farther {
            self.beyond(following, &request, &mut visit)
        } else {
            self.onward(following, &request, &mut visit)
        };
        let value = self
            .branch
            .points
            .last()
            .map_or(f64::NAN, |point| point.value);
        request.unless_lost(value, found)
    }

    /// How many points the part to the end of the range has, and the one to its beginning: none where it was followed one way. The first orbit
    /// of both is the same.
    fn points_of_parts(&self, following: &Following) -> [usize; 2] {
        let count = self.branch.points.len();
        let both = following
            .both_ways()
            .filter(|_| self.branch.begin.is_some());
        both.map_or([count, 0], |(_, middle)| {
            let middle = middle.min(count.saturating_sub(1));
            [count - middle, middle + 1]
        })
    }

    /// The most points of a part that ended so: a limit is that of each. `None` where neither did.
    fn most_points(&self, following: &Following, so: impl Fn(Stop) -> bool) -> Option<usize> {
        let ends = [Some(self.branch.stopped), self.branch.begin];
        let parts = self.points_of_parts(following).into_iter().zip(ends);
        let ended = parts.filter(|(_, end)| end.is_some_and(&so));
        ended.map(|(count, _)| count).max()
    }

    /// The rest of what was asked for.
    fn onward(
        &self,
        following: &Following,
        request: &Request,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let branch = self.branch;
        let lost = following.otherwise().and_then(|otherwise| otherwise.lost);
        if let Some((either, lost)) = following.either().zip(lost) {
            return self.by_balance(request, either, lost, visit);
        }
        let both = self.onward_both_ways(following, request, &mut *visit)?;
        let resumed = match (both, following) {
            (Some(both), _) => both,
            (
                None,
                Following::Balance {
                    context,
                    balance,
                    rest: Left::OneWay(rest),
                    ..
                },
            ) => {
                let asked = Asked::of(request, balance);
                by_balance::resume(asked, context.as_ref().clone(), branch, rest, &mut *visit)?
            }
            (
                None,
                Following::Shooting {
                    shooting,
                    rest: Left::OneWay(rest),
                    otherwise,
                    ..
                },
            ) => {
                let (shooting, other) = (*shooting, *otherwise);
                by_shooting::resume(request, shooting, other, branch, rest, &mut *visit)?
            }
            (
                None,
                Following::ContactEquation {
                    equation,
                    rest: Left::OneWay(rest),
                    otherwise,
                    ..
                },
            ) => {
                let (equation, other) = (*equation, *otherwise);
                by_contact_equation::resume(request, equation, other, branch, rest, &mut *visit)?
            }
            _ => return self.beyond(following, request, visit),
        };
        let resumed = or_otherwise(following, request, Ok(resumed), visit)?;
        Ok(resumed.after(branch))
    }

    /// The same of a branch that was followed both ways, if something is left of it.
    fn onward_both_ways(
        &self,
        following: &Following,
        request: &Request,
        visit: See<'_>,
    ) -> Result<Option<Branch>, Error> {
        let branch = self.branch;
        if following.both_ways().is_none() || !is_left(branch) {
            return Ok(None);
        }
        self.unkept()?;
        let resumed = match following {
            Following::Balance {
                balance,
                rest: Left::BothWays(both),
                ..
            } => {
                let asked = Asked::of(request, balance);
                by_balance::both_ways(asked, Some(branch), both, visit)?
            }
            Following::Shooting {
                shooting,
                rest: Left::BothWays(both),
                ..
            } => by_shooting::both_ways(request, *shooting, Some(branch), both, visit)?,
            Following::ContactEquation {
                equation,
                rest: Left::BothWays(both),
                ..
            } => by_contact_equation::both_ways(request, *equation, Some(branch), both, visit)?,
            _ => return Ok(None),
        };
        Ok(Some(resumed))
    }

    /// What the balance finds in place of a branch that ended so by the first method, or is left of it.
    ///
    /// # Errors
    /// If what is kept cannot be begun with again.
    fn by_balance(
        &self,
        request: &Request,
        either: Either,
        stopped: Stop,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let lost = Branch {
            stopped,
            ..self.branch.clone()
        };
        if let Some(keep) = &request.keep {
            keep.begin(&lost.model, &lost.varied, &lost.further)?;
        }
        either.beyond(request, lost, visit)
    }

    /// The branch with what follows behind its last orbit.
    fn beyond(
        &self,
        following: &Following,
        request: &Request,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let nothing = |must| self.nothing(must);
        let points = &self.branch.points;
        let ends = matches!(
            self.branch.stopped,
            Stop::ReachedEnd | Stop::Interrupted | Stop::PointLimit { .. }
        );
        let [.., before, last] = &points[..] else {
            return self.again(following, request, visit);
        };
        let [has, _] = self.points_of_parts(following);
        let to = self.to.or(request.to).unwrap_or(last.value);
        if !ends {
            return Err(
                nothing("ended before its range does, and there is nothing to go on to").into(),
            );
        }
        if self.to.is_none() && self.branch.stopped == Stop::ReachedEnd {
            // Not the name of what goes on: the program, which says this too, has none.
            return Err(
                nothing("has reached the end of its range, and nothing of it is left").into(),
            );
        }
        self.unkept()?;
        if (to - last.value) * (last.value - before.value) <= 0.0 {
            return Err(RequestError::Option {
                name: "to",
                value: to,
                must: "must be ahead of the last orbit, in the direction of the branch",
            }
            .into());
        }
        let whole = Request {
            to: Some(to),
            ..request.clone()
        };
        let request = Request {
            from: Some(last.value),
            near: Some(Guess::Orbit(last.orbit.clone())),
            period: Some(last.orbit.period),
            max_points: request.max_points.saturating_sub(has - 1).max(2),
            ..whole.clone()
        };
        // The balance is not tried for a part of the branch.
        let on = by_one(following, None, |method| method.run(&request, &mut *visit));
        let longer = on.map(|on| self.branch.with(on));
        or_otherwise(following, &whole, longer, visit)
    }

    /// Why there is nothing to go on to.
    fn nothing(&self, must: &'static str) -> RequestError {
        RequestError::Varied {
            name: self.branch.varied.clone(),
            must,
        }
    }

    /// # Errors
    /// If it is to be kept in a file: what is new does not lie behind what a file has.
    fn unkept(&self) -> Result<(), Error> {
        if self.keep.is_none() {
            return Ok(());
        }
        let must =
            "goes on beyond what is kept in its file: write the longer branch when it is there";
        Err(self.nothing(must).into())
    }

    /// The branch once more.
    fn again(
        &self,
        following: &Following,
        request: &Request,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        let points = &self.branch.points;
        let (Some(first), [from, to]) = (points.first(), request.range()?) else {
            return Err(RequestError::Rest.into());
        };
        let to = self.to.unwrap_or(to);
        if let Some((value, middle)) = following.both_ways() {
            let begun = begins_at(value, middle, points).then(|| &points[middle]);
            let middle = begun.ok_or(RequestError::Rest)?;
            let request = Request {
                to: Some(to),
                near: Some(Guess::Orbit(middle.orbit.clone())),
                period: Some(middle.orbit.period),
                ..request.clone()
            };
            self.unkept()?;
            let through = |method: &dyn Follow| method.through(&request, value, &mut *visit);
            return by_any(following, self.bifurcations, through);
        }
        let second = points.get(1).map_or(to, |second| second.value);
        let upwards = second > first.value;
        let ahead = (to > first.value) == upwards && to != first.value;
        if self.to.is_some() && !ahead {
            let must = "must be ahead of the first orbit, in the direction of the branch";
            return Err(RequestError::Option {
                name: "to",
                value: to,
                must,
            }
            .into());
        }
        let end = if ahead { to } else { from };
        let request = Request {
            from: Some(first.value),
            to: Some(end),
            near: Some(Guess::Orbit(first.orbit.clone())),
            period: Some(first.orbit.period),
            ..request.clone()
        };
        let run = |method: &dyn Follow| method.run(&request, &mut *visit);
        by_any(following, self.bifurcations, run)
    }
}

/// A branch, or what is tried where the first method led no further on it.
///
/// # Errors
/// Those of the balance, where there is no branch.
fn or_otherwise(
    following: &Following,
    request: &Request,
    found: Result<Branch, Error>,
    visit: See<'_>,
) -> Result<Branch, Error> {
    match following.either() {
        Some(either) => either.or_balance(request, found, visit),
        None => found,
    }
}
