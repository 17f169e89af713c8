//! The equations of a periodic orbit with their derivatives by its states and by every variable.
//!
//! The period is divided into segments. With `s_i` the state at the beginning of segment `i`, and `phi_i` the flow over it,
//!
//! ```text
//! F_i(s; p) = phi_i(s_i; p) - s_(i+1) = 0,     s_m = s_0                                                      (1)
//! F_s ds/dp = -F_p                                                                                            (2)
//! F_s t + F_lambda t_lambda = 0                                                                               (3)
//! dlambda/dp = - w.F_p / w.F_lambda     where     w F_s = 0                                                   (4)
//! ```
//!
//! (2) is the derivative at a fixed value of what is varied, (3) the tangent of the branch, and (4) how a fold moves: there `F_s` is singular,
//! and (2) has no solution. The flow moves derivatives exactly, with jumps where a gap crosses a level, so that (1) to (4) hold to what the
//! tolerance of the flow leaves.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 3 (bordered matrices, folds); Leine and
//! Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7 (how switches move derivatives).

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::error::SensitivityError;
use crate::branches::orbit::Orbit;
use crate::cancel::Cancel;
use crate::error::Error;
use crate::system::{System, Variable};
use crate::time::{self, Flow, FlowError, Stretch, Tangent};

/// Updates of Newton's method, at most.
const ITERATIONS: usize = 20;
/// Updates below this part of the orbit have converged, if they do not shrink any more.
const NEAR: f64 = 1e-6;

/// What rounding leaves of a closed form, and of sums over the nodes of rules.
const EXACT: f64 = 64.0 * f64::EPSILON;
const SMALLEST: f64 = 1e-12;

/// A place on an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stop {
    pub(super) segment: usize,
    pub(super) phase: f64,
}

/// The state at a stop, and its derivatives by the beginning of the segment and then by variables.
#[derive(Debug, Clone)]
pub(super) struct AtStop {
    pub(super) state: Vec<f64>,
    columns: DMatrix<f64>,
}

impl AtStop {
    /// Writes how the state moves with that at the beginning of the segment, and with variables by their weights.
    pub(super) fn moved(
        &self,
        states: &[f64],
        weights: impl Iterator<Item = f64>,
        moved: &mut [f64],
    ) {
        moved.fill(0.0);
        let times = states.iter().copied().chain(weights);
        for (column, times) in self.columns.column_iter().zip(times) {
            if times != 0.0 {
                let both = moved.iter_mut().zip(column.iter());
                both.for_each(|(sum, x)| *sum += times * x);
            }
        }
    }
}

/// The equations at states.
pub(super) struct Evaluated {
    pub(super) residual: DVector<f64>,
    pub(super) jacobian: DMatrix<f64>,
    /// By each variable that was asked for.
    pub(super) by: Vec<DVector<f64>>,
    pub(super) stops: Vec<AtStop>,
}

/// The equations of orbits of one period, at values that can be changed.
pub(super) struct Cycle {
    pub(super) system: Arc<dyn System>,
    flow: Box<dyn Flow>,
    pub(super) coordinates: usize,
    /// In periods of the declaration.
    pub(super) period: usize,
    pub(super) segments: usize,
    /// What a branch varies.
    pub(super) varied: Variable,
    pub(super) values: Vec<f64>,
    pub(super) omega: f64,
    /// The last updates of Newton's method, relative to the orbit, are below this.
    finest: f64,
    /// What the flow leaves in a state, relative to the largest, and in its derivatives.
    pub(super) leaves: f64,
}

impl Cycle {
    /// Of orbits like this one, near the values that it has.
    ///
    /// # Errors
    /// If there is no flow.
    pub(super) fn new(
        system: &Arc<dyn System>,
        values: &[f64],
        orbit: &Orbit,
        varied: Variable,
        tolerance: f64,
        cancel: &Cancel,
    ) -> Result<Self, Error> {
        let mut flow = time::at(system, values, orbit.omega, tolerance)?;
        flow.until(cancel);
        let leaves = if flow.is_closed_form() {
            EXACT
        } else {
            tolerance
        };
        let given = orbit.states.len() / (2 * orbit.coordinates);
        let segments = if orbit.parts == 1 && given > 0 {
            given
        } else {
            orbit.period
        };
        Ok(Self {
            system: Arc::clone(system),
            flow,
            coordinates: orbit.coordinates,
            period: orbit.period,
            segments,
            varied,
            values: values.to_vec(),
            omega: orbit.omega,
            finest: (10.0 * leaves).max(1e-13),
            leaves,
        })
    }

