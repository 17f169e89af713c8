//! Branches of what was asked for, by the same functions as those of `hertzian response`.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use hertzian::bifurcation::Diagram;
use hertzian::error::ErrorKind;
use hertzian::{Branch, Cancel, Error, FrequencyResponse, Point, Stop, System, Verdict};

use super::asked::{Asked, Effort, Method};
use super::declared::Texts;
use super::fault::{Fault, Kind};
use crate::response::bifurcations::Found;
use crate::response::options::{By, Options};
use crate::response::progress::{Progress, Seen};
use crate::response::{bifurcations, completed, covered, run};

/// A pixel of a picture that is some five hundred of them high.
const PIXEL: f64 = 2e-3;
/// Longest step on the screen: lines are bent between orbits.
const STRIDE: f64 = 0.2;
/// Orbits on the screen, at most: a branch that winds is not looked at while it moves.
const MOST_ON_SCREEN: usize = 600;
/// Between two lines about progress.
pub(super) const INTERVAL: Duration = Duration::from_millis(150);
/// A stretch without stable orbits is looked into if it is longer than this part of the range, as a search is.
const LACKING: f64 = 1e-2;

/// What is told of work that takes long.
pub type Tell = Arc<dyn Fn(&str) + Send + Sync>;

/// What was found.
pub struct Traced {
    /// What was asked for.
    pub asked: Asked,
    /// The same as options.
    pub options: Options,
    /// The model at its values.
    pub model: Box<dyn System>,
    /// The branches; the first is the one that was asked for.
    pub diagram: Diagram,
    /// Where branches from bifurcations were asked for, by shooting, the one that was asked for by its own method, and what was found.
    pub followed: Option<(Branch, Found)>,
    /// Whether it was looked for all that covers the range.
    pub whole: bool,
    /// How long it took.
    pub elapsed: Duration,
}

impl std::fmt::Debug for Traced {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Traced")
            .field("asked", &self.asked)
            .field("branches", &self.diagram.branches.len())
            .finish_non_exhaustive()
    }
}

impl Traced {
    /// By what the orbits of the first curve were asked for.
    pub fn by(&self) -> By {
        self.options.by.unwrap_or(By::Balance)
    }

    /// All branches as they are written to files, with everything that can be read off their orbits.
    ///
    /// # Errors
    /// If it is cancelled.
    pub fn written(&self, cancel: &Cancel) -> Result<Vec<Branch>, Fault> {
        let first = self.followed.iter().map(|(first, _)| first);
        let mut branches: Vec<Branch> = first.chain(self.branches()).cloned().collect();
        completed::all(&mut branches, cancel, |_| ());
        if cancel.is_cancelled() {
            return Err(Fault::cancelled());
        }
        Ok(branches)
    }

    /// The branches that are drawn.
    pub fn branches(&self) -> impl Iterator<Item = &Branch> {
        self.diagram.branches.iter().map(|found| &found.branch)
    }

    /// Whether there is more to be found by `hertzian response`: the branch ends before the range does, or nothing stable is on a part of it.
    pub fn lacks(&self) -> bool {
        let ended = self
            .branches()
            .any(|branch| branch.stopped != Stop::ReachedEnd);
        !self.whole && (ended || self.longest_lacking() > LACKING)
    }

    /// The longest stretch without stable orbits, as a part of the range.
    fn longest_lacking(&self) -> f64 {
        let range = [
            self.asked.from.min(self.asked.to),
            self.asked.from.max(self.asked.to),
        ];
        let stable = |point: &Point| point.stability.verdict == Verdict::Stable;
        let mut stretches: Vec<[f64; 2]> = Vec::new();
        for branch in self.branches() {
            let pairs = branch.points.windows(2);
            let pairs = pairs.filter(|pair| stable(&pair[0]) || stable(&pair[1]));
            stretches.extend(pairs.map(|pair| {
                let [a, b] = [pair[0].value, pair[1].value];
                [a.min(b), a.max(b)]
            }));
        }
        stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut reached, mut longest) = (range[0], 0.0_f64);
        for [low, high] in stretches {
            longest = longest.max(low - reached);
            reached = reached.max(high);
        }
        longest.max(range[1] - reached) / (range[1] - range[0])
    }
}

