//! What was asked for, checked before any work.

use std::sync::Arc;

use super::options::Shooting;
use super::problem::{ShootingProblem, Source};
use crate::balance::symmetry::{Over, Permutations};
use crate::branches::point::Point;
use crate::branches::request::{Guess, Request};
use crate::continuation::step_control;
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::Layout;
use crate::model::request::RequestError;
use crate::model::rigid::centre::Centre;
use crate::model::rigid::{self, Place};
use crate::model::validate;
use crate::system::Variable;
use crate::time;
use crate::time::affine::Affine;
use crate::time::centred::centred;

/// The dense matrix of more unknowns would take more than 300 megabytes.
const MOST_UNKNOWNS: usize = 6000;

/// What was asked for.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'r> {
    pub(crate) request: &'r Request,
    pub(crate) shooting: &'r Shooting,
    /// Systems that turn freely are refused.
    held: bool,
}

impl<'r> Asked<'r> {
    pub(crate) fn of(request: &'r Request, shooting: &'r Shooting) -> Self {
        Self {
            request,
            shooting,
            held: false,
        }
    }

    /// The same for a method whose equations are singular where nothing holds a system.
    pub(crate) fn held(self) -> Self {
        Self { held: true, ..self }
    }

    /// An orbit that is given is one of this system, and its value is that of what is varied here.
    pub(crate) fn belongs(&self, point: &Point) -> Result<(), Error> {
        let facts = self.request.system.facts();
        let expected = 2 * facts.coordinates.len();
        let entries = 2 * point.orbit.coordinates;
        if entries != expected {
            return Err(RequestError::State { entries, expected }.into());
        }
        let (values, expected) = (point.parameters.len(), facts.parameters.len());
        if values != expected {
            return Err(RequestError::Values { values, expected }.into());
        }
        let variable = self.request.variable()?;
        let varied = match variable {
            Variable::Omega => point.orbit.omega,
            Variable::Parameter(index) => point.parameters[index],
        };
        if varied != point.value {
            let name = self.request.varied();
            let must = "must be what the branch of the event or orbit varies";
            return Err(RequestError::Varied { name, must }.into());
        }
        let held = self.request.parameters();
        let pairs = held.iter().zip(&point.parameters).enumerate();
        for (index, (value, of_cycle)) in pairs {
            if value != of_cycle && variable != Variable::Parameter(index) {
                return Err(RequestError::Parameter {
                    name: facts.parameters[index].name.to_string(),
                    value: *value,
                    range: format!("[{of_cycle}, {of_cycle}], that of the event or orbit"),
                }
                .into());
            }
        }
        match self
            .request
            .omega
            .filter(|omega| *omega != point.orbit.omega)
        {
            Some(value) if variable != Variable::Omega => Err(RequestError::Option {
                name: "omega",
                value,
                must: "must be that of the event or orbit",
            }
            .into()),
            _ => Ok(()),
        }
    }

    /// The range, and everything else that was asked for, checked.
    pub(crate) fn ranged(&self) -> Result<([f64; 2], ShootingProblem), Error> {
        let [from, to] = self.request.range()?;
        let problem = self.problem(from, to)?;
        validate::range(self.request.system.facts(), problem.variable, from, to)?;
        Ok(([from, to], problem))
    }

    /// Checks everything that was asked for.
    pub(crate) fn problem(&self, from: f64, to: f64) -> Result<ShootingProblem, Error> {
        let facts = self.request.system.facts();
        if facts.coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        self.check_options()?;
        let variable = self.request.variable()?;
        let mut parameters = self.request.parameters();
        let given = self.request.held_omega(variable)?;
        for value in [to, from] {
            let omega = validate::omega(given.unwrap_or(value))?;
            if let Variable::Parameter(index) = variable {
                parameters[index] = value;
            }
            validate::parameters(facts, &parameters)?;
            validate::levels(self.request.system.as_ref(), &parameters, omega)?;
            validate::mass(self.request.system.as_ref(), &parameters, omega)?;
        }
        let omega = given.unwrap_or(from);
        let layout = Layout::of(self.request.system.as_ref());
        let range = [from, to];
        let place = Place {
            system: self.request.system.as_ref(),
            layout: &layout,
            parameters: &parameters,
            omega,
            variable,
        };
        let centre = if self.held {
            rigid::none(place, range)?;
            None
        } else {
            Centre::over(place, range)?
        };
        let over = Over { place, range };
        let Permutations { at_once, later } = over.permutations();
        let mut symmetries = vec![over.cyclic()];
        symmetries.extend(later);
        Ok(ShootingProblem {
            system: Arc::clone(&self.request.system),
            source: self.source(&parameters, omega),
            varied: self.request.varied(),
            parameters,
            omega,
            variable,
            divisor: facts.divisor,
            period: self.request.period(),
            segments: self.shooting.segments.unwrap_or(self.request.period()),
            rigid: centre.map_or(0, |centre| centre.multipliers()),
            symmetries,
            at_once,
            stability: self.request.stability,
            accuracy: self.shooting.accuracy,
            points: step_control::max_points(self.request.max_points)?,
            steps: step_control::largest_step(self.request.largest_step)?,
            cancel: self.request.cancel.clone(),
            keep: self.request.keep.clone(),
        })
    }

    /// The tolerance of the flow.
    fn tolerance(&self) -> f64 {
        self.shooting.flow_tolerance(self.request.tolerance)
    }

    /// Checks the numbers among the options.
    fn check_options(&self) -> Result<(), Error> {
        let coordinates = self.request.system.facts().coordinates.len();
        let segments = self.shooting.segments.unwrap_or(self.request.period());
        for (name, value, range, must) in [
            (
                "period",
                self.request.period() as f64,
                1.0..=1000.0,
                "must be from 1 to 1000",
            ),
            (
                "tolerance",
                self.request.tolerance,
                1e-12..=1e-1,
                "must be from 1e-12 to 0.1",
            ),
            (
                "tolerance of the flow",
                self.tolerance(),
                1e-14..=1e-3,
                "must be from 1e-14 to 1e-3",
            ),
            (
                "segments",
                segments as f64,
                1.0..=(MOST_UNKNOWNS / (2 * coordinates)) as f64,
                "must be at least 1, and 3000 at most, divided by the number of coordinates",
            ),
        ] {
            validate::option(name, value, range, must)?;
        }
        let (entries, state) = match &self.request.near {
            None => return Ok(()),
            Some(Guess::State(state)) => (state.len(), &state[..]),
            Some(Guess::Orbit(orbit)) => (2 * orbit.coordinates, &[][..]),
        };
        if entries != 2 * coordinates {
            let expected = 2 * coordinates;
            return Err(RequestError::State { entries, expected }.into());
        }
        let bad = state.iter().find(|x| !x.is_finite());
        bad.map_or(Ok(()), |&value| {
            Err(RequestError::Option {
                name: "near_state",
                value,
                must: "must be finite",
            }
            .into())
        })
    }

    /// Where flows of the system come from.
    fn source(&self, parameters: &[f64], omega: f64) -> Source {
        let system = Arc::clone(&self.request.system);
        let parameters = parameters.to_vec();
        let exact = Affine::new(&system, &parameters, omega).is_ok();
        let cancel = self.request.cancel.clone();
        Source {
            make: Box::new(move |tolerance| {
                let mut flow = time::at(&system, &parameters, omega, tolerance)?;
                flow.until(&cancel);
                Ok(centred(flow, &system, &parameters, omega))
            }),
            exact,
            tolerance: self.tolerance(),
        }
    }
}
