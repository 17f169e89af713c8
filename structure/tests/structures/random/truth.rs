//! What is true of a periodic orbit of a drawn structure: extremes and multipliers, each with an error of its own.
//!
//! The orbit is the state that its motion comes back to, by Newton's method with the matrix of the linearised motion (single shooting). What
//! motions are exact to is told by others to a looser tolerance.

use std::f64::consts::TAU;

use hertzian::Complex;
use nalgebra::{DMatrix, DVector};

use super::draw::Drawn;
use super::motion::{Course, Lost, Motions};

/// Of motions, relative to the size of the orbit.
const TOLERANCE: f64 = 1e-13;
/// The matrix by which states are corrected comes of motions to a looser one, and what motions are exact to of others.
const CORRECTING: f64 = 1e-9;
const OTHER: f64 = 1e-11;
/// How far another state is from the orbit, relative to the sizes.
const ASIDE: f64 = 1e-8;
/// This part of what changes with the other tolerance, a hundred times as large, is taken for an error: errors may fall with half a power of
/// the tolerance.
const PART: f64 = 0.3;
const CORRECTIONS: usize = 12;
/// A correction of the state below this is none.
const CLOSED: f64 = 1e-11;
/// From this on a multiplier is too large for a single segment.
const GROWTH: f64 = 1e5;
/// Slower meetings of gap and level, relative to the rates of the orbit, are touches: a motion beside it may not meet it.
const TOUCH: f64 = 1e-4;
/// Directions in which nothing holds the structure have singular values below this part of the largest.
const FREE: f64 = 1e-9;

/// A periodic orbit.
#[derive(Debug, Clone)]
pub struct Truth {
    /// How far the state was from it, relative to its size.
    pub correction: f64,
    /// Error of the state, relative to its size.
    pub error: f64,
    /// Of everything that is watched.
    pub extremes: Vec<[f64; 2]>,
    /// Of an extreme, as a part of the sum of sizes of what makes it up.
    pub extreme_error: f64,
    /// Largest modulus first.
    pub multipliers: Vec<Complex<f64>>,
    pub multiplier_error: f64,
}

impl Truth {
    /// Its multipliers without those of so many rigid motions, which are one.
    pub fn elastic(&self, rigid: usize) -> Vec<Complex<f64>> {
        let mut known = self.multipliers.clone();
        for _ in 0..rigid {
            let one = |i: &usize| (known[*i] - 1.0).norm();
            if let Some(i) = hertzian_tests::nearest(0..known.len(), 0.0, one) {
                known.remove(i);
            }
        }
        known
    }
}

/// Why nothing is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unsure {
    /// A motion beside the orbit cannot be computed.
    Lost(Lost),
    /// A multiplier is one, to what is known of it.
    Singular,
    /// A multiplier is too large.
    Growing,
    /// Motions beside it meet a level that it barely meets.
    Touching,
    /// States came nearer to none: this far it was from coming back at the end, relative to the size.
    Open(f64),
}

impl From<Lost> for Unsure {
    fn from(lost: Lost) -> Self {
        Self::Lost(lost)
    }
}

/// An orbit that is looked for.
pub struct Question<'d> {
    pub drawn: &'d Drawn,
    pub watched: &'d DMatrix<f64>,
    pub omega: f64,
    /// In periods of the excitation.
    pub period: usize,
}

