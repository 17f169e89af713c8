//! What is asked of a branch, whatever the method that computes its orbits.

use std::sync::Arc;

use super::error::unless_cancelled;
use super::orbit::Orbit;
use crate::cancel::Cancel;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::system::{System, Variable};

/// The system, what is varied, and how far.
#[derive(Clone)]
pub struct Request {
    pub(crate) system: Arc<dyn System>,
    pub(crate) vary: Option<String>,
    pub(crate) omega: Option<f64>,
    pub(crate) from: Option<f64>,
    pub(crate) to: Option<f64>,
    /// Period of the orbits in periods of the declaration, if it was given.
    pub(crate) period: Option<usize>,
    pub(crate) near: Option<Guess>,
    /// Accuracy of the output.
    pub(crate) tolerance: f64,
    pub(crate) max_points: usize,
    pub(crate) largest_step: f64,
    pub(crate) stability: bool,
    /// Ends what is computed.
    pub(crate) cancel: Cancel,
}

/// What is known of the first orbit beforehand.
#[derive(Debug, Clone)]
pub(crate) enum Guess {
    /// Its state at phase zero.
    State(Vec<f64>),
    /// An orbit near it.
    Orbit(Orbit),
}

impl std::fmt::Debug for Request {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Request")
            .field("system", &self.system.facts().name)
            .field("vary", &self.vary)
            .field("from", &self.from)
            .field("to", &self.to)
            .finish_non_exhaustive()
    }
}

impl Request {
    /// Of this system, at the values that its parameters have now.
    pub(crate) fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            vary: None,
            omega: None,
            from: None,
            to: None,
            period: None,
            near: None,
            tolerance: 1e-6,
            max_points: 20_000,
            largest_step: StepControl::default().largest,
            stability: true,
            cancel: Cancel::new(),
        }
    }

    /// Period of the orbits in periods of the declaration: as given, or that of the orbit given.
    pub(crate) fn period(&self) -> usize {
        match (self.period, &self.near) {
            (Some(period), _) => period,
            (None, Some(Guess::Orbit(orbit))) => orbit.period,
            (None, _) => 1,
        }
    }

    /// Name of what is varied.
    pub(crate) fn varied(&self) -> String {
        self.vary.clone().unwrap_or_else(|| "omega".to_owned())
    }

    /// What is varied.
    ///
    /// # Errors
    /// If there is no such parameter.
    pub(crate) fn variable(&self) -> Result<Variable, Error> {
        validate::variable(self.system.facts(), self.vary.as_deref())
    }

    /// Values of the parameters, of which one may be varied.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        let mut parameters = vec![0.0; self.system.facts().parameters.len()];
        self.system.values(&mut parameters);
        parameters
    }

    /// Both ends of the range.
    ///
    /// # Errors
    /// If one was not given.
    pub(crate) fn range(&self) -> Result<[f64; 2], Error> {
        let from = self.from.ok_or(RequestError::no_end("from"))?;
        let to = self.to.ok_or(RequestError::no_end("to"))?;
        Ok([from, to])
    }

    /// Length of the range; zero without one.
    pub(crate) fn length(&self) -> f64 {
        let ends = self.from.zip(self.to);
        ends.map_or(0.0, |(from, to)| (to - from).abs())
    }

    /// The excitation frequency where a parameter is varied; `None` where the frequency is.
    ///
    /// # Errors
    /// If it was not given, or both were.
    pub(crate) fn held_omega(&self, variable: Variable) -> Result<Option<f64>, Error> {
        match (variable, self.omega) {
            (Variable::Omega, None) => Ok(None),
            (Variable::Omega, Some(value)) => Err(RequestError::Option {
                name: "omega",
                value,
                must: "is what is varied: it has its own value",
            }
            .into()),
            (Variable::Parameter(_), None) => Err(RequestError::no_omega().into()),
            (Variable::Parameter(_), Some(omega)) => Ok(Some(omega)),
        }
    }

    /// The same with a token that nobody cancels: for what is asked of a result later.
    pub(crate) fn afterwards(&self) -> Self {
        Self {
            cancel: Cancel::new(),
            ..self.clone()
        }
    }

    /// What a computation gave that began at a value; where it was cancelled, that it was.
    pub(crate) fn unless_cancelled<T>(
        &self,
        value: f64,
        found: Result<T, Error>,
    ) -> Result<T, Error> {
        found.map_err(|error| unless_cancelled(&self.cancel, value, error))
    }

    /// An orbit is one of a system with as many coordinates.
    ///
    /// # Errors
    /// If it is not.
    pub(crate) fn fits(&self, orbit: &Orbit) -> Result<(), Error> {
        let expected = self.system.facts().coordinates.len();
        if orbit.coordinates == expected {
            return Ok(());
        }
        Err(RequestError::State {
            entries: 2 * orbit.coordinates,
            expected: 2 * expected,
        }
        .into())
    }
}
