//! What is true of a periodic orbit: where it is, how large, and its multipliers, each with an error of its own.
//!
//! The orbit is the state that its motion comes back to, by Newton's method; the monodromy matrix is that of differences on both
//! sides of it, at three distances. Where perturbations grow much in a period it is divided into segments: multiple shooting, Keller
//! (1968), Numerical methods for two-point boundary-value problems.

use std::f64::consts::TAU;

use hertzian::Complex;
use nalgebra::{DMatrix, DVector};

use crate::expression::{Expression, Wave};
use crate::integrate::{Course, Lost, Motions};
use crate::model::{COORDINATES, Contact, Law, Model, State, Term};

/// Tolerance of the motions, relative to the size of the orbit.
const TOLERANCE: f64 = 1e-12;
/// Distance of the perturbed states of a smooth force.
const APART: f64 = 3e-5;
/// Other distances in parts of this: what is known of the differences is how they change.
const FARTHER: f64 = 2.0;
const NEARER: f64 = 0.125;
/// Where the orbit nearly touches a level, distances are made smaller so often at most.
const NEARER_STILL: usize = 3;
/// Differences of a slope that bends converge in the first order, those of a root in the half: so many times a change is their error.
const ORDER: f64 = 3.0;
/// Motions that look for the orbit.
const MOTIONS: usize = 12;
/// A correction of the state below this is none.
const CLOSED: f64 = 1e-11;
/// A multiplier may be so large for each segment.
const GROWTH: f64 = 100.0;
/// An orbit so far from the guess, relative to its size, is sought again in more segments.
const FAR: f64 = 1e-3;
/// Segments of an orbit at most.
const SEGMENTS: usize = 16;

/// A periodic orbit.
#[derive(Debug, Clone)]
pub struct Truth {
    /// How far the positions were from it, relative to its size.
    pub correction: f64,
    /// Error of the state, relative to its size.
    pub error: f64,
    /// Largest less smallest value of the first coordinate, and its error.
    pub peak_to_peak: [f64; 2],
    /// Largest modulus first.
    pub multipliers: Vec<Complex<f64>>,
    pub multiplier_error: f64,
}

/// Why nothing is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unsure {
    /// A motion beside the orbit cannot be computed.
    Lost(Lost),
    /// A multiplier is one, to what is known of it.
    Singular,
    /// A multiplier, as far as it is known, is too large for the segments.
    Growing(f64),
    /// Motions beside it pass a level more often, however near they are.
    Touching,
    /// States came nearer to none: this far it was from coming back at the end, relative to the size.
    Open(f64),
}

impl From<Lost> for Unsure {
    fn from(lost: Lost) -> Self {
        Self::Lost(lost)
    }
}

/// What is looked at: a model at a frequency, and the time in which an orbit comes back.
pub struct Question<'a> {
    pub model: &'a Model,
    pub omega: f64,
    pub time: f64,
    /// Half of its peak-to-peak.
    pub size: f64,
}

impl<'a> Question<'a> {
    /// Of an orbit of so many periods of the declaration.
    pub fn of(model: &'a Model, omega: f64, period: usize, size: f64) -> Self {
        let periods = f64::from(model.divisor) * period as f64;
        Self {
            model,
            omega,
            time: TAU * periods / omega,
            size,
        }
    }

    fn sizes(&self) -> State {
        let mut sizes = [self.size; 2 * COORDINATES];
        for speed in &mut sizes[COORDINATES..] {
            *speed *= self.omega;
        }
        sizes
    }

    /// The state after a part of the time.
    pub fn after(&self, state: &State, part: f64) -> Result<State, Lost> {
        let motions = Motions::of(self.model, self.omega, self.sizes(), TOLERANCE);
        let course = motions.course(state, [0.0, part * self.time])?;
        Ok(course.state)
    }

