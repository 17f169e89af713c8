//! The options of the subcommand.

use std::path::PathBuf;

use clap::Parser;
use hertzian_study::Part;

/// Computes the variants of a study file and writes one table of all.
///
/// The file says which model it is, how its parameters vary, what is computed of each variant, and what is kept. Each block of variants is
/// written as it is done: a run that was killed goes on where it was when the same command is given again. Results are the same bit for bit
/// for any number of threads and parts.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "study",
    version,
    after_help = "Examples:\n  \
        hertzian study folds.toml                           into the folder folds-results\n  \
        hertzian study folds.toml --threads 4 --out run1\n  \
        hertzian study folds.toml --part 3/100              one part of a hundred, as a job of an array\n  \
        hertzian study folds.toml --merge                   one table of all parts\n  \
        hertzian study folds.toml --merge a b               of parts that are in several folders, into the first\n\n\
        A study file:\n\n  \
        model = \"one-sided\"                 # a name, or a file beside this one\n  \
        [variants]\n  \
        design = \"sobol\"                    # grid, list, latin-hypercube, sobol, random\n  \
        count = 1000\n  \
        [variants.over]\n  \
        zeta = { from = 0.02, to = 0.05 }\n  \
        drive = { mean = 0.1, percent = 5 }\n  \
        [request]\n  \
        from = 0.6\n  \
        to = 1.6\n\n\
        Exit codes: 0 everything was computed; 2 bad input, or a file cannot be written; 3 interrupted, or variants are missing or could not be computed."
)]
pub struct Options {
    /// The study file
    #[arg(value_name = "FILE")]
    pub file: PathBuf,

    /// The folder of the results [default: the name of the study file with -results, beside it]
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,

    /// Compute one part of so many only, as 3/100; no table is written
    #[arg(long, value_name = "PART/PARTS", value_parser = part, conflicts_with = "merge")]
    pub part: Option<Part>,

    /// Compute nothing: write one table of what is there, in this folder or in these
    #[arg(long, value_name = "FOLDER", num_args = 0.., conflicts_with = "threads")]
    pub merge: Option<Vec<PathBuf>>,

    /// Compute on so many threads [default: as many as the machine runs at once]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

/// Reads `3/100`.
fn part(text: &str) -> Result<Part, String> {
    let (number, of) = text
        .split_once('/')
        .ok_or("expected PART/PARTS, as 3/100")?;
    let count = |text: &str| {
        let count = text.trim().parse::<usize>();
        count.map_err(|_| format!("`{text}` is no number of parts"))
    };
    Part::new(count(number)?, count(of)?).map_err(|error| error.to_string())
}
