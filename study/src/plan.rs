//! What a study file says: model, variants, request, and what is kept.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use hertzian::power::Instructions;
use serde::{Deserialize, Serialize};

use crate::error::StudyError;
use crate::spread::Spread;

/// Everything that a study is: the contents of its file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub struct Plan {
    /// The model: a name, or the path of a file beside the study file.
    pub model: String,
    /// The folder of the results, beside the study file. Default: its name with `-results` in place of the extension.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub results: Option<PathBuf>,
    /// The instruction set that the numbers belong to: `baseline`, `avx2` or `avx512`. Default: the last that the processor has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instructions: Option<InstructionSet>,
    /// What random numbers follow from. Default: 1.
    #[serde(default = "one")]
    pub seed: u64,
    /// So many variants are kept in one file, which is what a part consists of and what is lost when a run is killed. Default: a quarter of
    /// the root of their number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<usize>,
    /// Forms in which the table is written. Default: `csv`.
    #[serde(default = "csv", skip_serializing_if = "Vec::is_empty")]
    pub formats: Vec<Format>,
    /// Values of parameters that every variant has.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
    /// The variants.
    #[serde(default)]
    pub variants: Variants,
    /// What is computed of each.
    pub request: Request,
    /// What is kept of that.
    #[serde(default)]
    pub keep: Keep,
    /// Pictures of the table.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pictures: Vec<Picture>,
}

/// A picture of the table.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub struct Picture {
    /// What is drawn.
    pub what: Shown,
    /// The file, in the folder of the results. Default: `map-1.svg` and so on, with the number of the picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Of a map `stable`, `largest` or `verdict`; of a fan the signal. Default: the number of stable orbits, the first signal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The kind of the events of a histogram. Default: `fold`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
    /// Which of several events of a variant counts, or of several orbits at a value. Default: the highest.
    #[serde(default)]
    pub which: Which,
    /// Quantiles of a histogram or a fan. Default: 5, 25, 50, 75 and 95 %.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantiles: Option<Vec<f64>>,
    /// Whether curves of folds and doublings are followed and drawn over a map. Default: no.
    #[serde(default)]
    pub tracks: bool,
    /// Whether what linear propagation of the distributions says is drawn over a histogram. Default: no.
    #[serde(default)]
    pub linear: bool,
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Shown {
    /// Solutions over two parameters, cell by cell.
    Map,
    /// How often an event lies where.
    #[default]
    Histogram,
    /// Quantiles over what varies along the branches.
    Fan,
}

/// Which of several counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Which {
    /// The highest.
    #[default]
    Highest,
    /// The lowest.
    Lowest,
}

impl std::fmt::Display for Which {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Highest => "highest",
            Self::Lowest => "lowest",
        })
    }
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            model: String::new(),
            results: None,
            instructions: None,
            seed: one(),
            block: None,
            formats: csv(),
            parameters: BTreeMap::new(),
            variants: Variants::default(),
            request: Request {
                vary: omega(),
                ..Request::default()
            },
            keep: Keep::default(),
            pictures: Vec::new(),
        }
    }
}

fn one() -> u64 {
    1
}

fn csv() -> Vec<Format> {
    vec![Format::Csv]
}

/// The name of an instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum InstructionSet {
    /// What every processor of the kind has.
    Baseline,
    /// AVX2 with fused multiply-add.
    Avx2,
    /// AVX-512.
    Avx512,
}

impl From<InstructionSet> for Instructions {
    fn from(set: InstructionSet) -> Self {
        match set {
            InstructionSet::Baseline => Self::Baseline,
            InstructionSet::Avx2 => Self::Avx2,
            InstructionSet::Avx512 => Self::Avx512,
        }
    }
}

impl From<Instructions> for InstructionSet {
    fn from(set: Instructions) -> Self {
        match set {
            Instructions::Avx2 => Self::Avx2,
            Instructions::Avx512 => Self::Avx512,
            _ => Self::Baseline,
        }
    }
}

/// A form in which a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Format {
    /// Values with commas.
    Csv,
    /// An object of JSON in each line.
    Jsonl,
    /// A structured array of numpy.
    Npy,
    /// Parquet, where the program has its feature.
    Parquet,
}

