//! What is true of a periodic orbit: where it is, how large, and its multipliers, each with an error of its own.
//!
//! The orbit is the state that its motion comes back to, by Newton's method; the monodromy matrix is that of differences on both
//! sides of it, at two distances.

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
/// Motions that look for the orbit.
const MOTIONS: usize = 12;
/// A correction of the state below this is none.
const CLOSED: f64 = 1e-11;

/// A periodic orbit.
#[derive(Debug, Clone)]
pub struct Truth {
    /// How far the state was from it, relative to its size.
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

    /// The orbit near a state.
    pub fn truth(&self, guess: &State) -> Result<Truth, Unsure> {
        let motions = Motions::of(self.model, self.omega, self.sizes(), TOLERANCE);
        let apart = APART * self.model.sharpest.sqrt();
        let there = Periodic {
            motions: &motions,
            time: self.time,
        };
        let (state, course, left) = there.closed(guess, apart)?;
        let near = there.monodromy(&state, apart)?;
        let far = there.monodromy(&state, 2.0 * apart)?;
        // Where perturbed motions are exact to a tolerance; and, by another tolerance, what the motion itself is exact to.
        let loose = Motions::of(self.model, self.omega, self.sizes(), 10.0 * TOLERANCE);
        let other = loose.course(&state, self.time)?;
        let motion = there.difference(&course.state, &other.state).amax();
        let inverse = (&near - identity(&near)).try_inverse();
        let inverse = inverse.ok_or(Unsure::Singular)?;
        let error = row_sum(&inverse) * (left + motion + TOLERANCE);
        let [least, most] = course.extremes[0];
        let grown = 4.0 * row_sum(&near).max(1.0);
        let multipliers = eigenvalues(&near);
        let noise = 4.0 * (motion + TOLERANCE) / apart + grown * error;
        let multiplier_error = hertzian_tests::distance(&multipliers, &eigenvalues(&far)) + noise;
        let correction = there.difference(&state, guess).amax();
        Ok(Truth {
            correction,
            error,
            peak_to_peak: [most - least, grown * error * self.size],
            multipliers,
            multiplier_error,
        })
    }
}

/// Motions over a period.
struct Periodic<'a> {
    motions: &'a Motions<'a>,
    time: f64,
}

impl Periodic<'_> {
    fn coordinates(&self) -> usize {
        self.motions.model.coordinates
    }

    /// Places of what the model has in a state.
    fn places(&self) -> impl Iterator<Item = usize> {
        let count = self.coordinates();
        (0..count).chain(COORDINATES..COORDINATES + count)
    }

    /// Of two states, relative to the sizes.
    fn difference(&self, a: &State, b: &State) -> DVector<f64> {
        let sizes = &self.motions.sizes;
        let parts = self.places().map(|i| (a[i] - b[i]) / sizes[i]);
        DVector::from_iterator(2 * self.coordinates(), parts)
    }

    fn moved(&self, state: &State, by: &DVector<f64>) -> State {
        let mut moved = *state;
        for (i, by) in self.places().zip(by.iter()) {
            moved[i] += by * self.motions.sizes[i];
        }
        moved
    }

    fn course(&self, state: &State) -> Result<Course, Lost> {
        self.motions.course(state, self.time)
    }

    /// Derivative of the state after the period by the state, both relative to the sizes.
    fn monodromy(&self, state: &State, apart: f64) -> Result<DMatrix<f64>, Lost> {
        let size = 2 * self.coordinates();
        let mut matrix = DMatrix::zeros(size, size);
        for column in 0..size {
            let mut by = DVector::zeros(size);
            by[column] = apart;
            let ahead = self.course(&self.moved(state, &by))?;
            let behind = self.course(&self.moved(state, &-by))?;
            let slope = self.difference(&ahead.state, &behind.state) / (2.0 * apart);
            matrix.set_column(column, &slope);
        }
        Ok(matrix)
    }

    /// The state that comes back, its motion, and how far it is from coming back.
    fn closed(&self, guess: &State, apart: f64) -> Result<(State, Course, f64), Unsure> {
        let mut state = *guess;
        let mut course = self.course(&state)?;
        let mut open = self.difference(&course.state, &state);
        let mut inverse = self.inverse(&state, apart)?;
        for _ in 0..MOTIONS {
            let by = -(&inverse * &open);
            let next = self.moved(&state, &by);
            let after = self.course(&next)?;
            let left = self.difference(&after.state, &next);
            let (was, is) = (open.amax(), left.amax());
            if is >= was {
                if by.amax() < CLOSED || was < CLOSED {
                    return Ok((state, course, was));
                }
                inverse = self.inverse(&state, apart)?;
                let again = -(&inverse * &open);
                if (&again - &by).amax() < 1e-6 * again.amax() {
                    return Err(Unsure::Open(was));
                }
                continue;
            }
            (state, course, open) = (next, after, left);
            if by.amax() < CLOSED {
                return Ok((state, course, is));
            }
            if is > 0.2 * was {
                inverse = self.inverse(&state, apart)?;
            }
        }
        let left = open.amax();
        if left < CLOSED {
            Ok((state, course, left))
        } else {
            Err(Unsure::Open(left))
        }
    }

    fn inverse(&self, state: &State, apart: f64) -> Result<DMatrix<f64>, Unsure> {
        let monodromy = self.monodromy(state, apart)?;
        let inverse = (&monodromy - identity(&monodromy)).try_inverse();
        inverse.ok_or(Unsure::Singular)
    }
}

fn identity(like: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::identity(like.nrows(), like.nrows())
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
    };
    let mut state = State::default();
    let mut still = 0;
    for _ in 0..periods {
        if until() {
            return None;
        }
        let Ok(course) = there.course(&state) else {
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
    let truth = question.truth(&state).unwrap();
    let [size, error] = truth.peak_to_peak;
    assert!(error < 1e-9 && (size - 1.065_351_188_531_121_3).abs() < 1e-11 + error);
    let exact = Complex::new(-0.282_447_013_736_739_14, 0.572_513_003_034_731_6);
    let apart = hertzian_tests::distance(&truth.multipliers, &[exact, exact.conj()]);
    assert!(apart < truth.multiplier_error && truth.multiplier_error < 1e-5);
}
