//! Orbits that come back, by multiple shooting: Newton's method on the states at the beginnings of segments.
//!
//! Source: Keller (1968), Numerical methods for two-point boundary-value problems.

use hertzian::Complex;
use nalgebra::{DMatrix, DVector};

use crate::differential::integrate::{Course, Lost, Motions};
use crate::differential::model::{COORDINATES, State};
use crate::differential::truth::Unsure;

/// Other distances in parts of this: what is known of the differences is how they change.
pub const FARTHER: f64 = 2.0;
pub const NEARER: f64 = 0.125;
/// Where the orbit nearly touches a level, distances are made smaller so often at most.
const NEARER_STILL: usize = 3;
/// Motions that look for the orbit.
const MOTIONS: usize = 24;
/// The least part of a correction that is made.
const SHORTEST: f64 = 0.01;
/// A correction of the state below this is none.
const CLOSED: f64 = 1e-11;
/// A multiplier may be so large for each segment.
const GROWTH: f64 = 100.0;
/// An orbit so far from the guess, relative to its size, is sought again in more segments.
const FAR: f64 = 1e-3;
/// Segments of an orbit.
const SEGMENTS: [usize; 5] = [1, 2, 4, 8, 16];

/// Motions over a period, in segments of equal length.
#[derive(Clone, Copy)]
pub struct Periodic<'a> {
    pub motions: &'a Motions<'a>,
    pub time: f64,
    pub segments: usize,
}

/// States at the beginnings of the segments, the motions from there, and how far they are from the next ones at most.
pub struct Closed {
    pub states: Vec<State>,
    pub courses: Vec<Course>,
    pub left: f64,
}

impl<'a> Periodic<'a> {
    /// The orbit in as many segments as are needed, and a distance of perturbed states.
    ///
    /// Over a period of a large multiplier no state is exact enough to come back, and no perturbation so small that what
    /// becomes of it is.
    pub fn found(
        motions: &'a Motions<'a>,
        time: f64,
        apart: f64,
        guess: impl Fn(f64) -> Result<State, Lost>,
    ) -> Result<(Self, Closed), Unsure> {
        let mut reason = None;
        let mut nearest: Option<(f64, Self, Closed)> = None;
        for segments in SEGMENTS {
            let there = Self {
                motions,
                time,
                segments,
            };
            let parts = (0..segments).map(|i| i as f64 / segments as f64);
            let states = parts.map(&guess).collect::<Result<Vec<_>, _>>();
            let closed = states
                .map_err(Unsure::Lost)
                .and_then(|states| there.closed(states, apart));
            match closed {
                Ok(closed) => {
                    let far = there.correction(&closed, &guess)?;
                    if nearest.as_ref().is_none_or(|known| far < known.0) {
                        nearest = Some((far, there, closed));
                    }
                    // Differences over a period of a large multiplier may be bounded by the force, so that it is not seen; and of
                    // several orbits the one that is meant is the nearest.
                    if far <= FAR {
                        break;
                    }
                }
                // What was the matter where a multiplier allowed to see it.
                Err(unsure) => match reason {
                    None | Some(Unsure::Growing(_)) => reason = Some(unsure),
                    _ => {}
                },
            }
        }
        let (_, there, closed) = nearest.ok_or(reason.unwrap_or(Unsure::Singular))?;
        Ok((there, closed))
    }

    /// How far the positions are from those of the guess, relative to the sizes.
    fn correction(
        &self,
        closed: &Closed,
        guess: impl Fn(f64) -> Result<State, Lost>,
    ) -> Result<f64, Lost> {
        let by = self.difference(&closed.states[0], &guess(0.0)?);
        Ok(by.rows(0, self.coordinates()).amax())
    }

    pub fn coordinates(&self) -> usize {
        self.motions.model.coordinates
    }

