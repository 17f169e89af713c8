//! Motions of a drawn structure in all of its coordinates, and of what is beside them, by a method that shares no code with the library.
//!
//! ```text
//! M q'' + C q' + K q + sum_c e_c f_c(d_c . q - delta_c, d_c . q') = b(t)                                      (1)
//! X' = A X,    A = [0, 1; -M^-1 (K + sum_c f_c,g e_c d_c^T), -M^-1 (C + sum_c f_c,r e_c d_c^T)]               (2)
//! ```
//!
//! Steps are those of Prince and Dormand ([`hertzian_tests::tableau`]), for the state and for the matrix `X` of the linearised motion. A step
//! ends where a gap meets a level: it is taken again, shorter, until it ends there to rounding. Where the force jumps there so does `X`:
//!
//! ```text
//! X+ = X- - [0; M^-1 e_c (f_c+ - f_c-)] (d_c^T X-) / (d_c . q')                                               (3)
//! ```
//!
//! Source of (3): Aizerman and Gantmakher (1958), Quart. J. Mech. Appl. Math. 11, 225.

use std::f64::consts::TAU;

use hertzian_tests::tableau::{A, B, C, LOWER, STAGES};
use nalgebra::{DMatrix, DVector};

use super::borders::root;
use super::draw::Drawn;
use super::laws::Force;

/// Steps of one motion at most.
const STEPS: usize = 200_000;
/// Steps in a period at least.
const LEAST: f64 = 24.0;
/// The matrix of the linearised motion is known to so many times the tolerance.
const LOOSER: f64 = 1e2;

/// A structure at a frequency.
pub struct Motions<'d> {
    drawn: &'d Drawn,
    omega: f64,
    /// `M^-1 [K, C]`
    linear: DMatrix<f64>,
    /// Harmonics of loads with cosine and sine of `M^-1 b`.
    loads: Vec<(f64, [DVector<f64>; 2])>,
    /// `M^-1 e` of each contact.
    pushed: Vec<DVector<f64>>,
    pub levels: Vec<Vec<f64>>,
    /// Sizes of coordinates and of rates.
    pub sizes: [f64; 2],
    pub tolerance: f64,
    /// What is watched: a row each.
    watched: &'d DMatrix<f64>,
}

/// Where a motion went.
#[derive(Debug, Clone)]
pub struct Course {
    pub state: DVector<f64>,
    /// Of the linearised motion, where that was asked for.
    pub beside: Option<DMatrix<f64>>,
    /// Smallest and largest value of everything that is watched.
    pub extremes: Vec<[f64; 2]>,
    /// Smallest rate of a gap at a level, relative to the largest rate.
    pub slowest: f64,
}

/// Why there is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost {
    /// It grew without bound, or was no number.
    Diverged,
    /// It took too many steps.
    Long,
}

/// A step from a state at a time.
pub struct Step {
    pub time: f64,
    pub from: DVector<f64>,
    pub pieces: Vec<usize>,
}

/// A step that was taken: the state behind it, its error over the tolerance, and the states of its stages.
pub struct Taken {
    pub to: DVector<f64>,
    error: f64,
    stages: Vec<DVector<f64>>,
}

impl<'d> Motions<'d> {
    pub fn of(
        drawn: &'d Drawn,
        watched: &'d DMatrix<f64>,
        omega: f64,
        sizes: [f64; 2],
        tolerance: f64,
    ) -> Self {
        let n = drawn.size();
        let inverse = drawn.mass.clone().try_inverse().expect("a positive mass");
        let mut linear = DMatrix::zeros(n, 2 * n);
        linear
            .columns_mut(0, n)
            .copy_from(&(&inverse * &drawn.stiffness));
        linear
            .columns_mut(n, n)
            .copy_from(&(&inverse * drawn.damping_at(omega)));
        let loads = drawn.loads.iter().map(|load| {
            let parts = drawn.force(load, omega).map(|part| &inverse * part);
            (f64::from(load.harmonic), parts)
        });
        Self {
            drawn,
            omega,
            linear,
            loads: loads.collect(),
            pushed: drawn
                .contacts
                .iter()
                .map(|contact| &inverse * &contact.force)
                .collect(),
            levels: drawn
                .contacts
                .iter()
                .map(|contact| contact.law.levels())
                .collect(),
            sizes,
            tolerance,
            watched,
        }
    }

