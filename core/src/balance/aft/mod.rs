//! From the gap of a contact to the Fourier series of its force: the alternating frequency/time step.
//!
//! The balance knows only this: a law, a gap as a series, and the series of force and derivatives that come back.

mod primitive;
mod sampled;
mod samples;
mod switched;

use crate::law::Law;
use primitive::PrimitiveAft;
use sampled::SampledAft;
use switched::SwitchedAft;

/// How the harmonics of a contact force are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Aft {
    /// Integrated from switch to switch: exact, whatever the number of harmonics.
    #[default]
    Switched,
    /// On equally spaced samples: the classical method, for comparison. A switch between two samples is not seen to move.
    Sampled,
    /// On equally spaced samples, with rate terms `h(g) dg/dt` taken as time derivatives of their primitive `G(g)`, which is
    /// continuous where `h` jumps. Laws that have no primitive are sampled.
    Primitive,
}

impl std::fmt::Display for Aft {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Switched => "switched",
            Self::Sampled => "sampled",
            Self::Primitive => "primitive",
        })
    }
}

/// A method, with its workspace.
pub(crate) trait ContactForces: std::fmt::Debug + Send + Sync {
    /// About how many multiplications all evaluations so far have taken.
    fn operations(&self) -> u64;

    /// Writes the series of the force.
    fn force(&mut self, input: ContactInput<'_>, force: &mut [f64]);

    /// Writes the series of the force and of its derivatives.
    fn derivatives(
        &mut self,
        input: ContactInput<'_>,
        change: Option<Change<'_>>,
        force: &mut [f64],
        out: &mut ContactDerivatives<'_>,
    );
}

impl Aft {
    pub(crate) fn engine(self, samples: usize) -> Box<dyn ContactForces> {
        match self {
            Self::Switched => Box::<SwitchedAft>::default(),
            Self::Sampled => Box::new(SampledAft::new(samples)),
            Self::Primitive => Box::new(PrimitiveAft::new(samples)),
        }
    }
}

/// Multiplications that a law and its share of the transforms take at one of many equally spaced samples, about.
const PER_SAMPLE: u64 = 64;

/// The gap of one contact, and how the answer shall change with the continuation parameter.
#[derive(Clone, Copy)]
pub(crate) struct ContactInput<'a> {
    pub(crate) law: &'a dyn Law,
    pub(crate) arguments: &'a [f64],
    /// Series of the gap.
    pub(crate) gap: &'a [f64],
    /// Series of its rate, a time derivative: `base` times the phase derivative of the gap.
    pub(crate) rate: &'a [f64],
    /// Base frequency.
    pub(crate) base: f64,
}

/// Derivatives of gap, rate and arguments with respect to the continuation parameter, the unknowns held fast.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Change<'a> {
    pub(crate) gap: &'a [f64],
    pub(crate) rate: &'a [f64],
    pub(crate) arguments: &'a [f64],
    pub(crate) base: f64,
}

/// Series of the derivatives of the force of one contact; each has as many harmonics as it has room for.
#[derive(Debug)]
#[allow(
    clippy::struct_field_names,
    reason = "each is the derivative by something"
)]
pub(crate) struct ContactDerivatives<'a> {
    pub(crate) by_gap: &'a mut [f64],
    pub(crate) by_rate: &'a mut [f64],
    /// With respect to the continuation parameter, where there is a [`Change`].
    pub(crate) by_parameter: &'a mut [f64],
}
