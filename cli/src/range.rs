//! Options that say what varies, and in which range.

use clap::Args;

/// What varies from one value to another.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct RangeOptions {
    /// What varies along the branch, or along a row of a map: `omega`, the frequency of the excitation, or any parameter of the oscillator
    #[arg(long, value_name = "NAME", default_value = "omega")]
    pub sweep: String,

    /// Where its range begins
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 0.6,
        allow_hyphen_values = true
    )]
    pub from: f64,

    /// Where it ends; may be below the beginning
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 1.6,
        allow_hyphen_values = true
    )]
    pub to: f64,
}

impl RangeOptions {
    /// Whether the frequency varies.
    pub fn over_frequency(&self) -> bool {
        self.sweep == "omega"
    }
}
