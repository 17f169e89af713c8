//! What can be asked for on the command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use hertzian::HarmonicBalance;
use hertzian::chart::View;
use hertzian::observe::Wanted;
use hertzian::sensitivity::Uncertain;
use hertzian::stability::Method;

use crate::look::{Axis, Look};
use crate::misplaced::{Given, count};
use crate::model::{ModelOptions, setting};
use crate::range::RangeOptions;

use super::structure::StructureOptions;

/// Traces the periodic response of a mass on a power-law contact, or of a declared oscillator, says what is stable, and draws it.
///
/// x'' + 2 zeta H(x) x' + H(x) sgn(x) |x|^alpha = drive cos(omega t) + load
///
/// H(x) is 1 for x > 0 and 0 otherwise (--one-sided), or 1 everywhere (--continuous). Without options: figure 5b of
/// Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "response",
    version,
    allow_negative_numbers = true,
    after_help = "Examples:\n  \
        hertzian response --alpha 1 --to 1.4                figure 5a of the paper\n  \
        hertzian response --at 1.1 --csv orbits.csv         every orbit at omega = 1.1; all of them as a table\n  \
        hertzian response --at 1.1 --panels page.svg        with spectrum, motion and force of each\n  \
        hertzian response --bifurcations --follow 1         and what begins where the period doubles\n  \
        hertzian response --sweep drive --omega 0.9 --from 0.01 --to 0.3\n  \
        hertzian response --model two-masses --set drive=0.2\n  \
        hertzian response --model FILE --set zeta=0.01 --to 2.2\n  \
        hertzian response --alpha 1 --by shooting --tolerance 1e-10\n  \
        hertzian response --model gear-pair --values 20     and what motions settle to at 20 values\n  \
        hertzian response --model FILE --plot tip:rms,stop:max --axis hz\n  \
        hertzian response --structure plate.toml --from 700 --to 1500\n  \
        hertzian response --plot x:h1 --sensitivities slopes.csv --tornado moves.svg --uncertain zeta=5%,load=0.02\n  \
        hertzian response --model FILE --plot tip --stack 5 --scale db --events fold,period-doubling\n\n\
        Where the branch turns back or ends early, that from the other end is followed too, and where there is no stable orbit,\n\
        those of what motions settle to; what was joined is said. --one-branch leaves that out.\n\n\
        Exit codes: 0 the range is covered; 2 bad input; 3 a part of it has no orbit, or the one branch\n\
        ended before (what was computed is written)."
)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the command line"
)]
pub struct Options {
    /// The oscillator
    #[command(flatten)]
    pub model: ModelOptions,

    /// A structure of many coordinates
    #[command(flatten)]
    pub structure: StructureOptions,

    /// What varies, and how far
    #[command(flatten)]
    pub range: RangeOptions,

