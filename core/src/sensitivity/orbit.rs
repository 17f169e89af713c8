//! Derivatives of what is read off one orbit, at a fixed value of what is varied.
//!
//! Everything is computed by two flows and two rules of quadrature, and errors are told by what the coarser ones change. The quick way
//! takes one flow that is coarser still, and tells none.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::change::{Centre, Crossed};
use super::cycle::{Cycle, Evaluated};
use super::error::SensitivityError;
use super::moments::Slope;
use super::reader::{Along, Reader};
use super::rows::{Row, needs};
use super::sample_phases::Places;
use super::slopes::Slopes;
use super::slopes::signals::Asked;
use super::{Measured, Missing, Sensitivities, multipliers};
use crate::branches::branch::{Branch, Model};
use crate::branches::point::Point;
use crate::cancel::Cancel;
use crate::error::{Error, ErrorKind};
use crate::model::request::RequestError;
use crate::numeric::estimate::Estimate;
use crate::orbit::observe::Measure;
use crate::system::{System, Variable};

/// Tolerance of the flow and nodes of a rule, and those that errors are told by.
pub(super) const FINE: (f64, usize) = (1e-12, 24);
pub(super) const COARSE: (f64, usize) = (1e-10, 16);
/// The flow that errors of events are told by: second derivatives are differenced, and noise of a coarser one would be all that is seen.
pub(super) const BESIDE: (f64, usize) = (1e-11, 16);
/// Those where no errors are asked for.
const QUICK: (f64, usize) = (1e-9, 24);
/// Roundings of a derivative, times the condition of the equations.
pub(super) const ROUNDINGS: f64 = 8.0;

/// An orbit of a system whose derivatives are asked for.
pub(super) struct Sensitive<'p> {
    system: Arc<dyn System>,
    model: Model,
    pub(super) point: &'p Point,
    pub(super) varied: Variable,
    name: String,
    pub(super) variables: Vec<Variable>,
    cancel: Cancel,
}

/// States of an orbit, and the value of what is varied.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub(super) states: Vec<f64>,
    pub(super) value: f64,
}

/// What is read off by one flow and one rule.
pub(super) struct Read {
    slopes: Vec<Slope>,
    condition: f64,
    /// The equations, what is crossed in which order, and the directions that were read along.
    evaluated: Evaluated,
    crossed: Crossed,
    along: Vec<Along>,
}

/// What is read off by two flows; nothing of the coarser one where that fails, which leaves errors unknown.
pub(super) struct Both {
    fine: Read,
    coarse: Option<Read>,
}

/// What was computed; nothing if it failed.
///
/// # Errors
/// If it was cancelled.
pub(super) fn unless_cancelled<T>(computed: Result<T, Error>) -> Result<Option<T>, Error> {
    match computed {
        Ok(computed) => Ok(Some(computed)),
        Err(error) if error.kind() == ErrorKind::Cancelled => Err(error),
        Err(_) => Ok(None),
    }
}

/// An error that is no number is one of which nothing is known.
pub(super) fn finite(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error }
}

impl<'p> Sensitive<'p> {
    /// At an orbit of a branch.
    ///
    /// # Errors
    /// If the branch has no model, or is a backbone, along which the frequency is not fixed.
    pub(super) fn of(branch: &Branch, point: &'p Point) -> Result<Self, Error> {
        branch.is_no_backbone()?;
        let system = branch.system().ok_or(RequestError::Detached)?.shared();
        let parameters = 0..system.facts().parameters.len();
        let facts = &system.facts().parameters;
        let varied = facts.iter().position(|facts| facts.name == branch.varied);
        Ok(Self {
            variables: std::iter::once(Variable::Omega)
                .chain(parameters.map(Variable::Parameter))
                .collect(),
            model: Model::of(system.as_ref()),
            varied: varied.map_or(Variable::Omega, Variable::Parameter),
            name: branch.varied.clone(),
            point,
            system,
            cancel: Cancel::new(),
        })
    }

    /// By variables of these names alone.
    ///
    /// # Errors
    /// If there is no such variable.
    pub(super) fn only_by(mut self, names: &[&str]) -> Result<Self, Error> {
        let variables = names.iter().map(|name| self.variable(name));
        self.variables = variables.collect::<Result<_, Error>>()?;
        Ok(self)
    }

