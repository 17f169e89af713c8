//! A branch that is kept in a file while it is followed, with feature `serde`.
//!
//! The file has one object of JSON in each line. The first one is its head: version, model, what is varied, and what was asked for. Each
//! further one has what is new since the one before: orbits, events and turns from a number on, which take the place of those that there
//! were, and what the walk goes on from. The last one says why the branch ended. A line that is not whole, as where the program was
//! killed, is left out when the file is read.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::export::JSON_VERSION;
use crate::branches::branch::{Branch, Further, Model};
use crate::branches::checkpoint::{Keep, Rest};
use crate::branches::engine::Places;
use crate::branches::point::{Event, Point};
use crate::branches::record;
use crate::branches::record::Kept;
use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::Turn;
use crate::report::error::FileError;
use crate::response::{FrequencyResponse, OrbitMethod, Resume};
use crate::time::Work;

/// Of the time of a computation, writing takes no more than one part in so many.
const SHARE: u32 = 20;
/// Nor is it done more often.
const SHORTEST: Duration = Duration::from_millis(50);

/// The first line.
#[derive(Debug, Clone, Serialize)]
struct Head {
    version: u32,
    kept: About,
}

/// The first line of a file of any version.
#[derive(Deserialize)]
struct AnyHead {
    version: u32,
    kept: Value,
}

/// What the branch is.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct About {
    model: Model,
    varied: String,
    request: Further,
}

/// A further line.
#[derive(Debug, Serialize, Deserialize)]
struct Line<P, E, T> {
    points: News<P>,
    events: News<E>,
    turns: News<T>,
    rest: Value,
    end: Option<End>,
}

/// What there is from a number on.
#[derive(Debug, Serialize, Deserialize)]
struct News<L> {
    from: usize,
    list: L,
}

/// How it ended.
#[derive(Debug, Serialize, Deserialize)]
struct End {
    begin: Option<Stop>,
    stopped: Stop,
    statistics: Statistics,
    work: Work,
    #[serde(with = "crate::serialise")]
    elapsed: Duration,
    request: Further,
}

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// Keeps the branch in a file while it is followed, so that it can be read by [`Branch::read`] and [resumed](Branch::resume) where the
    /// program has been killed. A file that is there is replaced by the first orbits. Of [a diagram](crate::Bifurcations) the first branch
    /// is kept. Where the file cannot be written any more, the run ends with that error.
    ///
    /// ```
    /// use hertzian::{Branch, FrequencyResponse};
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let model = Duffing { drive: 0.2 };
    /// # let path = std::env::temp_dir().join(format!("hertzian-keep-{}.json", std::process::id()));
    /// let branch = FrequencyResponse::of(&model).from(0.5).to(1.0).keep(&path).run()?;
    /// assert_eq!(Branch::read(&path)?, branch);
    /// # std::fs::remove_file(path).ok();
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    #[must_use]
    pub fn keep(mut self, path: impl AsRef<Path>) -> Self {
        self.request.keep = Some(Keeper::at(path.as_ref()));
        self
    }
}

impl Resume<'_> {
    /// Keeps the branch in a file while it is followed, as [`FrequencyResponse::keep`] does: it may be the one that it was read from. Of a
    /// branch that goes on beyond its range the part that is new is kept.
    #[must_use]
    pub fn keep(self, path: impl AsRef<Path>) -> Self {
        self.kept_by(Some(Keeper::at(path.as_ref())))
    }
}

/// Keeps a branch in a file.
#[derive(Debug)]
struct Keeper {
    path: PathBuf,
    kept: Mutex<InFile>,
}

/// What is in the file.
#[derive(Debug, Default)]
struct InFile {
    head: Option<Head>,
    /// Open as soon as there is something to keep.
    file: Option<File>,
    points: usize,
    events: Vec<Event>,
    turns: Vec<Turn>,
    /// When it was written last, and how long that took.
    written: Option<(Instant, Duration)>,
    failure: Option<FileError>,
}

impl Keeper {
    fn at(path: &Path) -> Arc<Self> {
        Arc::new(Self {
            path: path.to_path_buf(),
            kept: Mutex::default(),
        })
    }

    /// Writes what is new, and says whether that was possible.
    fn add(&self, kept: Kept<'_>, rest: Value, end: Option<End>) -> bool {
        let mut guard = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let file = &mut *guard;
        if file.failure.is_some() {
            return false;
        }
        let started = Instant::now();
        let points = file.points.min(kept.points.len());
        let events = shared(&file.events, kept.events);
        let turns = shared(&file.turns, kept.turns);
        let line = Line {
            points: News::from(points, kept.points),
            events: News::from(events, kept.events),
            turns: News::from(turns, kept.turns),
            rest,
            end,
        };
        if let Err(source) = file.append(&self.path, &line) {
            file.failure = Some(FileError::not_written(&self.path, &source));
            return false;
        }
        file.points = kept.points.len();
        file.events = kept.events.to_vec();
        file.turns = kept.turns.to_vec();
        file.written = Some((Instant::now(), started.elapsed()));
        true
    }
}

impl InFile {
    /// Whether it is time to write again.
    fn is_due(&self) -> bool {
        let due = |(at, took): (Instant, Duration)| at.elapsed() >= (SHARE * took).max(SHORTEST);
        self.written.is_none_or(due)
    }

    /// Adds a line; the first one with the head, in place of what was there.
    fn append(&mut self, path: &Path, line: &impl Serialize) -> std::io::Result<()> {
        if let Some(file) = &mut self.file {
            let mut text = serde_json::to_vec(line)?;
            text.push(b'\n');
            return file.write_all(&text);
        }
        let mut text = serde_json::to_vec(&self.head)?;
        text.push(b'\n');
        serde_json::to_writer(&mut text, line)?;
        text.push(b'\n');
        hertzian_file::write(path, text)?;
        self.file = Some(OpenOptions::new().append(true).open(path)?);
        Ok(())
    }
}

