//! One structure: its branch with all modes and with few, compared with what is true of some orbits, and with shooting.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use hertzian::error::{ErrorKind, chain};
use hertzian::structure::Structure;
use hertzian::system::{Place, Signal};
use hertzian::{
    Branch, Complex, ContactEquation, Error, FrequencyResponse, OrbitMethod, OrbitMethodKind,
    Point, Shooting, Stability, System, Verdict,
};
use hertzian_structure::{Direction, Reduction, SparseStructure};
use hertzian_tests::passage::{Passage, Walked, as_far, matched};
use hertzian_tests::random::Random;
use nalgebra::{DMatrix, DVector};

use super::draw::{self, Drawn};
use super::laws::Law;
use super::report::{Kind, Report};
use super::truth::{Question, Truth, Unsure};

/// Points of a branch at most: of a small structure, and of others.
const POINTS: [usize; 2] = [400, 60];
/// Orbits of a branch that are looked at: of the whole structure, and of a reduced one.
pub const ORBITS: [usize; 2] = [3, 2];
/// Time of the processor that a branch may take. What is begun is ended, so that some take longer.
const BUDGET: Duration = Duration::from_secs(2);
/// How far from the true orbit a state may be, relative to the size.
const NEAR: f64 = 1e-2;
/// Up to so many coordinates events are compared with those of shooting.
const SMALL: usize = 6;

/// One structure at work.
pub struct Case {
    pub index: u64,
    pub drawn: Drawn,
    pub sparse: SparseStructure,
    pub random: Random,
    pub report: Report,
}

/// What was asked of errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    /// Of all coordinates, which are amplitudes of modes.
    Modes,
    /// Of the first output.
    Tip,
}

/// Time of the processor that a branch has taken.
struct Clock {
    begun: Duration,
    out: Cell<bool>,
}

impl Clock {
    fn new() -> Self {
        Self {
            begun: now(),
            out: Cell::new(false),
        }
    }

