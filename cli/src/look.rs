//! How charts look, for every subcommand that draws branches.

use std::str::FromStr;

use clap::{Args, ValueEnum};
use hertzian::chart::{Frequency, Scale, View};
use hertzian::observe::Wanted;
use hertzian::{EventKind, RequestError};

/// How charts look.
#[derive(Debug, Clone, PartialEq, Eq, Default, Args)]
pub struct Look {
    /// The scale of what is measured; decibels are over one unit, which the axis says. What is negative anywhere has no place on db and log;
    /// orbits at zero are left out, and the chart says how many [default: linear; with --bifurcations log, where sizes are very different]
    #[arg(long, value_enum, value_name = "SCALE", requires = "svg")]
    pub scale: Option<ScaleName>,

    /// Mark events of these kinds alone: fold, period-doubling, symmetry-breaking, branch-point, neimark-sacker, grazing, or none; the chart
    /// says how many others there are [default: all]
    #[arg(long, value_name = "KIND", value_delimiter = ',', requires = "svg")]
    pub events: Vec<Marked>,

    /// Draw the amplitudes at the excitation frequency, twice of it, and so on, of so many harmonics upon each other, instead of one measure
    #[arg(long, value_name = "COUNT", default_value_t = 0, requires = "svg", value_parser = crate::misplaced::count)]
    pub stack: usize,
}

/// How values are spread along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ScaleName {
    /// Evenly
    Linear,
    /// By their logarithm
    Log,
    /// By their logarithm, in decibels
    Db,
}

impl From<ScaleName> for Scale {
    fn from(name: ScaleName) -> Self {
        match name {
            ScaleName::Linear => Self::Linear,
            ScaleName::Log => Self::Logarithmic,
            ScaleName::Db => Self::Decibel,
        }
    }
}

/// What is at the axis of the frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Axis {
    /// The angle per time
    Omega,
    /// Periods per second
    Hz,
    /// Periods per minute
    Rpm,
}

impl From<Axis> for Frequency {
    fn from(axis: Axis) -> Self {
        match axis {
            Axis::Omega => Self::Omega,
            Axis::Hz => Self::Hertz,
            Axis::Rpm => Self::Rpm,
        }
    }
}

/// A kind of events that is marked, or none of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marked {
    /// None.
    None,
    /// One kind.
    Kind(EventKind),
}

impl FromStr for Marked {
    type Err = RequestError;

    fn from_str(text: &str) -> Result<Self, RequestError> {
        match text {
            "none" => Ok(Self::None),
            _ => text.parse().map(Self::Kind),
        }
    }
}

impl Look {
    /// Whether nothing was asked for.
    pub fn is_usual(&self) -> bool {
        *self == Self::default()
    }

    /// What charts show that were asked for: one for each.
    pub fn views(&self, axis: Axis, plot: &[Wanted]) -> Vec<View> {
        let view = self.view(axis);
        if plot.is_empty() {
            return vec![view];
        }
        let wanted = plot.iter();
        wanted
            .map(|wanted| view.clone().of(wanted.clone()))
            .collect()
    }

    fn view(&self, axis: Axis) -> View {
        let scale = self.scale.map_or(Scale::Linear, Scale::from);
        let view = View::new()
            .frequency(axis.into())
            .scale(scale)
            .harmonics(self.stack);
        if self.events.is_empty() {
            return view;
        }
        view.events(self.events.iter().filter_map(|marked| match marked {
            Marked::None => None,
            Marked::Kind(kind) => Some(*kind),
        }))
    }
}
