//! Floquet modes of a reduced structure at an orbit, and modes adjoint to them.
//!
//! Beside an orbit the vectors `q` move by
//!
//! ```text
//! q'' + D q' + diag(w^2) q + sum_c b_c (k_c d_c . q + r_c d_c . q') = 0                                       (1)
//! ```
//!
//! with what contacts are there ([`crate::gaps`]), which is constant over each of equal times here. Of a multiplier `mu = exp(s T)` the motion
//! `x(t) = (q, q')` and the adjoint one `y(t)`, with `y . x = 1` at all times, are those of eigenvectors of the matrix of a period and
//! of its transpose. A force `f(t)` that a motion `x` makes besides those in (1) changes the exponent by
//!
//! ```text
//! ds = (1 / T) integral of y_v(t) . f(t) dt                                                                   (2)
//! ```
//!
//! where `y_v` is the part of `y` that belongs to rates.
//!
//! Source: Yakubovich and Starzhinskii (1975), Linear Differential Equations with Periodic Coefficients, chapter IV (changes of multipliers).

use std::f64::consts::TAU;

use hertzian::structure::DMatrix;
use hertzian::{Cancel, Complex};

use crate::arms::Arm;
use crate::gaps::{Slopes, TIMES};
use crate::reduced::Reduced;

/// Inverse iterations for the eigenvectors of a multiplier that is known.
const ITERATIONS: usize = 4;
/// A multiplier is moved by this part of it, so that there is an inverse.
const ASIDE: f64 = 1e-9;
/// More vectors take longer than what they tell is worth.
const MOST: usize = 60;

/// A Floquet mode, without the growth `exp(s t)`, at all times.
#[derive(Debug)]
pub(crate) struct Mode {
    /// Its multiplier by (1).
    pub(crate) multiplier: Complex<f64>,
    /// `s`
    pub(crate) exponent: Complex<f64>,
    /// What part of it each vector has: these are one in sum.
    parts: Vec<f64>,
    /// Of all vectors.
    pub(crate) positions: DMatrix<Complex<f64>>,
    pub(crate) rates: DMatrix<Complex<f64>>,
    /// `y_v` of (2).
    pub(crate) adjoint: DMatrix<Complex<f64>>,
}

impl Mode {
    /// The mean of frequencies of vectors by what part of it they have.
    pub(crate) fn frequency(&self, frequencies: &[f64]) -> f64 {
        let parts = self.parts.iter().zip(frequencies);
        parts.map(|(part, frequency)| part.abs() * frequency).sum()
    }

    /// What part of it these vectors have.
    pub(crate) fn share(&self, has: impl Fn(usize) -> bool) -> f64 {
        let parts = self.parts.iter().enumerate();
        let those = parts.filter(|(vector, _)| has(*vector));
        those.map(|(_, part)| part).sum::<f64>().abs()
    }
}

/// What takes motions beside an orbit through its period.
#[derive(Debug)]
pub(crate) struct Propagation {
    period: f64,
    /// Units of positions by vectors.
    units: Vec<f64>,
    /// Through half of the time around each.
    halves: Vec<DMatrix<f64>>,
    /// Through the period.
    whole: DMatrix<f64>,
}

impl Propagation {
    /// Of (1); none where there are too many vectors, what a contact is has no bound, or it is cancelled.
    pub(crate) fn of(
        reduced: &Reduced,
        damping: &DMatrix<f64>,
        contacts: &[Slopes],
        arms: &[Vec<Arm>],
        base: f64,
        cancel: &Cancel,
    ) -> Option<Self> {
        let m = reduced.vectors();
        if m > MOST {
            return None;
        }
        let period = TAU / base;
        let units: Vec<f64> = reduced
            .squares
            .iter()
            .map(|square| square.max(base * base).sqrt())
            .collect();
        let mut halves: Vec<DMatrix<f64>> = Vec::with_capacity(TIMES);
        let mut whole = DMatrix::identity(2 * m, 2 * m);
        let turns = arms.iter().any(|arms| arms.len() > 1);
        let mut before: Option<Vec<[f64; 2]>> = None;
        for time in 0..TIMES {
            if cancel.is_cancelled() {
                return None;
            }
            let now = contacts.iter();
            let now: Vec<_> = now.map(|of| [of.by_gap[time], of.by_rate[time]]).collect();
            let is_same = before.as_ref() == Some(&now)
                && (!turns || now.iter().flatten().all(|slope| *slope == 0.0));
            let same = halves.last().filter(|_| is_same);
            let half = if let Some(same) = same {
                same.clone()
            } else {
                let mut slope = free(reduced, damping, &units);
                for (arms, slopes) in arms.iter().zip(&now) {
                    push(&mut slope, reduced, &units, arms, *slopes, time);
                }
                if slope.iter().any(|x| !x.is_finite()) {
                    return None;
                }
                (slope * (0.5 * period / TIMES as f64)).exp()
            };
            whole = &half * (&half * whole);
            halves.push(half);
            before = Some(now);
        }
        whole.iter().all(|x| x.is_finite()).then_some(Self {
            period,
            units,
            halves,
            whole,
        })
    }

