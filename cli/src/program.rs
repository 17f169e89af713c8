//! What every program does around its work: Ctrl-C, a line that shows how far it is, what is printed, and the exit code.

use std::error::Error;
use std::fmt;
use std::io::{self, Write};
use std::process::ExitCode;

use hertzian::Cancel;
use hertzian::error::chain;

use crate::response::progress::Progress;

/// What came of the work.
#[derive(Debug, Clone, PartialEq)]
pub struct Ended {
    /// What is printed.
    pub summary: String,
    /// What is said on standard error.
    pub complaints: Vec<String>,
    /// Whether everything was done that was asked for.
    pub complete: bool,
}

/// Why nothing came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Failed {
    /// What is said on standard error.
    pub message: String,
    /// The exit code.
    pub code: u8,
}

impl Failed {
    /// Bad input, or a file that cannot be used: a sentence, and exit code 2.
    pub fn new(message: impl Into<String>) -> Self {
        let message = message.into();
        Self { message, code: 2 }
    }
}

/// What is said. It is no error of its own, which errors become one of.
impl fmt::Display for Failed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl<E: Error> From<E> for Failed {
    fn from(error: E) -> Self {
        Self::new(chain(&error).to_string())
    }
}

/// The options of a command line. Where there are none to work with, as with `--help`, what the parser says is printed, and the
/// exit code is in the error: 0 if it was asked for, 2 otherwise.
///
/// # Errors
/// If there is nothing to work with.
pub fn options<O>(name: &str, parsed: Result<O, clap::Error>) -> Result<O, ExitCode> {
    parsed.map_err(|error| {
        // The parser says it in colour where that can be seen.
        if error.use_stderr() {
            let _ = error.print();
            return ExitCode::from(2);
        }
        let printed = error.print().and_then(|()| io::stdout().flush());
        match unless_closed(printed) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => unprintable(name, &error),
        }
    })
}

/// Says that standard output takes nothing.
pub fn unprintable(name: &str, error: &io::Error) -> ExitCode {
    let _ = writeln!(
        io::stderr(),
        "{name}: cannot write to standard output: {error}"
    );
    ExitCode::from(2)
}

/// Prints a text, all of it, unless nobody reads it any more.
///
/// # Errors
/// If it cannot be written.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout();
    unless_closed(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Whoever reads the output may have stopped reading: not an error.
fn unless_closed(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// Works, prints, and says by the exit code how it went: 0 done, 2 failed or what the failure says, 3 not complete. A first
/// Ctrl-C cancels the work, a second one ends the program at once.
pub fn run(
    name: &str,
    quiet: bool,
    work: impl FnOnce(&Cancel, &mut Progress) -> Result<Ended, Failed>,
) -> ExitCode {
    let cancel = Cancel::new();
    let token = cancel.clone();
    // Without a handler, Ctrl-C ends the program at once: a nuisance, but no reason not to compute.
    let _ = ctrlc::set_handler(move || {
        if token.is_cancelled() {
            std::process::exit(130);
        }
        token.cancel();
    });
    let mut progress = if quiet {
        Progress::hidden()
    } else {
        Progress::shown(name)
    };
    let outcome = work(&cancel, &mut progress);
    progress.end();
    let complain = |message: &str| {
        let _ = writeln!(io::stderr(), "{name}: {message}");
    };
    match outcome {
        Ok(ended) => {
            for complaint in &ended.complaints {
                complain(complaint);
            }
            let printed = if quiet { Ok(()) } else { print(&ended.summary) };
            if let Err(error) = printed {
                return unprintable(name, &error);
            }
            ExitCode::from(if ended.complete { 0 } else { 3 })
        }
        Err(failed) => {
            complain(&failed.message);
            ExitCode::from(failed.code)
        }
    }
}
