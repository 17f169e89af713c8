//! What can be asked for on the command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Parser, ValueEnum};

use super::figures;
use crate::look::Axis;
use crate::misplaced::{Given, count};
use crate::model::ModelOptions;

/// Finds what the motions of a mass on a power-law contact, or of a declared oscillator, settle to, and draws it.
///
/// x'' + 2 zeta H(x) x' + H(x) sgn(x) |x|^alpha = drive cos(omega t) + load
///
/// H(x) is 1 for x > 0 and 0 otherwise (--one-sided), or 1 everywhere (--continuous). States are looked at once in each
/// period, at phase zero. Everything is written to three files: a table (CSV), the same as an array (NPY) and a picture (SVG).
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "attractors",
    version,
    allow_negative_numbers = true,
    args_override_self = true,
    group = ArgGroup::new("task").required(true).args(["sweep", "basin", "lyapunov", "phase", "history"]),
    after_help = figures::help()
)]
#[allow(clippy::struct_excessive_bools, reason = "switches of a command line")]
pub struct Options {
    /// The oscillator
    #[command(flatten)]
    pub model: ModelOptions,

    /// Draw a figure of the paper: stands for the options listed below
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(figures::FIGURES.map(|figure| figure.0)))]
    pub figure: Option<String>,

    /// Bifurcation diagram: what motions settle to as this changes in steps
    #[arg(long, value_enum, value_name = "WHAT")]
    pub sweep: Option<Swept>,

    /// Basins of attraction, on a grid of initial states
    #[arg(long)]
    pub basin: bool,

    /// Lyapunov exponents per period, with standard errors
    #[arg(long)]
    pub lyapunov: bool,

    /// Phase portraits of the attractors found from some starts
    #[arg(long)]
    pub phase: bool,

    /// Time history
    #[arg(long)]
    pub history: bool,

    /// --sweep: with rising values (the default, unless --down is given)
    #[arg(long)]
    pub up: bool,

    /// --sweep: with falling values; after --up, from where that ends
    #[arg(long)]
    pub down: bool,

    /// --sweep: the lowest value
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 0.1,
        allow_hyphen_values = true
    )]
    pub from: f64,

    /// --sweep: the highest value
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 2.0,
        allow_hyphen_values = true
    )]
    pub to: f64,

    /// --sweep: number of values in each direction
    #[arg(long, value_name = "COUNT", default_value_t = 400, value_parser = count)]
    pub values: usize,

    /// --sweep: look where x rises through this value, instead of once in each period
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub section: Option<f64>,

    /// --sweep: what is drawn of the states, a coordinate or an output by its name; a chart for each [default: the first coordinate, or its
    /// rate with --section]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub plot: Vec<String>,

    /// --sweep omega: what is at the axis of the frequency in the picture
    #[arg(long, value_enum, value_name = "UNIT", default_value_t = Axis::Omega)]
    pub axis: Axis,

    /// The state that motions start from, x and x' [default: rest at zero]
    #[arg(long, value_name = "VALUE", num_args = 2..)]
    pub start: Vec<f64>,

    /// Periods that are dropped first [default: 400 with --sweep, 5000 with --lyapunov, otherwise none]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub transient: Option<usize>,

    /// Periods that are looked at [default: 100 with --sweep, 400000 with --lyapunov, 1000 with --history]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub periods: Option<usize>,

    /// --lyapunov: batches that the periods are divided into for the standard error
    #[arg(long, value_name = "COUNT", default_value_t = 40, value_parser = count)]
    pub batches: usize,

    /// --history: show every so many periods
    #[arg(long, value_name = "COUNT", default_value_t = NonZeroUsize::MIN)]
    pub every: NonZeroUsize,

    /// --lyapunov, --phase: do it at each of these amplitudes
    #[arg(long, value_name = "VALUE", value_delimiter = ',', num_args = 1..)]
    pub drives: Vec<f64>,

    /// --phase: also mark the points of the periodic attractor at this amplitude
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub mark: Option<f64>,

    /// --phase: also enlarge this part of the last portrait
    #[arg(long, num_args = 4, value_names = ["X_LOW", "X_HIGH", "V_LOW", "V_HIGH"])]
    pub zoom: Vec<f64>,

    /// --phase: starts along each side of a grid; with 0 the one of --start
    #[arg(long, value_name = "COUNT", default_value_t = 16, value_parser = count)]
    pub starts: usize,

    /// --basin: cells along each side of the grid
    #[arg(long, value_name = "COUNT", default_value_t = 512, value_parser = count)]
    pub grid: usize,

    /// --basin, --phase: range of x on the grid; to be given with --model
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], default_values_t = [-110.0, 15.0])]
    pub x_range: Vec<f64>,

    /// --basin, --phase: range of x' on the grid; to be given with --model
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], default_values_t = [-16.0, 16.0])]
    pub v_range: Vec<f64>,

    /// --basin, --phase: the longest period that is looked for
    #[arg(long, value_name = "COUNT", default_value_t = 64, value_parser = count)]
    pub longest: usize,

    /// --basin, --phase: periods after which a motion is given up that has not come to a periodic orbit
    #[arg(long, value_name = "COUNT", default_value_t = 20_000, value_parser = count)]
    pub patience: usize,

    /// A motion that goes beyond this, in x or x', has escaped
    #[arg(long, value_name = "VALUE", default_value_t = 1e6)]
    pub escape: f64,

    /// Error allowed in a state, relative to the motion; a linear contact is exact whatever this is
    #[arg(long, value_name = "VALUE", default_value_t = 1e-10)]
    pub tolerance: f64,

    /// Where results go: PREFIX.csv, PREFIX.npy and PREFIX.svg
    #[arg(long, value_name = "PREFIX", default_value = "attractors")]
    pub out: PathBuf,

    /// --basin: threads [default: one for each processor]
    #[arg(long, value_name = "COUNT")]
    pub threads: Option<NonZeroUsize>,

    /// --basin, --sweep: keep what is done in this file, and go on from what it holds
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