    /// What has a name: the frequency, or a parameter.
    fn variable(&self, name: &str) -> Result<Variable, Error> {
        let mut parameters = self.model.parameters.iter();
        let index = parameters.position(|parameter| parameter.name == name);
        let known = self.model.parameters.iter();
        let unknown = || RequestError::UnknownParameter {
            name: name.to_owned(),
            known: known.map(|parameter| parameter.name.clone()).collect(),
        };
        match index {
            None if name == "omega" => Ok(Variable::Omega),
            None => Err(unknown().into()),
            Some(index) => Ok(Variable::Parameter(index)),
        }
    }

    pub(super) fn system(&self) -> &Arc<dyn System> {
        &self.system
    }

    /// The equations by a flow of a tolerance.
    ///
    /// # Errors
    /// If there is no flow.
    pub(super) fn cycle(&self, tolerance: f64) -> Result<Cycle, Error> {
        let point = self.point;
        let (values, orbit) = (&point.parameters, &point.orbit);
        Cycle::new(
            &self.system,
            values,
            orbit,
            self.varied,
            tolerance,
            &self.cancel,
        )
    }

    /// What is known of the orbit.
    ///
    /// # Errors
    /// If its motion cannot be continued.
    pub(super) fn start(&self, cycle: &mut Cycle) -> Result<Start, SensitivityError> {
        Ok(Start {
            states: cycle.states(&self.point.orbit)?,
            value: self.point.value,
        })
    }

    /// Nothing yet, of a place on the branch.
    pub(super) fn told(&self, condition: f64) -> Sensitivities {
        let named = |variable: &Variable| match variable {
            Variable::Omega => "omega".to_owned(),
            Variable::Parameter(index) => self.model.parameters[*index].name.clone(),
        };
        let value = |variable: &Variable| match variable {
            Variable::Omega => self.point.orbit.omega,
            Variable::Parameter(index) => self.point.parameters[*index],
        };
        Sensitivities {
            variables: self.variables.iter().map(named).collect(),
            values: self.variables.iter().map(value).collect(),
            varied: self.name.clone(),
            kind: None,
            place: Vec::new(),
            measured: Vec::new(),
            moving: Vec::new(),
            missing: Vec::new(),
            condition,
        }
    }

    /// By one flow, without errors.
    pub(super) fn quick(&self, rows: &[Row]) -> Result<Sensitivities, Error> {
        let mut cycle = self.cycle(QUICK.0)?;
        let mut start = self.start(&mut cycle)?;
        self.settle(&mut cycle, &mut start)?;
        let vanishes = cycle.vanishes();
        let read = self.read(&mut cycle, &start, rows, QUICK.1, vanishes)?;
        let mut told = self.told(read.condition);
        for (row, slope) in rows.iter().zip(read.slopes) {
            let by = slope.by.into_iter().map(|value| Estimate {
                value,
                error: f64::INFINITY,
            });
            told.add(row, slope.value, by.collect());
        }
        Ok(told)
    }

    /// By two flows, with errors.
    pub(super) fn of_point(&self, rows: &[Row]) -> Result<Sensitivities, Error> {
        let mut cycle = self.cycle(FINE.0)?;
        let mut start = self.start(&mut cycle)?;
        self.settle(&mut cycle, &mut start)?;
        let (told, _) = self.at(&mut cycle, &start, &start, rows)?;
        Ok(told)
    }

    /// The same at an orbit of the fine flow, and near another place by the coarse one: at an event, that at which the event is by another flow.
    pub(super) fn at(
        &self,
        cycle: &mut Cycle,
        start: &Start,
        near: &Start,
        rows: &[Row],
    ) -> Result<(Sensitivities, Both), Error> {
        let vanishes = cycle.vanishes();
        let fine = self.read(cycle, start, rows, FINE.1, vanishes)?;
        // The finer flow has decided what vanishes.
        let coarse = if cycle.is_closed_form() {
            // Another tolerance changes nothing: what is left are the nodes.
            self.read(cycle, start, rows, COARSE.1, 0.0)
        } else {
            let mut near = near.clone();
            self.cycle(COARSE.0).and_then(|mut own| {
                self.settle(&mut own, &mut near)?;
                self.read(&mut own, &near, rows, COARSE.1, 0.0)
            })
        };
        let coarse = unless_cancelled(coarse)?;
        let rounding = ROUNDINGS * f64::EPSILON / fine.condition;
        let mut told = self.told(fine.condition);
        for (index, (row, fine)) in rows.iter().zip(&fine.slopes).enumerate() {
            let coarse = coarse.as_ref().map(|coarse| &coarse.slopes[index]);
            let by = apart(fine, coarse, rounding);
            let by = rounded(by, fine.value, &told.values);
            told.add(row, fine.value, by);
        }
        Ok((told, Both { fine, coarse }))
    }

