//! How the motion of an orbit is had that is known by its states: by the contact equation where that has found it, which solves for it again, else by
//! integration, as of orbits that the contact equation does not find at their values.

use super::{by_contact_equation, by_shooting};
use crate::branches::branch::{Branch, Source};
use crate::branches::point::Point;
use crate::branches::request::Request;
use crate::contact_equation::ContactEquation;
use crate::contact_equation::completed::Solved;
use crate::error::Error;
use crate::orbit::observe::Reading;
use crate::shooting::Shooting;

/// What motions are computed by.
pub(super) struct Motions<'r> {
    pub(super) request: &'r Request,
    pub(super) shooting: Shooting,
    /// Where orbits are its.
    pub(super) equation: Option<ContactEquation>,
}

impl Motions<'_> {
    /// An orbit with its series, and everything that is read off.
    ///
    /// # Errors
    /// If it is not one of the system, or its motion cannot be computed.
    pub(super) fn completed(&self, point: &Point) -> Result<Point, Error> {
        let found = self.solved(point, |solved| solved.complete(point))?;
        found.map_or_else(
            || by_shooting::completed(self.request, self.shooting, point),
            Ok,
        )
    }

    /// A signal of an orbit.
    ///
    /// # Errors
    /// The same.
    pub(super) fn reading(&self, source: Source, point: &Point) -> Result<Reading, Error> {
        let found = self.solved(point, |solved| of_solved(solved, source, point))?;
        found.map_or_else(
            || by_shooting::reading(self.request, self.shooting, point, source),
            Ok,
        )
    }

    /// Several of them.
    ///
    /// # Errors
    /// The same.
    pub(super) fn readings(
        &self,
        sources: &[Source],
        point: &Point,
    ) -> Result<Vec<Reading>, Error> {
        let found = self.solved(point, |solved| {
            let sources = sources.iter();
            sources
                .map(|source| of_solved(solved, *source, point))
                .collect()
        })?;
        if let Some(found) = found {
            return Ok(found);
        }
        let sources = sources.iter();
        let read = |source| by_shooting::reading(self.request, self.shooting, point, source);
        sources.map(|source| read(*source)).collect()
    }

    /// What is read of an orbit that the contact equation finds again.
    fn solved<T>(
        &self,
        point: &Point,
        read: impl FnOnce(&Solved<'_>) -> T,
    ) -> Result<Option<T>, Error> {
        let Some(equation) = self.equation else {
            return Ok(None);
        };
        by_contact_equation::solved(self.request, equation, point, read)
    }
}

fn of_solved(solved: &Solved<'_>, source: Source, point: &Point) -> Reading {
    by_shooting::read(solved.found(by_shooting::signal(source)), point)
}

impl Branch {
    /// What the motions of its orbits are computed by.
    ///
    /// # Errors
    /// If it has no model.
    pub(super) fn motions(&self) -> Result<Motions<'_>, Error> {
        let following = self.followed()?;
        Ok(Motions {
            request: following.request(),
            shooting: following.shooting(),
            // The frequency of a free oscillation goes with the orbit.
            equation: following.equation().filter(|_| !self.further.is_backbone),
        })
    }
}