/// The branch that was asked for alone, or with `whole` all that `hertzian response` finds.
///
/// # Errors
/// What makes no sense, faults of the declaration, and if there is no first orbit.
pub fn trace(
    asked: &Asked,
    effort: Effort,
    whole: bool,
    texts: &Texts,
    cancel: &Cancel,
    tell: &Tell,
) -> Result<Traced, Fault> {
    asked.check()?;
    let begun = Instant::now();
    let model = asked.model(texts)?;
    let method = match (effort, asked.by) {
        // Few digits are cheapest by few harmonics.
        (Effort::Screen, Method::Automatic) => By::Balance,
        _ => asked.method(&*model)?,
    };
    let one = |method: By| -> Result<(Options, Diagram), Fault> {
        let mut options = asked.options(method)?;
        options.one_branch = !whole && asked.depth.is_none();
        let diagram = find(&options, effort, &*model, cancel, tell)?;
        Ok((options, diagram))
    };
    let mut found = one(method);
    // Where the method that pays most does not get through, the one that is most robust is asked.
    let gives_up = match &found {
        Ok((_, diagram)) => diagram.branches.iter().any(|found| is_lost(&found.branch)),
        Err(fault) => fault.kind == Kind::Computation,
    };
    if gives_up && asked.by == Method::Automatic && method != By::Balance {
        found = one(By::Balance).or(found);
    }
    let (options, mut diagram) = found?;
    let followed = if asked.depth.is_some() && effort == Effort::Full {
        let followed = follow(&options, &*model, &diagram, cancel, tell)?;
        diagram = followed.1.diagram.clone();
        Some(followed)
    } else {
        None
    };
    if cancel.is_cancelled() {
        return Err(Fault::cancelled());
    }
    Ok(Traced {
        asked: asked.clone(),
        options,
        model,
        diagram,
        followed,
        whole: whole || asked.depth.is_some(),
        elapsed: begun.elapsed(),
    })
}

/// Whether a branch ended because nothing further was found.
fn is_lost(branch: &Branch) -> bool {
    matches!(
        branch.stopped,
        Stop::StepTooShort { .. } | Stop::Motion { .. }
    )
}

fn find(
    options: &Options,
    effort: Effort,
    model: &dyn System,
    cancel: &Cancel,
    tell: &Tell,
) -> Result<Diagram, Fault> {
    let request = run::request(options, model).cancel(cancel);
    let mut progress = Progress::to(Line::new(tell));
    let mut seen = Seen::new(&mut progress, options);
    if effort == Effort::Screen {
        let request = request
            .tolerance(PIXEL)
            .largest_step(STRIDE)
            .max_points(MOST_ON_SCREEN);
        return Ok(covering(options, request, &mut |done| seen.see(done))?);
    }
    Ok(covering(options, request, &mut |done| seen.see(done))?)
}

/// What begins on the first of these branches, and that branch.
fn follow(
    options: &Options,
    model: &dyn System,
    diagram: &Diagram,
    cancel: &Cancel,
    tell: &Tell,
) -> Result<(Branch, Found), Fault> {
    let mut progress = Progress::to(Line::new(tell));
    let mut seen = Seen::new(&mut progress, options);
    let found = bifurcations::find(options, model, cancel, &mut seen)?;
    let first = diagram.branches.first();
    let first = first.map(|found| found.branch.clone());
    first.zip(found).ok_or_else(Fault::cancelled)
}

fn covering(
    options: &Options,
    request: FrequencyResponse,
    visit: &mut dyn FnMut(hertzian::Progress<'_>) -> ControlFlow<()>,
) -> Result<Diagram, Error> {
    covered::by_method(options, request, visit)
}

/// Takes the line that shows progress on a terminal, and tells it.
struct Line {
    tell: Tell,
    text: Vec<u8>,
    told: Instant,
}

impl Line {
    fn new(tell: &Tell) -> Self {
        Self {
            tell: Arc::clone(tell),
            text: Vec::new(),
            told: Instant::now(),
        }
    }
}

impl Write for Line {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.text.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.told.elapsed() >= INTERVAL {
            self.told = Instant::now();
            let text = String::from_utf8_lossy(&self.text);
            // What a terminal is told to do with the line before.
            let text = text.rsplit('\u{1b}').next().unwrap_or_default();
            (self.tell)(text.trim_start_matches("[K"));
        }
        self.text.clear();
        Ok(())
    }
}

/// Whether an error is that of a computation that was stopped.
pub fn is_cancelled(error: &Error) -> bool {
    error.kind() == ErrorKind::Cancelled
}