    /// Period of the orbit, in periods of the excitation
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = count)]
    pub period: usize,

    /// How the orbits of the curve are computed; --bifurcations and --track go by shooting [default: contact-equation where a law
    /// opens or has a corner, shooting where a stiffness is unbounded on both sides of a level, else balance; of a --structure shooting
    /// where its laws are made of straight lines or a force jumps, else contact-equation]
    #[arg(long, value_enum, value_name = "METHOD")]
    pub by: Option<By>,

    /// Harmonics per period of the excitation, by the balance [default: from the tolerance]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub harmonics: Option<usize>,

    /// Samples per period of the excitation, by the balance [default: from the harmonics]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub samples: Option<usize>,

    /// How the harmonics of the contact force are computed, by the balance [default: switched]
    #[arg(long, value_enum)]
    pub aft: Option<Aft>,

    /// How the balance computes Floquet multipliers [default: default]
    #[arg(long, value_enum, value_name = "METHOD")]
    pub multipliers: Option<Multipliers>,

    /// Relative accuracy asked of peak-to-peak
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 1e-6,
        allow_hyphen_values = true
    )]
    pub tolerance: f64,

    /// What that accuracy, and the error stated of every orbit, are of: an output or a coordinate [default: all coordinates]
    #[arg(long, value_name = "NAME")]
    pub accuracy_of: Option<String>,

    /// Stop after this many points, those of a branch that is resumed included [default: 20000]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub max_points: Option<usize>,

    /// Only the branch that begins at the start of the range, even if it turns back or ends before the other end
    #[arg(long)]
    pub one_branch: bool,

    /// Follow motions until they settle at so many values of what varies, evenly over the range, to find further branches; without it
    /// only where no stable orbit was found
    #[arg(long, value_name = "COUNT", default_value_t = 0, conflicts_with = "one_branch", value_parser = count)]
    pub values: usize,

    /// Motions from so many initial states at each of these values
    #[arg(long, value_name = "COUNT", default_value_t = 4, conflicts_with = "one_branch", value_parser = count)]
    pub starts: usize,

    /// Follow each of these motions for at most so many periods of the excitation; by default until the slowest linear oscillation has
    /// fallen to a millionth, from 500 to 20000
    #[arg(long, value_name = "COUNT", conflicts_with = "one_branch", value_parser = count)]
    pub patience: Option<usize>,

    /// Also compute every orbit of the branches at exactly these values of what varies
    #[arg(long, value_name = "VALUE", value_delimiter = ',', num_args = 1..)]
    pub at: Vec<f64>,

    /// Also find where the period doubles, a symmetry breaks, quasi-periodic motions begin, and a contact is touched
    #[arg(long)]
    pub bifurcations: bool,

    /// Follow the branches that begin there too, and those that begin on them, to this depth
    #[arg(long, value_name = "DEPTH", requires = "bifurcations", value_parser = count)]
    pub follow: Option<usize>,

    /// Also look for branches that nothing leads to, among what motions settle to at this value of what varies
    #[arg(
        long,
        value_name = "VALUE",
        requires = "bifurcations",
        allow_hyphen_values = true
    )]
    pub search: Vec<f64>,

    /// Follow the curves of these bifurcations in two parameters
    #[arg(long, value_enum, requires = "plane")]
    pub track: Option<Tracked>,

    /// The two parameters of --track; the first is what --sweep varies
    #[arg(
        long = "in",
        id = "plane",
        value_name = "PARAM,PARAM",
        value_delimiter = ',',
        num_args = 1..=2,
        requires = "track"
    )]
    pub plane: Vec<String>,

    /// Range of the second parameter of --track [default: from half to twice its value]
    #[arg(
        long,
        value_name = "VALUE,VALUE",
        value_delimiter = ',',
        num_args = 1..=2,
        requires = "track"
    )]
    pub within: Vec<f64>,

    /// Also draw the free oscillation without damping and excitation, and where the response is in phase resonance
    #[arg(long, conflicts_with = "track")]
    pub backbone: bool,

    /// What is drawn of each orbit: an output, a coordinate or a contact by its name, and what is measured of it: p2p, max, min, mean,
    /// rms, crest, the amplitude of a harmonic as h3, its phase as phase3, of contacts impulse, impacts, piece2; a chart for each
    /// [default: p2p of the first output, or of the coordinate that moves most]
    #[arg(
        long,
        value_name = "NAME:MEASURE",
        value_delimiter = ',',
        conflicts_with_all = ["track", "backbone"]
    )]
    pub plot: Vec<Wanted>,

    /// What is at the axis of the frequency in the picture
    #[arg(long, value_enum, value_name = "UNIT", default_value_t = Axis::Omega, conflicts_with_all = ["track", "backbone"])]
    pub axis: Axis,

    /// How charts look
    #[command(flatten)]
    pub look: Look,

    /// The picture
    #[arg(long, value_name = "FILE", default_value = "response.svg")]
    pub svg: PathBuf,

    /// Draw a page about every orbit at the values of --at into this file: the response with the orbit marked, the spectrum and the motion of
    /// what --plot names first, and the forces of the contacts over the period
    #[arg(long, value_name = "FILE", requires = "at")]
    pub panels: Option<PathBuf>,

    /// And, on that page, each of these orbits in the plane of two signals: NAME over NAME, as the path of a shaft
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', num_args = 1..=2, requires = "panels")]
    pub path: Vec<String>,

    /// Write one row per point to this file
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,

    /// Write everything to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Write derivatives by omega and every parameter to this file, with errors: of what --plot names, or of everything that is read off an orbit, at
    /// every orbit, and of where events are; and to --json
    #[arg(long, value_name = "FILE")]
    pub sensitivities: Option<PathBuf>,

    /// Draw what moves each event most into this file: a bar for each parameter of --uncertain, or for one per cent of every one
    #[arg(long, value_name = "FILE")]
    pub tornado: Option<PathBuf>,

    /// Standard uncertainties of parameters, of the parameter or as a part of its value: zeta=0.002,load=5%. They make a band around the curve
    #[arg(
        long,
        value_name = "NAME=VALUE",
        value_delimiter = ',',
        conflicts_with_all = ["track", "backbone"]
    )]
    pub uncertain: Vec<Uncertain>,

    /// The first orbit is near one of this file, of `--json` or --keep: that whose value is nearest to the start of the range
    #[arg(long, value_name = "FILE", conflicts_with = "at_rest")]
    pub near: Option<PathBuf>,

    /// The first orbit is near the motion from rest at this position of a coordinate; the others are at zero
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub at_rest: Vec<(String, f64)>,

    /// Keep the branch in this file while it is followed, for --resume and `hertzian show`; that from the start of the range, where
    /// others are joined
    #[arg(long, value_name = "FILE")]
    pub keep: Option<PathBuf>,

    /// Go on with the branch that was kept in this file, of the same oscillator, in the range and with the options that it has; alone,
    /// and kept in the file as it goes on
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with_all = ["keep", "bifurcations", "track", "backbone", "values", "starts", "patience", "one_branch", "period", "near", "at_rest"]
    )]
    pub resume: Option<PathBuf>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

