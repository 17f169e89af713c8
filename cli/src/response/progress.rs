//! A line on the terminal while a long computation runs.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use hertzian::Stage;

use super::options::Options;

/// Time between two updates: often enough to see that something happens.
const INTERVAL: Duration = Duration::from_millis(200);

/// The line, which is written over itself.
pub struct Progress {
    out: Option<Box<dyn Write + Send>>,
    interval: Duration,
    written: Option<Instant>,
}

impl std::fmt::Debug for Progress {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Progress")
            .field("written", &self.written)
            .finish_non_exhaustive()
    }
}

impl Progress {
    /// A line that is shown, or one that is not.
    pub fn new(shown: bool) -> Self {
        Self {
            out: shown.then(|| Box::new(io::stderr()) as Box<dyn Write + Send>),
            interval: INTERVAL,
            written: None,
        }
    }

    /// A line that is written elsewhere, at every update.
    pub fn to(out: impl Write + Send + 'static) -> Self {
        Self {
            out: Some(Box::new(out)),
            interval: Duration::ZERO,
            written: None,
        }
    }

    /// Writes the line anew, unless that has been done just now.
    pub fn update(&mut self, text: impl FnOnce() -> String) {
        let recent = |written: Instant| written.elapsed() < self.interval;
        if self.written.is_some_and(recent) {
            return;
        }
        if let Some(out) = &mut self.out {
            let _ = write!(out, "\r\x1b[K{}", text());
            let _ = out.flush();
            self.written = Some(Instant::now());
        }
    }

    /// Removes the line.
    pub fn end(&mut self) {
        if let Some(out) = &mut self.out
            && self.written.take().is_some()
        {
            let _ = write!(out, "\r\x1b[K");
            let _ = out.flush();
        }
    }
}

/// Counts what a computation shows, and says it on the line.
pub struct Seen<'p> {
    progress: &'p mut Progress,
    points: usize,
    varied: String,
    from: f64,
}

impl<'p> Seen<'p> {
    /// Nothing seen.
    pub fn new(progress: &'p mut Progress, options: &Options) -> Self {
        let (varied, from) = (options.varied().to_owned(), options.range.from);
        Self {
            progress,
            points: 0,
            varied,
            from,
        }
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
        let (points, varied) = (self.points, &self.varied);
        self.progress
            .update(|| format!("{points} points, {varied} = {value:.6}{how}"));
    }
}
