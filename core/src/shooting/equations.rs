//! The equations of shooting.
//!
//! The period is divided into `m` segments of equal phase. With `s_i` the state at the beginning of segment `i`, and `phi_i` the
//! flow over it,
//!
//! ```text
//! phi_i(s_i; lambda) - s_(i+1) = 0,    i < m - 1,                                                             (1)
//! phi_(m-1)(s_(m-1); lambda) - S s_0 = 0                                                                      (2)
//! M = S^-1 phi'_(m-1) ... phi'_1 phi'_0                                                                       (3)
//! ```
//!
//! `S` is one. Of an orbit that comes back after a part of its period, with coordinates in each other's place
//! ([`recurrence`](crate::branches::recurrence)), that part is enough: of one with odd symmetry, `q(tau + pi n) = -q(tau)`, half a
//! period with `S = -1`. The multipliers of the whole period are then the powers of the eigenvalues of `M` by the number of parts.
//! Phases begin within the first period of the system, so that equal states at equal phases move alike to the last bit.
//!
//! The unknowns are positions less those of a reference, and velocities, so that a load does not hide the oscillation.
//!
//! Source: Stoer and Bulirsch (2002), Introduction to Numerical Analysis, section 7.3 (simple and multiple shooting).

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DMatrixView};

use super::problem::ShootingProblem;
use crate::branches::recurrence::Recurrence;
use crate::cancel::Cancel;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::system::Variable;
use crate::time::{Flow, FlowError, See, Stretch, Tangent};

/// What one orbit extends over, and how it is divided.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Span {
    /// How it comes back: after a part of its period, and only that part is followed.
    pub(super) recurrence: Recurrence,
    /// `m`
    pub(super) segments: usize,
}

impl Span {
    /// Of orbits that come back so, in as many segments of a part as all of them has parts.
    pub(super) fn of(recurrence: Recurrence, segments: usize) -> Self {
        Self {
            segments: segments.div_ceil(recurrence.parts),
            recurrence,
        }
    }

    /// Of twice the time.
    pub(super) fn doubled(&self) -> Self {
        Self {
            recurrence: self.recurrence.doubled(),
            segments: 2 * self.segments,
        }
    }

    /// First and last phase of a segment. The first is within the first period.
    pub(super) fn phases(&self, segment: usize) -> (f64, f64) {
        let Recurrence { period, parts, .. } = self.recurrence;
        // A period of the system has so many units, a segment as many as the orbit has periods.
        let units = self.segments * parts;
        let begin = segment * period % units;
        let phase = |numerator: usize| TAU * (numerator as f64 / units as f64);
        (phase(begin), phase(begin + period))
    }

    /// Phase of the beginning of a segment, from the beginning of the first.
    pub(super) fn begins(&self, segment: usize) -> f64 {
        let (from, to) = self.phases(0);
        segment as f64 * (to - from)
    }
}

/// What does not change along a curve of orbits.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Frame {
    /// What is varied.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) variable: Variable,
    /// Positions that the unknowns are counted from.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) reference: Vec<f64>,
    /// A frequency: velocities count by it.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) omega: f64,
    /// The largest state in units of the oscillation's size: rounding and the error of a flow are relative to it.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) ratio: f64,
}

impl Frame {
    /// Positions count from zero.
    pub(super) fn plain(variable: Variable, coordinates: usize, omega: f64) -> Self {
        Self {
            variable,
            reference: vec![0.0; coordinates],
            omega,
            ratio: 1.0,
        }
    }
}

