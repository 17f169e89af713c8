//! The subcommands, and which of them a command line asks for.

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::attractors::{self, figures};
use crate::built_in;
#[cfg(feature = "explore")]
use crate::explore;
use crate::install;
use crate::misplaced::{self, Given};
use crate::{fit, map, multipliers, paper, program, response, show, study, work_precision};

/// Vibration of oscillators whose forces are piecewise power laws: contacts that open, springs of any exponent, play, stops.
///
/// An oscillator is given by options, by its name, or by a file that declares it in the language of `hertzian::oscillator!`.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "hertzian",
    version,
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = "Examples:\n  \
        hertzian response                                   a resonance curve, into response.svg\n  \
        hertzian response --help                            its options, with more examples\n  \
        hertzian completions bash > ~/.local/share/bash-completion/completions/hertzian\n  \
        hertzian man response | man -l -                    its page of the manual"
)]
pub struct Program {
    /// What is asked for
    #[command(subcommand)]
    pub task: Task,
}

/// What the program does.
#[derive(Debug, Clone, PartialEq, Subcommand)]
#[expect(
    missing_docs,
    reason = "the documentation of its options is the help of a subcommand"
)]
pub enum Task {
    Response(Box<response::options::Options>),
    #[cfg(feature = "explore")]
    Explore(explore::options::Options),
    Show(show::Options),
    Map(Box<map::Options>),
    Attractors(Box<attractors::options::Options>),
    Study(study::options::Options),
    Fit(Box<fit::options::Options>),
    Multipliers(multipliers::Options),
    Paper(paper::options::Options),
    WorkPrecision(work_precision::options::Options),
    Models(built_in::Options),
    Completions(install::Shell),
    Man(install::Page),
}

impl Program {
    /// From the words of a command line, the first of which is the program; figures stand for their options.
    ///
    /// # Errors
    /// What cannot be understood, and what would do nothing.
    pub fn read(words: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let mut words: Vec<OsString> = words.into_iter().collect();
        if words.get(1).is_some_and(|word| word == "attractors") {
            words = figures::expanded(words);
        }
        misplaced::parsed(words, Self::fault)
    }

    /// What was given and would do nothing.
    fn fault(&self, given: &Given<'_>) -> Option<String> {
        match &self.task {
            Task::Response(options) => options.fault(given),
            Task::Map(options) => options.fault(given),
            Task::Attractors(options) => options.fault(given),
            Task::Fit(options) => options.fault(given),
            _ => None,
        }
    }
}

/// Reads the command line, does what it asks for, and says by the exit code how it went.
pub fn main() -> ExitCode {
    let program = match program::options("hertzian", Program::read(std::env::args_os())) {
        Ok(program) => program,
        Err(code) => return code,
    };
    match program.task {
        Task::Response(options) => response::start(&options),
        #[cfg(feature = "explore")]
        Task::Explore(options) => explore::start(&options),
        Task::Show(options) => show::start(&options),
        Task::Map(options) => map::start(&options),
        Task::Attractors(options) => attractors::start(&options),
        Task::Study(options) => study::start(&options),
        Task::Fit(options) => fit::start(&options),
        Task::Multipliers(options) => multipliers::start(&options),
        Task::Paper(options) => paper::start(&options),
        Task::WorkPrecision(options) => work_precision::start(&options),
        Task::Models(options) => built_in::start(&options),
        Task::Completions(shell) => install::completions(&shell),
        Task::Man(page) => install::man(&page),
    }
}