/// Number of entries that two lists begin with alike.
fn shared<T: PartialEq>(a: &[T], b: &[T]) -> usize {
    a.iter().zip(b).take_while(|(a, b)| a == b).count()
}

impl<'l, T> News<&'l [T]> {
    fn from(from: usize, all: &'l [T]) -> Self {
        let list = all.get(from..).unwrap_or_default();
        Self { from, list }
    }
}

impl<T> News<Vec<T>> {
    /// Takes it into what there was; `None` where something is missing in between.
    fn into(self, all: &mut Vec<T>) -> Option<()> {
        if self.from > all.len() {
            return None;
        }
        all.truncate(self.from);
        all.extend(self.list);
        Some(())
    }
}

impl Keep for Keeper {
    fn begin(&self, model: &Model, varied: &str, further: &Further) -> Result<(), Error> {
        hertzian_file::can_write(&self.path)
            .map_err(|source| FileError::not_written(&self.path, &source))?;
        let head = Head {
            version: JSON_VERSION,
            kept: About {
                model: model.clone(),
                varied: varied.to_owned(),
                request: further.clone(),
            },
        };
        let mut file = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        *file = InFile {
            head: Some(head),
            ..InFile::default()
        };
        Ok(())
    }

    fn keep(&self, kept: Kept<'_>, rest: &dyn Rest) -> bool {
        let due = {
            let file = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            file.is_due()
        };
        // It is plain data, which can always be written.
        !due || self.add(kept, rest.written().unwrap_or_default(), None)
    }

    fn end(&self, branch: &Branch) -> bool {
        let end = End {
            begin: branch.begin,
            stopped: branch.stopped,
            statistics: branch.statistics,
            work: branch.work,
            elapsed: branch.elapsed,
            request: branch.further.clone(),
        };
        self.add(branch.kept(), Value::Null, Some(end))
    }

    fn failure(&self) -> Option<Error> {
        let file = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        file.failure.clone().map(Error::from)
    }
}

/// What is in a file where a branch was kept.
pub(super) struct InKeptFile<'t> {
    /// The version that it was written by.
    pub(super) version: u32,
    about: Value,
    lines: &'t [u8],
}

/// The same of any file; `None` if it is none of these.
pub(super) fn read(text: &[u8]) -> Option<InKeptFile<'_>> {
    let end = text.iter().position(|&byte| byte == b'\n')?;
    let (head, lines) = text.split_at(end + 1);
    let AnyHead { version, kept } = serde_json::from_slice(head).ok()?;
    Some(InKeptFile {
        version,
        about: kept,
        lines,
    })
}

impl InKeptFile<'_> {
    /// The branch. A last line that is not whole is left out.
    ///
    /// # Errors
    /// What is not as it must be.
    pub(super) fn branch(self) -> serde_json::Result<Branch> {
        let lines = self.lines.split_inclusive(|&byte| byte == b'\n');
        let whole = lines.filter(|line| line.ends_with(b"\n"));
        joined(serde_json::from_value(self.about)?, whole)
    }
}

/// What the lines have together.
fn joined<'l>(about: About, lines: impl Iterator<Item = &'l [u8]>) -> serde_json::Result<Branch> {
    let missing = || serde::de::Error::custom("lines of it are missing");
    let (mut points, mut events, mut turns) = (Vec::new(), Vec::new(), Vec::new());
    let mut rest = Value::Null;
    let mut end = None;
    for line in lines {
        let line: Line<Vec<Point>, Vec<Event>, Vec<Turn>> = serde_json::from_slice(line)?;
        line.points.into(&mut points).ok_or_else(missing)?;
        line.events.into(&mut events).ok_or_else(missing)?;
        line.turns.into(&mut turns).ok_or_else(missing)?;
        (rest, end) = (line.rest, line.end);
    }
    let mut branch = Branch {
        model: about.model,
        varied: about.varied,
        points,
        events,
        turns,
        leaps: Vec::new(),
        begin: None,
        stopped: Stop::Interrupted,
        statistics: Statistics::default(),
        work: Work::default(),
        elapsed: Duration::default(),
        further: about.request,
    };
    if let Some(end) = end {
        (branch.begin, branch.stopped) = (end.begin, end.stopped);
        (branch.statistics, branch.work) = (end.statistics, end.work);
        (branch.elapsed, branch.further) = (end.elapsed, end.request);
        return Ok(branch);
    }
    branch.sort(&mut rest);
    branch.further.set_rest(rest);
    Ok(branch)
}

impl Branch {
    /// Brings events and turns in the order of a branch that has ended, and tells what it goes on from where they are now.
    fn sort(&mut self, rest: &mut Value) {
        let order = record::sort(&self.points, &mut self.events, &mut self.turns);
        move_places(rest, "events", &order.events);
        move_places(rest, "turns", &order.turns);
    }
}

fn move_places(rest: &mut Value, name: &str, order: &[usize]) {
    let Some(list) = rest.pointer_mut(&format!("/walk/kept/{name}")) else {
        return;
    };
    if let Ok(mut places) = serde_json::from_value::<Vec<usize>>(list.clone()) {
        Places::sorted(&mut places, order);
        *list = places.into();
    }
}

impl Further {
    /// Puts what the walk goes on from to what was asked for, by whatever method.
    fn set_rest(&mut self, rest: Value) {
        let by = self.written.get_mut("by").and_then(Value::as_object_mut);
        let method = by.and_then(|by| by.values_mut().next());
        if let Some(method) = method.and_then(Value::as_object_mut) {
            method.insert("rest".to_owned(), rest);
        }
    }
}
