//! Real Fourier series.
//!
//! A series with `K` harmonics is a slice of `2 K + 1` numbers `[mean, c_1, s_1, ..., c_K, s_K]` and stands for
//!
//! ```text
//! x(tau) = mean + sum_k ( c_k cos k tau + s_k sin k tau )                                                     (1)
//! ```
//!
//! so that `c_k` is the amplitude itself, not half of it. The mean square over a period is
//! `mean^2 + 1/2 sum_k (c_k^2 + s_k^2)` (Parseval).

use crate::system::{Part, Wave};

/// Length of a series with this many harmonics.
pub const fn length(harmonics: usize) -> usize {
    2 * harmonics + 1
}

/// Number of harmonics of a series.
pub const fn harmonics(series: &[f64]) -> usize {
    series.len() / 2
}

/// Value at a phase, by Clenshaw's recurrence.
///
/// Source: Clenshaw (1955), A note on the summation of Chebyshev series; both sums share one recurrence in `cos tau`.
///
/// # Panics
/// If the series is empty: it has no mean.
pub fn value(series: &[f64], tau: f64) -> f64 {
    let (sine, cosine) = tau.sin_cos();
    let (mut c1, mut c2, mut s1, mut s2) = (0.0, 0.0, 0.0, 0.0);
    for pair in series[1..].chunks_exact(2).rev() {
        (c1, c2) = (pair[0] + 2.0 * cosine * c1 - c2, c1);
        (s1, s2) = (pair[1] + 2.0 * cosine * s1 - s2, s1);
    }
    series[0] + c1 * cosine - c2 + s1 * sine
}

/// Value, first and second derivative with respect to the phase.
///
/// # Panics
/// If the series is empty.
pub fn value_and_derivatives(series: &[f64], tau: f64) -> (f64, f64, f64) {
    let (sine, cosine) = tau.sin_cos();
    let (mut x, mut x1, mut x2) = (series[0], 0.0, 0.0);
    let (mut c, mut s) = (1.0, 0.0);
    for (index, pair) in series[1..].chunks_exact(2).enumerate() {
        let k = (index + 1) as f64;
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        let in_phase = pair[0] * c + pair[1] * s;
        x += in_phase;
        x1 += k * (pair[1] * c - pair[0] * s);
        x2 -= k * k * in_phase;
    }
    (x, x1, x2)
}

/// Writes the derivative with respect to the phase, into a series of the same length.
///
/// # Panics
/// If the series is empty, or the derivative is.
pub fn differentiate(series: &[f64], derivative: &mut [f64]) {
    derivative[0] = 0.0;
    for (index, (from, to)) in series[1..]
        .chunks_exact(2)
        .zip(derivative[1..].chunks_exact_mut(2))
        .enumerate()
    {
        let k = (index + 1) as f64;
        to[0] = k * from[1];
        to[1] = -k * from[0];
    }
}

/// Mean of the product of two series over a period; a shorter one counts as padded with zeros.
///
/// # Panics
/// If one is empty.
pub fn mean_product(a: &[f64], b: &[f64]) -> f64 {
    let oscillating: f64 = a[1..].iter().zip(&b[1..]).map(|(x, y)| x * y).sum();
    a[0] * b[0] + 0.5 * oscillating
}

/// Adds `factor * wave(tau) * series(tau)` to `sum`, dropping harmonics above those of `sum`.
///
/// From `cos h cos k = (cos(k - h) + cos(k + h)) / 2` and its companions, for every pair of (1).
pub(crate) fn add_product(series: &[f64], wave: Wave, factor: f64, sum: &mut [f64]) {
    let h = wave.harmonic as usize;
    if h == 0 {
        for (to, from) in sum.iter_mut().zip(series) {
            *to += factor * from;
        }
        return;
    }
    add_wave(sum, h, wave.part, factor * series[0]);
    for k in 1..=harmonics(series) {
        let (c, s) = (
            0.5 * factor * series[2 * k - 1],
            0.5 * factor * series[2 * k],
        );
        let below = k as isize - h as isize;
        match wave.part {
            Part::Cosine => {
                add_pair(sum, below, c, s);
                add_pair(sum, (k + h) as isize, c, s);
            }
            Part::Sine => {
                add_pair(sum, below, s, -c);
                add_pair(sum, (k + h) as isize, -s, c);
            }
        }
    }
}

