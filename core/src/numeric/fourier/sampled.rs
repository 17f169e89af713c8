//! Between a series and its samples at `N` equally spaced phases, by the fast Fourier transform.
//!
//! Layout and normalisation are those of [`series`](super::series): no factor is left to the caller.

use std::sync::Arc;

use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealToComplex};

#[cfg(test)]
use super::series;

/// Plans and scratch for one number of samples. No method allocates.
pub struct SampledTransform {
    samples: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    backward: Arc<dyn ComplexToReal<f64>>,
    spectrum: Vec<Complex64>,
    input: Vec<f64>,
    scratch: Vec<Complex64>,
}

impl std::fmt::Debug for SampledTransform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SampledTransform")
            .field("samples", &self.samples)
            .finish_non_exhaustive()
    }
}

impl SampledTransform {
    /// Plans for `samples >= 2` phases `tau_j = 2 pi j / samples`.
    pub fn new(samples: usize) -> Self {
        let forward = hertzian_fourier::forward(samples);
        let backward = hertzian_fourier::inverse(samples);
        let scratch = forward.get_scratch_len().max(backward.get_scratch_len());
        Self {
            samples,
            spectrum: forward.make_output_vec(),
            input: forward.make_input_vec(),
            scratch: vec![Complex64::default(); scratch],
            forward,
            backward,
        }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Writes the samples of a series. Harmonics from `samples / 2` upwards are left out.
    pub fn sample(&mut self, series: &[f64], samples: &mut [f64]) {
        self.spectrum.fill(Complex64::default());
        self.spectrum[0].re = series[0];
        let below_nyquist = (self.samples - 1) / 2;
        for (bin, pair) in self.spectrum[1..]
            .iter_mut()
            .zip(series[1..].chunks_exact(2))
            .take(below_nyquist)
        {
            *bin = Complex64::new(0.5 * pair[0], -0.5 * pair[1]);
        }
        let done =
            self.backward
                .process_with_scratch(&mut self.spectrum, samples, &mut self.scratch);
        debug_assert!(
            done.is_ok(),
            "mean and Nyquist are real and lengths fit: {done:?}"
        );
    }

    /// Whether the last `window` coefficients of the spectrum of these samples are below a part of its largest.
    pub(crate) fn is_resolved(&mut self, samples: &[f64], part: f64, window: usize) -> bool {
        self.transform(samples);
        let largest = |bins: &[Complex64]| bins.iter().fold(0.0_f64, |m, b| m.max(b.norm_sqr()));
        let upper = self.spectrum.len().saturating_sub(window);
        let (all, end) = (largest(&self.spectrum), largest(&self.spectrum[upper..]));
        end <= part * part * all
    }

    fn transform(&mut self, samples: &[f64]) {
        self.input.copy_from_slice(samples);
        let done = self.forward.process_with_scratch(
            &mut self.input,
            &mut self.spectrum,
            &mut self.scratch,
        );
        debug_assert!(done.is_ok(), "lengths fit: {done:?}");
    }

    /// Writes the series of samples, as many harmonics as it has room for; those from `samples / 2` upwards are zero.
    pub fn analyse(&mut self, samples: &[f64], series: &mut [f64]) {
        self.transform(samples);
        let scale = 2.0 / self.samples as f64;
        let below_nyquist = (self.samples - 1) / 2;
        series.fill(0.0);
        series[0] = 0.5 * scale * self.spectrum[0].re;
        for (pair, bin) in series[1..]
            .chunks_exact_mut(2)
            .zip(&self.spectrum[1..])
            .take(below_nyquist)
        {
            pair[0] = scale * bin.re;
            pair[1] = -scale * bin.im;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn samples_are_values_and_come_back(
            series in (0_usize..9).prop_flat_map(|k| prop::collection::vec(-1.0..1.0, series::length(k))),
            extra in 0_usize..9,
        ) {
            let n = series.len() + 1 + extra;
            let mut transform = SampledTransform::new(n);
            let mut samples = vec![0.0; n];
            transform.sample(&series, &mut samples);
            for (j, x) in samples.iter().enumerate() {
                let tau = std::f64::consts::TAU * j as f64 / n as f64;
                prop_assert!((x - series::value(&series, tau)).abs() < 1e-13);
            }
            let mut back = vec![0.0; series.len()];
            transform.analyse(&samples, &mut back);
            for (a, b) in back.iter().zip(&series) {
                prop_assert!((a - b).abs() < 1e-13);
            }
        }
    }
}
