//! Functions of time: cosines and sines of rational multiples of `omega t`.

use crate::dag::Rational;

/// `cos(multiple omega t)` or `sin(multiple omega t)`, with a multiple that is not negative; the constant is the cosine of zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Wave {
    /// Frequency over `omega`.
    pub multiple: Rational,
    /// Sine rather than cosine.
    pub sine: bool,
}

impl Wave {
    /// One.
    pub const CONSTANT: Self = Self {
        multiple: Rational::ZERO,
        sine: false,
    };

    /// The wave of any multiple, with the sign in front of it; `None` for the sine of zero.
    pub fn new(multiple: Rational, sine: bool) -> Option<(Rational, Self)> {
        let minus_one = Rational::integer(-1);
        let sign = if sine && multiple.is_negative() {
            minus_one
        } else {
            Rational::ONE
        };
        let multiple = multiple.absolute()?;
        (!sine || !multiple.is_zero()).then_some((sign, Self { multiple, sine }))
    }

    /// The product of two waves as a sum: `2 cos a cos b = cos(a-b) + cos(a+b)` and its kin. `None` where a multiple does not fit.
    pub fn times(self, other: Self) -> Option<Vec<(Rational, Self)>> {
        if self == Self::CONSTANT {
            return Some(vec![(Rational::ONE, other)]);
        }
        if other == Self::CONSTANT {
            return Some(vec![(Rational::ONE, self)]);
        }
        let half = Rational::new(1, 2)?;
        let minus = half.negate()?;
        let sum = self.multiple.checked_add(other.multiple)?;
        let difference = self.multiple.checked_sub(other.multiple)?;
        // The weights of the wave of the difference and of that of the sum.
        let (sine, of_difference, of_sum) = match (self.sine, other.sine) {
            (false, false) => (false, half, half),
            (true, true) => (false, half, minus),
            (true, false) => (true, half, half),
            (false, true) => (true, minus, half),
        };
        let mut waves = Vec::new();
        for (weight, multiple) in [(of_difference, difference), (of_sum, sum)] {
            if let Some((sign, wave)) = Self::new(multiple, sine) {
                waves.push((weight.checked_mul(sign)?, wave));
            }
        }
        Some(waves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(weight: Rational, wave: Wave, phase: f64) -> f64 {
        let angle = wave.multiple.to_f64() * phase;
        weight.to_f64() * if wave.sine { angle.sin() } else { angle.cos() }
    }

    #[test]
    fn products_are_sums() {
        let multiples = [
            Rational::ONE,
            Rational::integer(3),
            Rational::new(2, 5).unwrap(),
        ];
        for (a, b) in multiples
            .into_iter()
            .flat_map(|a| multiples.map(|b| (a, b)))
        {
            for (first, second) in [(false, false), (false, true), (true, false), (true, true)] {
                let one = (
                    Rational::ONE,
                    Wave {
                        multiple: a,
                        sine: first,
                    },
                );
                let two = (
                    Rational::ONE,
                    Wave {
                        multiple: b,
                        sine: second,
                    },
                );
                let product = one.1.times(two.1).unwrap();
                for phase in [0.3, 1.7, 4.0] {
                    let sum: f64 = product.iter().map(|&(w, wave)| value(w, wave, phase)).sum();
                    assert!(
                        (sum - value(one.0, one.1, phase) * value(two.0, two.1, phase)).abs()
                            < 1e-14
                    );
                }
            }
        }
    }
}
