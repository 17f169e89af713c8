//! What is computed without knowing a model: dense equations, powers, series, small eigenvalues.

pub(crate) mod decimal;
pub(crate) mod estimate;
pub(crate) mod exponential;
pub mod fourier;
mod francis;
pub(crate) mod leading;
pub(crate) mod linear;
pub(crate) mod peak;
pub mod power;
pub(crate) mod roots;
pub(crate) mod sparse;
pub(crate) mod spectrum;
pub(crate) mod triangular;

/// Makes each number larger or smaller by at most a part of itself, in no order that rows of them could have.
pub(crate) fn disturb(numbers: &mut [f64], by: f64) {
    for (x, index) in numbers.iter_mut().zip(1_u64..) {
        // Steele, Lea and Flood (2014), Fast splittable pseudorandom number generators, section 4.
        let mixed = index.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let part = (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        *x *= 1.0 + part * by;
    }
}
