//! What continuation knows of the equations it follows.

use crate::linear::Matrix;

/// `n` equations in `n` unknowns and one parameter.
///
/// The parameter is the last entry of the *extended* unknowns `u`, of length `n + 1`.
pub trait Problem {
    /// `n`
    fn unknowns(&self) -> usize;

    /// Writes the residual, and if asked for its derivatives by all `n + 1` extended unknowns into the first `n` rows of
    /// the matrix, which is of order `n + 1`.
    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Matrix>);

    /// Writes the weights `w` of the norm `|u|^2 = sum w_i u_i^2` over the `n` unknowns: a mean square that does not
    /// change when unknowns are added that are zero.
    fn weights(&self, weights: &mut [f64]);
}

/// The lengths that count as one, for the unknowns and for the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// For the norm of the unknowns.
    pub state: f64,
    /// For the parameter.
    pub parameter: f64,
}

impl Scale {
    /// Weighted norm of an extended vector in units of this scale.
    pub fn norm(&self, weights: &[f64], v: &[f64]) -> f64 {
        self.product(weights, v, v).sqrt()
    }

    /// Weighted product of two extended vectors in units of this scale.
    pub fn product(&self, weights: &[f64], a: &[f64], b: &[f64]) -> f64 {
        let n = weights.len();
        let state: f64 = (0..n).map(|i| weights[i] * a[i] * b[i]).sum();
        state / (self.state * self.state) + a[n] * b[n] / (self.parameter * self.parameter)
    }
}
