//! Multipliers of one orbit: by every method from balances of several sizes, and by shooting.

use std::time::Duration;

use cpu_time::ThreadTime;
use hertzian::error::chain;
use hertzian::{Complex, FrequencyResponse, Point, Shooting};

use super::method::Reference;
use super::problem::Problem;
use crate::multipliers::study::METHODS;

const HARMONICS: [usize; 4] = [5, 10, 20, 40];
const TOLERANCES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
/// Times below the limit are medians of so many.
const TURNS: usize = 7;
const LONG: Duration = Duration::from_millis(20);

/// The names of what is compared: [`METHODS`], and last shooting.
pub fn names() -> impl Iterator<Item = &'static str> {
    let methods = METHODS.into_iter().map(|(_, name)| name);
    methods.chain(["shooting: orbit and multipliers"])
}

/// The name of one of them.
pub fn name(method: usize) -> &'static str {
    names().nth(method).unwrap_or_default()
}

/// A method at one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Position among the [`names`].
    pub method: usize,
    /// Its setting.
    pub setting: String,
    /// Median time; of an orbit of the balance, that of the multipliers and their error alone.
    pub seconds: f64,
    /// Largest distance of a multiplier from the nearest exact one, or of an exact one from the nearest.
    pub error: f64,
    /// Why there are none.
    pub failure: Option<String>,
}

/// Every method on the orbit of comparison.
pub fn measure(problem: &Problem, reference: &Reference) -> Vec<Answer> {
    let mut answers = Vec::new();
    let [from, to] = problem.range;
    for harmonics in HARMONICS {
        let setting = format!("K = {harmonics}");
        let request = FrequencyResponse::of(&*problem.compiled).from(from).to(to);
        let branch = request.harmonics(harmonics).stability(false).run();
        let orbit = branch.and_then(|branch| {
            let largest = branch.at(problem.at)?.into_iter().max_by(larger);
            Ok(largest.map(|orbit| (branch, orbit)))
        });
        let Ok(Some((branch, orbit))) = orbit else {
            let failure = "no such orbit".to_owned();
            answers.extend((0..METHODS.len()).map(|method| failed(method, &setting, &failure)));
            continue;
        };
        for (method, (of, _)) in METHODS.into_iter().enumerate() {
            let mut last = Vec::new();
            let seconds = median(|| {
                let Ok(answer) = branch.multipliers(&orbit, of) else {
                    return Duration::MAX;
                };
                last = answer.stability.multipliers;
                answer.elapsed
            });
            let error = distance(&last, &reference.multipliers);
            answers.push(Answer {
                method,
                setting: setting.clone(),
                seconds,
                error,
                failure: (!error.is_finite()).then(|| "no multipliers".to_owned()),
            });
        }
    }
    answers.extend(TOLERANCES.map(|tolerance| shoot(problem, reference, tolerance)));
    answers
}

fn larger(a: &Point, b: &Point) -> std::cmp::Ordering {
    a.peak_to_peak().total_cmp(&b.peak_to_peak())
}

fn shoot(problem: &Problem, reference: &Reference, tolerance: f64) -> Answer {
    let method = METHODS.len();
    let setting = format!("tolerance {tolerance:.0e}");
    let shooting =
        FrequencyResponse::of(&*problem.compiled).by(Shooting::new().tolerance(tolerance));
    let orbit = || {
        shooting
            .clone()
            .near_state(&reference.state)
            .orbit(problem.at)
    };
    match orbit() {
        Ok(cycle) => Answer {
            method,
            setting,
            seconds: median(|| {
                let started = ThreadTime::now();
                let _ = orbit();
                started.elapsed()
            }),
            error: distance(&cycle.stability.multipliers, &reference.multipliers),
            failure: None,
        },
        Err(error) => failed(method, &setting, &chain(&error).to_string()),
    }
}

fn failed(method: usize, setting: &str, failure: &str) -> Answer {
    Answer {
        method,
        setting: setting.to_owned(),
        seconds: f64::NAN,
        error: f64::NAN,
        failure: Some(failure.to_owned()),
    }
}

/// The median of several times, or one that is long.
fn median(mut timed: impl FnMut() -> Duration) -> f64 {
    let mut times = vec![timed()];
    while times.len() < TURNS && times[0] < LONG {
        times.push(timed());
    }
    times.sort();
    times[times.len() / 2].as_secs_f64()
}

/// How far two sets are apart: a multiplier that is found twice stands for one of them only.
fn distance(found: &[Complex<f64>], exact: &[Complex<f64>]) -> f64 {
    let from = |a: &[Complex<f64>], b: &[Complex<f64>]| {
        let nearest = |x: &Complex<f64>| {
            let distances = b.iter().map(|y| (x - y).norm());
            distances.fold(f64::INFINITY, f64::min)
        };
        a.iter().map(nearest).fold(0.0, f64::max)
    };
    if found.len() == exact.len() {
        from(found, exact).max(from(exact, found))
    } else {
        f64::INFINITY
    }
}
