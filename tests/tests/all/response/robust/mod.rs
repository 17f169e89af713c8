//! Random models with random parameters end in a curve or in a clear reason: no panic, no hang, and no number that is not one.
//!
//! Nothing is known of these orbits, so nothing is compared with a value. What is asked is that a run returns, and that
//! what it returns can be used.
//!
//!     HERTZIAN_MODELS=10000 cargo test --release -p hertzian-tests --test all response::robust -- --nocapture
//!
//! draws as many cases instead of [`MODELS`]. A case depends on its number only; `HERTZIAN_MODEL=17` runs that one.

mod draw;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use draw::{Request, model};
use hertzian::error::chain;
use hertzian::{Branch, Error, NewtonError, OrbitError, Point, Stop, System};
use hertzian_tests::random::Random;

/// Cases by default.
const MODELS: u64 = 120;
/// No case works longer.
const LONGEST: Duration = Duration::from_secs(20);
/// A case that has not ended after this is taken for one that never ends.
const HUNG: Duration = Duration::from_secs(300);

/// One model with what is asked of it, so that it can be printed.
struct Case {
    index: u64,
    system: Box<dyn System + Send>,
    request: Request,
}

impl Case {
    fn draw(index: u64) -> Self {
        let random = &mut Random::of(index);
        let (system, natural) = model(random);
        let request = Request::draw(random, system.as_ref(), natural);
        Self {
            index,
            system,
            request,
        }
    }

    /// Runs it: the outcome in a few words, or what is wrong with it.
    fn run(&self) -> Result<String, String> {
        let system: &dyn System = self.system.as_ref();
        match self.request.of(system).run() {
            Ok(branch) => usable(&branch).map(|()| {
                let unknown = branch.events.iter().any(|event| event.error.is_infinite());
                let caution = if unknown {
                    ", a fold of unknown error"
                } else {
                    ""
                };
                ended(branch.stopped) + caution
            }),
            Err(error) if error.to_string().contains("NaN") => Err(error.to_string()),
            Err(error) => Ok(refused(&error)),
        }
    }

    /// As [`run`](Self::run); a panic is what is wrong, and no case takes too long.
    fn judge(&self) -> (Result<String, String>, Duration) {
        let (started, worked) = (Instant::now(), processor_time());
        let outcome = catch_unwind(AssertUnwindSafe(|| self.run()));
        let elapsed = processor_time()
            .zip(worked)
            .map_or_else(|| started.elapsed(), |(now, then)| now.saturating_sub(then));
        let outcome = outcome.unwrap_or_else(|_| Err("panicked, see above".to_owned()));
        let outcome = match outcome {
            Ok(_) if elapsed > LONGEST => Err(format!("took {elapsed:.1?}")),
            other => other,
        };
        (outcome, elapsed)
    }
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let facts = self.system.facts();
        let mut values = vec![0.0; facts.parameters.len()];
        self.system.values(&mut values);
        write!(f, "HERTZIAN_MODEL={}: {} {{", self.index, facts.name)?;
        for (parameter, value) in facts.parameters.iter().zip(values) {
            write!(f, " {}: {value:?},", parameter.name)?;
        }
        write!(f, " }}, {:?}", self.request)
    }
}

/// Why a branch ended.
fn ended(stop: Stop) -> String {
    match stop {
        Stop::ReachedEnd => "curve, reached the end".to_owned(),
        Stop::LeftAtStart => "curve, left at its start".to_owned(),
        Stop::Closed => "curve, closed".to_owned(),
        Stop::Joined { .. } => "curve, joined one of a shorter period".to_owned(),
        Stop::PointLimit { .. } => "curve, as many points as asked for".to_owned(),
        Stop::Unbounded { .. } => "curve, grew without bound".to_owned(),
        Stop::StepTooShort { reason, .. } => format!("stopped early: {}", in_words(reason)),
        other => other.to_string(),
    }
}

/// Why there is no branch.
fn refused(error: &Error) -> String {
    match error.downcast_ref() {
        Some(OrbitError::NoStart { reason, .. }) => format!("no start: {}", in_words(*reason)),
        Some(OrbitError::SearchLimit { reason, .. }) => {
            format!("no start within the limit: {}", in_words(*reason))
        }
        Some(OrbitError::NoSuchPeriod { planned, made, .. }) if made < planned => {
            "no start of that period within the limit".to_owned()
        }
        Some(OrbitError::NoSuchPeriod { .. }) => "no start of that period".to_owned(),
        _ => format!("refused: {}", chain(error)),
    }
}

fn in_words(reason: NewtonError) -> &'static str {
    match reason {
        NewtonError::NotConverged { .. } => "not converged",
        NewtonError::Singular { .. } => "singular",
        NewtonError::NotFinite { .. } => "not finite",
        NewtonError::NoEquations { .. } => "no equations",
        _ => "otherwise",
    }
}

/// Every number of a branch is one; an error may be unknown, which is infinite.
fn usable(branch: &Branch) -> Result<(), String> {
    if branch.points.is_empty() {
        return Err("a branch without points".to_owned());
    }
    for (index, point) in branch.points.iter().enumerate() {
        finite(point)
            .map_err(|what| format!("point {index} of {}: {what}", branch.points.len()))?;
    }
    for event in &branch.events {
        finite(&event.point).map_err(|what| format!("{event}: {what}"))?;
        if event.error.is_nan() || !event.test.is_finite() {
            return Err(format!("{event}: its error or its test"));
        }
    }
    let mut turns = branch.turns.iter();
    if let Some(turn) = turns.find(|turn| !(turn.value.is_finite() && turn.test.is_finite())) {
        return Err(format!("{turn:?}"));
    }
    let (first, last) = (&branch.points[0], &branch.points[branch.points.len() - 1]);
    // An orbit between two points may be lost, which is an error with numbers.
    let between = branch.at(0.5 * (first.value + last.value));
    for point in between.unwrap_or_default() {
        finite(&point).map_err(|what| format!("an orbit between: {what}"))?;
    }
    Ok(())
}

