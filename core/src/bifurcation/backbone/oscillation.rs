//! The equations of free oscillation, and where to begin.

use std::f64::consts::PI;

use crate::bifurcation::error::BifurcationError;
use crate::branches::observed::{Motion, Observed};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::recurrence::SignedPermutation;
use crate::branches::stability::Stability;
use crate::cancel::Cancel;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::shooting::extremes;
use crate::system::Variable;
use crate::time::{Flow, FlowError, MotionError, Stretch, Tangent};

/// Times in which the first moment of rest is looked for, and how many.
const STEP: f64 = 0.02;
const STEPS: usize = 5000;
/// Where there is none they grow, and then shrink until the moment stays, so many times at most.
const COARSER: f64 = 100.0;
const FINER: f64 = 5.0;
const SCALES: usize = 12;
/// Part of the time that it stays to.
const SAME: f64 = 0.01;

/// When a motion from rest is at rest again.
enum Rest {
    /// After this time.
    At(f64),
    /// Not within the time that was looked at.
    Later,
    /// It begins where nothing moves.
    Always,
}

/// The phase from which a motion is repeated, as a part of its period: neither of those about which a cosine or a sine is even or odd.
const ELSEWHERE: f64 = 0.3;

/// The equations (1) of [`free`](super::free); unknowns are the other positions and the frequency, the parameter is the position of one
/// coordinate.
pub(super) struct Equations {
    pub(super) flow: Box<dyn Flow>,
    /// The coordinate whose position is the parameter.
    varied: usize,
    /// Values of the parameters.
    parameters: Vec<f64>,
    divisor: f64,
    state: Vec<f64>,
    tangent: Tangent,
    column: Vec<f64>,
    /// What counts as one for positions and for the frequency.
    units: [f64; 2],
    cancel: Cancel,
}

impl Equations {
    pub(super) fn new(
        flow: Box<dyn Flow>,
        varied: usize,
        parameters: Vec<f64>,
        divisor: u32,
        cancel: Cancel,
    ) -> Self {
        let n = flow.coordinates();
        Self {
            state: vec![0.0; 2 * n],
            tangent: Tangent::of_state(n, Some(Variable::Omega)),
            column: vec![0.0; n],
            units: [1.0; 2],
            divisor: f64::from(divisor),
            varied,
            parameters,
            flow,
            cancel,
        }
    }

    /// Takes the sizes of the first oscillation for units.
    pub(super) fn measure(&mut self, u: &[f64]) {
        let n = self.column.len();
        let others = u[..n - 1].iter().chain([&u[n]]);
        let size = others.fold(0.0, |m: f64, q| m.max(q.abs()));
        self.units = [size, u[n - 1]].map(|unit| if unit > 0.0 { unit } else { 1.0 });
    }

    /// The time to the first moment of rest, at any scale of time: steps grow until there is one, and shrink until it stays.
    pub(super) fn half_period(&mut self, from: f64) -> Result<f64, Error> {
        let motion = |reason| MotionError {
            value: from,
            reason,
        };
        let never = BifurcationError::NeverAtRest { position: from };
        let mut step = STEP;
        let mut time = None;
        for _ in 0..SCALES {
            match self.first_rest(from, step) {
                Ok(Rest::At(found)) => {
                    time = Some(found);
                    break;
                }
                Ok(Rest::Always) => return Err(never.into()),
                Ok(Rest::Later) => step *= COARSER,
                // So many oscillations go into one step.
                Err(FlowError::TooManySwitches { .. }) => step /= COARSER,
                Err(reason) => return Err(motion(reason).into()),
            }
        }
        let mut time = time.ok_or(never.clone())?;
        for _ in 0..SCALES {
            step /= FINER;
            let again = match self.first_rest(from, step).map_err(motion)? {
                Rest::At(found) => found,
                Rest::Later | Rest::Always => time,
            };
            let same = (again - time).abs() <= SAME * again;
            time = again;
            if same && time > 10.0 * step {
                return Ok(time);
            }
        }
        Err(never.into())
    }

