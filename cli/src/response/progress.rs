//! A line on the terminal while a long computation runs.

use std::io::{self, Write};
use std::time::{Duration, Instant};

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