fn finite(point: &Point) -> Result<(), String> {
    let series = (0..point.orbit.coordinates()).flat_map(|i| point.orbit.series(i).unwrap());
    let motions = point.observed.motions.iter();
    let contacts = point.observed.contacts.iter();
    let observed = &point.observed;
    let multipliers = &point.stability.multipliers;
    let groups: [(&str, Vec<f64>); 7] = [
        ("its value", vec![point.value, point.omega()]),
        ("its series", series.copied().collect()),
        ("its size", vec![point.peak_to_peak()]),
        (
            "its motions",
            motions
                .flat_map(|m| [m.maximum, m.minimum, m.mean.unwrap(), m.rms.unwrap()])
                .collect(),
        ),
        (
            "its contacts",
            contacts.flat_map(|c| [c.peak_force, c.fraction]).collect(),
        ),
        (
            "its powers",
            [observed.input_power, observed.dissipated_power]
                .map(Option::unwrap)
                .to_vec(),
        ),
        (
            "its multipliers",
            multipliers.iter().flat_map(|m| [m.re, m.im]).collect(),
        ),
    ];
    for (what, numbers) in groups {
        if let Some(number) = numbers.iter().find(|x| !x.is_finite()) {
            return Err(format!("{what}: {number} at {}", point.value));
        }
    }
    // Infinite: unknown.
    for (what, error) in [
        ("its error", point.error.unwrap_or(0.0)),
        ("the error of its multipliers", point.stability.error),
    ] {
        if error.is_nan() || error < 0.0 {
            return Err(format!("{what}: {error} at {}", point.value));
        }
    }
    Ok(())
}

/// What all cases came to.
#[derive(Default)]
struct Summary {
    /// How many, and how long together.
    outcomes: BTreeMap<String, (usize, Duration)>,
    /// How long, and which.
    times: Vec<(Duration, u64)>,
    faults: Vec<String>,
}

impl Summary {
    fn add(&mut self, case: &Case, (outcome, elapsed): (Result<String, String>, Duration)) {
        self.times.push((elapsed, case.index));
        match outcome {
            Ok(outcome) => {
                let (count, together) = self.outcomes.entry(outcome).or_default();
                *count += 1;
                *together += elapsed;
            }
            Err(fault) => {
                println!("{fault}\n    {case}");
                self.faults.push(format!("{fault}\n    {case}"));
            }
        }
    }

    fn print(&mut self) {
        for (outcome, (count, together)) in &self.outcomes {
            println!("{count:7}  {together:8.1?}  {outcome}");
        }
        println!("{:7}  faults", self.faults.len());
        self.times.sort_unstable();
        let middle = self.times[self.times.len() / 2].0;
        println!("middle of the times {middle:.1?}, the longest:");
        for &(elapsed, index) in self.times.iter().rev().take(5) {
            println!("{elapsed:10.1?}  {}", Case::draw(index));
        }
    }
}

/// What this thread has worked, where the system tells (Linux does): other programs cost time that is not the case's.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = text.split_whitespace().next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}

fn environment(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

/// Draws and judges cases until there are none left. What is at work is noted, so that a case that never ends is known.
fn work(next: &AtomicU64, end: u64, at_work: &Mutex<Option<(u64, Instant)>>, sum: &Mutex<Summary>) {
    loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        if index >= end {
            *at_work.lock().unwrap() = None;
            return;
        }
        *at_work.lock().unwrap() = Some((index, Instant::now()));
        let case = Case::draw(index);
        let judged = case.judge();
        sum.lock().unwrap().add(&case, judged);
        if index % 1000 == 999 {
            println!("{} cases begun", index + 1);
        }
    }
}

#[test]
fn random_models_end_in_a_curve_or_a_reason() {
    let one = environment("HERTZIAN_MODEL");
    let start = one.unwrap_or(0);
    let end = one.map_or_else(
        || environment("HERTZIAN_MODELS").unwrap_or(MODELS),
        |index| index + 1,
    );
    if one.is_some() {
        println!("{}", Case::draw(start));
    }
    let next = AtomicU64::new(start);
    let sum = Mutex::new(Summary::default());
    let workers = std::thread::available_parallelism().map_or(1, |count| count.get().min(8));
    let at_work: Vec<_> = (0..workers).map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        let workers: Vec<_> = at_work
            .iter()
            .map(|at_work| scope.spawn(|| work(&next, end, at_work, &sum)))
            .collect();
        while workers.iter().any(|worker| !worker.is_finished()) {
            std::thread::sleep(Duration::from_millis(20));
            for at_work in &at_work {
                let hung = at_work
                    .lock()
                    .unwrap()
                    .filter(|(_, at)| at.elapsed() > HUNG);
                if let Some((index, _)) = hung {
                    // Threads cannot be ended from outside; without this the test would wait for ever.
                    eprintln!("does not end: {}", Case::draw(index));
                    std::process::exit(1);
                }
            }
        }
    });
    let mut sum = sum.into_inner().unwrap();
    sum.print();
    assert!(
        sum.faults.is_empty(),
        "{} faults, the first:\n{}",
        sum.faults.len(),
        sum.faults[0]
    );
}
