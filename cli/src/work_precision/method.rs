//! The methods and their settings.

use std::ops::ControlFlow;
use std::time::Instant;

use cpu_time::ThreadTime;
use hertzian::system::System;
use hertzian::{
    Aft, Branch, Complex, ContactEquation, EventKind, FrequencyResponse, HarmonicBalance,
    OrbitMethod, Shooting,
};

use super::problem::Problem;

/// A way to compute the curve, without its settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Sampled harmonic balance, the classical one.
    Classical,
    /// Sampled, with rate terms through their primitive.
    Primitive,
    /// Integrated from switch to switch, with a number of harmonics.
    Switched,
    /// The same with interpreted laws.
    Interpreted,
    /// Integrated from switch to switch, harmonics by a tolerance.
    Adaptive,
    /// Shooting, with a tolerance of the flow; closed forms have none.
    Shooting,
    /// Shooting by integration, on problems of which shooting has closed forms.
    Integrated,
    /// The contact equation, nodes by a tolerance.
    ContactEquation,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Classical,
        Self::Primitive,
        Self::Switched,
        Self::Interpreted,
        Self::Adaptive,
        Self::Shooting,
        Self::Integrated,
        Self::ContactEquation,
    ];

    /// Its name in legends and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Classical => "sampled, classical",
            Self::Primitive => "sampled, primitive",
            Self::Switched => "switched",
            Self::Interpreted => "switched, interpreted",
            Self::Adaptive => "switched, by tolerance",
            Self::Shooting => "shooting",
            Self::Integrated => "shooting, integrated",
            Self::ContactEquation => "contact equation",
        }
    }

    /// Whether it samples.
    pub fn is_sampled(self) -> bool {
        matches!(self, Self::Classical | Self::Primitive)
    }

    /// The settings that are tried.
    pub fn settings(self) -> Vec<Setting> {
        match self {
            Self::Classical | Self::Primitive => [512, 4096, 16384]
                .into_iter()
                .flat_map(|samples| {
                    [5, 10, 20, 40].map(|harmonics| Setting::Samples { harmonics, samples })
                })
                .collect(),
            Self::Switched | Self::Interpreted => {
                [5, 10, 20, 40, 80].map(Setting::Harmonics).to_vec()
            }
            Self::Adaptive => [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8]
                .map(Setting::Tolerance)
                .to_vec(),
            Self::ContactEquation => [1e-4, 1e-6, 1e-8, 1e-10].map(Setting::Tolerance).to_vec(),
            Self::Shooting | Self::Integrated => [1e-4, 1e-6, 1e-8, 1e-10, 1e-12]
                .map(Setting::Tolerance)
                .to_vec(),
        }
    }
}

/// What is swept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// Harmonics and samples of a period.
    Samples {
        /// Harmonics.
        harmonics: usize,
        /// Samples.
        samples: usize,
    },
    /// Harmonics.
    Harmonics(usize),
    /// A tolerance.
    Tolerance(f64),
}

impl Setting {
    /// Samples of a period, if there are any.
    pub fn samples(self) -> Option<usize> {
        match self {
            Self::Samples { samples, .. } => Some(samples),
            Self::Harmonics(_) | Self::Tolerance(_) => None,
        }
    }

    /// The tolerance, if that is swept; a small one otherwise.
    fn tolerance(self) -> f64 {
        match self {
            Self::Tolerance(tolerance) => tolerance,
            Self::Samples { .. } | Self::Harmonics(_) => 1e-10,
        }
    }
}

impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Samples { harmonics, samples } => write!(f, "K = {harmonics}, N = {samples}"),
            Self::Harmonics(harmonics) => write!(f, "K = {harmonics}"),
            Self::Tolerance(tolerance) => write!(f, "tolerance {tolerance:.0e}"),
        }
    }
}

/// What one run gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Time of the processor for the curve.
    pub seconds: f64,
    /// Folds, and turns that could not be confirmed as folds.
    pub folds: Vec<f64>,
    /// Peak-to-peak of the largest orbit at the frequency of comparison; `None` if the curve does not pass there.
    pub peak_to_peak: Option<f64>,
    /// Why the curve ended early.
    pub fault: Option<String>,
}

/// Traces the curve once.
///
/// # Errors
/// If it does not begin.
pub fn run(
    problem: &Problem,
    family: Family,
    setting: Setting,
    patience: f64,
) -> Result<Run, hertzian::Error> {
    match family {
        Family::Shooting => cycles(problem, shoot(&*problem.compiled, setting), patience),
        Family::Integrated => {
            let system = problem.integrated.as_deref();
            let system = system.unwrap_or(&*problem.compiled);
            cycles(problem, shoot(system, setting), patience)
        }
        Family::ContactEquation => {
            let request = FrequencyResponse::of(&*problem.compiled).by(ContactEquation::new());
            cycles(problem, request.tolerance(setting.tolerance()), patience)
        }
        _ => balance(problem, family, setting, patience),
    }
}

fn balance(
    problem: &Problem,
    family: Family,
    setting: Setting,
    patience: f64,
) -> Result<Run, hertzian::Error> {
    let system = match family {
        Family::Interpreted => &problem.interpreted,
        _ => &problem.compiled,
    };
    let aft = match family {
        Family::Classical => Aft::Sampled,
        Family::Primitive => Aft::Primitive,
        _ => Aft::Switched,
    };
    let [from, to] = problem.range;
    let request = FrequencyResponse::of(&**system).from(from).to(to);
    let request = request.aft(aft).stability(false);
    let request = match setting {
        Setting::Samples { harmonics, samples } => request.harmonics(harmonics).samples(samples),
        Setting::Harmonics(harmonics) => request.harmonics(harmonics),
        Setting::Tolerance(tolerance) => request.tolerance(tolerance),
    };
    let (clock, started) = (ThreadTime::now(), Instant::now());
    let branch = request.run_with(|_| within(started, patience))?;
    let seconds = clock.elapsed().as_secs_f64();
    let reached = branch.stopped == hertzian::Stop::ReachedEnd;
    Ok(Run {
        seconds,
        folds: turns(&branch),
        peak_to_peak: largest(&branch, problem.at),
        fault: (!reached).then(|| ended(&branch.stopped, started, patience)),
    })
}

