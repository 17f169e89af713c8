//! The options of the subcommand.

use std::path::PathBuf;

use clap::Parser;

use crate::misplaced::Given;
use crate::model::ModelOptions;

/// Finds the parameters at which the curves of an oscillator pass through measured ones, with standard errors and what the data cannot tell.
///
/// The table has a line of names, with units in brackets, and a row for each measured value:
///
///   `frequency [Hz], x:p2p [um], sd, sweep, drive`
///
/// `omega`, `frequency`, or the parameter that was varied; what was measured, as --plot of `hertzian response` writes it, in one column or
/// several; and where they are known standard deviations, how the sweep went (rising, falling, settled, controlled), a name of the `set`,
/// and parameters that had several values.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "fit",
    version,
    allow_negative_numbers = true,
    after_help = "Examples:\n  \
        hertzian fit data.csv --free zeta,load              of the one-sided contact of `hertzian response`\n  \
        hertzian fit data.csv --alpha 1.4 --free zeta,load,alpha\n  \
        hertzian fit joint.txt data.csv --free k=1e7..1e9,zeta,preload --json fit.json\n  \
        hertzian fit data.csv --free zeta,load,alpha --against alpha=1.5\n  \
        hertzian fit data.csv --free zeta,load --own drive  each data set has a drive of its own\n  \
        hertzian fit data.csv --free zeta --jump \"x:p2p rising=1.145:0.002\"\n\n\
        Values of --set and defaults are where the search starts. Exit codes: 0 done; 2 bad input; 3 interrupted or not converged: the best values until then."
)]
pub struct Options {
    /// The table of measured values; before it, the oscillator by its name or as a file may stand, as for --model
    #[arg(value_name = "[MODEL] DATA", required = true, num_args = 1..=2)]
    pub files: Vec<PathBuf>,

    /// The oscillator
    #[command(flatten)]
    pub model: ModelOptions,

    /// These parameters are free; NAME=LOW..HIGH within a range, in which starts are looked for too
    #[arg(long, value_name = "NAME[=LOW..HIGH]", value_delimiter = ',', value_parser = free)]
    pub free: Vec<Free>,

    /// Of these every data set has a value of its own, as of the level of the drive
    #[arg(long, value_name = "NAME[=LOW..HIGH]", value_delimiter = ',', value_parser = free)]
    pub own: Vec<Free>,

    /// Also fit with this parameter at a value instead of free, and compare
    #[arg(long, value_name = "NAME=VALUE", value_parser = crate::model::setting)]
    pub against: Vec<(String, f64)>,

    /// A sweep jumped: the branch that it was on ends at this value (of a frequency in radians per unit of time), with this standard deviation, as "SET=VALUE:SD"; "SET=VALUE+:SD" where it goes
    /// on at least that far
    #[arg(long, value_name = "SET=VALUE:SD", value_parser = jump)]
    pub jump: Vec<SetJump>,

    /// Standard deviation of the frequency (in radians per unit of time), or of what was varied [default: a hundredth of the usual step]
    #[arg(long, value_name = "VALUE")]
    pub place_sd: Option<f64>,

    /// Residuals beyond so many standard deviations count by their size and not by their square
    #[arg(long, value_name = "LIMIT")]
    pub huber: Option<f64>,

    /// Try so many starts if the first leads nowhere
    #[arg(long, value_name = "COUNT", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    pub starts: u16,

    /// The picture: data, fit, and residuals below
    #[arg(long, value_name = "FILE", default_value = "fit.svg")]
    pub svg: PathBuf,

    /// Write a row for each measured value to this file: residual, leverage, what would change without it
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,

    /// Write everything to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

/// A parameter that is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Free {
    /// Its name.
    pub name: String,
    /// Its range.
    pub range: Option<[f64; 2]>,
}

/// A jump of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct SetJump {
    /// The name of the set.
    pub set: String,
    /// Where.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Whether the branch may go on beyond.
    pub is_bound: bool,
}

impl Options {
    /// What was given and would do nothing.
    pub(crate) fn fault(&self, given: &Given<'_>) -> Option<String> {
        if self.files.len() > 1 && self.model.file.is_some() {
            return Some(
                "the oscillator is given twice: before the table, and by --model".to_owned(),
            );
        }
        self.model().fault(given)
    }

    /// The table.
    pub fn data(&self) -> &PathBuf {
        &self.files[self.files.len() - 1]
    }

    /// The oscillator, wherever it was given.
    pub fn model(&self) -> ModelOptions {
        let mut model = self.model.clone();
        if self.files.len() > 1 {
            model.file = Some(self.files[0].clone());
        }
        model
    }
}

/// Reads `NAME` or `NAME=LOW..HIGH`.
fn free(text: &str) -> Result<Free, String> {
    let (name, range) = match text.split_once('=') {
        None => (text, None),
        Some((name, range)) => (name, Some(range)),
    };
    let range = range.map(|range| {
        let ends = range.split_once("..").ok_or("expected NAME=LOW..HIGH")?;
        Ok::<_, String>([number(ends.0)?, number(ends.1)?])
    });
    Ok(Free {
        name: name.trim().to_owned(),
        range: range.transpose()?,
    })
}

/// Reads `SET=VALUE:SD` or `SET=VALUE+:SD`.
fn jump(text: &str) -> Result<SetJump, String> {
    let expected = "expected SET=VALUE:SD";
    let (set, rest) = text.rsplit_once('=').ok_or(expected)?;
    let (value, deviation) = rest.split_once(':').ok_or(expected)?;
    let (value, is_bound) = match value.strip_suffix('+') {
        Some(value) => (value, true),
        None => (value, false),
    };
    Ok(SetJump {
        set: set.trim().to_owned(),
        value: number(value)?,
        deviation: number(deviation)?,
        is_bound,
    })
}

fn number(text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.trim().parse().ok();
    let value = value.filter(|value| value.is_finite());
    value.ok_or_else(|| format!("`{text}` is not a number"))
}
