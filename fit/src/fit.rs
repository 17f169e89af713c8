//! What is asked for: data, what is free, and how.

use std::ops::ControlFlow;
use std::sync::Arc;

use hertzian::{Cancel, System, with_values};

use crate::checks;
use crate::data::DataSet;
use crate::error::FitError;
use crate::problem::Problem;
use crate::result::Fitted;
use crate::search;

/// How residuals count.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Loss {
    /// By their squares: of errors that are normal the most likely parameters.
    #[default]
    Squares,
    /// As squares up to so many standard deviations, and like their size beyond: a few outliers do not draw the curve. Huber (1964).
    Huber(f64),
}

/// A free parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Free {
    pub(crate) name: String,
    pub(crate) range: Option<[f64; 2]>,
    /// Whether each data set has its own.
    pub(crate) own: bool,
}

/// How far a fit is.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// What it does.
    pub stage: Stage,
    /// Curves of all sets that were followed so far, each a trial.
    pub trials: usize,
    /// The smallest root of the mean square of the residuals so far, in standard deviations or, where none are known, in hundredths of the
    /// largest value. Of stages before the last they are those of coarser distances.
    pub rms: f64,
}

/// What a fit does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Tries starts in the ranges.
    Starts,
    /// Moves curves near the data, by distances that both axes count for alike.
    Near,
    /// Fits with the deviations that are stated.
    Fit,
    /// Computes derivatives at every measured value.
    Errors,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Starts => "starts",
            Self::Near => "near",
            Self::Fit => "fit",
            Self::Errors => "errors",
        })
    }
}

/// A fit of parameters to measured curves, set up step by step, then [run](Self::run).
///
/// ```
/// use hertzian_fit::{DataSet, Fit};
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param zeta in 0.0..;
///         param drive;
///         ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
///     }
/// }
///
/// // Of a linear oscillator the amplitude is known.
/// let amplitude = |omega: f64| 0.3 / (1.0 - omega * omega).hypot(0.1 * omega);
/// let omegas: Vec<f64> = (0..12).map(|i| 0.7 + 0.05 * f64::from(i)).collect();
/// let values: Vec<f64> = omegas.iter().map(|&omega| amplitude(omega)).collect();
///
/// let fitted = Fit::of(&Linear { zeta: 0.1, drive: 0.2 })
///     .data(DataSet::new("x:h1", omegas, values))
///     .free("zeta")
///     .free("drive")
///     .run()?;
/// assert!((fitted.estimate("zeta").unwrap().value - 0.05).abs() < 1e-6);
/// assert!((fitted.estimate("drive").unwrap().value - 0.3).abs() < 1e-6);
/// # Ok::<(), hertzian_fit::FitError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fit {
    pub(crate) system: Arc<dyn System>,
    pub(crate) sets: Vec<DataSet>,
    pub(crate) free: Vec<Free>,
    pub(crate) starts: usize,
    pub(crate) loss: Loss,
    pub(crate) cancel: Cancel,
    /// Where unknowns begin, by their names, if not at the values of the system.
    pub(crate) begins: Vec<(String, f64)>,
}

impl Fit {
    /// Of a system, at the values that its parameters have now: those of the free ones are where the fit starts.
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            sets: Vec::new(),
            free: Vec::new(),
            starts: 8,
            loss: Loss::default(),
            cancel: Cancel::new(),
            begins: Vec::new(),
        }
    }

    /// Adds a data set.
    #[must_use]
    pub fn data(mut self, set: DataSet) -> Self {
        self.sets.push(set);
        self
    }

    /// Frees a parameter, within its declared range and up to thirty times its value. Starts are looked for between a third of its value and three
    /// times of it.
    #[must_use]
    pub fn free(self, parameter: impl Into<String>) -> Self {
        self.freed(parameter.into(), None, false)
    }

    /// Frees a parameter within a range, in which starts are looked for too.
    #[must_use]
    pub fn free_in(self, parameter: impl Into<String>, range: [f64; 2]) -> Self {
        self.freed(parameter.into(), Some(range), false)
    }

    /// Frees a parameter of which every data set has a value of its own, such as the level of the drive.
    #[must_use]
    pub fn own(self, parameter: impl Into<String>) -> Self {
        self.freed(parameter.into(), None, true)
    }

    /// As [`own`](Self::own), within a range.
    #[must_use]
    pub fn own_in(self, parameter: impl Into<String>, range: [f64; 2]) -> Self {
        self.freed(parameter.into(), Some(range), true)
    }

    /// A parameter by this name is not free any more: it has the value that the system or the data set gives it.
    #[must_use]
    pub fn fixed(mut self, parameter: &str) -> Self {
        self.free.retain(|free| free.name != parameter);
        self
    }

    /// The same from other estimates, those of each data set's own parameters among them, in the same ranges; nothing else is tried.
    pub(crate) fn from(&self, fitted: &Fitted) -> Self {
        let begins = fitted.estimates.iter();
        Self {
            starts: 1,
            begins: begins.map(|own| (own.name.clone(), own.value)).collect(),
            ..self.clone()
        }
    }

    /// With a parameter at a value, and not free.
    pub(crate) fn held(self, name: &str, value: f64) -> Self {
        let mut values = checks::values_of(&self.system);
        for (place, facts) in self.system.facts().parameters.iter().enumerate() {
            if facts.name == name {
                values[place] = value;
            }
        }
        let system = with_values(&self.system, values);
        Self {
            system,
            ..self.fixed(name)
        }
    }

    fn freed(mut self, name: String, range: Option<[f64; 2]>, own: bool) -> Self {
        self = self.fixed(&name);
        self.free.push(Free { name, range, own });
        self
    }

    /// Starts from so many places at most: the values of the system, and if that leads nowhere others spread over the ranges, of which the best are
    /// gone on with. Default: 8.
    #[must_use]
    pub fn starts(mut self, count: usize) -> Self {
        self.starts = count;
        self
    }

    /// How residuals count. Default: by their squares.
    #[must_use]
    pub fn loss(mut self, loss: Loss) -> Self {
        self.loss = loss;
        self
    }

    /// The fit ends when this token is cancelled, with the best parameters until then.
    #[must_use]
    pub fn cancel(mut self, cancel: &Cancel) -> Self {
        self.cancel = cancel.clone();
        self
    }

    /// Fits.
    ///
    /// # Errors
    /// If data or parameters cannot be used, or from no start curves can be followed.
    pub fn run(&self) -> Result<Fitted, FitError> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `told` at every trial. To break off keeps the best parameters until then.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut told: impl FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Fitted, FitError> {
        let mut problem = Problem::new(self)?;
        search::run(&mut problem, &mut told)
    }
}