    /// The orbit near one, the states of which are given at parts of the time.
    pub fn truth(&self, guess: impl Fn(f64) -> Result<State, Lost>) -> Result<Truth, Unsure> {
        let motions = Motions::of(self.model, self.omega, self.sizes(), TOLERANCE);
        let apart = APART * self.model.sharpest.sqrt();
        let start = guess(0.0)?;
        let (there, closed) = Periodic::found(&motions, self.time, apart, guess)?;
        let Closed {
            states,
            courses,
            left,
        } = closed;
        let (near, apart) = there.on_this_side(&states, apart)?;
        // Where perturbed motions are exact to a tolerance; and, by another tolerance, what the motion itself is exact to.
        let loose = Motions::of(self.model, self.omega, self.sizes(), 10.0 * TOLERANCE);
        let loose = Periodic {
            motions: &loose,
            ..there
        };
        let mut motion = 0.0_f64;
        for (course, other) in courses.iter().zip(loose.courses(&states)?) {
            motion = motion.max(there.difference(&course.state, &other.state).amax());
        }
        let inverse = jacobian(&near).try_inverse().ok_or(Unsure::Singular)?;
        let error = row_sum(&inverse) * (left + motion + TOLERANCE);
        let [least, most] = courses
            .iter()
            .map(|course| course.extremes[0])
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| {
                [low.min(a), high.max(b)]
            });
        let grown = 4.0 * near.iter().map(row_sum).fold(1.0, f64::max);
        let multipliers = eigenvalues(&product(&near));
        let noise = 4.0 * (motion + TOLERANCE) / apart + grown * error;
        let noise = amplified(&near) * noise;
        let change = |part: f64| -> Result<f64, Lost> {
            let others = eigenvalues(&product(&there.slopes(&states, part * apart)?));
            Ok(hertzian_tests::distance(&multipliers, &others))
        };
        let multiplier_error = noise + (ORDER * change(FARTHER)?).max(change(NEARER)?);
        // Of positions: rates of a series err by the number of its harmonics more.
        let correction = there.difference(&states[0], &start);
        let correction = correction.rows(0, there.coordinates()).amax();
        Ok(Truth {
            correction,
            error,
            peak_to_peak: [most - least, grown * error * self.size],
            multipliers,
            multiplier_error,
        })
    }
}

/// Motions over a period, in segments of equal length.
#[derive(Clone, Copy)]
struct Periodic<'a> {
    motions: &'a Motions<'a>,
    time: f64,
    segments: usize,
}

/// States at the beginnings of the segments, the motions from there, and how far they are from the next ones at most.
struct Closed {
    states: Vec<State>,
    courses: Vec<Course>,
    left: f64,
}