/// Adds `c cos(k tau) + s sin(k tau)` for any sign of `k`.
fn add_pair(sum: &mut [f64], k: isize, c: f64, s: f64) {
    let index = k.unsigned_abs();
    if index > harmonics(sum) {
        return;
    }
    if index == 0 {
        sum[0] += c;
    } else {
        sum[2 * index - 1] += c;
        sum[2 * index] += if k > 0 { s } else { -s };
    }
}

/// Adds `value * wave(tau)`, unless the wave is above the harmonics of the series.
pub(crate) fn add_wave(sum: &mut [f64], harmonic: usize, part: Part, value: f64) {
    if harmonic > harmonics(sum) {
        return;
    }
    match (harmonic, part) {
        (0, _) => sum[0] += value,
        (h, Part::Cosine) => sum[2 * h - 1] += value,
        (h, Part::Sine) => sum[2 * h] += value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn naive(series: &[f64], tau: f64) -> f64 {
        let mut x = series[0];
        for k in 1..=harmonics(series) {
            let angle = k as f64 * tau;
            x += series[2 * k - 1] * angle.cos() + series[2 * k] * angle.sin();
        }
        x
    }

    fn any_series() -> impl Strategy<Value = Vec<f64>> {
        (0_usize..12).prop_flat_map(|k| prop::collection::vec(-1.0..1.0, length(k)))
    }

    proptest! {
        #[test]
        fn recurrences_agree_with_the_sum(series in any_series(), tau in -10.0..10.0_f64) {
            let expected = naive(&series, tau);
            prop_assert!((value(&series, tau) - expected).abs() < 1e-12);
            let (x, x1, x2) = value_and_derivatives(&series, tau);
            let mut first = series.clone();
            differentiate(&series, &mut first);
            let mut second = series.clone();
            differentiate(&first, &mut second);
            prop_assert!((x - expected).abs() < 1e-12);
            prop_assert!((x1 - naive(&first, tau)).abs() < 1e-11);
            prop_assert!((x2 - naive(&second, tau)).abs() < 1e-10);
        }

        #[test]
        fn product_with_a_wave_is_the_product(
            series in any_series(), h in 0_u32..5, sine in any::<bool>(), tau in 0.0..6.0_f64,
        ) {
            let part = if sine && h > 0 { Part::Sine } else { Part::Cosine };
            let wave = Wave { harmonic: h, part };
            let mut sum = vec![0.0; length(harmonics(&series) + h as usize)];
            add_product(&series, wave, 1.5, &mut sum);
            let angle = f64::from(h) * tau;
            let factor = if part == Part::Sine { angle.sin() } else { angle.cos() };
            prop_assert!((naive(&sum, tau) - 1.5 * factor * naive(&series, tau)).abs() < 1e-12);
        }

        #[test]
        fn mean_product_is_the_mean_of_the_product(a in any_series(), b in any_series()) {
            let n = 64;
            let mean: f64 = (0..n)
                .map(|j| std::f64::consts::TAU * f64::from(j) / f64::from(n))
                .map(|tau| naive(&a, tau) * naive(&b, tau))
                .sum::<f64>() / f64::from(n);
            prop_assert!((mean_product(&a, &b) - mean).abs() < 1e-12);
        }
    }

    #[test]
    fn a_constant_has_no_derivative() {
        assert_eq!(value_and_derivatives(&[2.0], 1.0), (2.0, 0.0, 0.0));
        assert_eq!(value(&[2.0], 1.0), 2.0);
    }
}
