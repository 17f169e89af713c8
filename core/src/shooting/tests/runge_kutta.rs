//! The flow of a smooth oscillator by steps of Runge and Kutta: slow, and easy to believe.

use std::f64::consts::TAU;

use crate::cancel::Cancel;
use crate::system::Variable;
use crate::time::{Flow, FlowError, See, Stretch, Tangent, Work};

/// The classical method of Runge and Kutta with steps of equal phase.
pub(super) struct RungeKutta {
    /// zeta, cubic, drive, load
    pub(super) parameters: [f64; 4],
    pub(super) omega: f64,
    pub(super) steps: usize,
    pub(super) work: Work,
}

struct Step {
    phases: (f64, f64),
    /// State at both ends, and acceleration.
    ends: [[f64; 3]; 2],
    time: f64,
}

impl Stretch for Step {
    fn phases(&self) -> (f64, f64) {
        self.phases
    }

    /// The quintic through positions, velocities and accelerations.
    fn state(&self, phase: f64, state: &mut [f64]) {
        let (from, to) = self.phases;
        let (s, h) = ((phase - from) / (to - from), self.time);
        let [[x0, v0, a0], [x1, v1, a1]] = self.ends;
        let d = x1 - x0 - h * v0 - 0.5 * h * h * a0;
        let e = h * (v1 - v0 - h * a0);
        let f = h * h * (a1 - a0);
        let c3 = 10.0 * d - 4.0 * e + 0.5 * f;
        let c4 = -15.0 * d + 7.0 * e - f;
        let c5 = 6.0 * d - 3.0 * e + 0.5 * f;
        state[0] = x0 + s * (h * v0 + s * (0.5 * h * h * a0 + s * (c3 + s * (c4 + s * c5))));
        state[1] = v0 + s * (h * a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)) / h);
    }
}

impl RungeKutta {
    fn acceleration(&self, phase: f64, [x, v]: [f64; 2]) -> f64 {
        let [zeta, cubic, drive, load] = self.parameters;
        drive * phase.cos() + load - 2.0 * zeta * v - x - cubic * x * x * x
    }

    /// Derivatives by time of the state and of one tangent.
    fn slope(&self, phase: f64, y: [f64; 4], by: Option<Variable>) -> [f64; 4] {
        let [x, v, dx, dv] = y;
        let [zeta, cubic, ..] = self.parameters;
        let explicit = match by {
            Some(Variable::Parameter(0)) => -2.0 * v,
            Some(Variable::Parameter(1)) => -x * x * x,
            Some(Variable::Parameter(2)) => phase.cos(),
            Some(Variable::Parameter(_)) => 1.0,
            Some(Variable::Omega) | None => 0.0,
        };
        let stiffness = 1.0 + 3.0 * cubic * x * x;
        let acceleration = self.acceleration(phase, [x, v]);
        [
            v,
            acceleration,
            dv,
            explicit - 2.0 * zeta * dv - stiffness * dx,
        ]
    }

    /// One step in phase, of the state and of one tangent. With `y' = f / omega` by phase, the derivative by omega has
    /// `- f / omega^2` more.
    fn step(&self, phase: f64, h: f64, y: [f64; 4], by: Option<Variable>) -> [f64; 4] {
        let slope = |phase: f64, y: [f64; 4]| {
            let mut f = self.slope(phase, y, by).map(|x| x / self.omega);
            if by == Some(Variable::Omega) {
                f[2] -= f[0] / self.omega;
                f[3] -= f[1] / self.omega;
            }
            f
        };
        let plus = |a: f64, k: [f64; 4]| std::array::from_fn(|i| y[i] + a * k[i]);
        let k1 = slope(phase, y);
        let k2 = slope(phase + 0.5 * h, plus(0.5 * h, k1));
        let k3 = slope(phase + 0.5 * h, plus(0.5 * h, k2));
        let k4 = slope(phase + h, plus(h, k3));
        std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }
}

impl Flow for RungeKutta {
    fn coordinates(&self) -> usize {
        1
    }

    fn admits(&self, _: Variable, value: f64) -> bool {
        value.is_finite()
    }

    fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        match variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.parameters[index] = value,
        }
        Ok(())
    }

    fn until(&mut self, _: &Cancel) {}

    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        mut tangent: Option<&mut Tangent>,
        mut see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let steps = ((to - from) / TAU * self.steps as f64).ceil().max(1.0);
        let h = (to - from) / steps;
        for step in 0..steps as usize {
            let phase = from + h * step as f64;
            let start = [state[0], state[1]];
            if let Some(Tangent { columns, by }) = tangent.as_deref_mut() {
                let homogeneous = columns.len() / 2 - by.len();
                for (index, column) in columns.chunks_exact_mut(2).enumerate() {
                    let by = index.checked_sub(homogeneous).map(|index| by[index]);
                    let y = [start[0], start[1], column[0], column[1]];
                    let y = self.step(phase, h, y, by);
                    column.copy_from_slice(&y[2..]);
                }
            }
            let y = self.step(phase, h, [start[0], start[1], 0.0, 0.0], None);
            state.copy_from_slice(&y[..2]);
            self.work.steps += 1;
            if !(y[0] + y[1]).is_finite() {
                return Err(FlowError::NotFinite { phase });
            }
            if let Some(see) = &mut see {
                let end = [y[0], y[1]];
                let with = |p: f64, s: [f64; 2]| [s[0], s[1], self.acceleration(p, s)];
                see(&Step {
                    phases: (phase, phase + h),
                    ends: [with(phase, start), with(phase + h, end)],
                    time: h / self.omega,
                });
            }
        }
        Ok(())
    }

    fn work(&self) -> Work {
        self.work
    }
}
