//! What is asked of a branch, whatever the method that computes its orbits.

use std::sync::Arc;

use super::branch::Branch;
use super::checkpoint::Keep;
use super::error::unless_cancelled;
use super::orbit::Orbit;
use crate::cancel::Cancel;
use crate::continuation::step_control::StepControl;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::{self, validate};
use crate::system::{System, Variable};

/// The system, what is varied, and how far.
#[derive(Debug, Clone)]
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
    /// Keeps what is computed.
    pub(crate) keep: Option<Arc<dyn Keep>>,
}

/// What is asked for beside the system.
#[cfg(feature = "serde")]
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Options {
    vary: Option<String>,
    #[serde(with = "crate::serialise")]
    omega: Option<f64>,
    #[serde(with = "crate::serialise")]
    from: Option<f64>,
    #[serde(with = "crate::serialise")]
    to: Option<f64>,
    period: Option<usize>,
    near: Option<Guess>,
    #[serde(with = "crate::serialise")]
    tolerance: f64,
    max_points: usize,
    #[serde(with = "crate::serialise")]
    largest_step: f64,
    stability: bool,
}

/// What is known of the first orbit beforehand.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub(crate) enum Guess {
    /// Its state at phase zero.
    State(#[cfg_attr(feature = "serde", serde(with = "crate::serialise"))] Vec<f64>),
    /// An orbit near it.
    Orbit(Orbit),
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
            keep: None,
        }
    }

    /// What is asked for beside the system.
    #[cfg(feature = "serde")]
    pub(crate) fn options(&self) -> Options {
        Options {
            vary: self.vary.clone(),
            omega: self.omega,
            from: self.from,
            to: self.to,
            period: self.period,
            near: self.near.clone(),
            tolerance: self.tolerance,
            max_points: self.max_points,
            largest_step: self.largest_step,
            stability: self.stability,
        }
    }

    /// The same of a system. They may have been read from a file.
    ///
    /// # Errors
    /// If the orbit near which the first one is to be is none of the system.
    #[cfg(feature = "serde")]
    pub(crate) fn with(system: &dyn System, options: Options) -> Result<Self, Error> {
        let request = Self {
            vary: options.vary,
            omega: options.omega,
            from: options.from,
            to: options.to,
            period: options.period,
            near: options.near,
            tolerance: options.tolerance,
            max_points: options.max_points,
            largest_step: options.largest_step,
            stability: options.stability,
            ..Self::of(system)
        };
        if let Some(Guess::Orbit(orbit)) = &request.near {
            request.fits(orbit)?;
        }
        Ok(request)
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
        model::values(&self.system)
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
            keep: None,
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

    /// The same of a branch, which is kept to its end; where it could not be kept, why.
    pub(crate) fn unless_lost(
        &self,
        value: f64,
        found: Result<Branch, Error>,
    ) -> Result<Branch, Error> {
        let found = self.unless_cancelled(value, found);
        let Some(keep) = &self.keep else {
            return found;
        };
        let ended = found.as_ref().is_ok_and(|branch| keep.end(branch));
        match keep.failure().filter(|_| !ended) {
            Some(failure) => Err(failure),
            None => found,
        }
    }

    /// The same, kept by nothing.
    pub(crate) fn unkept(&self) -> Self {
        Self {
            keep: None,
            ..self.clone()
        }
    }

    /// An orbit is one of a system with as many coordinates.
    ///
    /// # Errors
    /// If it is not.
    pub(crate) fn fits(&self, orbit: &Orbit) -> Result<(), Error> {
        let expected = self.system.facts().coordinates.len();
        if orbit.is_of(expected) {
            return Ok(());
        }
        Err(RequestError::State {
            entries: 2 * orbit.coordinates,
            expected: 2 * expected,
        }
        .into())
    }
}
