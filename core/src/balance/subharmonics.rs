//! Orbits of several excitation periods: whether a shorter period would do, and which are the same but for a shift in time.

use crate::branches::orbit::Orbit;
use crate::numeric::fourier::series;

/// Least share of the mean square that the harmonics of a longer period must have. Samples of a force that jumps disturb a
/// simple orbit a little; that is not a longer period.
const SUBHARMONIC_SHARE: f64 = 1e-4;

/// What two orbits have beyond a more regular one, where the straight line between them comes nearest to it, in parts of the smaller:
/// up to this the line passes one.
const NEAR: f64 = 0.3;

/// Whether no divisor of the period is a period of the orbit: for every prime divisor some harmonic is no multiple of it.
/// The last of the extended unknowns is no harmonic; each coordinate has a series of the length.
pub(crate) fn has_shortest_period(u: &[f64], length: usize, period: usize) -> bool {
    let n = u.len() - 1;
    let square = |counts: &dyn Fn(usize) -> bool| -> f64 {
        let counted = (0..n).filter(|i| counts((i % length).div_ceil(2)));
        counted.map(|i| u[i] * u[i]).sum()
    };
    let total = square(&|k| k > 0);
    primes(period).all(|prime| square(&|k| !k.is_multiple_of(prime)) > SUBHARMONIC_SHARE * total)
}

/// The prime divisors of a period.
fn primes(period: usize) -> impl Iterator<Item = usize> {
    (2..=period).filter(move |p| period.is_multiple_of(*p) && (2..*p).all(|q| !p.is_multiple_of(q)))
}

/// Orbits that come back earlier, which a branch passes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shorter {
    /// Their period, in periods of the declaration.
    pub(crate) period: usize,
    /// Their harmonics are multiples of this one.
    times: usize,
}

impl Shorter {
    /// What an orbit has beyond those, beside that of another one.
    pub(crate) fn addition(self, from: &Orbit, u: &[f64]) -> Addition {
        Addition::of(from, u, |harmonic| !harmonic.is_multiple_of(self.times))
    }
}

/// What an orbit has beyond those of a more regular branch, `q`, beside that of another one, `p`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Addition {
    /// `<p, q>`, `<p, p>` and `<q, q>`
    product: f64,
    square: f64,
    other: f64,
}

impl Addition {
    /// Of the harmonics that are chosen.
    pub(crate) fn of(from: &Orbit, u: &[f64], chosen: impl Fn(usize) -> bool) -> Self {
        let length = (u.len() - 1) / from.coordinates();
        let (mut product, mut square, mut other) = (0.0, 0.0, 0.0);
        for i in 0..from.coordinates() {
            let next = &u[i * length..][..length];
            for (index, x) in from.row(i).iter().enumerate() {
                if chosen(index.div_ceil(2)) {
                    let y = next.get(index).copied().unwrap_or(0.0);
                    product += x * y;
                    square += x * x;
                    other += y * y;
                }
            }
        }
        Self {
            product,
            square,
            other,
        }
    }

    /// Along that of the other orbit: one for that orbit itself, zero for a more regular one.
    pub(crate) fn along(self) -> f64 {
        self.product / self.square
    }

    /// Its size in that of the other orbit.
    pub(crate) fn size(self) -> f64 {
        (self.other / self.square).sqrt()
    }

    /// Whether it vanished in between and came back with the other sign: the straight line from one to the other passes the origin
    /// closely. What only turns by more than a right angle does not.
    pub(crate) fn vanished(self) -> bool {
        let area = self.square * self.other - self.product * self.product;
        let apart = self.square + self.other - 2.0 * self.product;
        self.product < 0.0 && area <= NEAR * NEAR * self.square.min(self.other) * apart
    }
}

/// Whether an orbit that comes back earlier lies between an orbit and the next one of its branch, and which: one of a shorter period, or
/// one with more of the harmonics that are multiples of the stride of the system.
pub(crate) fn passes_shorter_period(from: &Orbit, u: &[f64], stride: usize) -> Option<Shorter> {
    let own = from.recurrence().stride();
    let shorter = |times| Shorter {
        period: from.period / times,
        times,
    };
    let within = |times| Shorter {
        period: from.period,
        times: own * times,
    };
    let parts = if stride.is_multiple_of(own) {
        stride / own
    } else {
        1
    };
    primes(from.period)
        .map(shorter)
        .chain(primes(parts).map(within))
        .find(|shorter| shorter.addition(from, u).vanished())
}

