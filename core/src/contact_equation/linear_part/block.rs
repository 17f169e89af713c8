//! Two states of the linear part that no other is coupled with: the exponential of a matrix of order two.
//!
//! With `m = tr A / 2` and `D = A - m`, `D^2 = d I`, so that for every kind of damping, of rigid and of repeated exponents too,
//!
//! ```text
//! e^(A s) = c(s) I + k(s) D,    c = e^(m s) cosh(sqrt(d) s),    k = e^(m s) sinh(sqrt(d) s) / sqrt(d)         (1)
//! ```
//!
//! where `d < 0` has cosine and sine. The response from rest to a wave `e^(i w t)` is (1) with
//!
//! ```text
//! r(s) = int_0^s k(u) e^(i w (s - u)) du,    p(s) = int_0^s c(u) e^(i w (s - u)) du = k + (i w - m) r         (2)
//! ```
//!
//! Exponents that are real and differ are taken apart. The far one `f = m -+ sqrt(d)` is a sum of equal signs, the near one is
//! `det A / f`, so that neither cancels, and with them
//!
//! ```text
//! r(s) = (phi(f) - phi(n)) / (f - n),    phi(e) = int_0^s e^(e u) e^(i w (s - u)) du = s e^(i w s) E((e - i w) s)       (3)
//! ```
//!
//! with `E(z) = (e^z - 1) / z`. Under a constant load, where neither does much within the time, `k` is integrated term by term,
//!
//! ```text
//! k(s) = sum_n h_n s^(n + 1) / (n + 1)!,    h_n = tr A h_(n - 1) - det A h_(n - 2),    h_0 = 1, h_(-1) = 0        (4)
//! ```
//!
//! Sources: Higham (2008), Functions of Matrices, section 1.2 (equation 1.10, interpolation of Hermite) and equation (10.51) for `E`;
//! Higham (2002), Accuracy and Stability of Numerical Algorithms, section 1.8 for the roots.

use multiversion::multiversion;
use nalgebra::Complex;

use crate::numeric::fourier::gauss;

/// A matrix of order two, row by row.
pub(in crate::contact_equation) type Square = [[f64; 2]; 2];
/// Two states.
pub(in crate::contact_equation) type Pair = [f64; 2];

/// Exponents nearer to each other than this part of them are not told apart.
const APART: f64 = 1e-2;
/// Below this `d s^2` series take the place of sine and cosine.
const SMALL: f64 = 0.1;
/// Points of the rule for (2), and the angle that the fastest factor turns by between one and the next such rule.
const POINTS: usize = 24;
const TURN: f64 = 4.0;
/// More such rules than this are no part of a period.
const MOST: f64 = 1e5;

/// `A` of two states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::contact_equation) struct Block {
    /// `A`
    pub(in crate::contact_equation) matrix: Square,
    /// `m`
    mean: f64,
    /// `D`
    pub(in crate::contact_equation) deviation: Square,
    /// `d`
    square: f64,
    /// `sqrt(|d|)`
    root: f64,
    /// `det A`
    determinant: f64,
    /// Both exponents, the larger one first, where they are real.
    exponents: Pair,
}

/// `c` and `k` of (1).
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Kernel {
    pub(in crate::contact_equation) c: f64,
    pub(in crate::contact_equation) k: f64,
}

/// Two of the states.
pub(in crate::contact_equation) fn pair(states: &[f64], r: usize) -> Pair {
    [states[2 * r], states[2 * r + 1]]
}

/// The product of a matrix and two states.
pub(in crate::contact_equation) fn times(a: Square, x: Pair) -> Pair {
    [
        a[0][0] * x[0] + a[0][1] * x[1],
        a[1][0] * x[0] + a[1][1] * x[1],
    ]
}

/// The product of two matrices.
pub(super) fn product(a: Square, b: Square) -> Square {
    a.map(|row| row_times(row, b))
}

/// The product of two states as a row and a matrix.
pub(in crate::contact_equation) fn row_times(x: Pair, a: Square) -> Pair {
    [
        x[0] * a[0][0] + x[1] * a[1][0],
        x[0] * a[0][1] + x[1] * a[1][1],
    ]
}

/// Adds a multiple.
pub(in crate::contact_equation) fn add(to: &mut [f64], factor: f64, of: &[f64]) {
    for (to, of) in to.iter_mut().zip(of) {
        *to += factor * of;
    }
}

