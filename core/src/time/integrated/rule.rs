//! Gauss-Legendre collocation on `[0, 1]`, and what is read off the values at its nodes.
//!
//! With the Lagrange polynomials `l_k` of the nodes `u_j`, and shifted Legendre polynomials `P_n`,
//!
//! ```text
//! A_jk = int_0^(u_j) l_k = b_k ( u_j + sum_(n=1)^(S-1) P_n(u_k) (P_(n+1)(u_j) - P_(n-1)(u_j)) / 2 )            (1)
//! c_n  = (2 n + 1) sum_k b_k P_n(u_k) f(u_k)                                                                 (2)
//! ```
//!
//! (2) are the Legendre coefficients of the polynomial through the values; the highest tell how well it resolves them.
//!
//! Source: Hairer, Lubich and Wanner (2006), Geometric Numerical Integration, section II.1.4; Farouki and Rajan (1987), On
//! the numerical condition of polynomials in Bernstein form.

use nalgebra::DMatrix;

use crate::numeric::fourier::gauss;

/// How many of the highest Legendre coefficients are looked at.
pub(super) const HIGHEST: usize = 4;

/// The rule of `S` nodes. Matrices are stored by columns: `[k][j]` belongs to the value at node `k` and the result at `j`.
#[derive(Debug)]
pub(crate) struct Rule<const S: usize> {
    pub(crate) nodes: [f64; S],
    pub(crate) weights: [f64; S],
    /// Integrals from the start to a node, (1).
    pub(super) before: [[f64; S]; S],
    /// Integrals from a node to the end.
    pub(super) after: [[f64; S]; S],
    /// Weights of the coefficients (2) of the highest degrees, `S - 1` first.
    pub(super) highest: [[f64; S]; HIGHEST],
    /// Legendre polynomials at the nodes.
    legendre: [Vec<f64>; S],
    /// Both ends and the nodes between them.
    pub(super) points: Vec<f64>,
    /// Weights of barycentric interpolation on them.
    pub(super) barycentric: Vec<f64>,
    /// From values at the points to Bernstein coefficients: one column for each point.
    bernstein: Vec<f64>,
}

impl<const S: usize> Rule<S> {
    pub(crate) fn new() -> Self {
        let gauss = gauss::rule(S);
        let nodes: [f64; S] = std::array::from_fn(|j| gauss.nodes[j]);
        let weights: [f64; S] = std::array::from_fn(|j| gauss.weights[j]);
        let legendre = nodes.map(polynomials::<S>);
        let mut before = [[0.0; S]; S];
        for k in 0..S {
            for j in 0..S {
                let sum: f64 = (1..S)
                    .map(|n| legendre[k][n] * (legendre[j][n + 1] - legendre[j][n - 1]))
                    .sum();
                before[k][j] = weights[k] * (nodes[j] + 0.5 * sum);
            }
        }
        let mut after = [[0.0; S]; S];
        for k in 0..S {
            for j in 0..S {
                after[k][j] = before[S - 1 - k][S - 1 - j];
            }
        }
        let highest = std::array::from_fn(|below| {
            let n = S - 1 - below;
            std::array::from_fn(|k| (2 * n + 1) as f64 * weights[k] * legendre[k][n])
        });
        let points: Vec<f64> = [0.0].into_iter().chain(nodes).chain([1.0]).collect();
        Self {
            nodes,
            weights,
            before,
            after,
            highest,
            barycentric: barycentric(&points),
            bernstein: bernstein(&points),
            legendre,
            points,
        }
    }

    /// Bernstein coefficients, on `[0, 1]`, of the polynomial with these values at the points, raised by a number.
    pub(super) fn in_bernstein_form(&self, values: &[f64], raise: f64, coefficients: &mut [f64]) {
        coefficients.fill(raise);
        let columns = self.bernstein.chunks_exact(values.len());
        for (column, value) in columns.zip(values) {
            for (coefficient, weight) in coefficients.iter_mut().zip(column) {
                *coefficient += weight * value;
            }
        }
    }

    /// The size of the first Legendre coefficient that is left out, from the last four that are known.
    pub(crate) fn tail(&self, values: &[f64; S]) -> f64 {
        tail(&self.highest, values)
    }

    /// Weights with which values at the points give the value at `u`.
    pub(super) fn interpolation(&self, u: f64, weights: &mut [f64]) {
        if let Some(hit) = self.points.iter().position(|&point| point == u) {
            weights.fill(0.0);
            weights[hit] = 1.0;
            return;
        }
        let mut sum = 0.0;
        for ((weight, point), b) in weights.iter_mut().zip(&self.points).zip(&self.barycentric) {
            *weight = b / (u - point);
            sum += *weight;
        }
        for weight in weights {
            *weight /= sum;
        }
    }
}