/// Whether two orbits are the same to three digits but for a shift by whole excitation periods, or by that part of one after which the
/// system of this stride is the same.
pub(crate) fn is_shifted(a: &Orbit, b: &Orbit, stride: usize) -> bool {
    let parts = a.period * stride;
    (0..parts).any(|shift| {
        let angle = std::f64::consts::TAU * shift as f64 / parts as f64;
        let (mut apart, mut size) = (0.0, 0.0);
        for i in 0..a.coordinates() {
            let (x, y) = (a.row(i), b.row(i));
            apart += (x[0] - y[0]) * (x[0] - y[0]);
            for k in 1..=series::harmonics(x).min(series::harmonics(y)) {
                let (sine, cosine) = (k as f64 * angle).sin_cos();
                let (c, s) = (x[2 * k - 1], x[2 * k]);
                let (c, s) = (c * cosine + s * sine, s * cosine - c * sine);
                apart += (c - y[2 * k - 1]).powi(2) + (s - y[2 * k]).powi(2);
                size += c * c + s * s;
            }
        }
        apart <= 1e-6 * size
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::branches::recurrence::SignedPermutation;

    fn orbit(period: usize, series: &[f64]) -> Orbit {
        Orbit {
            series: series.to_vec(),
            coordinates: 1,
            omega: 1.0,
            base: 1.0 / period as f64,
            period,
            states: Vec::new(),
            symmetric: false,
            parts: 1,
            image: SignedPermutation::identity(),
        }
    }

    #[test]
    fn a_shift_in_time_is_seen() {
        let a = [0.3, 1.0, -0.5, 0.2, 0.1, 0.0, 0.4, 0.05, 0.06];
        // x(tau + pi): odd harmonics change their sign.
        let b = [0.3, -1.0, 0.5, 0.2, 0.1, 0.0, -0.4, 0.05, 0.06];
        assert!(is_shifted(&orbit(2, &a), &orbit(2, &b), 1));
        assert!(!is_shifted(&orbit(1, &a), &orbit(1, &b), 1));
        assert!(is_shifted(&orbit(1, &a), &orbit(1, &a), 1));
        let mut c = b;
        c[4] += 0.01;
        assert!(!is_shifted(&orbit(2, &a), &orbit(2, &c), 1));
    }

    /// A branch of period three may pass near an orbit of period one without meeting it: what it has in addition turns round.
    #[test]
    fn what_turns_does_not_vanish() {
        let from = orbit(3, &[0.3, 0.1, 0.0, 0.0, 0.0, 0.5, 0.0]);
        let next =
            |c: f64, s: f64| passes_shorter_period(&from, &[0.3, c, s, 0.0, 0.0, 0.5, 0.0, 1.0], 1);
        assert!(next(-0.02, 0.1).is_none());
        assert!(next(-0.05, 0.01).is_some());
    }

    /// Of orbits with even harmonics, the second changes its sign: one with the fourth alone lies in between.
    #[test]
    fn an_orbit_that_comes_back_within_the_period_is_seen() {
        let series = |k: f64| [0.3, 0.0, 0.0, k, 0.0, 0.0, 0.0, 0.5, 0.0];
        let from = Orbit {
            parts: 2,
            ..orbit(1, &series(0.1))
        };
        let next = |stride: usize| {
            let u: Vec<f64> = [&series(-0.1)[..], &[1.0]].concat();
            passes_shorter_period(&from, &u, stride).map(|shorter| shorter.period)
        };
        assert_eq!(next(4), Some(1));
        assert_eq!(next(2), None);
        assert_eq!(next(1), None);
    }

    #[test]
    fn an_orbit_of_a_shorter_period_in_between_is_seen() {
        let from = orbit(6, &[0.3, 0.0, 0.1, 0.0, 0.2, 0.5, 0.0]);
        let next = |first: f64, second: f64, third: f64| {
            passes_shorter_period(&from, &[0.3, 0.0, first, 0.0, second, third, 0.0, 1.0], 1)
                .map(|shorter| shorter.period)
        };
        assert_eq!(next(0.09, 0.18, 0.45), None);
        // Without the odd harmonics the period is three, without the first two it is two.
        assert_eq!(next(-0.1, 0.2, -0.5), Some(3));
        assert_eq!(next(-0.1, -0.2, 0.5), Some(2));
        assert!(has_shortest_period(
            &[0.0, 0.0, 0.1, 0.0, 0.2, 0.5, 0.0, 1.0],
            7,
            6
        ));
        assert!(!has_shortest_period(
            &[0.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 1.0],
            7,
            6
        ));
    }
}
