//! A series close to a phase where its value is known: the difference keeps all its digits.

use super::series;

/// Within this phase of the highest harmonic, four terms of Taylor's series give the value to rounding.
const NEAR: f64 = 1e-3;

/// Derivatives of a series at a phase, from the first to the fourth, each divided by its factorial.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taylor([f64; 4]);

impl Taylor {
    /// The distance up to which it is exact.
    pub(crate) fn reach(series: &[f64]) -> f64 {
        NEAR / series::harmonics(series).max(1) as f64
    }

    pub(crate) fn at(series: &[f64], tau: f64) -> Self {
        let (sine, cosine) = tau.sin_cos();
        let (mut c, mut s) = (1.0, 0.0);
        let mut sums = [0.0; 4];
        for (index, pair) in series[1..].chunks_exact(2).enumerate() {
            let k = (index + 1) as f64;
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            let (even, odd) = (pair[0] * c + pair[1] * s, pair[1] * c - pair[0] * s);
            sums[0] += k * odd;
            sums[1] -= k * k * even;
            sums[2] -= k * k * k * odd;
            sums[3] += k * k * k * k * even;
        }
        Self([sums[0], sums[1] / 2.0, sums[2] / 6.0, sums[3] / 24.0])
    }

    /// The value at a small distance from the phase, given that there.
    pub(crate) fn value(self, there: f64, distance: f64) -> f64 {
        let [a, b, c, d] = self.0;
        there + distance * (a + distance * (b + distance * (c + distance * d)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two harmonics, by the functions themselves.
    #[test]
    fn close_by_it_is_the_series() {
        let series = [0.3, 1.0, -0.5, 0.2, 0.7];
        let of = |t: f64| {
            let second = 0.2 * (2.0 * t).cos() + 0.7 * (2.0 * t).sin();
            0.3 + t.cos() - 0.5 * t.sin() + second
        };
        for tau in [0.0, 1.0, 4.0] {
            let taylor = Taylor::at(&series, tau);
            let by = Taylor::reach(&series);
            for distance in [-by, 0.0, 0.5 * by, by] {
                let found = taylor.value(of(tau), distance);
                assert!((found - of(tau + distance)).abs() < 1e-15);
            }
        }
    }
}
