//! Orbits from what is known of them: series or samples, for [`near_orbit`](crate::FrequencyResponse::near_orbit).

use std::f64::consts::TAU;

use super::orbit::Orbit;
use super::recurrence::SignedPermutation;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::system::System;

impl Orbit {
    /// An orbit from the Fourier series of its coordinates, one after the other, each `[mean, cos 1, sin 1, ...]` in harmonics of its base
    /// frequency, over so many periods of the declaration. Series that are too short are filled with zeros.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, Orbit};
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let model = Duffing { drive: 0.2 };
    /// // One of three: the large one.
    /// let guess = Orbit::from_series(&model, 1.3, 1, &[vec![0.0, 0.5, 0.8]])?;
    /// let found = FrequencyResponse::of(&model).near_orbit(&guess).orbit(1.3)?;
    /// assert!(found.peak_to_peak() > 1.0);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If there are not as many series as coordinates, a number is not finite, or frequency or period cannot be.
    pub fn from_series(
        system: &dyn System,
        omega: f64,
        period: usize,
        series: &[Vec<f64>],
    ) -> Result<Self, Error> {
        let facts = system.facts();
        let coordinates = facts.coordinates.len();
        validate::omega(omega)?;
        let must = "must be from 1 to 1000";
        validate::option("period", period as f64, 1.0..=1000.0, must)?;
        if series.len() != coordinates || coordinates == 0 {
            return Err(RequestError::Values {
                values: series.len(),
                expected: coordinates,
            }
            .into());
        }
        for &value in series.iter().flatten() {
            validate::finite("series", value)?;
        }
        let longest = series.iter().map(Vec::len).max().unwrap_or(0).max(3);
        // A mean, and whole pairs of cosine and sine.
        let length = longest | 1;
        let filled = series.iter().flat_map(|series| {
            let zeros = std::iter::repeat(0.0);
            series.iter().copied().chain(zeros).take(length)
        });
        Ok(Self {
            series: filled.collect(),
            states: Vec::new(),
            coordinates,
            omega,
            base: omega / f64::from(facts.divisor) / period as f64,
            period,
            parts: 1,
            symmetric: false,
            image: SignedPermutation::identity(),
        })
    }

    /// The same from samples of the coordinates, one after the other, each at equal distances over the period from time zero on, its end
    /// left out: as many harmonics as they tell.
    ///
    /// # Errors
    /// As [`from_series`](Self::from_series), and if a coordinate has no samples.
    pub fn from_samples(
        system: &dyn System,
        omega: f64,
        period: usize,
        samples: &[Vec<f64>],
    ) -> Result<Self, Error> {
        if samples.iter().any(Vec::is_empty) {
            let (samples, least, harmonics) = (0, 3, 1);
            return Err(RequestError::Samples {
                samples,
                least,
                harmonics,
            }
            .into());
        }
        let series: Vec<Vec<f64>> = samples.iter().map(|samples| transformed(samples)).collect();
        Self::from_series(system, omega, period, &series)
    }
}

/// More harmonics are not needed near an orbit, and their sums would take long.
const HARMONICS: usize = 100;

/// The series of equally spaced samples.
fn transformed(samples: &[f64]) -> Vec<f64> {
    let count = samples.len() as f64;
    let mut series = vec![samples.iter().sum::<f64>() / count];
    for k in 1..=((samples.len() - 1) / 2).min(HARMONICS) {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (j, x) in samples.iter().enumerate() {
            let (s, c) = (TAU * ((j * k) as f64 / count)).sin_cos();
            cosine += x * c;
            sine += x * s;
        }
        series.extend([2.0 * cosine / count, 2.0 * sine / count]);
    }
    series
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::oscillator! {
        Two(x, y) {
            param drive;
            ddot(x) + 0.1*dot(x) + 2*x - y = drive*cos(omega*t);
            ddot(y) + 0.1*dot(y) + 2*y - x = 0;
        }
    }

    #[test]
    fn samples_give_the_series_that_they_are_of() {
        let at = |j: usize| {
            let tau = TAU * j as f64 / 16.0;
            0.5 + 2.0 * tau.cos() - 3.0 * (3.0 * tau).sin()
        };
        let samples = [(0..16).map(at).collect(), vec![1.0]];
        let orbit = Orbit::from_samples(&Two { drive: 1.0 }, 1.2, 2, &samples);
        let orbit = orbit.expect("an orbit");
        let expected = [0.5, 2.0, 0.0, 0.0, 0.0, 0.0, -3.0];
        let series = orbit.series(0).expect("a series");
        assert_eq!(series.len(), 15);
        for (place, value) in series.iter().enumerate() {
            let expected = expected.get(place).copied().unwrap_or(0.0);
            assert!((value - expected).abs() < 1e-14, "{place}: {value}");
        }
        assert_eq!(orbit.series(1).expect("a series")[0], 1.0);
        assert_eq!((orbit.base, orbit.period), (0.6, 2));
    }

    #[test]
    fn what_is_no_orbit_is_refused() {
        let model = Two { drive: 1.0 };
        let one = vec![0.0, 1.0, 0.0];
        assert!(Orbit::from_series(&model, 1.0, 1, std::slice::from_ref(&one)).is_err());
        let two = [one.clone(), vec![f64::NAN]];
        assert!(Orbit::from_series(&model, 1.0, 1, &two).is_err());
        assert!(Orbit::from_series(&model, 1.0, 0, &[one.clone(), one.clone()]).is_err());
        assert!(Orbit::from_series(&model, -1.0, 1, &[one.clone(), one.clone()]).is_err());
        assert!(Orbit::from_samples(&model, 1.0, 1, &[one, Vec::new()]).is_err());
    }
}
