//! The motion of one coordinate between two positions: a [`table`](super::table) in arrays of fixed size.
//!
//! With `z = (x, x', 1, cos h tau, sin h tau)`, the end of an interval is met in three steps: the distances from it at the ends of
//! all cells at once, the first cell that may hold a meeting ([`search`](super::search), equation (1)), and the zero in it. Where
//! the distance is monotone over that cell, or its curvature has one sign there, as its coefficients prove, the zero is found by
//!
//! ```text
//! s  <-  s - d d' / (d'^2 - d d'' / 2)                                                                        (1)
//! ```
//!
//! from the secant or from the parabola about the middle, and one step of Newton's method; otherwise by
//! [`crossing`](super::crossing).
//!
//! Source of (1): Halley (1694); see Traub (1964), Iterative Methods for the Solution of Equations, section 5.21.

use super::crossing;
use super::table::{self, COEFFICIENTS, Polynomial, Table, second_derivative_bound};

/// Entries of `z`.
pub(super) const ORDER: usize = 5;

/// Cells of a table of this order, and their ends.
const CELLS: usize = table::cells(ORDER);
const ENDS: usize = CELLS + 1;

/// Where a table ends, in cells.
pub(super) const RANGE: f64 = CELLS as f64 - 0.5;

/// The last step of Newton's method at most, in cells: its error is the square.
const CONVERGED: f64 = 1e-9;

/// The motion on one interval.
#[derive(Debug, Clone)]
pub(super) struct Interval {
    /// Phase of one cell, and cells per phase.
    pub(super) cell: f64,
    pub(super) density: f64,
    /// `nu / h`: velocity per slope.
    speed: f64,
    /// Angle of the wave over one cell.
    turn: f64,
    /// The coefficients of the position in every cell, by entry of `z`.
    series: Vec<[Polynomial; ORDER]>,
    /// Half of the bound on the second derivative.
    curved: [f64; ORDER],
    /// Cosine and sine of the angle of the wave at the middle of every cell.
    middles: [[f64; 2]; CELLS],
    /// Where it ends.
    ends: Vec<End>,
}

/// An end of an interval.
#[derive(Debug, Clone)]
struct End {
    upper: bool,
    at: f64,
    /// The distance from it at the beginning and at the ends of cells, by entry of `z`; positive inside.
    distances: [[f64; ENDS]; ORDER],
}

/// Where an interval ends: the cell and the place in it, the velocity, and which end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    pub(super) cell: usize,
    pub(super) s: f64,
    pub(super) velocity: f64,
    pub(super) upper: bool,
}

impl Interval {
    pub(super) fn new() -> Self {
        Self {
            cell: 0.0,
            density: 0.0,
            speed: 0.0,
            turn: 0.0,
            series: vec![[[0.0; COEFFICIENTS]; ORDER]; CELLS],
            curved: [0.0; ORDER],
            middles: [[0.0; 2]; CELLS],
            ends: Vec::with_capacity(2),
        }
    }

    /// Fills it from a table, for the harmonic of the wave and the base frequency.
    pub(super) fn fill(
        &mut self,
        table: &Table,
        harmonic: f64,
        base: f64,
        [lower, upper]: [f64; 2],
    ) {
        self.cell = table.cell;
        self.density = 1.0 / table.cell;
        self.speed = base / table.cell;
        self.turn = harmonic * table.cell;
        let mut positions = [[0.0; ENDS]; ORDER];
        positions[0][0] = 1.0;
        self.curved = [0.0; ORDER];
        let cells = table.series.chunks_exact(table.order);
        for (cell, (entries, from)) in self.series.iter_mut().zip(cells).enumerate() {
            entries[..table.order].copy_from_slice(from);
            for (m, polynomial) in entries.iter().enumerate() {
                positions[m][cell + 1] = value(polynomial, 0.5);
                let half = 0.5 * second_derivative_bound(polynomial);
                self.curved[m] = self.curved[m].max(half);
            }
            let (sine, cosine) = (self.turn * cell as f64).sin_cos();
            self.middles[cell] = [cosine, sine];
        }
        self.ends.clear();
        for (at, upper) in [(lower, false), (upper, true)] {
            if at.is_finite() {
                let sign = if upper { -1.0 } else { 1.0 };
                let mut distances = positions.map(|entries| entries.map(|x| sign * x));
                distances[2].iter_mut().for_each(|x| *x -= sign * at);
                self.ends.push(End {
                    upper,
                    at,
                    distances,
                });
            }
        }
    }

    /// The first meeting with an end within a range, in cells. `begins`: the motion may begin at an end.
    #[inline]
    pub(super) fn meeting(&self, z: &[f64; ORDER], range: f64, begins: bool) -> Option<Meeting> {
        let sizes = self.curved.iter().zip(z);
        let curved: f64 = sizes.map(|(bound, x)| bound * x.abs()).sum();
        let mut first = None;
        let mut range = range;
        for end in &self.ends {
            if let Some(meeting) = self.meeting_with(end, z, range, curved, begins) {
                range = meeting.cell as f64 + meeting.s;
                first = Some(meeting);
            }
        }
        first
    }

