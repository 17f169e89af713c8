//! Along a curve of free oscillations, and over the places where an oscillation in one mode is in resonance with another one.
//!
//! Where the frequency of one mode is a multiple of that of another, and nothing is damped, the curve leads aside, onto a tongue: the other mode
//! takes over, until the one that was followed is gone. Tongues are there wherever harmonics meet frequencies of modes, in a structure of many
//! modes without end, and damping leaves most of them out. So the curve of a mode is followed one way: where it turns back it is taken up beyond,
//! from the [linearisation](super::modes) at an amplitude that is a little larger.
//!
//! Source: Kerschen, Peeters, Golinval and Vakakis (2009), Mech. Syst. Signal Process. 23, section 4.2 (internally resonant tongues, and that
//! steps lead over those that are narrow).

use std::ops::ControlFlow;

use super::modes::{Linearised, Mode};
use super::oscillation::Equations;
use crate::branches::leap::Leap;
use crate::branches::point::Point;
use crate::branches::progress::{Progress, Stage};
use crate::cancel::Cancel;
use crate::continuation::follow::{
    Continue, FollowOptions, Halt, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::newton::{Newton, NewtonError};
use crate::error::Error;
use crate::time::FlowError;

/// A motion that has not come back to this part of its size is not free.
const RETURNED: f64 = 1e-6;
/// Where a curve is taken up it is of the same mode: the cosine between both shapes is as large.
const LIKE: f64 = 0.9;
/// A curve that turned back is taken up farther by this part of the range, then by twice of it, and so on.
const AHEAD: f64 = 0.005;

/// A mode whose curve is followed one way.
pub(super) struct OneWay {
    pub(super) linearised: Linearised,
    pub(super) mode: Mode,
    pub(super) varied: usize,
}

impl OneWay {
    /// Whether two oscillations by their unknowns have one shape at rest.
    fn is_like(&self, a: &[f64], b: &[f64]) -> bool {
        let shape = |u: &[f64]| {
            let rest = &self.linearised.rest;
            let n = rest.len();
            let mut shape = rest.iter().map(|rest| -rest).collect::<Vec<_>>();
            let others = (0..n).filter(|i| *i != self.varied);
            others.zip(u).for_each(|(i, q)| shape[i] += q);
            shape[self.varied] += u[n];
            Mode {
                omega: u[n - 1],
                shape,
            }
        };
        self.linearised.likeness(&shape(a), &shape(b)) >= LIKE
    }

    /// The unknowns of an oscillation where what is varied has this position.
    pub(super) fn near(&self, position: f64) -> Result<Option<Vec<f64>>, Error> {
        let by = position - self.linearised.rest[self.varied];
        let found = self.linearised.at(&self.mode, self.varied, by)?;
        Ok(found.map(|found| {
            let pairs = self.linearised.rest.iter().zip(&found.shape).enumerate();
            let others = pairs.filter(|(index, _)| *index != self.varied);
            let others = others.map(|(_, (rest, by))| rest + by);
            others.chain([found.omega, position]).collect()
        }))
    }
}

/// What was found of a curve.
#[derive(Default)]
pub(super) struct Found {
    pub(super) points: Vec<Point>,
    /// How far a motion missed its beginning, or why it could not be computed.
    pub(super) failure: Option<Result<f64, FlowError>>,
    /// The last position.
    pub(super) position: f64,
    /// Where it was taken up again.
    pub(super) leaps: Vec<Leap>,
    /// Why the part that was followed last is not followed on, where the walk does not say so itself.
    ended: Option<Stop>,
    interrupted: bool,
}

/// What a walk along a curve takes.
pub(super) struct Walk<'w> {
    pub(super) equations: &'w mut Equations,
    pub(super) newton: &'w mut Newton,
    pub(super) visit: &'w mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
    pub(super) one_way: Option<OneWay>,
}

