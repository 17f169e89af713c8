//! Free oscillation of a conservative system.
//!
//! Without damping and excitation, a motion that starts at rest and is at rest again half a period later goes back the way it came
//! (the equations do not change when time is turned round). So an orbit is a position `q_0` and a frequency `omega` with
//!
//! ```text
//! v(pi / omega; q_0, 0) = 0                                                                                  (1)
//! ```
//!
//! Rest at the beginning is the phase condition. The first coordinate of `q_0` is what is varied, so that a frequency that does not
//! depend on the amplitude, or turns back, is followed as any other.
//!
//! Source: Kerschen, Peeters, Golinval and Vakakis (2009), Nonlinear normal modes, part I, Mech. Syst. Signal Process. 23, section
//! 3.2 (shooting with a phase condition); Lamb and Roberts (1998), Time-reversal symmetry in dynamical systems, Physica D 112
//! (orbits that return on their way).

use std::f64::consts::PI;

use crate::continuation::follow::{
    Continue, FollowOptions, Halt, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::problem::Problem;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::flow::{self, Flow, FlowError, Options, Tangent};
use crate::jacobian::Jacobian;
use crate::newton::{Newton, NewtonOptions};
use crate::system::{System, Variable};
use crate::validate;

/// Times in which the first moment of rest is looked for, and how many.
const STEP: f64 = 0.02;
const STEPS: usize = 5000;
/// Where there is none they grow, and then shrink until the moment stays, so many times at most.
const COARSER: f64 = 100.0;
const FINER: f64 = 5.0;
const SCALES: usize = 12;
/// Part of the time that it stays to.
const SAME: f64 = 0.01;
/// A motion that has not come back to this part of its size is not free.
const RETURNED: f64 = 1e-6;
const POINTS: usize = 5000;

/// The frequency of free oscillation over its amplitude: set up step by step, then [run](FreeOscillation::run).
///
/// ```
/// use hertzian::backbone::FreeOscillation;
///
/// hertzian::oscillator! {
///     Hertz(x) {
///         ddot(x) + sgn(x)*|x|^1.5 = 0;
///     }
/// }
///
/// let curve = FreeOscillation::of(&Hertz {}).from(0.5).to(2.0).run()?;
/// // omega = 0.95469357 a^(1/4), by a quadrature of the period.
/// let last = curve.last().unwrap();
/// assert!((last.omega - 0.95469356972851 * 2_f64.powf(0.25)).abs() < 1e-9);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Clone)]
pub struct FreeOscillation<'a> {
    system: &'a dyn System,
    from: f64,
    to: f64,
    near: Option<(Vec<f64>, f64)>,
    tolerance: f64,
}

impl std::fmt::Debug for FreeOscillation<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FreeOscillation")
            .field("system", &self.system.facts().name)
            .field("from", &self.from)
            .field("to", &self.to)
            .finish_non_exhaustive()
    }
}

/// One free oscillation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FreePoint {
    /// Its frequency.
    pub omega: f64,
    /// Positions at rest, where it begins and half a period later.
    pub ends: [Vec<f64>; 2],
}

impl FreePoint {
    /// Distance between the ends of the first coordinate.
    pub fn peak_to_peak(&self) -> f64 {
        (self.ends[0][0] - self.ends[1][0]).abs()
    }
}

impl<'a> FreeOscillation<'a> {
    /// Of this system, whose damping and excitation must be zero at the parameters it has.
    pub fn of(system: &'a dyn System) -> Self {
        Self {
            system,
            from: 1.0,
            to: 2.0,
            near: None,
            tolerance: 1e-12,
        }
    }

    /// Position of the first coordinate at rest where the curve begins.
    #[must_use]
    pub fn from(mut self, position: f64) -> Self {
        self.from = position;
        self
    }

    /// The same where it ends.
    #[must_use]
    pub fn to(mut self, position: f64) -> Self {
        self.to = position;
        self
    }

    /// The first oscillation is near these positions at rest and this frequency: needed where there are several coordinates.
    #[must_use]
    pub fn near(mut self, positions: &[f64], omega: f64) -> Self {
        self.near = Some((positions.to_vec(), omega));
        self
    }

