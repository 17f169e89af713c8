//! What a branch computes when it is asked: it knows what followed it.

use std::any::Any;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::by_shooting::{self, Second};
use super::following::{Following, Left, by_any};
use super::kind::OrbitMethodKind;
use crate::balance::symmetry::is_broken;
use crate::balance_branch::check::Asked;
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::{Branch, Further, Model};
use crate::branches::point::{Event, Point};
use crate::branches::progress::{Progress, Stage};
use crate::branches::request::{Guess, Request};
use crate::branches::stability::Stability;
use crate::contact_equation;
use crate::contact_equation::problem::ContactProblem;
use crate::error::Error;
use crate::event::Side;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::shooting::{self, BifurcationCurve, Shooting};
use crate::system::System;

impl Branch {
    /// Every orbit of the branch at a value of what it varies, in branch order; empty where the branch does not pass. Harmonics
    /// follow the tolerance as along the branch. Of a branch by the contact equation or by shooting they are [completed](Self::complete).
    ///
    /// # Errors
    /// If the value is not finite, an orbit between two points cannot be computed, or the branch was read from a file and has no
    /// [model](Self::attach).
    pub fn at(&self, value: f64) -> Result<Vec<Point>, Error> {
        let found = self.plainly_at(value)?;
        found.iter().map(|point| self.complete(point)).collect()
    }

