//! One coordinate under at most one harmonic: the tables of [`table`](super::table) in arrays of fixed size.
//!
//! Every level is then a position, and the pieces are intervals between positions. With `z = (x, x', 1, cos h tau, sin h tau)`, the
//! end of an interval is met in three steps: the distances from it at the ends of all cells at once, the first cell that may hold
//! a meeting ([`search`](super::search), equation (1)), and the zero in it. Where the distance is monotone or concave over that
//! cell, which its coefficients prove, the zero is found by
//!
//! ```text
//! s  <-  s - d d' / (d'^2 - d d'' / 2)                                                                        (1)
//! ```
//!
//! from the secant or from the parabola about the middle, and one step of Newton's method; otherwise by
//! [`crossing`](super::crossing). Waves turn with the motion, from their values at its beginning.
//!
//! Source of (1): Halley (1694); see Traub (1964), Iterative Methods for the Solution of Equations, section 5.21.

use super::crossing;
use super::model::Model;
use super::table::{self, COEFFICIENTS, Polynomial};
use crate::flow::{FlowError, Work};

/// Entries of `z`.
const ORDER: usize = 5;

/// Cells of a table of this order, and their ends.
const CELLS: usize = table::cells(ORDER);
const ENDS: usize = CELLS + 1;

/// Where a table ends, in cells.
const RANGE: f64 = CELLS as f64 - 0.5;

/// The last step of Newton's method at most, in cells: its error is the square.
const CONVERGED: f64 = 1e-9;

/// A system of one coordinate at present values.
#[derive(Debug, Clone)]
pub(super) struct Scalar {
    /// From the lowest positions to the highest.
    intervals: Vec<Interval>,
    /// Between them.
    boundaries: Vec<Boundary>,
    harmonic: f64,
}

/// A position where pieces meet, and how the acceleration changes there in the direction of increasing positions: by a constant
/// and by a multiple of the velocity.
#[derive(Debug, Clone, Copy)]
struct Boundary {
    at: f64,
    constant: f64,
    by_velocity: f64,
}

/// The motion on one interval.
#[derive(Debug, Clone)]
struct Interval {
    /// Phase of one cell, and cells per phase.
    cell: f64,
    density: f64,
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
struct Meeting {
    cell: usize,
    s: f64,
    velocity: f64,
    upper: bool,
}

/// What a motion extends over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// First and last phase.
    pub(super) begin: f64,
    pub(super) end: f64,
    /// The first phase within the first period.
    pub(super) first: f64,
    /// At most one period.
    pub(super) length: f64,
}

impl Scalar {
    /// `None` if the system has more coordinates or harmonics, or a moving offset.
    pub(super) fn new(model: &mut Model<'_>, phase: f64) -> Result<Option<Self>, FlowError> {
        let simple = model.basis.coordinates == 1 && model.basis.harmonics.len() <= 1;
        if !simple || model.moving {
            return Ok(None);
        }
        let boundaries = boundaries(model);
        let mut pieces = vec![0; model.contacts.len()];
        let mut intervals = Vec::new();
        for index in 0..=boundaries.len() {
            let lower = match index {
                0 => f64::NEG_INFINITY,
                _ => boundaries[index - 1].at,
            };
            let upper = boundaries.get(index).map_or(f64::INFINITY, |end| end.at);
            choose_pieces(model, inside(lower, upper), &mut pieces);
            let combination = model.combination(&pieces, phase, false)?;
            let table = &model.at(combination).table;
            intervals.push(Interval::new(model, table, lower, upper));
        }
        Ok(Some(Self {
            intervals,
            boundaries,
            harmonic: model.basis.harmonics.first().map_or(0.0, |&h| f64::from(h)),
        }))
    }