/// What is tracked in two parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Tracked {
    /// Folds
    Fold,
    /// Period doublings
    PeriodDoubling,
    /// Where a symmetry breaks
    BranchPoint,
    /// Where a gap touches a level
    Grazing,
}

/// How orbits are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum By {
    /// Harmonic balance
    Balance,
    /// Shooting: motions that return to their first state
    Shooting,
    /// The forces of contacts and their ends as unknowns, which pays where contacts open
    ContactEquation,
}

/// How the harmonics of the contact force are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Aft {
    /// Integrated from switch to switch: exact
    Switched,
    /// From samples over the period (Cameron and Griffin 1989)
    Sampled,
    /// From samples, with damping as the time derivative of its primitive
    Primitive,
}

impl From<Aft> for hertzian::Aft {
    fn from(aft: Aft) -> Self {
        match aft {
            Aft::Switched => Self::Switched,
            Aft::Sampled => Self::Sampled,
            Aft::Primitive => Self::Primitive,
        }
    }
}

/// How Floquet multipliers are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Multipliers {
    /// The cheapest method whose estimated error is small enough
    Default,
    /// The monodromy matrix, from switch to switch, as exactly as it can be
    Monodromy,
    /// Eigenvalues of the Hill matrix, sorted by symmetry, without copies
    Hill,
    /// The same, sorted by the smallest imaginary part
    HillImaginaryPart,
    /// The same, sorted by the weighted mean of the eigenvector
    HillWeightedMean,
    /// Koopman-Hill projection
    KoopmanHill,
    /// Koopman-Hill projection with half harmonics
    KoopmanHillSubharmonic,
}

impl From<Multipliers> for Method {
    fn from(multipliers: Multipliers) -> Self {
        match multipliers {
            Multipliers::Default => Self::Default,
            Multipliers::Monodromy => Self::Monodromy,
            Multipliers::Hill => Self::Hill,
            Multipliers::HillImaginaryPart => Self::HillImaginaryPart,
            Multipliers::HillWeightedMean => Self::HillWeightedMean,
            Multipliers::KoopmanHill => Self::KoopmanHill,
            Multipliers::KoopmanHillSubharmonic => Self::KoopmanHillSubharmonic,
        }
    }
}