fn shoot(system: &dyn System, setting: Setting) -> FrequencyResponse<Shooting> {
    FrequencyResponse::of(system).by(Shooting::new().tolerance(setting.tolerance()))
}

/// The curve as a request asks for it, whose orbits are known by their states.
fn cycles<M: OrbitMethod>(
    problem: &Problem,
    asked: FrequencyResponse<M>,
    patience: f64,
) -> Result<Run, hertzian::Error> {
    let [from, to] = problem.range;
    let asked = asked.stability(false);
    let (clock, started) = (ThreadTime::now(), Instant::now());
    let request = asked.clone().from(from).to(to);
    let branch = request.run_with(|_| within(started, patience))?;
    let seconds = clock.elapsed().as_secs_f64();
    let folds = branch.folds().map(|fold| fold.point.value);
    let turns = branch.turns.iter();
    let others = turns.filter(|turn| turn.kind == EventKind::Fold);
    let others = others.map(|turn| turn.value);
    let reached = branch
        .points
        .last()
        .is_some_and(|last| last.value == to || last.value == from);
    Ok(Run {
        seconds,
        folds: folds.chain(others).collect(),
        peak_to_peak: largest_cycle(&asked, &branch, problem.at),
        fault: (!reached).then(|| ended(&branch.stopped, started, patience)),
    })
}

/// Why a curve is not complete.
fn ended(why: &dyn std::fmt::Display, started: Instant, patience: f64) -> String {
    if within(started, patience).is_break() {
        format!("no end within {patience} s")
    } else {
        format!("ended early: {why}")
    }
}

fn within(started: Instant, patience: f64) -> ControlFlow<()> {
    if started.elapsed().as_secs_f64() < patience {
        ControlFlow::Continue(())
    } else {
        ControlFlow::Break(())
    }
}

/// Where the branch turns, confirmed as a fold or not: a user would see either.
fn turns(branch: &Branch) -> Vec<f64> {
    let folds = branch
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Fold);
    let folds = folds.map(|fold| fold.point.value);
    let turns = branch
        .turns
        .iter()
        .filter(|turn| turn.kind == EventKind::Fold);
    folds.chain(turns.map(|turn| turn.value)).collect()
}

fn largest(branch: &Branch, at: f64) -> Option<f64> {
    let orbits = branch.at(at).ok()?;
    orbits
        .iter()
        .map(hertzian::Point::peak_to_peak)
        .max_by(f64::total_cmp)
}

/// The largest orbit of a branch at a frequency, from the nearest one of those that are larger than the others beside it.
fn largest_cycle<M: OrbitMethod>(
    asked: &FrequencyResponse<M>,
    branch: &Branch,
    at: f64,
) -> Option<f64> {
    let passes = branch
        .points
        .windows(2)
        .filter(|pair| (pair[0].value - at) * (pair[1].value - at) <= 0.0);
    let largest = passes.max_by(|a, b| a[0].peak_to_peak().total_cmp(&b[0].peak_to_peak()))?;
    let request = asked.clone().near_orbit(&largest[0].orbit);
    Some(request.orbit(at).ok()?.peak_to_peak())
}

/// What runs are compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// All folds, that of largest amplitude first.
    pub folds: Vec<f64>,
    /// Peak-to-peak of the largest orbit at the frequency of comparison.
    pub peak_to_peak: f64,
    /// Its state at phase zero.
    pub state: Vec<f64>,
    /// Its multipliers.
    pub multipliers: Vec<Complex<f64>>,
}

/// The largest orbit at the frequency of comparison, to all digits, and the folds.
///
/// # Errors
/// If there is none.
pub fn reference(problem: &Problem) -> Result<Option<Reference>, hertzian::Error> {
    let [from, to] = problem.range;
    let branch = FrequencyResponse::of(&*problem.compiled)
        .by(HarmonicBalance::new())
        .from(from)
        .to(to)
        .stability(false)
        .run()?;
    let orbits = branch.at(problem.at)?;
    let largest = orbits
        .iter()
        .max_by(|a, b| a.peak_to_peak().total_cmp(&b.peak_to_peak()));
    let Some(largest) = largest else {
        return Ok(None);
    };
    let shooting = FrequencyResponse::of(&*problem.compiled).by(Shooting::new().tolerance(1e-13));
    let folds = match problem.folds {
        Some(folds) => folds.to_vec(),
        None => folds(&shooting.clone().stability(false).from(from).to(to).run()?),
    };
    let point = shooting.near_orbit(&largest.orbit).orbit(problem.at)?;
    Ok(Some(Reference {
        folds,
        peak_to_peak: point.peak_to_peak(),
        state: point.orbit.state(),
        multipliers: point.stability.multipliers,
    }))
}

/// The folds of a branch, those of large amplitude first.
fn folds(branch: &Branch) -> Vec<f64> {
    let mut folds: Vec<_> = branch.folds().map(|fold| &fold.point).collect();
    folds.sort_by(|a, b| b.peak_to_peak().total_cmp(&a.peak_to_peak()));
    folds.iter().map(|point| point.value).collect()
}