impl Walk<'_> {
    /// From the first oscillation to the end of the range, or as far as it goes.
    pub(super) fn all(
        &mut self,
        first: Vec<f64>,
        options: FollowOptions,
        cancel: &Cancel,
    ) -> Result<(Found, Result<Outcome, NewtonError>), Error> {
        let mut found = Found {
            position: options.from,
            ..Found::default()
        };
        let mut outcome = self.once(first, options, &mut found);
        let range = options.to - options.from;
        let mut ahead = AHEAD;
        while found.goes_on(&outcome) && !cancel.is_cancelled() {
            let from = found.position + ahead * range;
            let left = options.points.saturating_sub(found.points.len());
            let is_inside = (options.to - from) * range > 0.0;
            let Some(one_way) = self.one_way.as_ref().filter(|_| is_inside && left > 1) else {
                break;
            };
            let before = found.points.len();
            if let Some(u) = one_way.near(from)? {
                let reason = found.stop(&outcome);
                found.ended = None;
                let beyond = FollowOptions {
                    from,
                    points: left,
                    ..options
                };
                let again = self.once(u, beyond, &mut found);
                if found.points.len() > before {
                    found
                        .leaps
                        .extend(reason.map(|reason| Leap::new(before, reason)));
                    outcome = again;
                    ahead = AHEAD;
                    continue;
                }
                found.ended = reason;
            }
            ahead *= 2.0;
        }
        Ok((found, outcome))
    }

    /// From an oscillation on.
    fn once(
        &mut self,
        u: Vec<f64>,
        options: FollowOptions,
        found: &mut Found,
    ) -> Result<Outcome, NewtonError> {
        let (mode, visit) = (self.one_way.as_ref(), &mut *self.visit);
        let one_way = mode.is_some();
        let first = u.clone();
        let forward = (options.to - options.from).signum();
        let begun = found.points.len();
        follow(
            self.equations,
            self.newton,
            Start::Near(u),
            options,
            &mut |equations: &mut Equations, _: &mut Newton, seen: Visit<'_>| {
                let Visit::Point(at) = seen else {
                    return Continue::Continue(());
                };
                let position = equations.position(&at.u);
                let is_back = (position - found.position) * forward <= 0.0;
                let is_first = found.points.len() == begun;
                let is_other =
                    begun > 0 && is_first && mode.is_some_and(|mode| !mode.is_like(&at.u, &first));
                if is_other || one_way && !is_first && is_back {
                    let value = found.position;
                    found.ended = Some(Stop::TurnedBack { value });
                    return Continue::Break(Halt::Stop);
                }
                let point = match equations.read(&at.u) {
                    Ok((mut point, apart)) if apart <= RETURNED => {
                        point.error = Some(apart);
                        point
                    }
                    // What is unstable does not come back for rounding.
                    Ok((_, by)) if one_way && !found.points.is_empty() => {
                        let value = found.position;
                        found.ended = Some(Stop::Missed { value, by });
                        return Continue::Break(Halt::Stop);
                    }
                    failed => {
                        found.failure = Some(failed.map(|(_, apart)| apart));
                        return Continue::Break(Halt::Stop);
                    }
                };
                found.position = position;
                let progress = Progress {
                    point: Some(&point),
                    ..Progress::at(Stage::Curve, found.points.len() + 1, position)
                };
                let answer = visit(progress);
                found.points.push(point);
                found.interrupted = answer.is_break();
                answer.map_break(|()| Halt::Stop)
            },
        )
    }
}

impl Found {
    /// Whether the curve may be taken up beyond where it ended.
    fn goes_on(&self, outcome: &Result<Outcome, NewtonError>) -> bool {
        let stop = self.stop(outcome);
        let ended = matches!(
            stop,
            Some(
                Stop::LeftAtStart
                    | Stop::StepTooShort { .. }
                    | Stop::TurnedBack { .. }
                    | Stop::Missed { .. }
            )
        );
        !self.points.is_empty() && !self.interrupted && self.failure.is_none() && ended
    }

    /// Why it ended; none where the walk did not begin or was interrupted.
    pub(super) fn stop(&self, outcome: &Result<Outcome, NewtonError>) -> Option<Stop> {
        let own = match outcome {
            // Where a later part begins is no end of the range.
            Ok(Outcome::Stopped(Stop::LeftAtStart)) if !self.leaps.is_empty() => {
                let value = self.position;
                Some(Stop::TurnedBack { value })
            }
            Ok(Outcome::Stopped(stop)) => Some(*stop),
            _ => None,
        };
        self.ended.or(own)
    }
}