/// Options and the tasks that look at them.
const BELONGS: [(&str, &[&str]); 24] = [
    ("up", &["sweep"]),
    ("down", &["sweep"]),
    ("from", &["sweep"]),
    ("to", &["sweep"]),
    ("values", &["sweep"]),
    ("section", &["sweep"]),
    ("plot", &["sweep"]),
    ("axis", &["sweep"]),
    ("transient", &["sweep", "lyapunov", "history"]),
    ("periods", &["sweep", "lyapunov", "history"]),
    ("batches", &["lyapunov"]),
    ("every", &["history"]),
    ("drives", &["lyapunov", "phase"]),
    ("mark", &["phase"]),
    ("zoom", &["phase"]),
    ("starts", &["phase"]),
    ("grid", &["basin"]),
    ("x_range", &["basin", "phase"]),
    ("v_range", &["basin", "phase"]),
    ("longest", &["basin", "phase"]),
    ("patience", &["basin", "phase"]),
    ("escape", &["sweep", "basin", "phase"]),
    ("threads", &["basin"]),
    ("checkpoint", &["basin", "sweep"]),
];

impl Options {
    /// What was given and would do nothing, or is missing.
    pub fn fault(&self, given: &Given<'_>) -> Option<String> {
        if let Some(fault) = self.model.fault(given) {
            return Some(fault);
        }
        let swept = self.sweep.map(Swept::name);
        let taken = swept.filter(|name| given.has(name)).map(|name| {
            format!("--sweep {name} takes the place of --{name}: --from and --to say where it begins and ends")
        });
        let set = self.model.set.iter().map(|(name, _)| name.as_str());
        let taken = taken.or_else(|| {
            let name = swept.filter(|swept| set.clone().any(|name| name == *swept))?;
            Some(format!("--sweep {name} takes the place of --set {name}: --from and --to say where it begins and ends"))
        });
        let taken = taken.or_else(|| {
            let drive = if given.has("drive") {
                "--drive"
            } else {
                set.clone().find(|name| *name == "drive")?;
                "--set drive"
            };
            let taken = format!("--drives takes the place of {drive}: give all amplitudes by it");
            given.has("drives").then_some(taken)
        });
        let one = self.phase && self.starts == 0;
        let ranged = given.has("x_range") || given.has("v_range");
        let unused = (one && ranged).then(|| {
            "--x-range and --v-range would do nothing with --starts 0: motions start from --start".to_owned()
        });
        // What motions of a model may reach, its file does not say.
        let looked = self.basin || self.phase && self.starts > 0;
        let ranges = given.has("x_range") && given.has("v_range");
        let missing = (looked && self.model.is_read() && !ranges).then(|| {
            "--model needs --x-range and --v-range here: their defaults are those of the loaded contact".to_owned()
        });
        taken
            .or_else(|| given.misplaced(&BELONGS))
            .or(unused)
            .or(missing)
    }
}

/// What a sweep changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Swept {
    /// The amplitude of the excitation
    Drive,
    /// The frequency of the excitation
    Omega,
    /// The constant load
    Load,
}

impl Swept {
    /// Its name, as the models call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Omega => "omega",
            Self::Load => "load",
        }
    }

    /// What is written at an axis.
    pub fn label(self) -> &'static str {
        match self {
            Self::Drive => "excitation amplitude A",
            Self::Omega => "excitation frequency ω",
            Self::Load => "load W",
        }
    }
}
