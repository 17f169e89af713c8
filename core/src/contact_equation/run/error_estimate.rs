//! Errors that a finer solution has shown, as data, and what they say of orbits behind it on the branch: (2) of
//! [`reading`](crate::contact_equation::reading).

/// What one step from a finer solution says of the error is multiplied by this.
pub(in crate::contact_equation) const SAFETY: f64 = 2.0;
/// As many orbits are compared with one whose errors a finer solution has shown.
pub(in crate::contact_equation) const SCREENED: usize = 31;
/// What their forces leave out may be so many times as much.
const MOST: f64 = 30.0;

/// Errors that a finer solution has shown.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Screened {
    /// What the forces of every contact on every interval left out there, and how often gaps crossed levels.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) tails: Vec<f64>,
    /// The same of how forces change with their gaps and with perturbations, which multipliers are made of: where a gap is about to touch its
    /// level they may leave out more from one orbit to the next than forces do, and where a perturbation turns fast.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) stiffness: Vec<f64>,
    pub(in crate::contact_equation) switches: usize,
    /// Half of the shortest way between switches that may meet where the force jumps. Multipliers go as `1/r` with that, which is known as
    /// well as the orbit, and their error as `1/r^2`.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) narrowest: f64,
    /// Of the motion across the tangent at any phase, and of what is varied. One number, as peak-to-peak, may be right by chance where
    /// its error changes sign.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) apart: f64,
    /// The same of the output that the error is of.
    #[cfg_attr(
        feature = "serde",
        serde(default = "unknown", with = "crate::serialise")
    )]
    pub(in crate::contact_equation) of_asked: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) shift: f64,
    /// How what is varied changes along the branch.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) slope: f64,
    /// Of peak-to-peak where what is varied has its value, and of the multipliers or the map that has them.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) error: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) spread: f64,
    /// The most that forces, and those or their changes, have left out since, in parts of that. Last coefficients may be small by chance.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) most: [f64; 2],
    /// As many orbits may still be compared with it.
    pub(in crate::contact_equation) left: usize,
}

/// What a walk that was kept before does not say: a finer solution is asked.
#[cfg(feature = "serde")]
fn unknown() -> f64 {
    f64::NAN
}

impl Screened {
    /// How far the orbit is from the finer one, at any phase.
    pub(in crate::contact_equation) fn apart(&self) -> f64 {
        self.apart
    }

    /// Whether its numbers can be what they say: they may have been read from a file.
    pub(in crate::contact_equation) fn is_possible(&self) -> bool {
        let Self {
            tails,
            stiffness,
            narrowest,
            apart,
            shift,
            slope,
            error,
            spread,
            ..
        } = self;
        let numbers = [apart, shift, slope, error, spread];
        let all = tails.iter().chain(stiffness);
        let mut all = all.chain([narrowest]);
        all.all(|tail| *tail > 0.0 && tail.is_finite())
            && numbers.into_iter().all(|x| *x >= 0.0)
            && self.most.iter().all(|ratio| (1.0..=MOST).contains(ratio))
            && self.left <= SCREENED
    }

    /// How many times as large errors may be where so much is left out, by (2): they are products of what the forces and what the rule of
    /// integration leave out. First those of the orbit, then those of its multipliers. `None` if so much more is left out that this says
    /// nothing.
    pub(in crate::contact_equation) fn grown(
        &mut self,
        [tails, stiffness]: [&[f64]; 2],
        narrowest: f64,
    ) -> Option<[f64; 2]> {
        if (tails.len(), stiffness.len()) != (self.tails.len(), self.stiffness.len()) {
            return None;
        }
        let ratio = |most: f64, now: &[f64], then: &[f64]| {
            let pairs = now.iter().zip(then);
            pairs.fold(most, |most, (now, then)| most.max(now / then))
        };
        let forces = ratio(self.most[0], tails, &self.tails);
        let all = ratio(forces.max(self.most[1]), stiffness, &self.stiffness);
        let narrower = (self.narrowest / narrowest).max(1.0);
        if all * narrower > MOST {
            return None;
        }
        self.most = [forces, all];
        Some([forces, all * narrower].map(|ratio| SAFETY * ratio * ratio))
    }
}