/// The equations of one system, as a problem of continuation.
pub(super) struct Equations {
    pub(super) flow: Box<dyn Flow>,
    pub(super) span: Span,
    pub(super) frame: Frame,
    /// Added to every position equation, and times the frequency to every velocity equation, with alternating signs. All
    /// segments are disturbed alike: what a shift by a period turns into itself, still is.
    pub(super) disturbance: f64,
    /// `M` at the last unknowns where derivatives were asked for.
    pub(super) product: DMatrix<f64>,
    /// Room for the next.
    room: DMatrix<f64>,
    /// Why the last evaluation has no value.
    pub(super) failure: Option<FlowError>,
    /// Tolerance of the flow.
    pub(super) tolerance: f64,
    tangent: Tangent,
    state: Vec<f64>,
    /// Derivatives of the residual by the parameter.
    column: Vec<f64>,
    cancel: Cancel,
}

impl Equations {
    /// With a flow of this tolerance.
    pub(super) fn new(
        problem: &ShootingProblem,
        tolerance: f64,
        span: Span,
        frame: Frame,
    ) -> Result<Self, Error> {
        let flow = problem.flow(tolerance)?;
        let coordinates = flow.coordinates();
        let order = 2 * coordinates;
        Ok(Self {
            tangent: Tangent::of_state(coordinates, Some(frame.variable)),
            state: vec![0.0; order],
            column: vec![0.0; order * span.segments],
            product: DMatrix::zeros(order, order),
            room: DMatrix::zeros(order, order),
            flow,
            span,
            frame,
            disturbance: 0.0,
            failure: None,
            tolerance,
            cancel: problem.cancel.clone(),
        })
    }

    /// The same equations, with a flow of their own.
    pub(super) fn again(&self, problem: &ShootingProblem) -> Result<Self, Error> {
        let (span, frame) = (self.span.clone(), self.frame.clone());
        let equations = Self::new(problem, self.tolerance, span, frame)?;
        Ok(Self {
            disturbance: self.disturbance,
            ..equations
        })
    }

    /// Entries of one state, `2 n`.
    pub(super) fn order(&self) -> usize {
        self.state.len()
    }

    /// Extended unknowns of states, segment after segment.
    pub(super) fn unknowns_of(&self, states: &[f64], value: f64) -> Vec<f64> {
        let mut u = states.to_vec();
        for state in u.chunks_exact_mut(self.order()) {
            for (x, reference) in state.iter_mut().zip(&self.frame.reference) {
                *x -= reference;
            }
        }
        u.push(value);
        u
    }

    /// The states, segment after segment.
    pub(super) fn states_of(&self, u: &[f64]) -> Vec<f64> {
        let mut states = u[..u.len() - 1].to_vec();
        for state in states.chunks_exact_mut(self.order()) {
            for (x, reference) in state.iter_mut().zip(&self.frame.reference) {
                *x += reference;
            }
        }
        states
    }

    /// Goes over to another division; the unknowns are then others.
    pub(super) fn divide(&mut self, span: Span) {
        self.column.resize(self.order() * span.segments, 0.0);
        self.span = span;
    }

