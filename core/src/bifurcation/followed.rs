//! Branches through orbits that were found by states, and at events: by which method.
//!
//! An orbit of `p` periods has `p` times as many harmonics as one of a single period. Elimination by the balance takes the cube of that, shooting `p` times as
//! much as for one period, whatever the number of coordinates. So where the balance is asked for, long orbits that motions or Newton's method
//! led to are followed by shooting, and so is what begins on their branches: crossings that shooting finds have directions in states only.

use super::diagram::{Origin, Reason, Search};
use super::matching;
use crate::branches::branch::Branch;
use crate::branches::error::Attempts;
use crate::branches::point::{Event, Point};
use crate::branches::progress::Progress;
use crate::error::{Error, ErrorKind};
use crate::event::Side;
use crate::response::{FrequencyResponse, OrbitMethod, OrbitMethodKind};
use crate::shooting::Shooting;

/// Orbits of several periods with more harmonics than this are followed by shooting. Of three coordinates with affine stops an orbit took 3 to 8 ms by shooting
/// and 37 ms by the balance with 80 harmonics; of two coordinates with forces that are integrated, 15 to 40 ms and, with 60 to 80 harmonics, 18 to 33 ms.
const MANY: usize = 25;
/// Values of one orbit differ by this part of the range.
const ROUNDING: f64 = 1e-6;

impl<M: OrbitMethod> Search<'_, M> {
    /// Takes in the branch through an orbit, given by its states at the beginnings of its periods, unless it is known; returns its number.
    ///
    /// # Errors
    /// Why it was not followed.
    pub(super) fn add_orbit(
        &mut self,
        origin: Origin,
        value: f64,
        states: &[Vec<f64>],
    ) -> Result<usize, Reason> {
        if self.observer.interrupted {
            return Err(Reason::Interrupted);
        }
        if let Some(number) = self.branch_of(value, states) {
            return Ok(number);
        }
        self.may_go_on()?;
        let branch = self.through(value, states).map_err(Reason::of)?;
        self.add(origin, 0, branch);
        Ok(self.diagram.branches.len() - 1)
    }

    /// The branch through the orbit with these states, by the method that was asked for or by shooting. If neither leads to it, what the method says
    /// that was asked for.
    fn through(&mut self, value: f64, states: &[Vec<f64>]) -> Result<Branch, Error> {
        let asked = self.response.clone();
        if self.is_long(value, states.len()) {
            let by_shooting = asked.clone().by(self.response.shooting()?);
            let found = self.through_by(by_shooting, value, states);
            if self.is_final(&found) {
                return found;
            }
            return self.through_by(asked, value, states);
        }
        let found = self.through_by(asked.clone(), value, states);
        let own: &dyn std::any::Any = &asked;
        if self.is_final(&found) || own.is::<FrequencyResponse<Shooting>>() {
            return found;
        }
        let by_shooting = asked.by(self.response.shooting()?);
        match self.through_by(by_shooting, value, states) {
            Err(other) if other.kind() != ErrorKind::Cancelled => found,
            other => other,
        }
    }

    /// Whether no other way is to be tried.
    fn is_final(&self, found: &Result<Branch, Error>) -> bool {
        let failed = |error: &Error| error.kind() != ErrorKind::Cancelled;
        self.observer.interrupted || !found.as_ref().is_err_and(failed)
    }

    /// Whether the balance is asked for, and an orbit of several periods has many harmonics, as far as the nearest one tells.
    fn is_long(&self, value: f64, period: usize) -> bool {
        let request = &self.response.request;
        if period < 2 || !request.stability || !self.response.method.is_balance(request) {
            return false;
        }
        let branches = self.diagram.branches.iter().map(|branch| &branch.branch);
        let points = branches.flat_map(|branch| &branch.points);
        let off = |point: &&Point| (point.value - value).abs();
        let known = points.filter(|point| point.orbit.harmonics() > 0);
        let nearest = known.min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.is_some_and(|point| {
            period * point.orbit.harmonics() > MANY * point.orbit.period.max(1)
        })
    }

    /// The branch through the orbit with these states by one method.
    fn through_by<N: OrbitMethod>(
        &mut self,
        request: FrequencyResponse<N>,
        value: f64,
        states: &[Vec<f64>],
    ) -> Result<Branch, Error> {
        let period = states.len();
        let request = request.period(period).near_state(&states[0]);
        let orbit = request.orbit(value)?;
        if !matching::passes(&orbit, states) {
            return Err(Attempts::default().without_period(period, value).into());
        }
        // Each of two parts may have half.
        let request = request
            .near_orbit(&orbit.orbit)
            .max_points(self.points_left / 2);
        let branch = request.through_with(value, |progress| self.observer.see(progress))?;
        // With other harmonics a balance may have gone on from an orbit beside it.
        let rounding = ROUNDING * self.range;
        let mut here = branch.points.iter();
        let passes = here.any(|point| {
            (point.value - value).abs() <= rounding && matching::passes(point, states)
        });
        if passes || matching::contains(&self.response, &branch, None, value, states) {
            return Ok(branch);
        }
        Err(Attempts::default().without_period(period, value).into())
    }

    /// The branch that begins at an event, which was found by some method: by the one that was asked for, or by shooting if that is a balance and shooting has found
    /// the event.
    pub(super) fn switched(
        &mut self,
        event: &Event,
        side: Side,
        found_by: Option<OrbitMethodKind>,
    ) -> Result<Branch, Error> {
        let asked = self.response.clone().max_points(self.points_left);
        let balance = asked.method.is_balance(&asked.request);
        let mut see = |progress: Progress<'_>| self.observer.see(progress);
        if balance && found_by == Some(OrbitMethodKind::Shooting) {
            let by_shooting = asked.clone().by(asked.shooting()?);
            let found = by_shooting.switch_with(event, side, &mut see);
            if self.is_final(&found) {
                return found;
            }
        }
        asked.switch_with(event, side, |progress| self.observer.see(progress))
    }
}