    fn size(&self, entry: usize) -> f64 {
        self.sizes[usize::from(entry >= self.drawn.size())]
    }

    /// Before anything moves.
    fn begun(&self, state: &DVector<f64>, beside: bool) -> Course {
        let n = self.drawn.size();
        Course {
            state: state.clone(),
            beside: beside.then(|| DMatrix::identity(2 * n, 2 * n)),
            extremes: self.seen(state, 0).iter().map(|x| [*x; 2]).collect(),
            slowest: f64::INFINITY,
        }
    }

    /// The motion from a state at time zero on, with what is beside it.
    pub fn course(&self, state: &DVector<f64>, time: f64, beside: bool) -> Result<Course, Lost> {
        let mut course = self.begun(state, beside);
        let end = time;
        let largest = f64::min(TAU / self.omega, end) / LEAST;
        let mut here = Step {
            time: 0.0,
            from: state.clone(),
            pieces: self.pieces(state),
        };
        let mut step = 0.1 * largest;
        for _ in 0..STEPS {
            let left = end - here.time;
            if left <= 1e-14 * end {
                return Ok(course);
            }
            let last = step >= left;
            let length = if last { left } else { step };
            let whole = self.step(&here, length);
            let shortest = length < 1e-15 * end;
            if !(whole.error <= 1.0 || shortest && whole.error.is_finite()) {
                if shortest {
                    return Err(Lost::Diverged);
                }
                step = length * shorter(whole.error);
                continue;
            }
            let switch = self.switch(&here, &whole.to, length);
            let (taken, length) = match switch {
                Some((_, _, at)) => (self.step(&here, at), at),
                None => (whole, length),
            };
            let mut error = taken.error;
            if let Some(matrix) = &mut course.beside {
                let (next, of_matrix) = self.moved(&here, &taken.stages, matrix, length);
                if of_matrix > 1.0 && length > 1e-15 * end {
                    step = length * shorter(of_matrix);
                    continue;
                }
                *matrix = next;
                error = error.max(of_matrix);
            }
            self.widen(&here, &taken.to, length, &mut course.extremes);
            let grown = (0.9 * error.max(1e-10).powf(-0.125)).clamp(0.3, 4.0);
            if switch.is_none() {
                step = (length * grown).min(largest);
            }
            here.time = if last && switch.is_none() {
                end
            } else {
                here.time + length
            };
            here.from = taken.to;
            if let Some((contact, piece, _)) = switch {
                self.pass(contact, piece, &mut here, &mut course);
            }
            course.state.copy_from(&here.from);
        }
        Err(Lost::Long)
    }

    /// A gap gets to another piece.
    fn pass(&self, contact: usize, piece: usize, here: &mut Step, course: &mut Course) {
        let n = self.drawn.size();
        let before = self.force(contact, here.pieces[contact], &here.from);
        let after = self.force(contact, piece, &here.from);
        here.pieces[contact] = piece;
        let [_, rate] = self.gap(contact, &here.from);
        course.slowest = course.slowest.min(rate.abs() / self.sizes[1]);
        let jump = (after.value - before.value) / rate;
        if let Some(matrix) = course.beside.as_mut().filter(|_| jump != 0.0) {
            let row = self.drawn.contacts[contact].gap.transpose() * matrix.rows(0, n);
            let change = &self.pushed[contact] * (jump * row);
            let mut below = matrix.rows_mut(n, n);
            below -= change;
        }
    }

    fn seen(&self, state: &DVector<f64>, derivative: usize) -> DVector<f64> {
        let n = self.drawn.size();
        self.watched * state.rows(derivative * n, n)
    }

