//! What can be asked for on the command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Parser;
use clap::builder::PossibleValuesParser;

use super::problem;

/// Charts error against time: sampled and exactly switched harmonic balance, and shooting, on the same curves.
///
/// Every method traces the same range. Its time is that of the whole curve without multipliers; its errors are those of the fold
/// of largest amplitude and of one orbit. Results are a chart for each problem (SVG), all figures (CSV), and a page: index.html.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "work-precision",
    version,
    after_help = "Examples:\n  \
        hertzian work-precision --budget 120                all problems, in two minutes\n  \
        hertzian work-precision --only one-sided-1 --repeats 3\n\n\
        Exit codes: 0 done; 2 bad input, or a file that cannot be written; 3 ended early."
)]
pub struct Options {
    /// Folder for the results; made if there is none
    #[arg(long, value_name = "DIR", default_value = "work_precision")]
    pub out: PathBuf,

    /// Only these problems
    #[arg(long, value_name = "PROBLEM", num_args = 1.., value_parser = PossibleValuesParser::new(problem::IDS))]
    pub only: Vec<String>,

    /// Measurements of each method, in turns with all others
    #[arg(long, value_name = "COUNT", default_value_t = NonZeroUsize::new(5).unwrap_or(NonZeroUsize::MIN))]
    pub repeats: NonZeroUsize,

    /// Seconds after which a method is given up
    #[arg(long, value_name = "SECONDS", default_value_t = 3.0)]
    pub patience: f64,

    /// Seconds for all measurements; shared out evenly among the problems, of which none begins a run beyond its share
    #[arg(long, value_name = "SECONDS", default_value_t = 540.0)]
    pub budget: f64,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}
