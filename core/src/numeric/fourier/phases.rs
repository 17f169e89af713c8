//! Cosines and sines of many phases at once.
//!
//! A phase is reduced by the nearest multiple of `pi / 2`, in three parts of which the first two are short, so that their multiples
//! are exact (Cody and Waite), and the rest is put into the polynomials of fdlibm, whose error is below a unit in the last place.
//! Plain loops without branches, so that they are compiled for the vectors that there are; a library takes one phase at a time.
//!
//! Source: Cody and Waite (1980), Software Manual for the Elementary Functions, chapter 8; Sun Microsystems (1993), fdlibm,
//! `k_sin.c` and `k_cos.c`.
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::kernels::LANES;

/// Beyond this many radians the reduction loses digits.
const LARGEST: f64 = 1e5;

/// Adding this leaves a whole number in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// `pi / 2` in three parts.
const HALF_PI: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];

/// `(sin r - r) / r^3`
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// `(cos r - 1 + r^2 / 2) / r^4`
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Writes sines and cosines. All slices have one length, a multiple of the lanes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(crate) fn sines_and_cosines(phases: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let (phases, _) = phases.as_chunks::<LANES>();
    let (sines, _) = sines.as_chunks_mut::<LANES>();
    let (cosines, _) = cosines.as_chunks_mut::<LANES>();
    for ((phases, sines), cosines) in phases.iter().zip(sines).zip(cosines) {
        [*cosines, *sines] = waves(phases);
    }
}

/// Cosines and sines.
#[inline(always)]
pub(crate) fn waves<const S: usize>(phases: &[f64; S]) -> [[f64; S]; 2] {
    let mut within = true;
    for phase in phases {
        within &= phase.abs() < LARGEST;
    }
    if !within {
        return [phases.map(f64::cos), phases.map(f64::sin)];
    }
    let (mut cosines, mut sines) = ([0.0; S], [0.0; S]);
    for j in 0..S {
        let x = phases[j];
        let shifted = x * std::f64::consts::FRAC_2_PI + WHOLE;
        let quarter = shifted.to_bits();
        let n = shifted - WHOLE;
        let r = ((x - n * HALF_PI[0]) - n * HALF_PI[1]) - n * HALF_PI[2];
        let z = r * r;
        let sine = r + r * z * polynomial(z, &SINE);
        let cosine = 1.0 - (0.5 * z - z * z * polynomial(z, &COSINE));
        let odd = quarter & 1 == 1;
        let (c, s) = if odd { (sine, cosine) } else { (cosine, sine) };
        let sign = |bit: u64| (bit & 1) << 63;
        cosines[j] = f64::from_bits(c.to_bits() ^ sign(quarter ^ (quarter >> 1)));
        sines[j] = f64::from_bits(s.to_bits() ^ sign(quarter >> 1));
    }
    [cosines, sines]
}

#[inline(always)]
fn polynomial(z: f64, c: &[f64; 6]) -> f64 {
    c[0] + z * (c[1] + z * (c[2] + z * (c[3] + z * (c[4] + z * c[5]))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;

    #[test]
    fn agrees_with_the_library() {
        let mut random = Random::seeded(8);
        for reach in [1e-3, 1.0, 7.0, 100.0, 1e4, LARGEST, 1e7] {
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
        assert_eq!(waves(&[0.0]), [[1.0], [0.0]]);
    }
}