    /// And multipliers.
    pub(super) fn with_multipliers(&self, rows: &[Row]) -> Result<Sensitivities, Error> {
        let mut cycle = self.cycle(FINE.0)?;
        let mut start = self.start(&mut cycle)?;
        self.settle(&mut cycle, &mut start)?;
        let (mut told, read) = self.at(&mut cycle, &start, &start, rows)?;
        self.add_multipliers(&mut cycle, &start, &read, &mut told)?;
        Ok(told)
    }

    /// Adds the derivatives of all multipliers at a fixed value of what is varied, or says why there are none.
    pub(super) fn add_multipliers(
        &self,
        cycle: &mut Cycle,
        start: &Start,
        Both { fine, coarse }: &Both,
        told: &mut Sensitivities,
    ) -> Result<(), Error> {
        let along = fine.along.iter().enumerate();
        let directions: Vec<(&Along, Option<&Along>)> = along
            .map(|(index, fine)| (fine, coarse.as_ref().map(|coarse| &coarse.along[index])))
            .collect();
        let (states, variables) = (&start.states, &self.variables);
        let crossed = fine.crossed.clone();
        let centre = Centre::known(cycle, states, variables, &fine.evaluated, crossed);
        let matrices = cycle.matrices(&fine.evaluated);
        match multipliers::add(cycle, &centre, &matrices, &directions, told) {
            Ok(()) => {}
            Err(error) if error.is_cancelled() => return Err(error.into()),
            Err(error) => told
                .missing
                .push(Missing::new("multipliers", error.to_string())),
        }
        Ok(())
    }

    /// Finds the orbit by another flow, at a fixed value of what is varied.
    pub(super) fn settle(
        &self,
        cycle: &mut Cycle,
        start: &mut Start,
    ) -> Result<(), SensitivityError> {
        cycle.set(self.varied, start.value)?;
        cycle.solve(&mut start.states)
    }

    /// (2) of [`cycle`](super::cycle), by each variable.
    fn directions(&self, evaluated: &Evaluated) -> Result<Vec<Along>, SensitivityError> {
        let lu = evaluated.jacobian.clone().lu();
        let count = self.variables.len();
        let along = (0..count).map(|index| {
            let moved = lu.solve(&-&evaluated.by[index]);
            let mut weights = vec![0.0; count];
            weights[index] = 1.0;
            moved
                .map(|states| Along { states, weights })
                .ok_or(SensitivityError::Singular)
        });
        along.collect()
    }

    /// What is read off an orbit, by every variable at a fixed value of all others; a harmonic vanishes below a part of the effective value.
    fn read(
        &self,
        cycle: &mut Cycle,
        start: &Start,
        rows: &[Row],
        nodes: usize,
        vanishes: f64,
    ) -> Result<Read, Error> {
        let (slopes, places) = self.looked_at(cycle, start, rows, nodes)?;
        let evaluated = cycle.evaluate(&start.states, &self.variables, &places.stops)?;
        let along = self.directions(&evaluated)?;
        let condition = condition(&cycle.scaled(&evaluated.jacobian))?;
        let reader = Reader::new(&places, &slopes, &evaluated, &self.variables, &along, cycle);
        let slopes = self.rows_of(&reader, &slopes, rows, vanishes);
        let arcs = places.scan.arcs.into_iter();
        Ok(Read {
            slopes,
            condition,
            evaluated,
            crossed: arcs.map(|arc| (arc.segment, arc.pieces)).collect(),
            along,
        })
    }

    /// The same along directions that are known.
    pub(super) fn read_along(
        &self,
        cycle: &mut Cycle,
        start: &Start,
        rows: &[Row],
        nodes: usize,
        along: &[Along],
        vanishes: f64,
    ) -> Result<Vec<Slope>, Error> {
        cycle.set(self.varied, start.value)?;
        let (slopes, places) = self.looked_at(cycle, start, rows, nodes)?;
        let evaluated = cycle.evaluate(&start.states, &self.variables, &places.stops)?;
        let reader = Reader::new(&places, &slopes, &evaluated, &self.variables, along, cycle);
        Ok(self.rows_of(&reader, &slopes, rows, vanishes))
    }