    /// The first meeting with one end.
    #[inline]
    fn meeting_with(
        &self,
        end: &End,
        z: &[f64; ORDER],
        range: f64,
        curved: f64,
        begins: bool,
    ) -> Option<Meeting> {
        let table = &end.distances;
        let mut distances = [0.0; ENDS];
        for (j, distance) in distances.iter_mut().enumerate() {
            *distance = (table[2][j] + table[0][j] * z[0])
                + (table[1][j] * z[1] + table[3][j] * z[3])
                + table[4][j] * z[4];
        }
        // Without branches; a number that is none shows nothing.
        let is_open = |a: f64, b: f64, bound: f64| {
            1 - (u32::from(a >= 0.0) & u32::from(b > 0.0) & u32::from(a + b > bound))
        };
        let mut open = is_open(distances[0], distances[1], 0.25 * curved);
        for cell in 1..CELLS {
            open |= is_open(distances[cell], distances[cell + 1], curved) << cell;
        }
        while open != 0 {
            let cell = open.trailing_zeros() as usize;
            open &= open - 1;
            if cell as f64 - 0.5 >= range {
                return None;
            }
            let pair = [distances[cell], distances[cell + 1]];
            let begins = begins && cell == 0 && z[0] == end.at;
            if let Some((s, slope)) = end.zero(cell, &self.series[cell], pair, z, begins) {
                let sign = if end.upper { -1.0 } else { 1.0 };
                return (cell as f64 + s <= range).then_some(Meeting {
                    cell,
                    s,
                    velocity: sign * slope * self.speed,
                    upper: end.upper,
                });
            }
        }
        None
    }

    /// The state at a place in a cell, of a motion that begins at `z`.
    #[inline]
    pub(super) fn state(&self, cell: usize, s: f64, z: &[f64; ORDER]) -> [f64; 2] {
        let p = combine(&self.series[cell], z);
        [value(&p, s), value(&slopes(&p), s) * self.speed]
    }

    /// `z` at a place in a cell, from the state there and from `z` at the beginning.
    #[inline]
    pub(super) fn advance(
        &self,
        cell: usize,
        s: f64,
        state: [f64; 2],
        z: &[f64; ORDER],
    ) -> [f64; ORDER] {
        let ([c, d], [e, f]) = (self.middles[cell], small_angle(self.turn * s));
        let (cosine, sine) = (z[3] * c - z[4] * d, z[4] * c + z[3] * d);
        [
            state[0],
            state[1],
            1.0,
            cosine * e - sine * f,
            sine * e + cosine * f,
        ]
    }

    /// Moves perturbations.
    #[inline]
    pub(super) fn advance_columns(&self, cell: usize, s: f64, columns: &mut [[f64; 2]]) {
        let series = &self.series[cell];
        for column in columns {
            let mut p = [0.0; COEFFICIENTS];
            for (k, x) in p.iter_mut().enumerate() {
                *x = series[0][k] * column[0] + series[1][k] * column[1];
            }
            *column = [value(&p, s), value(&slopes(&p), s) * self.speed];
        }
    }

    /// Whether the acceleration is positive at the beginning of a motion.
    pub(super) fn accelerates_up(&self, z: &[f64; ORDER]) -> bool {
        crossing::derivatives(&combine(&self.series[0], z), 0.0)[2] > 0.0
    }
}

impl End {
    /// The first zero of a distance in a cell, and its slope there.
    #[inline]
    fn zero(
        &self,
        cell: usize,
        series: &[Polynomial; ORDER],
        [a, b]: [f64; 2],
        z: &[f64; ORDER],
        begins: bool,
    ) -> Option<(f64, f64)> {
        let sign = if self.upper { -1.0 } else { 1.0 };
        let mut p = combine(series, z).map(|x| sign * x);
        p[0] -= sign * self.at;
        let from = if cell == 0 { 0.0 } else { -0.5 };
        let monotone = p[1].abs() > crossing::slope_variation(&p);
        // Its curvature has one sign; with that of the chord it has one zero.
        let curved = 4.0 * p[2].abs() > second_derivative_bound(&p);
        let rises = monotone && p[1] > 0.0;
        if a >= 0.0 && b >= 0.0 && (rises || (curved && p[2] < 0.0)) {
            return None;
        }
        if a >= 0.0 && b < 0.0 && (monotone || curved) && !begins {
            let guess = if monotone {
                0.5 - (0.5 - from) * b / (b - a)
            } else {
                falling_zero_of_parabola(&p).clamp(from, 0.5)
            };
            let falls = |&(s, slope): &(f64, f64)| s >= from && slope < 0.0;
            if let Some(found) = halley(&p, guess).filter(falls) {
                return Some(found);
            }
        }
        self.slow_zero(cell, &p, z, begins)
    }

