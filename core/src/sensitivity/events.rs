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
use super::orbit::{COARSE, FINE, ROUNDINGS, Sensitive, Start, apart};
use super::place::{self, Moving};
use super::rows::Row;
use super::{Derivative, Measured, Missing, Sensitivities};
use crate::branches::point::Event;
use crate::error::Error;
use crate::event::EventKind;
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
        let (moving, place) = match (event.kind, crosses) {
            (_, Some(crosses)) => {
                let moving = critical::crossing(&mut cycle, start, crosses, &others)?;
                let errors = moving.errors.clone();
                let place = self.placed(&moving, errors);
                (moving, place)
            }
            (EventKind::Fold, _) => self.by_both(&mut cycle, &start, |cycle, start| {
                place::fold(cycle, &start.states, start.value, &others)
            })?,
            (EventKind::Grazing { .. }, _) => {
                self.by_both(&mut cycle, &start, |cycle, start| {
                    place::grazing(cycle, self.system(), &start.states, start.value, &others)
                })?
            }
            (kind, _) => return Err(SensitivityError::Kind { kind }.into()),
        };
        let mut told = self.told(0.0);
        for (name, place) in told.variables.iter().zip(&place) {
            if place.is_some_and(|place| place.value.is_nan()) {
                let why = "it breaks the symmetry: beside its value no branches cross";
                told.missing
                    .push(Missing::new(format!("place by {name}"), why));
            }
        }
        told.place = place.into_iter().map(known).collect();
        told.kind = Some(event.kind);
        if rows.is_empty() {
            return Ok(told);
        }
        match (event.kind, crosses) {
            (EventKind::Fold, _) => {
                let why = format!(
                    "at a fold derivatives at a fixed {} are unbounded",
                    told.varied
                );
                told.missing.push(Missing::new("measured", why));
                self.add_of_fold(&mut cycle, &moving, rows, &mut told)?;
            }
            (_, Some(Crosses::One)) => {
                let why = "the equations of the orbit are singular where another branch crosses";
                told.missing.push(Missing::new("measured", why));
            }
            _ => self.add_at_event(&mut cycle, &moving, rows, multipliers, &mut told)?,
        }
        Ok(told)
    }

    /// By two flows, with errors told by the coarse one.
    fn by_both(
        &self,
        cycle: &mut Cycle,
        start: &Start,
        find: impl Fn(&mut Cycle, &Start) -> Result<Moving, SensitivityError>,
    ) -> Result<(Moving, Vec<Option<Derivative>>), Error> {
        let fine = find(cycle, start)?;
        let coarse = find(&mut self.cycle(COARSE.0)?, &fine.start())?;
        let both = fine.by.iter().zip(&coarse.by);
        let rounding = ROUNDINGS * f64::EPSILON;
        let errors = both.map(|(a, b)| (a - b).abs() + rounding * a.abs());
        let errors = errors.collect();
        let place = self.placed(&fine, errors);
        Ok((fine, place))
    }

    /// Derivatives of a place by all variables: none by what is varied.
    fn placed(&self, moving: &Moving, errors: Vec<f64>) -> Vec<Option<Derivative>> {
        let both = moving.by.iter().zip(errors);
        let mut known = both.map(|(&value, error)| Derivative { value, error });
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
        moving: &Moving,
        rows: &[Row],
        multipliers: bool,
        told: &mut Sensitivities,
    ) -> Result<(), Error> {
        let mut start = moving.start();
        self.settle(cycle, &mut start)?;
        let (mut at, read) = self.at(cycle, &start, rows)?;
        if multipliers {
            self.add_multipliers(cycle, &start, &read, &mut at)?;
        }
        let own = (self.variables.iter()).position(|variable| *variable == self.varied);
        let moved = at.measured.iter().map(|row| {
            let along = own.map_or(Derivative::NONE, |own| row.by[own]);
            let by =
                row.by.iter().zip(&told.place).map(|(by, place)| {
                    place.map_or(Derivative::NONE, |place| by.with(along, place))
                });
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

    /// What is read off at a fold, as it moves.
    fn add_of_fold(
        &self,
        cycle: &mut Cycle,
        fold: &Moving,
        rows: &[Row],
        told: &mut Sensitivities,
    ) -> Result<(), Error> {
        let bends = match critical::bends(cycle, fold, &self.variables) {
            Ok(bends) => bends,
            Err(error) if error.is_cancelled() => return Err(error.into()),
            Err(error) => {
                told.missing.push(Missing::new("moving", error.to_string()));
                return Ok(());
            }
        };
        let start = fold.start();
        let along = &bends.directions;
        let fine = self.read_along(cycle, &start, rows, FINE.1, along)?;
        let mut own = self.cycle(COARSE.0)?;
        let coarse = self.read_along(&mut own, &start, rows, COARSE.1, along)?;
        for (row, (fine, coarse)) in rows.iter().zip(fine.iter().zip(&coarse)) {
            let rounding = ROUNDINGS * f64::EPSILON;
            let both = apart(fine, coarse, rounding);
            let Some((last, both)) = both.split_last() else {
                continue;
            };
            let by = both.iter().zip(&bends.along);
            let by = by.map(|(by, &[value, error])| by.with(*last, Derivative { value, error }));
            let by: Vec<Derivative> = by.collect();
            told.add_moving(row, fine.value, by);
        }
        Ok(())
    }
}

/// A derivative that is a number.
fn known(place: Option<Derivative>) -> Option<Derivative> {
    place.filter(|place| !place.value.is_nan())
}

impl Sensitivities {
    fn add_moving(&mut self, row: &Row, value: f64, by: Vec<Derivative>) {
        if value.is_nan() {
            return;
        }
        self.moving.push(Measured {
            name: row.name.clone(),
            unit: row.unit.clone(),
            value,
            by,
        });
    }
}

impl Derivative {
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
