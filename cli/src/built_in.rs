//! Models that need no file: declarations with a name each, which are read as files are.

use std::path::Path;
use std::process::ExitCode;

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::program;

/// A declaration, and what it is called on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// Its name.
    pub name: &'static str,
    /// Its text; every parameter has a default.
    pub text: &'static str,
}

macro_rules! built_in {
    ($($name:literal $file:literal)*) => {
        &[$(BuiltIn {
            name: $name,
            text: include_str!(concat!("../../examples/models/", $file)),
        }),*]
    };
}

/// All of them. The first two are also compiled, with the exponent written into the force, and have options of their own.
pub const MODELS: &[BuiltIn] = built_in! {
    "one-sided" "one_sided.txt"
    "continuous" "continuous.txt"
    "cubic-with-stop" "cubic_with_stop.txt"
    "gear-pair" "gear_pair.txt"
    "gear-mesh" "gear_mesh.txt"
    "two-masses" "two_masses.txt"
    "preloaded-stop" "preloaded_stop.txt"
    "ball-bearing" "ball_bearing.txt"
    "tip" "tip.txt"
    "bolted-joint" "bolted_joint.txt"
    "cantilever" "cantilever.txt"
};

impl BuiltIn {
    /// The model of this name; a path with a folder or an extension is a file.
    pub fn named(path: &Path) -> Option<&'static Self> {
        MODELS.iter().find(|model| Path::new(model.name) == path)
    }

    /// What it is, in a line: the first of its documentation.
    pub fn described(&self) -> &'static str {
        let first = self.text.lines().next().unwrap_or_default();
        first.trim_start_matches('/').trim()
    }
}

/// All names, with commas.
pub fn names() -> String {
    let names: Vec<&str> = MODELS.iter().map(|model| model.name).collect();
    names.join(", ")
}

/// A line for each.
fn listing() -> String {
    let line = |model: &BuiltIn| format!("{:<16} {}\n", model.name, model.described());
    MODELS.iter().map(line).collect()
}

/// What `--model` takes.
pub(crate) fn help() -> String {
    format!(
        "The oscillator by its name, or a file that declares it in the language of `hertzian::oscillator!`. Names:\n\n{}\n\
         `hertzian models NAME` prints a declaration, to change it.",
        listing()
    )
}

/// Prints the names of the models, or the declaration of one.
///
/// What is printed of one is a file for `--model`, and, in `hertzian::oscillator! { ... }`, a declaration in Rust.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(after_help = "Examples:\n  \
        hertzian models\n  \
        hertzian models two-masses > mine.txt               to change it, and then:\n  \
        hertzian response --model mine.txt --set drive=0.2")]
pub struct Options {
    /// The name of one [default: all names]
    #[arg(value_parser = PossibleValuesParser::new(MODELS.iter().map(|model| model.name)))]
    pub name: Option<String>,
}

/// Prints what is asked for.
pub(crate) fn start(options: &Options) -> ExitCode {
    let name = options.name.as_ref();
    let model = name.and_then(|name| BuiltIn::named(Path::new(name)));
    let text = model.map_or_else(listing, |model| model.text.to_owned());
    match program::print(&text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => program::unprintable("hertzian models", &error),
    }
}
