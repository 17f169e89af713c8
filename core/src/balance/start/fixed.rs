//! One balance at a fixed value of the variable.

use super::StartRequest;
use super::effort::Effort;
use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::newton::{Border, Newton, NewtonError, NewtonOptions};
use crate::continuation::problem::Problem;

/// Size of a solution, in parts of where the search for it began, below which it is sought again on its own scale.
const SMALLER: f64 = 1e-3;
/// Searches on ever smaller scales, at most.
const SCALES: usize = 3;

/// One balance at a fixed value of the variable.
pub(super) struct Fixed<'a> {
    pub(super) balance: Balance<'a>,
    pub(super) newton: Newton,
    border: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) value: f64,
}

impl<'a> Fixed<'a> {
    pub(super) fn new(request: StartRequest<'a>, harmonics: usize) -> Self {
        // Without its harmonics a symmetric orbit has no unknowns; at rest there is but the mean.
        let resolution = Resolution {
            harmonics,
            parity: if harmonics > 0 {
                request.resolution.parity
            } else {
                Parity::All
            },
            ..request.resolution
        };
        let balance = Balance::new(
            request.system,
            request.parameters,
            request.omega,
            request.variable,
            resolution,
        )
        .until(request.cancel);
        let n = balance.unknowns();
        let mut border = vec![0.0; n + 1];
        border[n] = 1.0;
        Self {
            newton: Newton::new(&balance),
            balance,
            border,
            residual: vec![0.0; n],
            value: request.value,
        }
    }

    /// An extended vector of zeros at the value.
    pub(super) fn zeros(&self) -> Vec<f64> {
        let mut u = vec![0.0; self.border.len()];
        u[self.border.len() - 1] = self.value;
        u
    }

    /// Size of the residual, which is kept; not a number once the search is cancelled.
    pub(super) fn residual(&mut self, u: &[f64], effort: &mut Effort) -> f64 {
        if self.balance.is_cancelled() {
            return f64::NAN;
        }
        let size = self
            .newton
            .size_of_residual(&mut self.balance, u, &mut self.residual);
        effort.take(&mut self.newton);
        size
    }

    /// Whether the residual at `u` says anything: whether rounding of the terms that it is summed from is smaller than their sum is
    /// large elsewhere. Far away, where terms of a high power cancel, the residual may be zero and mean nothing.
    pub(super) fn is_known(&mut self, u: &[f64], elsewhere: f64, effort: &mut Effort) -> bool {
        let n = self.residual.len();
        let before = self.balance.operations();
        let known = self.balance.terms(u, &mut self.residual);
        effort.take_operations(self.balance.operations() - before);
        let largest = self.residual[..n].iter().copied().fold(0.0, f64::max);
        !known || f64::EPSILON * largest <= elsewhere
    }

    /// Newton's method at the fixed value.
    pub(super) fn solve(
        &mut self,
        u: &mut [f64],
        options: NewtonOptions,
        effort: &mut Effort,
    ) -> Result<(), NewtonError> {
        let last = u.len() - 1;
        let parameter = if self.value == 0.0 {
            1.0
        } else {
            self.value.abs()
        };
        let border = Border {
            row: &self.border,
            value: self.value,
        };
        let mut scale = self.newton.norm().scale_at(u, parameter, &mut [0.0; 2]);
        if u[..last].iter().all(|x| *x == 0.0) {
            // What rests at zero has no size: the linear response has one.
            let response = self
                .newton
                .linear_response(&mut self.balance, u, border, scale);
            scale = response.unwrap_or(scale);
        }
        let mut done = Ok(());
        for _ in 0..SCALES {
            done = self
                .newton
                .correct(&mut self.balance, u, border, scale, options)
                .map(|_| ());
            let found = self.newton.norm().scale_at(u, parameter, &mut [0.0; 2]);
            if done.is_err() || found.oscillation > SMALLER * scale.oscillation {
                break;
            }
            scale = found;
        }
        u[last] = self.value;
        let done = done.and_then(|()| self.newton.is_told_from_rounding(&mut self.balance, u));
        effort.take(&mut self.newton);
        done
    }
}

/// An orbit of fewer harmonics as unknowns of another balance of the same period.
pub(super) fn spread(u: &[f64], to: &Fixed<'_>) -> Vec<f64> {
    let mut result = to.zeros();
    let coordinates = to.balance.layout().coordinates;
    let (from, length) = ((u.len() - 1) / coordinates, to.balance.length());
    let shared = from.min(length);
    for i in 0..coordinates {
        result[i * length..][..shared].copy_from_slice(&u[i * from..][..shared]);
    }
    to.balance.partition().clear_others(&mut result);
    result
}

/// Sum of squares of all but the means.
pub(super) fn oscillation(u: &[f64], length: usize) -> f64 {
    let n = u.len() - 1;
    u[..n]
        .iter()
        .enumerate()
        .filter(|(i, _)| i % length != 0)
        .map(|(_, x)| x * x)
        .sum()
}

/// Amplitudes from tiny to huge, eight a decade.
pub(super) fn geometric() -> impl Iterator<Item = f64> {
    (-96..=96).map(|i| 10_f64.powf(f64::from(i) / 8.0))
}