    /// Places of what the model has in a state.
    fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let count = self.coordinates();
        (0..count).chain(COORDINATES..COORDINATES + count)
    }

    /// Of two states, relative to the sizes.
    pub fn difference(&self, a: &State, b: &State) -> DVector<f64> {
        let sizes = &self.motions.sizes;
        let parts = self.places().map(|i| (a[i] - b[i]) / sizes[i]);
        DVector::from_iterator(2 * self.coordinates(), parts)
    }

    /// By this part of a difference.
    fn moved<'b>(&self, state: &State, by: impl IntoIterator<Item = &'b f64>, part: f64) -> State {
        let mut moved = *state;
        for (i, by) in self.places().zip(by) {
            moved[i] += part * by * self.motions.sizes[i];
        }
        moved
    }

    /// Over a segment.
    pub fn course(&self, segment: usize, state: &State) -> Result<Course, Lost> {
        let ends = [segment, segment + 1].map(|i| self.time * i as f64 / self.segments as f64);
        self.motions.course(state, ends)
    }

    pub fn courses(&self, states: &[State]) -> Result<Vec<Course>, Lost> {
        let states = states.iter().enumerate();
        states
            .map(|(segment, state)| self.course(segment, state))
            .collect()
    }

    /// How far the ends of the segments are from the next beginnings.
    fn open(&self, states: &[State], courses: &[Course]) -> DVector<f64> {
        let next = states.iter().cycle().skip(1);
        let gaps = courses.iter().zip(next).flat_map(|(course, next)| {
            let gap = self.difference(&course.state, next);
            gap.data.as_vec().clone()
        });
        DVector::from_vec(gaps.collect())
    }

    /// Derivatives of the state after each segment by the state before it, both relative to the sizes; and whether the motions on both
    /// sides pass as many levels.
    fn differences(&self, states: &[State], apart: f64) -> Result<(Vec<DMatrix<f64>>, bool), Lost> {
        let size = 2 * self.coordinates();
        let mut slopes = Vec::with_capacity(self.segments);
        let mut alike = true;
        for (segment, state) in states.iter().enumerate() {
            let mut matrix = DMatrix::zeros(size, size);
            for column in 0..size {
                let mut by = DVector::zeros(size);
                by[column] = apart;
                let ahead = self.course(segment, &self.moved(state, &by, 1.0))?;
                let behind = self.course(segment, &self.moved(state, &by, -1.0))?;
                let slope = self.difference(&ahead.state, &behind.state) / (2.0 * apart);
                matrix.set_column(column, &slope);
                alike &= ahead.switches == behind.switches;
            }
            slopes.push(matrix);
        }
        Ok((slopes, alike))
    }

    /// The slopes at a distance at which no other motion touches a level, and the distance.
    pub fn on_this_side(
        &self,
        states: &[State],
        mut apart: f64,
    ) -> Result<(Vec<DMatrix<f64>>, f64), Unsure> {
        for _ in 0..=NEARER_STILL {
            let (slopes, alike) = self.differences(states, apart)?;
            if alike && self.differences(states, FARTHER * apart)?.1 {
                return Ok((slopes, apart));
            }
            apart *= NEARER;
        }
        Err(Unsure::Touching)
    }

    pub fn slopes(&self, states: &[State], apart: f64) -> Result<Vec<DMatrix<f64>>, Lost> {
        Ok(self.differences(states, apart)?.0)
    }

    /// The states that come back, by Newton's method.
    fn closed(&self, mut states: Vec<State>, apart: f64) -> Result<Closed, Unsure> {
        let slopes = self.slopes(&states, apart)?;
        let largest = eigenvalues(&product(&slopes))[0].norm();
        if largest > GROWTH.powi(self.segments as i32) {
            return Err(Unsure::Growing(largest));
        }
        let mut courses = self.courses(&states)?;
        let mut open = self.open(&states, &courses);
        let mut inverse = jacobian(&slopes).try_inverse().ok_or(Unsure::Singular)?;
        let renewed = |states: &[State]| {
            let slopes = self.slopes(states, apart)?;
            jacobian(&slopes).try_inverse().ok_or(Unsure::Singular)
        };
        // The slopes are those here, and so much of a correction is made: the whole one where the force is sharp may lead farther away.
        let (mut are_of_here, mut part) = (true, 1.0);
        let mut small = false;
        for _ in 0..MOTIONS {
            let by = -(&inverse * &open);
            let parts = by.as_slice().chunks(2 * self.coordinates());
            let next = states
                .iter()
                .zip(parts)
                .map(|(state, by)| self.moved(state, by, part));
            let next: Vec<_> = next.collect();
            let after = self.courses(&next)?;
            let gaps = self.open(&next, &after);
            let (was, left) = (open.amax(), gaps.amax());
            if left >= was {
                small |= by.amax() < CLOSED;
                if small || was < CLOSED {
                    break;
                }
                if are_of_here {
                    part *= 0.5;
                    if part < SHORTEST {
                        return Err(Unsure::Open(was));
                    }
                } else {
                    inverse = renewed(&states)?;
                    are_of_here = true;
                }
                continue;
            }
            (states, courses, open) = (next, after, gaps);
            small = by.amax() < CLOSED;
            if small {
                break;
            }
            are_of_here = left > 0.2 * was;
            if are_of_here {
                inverse = renewed(&states)?;
            }
            part = f64::min(1.0, 2.0 * part);
        }
        let left = open.amax();
        let closed = Closed {
            states,
            courses,
            left,
        };
        if small || left < CLOSED {
            Ok(closed)
        } else {
            Err(Unsure::Open(left))
        }
    }
}

/// Derivative of the gaps between segments by the states at their beginnings.
pub fn jacobian(slopes: &[DMatrix<f64>]) -> DMatrix<f64> {
    let (count, size) = (slopes.len(), slopes[0].nrows());
    let mut matrix = DMatrix::zeros(count * size, count * size);
    for (segment, slope) in slopes.iter().enumerate() {
        let next = (segment + 1) % count;
        matrix
            .view_mut((segment * size, segment * size), (size, size))
            .copy_from(slope);
        for i in 0..size {
            matrix[(segment * size + i, next * size + i)] -= 1.0;
        }
    }
    matrix
}

/// Over all segments.
pub fn product(slopes: &[DMatrix<f64>]) -> DMatrix<f64> {
    let identity = DMatrix::identity(slopes[0].nrows(), slopes[0].nrows());
    slopes
        .iter()
        .fold(identity, |product, slope| slope * product)
}

/// What an error of each derivative becomes in their product.
pub fn amplified(slopes: &[DMatrix<f64>]) -> f64 {
    let norm = |slopes: &[DMatrix<f64>]| slopes.first().map_or(1.0, |_| row_sum(&product(slopes)));
    let places = 0..slopes.len();
    places
        .map(|i| norm(&slopes[..i]) * norm(&slopes[i + 1..]))
        .sum()
}

pub fn row_sum(matrix: &DMatrix<f64>) -> f64 {
    let sums = matrix.row_iter().map(|row| row.abs().sum());
    sums.fold(0.0, f64::max)
}

pub fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let mut values: Vec<_> = matrix.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    values
}
