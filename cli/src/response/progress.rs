//! What is said on standard error while a long computation runs: a line on a terminal, which is written over itself; elsewhere whole lines, seldom. Between
//! two things that are done a watch says how long the present one has taken.

use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use hertzian::Stage;

use super::options::Options;

/// Time between two updates: often enough to see that something happens.
const INTERVAL: Duration = Duration::from_millis(200);
/// What has not been updated for so long is written by the watch.
const STILL: Duration = Duration::from_secs(1);
/// Where there is no terminal the first line comes after so long, and each further one after twice as long.
const SELDOM: Duration = Duration::from_secs(5);
/// What takes longer is worth advice, if there is any.
const LONG: Duration = Duration::from_secs(5);

/// The line.
pub struct Progress {
    shared: Option<Arc<Shared>>,
    watch: Option<JoinHandle<()>>,
}

/// What the watch sees as well.
struct Shared {
    line: Mutex<Line>,
    ended: Condvar,
}

/// Where lines are written.
enum To {
    /// Over each other.
    Terminal,
    /// One below the other, by a program of this name, the next one after so long.
    Log(String, Duration),
}

/// What is written, and when it was.
struct Line {
    out: Box<dyn Write + Send>,
    to: To,
    interval: Duration,
    doing: String,
    /// Since when.
    since: Instant,
    started: Instant,
    written: Option<Instant>,
    /// What is said once where the present takes long.
    advice: Option<String>,
    /// Where there is no terminal lines are written of what was said to be long alone: programs read what is complained of.
    is_long: bool,
    ended: bool,
}

impl Line {
    fn new(out: impl Write + Send + 'static, to: To, interval: Duration) -> Self {
        let now = Instant::now();
        Self {
            out: Box::new(out),
            to,
            interval,
            doing: String::new(),
            since: now,
            started: now,
            written: None,
            advice: None,
            is_long: false,
            ended: false,
        }
    }

    /// Writes the line anew.
    fn show(&mut self, text: &str) {
        let _ = match &self.to {
            To::Terminal => write!(self.out, "\r\x1b[K{text}"),
            To::Log(name, _) => writeln!(self.out, "{name}: {text}"),
        };
        let _ = self.out.flush();
        self.written = Some(Instant::now());
    }

    /// Whether it was written just now.
    fn is_recent(&self, time: Duration) -> bool {
        self.written.is_some_and(|written| written.elapsed() < time)
    }

    /// Whether the watch has to write what has taken so long.
    fn is_due(&self, taken: Duration) -> bool {
        match &self.to {
            To::Terminal => taken >= STILL && !self.is_recent(STILL),
            To::Log(_, next) => self.is_long && self.started.elapsed() >= *next,
        }
    }

