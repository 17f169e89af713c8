//! What can be asked for on the command line.

use std::path::PathBuf;

use clap::Args;

use crate::model::setting;

/// Opens a page on this machine on which a model is changed by hand: its curve, its stability and its motions move along.
///
/// The page is served on 127.0.0.1 alone, to whoever is at this machine, and needs no network. Nothing is written; what is exported goes
/// through the browser. Ctrl-C ends it.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(after_help = "Examples:\n  \
        hertzian explore --open                             figure 5b, in the browser\n  \
        hertzian explore two-masses --set drive=0.2\n  \
        hertzian explore mine.txt --from 0.4 --to 2.2 --port 8080")]
pub struct Options {
    /// The oscillator to begin with: its name, of `hertzian models`, or a file that declares it in the language of
    /// `hertzian::oscillator!`
    #[arg(value_name = "MODEL", default_value = "one-sided")]
    pub model: PathBuf,

    /// Value of a parameter to begin with
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub set: Vec<(String, f64)>,

    /// Where the range of the frequency begins [default: that of an example with this model, or 0.6]
    #[arg(long, value_name = "VALUE")]
    pub from: Option<f64>,

    /// Where it ends [default: that of an example with this model, or 1.6]
    #[arg(long, value_name = "VALUE")]
    pub to: Option<f64>,

    /// The port to listen on; 0 takes a free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    pub port: u16,

    /// Open the page in the browser
    #[arg(long)]
    pub open: bool,
}
