//! An orbit refined by integration, where its series does not resolve a law.
//!
//! Where a force changes on a scale far below that of the harmonics, as the friction `tanh(r / v)` of a small `v`, the acceleration
//! of the series passes the change smoothed, and however many harmonics there are, perturbations that pass it with that motion are
//! not those of the orbit: `K` and `2 K` harmonics agree, and both are wrong. So the motion itself is integrated, from the state
//! where the series begins, with its derivatives by that state; Newton's method closes it,
//!
//! ```text
//! (I - P) dx = x(T) - x(0),    P = dx(T) / dx(0)                                                              (1)
//! ```
//!
//! and the eigenvalues of `P` are the multipliers. The error is the change by the last step of Newton's method and by another
//! tolerance and another number of nodes in each step of the integration.
//!
//! Source: Parker and Chua (1989), Practical Numerical Algorithms for Chaotic Systems, section 5.3 (shooting).

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::method::Found;
use crate::balance::Balance;
use crate::model::rigid::Rigid;
use crate::numeric::fourier::series;
use crate::numeric::spectrum::spread;
use crate::numeric::spectrum::{distance, eigenvalues};
use crate::time::{Flow, Integrated, Tangent};

/// Relative tolerance of the integration that finds the orbit.
const COARSE: f64 = 1e-8;
/// The same of the one whose orbit is given.
const FINE: f64 = 1e-11;
/// Steps of Newton's method with either, at most.
const STEPS: usize = 8;
/// Update with which the first ends, in parts of the orbit.
const NEAR: f64 = 1e-6;
/// The same of the second, as far as rounding lets it.
const CLOSED: f64 = 1e-12;
/// Error of the states of a closed orbit, in parts of its size.
const INTEGRATED: f64 = 1e-9;
/// Distance from the series, in parts of the orbit's size, beyond which an orbit is another one.
const FAR: f64 = 0.1;
/// Rounding errors of the matrix, relative to its largest entry.
const ROUNDED: f64 = 1e-13;

/// The flow over a period of one orbit after the other.
struct Map<'a> {
    flow: Integrated,
    /// Phase at its end.
    end: f64,
    /// What counts as one in each entry of a state.
    units: Vec<f64>,
    tangent: Tangent,
    rigid: Option<&'a Rigid>,
}

impl<'a> Map<'a> {
    fn new(balance: &'a Balance<'_>, tolerance: f64) -> Option<Self> {
        let coordinates = balance.layout().coordinates;
        let period = balance.resolution().period as f64;
        let (parameters, omega) = (balance.parameters(), balance.omega());
        let rate = balance.base() * period;
        let units = [vec![1.0; coordinates], vec![rate; coordinates]].concat();
        Some(Self {
            flow: Integrated::new(balance.system(), parameters, omega, tolerance).ok()?,
            end: TAU * period,
            units,
            tangent: Tangent::of_state(coordinates, None),
            rigid: balance.rigid(),
        })
    }

    /// What a state lacks to close, and `P`, in units.
    fn at(&mut self, state: &[f64]) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let order = state.len();
        self.tangent = Tangent::of_state(order / 2, None);
        let mut end = state.to_vec();
        let tangent = Some(&mut self.tangent);
        self.flow
            .advance(0.0, self.end, &mut end, tangent, None)
            .ok()?;
        let units = &self.units;
        let residual = DVector::from_fn(order, |i, _| (end[i] - state[i]) / units[i]);
        let columns = &self.tangent.columns;
        let matrix = DMatrix::from_fn(order, order, |i, j| {
            columns[j * order + i] * units[j] / units[i]
        });
        let finite = residual.iter().chain(&matrix).all(|x| x.is_finite());
        finite.then_some((residual, matrix))
    }

    /// One step of (1): its size, and `P` before it.
    fn step(&mut self, state: &mut [f64]) -> Option<(f64, DMatrix<f64>)> {
        let (residual, matrix) = self.at(state)?;
        let order = state.len();
        let mut system = DMatrix::identity(order, order) - &matrix;
        if let Some(rigid) = self.rigid {
            // A shift is not determined: none is made.
            let n = order / 2;
            let mut block = system.view_mut((n, 0), (n, n));
            block += rigid.projector();
        }
        let change = system.lu().solve(&residual)?;
        for ((x, change), unit) in state.iter_mut().zip(&change).zip(&self.units) {
            *x += change * unit;
        }
        let size = change.amax();
        size.is_finite().then_some((size, matrix))
    }

    /// A map without the multipliers of rigid motions.
    fn reduced(&self, matrix: DMatrix<f64>) -> DMatrix<f64> {
        match self.rigid {
            Some(rigid) => rigid.taken_out_of(&matrix),
            None => matrix,
        }
    }

    /// Multipliers, with the error that rounding leaves.
    fn multipliers(matrix: &DMatrix<f64>) -> Option<Found> {
        let multipliers = eigenvalues(matrix);
        if multipliers.is_empty() {
            return None;
        }
        let rounded = ROUNDED * matrix.amax();
        Some(Found {
            error: spread(&multipliers, matrix.as_slice(), |_| rounded),
            multipliers,
            bound: None,
            matrix: Vec::new(),
        })
    }
}

