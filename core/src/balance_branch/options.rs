//! Options of the harmonic balance.

use crate::balance::aft::Aft;
use crate::balance_branch::context::EventSelection;
use crate::orbit::observe::Accuracy;
use crate::orbit::stability::Method;

/// Orbits as Fourier series whose residual vanishes in as many harmonics (harmonic balance): the method of a
/// [`FrequencyResponse`](crate::FrequencyResponse) unless another one is [asked for](crate::FrequencyResponse::by). Everything has a
/// default that follows from the tolerance.
///
/// ```
/// use hertzian::{FrequencyResponse, HarmonicBalance};
///
/// hertzian::oscillator! {
///     Duffing(x) {
///         param drive;
///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
///     }
/// }
///
/// let model = Duffing { drive: 0.2 };
/// let balance = HarmonicBalance::new().harmonics(5).samples(64);
/// let branch = FrequencyResponse::of(&model).by(balance).from(0.5).to(1.5).run()?;
/// assert_eq!(branch.points[0].orbit.harmonics(), 5);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HarmonicBalance {
    pub(crate) harmonics: Option<usize>,
    pub(crate) samples: Option<usize>,
    pub(crate) aft: Aft,
    pub(crate) multipliers: Method,
    pub(crate) doublings: bool,
    pub(crate) bifurcations: bool,
    pub(crate) symmetric: bool,
    /// What the accuracy is of.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) accuracy: Accuracy,
}

impl Default for HarmonicBalance {
    fn default() -> Self {
        Self {
            harmonics: None,
            samples: None,
            aft: Aft::default(),
            multipliers: Method::default(),
            doublings: false,
            bifurcations: false,
            symmetric: true,
            accuracy: Accuracy::default(),
        }
    }
}

impl HarmonicBalance {
    /// With everything by default.
    pub fn new() -> Self {
        Self::default()
    }

    hertzian_contract::setters! { self:
        /// The same number of harmonics at every point, whatever the tolerance. They are harmonics of the base frequency, which is
        /// omega over the divisor of the declaration (one, unless it has fractions of omega), for an orbit of period one; an orbit of
        /// period `n` has `n` times as many. Default: chosen by the tolerance; where the force is sampled, 20 times the divisor at the
        /// default tolerance, twice as many for every two digits more, and between 5 and 100.
        harmonics(harmonics: usize) { self.harmonics = Some(harmonics) }

        /// How the harmonics of contact forces are found. Default: [`Aft::Switched`], exact; the others are for comparison.
        aft(aft: Aft) { self.aft = aft }

        /// Samples per period of the declaration, for the methods that sample. Default: at least 200 per harmonic, a power of two. The
        /// derivative of a force like `g^1.5` has a kink where contact begins; folds feel it as the power -1.5 of the samples.
        samples(samples: usize) { self.samples = Some(samples) }

        /// How Floquet multipliers are computed. Default: [`Method::Default`].
        /// [`Branch::multipliers`](crate::Branch::multipliers) applies any method to an orbit that is there already.
        multipliers(method: Method) { self.multipliers = method }

        /// Whether doublings of the period are located too, where another balance, of twice the period, has the branch that begins.
        /// Orbits of odd symmetry have none. Default: no, since it takes about as long again. [`bifurcations`](Self::bifurcations)
        /// include doublings, whatever is said here.
        doublings(wanted: bool) { self.doublings = wanted }

        /// Whether all bifurcations are located and not folds alone: doublings of the period, crossings with other branches,
        /// Neimark-Sacker bifurcations, and where a gap touches a level. Default: no. Neimark-Sacker bifurcations are seen by the
        /// multipliers, so they need [`stability`](crate::FrequencyResponse::stability).
        bifurcations(wanted: bool) { self.bifurcations = wanted }

        /// Whether orbits of period one have the symmetry that the system has. Default: yes. Of the odd symmetry, `x(t + T/2) = -x(t)`,
        /// they have odd harmonics only then, and where the symmetry breaks is located. Otherwise a first orbit without the symmetry is
        /// looked for, as in one of two wells, and one with it taken if none is found; the branch may pass from one to the other. Where
        /// contacts take each other's place after a part of the period, as the balls of a bearing or the blades of a rotor, orbits come
        /// back after that part; otherwise all harmonics are unknowns, whatever the orbits have. An orbit without the symmetry that is
        /// [given](crate::FrequencyResponse::near_orbit) does not need this.
        symmetric(wanted: bool) { self.symmetric = wanted }
    }

    /// Which events are looked for.
    pub(crate) fn selection(&self) -> EventSelection {
        match (self.bifurcations, self.doublings) {
            (true, _) => EventSelection::All,
            (false, true) => EventSelection::Doublings,
            (false, false) => EventSelection::Folds,
        }
    }
}