    /// A gap and its rate.
    pub fn gap(&self, contact: usize, state: &DVector<f64>) -> [f64; 2] {
        let n = self.drawn.size();
        let of = &self.drawn.contacts[contact];
        [
            of.gap.dot(&state.rows(0, n)) - of.offset,
            of.gap.dot(&state.rows(n, n)),
        ]
    }

    fn force(&self, contact: usize, piece: usize, state: &DVector<f64>) -> Force {
        let [gap, rate] = self.gap(contact, state);
        self.drawn.contacts[contact].law.force(piece, gap, rate)
    }

    /// The piece of every contact; on a level the one that the gap moves to.
    fn pieces(&self, state: &DVector<f64>) -> Vec<usize> {
        let of = |(contact, levels): (usize, &Vec<f64>)| {
            let [value, rate] = self.gap(contact, state);
            let above = |level: &&f64| value > **level || value == **level && rate > 0.0;
            levels.iter().filter(above).count()
        };
        self.levels.iter().enumerate().map(of).collect()
    }

    fn slope(&self, time: f64, state: &DVector<f64>, pieces: &[usize]) -> DVector<f64> {
        let n = self.drawn.size();
        let mut slope = DVector::zeros(2 * n);
        let (rates, acceleration) = slope.as_mut_slice().split_at_mut(n);
        rates.copy_from_slice(&state.as_slice()[n..]);
        for (x, column) in state.iter().zip(self.linear.as_slice().chunks_exact(n)) {
            add(acceleration, -x, column);
        }
        for (harmonic, [cosine, sine]) in &self.loads {
            let (s, c) = (harmonic * self.omega * time).sin_cos();
            add(acceleration, c, cosine.as_slice());
            add(acceleration, s, sine.as_slice());
        }
        for (contact, &piece) in pieces.iter().enumerate() {
            let force = self.force(contact, piece, state);
            add(acceleration, -force.value, self.pushed[contact].as_slice());
        }
        slope
    }

    pub fn step(&self, here: &Step, length: f64) -> Taken {
        let mut slopes: Vec<DVector<f64>> = Vec::with_capacity(STAGES);
        let mut stages = Vec::with_capacity(STAGES);
        for stage in 0..STAGES {
            let mut state = here.from.clone();
            for (slope, weight) in slopes.iter().zip(&A[stage]) {
                add(state.as_mut_slice(), length * weight, slope.as_slice());
            }
            slopes.push(self.slope(here.time + C[stage] * length, &state, &here.pieces));
            stages.push(state);
        }
        let mut to = here.from.clone();
        let mut error = DVector::zeros(to.len());
        for (stage, slope) in slopes.iter().enumerate() {
            let of_lower = B[stage] - LOWER[stage];
            add(to.as_mut_slice(), length * B[stage], slope.as_slice());
            add(error.as_mut_slice(), length * of_lower, slope.as_slice());
        }
        let parts = error.iter().enumerate();
        let worst = parts.fold(0.0, |worst: f64, (entry, error)| {
            let error = (error / (self.tolerance * self.size(entry))).abs();
            // A number that is none is not lost.
            if error <= worst { worst } else { error }
        });
        Taken {
            to,
            error: worst,
            stages,
        }
    }