    /// Moves a state, and perturbations of it.
    #[inline]
    pub(super) fn advance(
        &self,
        span: Span,
        state: &mut [f64; 2],
        columns: &mut [[f64; 2]],
        work: &mut Work,
    ) -> Result<(), FlowError> {
        let (sine, cosine) = match span.first {
            0.0 => (0.0, 1.0),
            first => (self.harmonic * first).sin_cos(),
        };
        let mut z = [state[0], state[1], 1.0, cosine, sine];
        let mut index = self.choose(&z);
        let mut begins = true;
        let mut done = 0.0;
        let mut switches = 0;
        loop {
            let interval = &self.intervals[index];
            let left = (span.length - done) * interval.density;
            let range = left.min(RANGE);
            work.steps += 1;
            let Some(meeting) = interval.meeting(&z, range, begins) else {
                let (cell, s) = place(range);
                let next = interval.state(cell, s, &z);
                if !(next[0].is_finite() && next[1].is_finite()) {
                    let phase = span.begin + done;
                    return Err(FlowError::NotFinite { phase });
                }
                *state = next;
                interval.advance_columns(cell, s, columns);
                if range == left {
                    return Ok(());
                }
                z = interval.advance(cell, s, next, &z);
                done += range * interval.cell;
                begins = false;
                continue;
            };
            let Meeting {
                cell,
                s,
                velocity,
                upper,
            } = meeting;
            let boundary = &self.boundaries[index - usize::from(!upper)];
            z = interval.advance(cell, s, [boundary.at, velocity], &z);
            done += (cell as f64 + s) * interval.cell;
            if !columns.is_empty() {
                interval.advance_columns(cell, s, columns);
                boundary.switch(velocity, upper, columns);
            }
            index = if upper { index + 1 } else { index - 1 };
            begins = true;
            switches += 1;
            work.switches += 1;
            if switches > super::MOST_SWITCHES {
                *state = [z[0], z[1]];
                let phase = span.begin + done;
                return Err(FlowError::TooManySwitches { phase, switches });
            }
        }
    }

    /// The interval of a state; at a boundary the one that it is about to enter.
    fn choose(&self, z: &[f64; ORDER]) -> usize {
        let below = |boundary: &&Boundary| boundary.at < z[0];
        let index = self.boundaries.iter().filter(below).count();
        let at = self.boundaries.get(index);
        if at.is_none_or(|boundary| boundary.at != z[0]) {
            return index;
        }
        let rises = z[1] > 0.0 || (z[1] == 0.0 && self.intervals[index + 1].accelerates_up(z));
        index + usize::from(rises)
    }
}

impl Boundary {
    /// The saltation of perturbations, see [`tangent`](super::tangent), equation (1).
    fn switch(&self, velocity: f64, upwards: bool, columns: &mut [[f64; 2]]) {
        let steepness = if self.constant == 0.0 {
            self.by_velocity
        } else {
            self.constant / velocity + self.by_velocity
        };
        let steepness = if upwards { steepness } else { -steepness };
        for column in columns {
            column[1] += steepness * column[0];
        }
    }
}

impl Interval {
    fn new(model: &Model<'_>, table: &table::Table, lower: f64, upper: f64) -> Self {
        let harmonic = model.basis.harmonics.first().map_or(0.0, |&h| f64::from(h));
        let order = table.order;
        let series = table.series.chunks_exact(order).map(|from| {
            let mut entries = [[0.0; COEFFICIENTS]; ORDER];
            entries[..order].copy_from_slice(from);
            entries
        });
        let mut interval = Self {
            cell: table.cell,
            density: 1.0 / table.cell,
            speed: model.terms.base / table.cell,
            turn: harmonic * table.cell,
            series: series.collect(),
            curved: [0.0; ORDER],
            middles: [[0.0; 2]; CELLS],
            ends: Vec::new(),
        };
        let mut positions = [[0.0; ENDS]; ORDER];
        positions[0][0] = 1.0;
        for (cell, entries) in interval.series.iter().enumerate() {
            for (m, polynomial) in entries.iter().enumerate() {
                positions[m][cell + 1] = value(polynomial, 0.5);
                let half = 0.5 * table::second_derivative_bound(polynomial);
                interval.curved[m] = interval.curved[m].max(half);
            }
        }
        for (at, upper) in [(lower, false), (upper, true)] {
            if at.is_finite() {
                let sign = if upper { -1.0 } else { 1.0 };
                let mut distances = positions.map(|entries| entries.map(|x| sign * x));
                distances[2].iter_mut().for_each(|x| *x -= sign * at);
                interval.ends.push(End {
                    upper,
                    at,
                    distances,
                });
            }
        }
        for (cell, middle) in interval.middles.iter_mut().enumerate() {
            let (sine, cosine) = (interval.turn * cell as f64).sin_cos();
            *middle = [cosine, sine];
        }
        interval
    }

