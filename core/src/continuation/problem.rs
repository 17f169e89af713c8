//! What continuation knows of the equations it follows.

use crate::continuation::jacobian::{Jacobian, Partition};
use crate::numeric::linear::weighted_dot;

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

    /// Writes the size of the terms that each residual is summed from, to which its rounding is relative. Returns whether that is known.
    fn terms(&mut self, u: &[f64], terms: &mut [f64]) -> bool {
        let _ = (u, terms);
        false
    }

    /// Writes the weights `w` of the norm `|u|^2 = sum w_i u_i^2` over the `n` unknowns: a mean square that does not
    /// change when unknowns are added that are zero.
    fn weights(&self, weights: &mut [f64]);

    /// Whether an unknown is the mean of a coordinate, which is measured apart from what oscillates about it.
    fn is_mean(&self, unknown: usize) -> bool;

    /// Changes unknowns from which Newton's method begins, where others tell them better than a prediction along the curve does.
    fn prepare(&mut self, u: &mut [f64]) {
        let _ = u;
    }

    /// Is told a solution that Newton's method has found.
    fn found(&mut self, u: &[f64]) {
        let _ = u;
    }

    /// Whether the work with it is to end, which every iteration of Newton's method asks.
    fn is_cancelled(&self) -> bool {
        false
    }

    /// About how many multiplications all evaluations so far have taken, for a search whose work is limited.
    fn operations(&self) -> u64 {
        0
    }
}

/// A problem, or a trait object of what a room adds to one: searches along a curve hand it to the test function they look at.
pub(crate) trait AsProblem {
    /// The equations alone.
    fn problem(&mut self) -> &mut dyn Problem;
}

impl<P: Problem> AsProblem for P {
    fn problem(&mut self) -> &mut dyn Problem {
        self
    }
}

impl AsProblem for dyn Problem + '_ {
    fn problem(&mut self) -> &mut dyn Problem {
        self
    }
}

/// The lengths that count as one.
///
/// A large mean, as under a heavy load, must not hide the oscillation from the step control; so it has a scale of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Scale {
    /// For what oscillates.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub oscillation: f64,
    /// For means.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub mean: f64,
    /// For the parameter.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
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
    /// The weights of what oscillates, zero for means.
    oscillation: Vec<f64>,
    /// Which unknowns are means.
    means: Vec<usize>,
}

impl Norm {
    /// Of this problem.
    pub fn of(problem: &dyn Problem) -> Self {
        let n = problem.unknowns();
        let mut weights = vec![0.0; n];
        problem.weights(&mut weights);
        let means: Vec<usize> = (0..n).filter(|&unknown| problem.is_mean(unknown)).collect();
        let mut oscillation = weights.clone();
        for &mean in &means {
            oscillation[mean] = 0.0;
        }
        Self {
            weights,
            oscillation,
            means,
        }
    }

    /// Number of unknowns, without the parameter.
    pub fn unknowns(&self) -> usize {
        self.weights.len()
    }

    /// What counts as one for an extended unknown.
    pub fn unit(&self, scale: Scale, unknown: usize) -> f64 {
        if unknown == self.unknowns() {
            scale.parameter
        } else if self.means.contains(&unknown) {
            scale.mean
        } else {
            scale.oscillation
        }
    }

    /// Writes what counts as one for each extended unknown.
    pub fn write_units(&self, scale: Scale, units: &mut [f64]) {
        units.fill(scale.oscillation);
        for &mean in &self.means {
            units[mean] = scale.mean;
        }
        units[self.unknowns()] = scale.parameter;
    }

    /// Weighted products of two extended vectors without the parameter: of what oscillates, and of means.
    fn products(&self, a: &[f64], b: &[f64]) -> [f64; 2] {
        let means = self.means.iter().map(|&i| self.weights[i] * a[i] * b[i]);
        [weighted_dot(&self.oscillation, a, b), means.sum()]
    }

    /// Weighted product of two extended vectors.
    pub fn product(&self, scale: Scale, a: &[f64], b: &[f64]) -> f64 {
        let n = self.unknowns();
        let [oscillation, means] = self.products(a, b);
        let square = |x: f64| x * x;
        oscillation / square(scale.oscillation)
            + means / square(scale.mean)
            + a[n] * b[n] / square(scale.parameter)
    }

    /// Weighted length of an extended vector.
    pub fn length(&self, scale: Scale, v: &[f64]) -> f64 {
        self.product(scale, v, v).sqrt()
    }

    /// Writes the product with a vector as a linear form.
    pub fn linear_form(&self, scale: Scale, vector: &[f64], form: &mut [f64]) {
        let n = self.unknowns();
        let square = |x: f64| x * x;
        for i in 0..n {
            form[i] = self.weights[i] * vector[i] / square(scale.oscillation);
        }
        for &i in &self.means {
            form[i] = self.weights[i] * vector[i] / square(scale.mean);
        }
        form[n] = vector[n] / (scale.parameter * scale.parameter);
    }

    /// The scale at an orbit of its own size alone, if it has one.
    pub fn size_at(&self, u: &[f64], parameter: f64) -> Option<Scale> {
        let size = self.products(u, u).into_iter().sum::<f64>();
        let is_known = size > 0.0 && size.is_finite();
        is_known.then(|| self.scale_at(u, parameter, &mut [0.0; 2]))
    }

    /// The scale at an orbit: the size of its oscillation and of its mean, neither below a hundredth of the largest so far,
    /// which is kept in `largest`. A branch that passes through rest is then not followed in ever smaller steps.
    pub fn scale_at(&self, u: &[f64], parameter: f64, largest: &mut [f64; 2]) -> Scale {
        let squares = self.products(u, u);
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
