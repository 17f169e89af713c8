//! Derivatives of where an event is, and of what is read off there as it moves.
//!
//! With the place `lambda(p)` and what is read off at fixed values, `y(lambda, p)`,
//!
//! ```text
//! dy/dp = y_p + y_lambda dlambda/dp,                                                                          (1)
//! ```
//!
//! but at a fold, where both are unbounded: there `y` is differentiated along the directions of [`critical`](super::critical).

use super::critical::{self, Crosses};
use super::cycle::Cycle;
use super::error::SensitivityError;
use super::fold::{self, Moving};
use super::grazing;
use super::moments::Slope;
use super::orbit::{
    BESIDE, FINE, ROUNDINGS, Sensitive, Start, apart, condition, finite, unless_cancelled,
};
use super::rows::Row;
use super::{Measured, Missing, Sensitivities};
use crate::branches::point::Event;
use crate::error::{Error, ErrorKind};
use crate::event::EventKind;
use crate::numeric::estimate::Estimate;
use crate::system::Variable;

impl Sensitive<'_> {
    /// The place of an event, and rows; with multipliers, if they are asked for.
    pub(super) fn of_event(
        &self,
        event: &Event,
        rows: &[Row],
        multipliers: bool,
    ) -> Result<Sensitivities, Error> {
        let others: Vec<Variable> = (self.variables.iter().copied())
            .filter(|variable| *variable != self.varied)
            .collect();
        let mut cycle = self.cycle(FINE.0)?;
        let start = self.start(&mut cycle)?;
        let crosses = Crosses::at(event.kind, self.point.orbit.parts);
        let both = match (event.kind, crosses) {
            (_, Some(crosses)) => self.by_both(&mut cycle, &start, &|cycle, start| {
                critical::crossing(cycle, start.clone(), crosses, &others)
            })?,
            (EventKind::Fold, _) => self.by_both(&mut cycle, &start, &|cycle, start| {
                fold::fold(cycle, &start.states, start.value, &others)
            })?,
            (EventKind::Grazing { .. }, _) => {
                self.by_both(&mut cycle, &start, &|cycle, start| {
                    grazing::grazing(cycle, self.system(), start, &others)
                })?
            }
            (kind, _) => return Err(SensitivityError::Kind { kind }.into()),
        };
        let mut told = self.told(0.0);
        self.tell_place(&both, &mut told);
        told.kind = Some(event.kind);
        let is_singular = event.kind == EventKind::Fold || crosses == Some(Crosses::One);
        if rows.is_empty() {
            if !is_singular {
                let condition = self.condition_at(&mut cycle, &both.fine);
                told.condition = unless_cancelled(condition)?.unwrap_or(0.0);
            }
            return Ok(told);
        }
        if event.kind == EventKind::Fold {
            let why = format!(
                "at a fold derivatives at a fixed {} are unbounded",
                told.varied
            );
            told.lack(&["measured"], multipliers, &why);
            self.add_of_fold(&mut cycle, &both, rows, &mut told)?;
        } else if is_singular {
            let why = "the equations of the orbit are singular where another branch crosses";
            told.lack(&["measured", "moving"], multipliers, why);
        } else {
            let added = self.add_at_event(&mut cycle, &both, rows, multipliers, &mut told);
            told.unless_failed(&["measured", "moving"], multipliers, added)?;
        }
        Ok(told)
    }

    /// The place with its derivatives, or what breaks a symmetry.
    fn tell_place(&self, both: &Found, told: &mut Sensitivities) {
        let place = self.placed(both);
        for (name, place) in told.variables.iter().zip(&place) {
            if place.is_some_and(|place| place.value.is_nan()) {
                let why = "it breaks the symmetry: beside its value no branches cross";
                told.missing
                    .push(Missing::new(format!("place by {name}"), why));
            }
        }
        told.place = place.into_iter().map(known).collect();
    }

    /// How far the equations at an event are from singular ones.
    fn condition_at(&self, cycle: &mut Cycle, found: &Moving) -> Result<f64, Error> {
        cycle.set(self.varied, found.value)?;
        let evaluated = cycle.evaluate(&found.states, &[], &[])?;
        Ok(condition(&cycle.scaled(&evaluated.jacobian))?)
    }

    /// An event from a start on by two flows.
    fn by_both(&self, cycle: &mut Cycle, start: &Start, find: &Find<'_>) -> Result<Found, Error> {
        let fine = find(cycle, start)?;
        let beside = self
            .cycle(BESIDE.0)
            .and_then(|mut own| Ok(find(&mut own, &fine.start())?));
        Ok(Found {
            beside: unless_cancelled(beside)?,
            fine,
        })
    }

    /// Derivatives of a place by all variables, as two flows have it: none by what is varied.
    fn placed(&self, Found { fine, beside }: &Found) -> Vec<Option<Estimate>> {
        let both = fine.by.iter().zip(&fine.errors).enumerate();
        let mut known = both.map(|(index, (&value, own))| {
            let beside = beside.as_ref().map(|beside| beside.by[index]);
            let apart = beside.map_or(f64::INFINITY, |beside| (value - beside).abs());
            Estimate {
                value,
                error: finite(apart + own + ROUNDINGS * f64::EPSILON * value.abs()),
            }
        });
        let place = self.variables.iter().map(|variable| {
            let own = *variable == self.varied;
            if own { None } else { known.next() }
        });
        place.collect()
    }

    /// What is read off at an event that is no fold.
    fn add_at_event(
        &self,
        cycle: &mut Cycle,
        Found { fine, beside }: &Found,
        rows: &[Row],
        multipliers: bool,
        told: &mut Sensitivities,
    ) -> Result<(), Error> {
        let mut start = fine.start();
        self.settle(cycle, &mut start)?;
        let beside = beside.as_ref().unwrap_or(fine);
        let near = beside.near.clone().unwrap_or_else(|| beside.start());
        let (mut at, read) = self.at(cycle, &start, &near, rows)?;
        if multipliers {
            self.add_multipliers(cycle, &start, &read, &mut at)?;
        }
        let own = (self.variables.iter()).position(|variable| *variable == self.varied);
        let moved = at.measured.iter().map(|row| {
            let along = own.map_or(Estimate::NONE, |own| row.by[own]);
            let by = row
                .by
                .iter()
                .zip(&told.place)
                .map(|(by, place)| place.map_or(Estimate::NONE, |place| by.with(along, place)));
            Measured {
                by: by.collect(),
                ..row.clone()
            }
        });
        told.moving = moved.collect();
        told.measured = at.measured;
        told.missing.extend(at.missing);
        told.condition = at.condition;
        Ok(())
    }

    /// What is read off at a fold, as it moves; errors are told by another flow, at the place where the fold is by that one.
    fn add_of_fold(
        &self,
        cycle: &mut Cycle,
        Found { fine, beside }: &Found,
        rows: &[Row],
        told: &mut Sensitivities,
    ) -> Result<(), Error> {
        let bends = match critical::bends(cycle, fine, &self.variables) {
            Ok(bends) => bends,
            Err(error) if error.is_cancelled() => return Err(error.into()),
            Err(error) => {
                told.missing.push(Missing::new("moving", error.to_string()));
                return Ok(());
            }
        };
        let (start, directions) = (fine.start(), &bends.directions);
        let vanishes = cycle.vanishes();
        let read = self.read_along(cycle, &start, rows, FINE.1, directions, vanishes);
        let Some(read) = told.unless_failed(&["moving"], false, read)? else {
            return Ok(());
        };
        let beside = beside
            .as_ref()
            .map(|beside| self.read_of_fold(beside, rows));
        let beside = beside.map(unless_cancelled).transpose()?.flatten();
        for (index, (row, slope)) in rows.iter().zip(&read).enumerate() {
            let (slope, errors) = moved(slope, &bends);
            let beside = beside.as_ref().map(|beside| &beside[index]);
            let mut by = apart(&slope, beside, ROUNDINGS * f64::EPSILON);
            for (by, error) in by.iter_mut().zip(errors) {
                by.error = finite(by.error + error);
            }
            told.add_moving(row, slope.value, by);
        }
        Ok(())
    }

    /// What is read off at a fold by the flow that tells errors, as it moves.
    fn read_of_fold(&self, fold: &Moving, rows: &[Row]) -> Result<Vec<Slope>, Error> {
        let mut cycle = self.cycle(BESIDE.0)?;
        let bends = critical::bends(&mut cycle, fold, &self.variables)?;
        let (start, directions) = (fold.start(), &bends.directions);
        let read = self.read_along(&mut cycle, &start, rows, BESIDE.1, directions, 0.0)?;
        Ok(read.iter().map(|slope| moved(slope, &bends).0).collect())
    }
}