    /// The first meeting with an end within a range, in cells. `begins`: the motion may begin at an end.
    #[inline]
    fn meeting(&self, z: &[f64; ORDER], range: f64, begins: bool) -> Option<Meeting> {
        let sizes = self.curved.iter().zip(z);
        let curved: f64 = sizes.map(|(bound, x)| bound * x.abs()).sum();
        let mut first = None;
        let mut range = range;
        for end in &self.ends {
            if let Some(meeting) = self.meeting_with(end, z, (range, curved), begins) {
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
        (range, curved): (f64, f64),
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
            let motion = (cell, &self.series[cell]);
            if let Some((s, slope)) = end.zero(motion, pair, z, begins) {
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
    fn state(&self, cell: usize, s: f64, z: &[f64; ORDER]) -> [f64; 2] {
        let p = combine(&self.series[cell], z);
        [value(&p, s), value(&slopes(&p), s) * self.speed]
    }

    /// `z` at a place in a cell, from the state there and from `z` at the beginning.
    #[inline]
    fn advance(&self, cell: usize, s: f64, state: [f64; 2], z: &[f64; ORDER]) -> [f64; ORDER] {
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
    fn advance_columns(&self, cell: usize, s: f64, columns: &mut [[f64; 2]]) {
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
    fn accelerates_up(&self, z: &[f64; ORDER]) -> bool {
        crossing::derivatives(&combine(&self.series[0], z), 0.0)[2] > 0.0
    }
}

impl End {
    /// The first zero of a distance in a cell, and its slope there.
    #[inline]
    fn zero(
        &self,
        (cell, series): (usize, &[Polynomial; ORDER]),
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
        let curved = 4.0 * p[2].abs() > table::second_derivative_bound(&p);
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
fn place(cells: f64) -> (usize, f64) {
    let cell = ((cells + 0.5) as usize).min(CELLS - 1);
    (cell, cells - cell as f64)
}

/// The positions where pieces meet, in increasing order.
fn boundaries(model: &Model<'_>) -> Vec<Boundary> {
    let mut boundaries: Vec<Boundary> = Vec::new();
    for (index, contact) in model.contacts.iter().enumerate() {
        let (direction, offset) = model.position(index);
        if direction == 0.0 {
            continue;
        }
        for (level, &value) in contact.levels.iter().enumerate() {
            let (force, by_rate) = model.jump(index, level);
            // Upwards through the level if the gap grows with the position.
            let push = -contact.push[0] * direction.signum();
            boundaries.push(Boundary {
                at: (value + offset) / direction,
                constant: push * force,
                by_velocity: push * by_rate * direction,
            });
        }
    }
    boundaries.sort_by(|a, b| a.at.total_cmp(&b.at));
    boundaries.dedup_by(|next, kept| {
        let same = next.at == kept.at;
        if same {
            kept.constant += next.constant;
            kept.by_velocity += next.by_velocity;
        }
        same
    });
    boundaries
}

/// A position between two others.
fn inside(lower: f64, upper: f64) -> f64 {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => 0.5 * (lower + upper),
        (true, false) => lower + lower.abs().max(1.0),
        (false, true) => upper - upper.abs().max(1.0),
        (false, false) => 0.0,
    }
}

/// The pieces that all gaps are on at a position.
fn choose_pieces(model: &Model<'_>, x: f64, pieces: &mut [usize]) {
    for (index, piece) in pieces.iter_mut().enumerate() {
        let (direction, offset) = model.position(index);
        let gap = direction * x - offset;
        let levels = &model.contacts[index].levels;
        *piece = levels.iter().filter(|&&level| gap > level).count();
    }
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