    fn flow(&self) -> ControlFlow<()> {
        if now().saturating_sub(self.begun) > BUDGET {
            self.out.set(true);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

/// What this thread has worked, where the system tells (Linux does), or the time.
fn now() -> Duration {
    thread_local! {
        static STARTED: Instant = Instant::now();
    }
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let spent = text.split_whitespace().next().and_then(|t| t.parse().ok());
    spent.map_or_else(|| STARTED.with(Instant::elapsed), Duration::from_nanos)
}

/// The structure with all modes.
pub struct Whole {
    pub model: Structure,
    /// Coordinates by amplitudes of modes.
    pub modes: DMatrix<f64>,
    /// What is watched of true orbits: amplitudes of modes, and the tip.
    pub watched: DMatrix<f64>,
}

/// What a verdict is against the truth.
pub enum Judged {
    Undecided,
    Right,
    /// Nearer to one than what is known of the multiplier.
    Open,
    /// The largest multiplier says otherwise: its modulus.
    False(f64),
    NoNumber,
}

impl Judged {
    /// Of known multipliers, the largest first, and what they are known to.
    pub fn of(verdict: Verdict, known: &[Complex<f64>], unsure: f64) -> Self {
        let exact = known.first().map_or(0.0, |m| m.norm());
        let margin = match verdict {
            Verdict::Stable => exact - 1.0,
            Verdict::Unstable => 1.0 - exact,
            Verdict::Undecided => return Self::Undecided,
        };
        let mut moduli = known.iter().map(|multiplier| multiplier.norm());
        if moduli.any(f64::is_nan) || unsure.is_nan() {
            Self::NoNumber
        } else if margin > unsure {
            Self::False(exact)
        } else if margin.abs() < unsure {
            Self::Open
        } else {
            Self::Right
        }
    }
}

impl Case {
    pub fn of(index: u64) -> Self {
        let drawn = draw::structure(index);
        Self {
            index,
            sparse: drawn.of_library(),
            random: Random::of(!index),
            drawn,
            report: Report::default(),
        }
    }

    pub fn text(&self) -> String {
        self.drawn.text()
    }

    /// What it comes to.
    pub fn judged(mut self) -> Report {
        let begun = now();
        self.report.count("structures");
        match self.whole() {
            Ok(whole) => self.compare(&whole),
            Err(error) => self.find(Kind::Refused, error.to_string()),
        }
        if !self.report.findings.is_empty() {
            self.report.texts.insert(self.index, self.text());
        }
        let spent = now().saturating_sub(begun).as_secs_f64();
        self.report.times.push((spent, self.index));
        self.report
    }

    pub fn find(&mut self, kind: Kind, text: String) {
        self.report.find(kind, self.index, text);
    }

    pub fn highest(&self) -> f64 {
        self.drawn.range[0].max(self.drawn.range[1])
    }

    fn whole(&self) -> Result<Whole, Box<dyn std::error::Error>> {
        let n = self.drawn.size();
        let reduction = Reduction::to(self.highest()).modes(n).steps(0);
        let model = reduction.run(&self.sparse)?.structure(&self.sparse)?;
        // The same modes, read at all coordinates.
        let read = (0..n).fold(self.sparse.clone(), |read, i| {
            read.output(&format!("x{i}"), Direction::at(i))
        });
        let read = reduction.run(&read)?.structure(&read)?;
        let mut coefficients = vec![0.0; read.facts().places.len()];
        read.coefficients(&[], 1.0, &mut coefficients);
        let mut modes = DMatrix::zeros(n, n);
        for (place, value) in read.facts().places.iter().zip(coefficients) {
            if let Place::Output {
                output,
                of: Signal::Coordinate(mode),
                ..
            } = place
                && (1..=n).contains(output)
            {
                modes[(output - 1, *mode)] = value;
            }
        }
        let mut watched = DMatrix::zeros(n + 1, n);
        watched
            .rows_mut(0, n)
            .copy_from(&(modes.transpose() * &self.drawn.mass));
        watched.row_mut(n).copy_from(&self.drawn.tip.transpose());
        Ok(Whole {
            model,
            modes,
            watched,
        })
    }

    fn compare(&mut self, whole: &Whole) {
        // By what a request takes by itself, or by what the program takes.
        let asked = if !self.drawn.held || self.index.is_multiple_of(2) {
            Asked::Modes
        } else {
            Asked::Tip
        };
        let Some(branch) = self.branch(&whole.model, asked) else {
            return;
        };
        self.orbits(whole, &branch, asked);
        if self.drawn.size() > 2 {
            self.reduced(whole, &branch);
        }
        if self.drawn.held && self.drawn.size() <= SMALL {
            self.events(whole, &branch);
        }
    }

    /// The branch over the range.
    pub fn branch(&mut self, model: &Structure, asked: Asked) -> Option<Branch> {
        let jumps = |law: &Law| matches!(law, Law::Damped { .. });
        let mut laws = self.drawn.contacts.iter().map(|contact| contact.law);
        let closed = laws.clone().all(|law| law.is_affine()) || laws.any(|law| jumps(&law));
        let request = FrequencyResponse::of(model);
        let found = match asked {
            Asked::Modes => self.followed(request),
            Asked::Tip if closed => self.followed(request.by(Shooting::new()).accuracy_of("tip")),
            Asked::Tip => self.followed(request.by(ContactEquation::new()).accuracy_of("tip")),
        };
        match found {
            Ok(branch) => {
                let passage = Passage::of("the branch", &branch);
                for text in passage.unexplained() {
                    self.find(Kind::ChangeWithoutEvent, text);
                }
                self.report.count(match branch.method() {
                    Some(OrbitMethodKind::Shooting) => "branches by shooting",
                    Some(OrbitMethodKind::ContactEquation) => "branches by the contact equation",
                    _ => "branches by the balance",
                });
                if !passage.whole && !passage.cut {
                    self.report
                        .count("branches that ended before the end of the range");
                }
                Some(branch)
            }
            Err(error) => {
                self.no_branch(&error);
                None
            }
        }
    }

    fn followed<M: OrbitMethod>(&mut self, request: FrequencyResponse<M>) -> Result<Branch, Error> {
        let [from, to] = self.drawn.range;
        let clock = Clock::new();
        let found = request
            .from(from)
            .to(to)
            .max_points(POINTS[usize::from(self.drawn.size() > SMALL)])
            .run_with(|_| clock.flow());
        if clock.out.get() {
            self.report.count("branches that ran out of time");
        }
        found
    }

    fn no_branch(&mut self, error: &Error) {
        match error.kind() {
            ErrorKind::NoOrbit => self.report.count("branches without a first orbit"),
            ErrorKind::Limit => self
                .report
                .count("branches without a first orbit within the limit"),
            ErrorKind::Motion => self
                .report
                .count("branches that did not begin: a motion was lost"),
            _ => self.find(Kind::Refused, chain(error).to_string()),
        }
    }

    /// Some points: anywhere, and an unstable one.
    pub fn chosen(&mut self, branch: &Branch, count: usize) -> Vec<usize> {
        let points = &branch.points;
        let unstable = |index: &usize| points[*index].stability.verdict == Verdict::Unstable;
        let unstable: Vec<usize> = (0..points.len()).filter(unstable).collect();
        let mut chosen = Vec::new();
        for turn in 0..count.min(points.len()) {
            chosen.push(if turn == 1 && !unstable.is_empty() {
                unstable[self.random.below(unstable.len())]
            } else {
                self.random.below(points.len())
            });
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }

    /// The true orbit near one of the structure with all modes.
    pub fn truth(&mut self, whole: &Whole, point: &Point) -> Option<Truth> {
        let n = self.drawn.size();
        let state = point.orbit.state();
        let mut guess = DVector::zeros(2 * n);
        for part in 0..2 {
            let amplitudes = DVector::from_column_slice(&state[part * n..(part + 1) * n]);
            guess
                .rows_mut(part * n, n)
                .copy_from(&(&whole.modes * amplitudes));
        }
        let question = Question {
            drawn: &self.drawn,
            watched: &whole.watched,
            omega: point.omega(),
            period: point.orbit.period,
        };
        let stated = point.error.unwrap_or(0.0);
        match question.truth(&guess) {
            Ok(truth)
                if truth.correction > NEAR.max(6.0 * stated)
                    && truth.error < 0.1 * truth.correction =>
            {
                let text = format!(
                    "at {:?}: the true one is {:.1e} of its size away",
                    point.value, truth.correction
                );
                self.find(Kind::Elsewhere, text);
                None
            }
            Ok(truth) if truth.error > 1e-4 => {
                self.report.count("orbits, the truth of which is not sure");
                None
            }
            Ok(truth) => Some(truth),
            Err(unsure) => {
                self.unsure(unsure, point);
                None
            }
        }
    }

    fn unsure(&mut self, unsure: Unsure, point: &Point) {
        self.report.count(match unsure {
            Unsure::Lost(_) => "orbits, the motion of which was lost",
            Unsure::Singular => "orbits with a multiplier of one",
            Unsure::Open(_) => "orbits that did not close",
            Unsure::Touching => "orbits too near a level to be disturbed",
            Unsure::Growing => "orbits of a multiplier too large to close",
        });
        if let Unsure::Open(left) = unsure
            && left > NEAR.max(6.0 * point.error.unwrap_or(0.0))
        {
            let text = format!("at {:?}: {left:.1e} of its size open", point.value);
            self.find(Kind::NotClosed, text);
        }
    }

    /// Orbits of the structure with all modes.
    fn orbits(&mut self, whole: &Whole, branch: &Branch, asked: Asked) {
        for index in self.chosen(branch, ORBITS[0]) {
            let point = &branch.points[index];
            self.report.count("orbits");
            let Some(truth) = self.truth(whole, point) else {
                continue;
            };
            let name = format!("{} at {:?}", said(branch), point.value);
            self.verdict(&name, &truth, &point.stability);
            let Some(stated) = self.stated(&name, point) else {
                self.report.count("orbits without a stated error");
                continue;
            };
            let of = match asked {
                Asked::Modes => of_modes(point, &truth, stated),
                Asked::Tip => {
                    let Ok(tip) = branch.reading("tip", point) else {
                        self.find(Kind::Refused, format!("{name}: no reading of the tip"));
                        continue;
                    };
                    of_one(
                        tip.motion.peak_to_peak(),
                        &truth,
                        self.drawn.size(),
                        [stated, self.drawn.tip.abs().sum()],
                    )
                }
            };
            self.ratio(("orbits of all modes", Kind::Orbit), &name, of);
        }
    }

    /// The stated error of an orbit, where there is a bound.
    pub fn stated(&mut self, name: &str, point: &Point) -> Option<f64> {
        if point.error.is_some_and(f64::is_nan) {
            self.find(Kind::NoNumber, format!("{name}: the stated error"));
        }
        point.error.filter(|error| error.is_finite())
    }

    /// A true error, the stated one, and what the true one is known to.
    pub fn ratio(
        &mut self,
        (of, kind): (&'static str, Kind),
        name: &str,
        [error, stated, unsure]: [f64; 3],
    ) {
        let excess = error - unsure;
        // What is no number would pass for less than what is stated.
        if excess.is_nan() || stated.is_nan() {
            let text = format!("{name}: {error} true (known to {unsure}), {stated} stated");
            return self.find(Kind::NoNumber, text);
        }
        let ratio = if excess > 0.0 { excess / stated } else { 0.0 };
        if ratio > 3.0 {
            let text =
                format!("{name}: {error:.2e} true (known to {unsure:.0e}), {stated:.2e} stated");
            self.find(kind, text);
        }
        self.report.ratio(of, ratio);
    }

    fn verdict(&mut self, name: &str, truth: &Truth, stability: &Stability) {
        let known = truth.elastic(stability.rigid);
        let (stated, unsure) = (stability.error, truth.multiplier_error);
        match Judged::of(stability.verdict, &known, unsure) {
            Judged::Undecided => return self.report.count("verdicts undecided"),
            Judged::Open => self.report.count("verdicts that the truth leaves open"),
            Judged::Right => self.report.count("verdicts that are right"),
            Judged::NoNumber => self.find(Kind::NoNumber, format!("{name}: multipliers")),
            Judged::False(exact) => {
                let largest = stability.multipliers[0].norm();
                let text = format!(
                    "{name}: {}, |mu| {largest:.9} +- {stated:.1e}; it is {exact:.9} +- {unsure:.0e}",
                    stability.verdict
                );
                self.find(Kind::FalseVerdict, text);
            }
        }
        if known.len() != stability.multipliers.len() {
            self.find(
                Kind::Refused,
                format!(
                    "{name}: {} multipliers, not {}",
                    stability.multipliers.len(),
                    known.len()
                ),
            );
            return;
        }
        // The largest distance has no place for what is no number.
        let mut multipliers = stability.multipliers.iter();
        let error = if multipliers.any(|multiplier| multiplier.norm().is_nan()) {
            f64::NAN
        } else {
            hertzian_tests::distance(&stability.multipliers, &known)
        };
        self.ratio(
            ("multipliers of all modes", Kind::Multipliers),
            name,
            [error, stated, unsure],
        );
    }

    /// Events of the branch against those by shooting.
    fn events(&mut self, whole: &Whole, branch: &Branch) {
        let request = FrequencyResponse::of(&whole.model).by(Shooting::new());
        let Ok(other) = self.followed(request) else {
            self.report.count("branches by shooting that did not begin");
            return;
        };
        let walked = |name, branch| Walked {
            passage: Passage::of(name, branch),
            branch,
            units: [1.0; 2],
        };
        let (one, other) = (walked("the branch", branch), walked("shooting", &other));
        let both = if one.passage.whole && other.passage.whole {
            Some([one.passage, other.passage])
        } else {
            as_far(&one, &other)
        };
        let Some([one, other]) = both.filter(|[one, other]| one.shares_ends(other)) else {
            self.report.count("pairs of branches that are not compared");
            return;
        };
        self.report.count("pairs of branches");
        let matched = matched(&one, &other, self.drawn.range);
        for (alone, missing) in matched.alone.iter().zip([&other, &one]) {
            for event in alone {
                self.find(
                    Kind::OneMethod,
                    format!("{event} is missing by {}", missing.name),
                );
            }
        }
        for (ratio, event, seen) in matched.both {
            if ratio > 3.0 {
                self.find(Kind::EventValue, format!("{event}, by shooting {seen}"));
            }
            self.report.ratio("events", ratio);
        }
    }
}

/// Error of the peak-to-peak of amplitudes of modes, as a part of what is stated of each: true, stated, unsure of the worst one.
fn of_modes(point: &Point, truth: &Truth, stated: f64) -> [f64; 3] {
    let motions = &point.observed.motions;
    let largest = motions
        .iter()
        .fold(0.0, |most: f64, motion| most.max(motion.peak_to_peak()));
    let of = |(mode, motion): (usize, &hertzian::observe::Motion)| {
        let own = motion.peak_to_peak();
        let by = if mode == 0 && own > 1e-6 * largest {
            own
        } else {
            largest
        };
        let [least, most] = truth.extremes[mode];
        [
            (own - (most - least)).abs(),
            stated * by,
            truth.extreme_error,
        ]
    };
    // What is no number is the worst.
    let worst = |[error, stated, unsure]: &[f64; 3]| {
        let excess = error - unsure;
        if excess.is_nan() {
            f64::INFINITY
        } else {
            excess / stated
        }
    };
    let all = motions.iter().enumerate().map(of);
    all.max_by(|a, b| worst(a).total_cmp(&worst(b)))
        .unwrap_or_default()
}

/// The same of the signal that is watched last.
pub fn of_one(size: f64, truth: &Truth, watched: usize, [stated, parts]: [f64; 2]) -> [f64; 3] {
    let [least, most] = truth.extremes[watched];
    [
        (size - (most - least)).abs(),
        stated * size,
        parts * truth.extreme_error,
    ]
}

/// By which method a branch was followed.
pub fn said(branch: &Branch) -> String {
    let method = branch.method();
    method.map_or_else(String::new, |method| method.to_string())
}
