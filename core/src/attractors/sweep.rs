//! Bifurcation diagrams by brute force: what a motion settles to as a parameter or the frequency changes in steps.
//!
//! At every value the motion goes on from the last state of the value before, so that it stays with its attractor as long as
//! there is one: a sweep up and a sweep down show hysteresis.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::log::{Log, Reader, Writer};
use crate::branches::progress::{Progress, Stage};
use crate::cancel::Cancel;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::system::{System, Variable};
use crate::time;
use crate::time::poincare::{Crossing, Section};
use crate::time::stroboscope::Stroboscope;
use crate::time::{FlowError, Options};

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
#[derive(Clone)]
pub struct Sweep {
    system: Arc<dyn System>,
    vary: Option<String>,
    omega: Option<f64>,
    from: Option<f64>,
    to: Option<f64>,
    values: usize,
    back: bool,
    start: Option<Vec<f64>>,
    transient: usize,
    periods: usize,
    escape: f64,
    tolerance: f64,
    section: Option<Arc<Section<'static>>>,
    cancel: Cancel,
}

/// Everything that is asked for, but what a section is of.
impl std::fmt::Debug for Sweep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sweep")
            .field("system", &self.system.facts().name)
            .field("vary", &self.vary)
            .field("omega", &self.omega)
            .field("from", &self.from)
            .field("to", &self.to)
            .field("values", &self.values)
            .field("back", &self.back)
            .field("start", &self.start)
            .field("transient", &self.transient)
            .field("periods", &self.periods)
            .field("escape", &self.escape)
            .field("tolerance", &self.tolerance)
            .field("section", &self.section)
            .finish_non_exhaustive()
    }
}

/// What a sweep has seen.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Swept {
    /// Value by value, in order.
    pub rows: Vec<Row>,
    /// Whether these are all values; otherwise it was interrupted.
    pub complete: bool,
}

/// What was seen at one value.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Row {
    /// The value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// States, one after the other: of the stroboscope, or where the motion crossed a section.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub points: Vec<f64>,
    /// Why it has no points; the motion started again.
    pub ended: Option<Ended>,
    /// The state that the next value goes on from.
    #[cfg_attr(feature = "serde", serde(skip))]
    last: Vec<f64>,
}

/// Why nothing was seen at a value.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Ended {
    /// The motion grew beyond the bound.
    Escaped,
    /// The variable cannot have this value, or the motion could not be computed.
    Failed(FlowError),
}

impl From<FlowError> for Ended {
    fn from(error: FlowError) -> Self {
        Self::Failed(error)
    }
}

impl std::fmt::Display for Ended {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Escaped => write!(f, "the motion grew beyond the bound"),
            Self::Failed(error) => error.fmt(f),
        }
    }
}