    /// The same, with what the method reads off.
    pub(crate) fn plainly_at(&self, value: f64) -> Result<Vec<Point>, Error> {
        validate::finite("at", value)?;
        let following = self.following()?;
        let places = self.points.iter().map(|point| point.value);
        let places = places.chain(self.events.iter().map(|event| event.point.value));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
            (low.min(place), high.max(place))
        });
        if !(low..=high).contains(&value) {
            return Ok(Vec::new());
        }
        if let Following::Balance { context, .. } = following {
            return context.at(self, value);
        }
        let Some(point) = self.points.first() else {
            return Ok(Vec::new());
        };
        let (shooting, request) = (following.shooting(), following.request());
        let (shooting, mut request) = by_shooting::of_period(shooting, request, point.orbit.period);
        let verdicts = request.stability;
        // Errors of shooting are known with its maps.
        request.stability |= matches!(following, Following::ContactEquation { .. });
        let asked = shooting::Asked::of(&request, &shooting);
        let mut found = if let Following::ContactEquation { .. } = following {
            let problem = asked.held().problem(value, value)?;
            contact_equation::at::at(
                &ContactProblem::new(problem, request.tolerance),
                self,
                value,
            )?
        } else {
            shooting::at::at(&asked.problem(value, value)?, self, value)?
        };
        for point in found.iter_mut().filter(|_| !verdicts) {
            point.stability = Stability::unknown();
        }
        Ok(found)
    }

    /// The branch that begins at one of the events of this one, in the same range, by the same method: see
    /// [`FrequencyResponse::switch`](crate::FrequencyResponse::switch).
    ///
    /// # Errors
    /// If no branch begins there, its first orbit was not found, or the branch was read from a file and has no
    /// [model](Self::attach).
    pub fn switch(&self, event: &Event, side: Side) -> Result<Self, Error> {
        self.switch_with(event, side, |_| ControlFlow::Continue(()))
    }

    /// As [`switch`](Self::switch), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`switch`](Self::switch).
    pub fn switch_with(
        &self,
        event: &Event,
        side: Side,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Self, Error> {
        let following = self.following()?;
        let request = following.request();
        by_any(following, None, |method| {
            method.switch(request, event, side, &mut visit)
        })
    }

    // A request has `track` and `track_with` as well, for whoever has an event and no branch.
    /// The curve of bifurcations through one of its events, as a second parameter (or `"omega"`) varies between two values: see
    /// [`FrequencyResponse::track`](crate::FrequencyResponse::track).
    ///
    /// # Errors
    /// If a parameter is not usable, there is no such curve, or the branch was read from a file and has no [model](Self::attach).
    pub fn track(
        &self,
        event: &Event,
        second: &str,
        range: [f64; 2],
    ) -> Result<BifurcationCurve, Error> {
        self.track_with(event, second, range, |_| ControlFlow::Continue(()))
    }

    /// As [`track`](Self::track), and calls `visit` at every bifurcation as it is found: to show progress, or to stop. What was found
    /// until then comes back.
    ///
    /// # Errors
    /// As [`track`](Self::track).
    pub fn track_with(
        &self,
        event: &Event,
        second: &str,
        range: [f64; 2],
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<BifurcationCurve, Error> {
        let following = self.following()?;
        let (shooting, request) = (following.shooting(), following.request());
        let second = Second {
            name: second,
            range,
        };
        by_shooting::track(request, shooting, event, second, &mut visit)
    }

    /// An orbit of this branch with its Fourier series, and everything that is read off. By the balance it has that already; by other methods
    /// its motion is computed once more, and 20 harmonics for each period of the excitation are kept. By the contact equation that is solved again at the
    /// value, or along the branch beside a fold, with so many nodes that more change nothing, if its motion is stiff; else, where that finds nothing, and by shooting, the motion is integrated. Where that
    /// does not come back as nearly as the stated error has it, it is the periodic one beside it; extremes of coordinates, and states, stay those of the orbit.
    ///
    /// # Errors
    /// If the orbit is not one of this system, its motion cannot be computed, or the branch was read from a file and has no
    /// [model](Self::attach).
    pub fn complete(&self, point: &Point) -> Result<Point, Error> {
        if point.orbit.has_series() {
            return Ok(point.clone());
        }
        let found = self.motions()?.completed(&self.of_motion(point))?;
        Ok(Point {
            error: point.error,
            ..found
        })
    }

    /// An orbit as its motion is looked at. A free oscillation states how far it misses its beginning: nothing holds its phase, so that no orbit is looked
    /// for that comes nearer.
    pub(super) fn of_motion(&self, point: &Point) -> Point {
        Point {
            error: point.error.filter(|_| !self.further.is_backbone),
            ..point.clone()
        }
    }

    /// [Completes](Self::complete) every orbit of the branch, as tables that have more than extremes take it.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Stopped(x) {
    ///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
    ///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    ///     }
    /// }
    ///
    /// let mut branch = FrequencyResponse::of(&Stopped {}).from(1.0).to(1.1).run()?;
    /// branch.complete_all()?;
    /// let impulse = branch.points.iter().filter_map(|point| point.observed.contacts[0].impulse);
    /// assert!(impulse.sum::<f64>() > 0.0);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`complete`](Self::complete), at the first orbit where it fails; all others are completed.
    pub fn complete_all(&mut self) -> Result<(), Error> {
        self.complete_all_with(|_| ControlFlow::Continue(()))
    }

    /// As [`complete_all`](Self::complete_all), and calls `visit` at every orbit: to show progress, or to stop with those that are completed
    /// by then.
    ///
    /// # Errors
    /// As [`complete_all`](Self::complete_all).
    pub fn complete_all_with(
        &mut self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let total = Some(self.points.len());
        let mut failed = Ok(());
        for index in 0..self.points.len() {
            match self.complete(&self.points[index]) {
                Ok(completed) => self.points[index] = completed,
                Err(error) => failed = failed.and(Err(error)),
            }
            let point = &self.points[index];
            let progress = Progress {
                total,
                point: Some(point),
                ..Progress::at(Stage::Completing, index + 1, point.value)
            };
            if visit(progress).is_break() {
                break;
            }
        }
        failed
    }

    /// Gives a branch that was read from a file its model back, so that it can compute further orbits: by the method that followed it,
    /// with the options that it was asked for. Where those are not in the file, by default options in the range that the branch has, and
    /// the balance looks for all bifurcations.
    ///
    /// # Errors
    /// If the model has another name, other equations, or other values of what the branch does not vary.
    pub fn attach(&mut self, model: &dyn System) -> Result<(), Error> {
        if !self.model.agrees(&Model::of(model)) {
            return Err(RequestError::OtherModel {
                expected: self.model.name.clone(),
                found: model.facts().name.to_string(),
            }
            .into());
        }
        let following = match self.points.first() {
            Some(point) => self.asked_for(model, point)?,
            None => Following::Shooting {
                request: Request::of(model),
                shooting: Shooting::new(),
                rest: Left::Nothing,
                otherwise: None,
            },
        };
        self.further = Further {
            is_backbone: self.further.is_backbone,
            ..Further::of(model.shared(), Arc::new(following))
        };
        Ok(())
    }

    /// What a branch with this first point was asked for by, as it was written, or else as it must have been.
    fn asked_for(&self, model: &dyn System, point: &Point) -> Result<Following, Error> {
        #[cfg(feature = "serde")]
        if !self.further.written.is_null() {
            let written = serde_json::from_value(self.further.written.clone());
            let following = Following::of(model, written.map_err(|_| RequestError::Rest)?)?;
            // Along a backbone other things vary than in what it was read by.
            let varying = self.further.is_backbone.then(|| self.varying(model, point));
            let request = varying.as_ref().unwrap_or(following.request());
            shooting::Asked::of(request, &Shooting::new()).belongs(point)?;
            return Ok(following);
        }
        self.followed_by(model, point)
    }

    /// A request that varies what the branch does, from this point of it.
    fn varying(&self, model: &dyn System, point: &Point) -> Request {
        let mut request = Request::of(model);
        if self.varied != "omega" {
            request.vary = Some(self.varied.clone());
            request.omega = Some(point.orbit.omega);
        }
        request
    }

    /// What a branch with this first point was followed by, if it was one of this system.
    fn followed_by(&self, model: &dyn System, point: &Point) -> Result<Following, Error> {
        let mut request = self.varying(model, point);
        let values = || {
            let events = self.events.iter().map(|event| event.point.value);
            let turns = self.turns.iter().map(|turn| turn.value);
            let points = self.points.iter().map(|point| point.value);
            points
                .chain(events)
                .chain(turns)
                .filter(|value| value.is_finite())
        };
        let ends = [
            values().fold(f64::INFINITY, f64::min),
            values().fold(f64::NEG_INFINITY, f64::max),
        ];
        request.from = Some(ends[0]);
        request.period = Some(point.orbit.period);
        let (shooting, balance) = (Shooting::new(), HarmonicBalance::new().bifurcations(true));
        shooting::Asked::of(&request, &shooting).belongs(point)?;
        request.to = Some(if ends[0] < ends[1] {
            ends[1]
        } else {
            let balance = &balance;
            let request = &request;
            Asked { request, balance }.aside(ends[0])?
        });
        if !point.orbit.states.is_empty() {
            return Ok(Following::Shooting {
                request,
                shooting,
                rest: Left::Nothing,
                otherwise: None,
            });
        }
        // A branch may pass from orbits with a symmetry to others.
        let broken = |point: &&Point| {
            let orbit = &point.orbit;
            orbit.has_series() && is_broken(&orbit.series, orbit.row(0).len())
        };
        let near = self.points.iter().find(broken).unwrap_or(point);
        let near = Request {
            near: Some(Guess::Orbit(near.orbit.clone())),
            ..request.clone()
        };
        let asked = Asked::of(&near, &balance);
        let (context, _) = asked.check()?;
        Ok(Following::Balance {
            context: Box::new(context),
            request,
            balance,
            rest: Left::Nothing,
        })
    }

    /// A balance of orbits like this one of the branch, whatever method found it.
    pub(super) fn context(&self, point: &Point) -> Result<BranchContext, Error> {
        let following = self.following()?;
        if let Following::Balance { context, .. } = following {
            return Ok(context.as_ref().clone());
        }
        let request = following.request();
        let balance = HarmonicBalance::new();
        // With the symmetry that this orbit has, and no other.
        let mut request = Request {
            near: Some(Guess::Orbit(point.orbit.clone())),
            period: Some(point.orbit.period),
            ..request.clone()
        };
        if request.from.is_none() || request.to.is_none() {
            request.from = Some(point.value);
            let asked = Asked::of(&request, &balance);
            request.to = Some(asked.aside(point.value)?);
        }
        let asked = Asked::of(&request, &balance);
        Ok(asked.check()?.0)
    }

    /// The method that followed it, whether it was asked for or [chosen](crate::Chosen). `None` of a branch from a file that does not say
    /// so.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, OrbitMethodKind, Shooting};
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let request = FrequencyResponse::of(&Duffing { drive: 0.2 }).from(0.5).to(0.6);
    /// assert_eq!(request.run()?.method(), Some(OrbitMethodKind::HarmonicBalance));
    /// let by_shooting = request.by(Shooting::new()).run()?;
    /// assert_eq!(by_shooting.method(), Some(OrbitMethodKind::Shooting));
    /// assert_eq!(OrbitMethodKind::Shooting.to_string(), "shooting");
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    pub fn method(&self) -> Option<OrbitMethodKind> {
        let known = self.followed().ok().map(Following::method);
        known.or_else(|| written_method(&self.further))
    }

    /// What followed it, if it is one of the balance.
    pub(super) fn by_balance(&self) -> Option<&BranchContext> {
        match self.following() {
            Ok(Following::Balance { context, .. }) => Some(context),
            _ => None,
        }
    }

    /// Whether what is asked for at a fixed value of what is varied makes sense of it.
    ///
    /// # Errors
    /// If it is a backbone, along which the frequency goes with the orbit.
    pub(crate) fn is_no_backbone(&self) -> Result<(), Error> {
        if self.further.is_backbone {
            return Err(RequestError::Backbone.into());
        }
        Ok(())
    }

    /// What followed it, to compute further orbits by.
    ///
    /// # Errors
    /// If it has no model, or is a backbone.
    pub(super) fn following(&self) -> Result<&Following, Error> {
        self.is_no_backbone()?;
        self.followed()
    }

    /// What followed it, to read its own orbits by.
    ///
    /// # Errors
    /// If it has no model.
    pub(super) fn followed(&self) -> Result<&Following, Error> {
        let request = self.further.request.as_deref();
        let request = request.map(|request| request as &dyn Any);
        let following = request.and_then(|request| request.downcast_ref::<Following>());
        following.ok_or_else(|| RequestError::Detached.into())
    }
}

/// The method of a branch that was read from a file, as it was written.
#[cfg(feature = "serde")]
fn written_method(further: &Further) -> Option<OrbitMethodKind> {
    let by = further.written["by"].as_object()?;
    let known = [
        ("harmonic-balance", OrbitMethodKind::HarmonicBalance),
        ("shooting", OrbitMethodKind::Shooting),
        ("contact-equation", OrbitMethodKind::ContactEquation),
    ];
    let mut known = known.into_iter();
    known.find_map(|(key, method)| by.contains_key(key).then_some(method))
}

/// Without files nothing is written.
#[cfg(not(feature = "serde"))]
fn written_method(_: &Further) -> Option<OrbitMethodKind> {
    None
}