impl Format {
    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Jsonl => "jsonl",
            Self::Npy => "npy",
            Self::Parquet => "parquet",
        }
    }
}

/// Which variants there are.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub struct Variants {
    /// How they are chosen. Default: a grid.
    #[serde(default)]
    pub design: Design,
    /// How many there are; of a grid and of a list the numbers of values say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// A table with a column for each parameter, for a list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// How each parameter varies, by its name.
    #[serde(default)]
    pub over: BTreeMap<String, Spread>,
}

/// How variants are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Design {
    /// Every value of one parameter with every value of the others; the last parameter changes first.
    #[default]
    Grid,
    /// The rows of a table.
    List,
    /// As many parts of every parameter as there are variants, each met once, `McKay`, Beckman and Conover (1979).
    LatinHypercube,
    /// The sequence of Sobol (1967), with the direction numbers of Joe and Kuo (2008), shifted digit by digit by the seed.
    Sobol,
    /// Independently.
    Random,
}

/// What is computed of each variant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub struct Request {
    /// What is asked for. Default: a response.
    #[serde(default)]
    pub what: What,
    /// What varies along a branch. Default: `omega`, the excitation frequency.
    #[serde(default = "omega")]
    pub vary: String,
    /// Where branches begin.
    pub from: f64,
    /// Where they end.
    pub to: f64,
    /// The excitation frequency where a parameter varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub omega: Option<f64>,
    /// How orbits are computed. Default: by the method that fits; solutions by shooting, and by harmonic balance with `bifurcations`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
    /// Relative accuracy of peak-to-peak. Default: 1e-6.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Period of the orbits in periods of the declaration. Default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<usize>,
    /// Whether multipliers are computed. Default: yes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<bool>,
    /// Whether the balance looks for doublings, broken symmetry and branch points too; the other methods do. Default: no.
    #[serde(default)]
    pub bifurcations: bool,
    /// Orbits of a branch, at most. Default: 20000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_points: Option<usize>,
    /// Bifurcations between a branch and the first one, at most, where bifurcations are asked for. Default: 3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<usize>,
    /// The longest period that is followed, where bifurcations are asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_period: Option<usize>,
    /// Whether the range is covered by what motions settle to, where bifurcations are asked for. Default: no.
    #[serde(default)]
    pub cover: bool,
    /// Values of what varies at which solutions are looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Spread>,
}

fn omega() -> String {
    "omega".to_owned()
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum What {
    /// A branch from one end of the range to the other.
    #[default]
    Response,
    /// That, and all branches that begin on it.
    Bifurcations,
    /// Which orbits there are at given values, on branches and by what motions settle to.
    Solutions,
}

/// How orbits are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// By harmonic balance.
    Balance,
    /// By shooting.
    Shooting,
    /// By the contact equation.
    ContactEquation,
}

/// What is kept of each variant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub struct Keep {
    /// Kinds of events that have a row. Default: all that are found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub events: Option<Vec<String>>,
    /// Measured at each orbit that has a row, a column each: `x:p2p`, `tip:rms`. Default: peak-to-peak of the first output, or of the
    /// first coordinate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signals: Option<Vec<String>>,
    /// A row for the orbit at which each of these is largest.
    #[serde(default)]
    pub largest: Vec<String>,
    /// Rows for the orbits at these values of what varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Spread>,
    /// Whether events say how their place moves with every parameter, a column each, and one for its error. Default: no.
    #[serde(default)]
    pub sensitivities: bool,
    /// Whether every branch is kept as a file of its own, which `hertzian show` reads. Default: no.
    #[serde(default)]
    pub branches: bool,
}

impl Plan {
    /// From the text of a study file.
    ///
    /// # Errors
    /// What is wrong with it, with the line; nothing is known of the model yet.
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyError> {
        toml::from_str(text).map_err(|error| {
            let before = error.span().and_then(|span| text.get(..span.start));
            let before = before.unwrap_or_default();
            let line_start = before.rfind('\n').map_or(0, |at| at + 1);
            StudyError::File {
                path: path.to_path_buf(),
                line: 1 + before.matches('\n').count(),
                column: 1 + before[line_start..].chars().count(),
                message: error.message().to_owned(),
            }
        })
    }
}