impl Sweep {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            vary: None,
            omega: None,
            from: None,
            to: None,
            values: 101,
            back: false,
            start: None,
            transient: 400,
            periods: 100,
            escape: 1e6,
            tolerance: 1e-10,
            section: None,
            cancel: Cancel::new(),
        }
    }

    /// The first value.
    #[must_use]
    pub fn from(mut self, value: f64) -> Self {
        self.from = Some(value);
        self
    }

    /// The last one, or where the sweep turns [back](Self::back).
    #[must_use]
    pub fn to(mut self, value: f64) -> Self {
        self.to = Some(value);
        self
    }

    /// Varies a parameter instead of the excitation frequency, which is then [`omega`](Self::omega).
    #[must_use]
    pub fn vary(mut self, parameter: impl Into<String>) -> Self {
        self.vary = Some(parameter.into());
        self
    }

    /// The excitation frequency, in radians per unit of time, when a parameter is varied.
    #[must_use]
    pub fn omega(mut self, omega: f64) -> Self {
        self.omega = Some(omega);
        self
    }

    /// So many values at equal distances, both ends included. Default: 101.
    #[must_use]
    pub fn values(mut self, count: usize) -> Self {
        self.values = count;
        self
    }

    /// Whether the same values follow again in reverse, which shows hysteresis. Default: no.
    #[must_use]
    pub fn back(mut self, wanted: bool) -> Self {
        self.back = wanted;
        self
    }

    /// Where the motion starts, and starts again after it has escaped: all positions, then all velocities. Default: at the origin, at
    /// rest.
    #[must_use]
    pub fn start(mut self, state: &[f64]) -> Self {
        self.start = Some(state.to_vec());
        self
    }

    /// Periods that are dropped at every value. Default: 400.
    #[must_use]
    pub fn transient(mut self, periods: usize) -> Self {
        self.transient = periods;
        self
    }

    /// Periods that are looked at after those. Default: 100.
    #[must_use]
    pub fn periods(mut self, periods: usize) -> Self {
        self.periods = periods;
        self
    }

    /// A state with an entry beyond this has escaped; infinite for none. Default: a million.
    #[must_use]
    pub fn escape(mut self, bound: f64) -> Self {
        self.escape = bound;
        self
    }

    /// Tolerance of the flow, where it is not in closed form. Default: 1e-10.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Points are crossings of a section instead of states at the beginnings of periods.
    #[must_use]
    pub fn section(mut self, section: Section<'static>) -> Self {
        self.section = Some(Arc::new(section));
        self
    }

    /// The sweep ends when this token is cancelled.
    #[must_use]
    pub fn cancel(mut self, cancel: &Cancel) -> Self {
        self.cancel = cancel.clone();
        self
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

    /// As [`run_with`](Self::run_with), and goes on from what a log holds of this sweep; what is computed is added to it.
    ///
    /// # Errors
    /// As [`run`](Self::run), and if the log cannot be written.
    pub fn resume(
        &self,
        log: &mut Log,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Swept, Error> {
        self.sweep(Some(log), &mut visit)
    }

    fn sweep(
        &self,
        mut log: Option<&mut Log>,
        visit: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Swept, Error> {
        let Checked {
            variable,
            values,
            start,
            mut map,
        } = self.check()?;
        let records = log.as_deref().map_or(&[][..], Log::records);
        let known: Vec<Known> = records
            .iter()
            .map_while(|record| Row::read(record))
            .collect();
        let mut rows: Vec<Row> = Vec::new();
        let mut state = start.clone();
        for (index, &value) in values.iter().enumerate() {
            if let Some(Known::Seen(row)) = known.get(index) {
                state.clone_from(&row.last);
                rows.push(row.clone());
                continue;
            }
            let mut points = Vec::new();
            let ended = map.set(variable, value).map_err(Ended::from);
            let ended = ended.and_then(|()| self.row(&mut map, &mut state, &mut points));
            let ended = ended.err();
            if self.cancel.is_cancelled() {
                break;
            }
            if ended.is_some() {
                points.clear();
                state.clone_from(&start);
            }
            let row = Row {
                value,
                points,
                ended,
                last: state.clone(),
            };
            if let Some(log) = log.as_mut().filter(|_| index >= known.len()) {
                log.append(&row.written())?;
            }
            rows.push(row);
            let progress = Progress {
                total: Some(values.len()),
                value: Some(value),
                ..Progress::new(Stage::Sweep, rows.len())
            };
            if visit(progress).is_break() {
                break;
            }
        }
        Ok(Swept {
            complete: rows.len() == values.len(),
            rows,
        })
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
        let facts = self.system.facts();
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
        validate::positive("escape", self.escape)?;
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
        let mut parameters = vec![0.0; facts.parameters.len()];
        self.system.values(&mut parameters);
        let omega = match (variable, self.omega) {
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
        let options = Options::default()
            .tolerance(self.tolerance)
            .cancel(&self.cancel);
        let flow = time::at(&self.system, &parameters, omega, options)?;
        Ok(Checked {
            variable,
            values: self.spread(from, to),
            start,
            map: Stroboscope::new(flow),
        })
    }

    /// One value.
    fn row(
        &self,
        map: &mut Stroboscope,
        state: &mut [f64],
        points: &mut Vec<f64>,
    ) -> Result<(), Ended> {
        for _ in 0..self.transient {
            map.map(state)?;
            self.stays(state)?;
        }
        for _ in 0..self.periods {
            if let Some(section) = &self.section {
                let mut see = |crossing: Crossing<'_>| points.extend_from_slice(crossing.state);
                section.follow(map, state, map.stride(), &mut see)?;
            } else {
                map.map(state)?;
                points.extend_from_slice(state);
            }
            self.stays(state)?;
        }
        Ok(())
    }

    fn stays(&self, state: &[f64]) -> Result<(), Ended> {
        let inside = state.iter().all(|x| x.abs() <= self.escape);
        if inside { Ok(()) } else { Err(Ended::Escaped) }
    }
}

/// What a sweep works with.
struct Checked {
    variable: Variable,
    values: Vec<f64>,
    start: Vec<f64>,
    map: Stroboscope,
}

impl Row {
    fn written(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.numbers(&[self.value]);
        writer.numbers(&self.points);
        writer.numbers(&match self.ended {
            None => vec![],
            Some(Ended::Escaped) => vec![0.0],
            Some(Ended::Failed(_)) => vec![1.0],
        });
        writer.numbers(&self.last);
        writer.0
    }

    fn read(record: &[u8]) -> Option<Known> {
        let mut reader = Reader(record);
        let value = *reader.numbers()?.first()?;
        let points = reader.numbers()?;
        let ended = match reader.numbers()?[..] {
            [] => None,
            [0.0] => Some(Ended::Escaped),
            _ => return Some(Known::Failed),
        };
        Some(Known::Seen(Self {
            value,
            points,
            ended,
            last: reader.numbers()?,
        }))
    }
}

/// What a log says of a value. Why a motion failed there, it says itself when it is computed again, and again in the same way.
enum Known {
    Seen(Row),
    Failed,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::poincare::Direction;

    crate::oscillator! {
        /// Wang et al. (2021), Eq. (1), one-sided, exponent one.
        OneSided(x) {
            param zeta in 0.0..;
            param load;
            param drive;
            law contact(gap) {
                gap > 0 => 2*zeta*dot(gap) + gap,
                else    => 0,
            }
            ddot(x) + contact(x) = drive*cos(omega*t) + load;
        }
    }

    const MODEL: OneSided = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };

    fn sweep(from: f64, to: f64, start: [f64; 2]) -> Sweep {
        let sweep = Sweep::of(&MODEL).vary("drive").omega(1.0);
        let sweep = sweep.from(from).to(to).values(26).start(&start);
        sweep.transient(400).periods(4)
    }

    /// States that differ.
    fn distinct(row: &Row) -> usize {
        let mut seen: Vec<f64> = Vec::new();
        for x in row.points.chunks(2).map(|state| state[0]) {
            if seen.iter().all(|y| (x - y).abs() > 1e-3) {
                seen.push(x);
            }
        }
        seen.len()
    }

    /// Period one doubles at A = 1.282584168, and a period two ends in a fold at A = 0.294528806 (exact values, computed
    /// independently of this project); between them both are stable.
    #[test]
    fn up_and_down_show_the_hysteresis() {
        let run = |sweep: Sweep| sweep.run().expect("rows").rows;
        let up = run(sweep(0.2, 1.45, [0.5, 0.0]));
        let down = run(sweep(1.0, 0.2, [-5.632, 3.5266]));
        // Beside a bifurcation the transient is long.
        for row in up.iter().filter(|row| (row.value - 1.282_584).abs() > 0.02) {
            let doubled = row.value > 1.282_584;
            assert_eq!(distinct(row), 1 + usize::from(doubled), "{}", row.value);
        }
        for row in down
            .iter()
            .filter(|row| (row.value - 0.294_529).abs() > 0.02)
        {
            let before = row.value > 0.294_529;
            assert_eq!(distinct(row), 1 + usize::from(before), "{}", row.value);
        }
        assert!(up.iter().chain(&down).all(|row| row.ended.is_none()));
        // At A = 1: the exact states of both.
        let at_one = up.iter().find(|row| (row.value - 1.0).abs() < 1e-9);
        let first = at_one.expect("a row").points[0];
        assert!((first + 1.999_776_122_757_642_7).abs() < 1e-9, "{first}");
        let second = down[0].points[0].max(down[0].points[2]);
        assert!((second + 5.632_060_192_753_841).abs() < 1e-9, "{second}");
    }

    #[test]
    fn a_run_that_was_ended_goes_on_with_the_same_rows() {
        let sweep = sweep(1.0, 1.5, [0.5, 0.0]);
        let all = sweep.run().expect("rows");
        assert!(all.complete && all.rows.len() == 26);
        let folder = std::env::temp_dir().join(format!("hertzian-sweep-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("sweep");
        let _ = std::fs::remove_file(&path);
        let mut computed = 0;
        let swept = loop {
            let mut log = Log::open(&path, "sweep").expect("a log");
            let before = computed;
            let mut see = |progress: Progress<'_>| {
                computed += 1;
                assert_eq!((progress.done, progress.total), (computed, Some(26)));
                if computed - before < 10 {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            };
            let swept = sweep.resume(&mut log, &mut see).expect("rows");
            if swept.complete {
                break swept;
            }
        };
        assert_eq!(swept, all);
        assert_eq!(computed, all.rows.len());
        let _ = std::fs::remove_dir_all(&folder);
    }

    /// A damping below zero is refused, value by value, and by the run that goes on in the same words.
    #[test]
    fn values_that_failed_are_the_same_when_a_run_goes_on() {
        let sweep = Sweep::of(&MODEL).vary("zeta").omega(1.0).start(&[0.5, 0.0]);
        let sweep = sweep.from(0.05).to(-0.03).values(5).back(true);
        let sweep = sweep.transient(20).periods(2);
        let all = sweep.run().expect("rows");
        let failed = |row: &&Row| matches!(row.ended, Some(Ended::Failed(FlowError::Value { .. })));
        assert_eq!(all.rows.iter().filter(failed).count(), 4);
        let folder = std::env::temp_dir().join(format!("hertzian-failed-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let mut log = Log::open(folder.join("sweep"), "sweep").expect("a log");
        let visit = |progress: Progress<'_>| match progress.done {
            6 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let part = sweep.resume(&mut log, visit).expect("rows");
        assert_eq!(part.rows[..], all.rows[..6]);
        let mut log = Log::open(folder.join("sweep"), "sweep").expect("a log");
        assert_eq!(log.records().len(), 6);
        let visit = |_: Progress<'_>| ControlFlow::Continue(());
        assert_eq!(sweep.resume(&mut log, visit), Ok(all));
        drop(log);
        let log = Log::open(folder.join("sweep"), "sweep").expect("a log");
        assert_eq!(log.records().len(), 10);
        let _ = std::fs::remove_dir_all(&folder);
    }

    /// A sweep that is cancelled at a value has those before it, and no row for the motion that was cut short.
    #[test]
    fn a_cancelled_sweep_keeps_its_rows() {
        let cancel = Cancel::new();
        let sweep = sweep(1.0, 1.5, [0.5, 0.0]).cancel(&cancel);
        let part = sweep.run_with(|progress| {
            if progress.done == 3 {
                cancel.cancel();
            }
            ControlFlow::Continue(())
        });
        let part = part.expect("rows");
        let again = sweep.cancel(&Cancel::new()).values(26);
        let whole = again.run().expect("rows");
        assert!(!part.complete && whole.complete);
        assert_eq!(part.rows[..], whole.rows[..3]);
    }

    #[test]
    fn what_cannot_be_swept_is_refused() {
        for count in [MOST_VALUES + 1, usize::MAX] {
            let refused = sweep(0.0, 1.0, [0.0; 2]).values(count).run();
            let refused = refused.expect_err("too many");
            assert!(matches!(
                refused.downcast_ref(),
                Some(RequestError::Option { name: "values", .. })
            ));
        }
        let refused = Sweep::of(&MODEL).from(0.5).run().expect_err("no end");
        assert_eq!(refused.downcast_ref(), Some(&RequestError::no_end("to")));
        let refused = sweep(0.0, 1.0, [0.0; 2]).start(&[0.0]).run();
        assert!(matches!(
            refused.expect_err("half a state").downcast_ref(),
            Some(RequestError::State {
                entries: 1,
                expected: 2
            })
        ));
        let back = sweep(0.0, 1.0, [0.0; 2]).values(3).back(true);
        assert_eq!(back.spread(0.0, 1.0), [0.0, 0.5, 1.0, 1.0, 0.5, 0.0]);
    }

    #[test]
    fn a_section_gives_its_crossings() {
        let section = Section::entry(0, 0.0, Direction::Rising);
        let sweep = sweep(1.0, 1.0, [-2.0, 0.18]).values(1).section(section);
        let rows = sweep.run().expect("rows").rows;
        // Period one meets the contact once in each period, at one speed.
        assert_eq!(rows[0].points.len(), 8);
        for state in rows[0].points.chunks(2) {
            assert!(state[0].abs() < 1e-13 && (state[1] - rows[0].points[1]).abs() < 1e-9);
        }
    }

    /// Without damping and at its own frequency an oscillator grows without bound.
    #[test]
    fn what_escapes_starts_again() {
        crate::oscillator! {
            Resonance(x) {
                param drive;
                ddot(x) + x = drive*cos(omega*t);
            }
        }
        let model = Resonance { drive: 1.0 };
        let sweep = Sweep::of(&model).vary("drive").omega(1.0);
        let sweep = sweep.from(1.0).to(0.0).values(2).start(&[1.0, 0.0]);
        let sweep = sweep.transient(10).periods(2).escape(10.0);
        let rows = sweep.run().expect("rows").rows;
        assert_eq!(rows[0].ended, Some(Ended::Escaped));
        assert!(rows[0].points.is_empty());
        assert!(rows[1].ended.is_none() && (rows[1].points[0] - 1.0).abs() < 1e-12);
    }
}