impl<'a> Periodic<'a> {
    /// The orbit in as many segments as are needed, and a distance of perturbed states.
    ///
    /// Over a period of a large multiplier no state is exact enough to come back, and no perturbation so small that what
    /// becomes of it is.
    fn found(
        motions: &'a Motions<'a>,
        time: f64,
        apart: f64,
        guess: impl Fn(f64) -> Result<State, Lost>,
    ) -> Result<(Self, Closed), Unsure> {
        let (mut segments, mut reason) = (1, None);
        let mut elsewhere = None;
        loop {
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
                // Differences over a period of a large multiplier may be bounded by the force, so that it is not seen.
                Ok(closed) if segments < SEGMENTS && there.went_far(&closed, &guess)? => {
                    elsewhere.get_or_insert((there, closed));
                    segments *= 2;
                }
                Ok(closed) => return Ok((there, closed)),
                Err(unsure) => {
                    // What was the matter where a multiplier allowed to see it.
                    reason = match reason {
                        None | Some(Unsure::Growing(_)) => Some(unsure),
                        reason => reason,
                    };
                    segments *= 2;
                    if segments > SEGMENTS {
                        return elsewhere.ok_or(reason.unwrap_or(unsure));
                    }
                }
            }
        }
    }

    /// Whether the orbit is another one than the guess is near to.
    fn went_far(
        &self,
        closed: &Closed,
        guess: impl Fn(f64) -> Result<State, Lost>,
    ) -> Result<bool, Lost> {
        let by = self.difference(&closed.states[0], &guess(0.0)?);
        Ok(by.rows(0, self.coordinates()).amax() > FAR)
    }

    fn coordinates(&self) -> usize {
        self.motions.model.coordinates
    }

    /// Places of what the model has in a state.
    fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let count = self.coordinates();
        (0..count).chain(COORDINATES..COORDINATES + count)
    }

    /// Of two states, relative to the sizes.
    fn difference(&self, a: &State, b: &State) -> DVector<f64> {
        let sizes = &self.motions.sizes;
        let parts = self.places().map(|i| (a[i] - b[i]) / sizes[i]);
        DVector::from_iterator(2 * self.coordinates(), parts)
    }

    fn moved<'b>(&self, state: &State, by: impl IntoIterator<Item = &'b f64>) -> State {
        let mut moved = *state;
        for (i, by) in self.places().zip(by) {
            moved[i] += by * self.motions.sizes[i];
        }
        moved
    }

    /// Over a segment.
    fn course(&self, segment: usize, state: &State) -> Result<Course, Lost> {
        let ends = [segment, segment + 1].map(|i| self.time * i as f64 / self.segments as f64);
        self.motions.course(state, ends)
    }

    fn courses(&self, states: &[State]) -> Result<Vec<Course>, Lost> {
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
                let ahead = self.course(segment, &self.moved(state, &by))?;
                let behind = self.course(segment, &self.moved(state, &-by))?;
                let slope = self.difference(&ahead.state, &behind.state) / (2.0 * apart);
                matrix.set_column(column, &slope);
                alike &= ahead.switches == behind.switches;
            }
            slopes.push(matrix);
        }
        Ok((slopes, alike))
    }

    /// The slopes at a distance at which no other motion touches a level, and the distance.
    fn on_this_side(
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

    fn slopes(&self, states: &[State], apart: f64) -> Result<Vec<DMatrix<f64>>, Lost> {
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
        let mut small = false;
        for _ in 0..MOTIONS {
            let by = -(&inverse * &open);
            let parts = by.as_slice().chunks(2 * self.coordinates());
            let next = states
                .iter()
                .zip(parts)
                .map(|(state, by)| self.moved(state, by));
            let next: Vec<_> = next.collect();
            let after = self.courses(&next)?;
            let gaps = self.open(&next, &after);
            let (was, left) = (open.amax(), gaps.amax());
            if left >= was {
                small |= by.amax() < CLOSED;
                if small || was < CLOSED {
                    break;
                }
                inverse = renewed(&states)?;
                let again = -(&inverse * &open);
                if (&again - &by).amax() < 1e-6 * again.amax() {
                    return Err(Unsure::Open(was));
                }
                continue;
            }
            (states, courses, open) = (next, after, gaps);
            small = by.amax() < CLOSED;
            if small {
                break;
            }
            if left > 0.2 * was {
                inverse = renewed(&states)?;
            }
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
fn jacobian(slopes: &[DMatrix<f64>]) -> DMatrix<f64> {
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
fn product(slopes: &[DMatrix<f64>]) -> DMatrix<f64> {
    let identity = DMatrix::identity(slopes[0].nrows(), slopes[0].nrows());
    slopes
        .iter()
        .fold(identity, |product, slope| slope * product)
}

/// What an error of each derivative becomes in their product.
fn amplified(slopes: &[DMatrix<f64>]) -> f64 {
    let norm = |slopes: &[DMatrix<f64>]| slopes.first().map_or(1.0, |_| row_sum(&product(slopes)));
    let places = 0..slopes.len();
    places
        .map(|i| norm(&slopes[..i]) * norm(&slopes[i + 1..]))
        .sum()
}

fn row_sum(matrix: &DMatrix<f64>) -> f64 {
    let sums = matrix.row_iter().map(|row| row.abs().sum());
    sums.fold(0.0, f64::max)
}

fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let mut values: Vec<_> = matrix.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    values
}

/// Whether a motion from rest comes to repeat itself within so many periods, to a part of its size.
pub fn settles(question: &Question<'_>, periods: usize, until: impl Fn() -> bool) -> Option<bool> {
    const SETTLED: f64 = 1e-6;
    let motions = Motions::of(question.model, question.omega, question.sizes(), 1e-8);
    let there = Periodic {
        motions: &motions,
        time: question.time,
        segments: 1,
    };
    let mut state = State::default();
    let mut still = 0;
    for _ in 0..periods {
        if until() {
            return None;
        }
        let Ok(course) = there.course(0, &state) else {
            return Some(false);
        };
        let apart = there.difference(&course.state, &state).amax();
        let [least, most] = course.extremes[0];
        let size = (most - least) / question.size;
        still = if apart < SETTLED * size { still + 1 } else { 0 };
        if still >= 5 {
            return Some(true);
        }
        state = course.state;
    }
    Some(false)
}

/// The gear pair of Kahraman and Singh (1991) against event-driven shooting of another program, confirmed by Chebyshev collocation.
#[test]
fn a_gear_pair_is_what_another_program_says() {
    let number = Expression::Number;
    let wave = || Expression::Wave(Wave::cosine(1, 1));
    let square = Expression::Omega.to(number(2.0));
    let model = Model {
        coordinates: 1,
        masses: vec![number(1.0)],
        laws: vec![Law {
            levels: vec![number(1.0).negative(), number(1.0)],
            pieces: vec![
                Expression::Gap.plus(number(1.0)),
                number(0.0),
                Expression::Gap.plus(number(1.0).negative()),
            ],
            ..Law::default()
        }],
        contacts: vec![Contact {
            law: 0,
            terms: vec![Term {
                coordinate: 0,
                factor: 1.0,
                wave: None,
            }],
            distance: None,
            moving: None,
            factor: Some(number(1.0).plus(number(0.2).times(wave()))),
        }],
        left: vec![vec![number(0.1).times(Expression::Velocity(0))]],
        right: vec![vec![
            number(0.1),
            Expression::Product(vec![number(0.2), square, wave()]),
        ]],
        sharpest: 1.0,
        divisor: 1,
        ..Model::default()
    };
    let mut state = State::default();
    (state[0], state[COORDINATES]) = (0.441, 0.1205);
    let question = Question::of(&model, 0.7, 1, 0.5);
    let truth = question.truth(|part| question.after(&state, part)).unwrap();
    let [size, error] = truth.peak_to_peak;
    assert!(error < 1e-9 && (size - 1.065_351_188_531_121_3).abs() < 1e-11 + error);
    let exact = Complex::new(-0.282_447_013_736_739_14, 0.572_513_003_034_731_6);
    let apart = hertzian_tests::distance(&truth.multipliers, &[exact, exact.conj()]);
    assert!(apart < truth.multiplier_error && truth.multiplier_error < 1e-5);
}
