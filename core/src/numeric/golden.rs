//! The largest value of a function between two places.
//!
//! Source: Kiefer (1953), Sequential minimax search for a maximum.

/// Steps: the bracket shrinks by `0.618` in each, and the value is known to rounding at the end.
const STEPS: usize = 45;

/// The largest value between two places, by golden section: near a maximum its place is known to half of the digits, and its value to
/// rounding.
pub(crate) fn largest(mut at: impl FnMut(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut c, mut d) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut of_c, mut of_d) = (at(c), at(d));
    let mut largest = of_c.max(of_d);
    for _ in 0..STEPS {
        if of_c > of_d {
            (high, d, of_d) = (d, c, of_c);
            c = high - ratio * (high - low);
            of_c = at(c);
        } else {
            (low, c, of_c) = (c, d, of_d);
            d = low + ratio * (high - low);
            of_d = at(d);
        }
        largest = largest.max(of_c).max(of_d);
    }
    largest
}
