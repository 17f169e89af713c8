//! Directions of contacts along an orbit: of one row of the reduced structure, or of two between which they turn.
//!
//! A direction that turns is `cos(a + h w t) u + sin(a + h w t) v`, with the frequency `w` of the orbit. What is along it is the sum of what is along
//! the rows of `u` and of `v`, its arms, each times a weight `c` that changes with time; its rate is
//!
//! ```text
//! (sum c d . q)' = sum (c d . q' + c' d . q)                                                                  (1)
//! ```

use std::f64::consts::TAU;

use crate::description::contact::SparseContact;
use crate::gaps::TIMES;

/// How a weight changes over the period of an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Weight {
    /// It is one.
    One,
    /// `cos(angle + harmonic w t)`, with the part of a turn by which it lags: a quarter for the sine.
    Turning {
        harmonic: f64,
        angle: f64,
        base: f64,
    },
}

/// A row along which a contact is, times a weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arm {
    /// Among what is read.
    pub(crate) read: usize,
    /// Among what is driven.
    pub(crate) driven: usize,
    weight: Weight,
}

impl Arm {
    /// All arms of a contact, the one of this number, at an orbit of this base frequency where the excitation has the other one.
    pub(crate) fn of(contact: &SparseContact, number: usize, [omega, base]: [f64; 2]) -> Vec<Self> {
        let [first, second] = [2 * number, 2 * number + 1];
        let Some((_, turn)) = &contact.turning else {
            return vec![Self {
                read: first,
                driven: second,
                weight: Weight::One,
            }];
        };
        let [numerator, denominator] = turn.fraction().map(f64::from);
        let harmonic = (numerator / denominator * omega / base).round();
        let arm = |row: usize, angle: f64| Self {
            read: row,
            driven: row,
            weight: Weight::Turning {
                harmonic,
                angle,
                base,
            },
        };
        vec![
            arm(first, turn.angle()),
            arm(second, turn.angle() - TAU / 4.0),
        ]
    }

    /// The weight, and its rate, at a part of the period.
    pub(crate) fn at(&self, part: f64) -> [f64; 2] {
        match self.weight {
            Weight::One => [1.0, 0.0],
            Weight::Turning {
                harmonic,
                angle,
                base,
            } => {
                let (sine, cosine) = (angle + TAU * (harmonic * part).fract()).sin_cos();
                [cosine, -harmonic * base * sine]
            }
        }
    }

    /// The same at one of equal times.
    pub(crate) fn at_time(&self, time: usize) -> [f64; 2] {
        self.at(time as f64 / TIMES as f64)
    }

    /// A series of mean, cosines and sines times the weight.
    pub(crate) fn times(&self, series: &[f64]) -> Vec<f64> {
        let Weight::Turning {
            harmonic, angle, ..
        } = self.weight
        else {
            return series.to_vec();
        };
        let shift = harmonic as usize;
        let (sine, cosine) = angle.sin_cos();
        let mut product = vec![0.0; series.len() + 2 * shift];
        // With z = c - i s of the harmonic k, half of z exp(i angle) goes to k + h, and half of z exp(-i angle) to k - h.
        let mut add = |harmonic: isize, c: f64, s: f64| {
            let k = harmonic.unsigned_abs();
            if k == 0 {
                product[0] += c;
            } else {
                product[2 * k - 1] += c;
                product[2 * k] += if harmonic < 0 { -s } else { s };
            }
        };
        for k in 0..=series.len() / 2 {
            let [c, s] = match k {
                0 => [series.first().copied().unwrap_or(0.0), 0.0],
                _ => [series[2 * k - 1], series[2 * k]],
            };
            let share = if k == 0 && shift > 0 { 1.0 } else { 0.5 };
            let [up, down] = [k as isize + shift as isize, k as isize - shift as isize];
            add(
                up,
                share * (c * cosine + s * sine),
                share * (s * cosine - c * sine),
            );
            if k > 0 || shift == 0 {
                add(
                    down,
                    0.5 * (c * cosine - s * sine),
                    0.5 * (s * cosine + c * sine),
                );
            }
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hertzian::structure::Turn;

    fn value(series: &[f64], phase: f64) -> f64 {
        let harmonics = series[1..].chunks_exact(2).zip(1..);
        let waves = harmonics.map(|(pair, k)| {
            let (sine, cosine) = (f64::from(k) * phase).sin_cos();
            pair[0] * cosine + pair[1] * sine
        });
        series[0] + waves.sum::<f64>()
    }

    /// A product of series has the product of values, for turns of a higher and of lower harmonics than the series has.
    #[test]
    fn a_series_times_a_weight_has_the_product_of_values() {
        let series = [0.3, -0.7, 0.2, 0.5, 1.1, -0.4, 0.9];
        for harmonic in [0.0, 1.0, 2.0, 3.0, 7.0] {
            for lag in [0.0, TAU / 4.0] {
                let arm = Arm {
                    read: 0,
                    driven: 0,
                    weight: Weight::Turning {
                        harmonic,
                        angle: 0.7 - lag,
                        base: 2.0,
                    },
                };
                let product = arm.times(&series);
                for i in 0..17 {
                    let part = f64::from(i) / 17.0;
                    let expected = arm.at(part)[0] * value(&series, TAU * part);
                    assert!((value(&product, TAU * part) - expected).abs() < 1e-13);
                    let [_, rate] = arm.at(part);
                    let beside = [part - 1e-6, part + 1e-6].map(|part| arm.at(part)[0]);
                    let slope = (beside[1] - beside[0]) / (2e-6 * TAU / 2.0);
                    assert!((rate - slope).abs() < 1e-6 * (1.0 + rate.abs()));
                }
            }
        }
        assert_eq!(Turn::by(2, 5).from(0.3).angle(), 0.3);
    }
}