    /// The same where the motion may turn within the cell.
    #[cold]
    fn slow_zero(
        &self,
        cell: usize,
        p: &Polynomial,
        z: &[f64; ORDER],
        begins: bool,
    ) -> Option<(f64, f64)> {
        let columns = self.distances.iter().zip(z);
        let sizes = columns.map(|(ends, x)| (ends[cell].abs() + ends[cell + 1].abs()) * x.abs());
        let noise = 4.0 * f64::EPSILON * sizes.sum::<f64>();
        let from = if cell == 0 { 0.0 } else { -0.5 };
        let s = crossing::first_zero(p, from, 0.5, begins, noise)?;
        Some((s, crossing::value_and_slope(p, s).1))
    }
}

/// The cell that a phase lies in, in cells, and where in it.
pub(super) fn place(cells: f64) -> (usize, f64) {
    let cell = ((cells + 0.5) as usize).min(CELLS - 1);
    (cell, cells - cell as f64)
}

/// The polynomial of a motion.
#[inline(always)]
#[allow(clippy::inline_always, reason = "the sums stay in registers")]
fn combine(series: &[Polynomial; ORDER], z: &[f64; ORDER]) -> Polynomial {
    let mut sum = [0.0; COEFFICIENTS];
    for (k, sum) in sum.iter_mut().enumerate() {
        *sum = (series[2][k] + series[0][k] * z[0])
            + (series[1][k] * z[1] + series[3][k] * z[3])
            + series[4][k] * z[4];
    }
    sum
}

/// The coefficients of the derivative.
#[inline(always)]
#[allow(clippy::inline_always, reason = "as above")]
fn slopes(p: &Polynomial) -> Polynomial {
    let mut q = [0.0; COEFFICIENTS];
    for k in 1..COEFFICIENTS {
        q[k - 1] = k as f64 * p[k];
    }
    q
}

/// The value of a polynomial, in an order in which few operations wait for each other (Estrin 1960).
#[inline(always)]
#[allow(clippy::inline_always, reason = "as above")]
fn value(p: &Polynomial, s: f64) -> f64 {
    let (s2, pair) = (s * s, |k: usize| p[k] + p[k + 1] * s);
    let s4 = s2 * s2;
    let four = |k: usize| pair(k) + pair(k + 2) * s2;
    (four(0) + four(4) * s4) + (four(8) + p[12] * s4) * (s4 * s4)
}

/// The zero of a polynomial that is monotone over the cell, and the slope there; `None` if the iteration has not converged.
///
/// Three steps without a bracket, unlike the root finders of [`numeric`](crate::numeric): the proof is that there is one zero, the last
/// step shows that it was found, and all of a motion's time is spent here.
#[inline(always)]
#[allow(clippy::inline_always, reason = "as above")]
fn halley(p: &Polynomial, guess: f64) -> Option<(f64, f64)> {
    let q = slopes(p);
    let mut s = guess;
    for _ in 0..2 {
        let (d, slope) = (value(p, s), value(&q, s));
        let half_curvature = p[2] + 3.0 * p[3] * s + 6.0 * p[4] * (s * s);
        s -= d * slope / (slope * slope - d * half_curvature);
    }
    let step = value(p, s) / value(&q, s);
    s -= step;
    (step.abs() <= CONVERGED && s <= 0.5).then(|| (s, value(&q, s)))
}

/// The zero of the parabola about the middle at which it falls; its vertex if it has none.
#[inline(always)]
#[allow(clippy::inline_always, reason = "as above")]
fn falling_zero_of_parabola(p: &Polynomial) -> f64 {
    let root = (p[1] * p[1] - 4.0 * p[0] * p[2]).max(0.0).sqrt();
    if p[1] > 0.0 {
        (p[1] + root) / (-2.0 * p[2])
    } else {
        2.0 * p[0] / (root - p[1])
    }
}

/// Cosine and sine of an angle of at most half a cell: the first terms left out are below `4e-17`.
#[inline(always)]
#[allow(clippy::inline_always, reason = "as above")]
fn small_angle(angle: f64) -> [f64; 2] {
    let u = angle * angle;
    let cosine = 1.0
        + u * (-1.0 / 2.0
            + u * (1.0 / 24.0 + u * (-1.0 / 720.0 + u * (1.0 / 40_320.0 - u / 3_628_800.0))));
    let sine = angle
        * (1.0
            + u * (-1.0 / 6.0
                + u * (1.0 / 120.0
                    + u * (-1.0 / 5040.0 + u * (1.0 / 362_880.0 - u / 39_916_800.0)))));
    [cosine, sine]
}
