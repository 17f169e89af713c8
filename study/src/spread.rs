//! How one parameter varies: values, a range, or a distribution.
//!
//! A number `u` between zero and one becomes a value by the inverse of the distribution, so that the same designs serve all of them. A
//! normal distribution may be cut at both ends: `u` is then spread over the part between them,
//!
//! ```text
//! value = F^-1( F(from) + u (F(to) - F(from)) )                                                               (1)
//! ```
//!
//! Its mean and its variance are then, with `a` and `b` the ends in deviations from the mean, `f` the density of the standard normal
//! distribution and `Z` the part between the ends,
//!
//! ```text
//! mean + deviation (f(a) - f(b)) / Z,
//! deviation^2 (1 + (a f(a) - b f(b)) / Z - ((f(a) - f(b)) / Z)^2)                                               (2)
//! ```
//!
//! Source: Johnson, Kotz and Balakrishnan (1994), Continuous univariate distributions, volume 1, 13.10.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};
use statrs::distribution::{Continuous, ContinuousCDF, Normal};
use statrs::statistics::Distribution as _;

/// How one parameter varies.
///
/// | keys | is |
/// |---|---|
/// | `values` | these, for a grid |
/// | `from`, `to`, `count` | so many, evenly, both ends included, for a grid |
/// | `from`, `to` | a uniform distribution |
/// | `mean`, `deviation` | a normal distribution |
/// | `mean`, `percent` | the same, with the deviation as a part of the mean |
/// | `scale = "log"` with `from`, `to` | even in the logarithm |
///
/// `from` and `to` beside `mean` cut a normal distribution.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub struct Spread {
    /// Values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<f64>>,
    /// Lower end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Upper end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Number of values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Mean of a normal distribution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Its standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
    /// The same in percent of the mean.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub percent: Option<f64>,
    /// Whether a range is even in the value or in its logarithm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<SpreadScale>,
}

/// In what a range is even.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SpreadScale {
    /// The value.
    Linear,
    /// Its logarithm.
    Log,
}

/// More values of one parameter than this are a slip.
const MOST: usize = 10_000_000;

impl Spread {
    /// Uniform between two values.
    pub fn uniform(from: f64, to: f64) -> Self {
        Self {
            from: Some(from),
            to: Some(to),
            ..Self::default()
        }
    }

    /// So many values between two, evenly, both ends included.
    pub fn even(from: f64, to: f64, count: usize) -> Self {
        Self {
            count: Some(count),
            ..Self::uniform(from, to)
        }
    }

    /// Normal.
    pub fn normal(mean: f64, deviation: f64) -> Self {
        Self {
            mean: Some(mean),
            deviation: Some(deviation),
            ..Self::default()
        }
    }

    /// These values.
    pub fn list(values: &[f64]) -> Self {
        Self {
            values: Some(values.to_vec()),
            ..Self::default()
        }
    }

    /// The values of a side of a grid.
    ///
    /// # Errors
    /// Why there are none.
    pub(crate) fn side(&self) -> Result<Vec<f64>, String> {
        if let Some(values) = &self.values {
            self.alone("values")?;
            if values.is_empty() {
                return Err("no values".to_owned());
            }
            return match values.iter().find(|value| !value.is_finite()) {
                Some(value) => Err(format!("{value} is not a number that can be used")),
                None => Ok(values.clone()),
            };
        }
        if self.mean.is_some() {
            return Err("a normal distribution has no values for a grid: give `from`, `to` and `count`, or `values`, or another design".to_owned());
        }
        let count = self
            .count
            .ok_or("a grid needs `values`, or `count` beside `from` and `to`")?;
        if !(1..=MOST).contains(&count) {
            return Err(format!("count = {count} is not between 1 and {MOST}"));
        }
        let [from, to] = self.range()?;
        let part = |index: usize| match count {
            1 => 0.5,
            _ => index as f64 / (count - 1) as f64,
        };
        Ok((0..count)
            .map(|index| self.between(from, to, part(index)))
            .collect())
    }