    /// (2) over a step, and its error over the tolerance.
    fn moved(
        &self,
        here: &Step,
        stages: &[DVector<f64>],
        matrix: &DMatrix<f64>,
        length: f64,
    ) -> (DMatrix<f64>, f64) {
        let n = self.drawn.size();
        let mut slopes: Vec<DMatrix<f64>> = Vec::with_capacity(STAGES);
        for (stage, state) in stages.iter().enumerate() {
            let mut moved = matrix.clone();
            for (slope, weight) in slopes.iter().zip(&A[stage]) {
                add(moved.as_mut_slice(), length * weight, slope.as_slice());
            }
            let mut linear = self.linear.clone();
            for (contact, &piece) in here.pieces.iter().enumerate() {
                let force = self.force(contact, piece, state);
                let row = &self.drawn.contacts[contact].gap;
                for (first, slope) in [(0, force.by_gap), (n, force.by_rate)] {
                    if slope != 0.0 {
                        linear
                            .columns_mut(first, n)
                            .ger(slope, &self.pushed[contact], row, 1.0);
                    }
                }
            }
            let mut slope = DMatrix::zeros(2 * n, 2 * n);
            slope.rows_mut(0, n).copy_from(&moved.rows(n, n));
            slope.rows_mut(n, n).gemm(-1.0, &linear, &moved, 0.0);
            slopes.push(slope);
        }
        let mut to = matrix.clone();
        let mut error = DMatrix::zeros(2 * n, 2 * n);
        for (stage, slope) in slopes.iter().enumerate() {
            let of_lower = B[stage] - LOWER[stage];
            add(to.as_mut_slice(), length * B[stage], slope.as_slice());
            add(error.as_mut_slice(), length * of_lower, slope.as_slice());
        }
        let largest = self.scaled(&to).max(1.0);
        let error = self.scaled(&error) / (LOOSER * self.tolerance * largest);
        (to, error)
    }

    /// The largest entry of a matrix of the linearised motion, relative to the sizes.
    fn scaled(&self, matrix: &DMatrix<f64>) -> f64 {
        let n = self.drawn.size();
        let mut most = 0.0_f64;
        for (j, column) in matrix.as_slice().chunks_exact(2 * n).enumerate() {
            for (part, size) in column.chunks_exact(n).zip(self.sizes) {
                let factor = self.size(j) / size;
                for x in part {
                    let entry = (x * factor).abs();
                    // A number that is none is not lost.
                    most = if entry <= most { most } else { entry };
                }
            }
        }
        most
    }

    /// Takes what is seen at the end of a step in, and the extremes within.
    fn widen(&self, here: &Step, to: &DVector<f64>, length: f64, extremes: &mut [[f64; 2]]) {
        let [before, after] =
            [&here.from, to].map(|state| [self.seen(state, 0), self.seen(state, 1)]);
        for (i, [least, most]) in extremes.iter_mut().enumerate() {
            let mut include = |x: f64| {
                *least = least.min(x);
                *most = most.max(x);
            };
            include(after[0][i]);
            let [begin, end] = [before[1][i], after[1][i]];
            if begin * end >= 0.0 {
                continue;
            }
            // No value within is farther out than the slopes at both ends allow.
            let ends = [before[0][i], after[0][i]];
            let reach = length * begin.abs().max(end.abs());
            let beyond = if begin > 0.0 {
                ends[0].max(ends[1]) + reach > *most
            } else {
                ends[0].min(ends[1]) - reach < *least
            };
            if beyond {
                let rate = |time: f64| self.seen_once(i, 1, &self.step(here, time).to);
                let at = root((0.0, begin), (length, end), rate);
                let extremum = self.seen_once(i, 0, &self.step(here, at).to);
                *least = least.min(extremum);
                *most = most.max(extremum);
            }
        }
    }

    fn seen_once(&self, watched: usize, derivative: usize, state: &DVector<f64>) -> f64 {
        let n = self.drawn.size();
        let row = self.watched.row(watched);
        row.iter()
            .zip(state.rows(derivative * n, n).iter())
            .map(|(a, x)| a * x)
            .sum()
    }
}

/// By what a step is multiplied that has an error of so many times the tolerance.
fn shorter(error: f64) -> f64 {
    if error.is_finite() {
        (0.9 * error.powf(-0.125)).clamp(0.1, 0.8)
    } else {
        0.1
    }
}

/// Adds so many times a column. Written out, since without optimisation it is faster than what packages have.
fn add(to: &mut [f64], factor: f64, column: &[f64]) {
    if factor == 0.0 {
        return;
    }
    for (x, y) in to.iter_mut().zip(column) {
        *x += factor * y;
    }
}
