//! A line on the terminal while a long computation runs.

use std::io::{self, Write};
use std::time::{Duration, Instant};

/// Time between two updates: often enough to see that something happens.
const INTERVAL: Duration = Duration::from_millis(200);

/// The line, which is written over itself.
#[derive(Debug)]
pub struct Progress {
    shown: bool,
    written: Instant,
    dirty: bool,
}

impl Progress {
    /// A line that is shown, or one that is not.
    pub fn new(shown: bool) -> Self {
        Self {
            shown,
            written: Instant::now(),
            dirty: false,
        }
    }

    /// Writes the line anew, unless that has been done just now.
    pub fn update(&mut self, text: impl FnOnce() -> String) {
        if self.shown && self.written.elapsed() >= INTERVAL {
            let _ = write!(io::stderr(), "\r\x1b[K{}", text());
            let _ = io::stderr().flush();
            self.written = Instant::now();
            self.dirty = true;
        }
    }

    /// Removes the line.
    pub fn end(&mut self) {
        if self.dirty {
            let _ = write!(io::stderr(), "\r\x1b[K");
            let _ = io::stderr().flush();
            self.dirty = false;
        }
    }
}
