//! What continuation knows of the equations it follows.

use crate::jacobian::{Jacobian, Partition};

/// `n` equations in `n` unknowns and one parameter.
///
/// The parameter is the last entry of the *extended* unknowns `u`, of length `n + 1`.
pub trait Problem {
    /// `n`
    fn unknowns(&self) -> usize;

    /// Which unknowns the Jacobian couples densely, and which by groups.
    fn partition(&self) -> Partition {
        Partition::dense(self.unknowns())
    }

    /// Writes the residual, and if asked for its derivatives by all `n + 1` extended unknowns into the Jacobian, which is
    /// clear. Residuals of unknowns that are in no part of the [`Partition`] are zero.
    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>);

    /// Writes the derivative of the residual in a direction of the extended unknowns, nothing left out. Only called where the
    /// [`Partition`] has a tail.
    fn apply(&mut self, u: &[f64], direction: &[f64], derivative: &mut [f64]) {
        let _ = (u, direction);
        derivative.fill(f64::NAN);
    }

    /// Writes the weights `w` of the norm `|u|^2 = sum w_i u_i^2` over the `n` unknowns: a mean square that does not
    /// change when unknowns are added that are zero.
    fn weights(&self, weights: &mut [f64]);

    /// Whether an unknown is the mean of a coordinate, which is measured apart from what oscillates about it.
    fn is_mean(&self, unknown: usize) -> bool;

    /// About how many multiplications all evaluations so far have taken, for a search whose work is limited.
    fn operations(&self) -> u64 {
        0
    }
}

/// The lengths that count as one.
///
/// A large mean, as under a heavy load, must not hide the oscillation from the step control; so it has a scale of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// For what oscillates.
    pub oscillation: f64,
    /// For means.
    pub mean: f64,
    /// For the parameter.
    pub parameter: f64,
}

impl Scale {
    /// Everything counts as it is.
    pub const UNIT: Self = Self {
        oscillation: 1.0,
        mean: 1.0,
        parameter: 1.0,
    };
}

/// The norm of a problem's extended vectors, in units of a [`Scale`].
#[derive(Debug, Clone)]
pub struct Norm {
    weights: Vec<f64>,
    means: Vec<bool>,
}

impl Norm {
    /// Of this problem.
    pub fn of(problem: &impl Problem) -> Self {
        let n = problem.unknowns();
        let mut weights = vec![0.0; n];
        problem.weights(&mut weights);
        Self {
            weights,
            means: (0..n).map(|unknown| problem.is_mean(unknown)).collect(),
        }
    }

    /// Number of unknowns, without the parameter.
    pub fn unknowns(&self) -> usize {
        self.weights.len()
    }

    /// What counts as one for an extended unknown.
    pub fn unit(&self, scale: Scale, unknown: usize) -> f64 {
        match self.means.get(unknown) {
            None => scale.parameter,
            Some(true) => scale.mean,
            Some(false) => scale.oscillation,
        }
    }

    /// Weighted product of two extended vectors.
    pub fn product(&self, scale: Scale, a: &[f64], b: &[f64]) -> f64 {
        let n = self.unknowns();
        let mut sums = [0.0, 0.0];
        for i in 0..n {
            sums[usize::from(self.means[i])] += self.weights[i] * a[i] * b[i];
        }
        let square = |x: f64| x * x;
        sums[0] / square(scale.oscillation)
            + sums[1] / square(scale.mean)
            + a[n] * b[n] / square(scale.parameter)
    }

    /// Weighted length of an extended vector.
    pub fn length(&self, scale: Scale, v: &[f64]) -> f64 {
        self.product(scale, v, v).sqrt()
    }

    /// Writes the product with a vector as a linear form.
    pub fn linear_form(&self, scale: Scale, vector: &[f64], form: &mut [f64]) {
        let n = self.unknowns();
        for i in 0..n {
            let unit = self.unit(scale, i);
            form[i] = self.weights[i] * vector[i] / (unit * unit);
        }
        form[n] = vector[n] / (scale.parameter * scale.parameter);
    }

    /// The scale at an orbit: the size of its oscillation and of its mean, neither below a hundredth of the largest so far,
    /// which is kept in `largest`. A branch that passes through rest is then not followed in ever smaller steps.
    pub fn scale_at(&self, u: &[f64], parameter: f64, largest: &mut [f64; 2]) -> Scale {
        let mut squares = [0.0, 0.0];
        for (i, weight) in self.weights.iter().enumerate() {
            squares[usize::from(self.means[i])] += weight * u[i] * u[i];
        }
        for (largest, square) in largest.iter_mut().zip(squares) {
            *largest = largest.max(square.sqrt());
        }
        let size = |kind: usize| squares[kind].sqrt().max(0.01 * largest[kind]);
        let usable = |x: f64, otherwise: f64| {
            if x > 0.0 && x.is_finite() {
                x
            } else {
                otherwise
            }
        };
        let oscillation = usable(size(0), usable(size(1), 1.0));
        Scale {
            oscillation,
            mean: usable(size(1).max(oscillation), 1.0),
            parameter,
        }
    }
}