    /// A harmonic below this part of the effective value is what the flow leaves.
    pub(super) fn vanishes(&self) -> f64 {
        self.leaves.max(SMALLEST)
    }

    /// Whether its flow is exact to rounding.
    pub(super) fn is_closed_form(&self) -> bool {
        self.flow.is_closed_form()
    }

    /// Entries of a state.
    pub(super) fn order(&self) -> usize {
        2 * self.coordinates
    }

    /// Unknowns: the states at the beginnings of all segments.
    pub(super) fn unknowns(&self) -> usize {
        self.order() * self.segments
    }

    /// First and last phase of a segment. The first is within the first period.
    pub(super) fn phases(&self, segment: usize) -> [f64; 2] {
        let begin = segment * self.period % self.segments;
        let phase = |numerator: usize| TAU * (numerator as f64 / self.segments as f64);
        [phase(begin), phase(begin + self.period)]
    }

    /// What is added to a phase within a segment, for that from the beginning of the orbit.
    pub(super) fn passed(&self, segment: usize) -> f64 {
        let [from, _] = self.phases(segment);
        TAU * (segment * self.period) as f64 / self.segments as f64 - from
    }

    /// The present value of a variable.
    pub(super) fn value(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Omega => self.omega,
            Variable::Parameter(index) => self.values[index],
        }
    }

    /// Changes a variable.
    ///
    /// # Errors
    /// If the flow cannot have that value.
    pub(super) fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        if self.value(variable) == value {
            return Ok(());
        }
        self.flow.set(variable, value)?;
        match variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.values[index] = value,
        }
        Ok(())
    }

    /// States at the beginnings of all segments, from what is known of an orbit.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn states(&mut self, orbit: &Orbit) -> Result<Vec<f64>, FlowError> {
        if orbit.parts == 1 && !orbit.states.is_empty() {
            return Ok(orbit.states.clone());
        }
        let order = self.order();
        let mut states = Vec::with_capacity(self.unknowns());
        if orbit.has_series() {
            for segment in 0..self.segments {
                let part = segment as f64 / self.segments as f64;
                let time = part * TAU / orbit.base;
                let motions = (0..self.coordinates).filter_map(|i| orbit.state_at(i, time));
                let (positions, velocities): (Vec<f64>, Vec<f64>) = motions.unzip();
                states.extend(positions);
                states.extend(velocities);
            }
            return Ok(states);
        }
        let mut state = orbit.state();
        for segment in 0..self.segments {
            states.extend_from_slice(&state[..order]);
            let [from, to] = self.phases(segment);
            self.flow.advance(from, to, &mut state, None, None)?;
        }
        Ok(states)
    }

    /// Shows the motion, stretch by stretch, with the segment that each is in.
    ///
    /// # Errors
    /// If it cannot be continued.
    pub(super) fn trace(
        &mut self,
        states: &[f64],
        see: &mut dyn FnMut(usize, &dyn Stretch),
    ) -> Result<(), FlowError> {
        let order = self.order();
        for segment in 0..self.segments {
            let mut state = states[segment * order..][..order].to_vec();
            let [from, to] = self.phases(segment);
            let mut show = |stretch: &dyn Stretch| see(segment, stretch);
            self.flow
                .advance(from, to, &mut state, None, Some(&mut show))?;
        }
        Ok(())
    }

    /// The equations and their derivatives by states and variables, and the same at stops, which are in the order of the motion.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn evaluate(
        &mut self,
        states: &[f64],
        variables: &[Variable],
        stops: &[Stop],
    ) -> Result<Evaluated, FlowError> {
        let order = self.order();
        let mut at_stops = Vec::with_capacity(stops.len());
        let mut phases = Vec::with_capacity(stops.len());
        let mut evaluated = self.evaluate_by(states, variables, |flow, segment, motion| {
            let inside = stops.iter().filter(|stop| stop.segment == segment);
            phases.clear();
            phases.extend(inside.map(|stop| stop.phase));
            let Motion {
                ends,
                state,
                tangent,
            } = motion;
            flow.advance_by(ends, &phases, state, tangent, &mut |_, state, columns| {
                at_stops.push(AtStop {
                    state: state.to_vec(),
                    columns: DMatrix::from_column_slice(order, columns.len() / order, columns),
                });
            })
        })?;
        evaluated.stops = at_stops;
        Ok(evaluated)
    }

    /// The same without stops; every stretch is shown with its segment.
    ///
    /// # Errors
    /// As there.
    pub(super) fn evaluate_seen(
        &mut self,
        states: &[f64],
        variables: &[Variable],
        see: &mut dyn FnMut(usize, &dyn Stretch),
    ) -> Result<Evaluated, FlowError> {
        self.evaluate_by(states, variables, |flow, segment, motion| {
            let Motion {
                ends: [from, to],
                state,
                tangent,
            } = motion;
            let mut show = |stretch: &dyn Stretch| see(segment, stretch);
            flow.advance(from, to, state, Some(tangent), Some(&mut show))
        })
    }

    fn evaluate_by(
        &mut self,
        states: &[f64],
        variables: &[Variable],
        mut advance: impl FnMut(&mut dyn Flow, usize, Motion<'_>) -> Result<(), FlowError>,
    ) -> Result<Evaluated, FlowError> {
        let (order, n) = (self.order(), self.unknowns());
        let mut evaluated = Evaluated {
            residual: DVector::zeros(n),
            jacobian: DMatrix::zeros(n, n),
            by: vec![DVector::zeros(n); variables.len()],
            stops: Vec::new(),
        };
        for segment in 0..self.segments {
            let (first, next) = (segment * order, (segment + 1) % self.segments * order);
            let mut tangent = Tangent::of_state(self.coordinates, variables.iter().copied());
            let mut state = states[first..][..order].to_vec();
            let motion = Motion {
                ends: self.phases(segment),
                state: &mut state,
                tangent: &mut tangent,
            };
            advance(self.flow.as_mut(), segment, motion)?;
            let mut columns = tangent.columns.chunks_exact(order);
            for (j, column) in columns.by_ref().take(order).enumerate() {
                for i in 0..order {
                    evaluated.jacobian[(first + i, first + j)] += column[i];
                }
            }
            for i in 0..order {
                evaluated.residual[first + i] = state[i] - states[next + i];
                evaluated.jacobian[(first + i, next + i)] -= 1.0;
            }
            for (by, column) in evaluated.by.iter_mut().zip(columns) {
                by.as_mut_slice()[first..][..order].copy_from_slice(column);
            }
        }
        Ok(evaluated)
    }

    /// The matrices over the segments, in units of states.
    pub(super) fn matrices(&self, evaluated: &Evaluated) -> Vec<DMatrix<f64>> {
        let order = self.order();
        let matrix = |segment: usize| {
            let first = segment * order;
            let own = evaluated.jacobian.view((first, first), (order, order));
            let mut own = own.into_owned();
            if self.segments == 1 {
                // Its own beginning is the next one.
                own += DMatrix::identity(order, order);
            }
            for i in 0..order {
                for j in 0..order {
                    own[(i, j)] *= self.unit(j) / self.unit(i);
                }
            }
            own
        };
        (0..self.segments).map(matrix).collect()
    }

    /// What counts as one in an unknown: velocities count by the frequency.
    pub(super) fn unit(&self, unknown: usize) -> f64 {
        if unknown % self.order() < self.coordinates {
            1.0
        } else {
            self.omega
        }
    }

    /// The Jacobian of the equations in these units.
    pub(super) fn scaled(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        let unit = |index: usize| self.unit(index);
        DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |i, j| {
            jacobian[(i, j)] * unit(j) / unit(i)
        })
    }

    /// States, or equations, in these units.
    pub(super) fn in_units(&self, states: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(states.len(), |i, _| states[i] / self.unit(i))
    }

    /// States that are in these units.
    pub(super) fn out_of_units(&self, states: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(states.len(), |i, _| states[i] * self.unit(i))
    }

    /// The largest entry of states in these units.
    pub(super) fn size(&self, states: &[f64]) -> f64 {
        let entries = states.iter().enumerate();
        entries.fold(0.0, |m: f64, (i, x)| m.max(x.abs() / self.unit(i)))
    }

    /// Solves (1) from nearby states, at fixed values.
    ///
    /// # Errors
    /// If the motion cannot be continued, or Newton's method does not converge.
    pub(super) fn solve(&mut self, states: &mut [f64]) -> Result<(), SensitivityError> {
        self.solve_by(states, |_, jacobian, right| {
            let solved = jacobian.clone().lu().solve(right);
            solved.ok_or(SensitivityError::Singular)
        })
    }

    /// The same, with updates by a solver of linear equations that is given.
    ///
    /// # Errors
    /// As [`solve`](Self::solve), and those of the solver.
    pub(super) fn solve_by(
        &mut self,
        states: &mut [f64],
        solver: impl Fn(&Self, &DMatrix<f64>, &DVector<f64>) -> Result<DVector<f64>, SensitivityError>,
    ) -> Result<(), SensitivityError> {
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let Evaluated {
                residual, jacobian, ..
            } = self.evaluate(states, &[], &[])?;
            let update = solver(self, &jacobian, &-residual)?;
            let length = self.size(update.as_slice()) / self.size(states).max(f64::MIN_POSITIVE);
            states.iter_mut().zip(&update).for_each(|(x, d)| *x += d);
            if self.has_converged(length, before) {
                return Ok(());
            }
            if !length.is_finite() {
                break;
            }
            before = length;
        }
        Err(SensitivityError::Diverged { left: before })
    }

    /// Whether an update is the last, where the one before had a length.
    pub(super) fn has_converged(&self, length: f64, before: f64) -> bool {
        length <= self.finest || (length <= NEAR && length >= 0.5 * before)
    }

    /// The solution of the equations (1) with a border: the row `border` of extended unknowns, and the right-hand side beside it.
    pub(super) fn bordered(
        &self,
        evaluated: &Evaluated,
        border: &DVector<f64>,
        right: &DVector<f64>,
    ) -> Result<DVector<f64>, SensitivityError> {
        let n = self.unknowns();
        let mut matrix = DMatrix::zeros(n + 1, n + 1);
        matrix
            .view_mut((0, 0), (n, n))
            .copy_from(&evaluated.jacobian);
        matrix.view_mut((0, n), (n, 1)).copy_from(&evaluated.by[0]);
        for i in 0..=n {
            matrix[(n, i)] = border[i] / self.square(i);
        }
        matrix.lu().solve(right).ok_or(SensitivityError::Singular)
    }

    /// The square of what counts as one in an extended unknown.
    fn square(&self, unknown: usize) -> f64 {
        let unit = if unknown == self.unknowns() {
            self.value(self.varied).abs().max(f64::MIN_POSITIVE)
        } else {
            self.unit(unknown)
        };
        unit * unit
    }

    /// The tangent (3) of length one, on the side of another one; without one, towards larger values.
    pub(super) fn tangent(
        &self,
        evaluated: &Evaluated,
        like: Option<&DVector<f64>>,
    ) -> Result<DVector<f64>, SensitivityError> {
        let n = self.unknowns();
        let mut right = DVector::zeros(n + 1);
        right[n] = 1.0;
        let value = like.is_none().then(|| right.clone());
        let border = like.or(value.as_ref()).ok_or(SensitivityError::Singular)?;
        let mut tangent = self.bordered(evaluated, border, &right)?;
        let length: f64 = (0..=n)
            .map(|i| tangent[i] * tangent[i] / self.square(i))
            .sum();
        tangent /= length.sqrt();
        Ok(tangent)
    }
}

/// What is moved over a segment.
struct Motion<'m> {
    ends: [f64; 2],
    state: &'m mut [f64],
    tangent: &'m mut Tangent,
}
