//! What was asked for, checked before any work.

use std::sync::Arc;

use super::cycle::Cycle;
use super::request::Shooting;
use super::setting::{Setting, Source};
use super::start::Guess;
use crate::balance::symmetry::Over;
use crate::continuation::step;
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::labels::Labels;
use crate::model::layout::Layout;
use crate::model::request::RequestError;
use crate::model::rigid::{self, Place};
use crate::model::validate;
use crate::response::FrequencyResponse;
use crate::system::Variable;
use crate::time;
use crate::time::MotionError;
use crate::time::Options;
use crate::time::affine::Affine;
use crate::time::stroboscope::Stroboscope;

/// The dense matrix of more unknowns would take more than 300 megabytes.
const MOST_UNKNOWNS: usize = 6000;

impl Shooting {
    /// An orbit that is given is one of this system, and its value is that of what is varied here.
    pub(super) fn belongs(&self, cycle: &Cycle) -> Result<(), Error> {
        let facts = self.system.facts();
        let expected = 2 * facts.coordinates.len();
        let entries = 2 * cycle.extremes.len();
        if entries != expected {
            return Err(RequestError::State { entries, expected }.into());
        }
        let (values, expected) = (cycle.parameters.len(), facts.parameters.len());
        if values != expected {
            return Err(RequestError::Values { values, expected }.into());
        }
        let variable = validate::variable(facts, self.vary.as_deref())?;
        let varied = match variable {
            Variable::Omega => cycle.omega,
            Variable::Parameter(index) => cycle.parameters[index],
        };
        if varied != cycle.value {
            let name = self.vary.clone().unwrap_or_else(|| "omega".to_owned());
            let must = "must be what the branch of the event or orbit varies";
            return Err(RequestError::Varied { name, must }.into());
        }
        let mut held = vec![0.0; facts.parameters.len()];
        self.system.values(&mut held);
        let pairs = held.iter().zip(&cycle.parameters).enumerate();
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
        match self.omega.filter(|omega| *omega != cycle.omega) {
            Some(value) if variable != Variable::Omega => Err(RequestError::Option {
                name: "omega",
                value,
                must: "must be that of the event or orbit",
            }
            .into()),
            _ => Ok(()),
        }
    }

    /// The states of an orbit at the beginnings of its periods of the declaration, the first of which it is given by.
    pub(crate) fn returns(&self, cycle: &Cycle) -> Result<Vec<Vec<f64>>, Error> {
        let tolerance = self.tolerance;
        let flow = time::at(
            &self.system,
            &cycle.parameters,
            cycle.omega,
            Options::default().tolerance(tolerance).cancel(&self.cancel),
        )?;
        let mut map = Stroboscope::new(flow);
        let mut state = cycle.state().to_vec();
        let mut states = vec![state.clone()];
        for _ in 1..cycle.period {
            let value = cycle.value;
            map.map(&mut state)
                .map_err(|reason| MotionError { value, reason })?;
            states.push(state.clone());
        }
        Ok(states)
    }

    /// Length of the range; zero without one.
    pub(crate) fn length(&self) -> f64 {
        let ends = self.from.zip(self.to);
        ends.map_or(0.0, |(from, to)| (to - from).abs())
    }

    /// The range, and everything else that was asked for, checked.
    pub(super) fn ranged(&self) -> Result<([f64; 2], Setting), Error> {
        let from = self.from.ok_or(RequestError::Missing { name: "from" })?;
        let to = self.to.ok_or(RequestError::Missing { name: "to" })?;
        let setting = self.setting(from, to)?;
        validate::range(self.system.facts(), setting.variable, from, to)?;
        Ok(([from, to], setting))
    }