    /// The distribution.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn distribution(&self) -> Result<Distribution, String> {
        if self.values.is_some() {
            return Err(
                "`values` are for a grid: give `from` and `to`, or `mean` and `deviation`"
                    .to_owned(),
            );
        }
        if self.count.is_some() {
            return Err(
                "`count` here is for a grid: `count` of `variants` says how many there are"
                    .to_owned(),
            );
        }
        let Some(mean) = self.mean else {
            if self.deviation.is_some() || self.percent.is_some() {
                return Err("`deviation` and `percent` belong to `mean`".to_owned());
            }
            let [from, to] = self.range()?;
            let spread = self.clone();
            return Ok(Distribution::Between { spread, from, to });
        };
        if self.scale == Some(SpreadScale::Log) {
            return Err("`scale` belongs to `from` and `to` alone".to_owned());
        }
        let deviation = match (self.deviation, self.percent) {
            (Some(deviation), None) => deviation,
            (None, Some(percent)) => percent / 100.0 * mean.abs(),
            (Some(_), Some(_)) => return Err("give `deviation` or `percent`, not both".to_owned()),
            (None, None) => return Err("`mean` needs `deviation` or `percent`".to_owned()),
        };
        let positive = deviation.is_finite() && deviation > 0.0;
        let normal = Normal::new(mean, deviation).ok().filter(|_| positive);
        let normal = normal.ok_or_else(|| {
            format!("no normal distribution has the mean {mean} and the deviation {deviation}")
        })?;
        let below =
            |value: Option<f64>, otherwise: f64| value.map_or(otherwise, |value| normal.cdf(value));
        let cut = [below(self.from, 0.0), below(self.to, 1.0)];
        if cut[0].partial_cmp(&cut[1]) != Some(Ordering::Less) {
            return Err("nothing of the normal distribution is between `from` and `to`".to_owned());
        }
        Ok(Distribution::Normal { normal, cut })
    }

    /// The ends of everything that can occur, where there are ends.
    pub(crate) fn ends(&self) -> Vec<f64> {
        let values = self.values.iter().flatten();
        let ends = [self.from, self.to];
        values
            .copied()
            .chain(ends.into_iter().flatten())
            .chain(self.mean)
            .collect()
    }

    fn alone(&self, key: &str) -> Result<(), String> {
        let mut alone = Self {
            values: None,
            ..self.clone()
        };
        alone.scale = alone.scale.filter(|scale| *scale == SpreadScale::Log);
        if alone == Self::default() {
            return Ok(());
        }
        Err(format!("`{key}` says it all: leave out the other keys"))
    }

    fn range(&self) -> Result<[f64; 2], String> {
        let (Some(from), Some(to)) = (self.from, self.to) else {
            return Err("needs `from` and `to`".to_owned());
        };
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(format!("from = {from} must be less than to = {to}"));
        }
        if self.scale == Some(SpreadScale::Log) && from <= 0.0 {
            return Err(format!("from = {from} has no logarithm"));
        }
        Ok([from, to])
    }

    /// A value between two ends, at this part of the way; the ends themselves without rounding.
    fn between(&self, from: f64, to: f64, part: f64) -> f64 {
        let value = match self.scale {
            Some(SpreadScale::Log) => from * (to / from).powf(part),
            _ => (1.0 - part) * from + part * to,
        };
        value.clamp(from, to)
    }
}

/// What makes a value of a number between zero and one.
#[derive(Debug, Clone)]
pub(crate) enum Distribution {
    /// Uniform, or uniform in the logarithm.
    Between { spread: Spread, from: f64, to: f64 },
    /// Normal, between two values of its distribution function.
    Normal { normal: Normal, cut: [f64; 2] },
}

impl Distribution {
    /// By (1).
    pub(crate) fn value(&self, part: f64) -> f64 {
        match self {
            Self::Between { spread, from, to } => spread.between(*from, *to, part),
            Self::Normal { normal, cut } => normal.inverse_cdf(cut[0] + part * (cut[1] - cut[0])),
        }
    }

    /// Its mean and its standard deviation: of a range `(from + to) / 2` and `(to - from) / sqrt(12)`, in the logarithm those of its density
    /// `1 / (value ln(to / from))`, of a normal distribution (2).
    pub(crate) fn moments(&self) -> [f64; 2] {
        match self {
            Self::Between { spread, from, to } if spread.scale == Some(SpreadScale::Log) => {
                let width = (to / from).ln();
                let mean = (to - from) / width;
                let square = (to + from) * (to - from) / (2.0 * width);
                [mean, (square - mean * mean).max(0.0).sqrt()]
            }
            Self::Between { from, to, .. } => [0.5 * (from + to), (to - from) / 12_f64.sqrt()],
            Self::Normal { normal, cut } => {
                let mean = normal.mean().unwrap_or(f64::NAN);
                let deviation = normal.std_dev().unwrap_or(f64::NAN);
                // At an end that is cut off nowhere the density vanishes, and so does its product with the distance.
                let ends = cut.map(|part| {
                    let value = normal.inverse_cdf(part);
                    let away = (value - mean) / deviation;
                    let density = deviation * normal.pdf(value);
                    let product = if away.is_finite() {
                        away * density
                    } else {
                        0.0
                    };
                    [density, product]
                });
                let inside = cut[1] - cut[0];
                let [first, second] =
                    [0, 1].map(|power| (ends[0][power] - ends[1][power]) / inside);
                let variance = (1.0 + second - first * first).max(0.0);
                [mean + deviation * first, deviation * variance.sqrt()]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_distributions() {
        let cut = |from: Option<f64>, to: Option<f64>| Spread {
            from,
            to,
            ..Spread::normal(10.0, 0.5)
        };
        let log = Spread {
            scale: Some(SpreadScale::Log),
            ..Spread::uniform(1.0, std::f64::consts::E)
        };
        let (root, e) = ((2.0 / std::f64::consts::PI).sqrt(), std::f64::consts::E);
        for (spread, mean, variance) in [
            (Spread::uniform(2.0, 5.0), 3.5, 0.75),
            // Of the density 1/x from 1 to e.
            (log, e - 1.0, (e * e - 1.0) / 2.0 - (e - 1.0).powi(2)),
            (cut(None, None), 10.0, 0.25),
            // Half of a normal distribution.
            (
                cut(Some(10.0), None),
                10.0 + 0.5 * root,
                0.25 * (1.0 - root * root),
            ),
            // Of the standard normal distribution within one deviation the variance is 1 - 2 f(1) / 0.6827.
            (cut(Some(9.5), Some(10.5)), 10.0, 0.25 * 0.291_125_094_772_8),
        ] {
            let [found, deviation] = spread.distribution().expect("a distribution").moments();
            assert!((found - mean).abs() < 1e-9, "{spread:?}: {found} {mean}");
            let found = deviation * deviation;
            assert!(
                (found - variance).abs() < 1e-9,
                "{spread:?}: {found} {variance}"
            );
        }
    }
}