    /// The mode whose multiplier is the nearest to a number.
    pub(crate) fn mode(&self, near: Complex<f64>) -> Option<Mode> {
        let n = self.whole.nrows();
        let whole = self.whole.map(|x| Complex::new(x, 0.0));
        let shift = DMatrix::identity(n, n) * (near * (1.0 + ASIDE));
        let right = direction(&(&whole - &shift))?;
        let left = direction(&(whole.transpose() - shift))?;
        let product = (left.transpose() * &right)[(0, 0)];
        let multiplier = (left.transpose() * &whole * &right)[(0, 0)] / product;
        let exponent = multiplier.ln() / self.period;
        let left = left / product;
        let found = left.iter().chain(right.iter());
        if !exponent.norm().is_finite() || found.clone().any(|x| !x.norm().is_finite()) {
            return None;
        }
        let (states, adjoint) = self.along(&right, &(left / multiplier), exponent);
        let m = n / 2;
        let part = |i: usize| {
            let terms = (0..TIMES)
                .flat_map(|time| [i, m + i].map(|i| (adjoint[(i, time)] * states[(i, time)]).re));
            terms.sum::<f64>() / TIMES as f64
        };
        let parts = (0..m).map(part).collect();
        let positions = DMatrix::from_fn(m, TIMES, |i, time| states[(i, time)] / self.units[i]);
        Some(Mode {
            multiplier,
            exponent,
            parts,
            positions,
            rates: states.rows(m, m).into_owned(),
            adjoint: adjoint.rows(m, m).into_owned(),
        })
    }

    /// A motion from its beginning on, and an adjoint one back from its end, without the growth.
    fn along(
        &self,
        begin: &DMatrix<Complex<f64>>,
        end: &DMatrix<Complex<f64>>,
        exponent: Complex<f64>,
    ) -> (DMatrix<Complex<f64>>, DMatrix<Complex<f64>>) {
        let n = begin.nrows();
        let after = |time: usize| exponent * (self.period * (time as f64 + 0.5) / TIMES as f64);
        let mut states = DMatrix::zeros(n, TIMES);
        let mut state = real_and_imaginary(begin);
        for (time, half) in self.halves.iter().enumerate() {
            state = half * state;
            let less = (-after(time)).exp();
            for i in 0..n {
                states[(i, time)] = Complex::new(state[(i, 0)], state[(i, 1)]) * less;
            }
            state = half * state;
        }
        let mut adjoint = DMatrix::zeros(n, TIMES);
        let mut state = real_and_imaginary(end);
        for (time, half) in self.halves.iter().enumerate().rev() {
            state = half.tr_mul(&state);
            let more = after(time).exp();
            for i in 0..n {
                adjoint[(i, time)] = Complex::new(state[(i, 0)], state[(i, 1)]) * more;
            }
            state = half.tr_mul(&state);
        }
        (states, adjoint)
    }
}

/// Real and imaginary parts of a column.
fn real_and_imaginary(column: &DMatrix<Complex<f64>>) -> DMatrix<f64> {
    DMatrix::from_fn(column.nrows(), 2, |i, part| {
        let entry = column[(i, 0)];
        if part == 0 { entry.re } else { entry.im }
    })
}

/// The matrix of (1) without contacts, for positions in their units and rates.
fn free(reduced: &Reduced, damping: &DMatrix<f64>, units: &[f64]) -> DMatrix<f64> {
    let m = units.len();
    let mut slope = DMatrix::zeros(2 * m, 2 * m);
    for (i, unit) in units.iter().enumerate() {
        slope[(i, m + i)] = *unit;
        slope[(m + i, i)] = -reduced.squares[i] / unit;
        for j in 0..m {
            slope[(m + i, m + j)] = -damping[(i, j)];
        }
    }
    slope
}

/// Adds a contact with its slopes by gap and rate at a time.
fn push(
    slope: &mut DMatrix<f64>,
    reduced: &Reduced,
    units: &[f64],
    arms: &[Arm],
    [k, r]: [f64; 2],
    time: usize,
) {
    let m = units.len();
    let sum = |row: &dyn Fn(&Arm) -> usize, which: usize| -> Vec<f64> {
        let mut sum = vec![0.0; m];
        for arm in arms {
            let weight = arm.at_time(time)[which];
            let along = &reduced.rows[row(arm)];
            sum.iter_mut()
                .zip(along)
                .for_each(|(sum, x)| *sum += weight * x);
        }
        sum
    };
    let (read, driven) = (&|arm: &Arm| arm.read, &|arm: &Arm| arm.driven);
    let (gap, turned, force) = (sum(read, 0), sum(read, 1), sum(driven, 0));
    for (i, b) in force.iter().enumerate() {
        for (j, (d, by_time)) in gap.iter().zip(&turned).enumerate() {
            slope[(m + i, j)] -= b * (k * d + r * by_time) / units[j];
            slope[(m + i, m + j)] -= b * r * d;
        }
    }
}

/// The direction that a matrix nearly takes to nothing.
fn direction(matrix: &DMatrix<Complex<f64>>) -> Option<DMatrix<Complex<f64>>> {
    let factors = matrix.clone().lu();
    let mut found = DMatrix::from_fn(matrix.nrows(), 1, |i, _| {
        Complex::new(1.0 + 0.1 * (i % 7) as f64, 0.3)
    });
    for _ in 0..ITERATIONS {
        found = factors.solve(&found)?;
        let size = found.norm();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        found /= Complex::new(size, 0.0);
    }
    Some(found)
}