    /// Says how long the present thing takes, where nothing else has been said.
    fn look(&mut self) {
        let taken = self.since.elapsed();
        if self.is_due(taken) && !self.doing.is_empty() {
            let text = if taken >= STILL {
                format!("{}, {:.0} s", self.doing, taken.as_secs_f64())
            } else {
                self.doing.clone()
            };
            self.show(&text);
            if let To::Log(_, next) = &mut self.to {
                *next *= 2;
            }
        }
        if taken >= LONG
            && let Some(advice) = self.advice.take()
        {
            let _ = match &self.to {
                To::Terminal => writeln!(self.out, "\r\x1b[K{advice}"),
                To::Log(name, _) => writeln!(self.out, "{name}: {advice}"),
            };
            let _ = self.out.flush();
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Line> {
        self.line.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks at the line until it has ended.
    fn watch(&self) {
        let mut line = self.lock();
        while !line.ended {
            line.look();
            let waited = self.ended.wait_timeout(line, INTERVAL);
            line = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl std::fmt::Debug for Progress {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Progress").finish_non_exhaustive()
    }
}

impl Progress {
    /// Nothing is shown.
    pub fn hidden() -> Self {
        Self {
            shared: None,
            watch: None,
        }
    }

    /// On standard error, by a program of this name, with a watch.
    pub fn shown(name: &str) -> Self {
        let to = if io::stderr().is_terminal() {
            To::Terminal
        } else {
            To::Log(name.to_owned(), SELDOM)
        };
        let mut progress = Self::of(Line::new(io::stderr(), to, INTERVAL));
        if let Some(shared) = progress.shared.clone() {
            // Without one there are fewer lines.
            let watch = thread::Builder::new().spawn(move || shared.watch());
            progress.watch = watch.ok();
        }
        progress
    }

    /// A line that is written elsewhere, at every update.
    pub fn to(out: impl Write + Send + 'static) -> Self {
        Self::of(Line::new(out, To::Terminal, Duration::ZERO))
    }

    fn of(line: Line) -> Self {
        let shared = Shared {
            line: Mutex::new(line),
            ended: Condvar::new(),
        };
        Self {
            shared: Some(Arc::new(shared)),
            watch: None,
        }
    }

    /// What is done may take minutes.
    pub fn expect_long(&mut self) {
        if let Some(shared) = &self.shared {
            shared.lock().is_long = true;
        }
    }

    /// Something begins of which nothing is seen until it is done, with what to say where it takes long.
    pub fn begin(&mut self, doing: &str, advice: Option<String>) {
        if let Some(shared) = &self.shared {
            let mut line = shared.lock();
            doing.clone_into(&mut line.doing);
            line.advice = advice;
            line.since = Instant::now();
        }
    }

    /// Writes the line anew, unless that has been done just now.
    pub fn update(&mut self, text: impl FnOnce() -> String) {
        let Some(shared) = &self.shared else {
            return;
        };
        let mut line = shared.lock();
        line.advice = None;
        line.since = Instant::now();
        if line.is_recent(line.interval) {
            return;
        }
        let text = text();
        match line.to {
            To::Terminal => line.show(&text),
            To::Log(..) => line.written = Some(Instant::now()),
        }
        line.doing = text;
    }

    /// Removes the line.
    pub fn end(&mut self) {
        let Some(shared) = self.shared.take() else {
            return;
        };
        let mut line = shared.lock();
        line.ended = true;
        if matches!(line.to, To::Terminal) && line.written.is_some() {
            let _ = write!(line.out, "\r\x1b[K");
            let _ = line.out.flush();
        }
        drop(line);
        shared.ended.notify_all();
        if let Some(watch) = self.watch.take() {
            let _ = watch.join();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        // Nothing else is looked at any more.
        if self.watch.is_some() {
            self.end();
        }
    }
}

/// Counts what a computation shows, and says it on the line.
pub struct Seen<'p> {
    progress: &'p mut Progress,
    points: usize,
    varied: String,
    from: f64,
    to: f64,
}

impl<'p> Seen<'p> {
    /// Nothing seen.
    pub fn new(progress: &'p mut Progress, options: &Options) -> Self {
        Self {
            progress,
            points: 0,
            varied: options.varied().to_owned(),
            from: options.range.from,
            to: options.range.to,
        }
    }

    /// The first orbit is looked for, with what to say where that takes long.
    pub fn begin(&mut self, advice: Option<String>) {
        let (varied, from) = (&self.varied, self.from);
        let doing = format!("looking for the first orbit, {varied} = {from:.6}");
        self.progress.begin(&doing, advice);
    }

    /// So many of so many orbits were looked at for what the reduction changes.
    pub fn reduced(&mut self, done: usize, total: usize) {
        self.progress.update(|| {
            format!("{done} of {total} orbits looked at for what the reduction changes")
        });
    }

    /// Something was done; it goes on.
    pub fn see(&mut self, done: hertzian::Progress<'_>) -> ControlFlow<()> {
        self.show(done);
        ControlFlow::Continue(())
    }

    /// Something was done.
    pub fn show(&mut self, done: hertzian::Progress<'_>) {
        let value = done.value.unwrap_or(self.from);
        let (count, varied) = (done.done, &self.varied);
        match (done.stage, done.total) {
            (Stage::Settling, Some(total)) => self
                .progress
                .update(|| format!("{count} of {total} motions, {varied} = {value:.6}")),
            (Stage::Solving, Some(total)) => self
                .progress
                .update(|| format!("{count} of {total} states, {varied} = {value:.6}")),
            (Stage::Completing, Some(total)) => self
                .progress
                .update(|| format!("{count} of {total} orbits read off, {varied} = {value:.6}")),
            (Stage::Again, _) => self.count(value, " by the balance"),
            _ => self.at(value),
        }
    }

    /// A point more, at a value.
    pub fn at(&mut self, value: f64) {
        self.count(value, "");
    }

    fn count(&mut self, value: f64, how: &str) {
        self.points += 1;
        let (points, varied, to) = (self.points, &self.varied, self.to);
        self.progress
            .update(|| format!("{points} points, {varied} = {value:.6} on the way to {to}{how}"));
    }
}
