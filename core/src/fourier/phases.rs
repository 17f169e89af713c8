//! Sines and cosines of many phases at once.
//!
//! The argument is reduced to a quarter of a period, `x = n pi/2 + r` with `|r| <= pi/4`, where `pi/2` is taken as the sum of a
//! number of 33 bits, whose multiples are exact, and its remainder; `sin r` and `cos r` are the polynomials of least error on
//! that interval. Results differ from the exact ones by one unit in the last place or so, as those of a library do; a
//! library takes one phase at a time.
//!
//! Source: Ng (1992), Argument reduction for huge arguments: good to the last bit, and the kernels of FDLIBM (Sun
//! Microsystems, 1993), from which the coefficients are.

use multiversion::multiversion;

use super::kernels::LANES;

/// Phases beyond this are not reduced exactly.
#[cfg(test)]
const LARGEST: f64 = 1e4;

const HALF_PI: [f64; 2] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A62_6331),
];
/// Added and subtracted, it rounds to a whole number.
const ROUND: f64 = 6_755_399_441_055_744.0;

const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Writes sines and cosines of phases up to some thousand periods. All slices have one length, a multiple of the lanes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(crate) fn sines_and_cosines(phases: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let groups = phases
        .chunks_exact(LANES)
        .zip(sines.chunks_exact_mut(LANES))
        .zip(cosines.chunks_exact_mut(LANES));
    for ((phases, sines), cosines) in groups {
        for lane in 0..LANES {
            let x = phases[lane];
            let quarters = (x * std::f64::consts::FRAC_2_PI + ROUND) - ROUND;
            let r = (x - quarters * HALF_PI[0]) - quarters * HALF_PI[1];
            let z = r * r;
            let s = r + r * z * polynomial(&SINE, z);
            // 1 - z/2 first, and what its rounding lost.
            let half = 0.5 * z;
            let rest = 1.0 - half;
            let c = rest + (((1.0 - rest) - half) + z * z * polynomial(&COSINE, z));
            // The quarter, from 0 to 3.
            let turn = quarters - 4.0 * ((0.25 * quarters - 0.375 + ROUND) - ROUND);
            let odd = turn == 1.0 || turn == 3.0;
            let (sine, cosine) = if odd { (c, s) } else { (s, c) };
            sines[lane] = if turn >= 2.0 { -sine } else { sine };
            let left = turn == 1.0 || turn == 2.0;
            cosines[lane] = if left { -cosine } else { cosine };
        }
    }
}

#[inline(always)]
#[allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]
fn polynomial(c: &[f64; 6], z: f64) -> f64 {
    c[0] + z * (c[1] + z * (c[2] + z * (c[3] + z * (c[4] + z * c[5]))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn agrees_with_the_library() {
        let mut random = Random::new(8);
        for reach in [1e-3, 1.0, 7.0, 100.0, LARGEST] {
            let mut phases: Vec<f64> = (0..4096).map(|_| random.between(-reach, reach)).collect();
            for (index, phase) in phases.iter_mut().take(64).enumerate() {
                *phase = (index as f64 - 32.0) * std::f64::consts::FRAC_PI_4;
            }
            let (mut sines, mut cosines) = (vec![0.0; 4096], vec![0.0; 4096]);
            sines_and_cosines(&phases, &mut sines, &mut cosines);
            for ((phase, s), c) in phases.iter().zip(&sines).zip(&cosines) {
                let (sine, cosine) = phase.sin_cos();
                // Close to a multiple of pi/2 the result is small, and its error that of the reduction.
                let near = |a: f64, b: f64| (a - b).abs() <= 2.0 * f64::EPSILON * b.abs().max(1e-7);
                assert!(
                    near(*s, sine) && near(*c, cosine),
                    "{phase}: {s} {sine} {c} {cosine}"
                );
            }
        }
    }
}