    /// Tolerance of the flow, where it is not in closed form. Default: 1e-12.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Follows the curve from one position to the other. It ends early where it cannot be continued.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, nothing oscillates at the first position, or a motion does not come back because
    /// the system has damping or an excitation.
    pub fn run(&self) -> Result<Vec<FreePoint>, Error> {
        let facts = self.system.facts();
        let n = facts.coordinates.len();
        if n == 0 {
            return Err(Error::NoCoordinates);
        }
        for (name, value) in [("from", self.from), ("to", self.to)] {
            validate::option(name, value, -1e300..=1e300, "must be finite")?;
        }
        if self.from == self.to {
            return Err(Error::EmptyRange { value: self.from });
        }
        let mut parameters = vec![0.0; facts.parameters.len()];
        self.system.values(&mut parameters);
        validate::parameters(facts, &parameters)?;
        let options = Options {
            tolerance: self.tolerance,
        };
        let flow = flow::at(self.system, &parameters, 1.0, options)?;
        let mut equations = Equations::new(flow, f64::from(facts.divisor));
        let mut u = self.first(&mut equations)?;
        u.push(self.from);
        let options = FollowOptions {
            from: self.from,
            to: self.to,
            points: POINTS,
            steps: StepControl::default(),
            newton: NewtonOptions {
                tolerance: (100.0 * self.tolerance).clamp(1e-11, 1e-6),
                iterations: 12,
                damped: false,
            },
        };
        let mut newton = Newton::new(&equations);
        let mut points = Vec::new();
        let mut apart = 0.0_f64;
        let outcome = follow(
            &mut equations,
            &mut newton,
            Start::Near(u),
            options,
            &mut |equations, _, seen| match seen {
                Visit::Point(at) => match equations.read(&at.u) {
                    Ok((point, returned)) => {
                        apart = apart.max(returned);
                        points.push(point);
                        Continue::Continue(())
                    }
                    Err(_) => Continue::Break(Halt::Stop),
                },
                _ => Continue::Continue(()),
            },
        );
        let parameter = self.from;
        match outcome {
            Err(reason) => return Err(Error::NoStart { parameter, reason }),
            Ok(Outcome::Stopped(Stop::Interrupted) | Outcome::Halted(_)) if points.is_empty() => {
                let reason = FlowError::NotFinite { phase: 0.0 };
                return Err(Error::Motion { parameter, reason });
            }
            Ok(_) => {}
        }
        if apart > RETURNED {
            return Err(Error::NotFree { apart });
        }
        Ok(points)
    }

    /// The unknowns of the first oscillation.
    fn first(&self, equations: &mut Equations<'_>) -> Result<Vec<f64>, Error> {
        let n = equations.flow.coordinates();
        if let Some((positions, omega)) = &self.near {
            if positions.len() != n {
                return Err(Error::State {
                    entries: positions.len(),
                    expected: n,
                });
            }
            let omega = validate::omega(*omega)?;
            return Ok(positions[1..].iter().copied().chain([omega]).collect());
        }
        let time = self.half_period(equations)?;
        Ok((1..n).map(|_| 0.0).chain([PI / time]).collect())
    }

    /// The time to the first moment of rest, at any scale of time: steps grow until there is one, and shrink until it stays.
    fn half_period(&self, equations: &mut Equations<'_>) -> Result<f64, Error> {
        let mut step = STEP;
        let mut found = self.first_rest(equations, step)?;
        for _ in 0..SCALES {
            if found.is_some() {
                break;
            }
            step *= COARSER;
            found = self.first_rest(equations, step)?;
        }
        let never = Error::NeverAtRest {
            position: self.from,
        };
        let mut time = found.ok_or(never.clone())?;
        for _ in 0..SCALES {
            step /= FINER;
            let again = self.first_rest(equations, step)?.unwrap_or(time);
            let same = (again - time).abs() <= SAME * again;
            time = again;
            if same && time > 10.0 * step {
                return Ok(time);
            }
        }
        Err(never)
    }

    /// The same, looked for in steps of this time.
    fn first_rest(&self, equations: &mut Equations<'_>, step: f64) -> Result<Option<f64>, Error> {
        let n = equations.flow.coordinates();
        let parameter = self.from;
        let mut state = vec![0.0; 2 * n];
        state[0] = self.from;
        let (mut phase, mut before) = (0.0, 0.0);
        let motion = |reason| Error::Motion { parameter, reason };
        equations.flow.set(Variable::Omega, 1.0).map_err(motion)?;
        for _ in 0..STEPS {
            let next = phase + step / equations.divisor;
            let moved = equations.flow.advance(phase, next, &mut state, None, None);
            moved.map_err(motion)?;
            let velocity = state[n];
            if before * velocity < 0.0 {
                let part = before / (before - velocity);
                let time = (phase + part * (next - phase)) * equations.divisor;
                return Ok(Some(time));
            }
            (phase, before) = (next, velocity);
        }
        Ok(None)
    }
}

/// The equations (1); unknowns are the other positions and the frequency, the parameter is the first position.
struct Equations<'a> {
    flow: Box<dyn Flow + 'a>,
    divisor: f64,
    state: Vec<f64>,
    tangent: Tangent,
    column: Vec<f64>,
}

impl<'a> Equations<'a> {
    fn new(flow: Box<dyn Flow + 'a>, divisor: f64) -> Self {
        let n = flow.coordinates();
        Self {
            state: vec![0.0; 2 * n],
            tangent: Tangent::of_state(n, Some(Variable::Omega)),
            column: vec![0.0; n],
            divisor,
            flow,
        }
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
    fn read(&mut self, u: &[f64]) -> Result<(FreePoint, f64), FlowError> {
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
