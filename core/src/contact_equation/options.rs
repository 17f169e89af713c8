//! Options of the contact equation.

use crate::orbit::observe::Accuracy;

/// Orbits from the forces at a few nodes of each stretch in contact: nothing else is unknown but where stretches begin and end, and the
/// state where the period begins. Between contacts the motion is known in closed form, and in contact too where forces are affine, so that no
/// harmonic is cut off.
///
/// Where contact begins and ends is solved for. Whether it does so elsewhere too is told by the extremes of gaps, which are looked for between
/// samples of the motion, eight to its shortest period; no bound says that none is missed.
///
/// Where an orbit comes back after a part of its period with coordinates or contacts in each other's place, as in a bearing or between two
/// equal stops, that part is all that is computed.
///
/// Nodes follow the [tolerance](crate::FrequencyResponse::tolerance); events are located again with more nodes until their value is known
/// to nine digits. A branch that begins at one of its events has its first orbit from [`Shooting`](crate::Shooting), and is followed by the contact
/// equation from there. Where that finds no equations of its first orbit, shooting follows it, and is its
/// [method](crate::Branch::method). Orbits at a value are looked for near the motion
/// on the chord of their neighbours, and by shooting where that leads to another limb.
///
/// ```
/// use hertzian::{ContactEquation, FrequencyResponse};
///
/// hertzian::oscillator! {
///     OneSided(x) {
///         law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
///         ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
///     }
/// }
///
/// let request = FrequencyResponse::of(&OneSided {}).by(ContactEquation::new());
/// let branch = request.from(0.5).to(1.5).run()?;
/// // A fold of Wang et al. (2021), figure 5a.
/// let exact = 0.715119549676419;
/// assert!(branch.folds().any(|fold| (fold.point.value - exact).abs() < 1e-9));
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ContactEquation {
    /// What the accuracy is of.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) accuracy: Accuracy,
}

impl ContactEquation {
    /// With everything by default.
    pub fn new() -> Self {
        Self::default()
    }
}
