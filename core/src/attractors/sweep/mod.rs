//! Bifurcation diagrams by brute force: what a motion settles to as a parameter or the frequency changes in steps.
//!
//! At every value the motion goes on from the last state of the value before, so that it stays with its attractor as long as
//! there is one: a sweep up and a sweep down show hysteresis.

mod compute;
#[cfg(test)]
mod tests;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use super::log::Log;
use super::request::Request;
use crate::branches::progress::Progress;
use crate::cancel::Cancel;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::{self, validate};
use crate::system::{System, Variable};
use crate::time::FlowError;
use crate::time::poincare::Section;
use crate::time::stroboscope::Stroboscope;

/// What is seen at more values would not fit into memory well.
const MOST_VALUES: usize = 1 << 24;

/// A bifurcation diagram by brute force: set up step by step, then [run](Sweep::run).
///
/// By default the excitation frequency is varied, at 101 values; 400 periods are dropped at each of them and 100 looked at.
///
/// ```
/// use hertzian::attractors::sweep::Sweep;
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear { drive: 3.0 };
/// let swept = Sweep::of(&model).from(0.5).to(1.5).values(5).transient(100).periods(1).run()?;
/// for row in &swept.rows {
///     // The amplitude of the cosine: 3 k / (k^2 + (0.2 omega)^2), k = 4 - omega^2
///     let k = 4.0 - row.value * row.value;
///     let expected = 3.0 * k / (k * k + (0.2 * row.value).powi(2));
///     assert!((row.points[0] - expected).abs() < 1e-9);
/// }
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sweep {
    request: Request,
    vary: Option<String>,
    from: Option<f64>,
    to: Option<f64>,
    values: usize,
    back: bool,
    start: Option<Vec<f64>>,
    transient: usize,
    periods: usize,
    section: Option<Arc<Section<'static>>>,
}

/// What a sweep has seen.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Swept {
    /// Value by value, in order.
    pub rows: Vec<Row>,
    /// Whether these are all values; otherwise it was interrupted.
    pub complete: bool,
}

/// What was seen at one value.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Row {
    /// The value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// States, one after the other: of the stroboscope, or where the motion crossed a section.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub points: Vec<f64>,
    /// Why it has no points: the motion [escaped](FlowError::Escaped), could not be computed, or the variable cannot have this value. The
    /// motion started again.
    pub ended: Option<FlowError>,
    /// The state that the next value goes on from.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    last: Vec<f64>,
}

impl Sweep {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            request: Request::of(system),
            vary: None,
            from: None,
            to: None,
            values: 101,
            back: false,
            start: None,
            transient: 400,
            periods: 100,
            section: None,
        }
    }

    hertzian_contract::setters! { self:
        /// The first value.
        from(value: f64) { self.from = Some(value) }

        /// The last one, or where the sweep turns [back](Self::back).
        to(value: f64) { self.to = Some(value) }

        /// Varies a parameter instead of the excitation frequency, which is then [`omega`](Self::omega).
        vary(parameter: impl Into<String>) { self.vary = Some(parameter.into()) }

        /// The excitation frequency, in radians per unit of time, when a parameter is varied.
        omega(omega: f64) { self.request.omega = Some(omega) }

        /// So many values at equal distances, both ends included. Default: 101.
        values(count: usize) { self.values = count }

        /// Whether the same values follow again in reverse, which shows hysteresis. Default: no.
        back(wanted: bool) { self.back = wanted }

        /// Where the motion starts, and starts again after it has escaped: all positions, then all velocities. Default: at the origin, at
        /// rest.
        start(state: &[f64]) { self.start = Some(state.to_vec()) }

        /// Periods that are dropped at every value. Default: 400.
        transient(periods: usize) { self.transient = periods }

        /// Periods that are looked at after those. Default: 100.
        periods(periods: usize) { self.periods = periods }

        /// A state with an entry beyond this has escaped; infinite for none. Default: a million.
        escape(bound: f64) { self.request.escape = bound }

        /// Tolerance of the flow, where it is not in closed form. Default: 1e-10.
        tolerance(tolerance: f64) { self.request.tolerance = tolerance }

        /// Points are crossings of a section instead of states at the beginnings of periods.
        section(section: Section<'static>) { self.section = Some(Arc::new(section)) }

        /// The sweep ends when this token is cancelled.
        cancel(cancel: &Cancel) { self.request.cancel = cancel.clone() }
    }

    /// Runs the sweep.
    ///
    /// # Errors
    /// If a parameter or an option is not usable.
    pub fn run(&self) -> Result<Swept, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` after every value: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Swept, Error> {
        self.sweep(None, &mut visit)
    }

    /// As [`run_with`](Self::run_with), and goes on from what a file holds of this sweep; what is computed is added to it. A
    /// file that is not there is begun. `model` is one line that says which system it is, with everything that its motions depend on, and
    /// where a [`section`](Self::section) is: a file of another one, or of another request, is refused.
    ///
    /// # Errors
    /// As [`run`](Self::run), and if the file cannot be used.
    pub fn resume(
        &self,
        path: impl AsRef<Path>,
        model: &str,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Swept, Error> {
        let mut log = Log::open(path.as_ref(), &format!("{model}, {self:?}"))?;
        self.sweep(Some(&mut log), &mut visit)
    }

    /// All values, in order.
    fn spread(&self, from: f64, to: f64) -> Vec<f64> {
        let last = self.values.saturating_sub(1).max(1) as f64;
        let at = |i: usize| {
            let part = i as f64 / last;
            (1.0 - part) * from + part * to
        };
        let there = (0..self.values).map(at);
        let back = (0..self.values).rev().map(at).filter(|_| self.back);
        there.chain(back).collect()
    }

    /// Everything that was asked for.
    fn check(&self) -> Result<Checked, Error> {
        let facts = self.request.system.facts();
        let from = self.from.ok_or(RequestError::no_end("from"))?;
        let to = self.to.ok_or(RequestError::no_end("to"))?;
        validate::finite("from", from)?;
        validate::finite("to", to)?;
        let most = MOST_VALUES / if self.back { 2 } else { 1 };
        validate::option(
            "values",
            self.values as f64,
            0.0..=most as f64,
            "must be at most 2^24, both ways together",
        )?;
        validate::positive("escape", self.request.escape)?;
        let order = 2 * facts.coordinates.len();
        let start = self.start.clone().unwrap_or_else(|| vec![0.0; order]);
        if start.len() != order {
            return Err(RequestError::State {
                entries: start.len(),
                expected: order,
            }
            .into());
        }
        for &entry in &start {
            validate::finite("start", entry)?;
        }
        let variable = validate::variable(facts, self.vary.as_deref())?;
        let mut parameters = model::values(&self.request.system);
        let omega = match (variable, self.request.omega) {
            (Variable::Omega, None) => from,
            (Variable::Omega, Some(value)) => {
                return Err(RequestError::Option {
                    name: "omega",
                    value,
                    must: "is what is varied: give it by from and to",
                }
                .into());
            }
            (Variable::Parameter(_), None) => {
                return Err(RequestError::no_omega().into());
            }
            (Variable::Parameter(index), Some(omega)) => {
                parameters[index] = from;
                omega
            }
        };
        let flow = self.request.flow(&parameters, omega)?;
        Ok(Checked {
            variable,
            values: self.spread(from, to),
            start,
            map: Stroboscope::new(flow),
        })
    }
}

/// What a sweep works with.
struct Checked {
    variable: Variable,
    values: Vec<f64>,
    start: Vec<f64>,
    map: Stroboscope,
}