    /// The same, looked for in steps of this time. Each is the same part of a period of the flow, whose frequency does not matter.
    fn first_rest(&mut self, from: f64, step: f64) -> Result<Rest, FlowError> {
        let n = self.flow.coordinates();
        let mut state = vec![0.0; 2 * n];
        state[self.varied] = from;
        let (mut phase, mut before) = (0.0, 0.0);
        let omega = STEP / step;
        self.flow.set(Variable::Omega, omega)?;
        let mut moves = false;
        for _ in 0..STEPS {
            let next = phase + STEP / self.divisor;
            self.flow.advance(phase, next, &mut state, None, None)?;
            let velocity = state[n + self.varied];
            if before * velocity < 0.0 {
                let part = before / (before - velocity);
                let time = (phase + part * (next - phase)) * self.divisor / omega;
                return Ok(Rest::At(time));
            }
            moves |= state[n..].iter().any(|v| *v != 0.0);
            (phase, before) = (next, velocity);
        }
        Ok(if moves { Rest::Later } else { Rest::Always })
    }

    /// Sets `state` to rest at the positions of the unknowns, and the frequency to theirs.
    fn begin(&mut self, u: &[f64]) -> Result<(), FlowError> {
        let n = self.column.len();
        self.state.fill(0.0);
        let varied = self.varied;
        self.state[..varied].copy_from_slice(&u[..varied]);
        self.state[varied] = u[n];
        self.state[varied + 1..n].copy_from_slice(&u[varied..n - 1]);
        self.flow.set(Variable::Omega, u[n - 1])
    }

    /// The position that is varied.
    pub(super) fn position(&self, u: &[f64]) -> f64 {
        u[self.column.len()]
    }

    /// The oscillation, and how far it misses its beginning, relative to its size.
    pub(super) fn read(&mut self, u: &[f64]) -> Result<(Point, f64), FlowError> {
        let n = self.column.len();
        let half = PI / self.divisor;
        let rate = u[n - 1] / self.divisor;
        self.begin(u)?;
        let mut states = self.state.clone();
        let first = states[..n].to_vec();
        let before = self.flow.work().switches;
        // It goes back the way it came.
        let mut motions = vec![Motion::NONE; n];
        let see = &mut |stretch: &dyn Stretch| extremes::include(stretch, rate, &mut motions);
        self.flow
            .advance(0.0, half, &mut self.state, None, Some(see))?;
        states.extend_from_slice(&self.state);
        let other = self.state[..n].to_vec();
        let end = 2.0 * half;
        self.flow.advance(half, end, &mut self.state, None, None)?;
        let largest = |a: &[f64], b: &[f64]| {
            let pairs = a.iter().zip(b);
            pairs.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()))
        };
        let size = largest(&first, &other).max(f64::MIN_POSITIVE);
        let switches = self.flow.work().switches - before;
        let mut apart = largest(&first, &self.state[..n]) / size;
        // What goes back the way it came under an excitation does so from a phase about which that is even, and from no other.
        self.begin(u)?;
        let start = ELSEWHERE * end;
        self.flow
            .advance(start, start + end, &mut self.state, None, None)?;
        apart = apart.max(largest(&first, &self.state[..n]) / size);
        let parts = self.divisor as usize;
        let observed = Observed::extremes(motions, switches * parts);
        Ok((self.point(u[n - 1], states, observed), apart))
    }

    /// An orbit that is at rest in two states. In a period of the declaration there are as many oscillations as that has of the excitation.
    fn point(&self, omega: f64, states: Vec<f64>, observed: Observed) -> Point {
        let orbit = Orbit {
            series: Vec::new(),
            states,
            coordinates: self.column.len(),
            omega,
            base: omega / self.divisor,
            period: 1,
            parts: self.divisor as usize,
            symmetric: false,
            image: SignedPermutation::identity(),
        };
        Point {
            value: omega,
            parameters: self.parameters.clone(),
            orbit,
            stability: Stability::unknown(),
            observed,
            error: None,
        }
    }
}

impl Problem for Equations {
    fn unknowns(&self) -> usize {
        self.column.len()
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
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
            let others = (0..n).filter(|j| *j != self.varied);
            for (to, j) in row.iter_mut().zip(others) {
                *to = by(j, i);
            }
            row[n - 1] = by(2 * n, i);
        }
        for i in 0..n {
            self.column[i] = by(self.varied, i);
        }
        jacobian.set_column(&self.column);
    }

    fn weights(&self, weights: &mut [f64]) {
        // The frequency counts relative to itself, as positions do.
        let [size, omega] = self.units;
        weights.fill(1.0);
        weights[self.column.len() - 1] = (size / omega).powi(2);
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }
}
