//! The equations of free oscillation, and where to begin.

use std::f64::consts::PI;

use super::free::FreePoint;
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::flow::{Flow, FlowError, Tangent};
use crate::jacobian::Jacobian;
use crate::system::Variable;

/// Times in which the first moment of rest is looked for, and how many.
const STEP: f64 = 0.02;
const STEPS: usize = 5000;
/// Where there is none they grow, and then shrink until the moment stays, so many times at most.
const COARSER: f64 = 100.0;
const FINER: f64 = 5.0;
const SCALES: usize = 12;
/// Part of the time that it stays to.
const SAME: f64 = 0.01;

/// The equations (1) of [`free`](super::free); unknowns are the other positions and the frequency, the parameter is the first position.
pub(super) struct Equations<'a> {
    pub(super) flow: Box<dyn Flow + 'a>,
    divisor: f64,
    state: Vec<f64>,
    tangent: Tangent,
    column: Vec<f64>,
}

impl<'a> Equations<'a> {
    pub(super) fn new(flow: Box<dyn Flow + 'a>, divisor: f64) -> Self {
        let n = flow.coordinates();
        Self {
            state: vec![0.0; 2 * n],
            tangent: Tangent::of_state(n, Some(Variable::Omega)),
            column: vec![0.0; n],
            divisor,
            flow,
        }
    }

    /// The time to the first moment of rest, at any scale of time: steps grow until there is one, and shrink until it stays.
    pub(super) fn half_period(&mut self, from: f64) -> Result<f64, Error> {
        let mut step = STEP;
        let mut found = self.first_rest(from, step)?;
        for _ in 0..SCALES {
            if found.is_some() {
                break;
            }
            step *= COARSER;
            found = self.first_rest(from, step)?;
        }
        let never = Error::NeverAtRest { position: from };
        let mut time = found.ok_or(never.clone())?;
        for _ in 0..SCALES {
            step /= FINER;
            let again = self.first_rest(from, step)?.unwrap_or(time);
            let same = (again - time).abs() <= SAME * again;
            time = again;
            if same && time > 10.0 * step {
                return Ok(time);
            }
        }
        Err(never)
    }

    /// The same, looked for in steps of this time.
    fn first_rest(&mut self, from: f64, step: f64) -> Result<Option<f64>, Error> {
        let n = self.flow.coordinates();
        let value = from;
        let mut state = vec![0.0; 2 * n];
        state[0] = from;
        let (mut phase, mut before) = (0.0, 0.0);
        let motion = |reason| Error::Motion { value, reason };
        self.flow.set(Variable::Omega, 1.0).map_err(motion)?;
        for _ in 0..STEPS {
            let next = phase + step / self.divisor;
            let moved = self.flow.advance(phase, next, &mut state, None, None);
            moved.map_err(motion)?;
            let velocity = state[n];
            if before * velocity < 0.0 {
                let part = before / (before - velocity);
                let time = (phase + part * (next - phase)) * self.divisor;
                return Ok(Some(time));
            }
            (phase, before) = (next, velocity);
        }
        Ok(None)
    }

    /// Sets `state` to rest at the positions of the unknowns, and the frequency to theirs.
    fn begin(&mut self, u: &[f64]) -> Result<(), FlowError> {
        let n = self.column.len();
        self.state.fill(0.0);
        self.state[0] = u[n];
        self.state[1..n].copy_from_slice(&u[..n - 1]);
        self.flow.set(Variable::Omega, u[n - 1])
    }

    /// The oscillation, and how far it misses its beginning, relative to its size.
    pub(super) fn read(&mut self, u: &[f64]) -> Result<(FreePoint, f64), FlowError> {
        let n = self.column.len();
        let half = PI / self.divisor;
        self.begin(u)?;
        let first = self.state[..n].to_vec();
        self.flow.advance(0.0, half, &mut self.state, None, None)?;
        let other = self.state[..n].to_vec();
        let end = 2.0 * half;
        self.flow.advance(half, end, &mut self.state, None, None)?;
        let largest = |a: &[f64], b: &[f64]| {
            let pairs = a.iter().zip(b);
            pairs.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()))
        };
        let size = largest(&first, &other).max(f64::MIN_POSITIVE);
        let apart = largest(&first, &self.state[..n]) / size;
        let point = FreePoint {
            omega: u[n - 1],
            ends: [first, other],
        };
        Ok((point, apart))
    }
}

impl Problem for Equations<'_> {
    fn unknowns(&self) -> usize {
        self.column.len()
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let n = self.column.len();
        let begun = self.begin(u);
        self.tangent.columns.fill(0.0);
        for i in 0..2 * n {
            self.tangent.columns[i * 2 * n + i] = 1.0;
        }
        let half = PI / self.divisor;
        let tangent = jacobian.is_some().then_some(&mut self.tangent);
        // A frequency that is not positive is none.
        let moved =
            begun.and_then(|()| self.flow.advance(0.0, half, &mut self.state, tangent, None));
        if moved.is_err() {
            residual.fill(f64::NAN);
            return;
        }
        residual.copy_from_slice(&self.state[n..]);
        let Some(jacobian) = jacobian else {
            return;
        };
        let by = |column: usize, i: usize| self.tangent.columns[column * 2 * n + n + i];
        for i in 0..n {
            let row = jacobian.core_mut().row_mut(i);
            for j in 1..n {
                row[j - 1] = by(j, i);
            }
            row[n - 1] = by(2 * n, i);
        }
        for i in 0..n {
            self.column[i] = by(0, i);
        }
        jacobian.set_column(&self.column);
    }

    fn weights(&self, weights: &mut [f64]) {
        weights.fill(1.0);
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }
}