/// An orbit closed by integration.
#[derive(Debug)]
pub(crate) struct Refined {
    /// Its state at phase zero.
    state: Vec<f64>,
    /// Size of its largest oscillation.
    size: f64,
    /// The last update of the state, relative to the size.
    remaining: f64,
}

impl Refined {
    /// The largest difference of a coordinate's peak-to-peak, in its unit, from that of series, whose extremes have these phases: with the
    /// rate `v` that the motion has there and the acceleration `a` of the series, its extreme is `v^2 / 2 a` beyond. Both parts are taken
    /// by their sizes, with what the integration and the last update may err by.
    pub(crate) fn peak_to_peak_error(
        &self,
        balance: &Balance<'_>,
        series: &[f64],
        phases: &[[f64; 2]],
        units: &[f64],
    ) -> Option<f64> {
        let coordinates = balance.layout().coordinates;
        let (parameters, omega) = (balance.parameters(), balance.omega());
        let mut flow = Integrated::new(balance.system(), parameters, omega, FINE).ok()?;
        let period = balance.resolution().period as f64;
        let length = series.len() / coordinates;
        let mut largest = 0.0_f64;
        for (coordinate, phases) in phases.iter().enumerate() {
            let of = &series[coordinate * length..][..length];
            let (mut range, mut beyond) = ([0.0; 2], 0.0);
            for (difference, phase) in range.iter_mut().zip(phases) {
                let mut state = self.state.clone();
                // Phases of series are of the orbit's own period, those of a flow of the declaration's.
                flow.advance(0.0, phase * period, &mut state, None, None)
                    .ok()?;
                let (value, _, curvature) = series::value_and_derivatives(of, *phase);
                *difference = state[coordinate] - value;
                let slope = state[coordinates + coordinate] / balance.base();
                let rise = slope * slope / (2.0 * curvature.abs());
                beyond += if slope == 0.0 {
                    0.0
                } else {
                    rise.min(self.size)
                };
            }
            let remaining = (INTEGRATED + 2.0 * self.remaining) * self.size;
            let difference = (range[1] - range[0]).abs() + beyond + remaining;
            largest = largest.max(difference / units[coordinate]);
        }
        Some(largest)
    }
}

/// Multipliers of the orbit at the value that a balance was set to, beside the orbit with these series, and that orbit; `None` if it is
/// not found or is not near.
pub(super) fn multipliers(balance: &Balance<'_>, orbit: &[f64]) -> Option<(Found, Refined)> {
    let coordinates = balance.layout().coordinates;
    let (mut state, size) = begin(orbit, coordinates, balance.base());
    let first = state.clone();
    let mut coarse = Map::new(balance, COARSE)?;
    let apart = |a: &[f64], b: &[f64], units: &[f64]| {
        let entries = a.iter().zip(b).zip(units);
        entries.fold(0.0_f64, |m, ((x, y), unit)| m.max((x - y).abs() / unit))
    };
    let mut near = false;
    for _ in 0..STEPS {
        let (change, _) = coarse.step(&mut state)?;
        if apart(&state, &first, &coarse.units) > FAR * size {
            return None;
        }
        near = change <= NEAR * size;
        if near {
            break;
        }
    }
    if !near {
        return None;
    }
    let mut fine = Map::new(balance, FINE)?;
    let (mut change, mut before) = fine.step(&mut state)?;
    for _ in 1..STEPS {
        let at = state.clone();
        let (next, matrix) = fine.step(&mut state)?;
        // Below what is near, updates that no longer shrink are rounding and tolerance.
        let settled = next <= NEAR * size && next >= 0.5 * change;
        if next <= CLOSED * size || settled {
            if apart(&state, &first, &fine.units) > FAR * size {
                return None;
            }
            let [matrix, other, before] =
                [matrix, coarse.at(&at)?.1, before].map(|matrix| fine.reduced(matrix));
            let mut found = Map::multipliers(&matrix)?;
            let differ = |other: &DMatrix<f64>| distance(&found.multipliers, &eigenvalues(other));
            let error = differ(&other) + differ(&before);
            found.error += error;
            let remaining = next / size;
            return Some((
                found,
                Refined {
                    state,
                    size,
                    remaining,
                },
            ));
        }
        (change, before) = (next, matrix);
    }
    None
}

/// The state at phase zero, and the size of the largest oscillation.
fn begin(orbit: &[f64], coordinates: usize, base: f64) -> (Vec<f64>, f64) {
    let length = orbit.len() / coordinates;
    let mut state = vec![0.0; 2 * coordinates];
    let mut size = f64::MIN_POSITIVE;
    for (i, of) in orbit.chunks_exact(length).enumerate() {
        let (value, slope, _) = series::value_and_derivatives(of, 0.0);
        state[i] = value;
        state[coordinates + i] = base * slope;
        size = of[1..].iter().map(|x| x.abs()).fold(size, f64::max);
    }
    (state, size)
}
