//! What is read off an orbit, as data.

/// Roundings of the two extremes.
pub(crate) const EXTREMES: f64 = 4.0;
/// What moves by no more than so many times its noise is at rest.
const STILL: f64 = 10.0;

/// An error as a part of what it is measured by. What is zero, and has none, has no part either; of what is zero alone, nothing is known.
pub(crate) fn part_of(error: f64, measure: f64) -> f64 {
    if measure > 0.0 && !error.is_nan() {
        error / measure
    } else if error == 0.0 {
        0.0
    } else {
        f64::INFINITY
    }
}

/// What is read off one orbit: of one by the balance everything, of one by shooting the extremes of its coordinates, and the rest by
/// [`Branch::complete`](crate::Branch::complete).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Observed {
    /// One entry per coordinate.
    pub motions: Vec<Motion>,
    /// Whether all but the first of them are of 48 phases a period, as by the contact equation where
    /// [accuracy](crate::FrequencyResponse::accuracy_of) is asked of an output: no error is of coordinates then. Tables and names leave them out
    /// ([`read`](Self::read)), and [`Branch::complete`](crate::Branch::complete) reads them.
    #[cfg_attr(feature = "serde", serde(default))]
    pub sampled: bool,
    /// One entry per output of the system; none where only the extremes of the coordinates were read off. Between switches of contacts an
    /// output is smooth, and its extremes, mean and root of the mean square are those of the output itself.
    #[cfg_attr(feature = "serde", serde(default))]
    pub outputs: Vec<Motion>,
    /// One entry per contact; none where only the extremes were read off.
    pub contacts: Vec<ContactMotion>,
    /// For each contact, the part of the period that its gap spends on each piece of its law, from the piece of the lowest gaps to
    /// that of the highest: `gap > 0 => ..., else => ...` has the time without contact first. They add up to one.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub on_pieces: Vec<Vec<f64>>,
    /// Mean power of the load: `<f . q'>`; `None` where only the extremes were read off.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub input_power: Option<f64>,
    /// Mean power that damping, stiffness and contacts take up. In the discrete balance it equals the input power
    /// exactly, for a symmetric mass matrix: the residual is orthogonal to the velocity. `None` where only the extremes were read off.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub dissipated_power: Option<f64>,
    /// How often a gap crosses a level in the period, where shooting has counted that.
    pub switches: Option<usize>,
}

impl Observed {
    /// Motions of coordinates that were read off: of the first alone where the others are of a few [phases](Self::sampled).
    pub fn read(&self) -> &[Motion] {
        let known = if self.sampled { 1 } else { self.motions.len() };
        &self.motions[..known.min(self.motions.len())]
    }

    /// Extremes of the coordinates alone.
    pub(crate) fn extremes(motions: Vec<Motion>, switches: usize) -> Self {
        Self {
            motions,
            sampled: false,
            outputs: Vec::new(),
            contacts: Vec::new(),
            on_pieces: Vec::new(),
            input_power: None,
            dissipated_power: None,
            switches: Some(switches),
        }
    }
}

/// What is read off the motion of one coordinate over a period.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Motion {
    /// Largest value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub maximum: f64,
    /// Smallest value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub minimum: f64,
    /// Mean; `None` where only the extremes were read off.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub mean: Option<f64>,
    /// Root of the mean square, mean included; `None` where only the extremes were read off.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub rms: Option<f64>,
}

impl Motion {
    /// Largest less smallest value.
    pub fn peak_to_peak(&self) -> f64 {
        self.maximum - self.minimum
    }

    /// Its largest value by size.
    pub(crate) fn farthest(&self) -> f64 {
        self.maximum.abs().max(self.minimum.abs())
    }

    /// How far its extremes are from those of another one, together: what peak-to-peak differs by may vanish by chance. Nothing where
    /// neither moves.
    pub(crate) fn apart(&self, other: &Self) -> f64 {
        if self.peak_to_peak() == 0.0 && other.peak_to_peak() == 0.0 {
            return 0.0;
        }
        (other.maximum - self.maximum).abs() + (other.minimum - self.minimum).abs()
    }

    /// Whether it does not move, where so much of peak-to-peak is noise.
    pub(crate) fn is_at_rest(&self, noise: f64) -> bool {
        let rounding = EXTREMES * f64::EPSILON * self.farthest();
        self.peak_to_peak() <= STILL * (noise + rounding)
    }

    /// What errors of peak-to-peak are measured by: by itself, and of what is at rest by its largest value.
    pub(crate) fn measure(&self, noise: f64) -> f64 {
        if self.is_at_rest(noise) {
            self.farthest()
        } else {
            self.peak_to_peak()
        }
    }

    /// Before anything was seen of it.
    pub(crate) const NONE: Self = Self {
        minimum: f64::INFINITY,
        maximum: f64::NEG_INFINITY,
        mean: None,
        rms: None,
    };

    /// In the middle between its extremes.
    pub(crate) fn middle(&self) -> f64 {
        0.5 * (self.maximum + self.minimum)
    }

    pub(crate) fn include(&mut self, x: f64) {
        self.minimum = self.minimum.min(x);
        self.maximum = self.maximum.max(x);
    }
}

/// What is read off one contact over a period of the orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ContactMotion {
    /// Largest value of the law by size, one-sided limits at switches included. A factor that stands outside of the law in an
    /// equation is not in it: of `2*stop(x - 1)` this is the largest `stop(x - 1)`. The factor belongs to the place where the force
    /// acts, and one law may act on several equations with a different factor in each.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub peak_force: f64,
    /// Smallest value of the law, with its sign: the largest pull where a positive force pushes. One-sided limits at switches count,
    /// and a piece without force counts as zero.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub minimum_force: f64,
    /// Largest value of the law, with its sign.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub maximum_force: f64,
    /// Fraction of the period spent on pieces whose force is not identically zero. So it is one for a law that acts everywhere, as
    /// the attraction beyond the surface under a tip, or a bolt that holds two parts together: time on each side of a level is in
    /// [`Observed::on_pieces`].
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub fraction: f64,
    /// Number of separate intervals of contact: zero without contact, one for contact that is never lost.
    pub count: usize,
    /// Integral of the law over the period of the orbit; `None` where it was not read off.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
    pub impulse: Option<f64>,
}

impl ContactMotion {
    /// Without contact.
    pub(crate) const NONE: Self = Self {
        peak_force: 0.0,
        minimum_force: 0.0,
        maximum_force: 0.0,
        fraction: 0.0,
        count: 0,
        impulse: None,
    };

    /// How often contact begins in the period of the orbit: zero where it is never lost.
    pub fn impacts(&self) -> usize {
        if self.fraction < 1.0 { self.count } else { 0 }
    }
}