impl Question<'_> {
    /// The orbit near a state.
    pub fn truth(&self, guess: &DVector<f64>) -> Result<Truth, Unsure> {
        let time = TAU * self.period as f64 / self.omega;
        let motions =
            |sizes, tolerance| Motions::of(self.drawn, self.watched, self.omega, sizes, tolerance);
        // How large it is, to begin with, and then as it is.
        let first = self.sizes(guess, time)?;
        let there = motions(first, TOLERANCE);
        let start = motions(first, CORRECTING).course(guess, time, true)?;
        if multipliers(&start)[0].norm() > GROWTH {
            return Err(Unsure::Growing);
        }
        let closed = self.closed(&there, guess, &start, time)?;
        let course = there.course(&closed, time, true)?;
        if course.slowest < TOUCH {
            return Err(Unsure::Touching);
        }
        let loose = motions(first, OTHER);
        let other = loose.course(&closed, time, false)?;
        // Where a level is met slowly multipliers depend much on the state.
        let aside = DVector::from_fn(closed.len(), |i, _| {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            closed[i] + sign * ASIDE * first[usize::from(i >= self.drawn.size())]
        });
        let beside = loose.course(&aside, time, true)?;
        let left = self.scaled(&(&course.state - &closed), first);
        let apart = self.scaled(&(&course.state - &other.state), first);
        let inverse = self.inverse(&course).ok_or(Unsure::Singular)?;
        let error = row_sum(&self.relative(&inverse, first)) * (left + PART * apart + TOLERANCE);
        let matrix = course.beside.as_ref().ok_or(Unsure::Singular)?;
        let grown = row_sum(&self.relative(matrix, first)).max(1.0);
        let found = multipliers(&course);
        let changed = hertzian_tests::distance(&found, &multipliers(&beside));
        let size = found[0].norm().max(1.0);
        Ok(Truth {
            correction: self.scaled(&(&closed - guess), first),
            error,
            extreme_error: 4.0 * grown * error * first[0],
            extremes: course.extremes,
            multipliers: found,
            multiplier_error: (PART + error / ASIDE) * changed + 1e-9 * size,
        })
    }

    /// Sizes of coordinates and rates over the period.
    fn sizes(&self, state: &DVector<f64>, time: f64) -> Result<[f64; 2], Lost> {
        let n = self.drawn.size();
        let all = DMatrix::identity(n, n);
        let rate = state.rows(n, n).amax();
        let guess = state.rows(0, n).amax().max(rate / self.omega).max(1e-12);
        let sizes = [guess, guess * self.omega];
        let course =
            Motions::of(self.drawn, &all, self.omega, sizes, 1e-6).course(state, time, false)?;
        let extremes = course.extremes.iter();
        let size = extremes.fold(0.0, |size: f64, [least, most]| {
            size.max(0.5 * (most - least))
        });
        let size = size.max(1e-12);
        Ok([size, size * self.omega])
    }

    /// The largest entry of a state relative to sizes.
    fn scaled(&self, state: &DVector<f64>, sizes: [f64; 2]) -> f64 {
        let n = self.drawn.size();
        let parts = state.iter().enumerate();
        parts.fold(0.0, |most, (entry, x)| {
            most.max((x / sizes[usize::from(entry >= n)]).abs())
        })
    }

    /// A matrix that takes states to states, relative to sizes.
    fn relative(&self, matrix: &DMatrix<f64>, sizes: [f64; 2]) -> DMatrix<f64> {
        let n = self.drawn.size();
        let size = |entry: usize| sizes[usize::from(entry >= n)];
        DMatrix::from_fn(2 * n, 2 * n, |i, j| matrix[(i, j)] * size(j) / size(i))
    }

    /// Of one less the matrix of the linearised motion; where nothing holds the structure, in the directions that are held.
    fn inverse(&self, course: &Course) -> Option<DMatrix<f64>> {
        let matrix = course.beside.as_ref()?;
        let (n, _) = matrix.shape();
        let open = DMatrix::identity(n, n) - matrix;
        if self.drawn.held {
            open.try_inverse()
        } else {
            let largest = open.amax();
            open.pseudo_inverse(FREE * largest).ok()
        }
    }

    /// The state that comes back.
    fn closed(
        &self,
        there: &Motions<'_>,
        guess: &DVector<f64>,
        start: &Course,
        time: f64,
    ) -> Result<DVector<f64>, Unsure> {
        let sizes = there.sizes;
        let (mut state, mut after) = (guess.clone(), there.course(guess, time, false)?.state);
        let mut inverse = self.inverse(start).ok_or(Unsure::Singular)?;
        let mut fresh = true;
        let mut was = self.scaled(&(&after - &state), sizes);
        for _ in 0..CORRECTIONS {
            let by = &inverse * (&after - &state);
            let next = &state + &by;
            let course = there.course(&next, time, false)?;
            let left = self.scaled(&(&course.state - &next), sizes);
            let correction = self.scaled(&by, sizes);
            if left > 0.3 * was && left > CLOSED {
                if fresh && left >= was {
                    return Err(Unsure::Open(was));
                }
                let from = if left < was { next } else { state.clone() };
                let again = there.course(&from, time, true)?;
                inverse = self.inverse(&again).ok_or(Unsure::Singular)?;
                (state, after) = (from, again.state);
                was = was.min(left);
                fresh = true;
                continue;
            }
            (state, after) = (next, course.state);
            was = left;
            fresh = false;
            if correction < CLOSED || left < 0.1 * CLOSED {
                return Ok(state);
            }
        }
        if was < CLOSED {
            Ok(state)
        } else {
            Err(Unsure::Open(was))
        }
    }
}

fn row_sum(matrix: &DMatrix<f64>) -> f64 {
    let sums = matrix.row_iter().map(|row| row.abs().sum());
    sums.fold(0.0, f64::max)
}

/// Of a course with what is beside it.
fn multipliers(course: &Course) -> Vec<Complex<f64>> {
    let matrix = course.beside.as_ref();
    let mut values: Vec<_> = matrix.map_or_else(Vec::new, |matrix| {
        matrix.complex_eigenvalues().iter().copied().collect()
    });
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    values
}