    /// The signals of rows, and where they are looked at.
    fn looked_at(
        &self,
        cycle: &mut Cycle,
        start: &Start,
        rows: &[Row],
        nodes: usize,
    ) -> Result<(Slopes, Places), Error> {
        let mut asked: Vec<Asked> = Vec::new();
        for row in rows {
            if !asked.contains(&row.asked) {
                asked.push(row.asked);
            }
        }
        let mut slopes = Slopes::new(&self.system, &asked);
        slopes.set(&cycle.values, cycle.omega);
        let places = Places::of(cycle, &slopes, &start.states, needs(rows, &asked, nodes))?;
        Ok((slopes, places))
    }

    fn rows_of(
        &self,
        reader: &Reader<'_>,
        slopes: &Slopes,
        rows: &[Row],
        vanishes: f64,
    ) -> Vec<Slope> {
        let moments = reader.moments();
        let directions = reader.directions.len();
        let measured = rows.iter().map(|row| {
            let none = || Slope {
                value: f64::NAN,
                by: vec![f64::NAN; directions],
            };
            if let (Measure::OnPiece(piece), Asked::Contact(contact)) = (row.measure, row.asked) {
                let pieces = self.model.pieces[contact];
                return reader.on_pieces(contact, pieces)[piece - 1].clone();
            }
            let own = slopes.position(row.asked).map(|signal| &moments[signal]);
            let measured = match row.measure {
                Measure::Impulse => own.map(|own| reader.over_period(&own.mean)),
                measure => own.and_then(|own| own.measure(measure, vanishes)),
            };
            measured.unwrap_or_else(none)
        });
        measured.collect()
    }
}

impl Sensitivities {
    /// Adds what was read off.
    pub(super) fn add(&mut self, row: &Row, value: f64, by: Vec<Estimate>) {
        let measured = self.known(row, value, by);
        self.measured.extend(measured);
    }

    /// What was read off. An amplitude that vanishes has no derivative, nor has its phase, nor an extreme of what is at rest; and one that is another
    /// one to each side is none: that is said.
    pub(super) fn known(&mut self, row: &Row, value: f64, by: Vec<Estimate>) -> Option<Measured> {
        if value.is_nan() {
            let why = "it is of a motion that vanishes, where it has no derivative";
            self.missing.push(Missing::new(&row.name, why));
            return None;
        }
        for (variable, _) in (self.variables.iter().zip(&by)).filter(|(_, by)| by.value.is_nan()) {
            let why = "it has another derivative to each side: its largest and its smallest value are of one size, or several gaps switch at once";
            let what = format!("{} by {variable}", row.name);
            self.missing.push(Missing::new(what, why));
        }
        Some(Measured {
            name: row.name.clone(),
            unit: row.unit.clone(),
            value,
            by,
        })
    }
}

/// Derivatives by two flows: the fine ones, with errors told by the coarse ones, if there are any.
pub(super) fn apart(fine: &Slope, coarse: Option<&Slope>, rounding: f64) -> Vec<Estimate> {
    let largest = fine.by.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let by = fine.by.iter().enumerate().map(|(index, &value)| {
        let apart = coarse.map_or(f64::INFINITY, |coarse| (value - coarse.by[index]).abs());
        Estimate {
            value,
            error: finite(apart + rounding * (value.abs() + f64::EPSILON * largest)),
        }
    });
    by.collect()
}

/// With rounding of what a derivative is the sum of, which may be left of it alone: each part is about the value divided by the variable.
fn rounded(mut by: Vec<Estimate>, value: f64, variables: &[f64]) -> Vec<Estimate> {
    for (by, variable) in by.iter_mut().zip(variables) {
        let part = (value / variable).abs();
        if part.is_finite() {
            by.error += ROUNDINGS * f64::EPSILON * part;
        }
    }
    by
}

/// How far equations in units of states are from singular ones, as a part of their size.
pub(super) fn condition(jacobian: &DMatrix<f64>) -> Result<f64, SensitivityError> {
    let inverse = jacobian.clone().lu().try_inverse();
    let inverse = inverse.ok_or(SensitivityError::Singular)?;
    Ok(1.0 / (jacobian.norm() * inverse.norm()))
}
