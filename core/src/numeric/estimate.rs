//! Numbers with an estimate of their error, and means along a motion with their standard errors, by batch means.
//!
//! Values along a chaotic motion are correlated, so the deviation of single values says little of the error of their mean.
//! Means `m_b` over batches much longer than the correlation are nearly independent:
//!
//! ```text
//! s^2 = 1 / (B (B - 1)) sum_b (m_b - m)^2                                                              (1)
//! ```
//!
//! Source: Flegal and Jones (2010), Annals of Statistics 38, 1034.

/// A number with an estimate of its error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Estimate {
    /// Its value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Its estimated error, in the same unit. Where it stands it is said of which kind; infinite where it is not known.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub error: f64,
}

impl Estimate {
    /// The mean of means of batches that are equally long, and its standard error (1): infinite for fewer than two batches.
    pub(crate) fn of_batches(means: impl Iterator<Item = f64> + Clone) -> Self {
        let count = means.clone().count() as f64;
        let value = means.clone().sum::<f64>() / count;
        let squares: f64 = means.map(|mean| (mean - value).powi(2)).sum();
        let error = if count < 2.0 {
            f64::INFINITY
        } else {
            (squares / (count * (count - 1.0))).sqrt()
        };
        Self { value, error }
    }

    /// Adds another one, with all of its error.
    pub(crate) fn add(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error;
    }

    /// Both divided by a number.
    pub(crate) fn over(self, by: f64) -> Self {
        Self {
            value: self.value / by,
            error: self.error / by,
        }
    }
}

impl std::fmt::Display for Estimate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.6} ± {:.1e}", self.value, self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_mean_and_its_deviation() {
        let estimate = Estimate::of_batches([1.0, 2.0, 3.0, 6.0].into_iter());
        assert_eq!(estimate.value, 3.0);
        assert!((estimate.error - (14.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        let one = Estimate::of_batches([1.0].into_iter());
        assert_eq!(one.error, f64::INFINITY);
    }
}