/// An event by two flows; nothing of the second one where that fails, which leaves errors unknown.
struct Found {
    fine: Moving,
    beside: Option<Moving>,
}

/// What finds an event and says how its place moves.
type Find<'f> = dyn Fn(&mut Cycle, &Start) -> Result<Moving, SensitivityError> + 'f;

/// What is read off along the directions in which a fold moves, and the errors that these leave: (3) of [`critical`](super::critical).
fn moved(slope: &Slope, bends: &critical::Bends) -> (Slope, Vec<f64>) {
    let last = slope.by.last().copied().unwrap_or(f64::NAN);
    let both = slope.by.iter().zip(&bends.along);
    let by = both.clone().map(|(by, [along, _])| by + last * along);
    let moved = Slope {
        value: slope.value,
        by: by.collect(),
    };
    (
        moved,
        both.map(|(_, [_, error])| (last * error).abs()).collect(),
    )
}

/// A derivative that is a number.
fn known(place: Option<Estimate>) -> Option<Estimate> {
    place.filter(|place| !place.value.is_nan())
}

impl Sensitivities {
    fn add_moving(&mut self, row: &Row, value: f64, by: Vec<Estimate>) {
        let moving = self.known(row, value, by);
        self.moving.extend(moving);
    }

    /// Says why some of it is not known.
    fn lack(&mut self, what: &[&str], multipliers: bool, why: &str) {
        let multipliers = multipliers.then_some("multipliers");
        let all = what.iter().copied().chain(multipliers);
        self.missing.extend(all.map(|what| Missing::new(what, why)));
    }

    /// What was computed; what failed is said to be missing, and what is known already is kept.
    ///
    /// # Errors
    /// If it was cancelled.
    fn unless_failed<T>(
        &mut self,
        what: &[&str],
        multipliers: bool,
        computed: Result<T, Error>,
    ) -> Result<Option<T>, Error> {
        match computed {
            Ok(computed) => Ok(Some(computed)),
            Err(error) if error.kind() == ErrorKind::Cancelled => Err(error),
            Err(error) => {
                let why = crate::error::chain(&error).to_string();
                self.lack(what, multipliers, &why);
                Ok(None)
            }
        }
    }
}

impl Estimate {
    /// By what nothing depends on.
    const NONE: Self = Self {
        value: 0.0,
        error: 0.0,
    };

    /// (1): and that along another direction, times a number.
    fn with(self, along: Self, times: Self) -> Self {
        Self {
            value: self.value + along.value * times.value,
            error: self.error
                + (along.error * times.value).abs()
                + (along.value * times.error).abs(),
        }
    }
}
