//! Options that say which oscillator a program is about.

use std::path::PathBuf;

use clap::Args;

use crate::values;

/// An oscillator on a power-law contact, or one from a file.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct ModelOptions {
    /// Exponent of the force, positive
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 1.5,
        allow_hyphen_values = true
    )]
    pub alpha: f64,

    /// Contact that can be lost: force and damping act for x > 0 only (the default)
    #[arg(long, conflicts_with = "continuous")]
    pub one_sided: bool,

    /// Contact that cannot be lost: force and damping act everywhere
    #[arg(long)]
    pub continuous: bool,

    /// Read the oscillator from this file instead, in the language of `hertzian::oscillator!`
    #[arg(
        long = "model",
        value_name = "FILE",
        conflicts_with_all = ["alpha", "one_sided", "continuous", "zeta", "load", "drive"]
    )]
    pub file: Option<PathBuf>,

    /// Value of a parameter of that oscillator
    #[arg(long, value_name = "NAME=VALUE", requires = "file", value_parser = setting)]
    pub set: Vec<(String, f64)>,

    /// Damping ratio, not negative
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 0.032,
        allow_hyphen_values = true
    )]
    pub zeta: f64,

    /// Constant load W
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 1.0,
        allow_hyphen_values = true
    )]
    pub load: f64,

    /// Amplitude A of the excitation; with --sweep drive, the range takes its place
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 0.1,
        allow_hyphen_values = true
    )]
    pub drive: f64,

    /// Frequency of the excitation, positive, where it is not what varies [default: 1]
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub omega: Option<f64>,
}

/// Said where a frequency is given, and a range of it too.
pub const FREQUENCY_VARIES: &str = "--omega cannot be used where omega varies: the range gives it";

impl ModelOptions {
    /// Whether every parameter is set once, to a number, and of an oscillator that has it.
    ///
    /// # Errors
    /// If one is not.
    pub fn check(&self) -> Result<(), String> {
        if let (Some((name, _)), None) = (self.set.first(), &self.file) {
            return Err(format!(
                "--set {name} belongs to --model and would do nothing here"
            ));
        }
        for (name, value) in &self.set {
            values::finite(&format!("--set {name}"), *value)?;
        }
        values::once("--set", self.set.iter().map(|(name, _)| name.as_str()))
    }

    /// Whether contact can be lost.
    pub fn loses_contact(&self) -> bool {
        self.file.is_none() && !self.continuous
    }

    /// Frequency of the excitation where it does not vary.
    pub fn frequency(&self) -> f64 {
        self.omega.unwrap_or(1.0)
    }
}

/// Reads `NAME=VALUE`.
fn setting(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    let value = value
        .trim()
        .parse()
        .map_err(|_| format!("`{value}` is not a number"))?;
    Ok((name.trim().to_owned(), value))
}
