//! What belongs to a program that is installed: completions for shells and pages of the manual, from the same options as `--help`.

use std::io;
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::{Args, CommandFactory};

use crate::command::Program;
use crate::program;

/// Subcommands that have a page of their own.
const PAGES: &[&str] = &[
    "response",
    #[cfg(feature = "explore")]
    "explore",
    "show",
    "map",
    "attractors",
    "study",
    "fit",
    "multipliers",
    "paper",
    "work-precision",
    "models",
];

/// Prints completions of this program for a shell.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(after_help = "Examples:\n  \
        hertzian completions bash > ~/.local/share/bash-completion/completions/hertzian\n  \
        hertzian completions fish > ~/.config/fish/completions/hertzian.fish")]
pub struct Shell {
    /// The shell
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Prints a page of the manual, in the format of man.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(after_help = "Examples:\n  \
        hertzian man > hertzian.1\n  \
        hertzian man response > hertzian-response.1\n  \
        hertzian man response | man -l -")]
pub struct Page {
    /// The subcommand [default: the program as a whole]
    #[arg(value_parser = PossibleValuesParser::new(PAGES))]
    pub of: Option<String>,
}

/// Prints completions.
pub(crate) fn completions(shell: &Shell) -> ExitCode {
    let mut text = Vec::new();
    clap_complete::generate(shell.shell, &mut Program::command(), "hertzian", &mut text);
    printed(Ok(text))
}

/// Prints a page in the format of man.
pub(crate) fn man(page: &Page) -> ExitCode {
    let mut all = Program::command();
    // Names subcommands after the program, as `hertzian-response`.
    all.build();
    let of = page.of.as_ref();
    let command = of
        .and_then(|name| all.find_subcommand(name))
        .unwrap_or(&all);
    let mut text = Vec::new();
    let written = clap_mangen::Man::new(command.clone()).render(&mut text);
    printed(written.map(|()| text))
}

fn printed(text: io::Result<Vec<u8>>) -> ExitCode {
    match text.and_then(|text| program::print(&String::from_utf8_lossy(&text))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => program::unprintable("hertzian", &error),
    }
}