impl<const S: usize> Rule<S> {
    /// Lagrange's polynomials of the nodes at `u`, by the Legendre polynomials: `l_k = b_k sum_n (2 n + 1) P_n(u_k) P_n`.
    pub(super) fn lagrange(&self, u: f64, values: &mut [f64; S]) {
        let at = polynomials::<S>(u);
        for k in 0..S {
            let terms = (0..S).map(|n| (2 * n + 1) as f64 * self.legendre[k][n] * at[n]);
            values[k] = self.weights[k] * terms.sum::<f64>();
        }
    }
}

/// `P_0(u) .. P_S(u)` on `[0, 1]`; one more than an array of `S` holds.
fn polynomials<const S: usize>(u: f64) -> Vec<f64> {
    let x = 2.0 * u - 1.0;
    let mut values = vec![1.0, x];
    for n in 1..S {
        let m = n as f64;
        values.push(((2.0 * m + 1.0) * x * values[n] - m * values[n - 1]) / (m + 1.0));
    }
    values
}

/// The size of the first Legendre coefficient that is left out, from the last four that are known.
pub(super) fn tail<const S: usize>(highest: &[[f64; S]; HIGHEST], a: &[f64; S]) -> f64 {
    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|index| dot(&highest[index], a).abs());
    let (last, before) = (c0 + c1, c2 + c3);
    let ratio = if before > 0.0 {
        (last / before).sqrt().min(1.0)
    } else {
        1.0
    };
    last * ratio
}

pub(super) fn dot<const S: usize>(x: &[f64; S], y: &[f64; S]) -> f64 {
    let mut sums = [0.0; 4];
    for (x, y) in x.chunks_exact(4).zip(y.chunks_exact(4)) {
        for l in 0..4 {
            sums[l] += x[l] * y[l];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

fn barycentric(points: &[f64]) -> Vec<f64> {
    let weight = |i: usize| {
        let others = points.iter().enumerate().filter(|&(j, _)| j != i);
        // Factors of four keep the product near one.
        1.0 / others.fold(1.0, |product, (_, x)| product * 4.0 * (points[i] - x))
    };
    (0..points.len()).map(weight).collect()
}

/// The inverse of the values of the Bernstein polynomials at the points, by columns.
fn bernstein(points: &[f64]) -> Vec<f64> {
    let order = points.len();
    let degree = order - 1;
    let mut choose = vec![1.0; order];
    for i in 1..order {
        choose[i] = choose[i - 1] * (order - i) as f64 / i as f64;
    }
    let values = DMatrix::from_fn(order, order, |row, i| {
        let u = points[row];
        choose[i] * u.powi(i as i32) * (1.0 - u).powi((degree - i) as i32)
    });
    // Distinct points make it regular.
    let inverse = values
        .try_inverse()
        .unwrap_or_else(|| DMatrix::zeros(order, order));
    inverse.as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_integrated_from_either_end() {
        let rule = Rule::<12>::new();
        for degree in 0..12 {
            for j in 0..12 {
                let integral = |matrix: &[[f64; 12]; 12]| -> f64 {
                    (0..12)
                        .map(|k| matrix[k][j] * rule.nodes[k].powi(degree))
                        .sum()
                };
                let exact = rule.nodes[j].powi(degree + 1) / f64::from(degree + 1);
                assert!((integral(&rule.before) - exact).abs() < 4e-16);
                let rest = 1.0 / f64::from(degree + 1) - exact;
                assert!((integral(&rule.after) - rest).abs() < 4e-16);
            }
        }
    }

    #[test]
    fn bernstein_coefficients_of_a_power_are_quotients_of_binomials() {
        let rule = Rule::<16>::new();
        let order = rule.points.len();
        // u^2 = sum_i (i choose 2) / (n choose 2) B_i, n = order - 1.
        let n = (order - 1) as f64;
        let values: Vec<f64> = rule.points.iter().map(|u| u * u).collect();
        let mut coefficients = vec![0.0; order];
        rule.in_bernstein_form(&values, 0.0, &mut coefficients);
        for (i, coefficient) in coefficients.iter().enumerate() {
            let exact = (i * i.saturating_sub(1)) as f64 / (n * (n - 1.0));
            assert!(
                (coefficient - exact).abs() < 1e-9,
                "{i} {coefficient} {exact}"
            );
        }
    }

    #[test]
    fn polynomials_are_interpolated_and_read_off() {
        let rule = Rule::<8>::new();
        let mut weights = [0.0; 10];
        for u in [0.0, 0.1, 0.77, 1.0, rule.nodes[3], 1.05] {
            rule.interpolation(u, &mut weights);
            let points = rule.points.iter().zip(weights);
            let value: f64 = points.map(|(x, w)| w * x.powi(9)).sum();
            assert!((value - u.powi(9)).abs() < 1e-13);
        }
        // The polynomial of degree seven with leading coefficient one: 1 / (14 choose 7) of P_7.
        let leading: f64 = (0..8)
            .map(|k| rule.highest[0][k] * rule.nodes[k].powi(7))
            .sum();
        assert!((leading * 3432.0 - 1.0).abs() < 1e-11);
    }
}
