//! Options of shooting.

use crate::orbit::observe::Accuracy;

/// Orbits as states that return to themselves, found by Newton's method on motions in time (multiple shooting): nothing is left out of
/// an orbit but the error of the flow. Systems of which every piece is affine have their motions in closed form; those of others are
/// integrated.
///
/// All bifurcations are located with the multipliers. Free systems, which nothing holds in place, are refused.
///
/// ```
/// use hertzian::{EventKind, FrequencyResponse, Shooting};
///
/// hertzian::oscillator! {
///     OneSided(x) {
///         param load;
///         param drive;
///         law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
///         ddot(x) + contact(x) = drive*cos(omega*t) + load;
///     }
/// }
///
/// let model = OneSided { load: 1.0, drive: 1.0 };
/// let request = FrequencyResponse::of(&model).by(Shooting::new()).vary("drive").omega(1.0);
/// let orbit = request.orbit(1.0)?.orbit;
/// let branch = request.near_orbit(&orbit).from(1.0).to(1.4).run()?;
/// let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
/// assert!((doubling.point.value - 1.282584167663768).abs() < 1e-11);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Shooting {
    pub(crate) segments: Option<usize>,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) tolerance: Option<f64>,
    /// What the accuracy is of.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) accuracy: Accuracy,
}

/// Flows are so much more accurate than what is asked of the output.
const FINER: f64 = 1e-4;
/// The default is no coarser and no finer than these.
const BY_DEFAULT: [f64; 2] = [1e-13, 1e-6];

impl Shooting {
    /// With everything by default.
    pub fn new() -> Self {
        Self::default()
    }

    hertzian_contract::setters! { self:
        /// Segments that the orbit is divided into: multiple shooting. Default: one for each period of the declaration. More of them help
        /// where neighbouring motions part fast. What goes on from an orbit that is known, as from an event, keeps the division of that orbit.
        segments(segments: usize) { self.segments = Some(segments) }

        /// Tolerance of the flow, relative to the size of the motion. Default: 1e-4 times the
        /// [tolerance](crate::FrequencyResponse::tolerance) of the output, so 1e-10, and from 1e-13 to 1e-6. A flow in closed form has none.
        tolerance(tolerance: f64) { self.tolerance = Some(tolerance) }
    }

    /// The tolerance of the flow where this is asked of the output.
    pub(crate) fn flow_tolerance(&self, output: f64) -> f64 {
        let [finest, coarsest] = BY_DEFAULT;
        self.tolerance
            .unwrap_or_else(|| (FINER * output).clamp(finest, coarsest))
    }
}
