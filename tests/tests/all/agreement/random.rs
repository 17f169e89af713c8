//! Numbers of any size and sign.

use hertzian_tests::random::Random;

/// Either sign, with a logarithm to base ten that is uniform in the given range.
pub fn magnitude(random: &mut Random, low: f64, high: f64) -> f64 {
    let magnitude = 10_f64.powf(random.between(low, high));
    if random.once_in(2) {
        magnitude
    } else {
        -magnitude
    }
}
