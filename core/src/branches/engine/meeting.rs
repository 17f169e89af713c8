//! Pairs of multipliers that meet and may part across the unit circle.
//!
//! Where two pairs come together, their moduli part as a square root does, and what they are at successive points tells nothing of what
//! they come to in between. With the logarithms `l_1`, `l_2` of both, `s = Re (l_1 + l_2) / 2` and `(l_1 - l_2)^2 / 4 = p + i q` are smooth
//! all along, and so is
//!
//! ```text
//! F = s^4 - s^2 p - q^2 / 4 = Re l_1 Re l_2 (s^2 + (Im l_1 - Im l_2)^2 / 4)                                    (1)
//! ```
//!
//! which is negative where one pair is inside of the circle and the other one outside.
//!
//! Source: (1) is the part of the bialternate product, Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria,
//! chapter 4, that belongs to two pairs beside each other.

use nalgebra::Complex;

use super::seen::Seen;
use crate::branches::problem::TestValue;

/// Of more pairs than this those are looked at whose logarithms are not so far below the largest one, or below the circle if the largest is outside:
/// at most, and at least.
const FEW: usize = 8;
const SMALL: [f64; 2] = [-1.0, -0.2];
/// And so far above the smallest one that is known.
const CUT: f64 = 0.5;

/// Two pairs of multipliers of one orbit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    /// Logarithms of the multipliers with a positive imaginary part.
    pairs: [Complex<f64>; 2],
    /// To which logarithms of moduli are known.
    noise: f64,
}

impl Meeting {
    /// All of an orbit; where there are many, those of the larger ones.
    pub(super) fn all(seen: &Seen, noise: f64) -> Vec<Self> {
        let pairs = seen.pairs.as_deref().unwrap_or_default();
        let few = pairs.len() <= FEW;
        let sizes = || pairs.iter().map(|pair| pair.re);
        let largest = sizes().fold(f64::NEG_INFINITY, f64::max).min(0.0);
        // Where small ones are left out, those that are about to be have no others beside them.
        let smallest = sizes().fold(f64::INFINITY, f64::min) - largest;
        let [far, near] = SMALL;
        let least = largest + (smallest + CUT).clamp(far, near);
        let counts = |pair: &&Complex<f64>| few || pair.re > least;
        let pairs: Vec<_> = pairs.iter().filter(counts).collect();
        let mut all = Vec::new();
        for (i, one) in pairs.iter().enumerate() {
            all.extend(pairs[..i].iter().map(|other| Self {
                pairs: [**one, **other],
                noise,
            }));
        }
        all
    }

    /// (1) at another orbit, of the two pairs that these are nearest to.
    pub(super) fn value(&self, seen: &Seen) -> TestValue {
        let among = seen.pairs.as_deref().unwrap_or_default();
        let Some([a, b]) = self.nearest(among) else {
            return TestValue::UNKNOWN;
        };
        let s = 0.5 * (a.re + b.re);
        if s.abs() <= self.noise {
            return TestValue::UNKNOWN;
        }
        let half = 0.5 * (a - b);
        let Complex { re: p, im: q } = half * half;
        TestValue::plain(s * s * (s * s - p) - 0.25 * q * q)
    }

    /// The two that are nearest together: where both have moved the same way, one may be the nearest of each, and another one is that of one of
    /// them then.
    fn nearest(&self, among: &[Complex<f64>]) -> Option<[Complex<f64>; 2]> {
        let [ones, others] = self.pairs.map(|pair| nearest_two(among, pair));
        let places = ones.into_iter().flatten();
        let places = places.flat_map(|i| others.into_iter().flatten().map(move |j| [i, j]));
        let apart = |[i, j]: &[usize; 2]| {
            let [one, other] = self.pairs;
            (among[*i] - one).norm() + (among[*j] - other).norm()
        };
        places
            .filter(|[i, j]| i != j)
            .min_by(|x, y| apart(x).total_cmp(&apart(y)))
            .map(|places| places.map(|place| among[place]))
    }
}

/// The places of the nearest and the second nearest to one.
fn nearest_two(among: &[Complex<f64>], to: Complex<f64>) -> [Option<usize>; 2] {
    let mut found = [None, None];
    // Squares are in the order of distances, and logarithms are no large numbers.
    let mut apart = [f64::INFINITY; 2];
    for (place, pair) in among.iter().enumerate() {
        let square = (pair - to).norm_sqr();
        if found[0].is_none() || square < apart[0] {
            found = [Some(place), found[0]];
            apart = [square, apart[0]];
        } else if found[1].is_none() || square < apart[1] {
            found[1] = Some(place);
            apart[1] = square;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::follow::CurvePoint;
    use crate::continuation::problem::Scale;

    fn at(pairs: [Complex<f64>; 2]) -> Seen {
        Seen {
            point: CurvePoint {
                u: vec![0.0],
                tangent: vec![1.0],
                scale: Scale::UNIT,
            },
            values: Vec::new(),
            pairs: Some(pairs.to_vec()),
            falls: None,
        }
    }

    /// Of all places, one by one.
    #[test]
    fn the_nearest_two_are_those_of_all() {
        let number = |i: u64| (0.7 * (i * i % 1009) as f64).sin();
        for count in 0..7 {
            for case in 0..40 {
                let z = |i: u64| Complex::new(number(91 * case + i), number(57 * case + 3 * i + 1));
                let among: Vec<_> = (0..count).map(|i| z(i + 2)).collect();
                let (pairs, noise) = ([z(0), 0.9 * z(0) + 0.1 * z(1)], 0.0);
                let apart = |i: usize, j: usize| {
                    (among[i] - pairs[0]).norm() + (among[j] - pairs[1]).norm()
                };
                let count = among.len();
                let places = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
                let others = places.filter(|(i, j)| i != j);
                let least = others.map(|(i, j)| apart(i, j)).min_by(f64::total_cmp);
                let found = Meeting { pairs, noise }.nearest(&among);
                let found = found.map(|[a, b]| (a - pairs[0]).norm() + (b - pairs[1]).norm());
                assert_eq!(found, least);
            }
        }
    }

    /// `l = s + 0.9 i +- d^(1/2)`: the moduli have kinks where `d` vanishes, (1) is a parabola of a `d` that goes straight.
    #[test]
    fn where_pairs_meet_the_function_is_smooth() {
        let s = -0.03;
        let pairs = |d: Complex<f64>| {
            let root = d.sqrt();
            let mean = Complex::new(s, 0.9);
            at([mean + root, mean - root])
        };
        let meeting = Meeting::all(&pairs(Complex::new(-1e-4, 1e-5)), 1e-9)[0];
        let way = |t: f64| Complex::new(-1e-4 + 2e-3 * t, 1e-5 - 1e-5 * t);
        let value = |t: f64| meeting.value(&pairs(way(t))).mantissa;
        for t in [0.0, 0.2, 0.5, 0.8] {
            let third = value(t + 0.2) - 3.0 * value(t + 0.1) + 3.0 * value(t) - value(t - 0.1);
            assert!(
                third.abs() < 1e-12 * value(0.0).abs().max(1e-6),
                "{third:e}"
            );
            let apart = way(t).sqrt().re.abs() > -s;
            assert_eq!(value(t) < 0.0, apart, "{t}");
        }
        let unknown = Meeting {
            noise: 0.1,
            ..meeting
        };
        assert!(!unknown.value(&pairs(way(0.5))).is_known());
    }
}
