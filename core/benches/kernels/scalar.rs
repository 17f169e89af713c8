//! The exponent an argument, sample by sample: with `powf`, and with dual numbers.

use super::dual::{self, Exponent, Sides};
use super::samples::Samples;

/// A loop with one power and one logarithm, everything that can be shared shared. Calls of the standard library are not
/// vectorised.
pub fn powf(sides: Sides, [zeta, alpha]: [f64; 2], samples: &mut Samples) {
    let by_rate = 2.0 * zeta;
    for i in 0..samples.gap.len() {
        let (gap, rate) = (samples.gap[i], samples.rate[i]);
        if gap == 0.0 || (sides == Sides::One && gap < 0.0) {
            let damped = sides == Sides::Both;
            samples.force[i] = if damped { by_rate * rate } else { 0.0 };
            samples.by_gap[i] = 0.0;
            samples.by_rate[i] = if damped { by_rate } else { 0.0 };
            samples.by_argument[i] = 0.0;
            continue;
        }
        let power = gap.abs().powf(alpha);
        let signed = power.copysign(gap);
        samples.force[i] = by_rate * rate + signed;
        samples.by_gap[i] = alpha * signed / gap;
        samples.by_rate[i] = by_rate;
        samples.by_argument[i] = signed * gap.abs().ln();
    }
}

/// Dual numbers with three derivatives.
pub fn duals(sides: Sides, [zeta, alpha]: [f64; 2], samples: &mut Samples) {
    for i in 0..samples.gap.len() {
        let (gap, rate) = (samples.gap[i], samples.rate[i]);
        let exponent = Exponent::Number(alpha);
        let (force, [by_gap, by_rate, by_alpha]) = dual::force(sides, zeta, exponent, gap, rate);
        samples.force[i] = force;
        samples.by_gap[i] = by_gap;
        samples.by_rate[i] = by_rate;
        samples.by_argument[i] = by_alpha;
    }
}

/// Dual numbers with two derivatives, exponent 3/2.
pub fn duals_three_halves(sides: Sides, zeta: f64, samples: &mut Samples) {
    for i in 0..samples.gap.len() {
        let (gap, rate) = (samples.gap[i], samples.rate[i]);
        let exponent = Exponent::ThreeHalves;
        let (force, [by_gap, by_rate]) = dual::force(sides, zeta, exponent, gap, rate);
        samples.force[i] = force;
        samples.by_gap[i] = by_gap;
        samples.by_rate[i] = by_rate;
    }
}