impl Options {
    /// What was given and would do nothing.
    pub fn fault(&self, given: &Given<'_>) -> Option<String> {
        if let Some(fault) = self.model.fault(given) {
            return Some(fault);
        }
        let swept = self.varied();
        let known = ["omega", "alpha", "zeta", "load", "drive"].contains(&swept);
        if (known && given.has(swept)) || self.model.set.iter().any(|(name, _)| name == swept) {
            return Some(format!(
                "--sweep {swept} takes the place of the value of {swept}: --from and --to say where it begins and ends"
            ));
        }
        let kept = [
            "from",
            "to",
            "sweep",
            "by",
            "harmonics",
            "samples",
            "aft",
            "multipliers",
            "tolerance",
            "accuracy_of",
        ];
        if self.resume.is_some() && kept.iter().any(|option| given.has(option)) {
            let fault = "--resume takes range and options from the file: leave them out, but those of the oscillator";
            return Some(fault.to_owned());
        }
        let motions = ["values", "starts", "patience"];
        let motions = motions.iter().any(|option| given.has(option));
        if motions && self.track.is_some() && !self.bifurcations {
            let fault =
                "--values, --starts and --patience do nothing beside --track: add --bifurcations";
            return Some(fault.to_owned());
        }
        if let Some(fault) = self.of_the_balance(given) {
            return Some(fault);
        }
        let look = ["scale", "events", "stack"];
        let look = look.into_iter().find(|option| given.has(option));
        if let Some(option) = look.filter(|_| self.track.is_some()) {
            return Some(format!(
                "--{option} does nothing beside --track: the chart is of curves in two parameters"
            ));
        }
        if !self.uncertain.is_empty() && given.has("stack") {
            let fault =
                "--uncertain draws a band around one curve, and --stack several: leave one out";
            return Some(fault.to_owned());
        }
        if self.backbone && given.has("stack") {
            let fault =
                "--backbone is of peak-to-peak, and --stack draws amplitudes: leave one out";
            return Some(fault.to_owned());
        }
        let samples = given.has("samples") && !self.is_sampled();
        samples.then(|| {
            "--samples belongs to --aft sampled or --aft primitive: nothing is sampled here"
                .to_owned()
        })
    }

    /// What belongs to the harmonic balance, beside another method.
    fn of_the_balance(&self, given: &Given<'_>) -> Option<String> {
        let options = ["harmonics", "samples", "aft", "multipliers"];
        let mut options = options.into_iter().filter(|option| given.has(option));
        let option = options
            .next()
            .filter(|_| self.method() != Some(By::Balance))?;
        Some(format!(
            "--{option} belongs to --by balance and would do nothing here"
        ))
    }

    /// How the orbits of the curve are computed, where that was asked for: by the balance where an option of it was given. `None` where the
    /// library chooses.
    pub fn method(&self) -> Option<By> {
        let of_structures = self.structure.file.is_some();
        let of_the_balance = self.harmonics.is_some()
            || self.samples.is_some()
            || self.aft.is_some()
            || self.multipliers.is_some();
        let default = if of_structures {
            Some(By::Shooting)
        } else {
            of_the_balance.then_some(By::Balance)
        };
        self.by.or(default)
    }

    /// The balance with its options.
    pub fn balance(&self) -> HarmonicBalance {
        let mut balance = HarmonicBalance::new();
        if let Some(aft) = self.aft {
            balance = balance.aft(aft.into());
        }
        if let Some(multipliers) = self.multipliers {
            balance = balance.multipliers(multipliers.into());
        }
        if let Some(harmonics) = self.harmonics {
            balance = balance.harmonics(harmonics);
        }
        if let Some(samples) = self.samples {
            balance = balance.samples(samples);
        }
        balance
    }

    /// Whether contact forces are sampled.
    pub fn is_sampled(&self) -> bool {
        self.aft.is_some_and(|aft| aft != Aft::Switched)
    }

    /// Name of what varies, as the models call it.
    pub fn varied(&self) -> &str {
        &self.range.sweep
    }

    /// What the charts show: one for each.
    pub fn views(&self) -> Vec<View> {
        self.look.views(self.axis, &self.plot)
    }

    /// Whether that is the frequency.
    pub fn over_frequency(&self) -> bool {
        self.range.over_frequency()
    }
}