    /// The states at the beginnings of all segments, on the way from a state at phase zero.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn states_from(&mut self, state: &[f64], value: f64) -> Result<Vec<f64>, FlowError> {
        self.flow.set(self.frame.variable, value)?;
        let mut state = state.to_vec();
        let mut states = state.clone();
        for segment in 1..self.span.segments {
            let (from, to) = self.span.phases(segment - 1);
            self.flow.advance(from, to, &mut state, None, None)?;
            states.extend_from_slice(&state);
        }
        Ok(states)
    }

    /// Moves a state from one of so many parts of a period of the system to another.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn pass(
        &mut self,
        state: &mut [f64],
        value: f64,
        [from, to]: [usize; 2],
        parts: usize,
    ) -> Result<(), FlowError> {
        self.flow.set(self.frame.variable, value)?;
        let begin = from % parts;
        let phase = |numerator: usize| TAU * (numerator as f64 / parts as f64);
        let (from, to) = (phase(begin), phase(begin + to - from));
        self.flow.advance(from, to, state, None, None)
    }

    /// The largest difference between the states of two orbits, of velocities in units of the frequency.
    pub(super) fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        let pairs = a[..a.len() - 1].iter().zip(b).enumerate();
        pairs.fold(0.0, |m: f64, (i, (x, y))| {
            m.max((x - y).abs() / self.unit(i))
        })
    }

    /// Sets `state` to the beginning of a segment, and the tangent to the unit matrix.
    fn begin(&mut self, u: &[f64], segment: usize) {
        let order = self.order();
        self.state.copy_from_slice(&u[segment * order..][..order]);
        for (x, reference) in self.state.iter_mut().zip(&self.frame.reference) {
            *x += reference;
        }
        self.tangent.columns.fill(0.0);
        for i in 0..order {
            self.tangent.columns[i * order + i] = 1.0;
        }
    }

    /// Moves `state` over a segment, and the tangent if asked for.
    fn advance(
        &mut self,
        segment: usize,
        tangent: bool,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let (from, to) = self.span.phases(segment);
        let tangent = tangent.then_some(&mut self.tangent);
        self.flow.advance(from, to, &mut self.state, tangent, see)
    }

    /// The entry of a state that `S` takes into another one, and the sign.
    fn image(&self, entry: usize) -> (usize, f64) {
        let image = &self.span.recurrence.image;
        image.state_entry(entry, self.order() / 2)
    }

    /// The state at a phase within a segment, and its derivatives by where that begins and by the parameter.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn tangent_at(
        &mut self,
        u: &[f64],
        segment: usize,
        phase: f64,
    ) -> Result<(Vec<f64>, Tangent), FlowError> {
        self.flow.set(self.frame.variable, u[u.len() - 1])?;
        self.begin(u, segment);
        let (from, _) = self.span.phases(segment);
        let tangent = Some(&mut self.tangent);
        self.flow
            .advance(from, phase, &mut self.state, tangent, None)?;
        Ok((self.state.clone(), self.tangent.clone()))
    }

    /// The residuals of one segment, once `state` is at its end.
    fn close(&self, u: &[f64], segment: usize, residual: &mut [f64]) {
        let order = self.order();
        let last = segment + 1 == self.span.segments;
        let next = if last { 0 } else { segment + 1 };
        for i in 0..order {
            let (place, sign) = if last { self.image(i) } else { (i, 1.0) };
            let reference = self.frame.reference.get(place).copied().unwrap_or(0.0);
            let target = sign * (u[next * order + place] + reference);
            let unit = self.unit(i);
            let alternating = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            residual[segment * order + i] =
                self.state[i] - target + alternating * unit * self.disturbance;
        }
    }

    /// The rows of one segment, once the tangent is that of its end.
    fn fill(&mut self, segment: usize, jacobian: &mut Jacobian) {
        let order = self.order();
        let last = segment + 1 == self.span.segments;
        let next = if last { 0 } else { segment + 1 };
        let (first, next) = (segment * order, next * order);
        for i in 0..order {
            let (place, sign) = if last { self.image(i) } else { (i, 1.0) };
            let row = jacobian.core_mut().row_mut(first + i);
            for j in 0..order {
                row[first + j] += self.tangent.columns[j * order + i];
            }
            row[next + place] -= sign;
            self.column[first + i] = self.tangent.columns[order * order + i];
        }
    }

    /// `M` at the orbit `u`, which is shown to `see` stretch by stretch; velocities count by the frequency, so that its entries do
    /// not depend on the unit of time.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn map(
        &mut self,
        u: &[f64],
        see: &mut dyn FnMut(&dyn Stretch),
    ) -> Result<DMatrix<f64>, FlowError> {
        self.flow.set(self.frame.variable, u[u.len() - 1])?;
        for segment in 0..self.span.segments {
            self.begin(u, segment);
            self.advance(segment, true, Some(see))?;
            self.multiply(segment);
        }
        Ok(self.in_units(&self.product))
    }

    /// A map of states as one of states whose velocities are divided by the frequency: `D^-1 M D` with `D = diag(1, omega)`.
    fn in_units(&self, map: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(map.nrows(), map.ncols(), |i, j| {
            map[(i, j)] * self.unit(j) / self.unit(i)
        })
    }

    /// What counts as one in an entry of a state.
    pub(super) fn unit(&self, entry: usize) -> f64 {
        if entry % self.order() < self.order() / 2 {
            1.0
        } else {
            self.frame.omega
        }
    }

    /// The derivatives of the flow over every segment of the orbit `u`, in the same units.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn segment_maps(&mut self, u: &[f64]) -> Result<Vec<DMatrix<f64>>, FlowError> {
        self.flow.set(self.frame.variable, u[u.len() - 1])?;
        let order = self.order();
        let mut maps = Vec::with_capacity(self.span.segments);
        for segment in 0..self.span.segments {
            self.begin(u, segment);
            self.advance(segment, true, None)?;
            let columns = &self.tangent.columns[..order * order];
            let map = DMatrix::from_column_slice(order, order, columns);
            maps.push(self.in_units(&map));
        }
        Ok(maps)
    }

    /// Takes the tangent of one segment into the product (3).
    fn multiply(&mut self, segment: usize) {
        let order = self.order();
        let last = segment + 1 == self.span.segments;
        let columns = &self.tangent.columns[..order * order];
        let tangent = DMatrixView::from_slice(columns, order, order);
        if segment == 0 {
            self.room.copy_from(&tangent);
        } else {
            self.room.gemm(1.0, &tangent, &self.product, 0.0);
        }
        if !last || self.span.recurrence.image.is_identity() {
            std::mem::swap(&mut self.product, &mut self.room);
            return;
        }
        // S takes row p_i to row i, and its inverse back.
        for i in 0..order {
            let (place, sign) = self.image(i);
            for j in 0..order {
                self.product[(place, j)] = sign * self.room[(i, j)];
            }
        }
    }

    /// Shows the orbit `u` to `see`, stretch by stretch. Returns the largest distance of the end of a segment from the beginning of the next one,
    /// velocities in units of the frequency.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn trace(
        &mut self,
        u: &[f64],
        see: &mut dyn FnMut(&dyn Stretch),
    ) -> Result<f64, FlowError> {
        let mut residual = vec![0.0; self.unknowns()];
        self.flow.set(self.frame.variable, u[u.len() - 1])?;
        for segment in 0..self.span.segments {
            self.begin(u, segment);
            self.advance(segment, false, Some(see))?;
            self.close(u, segment, &mut residual);
        }
        let residual = residual.iter().enumerate();
        Ok(residual.fold(0.0, |most: f64, (i, x)| most.max(x.abs() / self.unit(i))))
    }
}

impl Problem for Equations {
    fn unknowns(&self) -> usize {
        self.order() * self.span.segments
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], mut jacobian: Option<&mut Jacobian>) {
        self.failure = None;
        if let Err(failure) = self.flow.set(self.frame.variable, u[u.len() - 1]) {
            self.failure = Some(failure);
            residual.fill(f64::NAN);
            return;
        }
        for segment in 0..self.span.segments {
            self.begin(u, segment);
            if let Err(failure) = self.advance(segment, jacobian.is_some(), None) {
                self.failure = Some(failure);
                residual.fill(f64::NAN);
                return;
            }
            self.close(u, segment, residual);
            if let Some(jacobian) = &mut jacobian {
                self.multiply(segment);
                self.fill(segment, jacobian);
            }
        }
        if let Some(jacobian) = jacobian {
            jacobian.set_column(&self.column);
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    fn weights(&self, weights: &mut [f64]) {
        let order = self.order();
        let coordinates = order / 2;
        let states = (coordinates * self.span.segments) as f64;
        for (i, weight) in weights.iter_mut().enumerate() {
            let unit = self.unit(i);
            // A harmonic oscillation has half the square of its amplitude as its mean square.
            *weight = 0.5 / (states * unit * unit);
        }
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }
}
