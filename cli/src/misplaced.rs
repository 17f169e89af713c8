//! Options that would do nothing are refused, so that nobody waits for an effect.

use std::ffi::OsString;

use clap::error::{Error, ErrorKind};
use clap::parser::ValueSource;
use clap::{ArgMatches, Command, Parser};

/// What was given on the command line.
pub struct Given<'m>(&'m ArgMatches);

impl Given<'_> {
    /// Whether an option was.
    pub fn has(&self, id: &str) -> bool {
        self.0.value_source(id) == Some(ValueSource::CommandLine)
    }

    /// The first option of a list that was given without any of those that it belongs to, and what is said of it.
    pub fn misplaced(&self, belongs: &[(&str, &[&str])]) -> Option<String> {
        let alone = |(option, to): &&(&str, &[&str])| {
            self.has(option) && !to.iter().any(|task| self.has(task))
        };
        let (option, to) = belongs.iter().find(alone)?;
        let to: Vec<String> = to.iter().map(|task| dashed(task)).collect();
        let (option, to) = (dashed(option), to.join(" or "));
        Some(format!(
            "{option} belongs to {to} and would do nothing here"
        ))
    }
}

fn dashed(id: &str) -> String {
    format!("--{}", id.replace('_', "-"))
}

/// The options, unless `fault` finds one that would do nothing.
///
/// # Errors
/// What the parser refuses, and that.
pub fn parsed<O: Parser>(
    arguments: impl IntoIterator<Item = OsString>,
    fault: impl Fn(&O, &Given<'_>) -> Option<String>,
) -> Result<O, Error> {
    let mut command = O::command();
    let matches = command.try_get_matches_from_mut(arguments)?;
    let options = O::from_arg_matches(&matches)?;
    // What is given to a subcommand is in its own matches, and the usage that is shown is its own.
    let given = matches.subcommand().map_or(&matches, |(_, given)| given);
    let Some(message) = fault(&options, &Given(given)) else {
        return Ok(options);
    };
    let refuse = |command: &mut Command| command.error(ErrorKind::ArgumentConflict, &message);
    let subcommand = matches
        .subcommand_name()
        .and_then(|name| command.find_subcommand_mut(name));
    let refused = subcommand.map(refuse);
    Err(refused.unwrap_or_else(|| refuse(&mut command)))
}

/// A number of things: zero or more.
///
/// # Errors
/// What it must be.
pub fn count(text: &str) -> Result<usize, String> {
    text.parse()
        .map_err(|_| "must be a whole number, zero or more".to_owned())
}
