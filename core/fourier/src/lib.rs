//! Plans of Fourier transforms of real samples.
//!
//! Algorithms of transforms are generic over their numbers, and compiled where they are planned: nearly a fifth of the lines that a compiler
//! would make of the runtime. Here that is done once, and not again for each build of the runtime.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

/// From so many real samples to half of their spectrum, without a factor.
///
/// ```
/// let plan = hertzian_fourier::forward(4);
/// let (mut samples, mut spectrum) = ([1.0, 0.0, -1.0, 0.0], plan.make_output_vec());
/// plan.process(&mut samples, &mut spectrum)?;
/// assert_eq!(spectrum.iter().map(|bin| bin.re).collect::<Vec<_>>(), [0.0, 2.0, 0.0]);
/// # Ok::<(), realfft::FftError>(())
/// ```
#[must_use]
pub fn forward(samples: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::new().plan_fft_forward(samples)
}

/// From half of a spectrum to so many real samples, without a factor: so many times as large as what [`forward`] was given.
#[must_use]
pub fn inverse(samples: usize) -> Arc<dyn ComplexToReal<f64>> {
    RealFftPlanner::new().plan_fft_inverse(samples)
}