    /// Checks everything that was asked for.
    pub(super) fn setting(&self, from: f64, to: f64) -> Result<Setting, Error> {
        let facts = self.system.facts();
        if facts.coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        self.check_options()?;
        let variable = validate::variable(facts, self.vary.as_deref())?;
        let mut parameters = vec![0.0; facts.parameters.len()];
        self.system.values(&mut parameters);
        let given = match (variable, self.omega) {
            (Variable::Omega, None) => None,
            (Variable::Omega, Some(value)) => {
                let must = "is what is varied: it has its own value";
                return Err(RequestError::Option {
                    name: "omega",
                    value,
                    must,
                }
                .into());
            }
            (Variable::Parameter(_), None) => {
                return Err(RequestError::Missing { name: "omega" }.into());
            }
            (Variable::Parameter(_), Some(omega)) => Some(omega),
        };
        for value in [to, from] {
            let omega = validate::omega(given.unwrap_or(value))?;
            if let Variable::Parameter(index) = variable {
                parameters[index] = value;
            }
            validate::parameters(facts, &parameters)?;
            validate::levels(self.system.as_ref(), &parameters, omega)?;
            validate::mass(self.system.as_ref(), &parameters, omega)?;
        }
        let omega = given.unwrap_or(from);
        let layout = Layout::of(self.system.as_ref());
        let range = [from, to];
        let place = Place {
            system: self.system.as_ref(),
            layout: &layout,
            parameters: &parameters,
            omega,
            variable,
        };
        rigid::none(place, range)?;
        let over = Over {
            system: self.system.as_ref(),
            layout: &layout,
            parameters: &parameters,
            omega,
            variable,
            range,
        };
        let odd = over.is_odd();
        let varied = self.vary.clone().unwrap_or_else(|| "omega".to_owned());
        Ok(Setting {
            source: self.source(&parameters, omega),
            labels: Labels::of(facts, &varied, &parameters, omega),
            varied,
            parameters,
            omega,
            variable,
            divisor: facts.divisor,
            period: self.period,
            segments: self.segments.unwrap_or(self.period),
            odd: odd && !self.period.is_multiple_of(2),
            stability: self.stability,
            points: step::max_points(self.max_points)?,
            steps: step::largest_step(self.largest_step)?,
            cancel: self.cancel.clone(),
        })
    }

    /// Checks the numbers among the options.
    fn check_options(&self) -> Result<(), Error> {
        let coordinates = self.system.facts().coordinates.len();
        let segments = self.segments.unwrap_or(self.period);
        for (name, value, range, must) in [
            (
                "period",
                self.period as f64,
                1.0..=1000.0,
                "must be from 1 to 1000",
            ),
            (
                "tolerance",
                self.tolerance,
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
        let (entries, state) = match &self.near {
            None => return Ok(()),
            Some(Guess::State(state)) => (state.len(), &state[..]),
            Some(Guess::Series(orbit)) => (2 * orbit.coordinates, &[][..]),
        };
        if entries != 2 * coordinates {
            let expected = 2 * coordinates;
            return Err(RequestError::State { entries, expected }.into());
        }
        let bad = state.iter().find(|x| !x.is_finite());
        bad.map_or(Ok(()), |&value| {
            Err(RequestError::Option {
                name: "near",
                value,
                must: "must be finite",
            }
            .into())
        })
    }

    /// Where flows of the system come from.
    fn source(&self, parameters: &[f64], omega: f64) -> Source {
        let system = Arc::clone(&self.system);
        let parameters = parameters.to_vec();
        let exact = Affine::new(&system, &parameters, omega).is_ok();
        let cancel = self.cancel.clone();
        Source {
            make: Box::new(move |tolerance| {
                let options = Options::default().tolerance(tolerance).cancel(&cancel);
                time::at(&system, &parameters, omega, options)
            }),
            exact,
            tolerance: self.tolerance,
        }
    }

    /// What the orbit at a value is near.
    pub(super) fn guess(&self, value: f64) -> Result<Guess, Error> {
        if let Some(guess) = &self.near {
            return Ok(guess.clone());
        }
        let mut request = FrequencyResponse::of(&self.system)
            .period(self.period)
            .stability(false)
            .cancel(&self.cancel);
        if let (Some(name), Some(omega)) = (&self.vary, self.omega) {
            request = request.vary(name).omega(omega);
        }
        Ok(Guess::Series(request.orbit(value)?.orbit))
    }
}