/// Adds two multiples.
pub(in crate::contact_equation) fn add_both([a, b]: [&[f64]; 2], [x, y]: [f64; 2], to: &mut [f64]) {
    if let ([a], [b], [to]) = (a, b, &mut *to) {
        // Most ways have no nodes, and one target.
        *to += x * a + y * b;
    } else {
        add_many([a, b], [x, y], to);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_many([a, b]: [&[f64]; 2], [x, y]: [f64; 2], to: &mut [f64]) {
    for ((to, a), b) in to.iter_mut().zip(a).zip(b) {
        *to += x * a + y * b;
    }
}

impl Block {
    pub(in crate::contact_equation) fn new(matrix: Square) -> Self {
        let mean = 0.5 * (matrix[0][0] + matrix[1][1]);
        let mut deviation = matrix;
        deviation[0][0] -= mean;
        deviation[1][1] -= mean;
        let square = deviation[0][0] * deviation[0][0] + deviation[0][1] * deviation[1][0];
        let root = square.abs().sqrt();
        let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
        let far = mean + root.copysign(mean);
        let near = if far == 0.0 { 0.0 } else { determinant / far };
        Self {
            matrix,
            mean,
            deviation,
            square,
            root,
            determinant,
            exponents: [far.max(near), far.min(near)],
        }
    }

    /// Both exponents are zero: `c = 1`, `k = s`.
    pub(in crate::contact_equation) fn is_free(&self) -> bool {
        self.mean == 0.0 && self.square == 0.0
    }

    /// `m`
    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// Size of the faster exponent.
    pub(in crate::contact_equation) fn rate(&self) -> f64 {
        self.mean.abs() + self.root
    }

    /// Bounds of both states within a time from these, if nothing acts on them.
    pub(in crate::contact_equation) fn bound(&self, x: Pair, time: f64) -> Pair {
        let turned = times(self.deviation, x);
        let grows = self.mean + self.square.max(0.0).sqrt();
        let growth = (grows * time).exp().max(1.0);
        [0, 1].map(|i| {
            if self.square < 0.0 && self.root * time > 1.0 {
                growth * x[i].hypot(turned[i] / self.root)
            } else {
                // Of what hardly turns a straight line is more.
                growth * (x[i].abs() + turned[i].abs() * time.min(1.0 / self.root))
            }
        })
    }

    /// Both exponents, the larger one first, where they are real and differ.
    pub(in crate::contact_equation) fn real_exponents(&self) -> Option<[f64; 2]> {
        let differ = self.square > 0.0 && self.root > APART * self.mean.abs();
        differ.then_some(self.exponents)
    }

    /// What states have of each of these, `(x +- D x / sqrt(d)) / 2`.
    pub(in crate::contact_equation) fn real_parts(&self, x: Pair) -> [Pair; 2] {
        let turned = times(self.deviation, x);
        [1.0, -1.0].map(|sign| [0, 1].map(|i| 0.5 * (x[i] + sign * turned[i] / self.root)))
    }

    /// The exponent of what grows; zero where nothing does.
    pub(in crate::contact_equation) fn growth(&self) -> f64 {
        let fastest = if self.square > 0.0 {
            self.exponents[0]
        } else {
            self.mean
        };
        fastest.max(0.0)
    }

    /// The exponent of what decays most slowly; zero where it grows.
    pub(in crate::contact_equation) fn slowest(&self) -> f64 {
        let slowest = if self.square > 0.0 {
            self.exponents[0]
        } else {
            self.mean
        };
        slowest.min(0.0)
    }

    /// `-A^-1` of a constant load; nothing where an exponent is zero.
    pub(in crate::contact_equation) fn held(&self, load: Pair) -> Pair {
        let determinant = self.determinant;
        let [[a, b], [c, d]] = self.matrix;
        let rounding = 4.0 * f64::EPSILON * ((a * d).abs() + (b * c).abs());
        if determinant.abs() <= rounding {
            return [0.0; 2];
        }
        [
            (b * load[1] - d * load[0]) / determinant,
            (c * load[0] - a * load[1]) / determinant,
        ]
    }

    /// The faster of what decays, whether it oscillates or not.
    pub(super) fn decay(&self) -> f64 {
        self.mean.abs() + self.square.max(0.0).sqrt()
    }

    /// Squares of the sizes of both exponents, without those that are zero.
    pub(in crate::contact_equation) fn squares(&self) -> impl Iterator<Item = f64> {
        let product = self.determinant.abs();
        let larger = if self.square > 0.0 {
            self.rate() * self.rate()
        } else {
            product
        };
        let smaller = product * product / larger;
        [larger, smaller].into_iter().filter(|size| *size > 0.0)
    }

    /// Angular frequency of what oscillates; zero where nothing does.
    pub(in crate::contact_equation) fn turns(&self) -> f64 {
        (-self.square).max(0.0).sqrt()
    }

    /// (1)
    pub(in crate::contact_equation) fn kernel(&self, s: f64) -> Kernel {
        let x = self.square * s * s;
        let (c, k) = if x.abs() < SMALL {
            series(x, s)
        } else if x > 0.0 {
            // Both exponents at once, so that no factor overflows where they decay.
            let [plus, minus] = self.exponents.map(|exponent| (exponent * s).exp());
            return Kernel {
                c: 0.5 * (plus + minus),
                k: 0.5 * (plus - minus) / self.root,
            };
        } else {
            let root = self.root;
            let (sine, cosine) = (root * s).sin_cos();
            (cosine, sine / root)
        };
        let decay = if self.mean == 0.0 {
            1.0
        } else {
            (self.mean * s).exp()
        };
        Kernel {
            c: decay * c,
            k: decay * k,
        }
    }

    /// `a c(s) + b k(s)` as real parts of two exponentials `z e^(m s)`; `None` where both are nearly one, or hardly change within a time: they cancel.
    pub(in crate::contact_equation) fn exponentials(
        &self,
        [a, b]: Pair,
        time: f64,
    ) -> Option<[[Complex<f64>; 2]; 2]> {
        if self.root <= APART * self.mean.abs() || self.root * time <= APART {
            return None;
        }
        let by = b / self.root;
        let real = |x: f64| Complex::new(x, 0.0);
        Some(if self.square < 0.0 {
            let m = Complex::new(self.mean, self.root);
            [[Complex::new(a, -by), m], [real(0.0), m]]
        } else {
            let of = |sign: f64| {
                [
                    real(0.5 * (a + sign * by)),
                    real(self.mean + sign * self.root),
                ]
            };
            [of(1.0), of(-1.0)]
        })
    }

    /// `e^(A s)`
    pub(in crate::contact_equation) fn exponential(&self, s: f64) -> Square {
        self.exponential_of(self.kernel(s))
    }

    /// `c I + k D`
    pub(in crate::contact_equation) fn exponential_of(&self, Kernel { c, k }: Kernel) -> Square {
        let d = self.deviation;
        [
            [c + k * d[0][0], k * d[0][1]],
            [k * d[1][0], c + k * d[1][1]],
        ]
    }

    /// `(c I + k D) x`
    pub(in crate::contact_equation) fn carried(&self, Kernel { c, k }: Kernel, x: Pair) -> Pair {
        let turned = times(self.deviation, x);
        [0, 1].map(|i| c * x[i] + k * turned[i])
    }

    /// `(c I + k D)(a I + b D)`, of a kernel and the coefficients of another such matrix.
    pub(in crate::contact_equation) fn compose(
        &self,
        Kernel { c, k }: Kernel,
        a: f64,
        b: f64,
    ) -> (f64, f64) {
        (c * a + k * self.square * b, c * b + k * a)
    }

    /// The steady response to a wave of this frequency: `(i w - A)^-1 b`, and its derivative by the frequency; `None` where an exponent
    /// is so near that the response from rest is all there is.
    pub(in crate::contact_equation) fn steady(
        &self,
        frequency: f64,
        input: [Complex<f64>; 2],
    ) -> Option<[[Complex<f64>; 2]; 2]> {
        if self.is_resonant(frequency) {
            return None;
        }
        let [[a, b], [c, d]] = self.matrix;
        let wave = Complex::new(0.0, frequency);
        // (i w)^2 - i w tr A + det A
        let determinant = Complex::new(
            self.determinant - frequency * frequency,
            -frequency * (a + d),
        );
        let inverse = |x: [Complex<f64>; 2]| {
            [
                ((wave - d) * x[0] + x[1] * b) / determinant,
                (x[0] * c + (wave - a) * x[1]) / determinant,
            ]
        };
        let response = inverse(input);
        let by = inverse(response).map(|x| x * Complex::new(0.0, -1.0));
        Some([response, by])
    }

    /// Whether an exponent is so near to that of a wave that the steady response cancels in what there is.
    fn is_resonant(&self, frequency: f64) -> bool {
        if self.square > 0.0 {
            // Real exponents are near to no wave but a constant.
            let [larger, smaller] = self.exponents.map(f64::abs);
            return frequency == 0.0 && larger.min(smaller) <= NEAR * larger.max(smaller);
        }
        let apart = (frequency.abs() - self.root).hypot(self.mean);
        apart <= NEAR * (frequency.abs() + self.root + self.mean.abs())
    }

    /// (2) and its derivatives by the frequency: `p`, `r`, `dp`, `dr`.
    pub(super) fn response_at_rest(&self, frequency: f64, s: f64) -> [Complex<f64>; 4] {
        if self.is_free() && frequency == 0.0 {
            let real = |x: f64| Complex::new(x, 0.0);
            let slope = |x: f64| Complex::new(0.0, x);
            let square = 0.5 * s * s;
            return [
                real(s),
                real(square),
                slope(square),
                slope(square * s / 3.0),
            ];
        }
        // Where both exponents do little within the time, (3) cancels, and few rules do.
        let apart = self.root * s.abs() > 1.0;
        if let Some(exponents) = self.real_exponents().filter(|_| apart) {
            return by_exponents(exponents, frequency, s);
        }
        let wave = Complex::new(0.0, frequency);
        let [r, by] = if frequency == 0.0 && self.rate() * s.abs() <= 1.0 {
            self.by_series(s)
        } else {
            self.by_rule(frequency, s)
        };
        let k = self.kernel(s).k;
        let p = k + (wave - self.mean) * r;
        let p_by = (wave - self.mean) * by + r * Complex::new(0.0, 1.0);
        [p, r, p_by, by]
    }

    /// `r` of (2) under a constant load and its derivative, by (4).
    fn by_series(&self, s: f64) -> [Complex<f64>; 2] {
        let (trace, determinant) = (2.0 * self.mean * s, self.determinant * s * s);
        let (mut before, mut term) = (0.0, 1.0);
        let mut factor = 0.5 * s * s;
        let (mut r, mut by) = (0.0, 0.0);
        for n in 0..TERMS {
            let next = factor / f64::from(n + 3);
            r += factor * term;
            by += next * s * term;
            factor = next;
            (before, term) = (term, trace * term - determinant * before);
        }
        [Complex::new(r, 0.0), Complex::new(0.0, by)]
    }

    /// `r` of (2) and its derivative, by rules of Gauss.
    fn by_rule(&self, frequency: f64, s: f64) -> [Complex<f64>; 2] {
        let wave = Complex::new(0.0, frequency);
        let turn = (self.rate() + frequency) * s.abs();
        let rules = (turn / TURN).ceil().max(1.0);
        // Unknowns that belong to no motion: there the pass fails.
        if rules > MOST {
            return [Complex::new(f64::NAN, f64::NAN); 2];
        }
        let rule = gauss::rule(POINTS);
        let mut r = Complex::new(0.0, 0.0);
        let mut by = r;
        let length = s / rules;
        for part in 0..rules as usize {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let u = length * (part as f64 + node);
                let value = (wave * (s - u)).exp() * (length * weight * self.kernel(u).k);
                r += value;
                by += value * Complex::new(0.0, s - u);
            }
        }
        [r, by]
    }
}

/// (2) by (3) and its derivatives by the frequency: `p`, `r`, `dp`, `dr`.
fn by_exponents(exponents: Pair, frequency: f64, s: f64) -> [Complex<f64>; 4] {
    let wave = Complex::new(0.0, frequency);
    let turn = (wave * s).exp();
    let [larger, smaller] = exponents.map(|exponent| {
        let z = (exponent - wave) * s;
        let (value, slope) = quotient(z);
        let by = Complex::new(0.0, s * s);
        [turn * value * s, turn * (value - slope) * by]
    });
    let apart = exponents[0] - exponents[1];
    let sum = |i: usize| 0.5 * (larger[i] + smaller[i]);
    let difference = |i: usize| (larger[i] - smaller[i]) / apart;
    [sum(0), difference(0), sum(1), difference(1)]
}

/// `E` of (3) and its derivative.
fn quotient(z: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    if z.norm() > 1.0 {
        let value = (z.exp() - 1.0) / z;
        return (value, (z.exp() - value) / z);
    }
    // E = sum z^n / (n + 1)!, E' = sum (n + 1) z^n / (n + 2)!
    let zero = Complex::new(0.0, 0.0);
    let (mut value, mut slope, mut term) = (zero, zero, Complex::new(1.0, 0.0));
    for n in 0..TERMS {
        let n = f64::from(n);
        value += term / (n + 1.0);
        slope += term / (n + 2.0);
        term *= z / (n + 1.0);
    }
    (value, slope)
}

/// Terms of the series of `E`, and of (4), for arguments up to one.
const TERMS: u32 = 18;

/// Exponents as near as this to a frequency, relative to both, are in resonance.
const NEAR: f64 = 1e-5;

/// `cosh sqrt(x)` and `s sinh sqrt(x) / sqrt(x)` for small `x` of either sign.
fn series(x: f64, s: f64) -> (f64, f64) {
    let c = 1.0
        + x / 2.0
            * (1.0
                + x / 12.0
                    * (1.0 + x / 30.0 * (1.0 + x / 56.0 * (1.0 + x / 90.0 * (1.0 + x / 132.0)))));
    let k = 1.0
        + x / 6.0
            * (1.0
                + x / 20.0
                    * (1.0 + x / 42.0 * (1.0 + x / 72.0 * (1.0 + x / 110.0 * (1.0 + x / 156.0)))));
    (c, s * k)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASES: [Square; 6] = [
        [[0.0, 1.0], [0.0, 0.0]],
        [[0.0, 1.0], [-4.0, -0.2]],
        [[0.0, 1.0], [-1.0, -2.0]],
        [[0.0, 1.0], [-1.0, -7.0]],
        [[-0.3, 2.0], [-2.0, -0.3]],
        [[-0.5, 0.0], [0.0, -3.0]],
    ];

    #[test]
    fn exponentials_are_those_of_the_series() {
        for matrix in CASES {
            let block = Block::new(matrix);
            for s in [1e-3, 0.11, 0.8, 2.5] {
                let a =
                    nalgebra::Matrix2::new(matrix[0][0], matrix[0][1], matrix[1][0], matrix[1][1]);
                let exact = (a * s).exp();
                let found = block.exponential(s);
                for i in 0..2 {
                    for j in 0..2 {
                        assert!(
                            (found[i][j] - exact[(i, j)]).abs() < 1e-13,
                            "{matrix:?} {s}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn responses_from_rest_are_steady_ones_less_what_dies() {
        for matrix in &CASES[1..] {
            let block = Block::new(*matrix);
            let input = [Complex::new(0.2, 0.5), Complex::new(1.0, -0.3)];
            let (frequency, s) = (1.3, 2.1);
            let [steady, _] = block.steady(frequency, input).unwrap();
            let [p, r, p_by, r_by] = block.response_at_rest(frequency, s);
            let d = block.deviation;
            let e = block.exponential(s);
            let turn = Complex::new(0.0, frequency * s).exp();
            for i in 0..2 {
                let response = p * input[i] + r * (input[0] * d[i][0] + input[1] * d[i][1]);
                let expected = turn * steady[i] - (steady[0] * e[i][0] + steady[1] * e[i][1]);
                assert!((response - expected).norm() < 1e-13);
            }
            let h = 1e-5;
            let [p1, r1, ..] = block.response_at_rest(frequency + h, s);
            let [p0, r0, ..] = block.response_at_rest(frequency - h, s);
            assert!(((p1 - p0) / (2.0 * h) - p_by).norm() < 1e-8);
            assert!(((r1 - r0) / (2.0 * h) - r_by).norm() < 1e-8);
        }
    }

    /// Under a constant load, where both exponents do little: rules of Gauss tell the same.
    #[test]
    fn responses_by_series_are_those_by_rules() {
        let none = [[0.0, 1.0], [0.0, -1e-9]];
        for matrix in CASES.iter().chain([&none]) {
            let block = Block::new(*matrix);
            for part in [1.0, 0.4, 1e-3] {
                let s = part / block.rate().max(1e-3);
                let [r, by] = block.by_series(s);
                let [exact, exact_by] = block.by_rule(0.0, s);
                assert!((r - exact).norm() <= 1e-15 * exact.norm(), "{matrix:?} {s}");
                assert!((by - exact_by).norm() <= 1e-15 * exact_by.norm());
            }
            assert_eq!(block.by_series(0.0)[0].re, 0.0);
        }
    }

    #[test]
    fn responses_of_far_exponents_are_those_of_each() {
        // x'' + c x' + k x = e^(i w t) with c^2 far above k: exponents -c and -k / c to first order.
        for (c, k) in [(20.0, 1.0), (1e3, 0.3), (1e6, 1.0), (1e9, 1e-3), (1e3, 0.0)] {
            let block = Block::new([[0.0, 1.0], [-k, -c]]);
            let [near, far] = block.real_exponents().unwrap();
            assert!((near * near + c * near + k).abs() <= 1e-14 * k.max(f64::MIN_POSITIVE));
            assert!((near + far + c).abs() <= 1e-15 * c);
            let input = [Complex::new(0.0, 0.0), Complex::new(1.0, 0.0)];
            for frequency in [1e-3, 1.3, 40.0] {
                let [steady, _] = block.steady(frequency, input).unwrap();
                let exact = 1.0 / Complex::new(k - frequency * frequency, c * frequency);
                assert!((steady[0] - exact).norm() <= 1e-14 * exact.norm());
                let s = 2.1;
                let [p, r, ..] = block.response_at_rest(frequency, s);
                let d = block.deviation;
                let found = r * d[0][1] + p * input[0];
                let decays = [near, far].map(|e| {
                    let turn = Complex::new(0.0, frequency * s).exp();
                    (turn - (e * s).exp()) / Complex::new(-e, frequency)
                });
                let expected = (decays[0] - decays[1]) / (near - far);
                assert!(
                    (found - expected).norm() <= 1e-10 * expected.norm(),
                    "{c} {k} {frequency}: {found} {expected}"
                );
            }
            // Under a constant load: integrals of both exponentials.
            let s = 2.1;
            let [_, r, ..] = block.response_at_rest(0.0, s);
            let integral = |e: f64| if e == 0.0 { s } else { (e * s).exp_m1() / e };
            let exact = (integral(near) - integral(far)) / (near - far);
            assert!((r.re - exact).abs() <= 1e-13 * exact, "{c} {k}");
        }
    }

    #[test]
    fn responses_of_slow_decays_are_known_to_rounding() {
        // x'' + c x' = 1 from rest: x' = (1 - e^(-c s)) / c, x = (s - x') / c.
        for c in [1e-9, 1e-6, 1e-3, 0.1, 3.0, 200.0] {
            let block = Block::new([[0.0, 1.0], [0.0, -c]]);
            let d = block.deviation;
            for s in [1e-5, 1e-2, 0.7, 6.0] {
                let [p, r, ..] = block.response_at_rest(0.0, s);
                let rate = p + r * d[1][1];
                let exact = -(-c * s).exp_m1() / c;
                assert!((rate.re / exact - 1.0).abs() < 1e-13, "{c} {s}");
                if c * s < 1e-2 {
                    let z = c * s;
                    let exact = 0.5
                        * s
                        * s
                        * (1.0 - z / 3.0 + z * z / 12.0 - z.powi(3) / 60.0 + z.powi(4) / 360.0);
                    assert!((r.re * d[0][1] / exact - 1.0).abs() < 1e-11, "{c} {s}");
                }
            }
        }
    }

    #[test]
    fn a_free_mass_under_a_constant_load_moves_on_a_parabola() {
        let block = Block::new(CASES[0]);
        let [p, r, p_by, r_by] = block.response_at_rest(0.0, 3.0);
        assert!((p.re - 3.0).abs() < 1e-14 && (r.re - 4.5).abs() < 1e-14);
        // By the rule for all others.
        let [_, _, p_near, r_near] = block.response_at_rest(1e-9, 3.0);
        assert!((p_by - p_near).norm() < 1e-7 && (r_by - r_near).norm() < 1e-7);
    }
}
