//! What can be asked for on the command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Parser;
use clap::builder::PossibleValuesParser;

use super::figures::FIGURES;

/// Draws every figure of a paper and its table, beside exact values.
///
/// Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722. Each figure becomes a picture (SVG) and its data (CSV) in a
/// folder, and all of them a page to look at: index.html.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "paper",
    version,
    after_help = "Examples:\n  \
        hertzian paper                                      everything, into the folder paper\n  \
        hertzian paper --only fig5a fig5b --out resonances\n\n\
        Exit codes: 0 all was drawn; 2 bad input, or a file that cannot be written; 3 a figure failed or was not reached, or a \
        value is missing or not the exact one."
)]
pub struct Options {
    /// Folder for the results; made if there is none
    #[arg(long, value_name = "DIR", default_value = "paper")]
    pub out: PathBuf,

    /// Only these figures
    #[arg(long, value_name = "FIGURE", num_args = 1.., value_parser = PossibleValuesParser::new(FIGURES.iter().map(|figure| figure.id)))]
    pub only: Vec<String>,

    /// Figures that are computed at a time [default: one for each processor]
    #[arg(long, value_name = "COUNT")]
    pub threads: Option<NonZeroUsize>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}
