//! What is true of a periodic orbit: where it is, how large, and its multipliers, each with an error of its own.
//!
//! The orbit is the state that its motion comes back to, by Newton's method; the monodromy matrix is that of differences on both
//! sides of it, at three distances. Where perturbations grow much in a period it is divided into segments: multiple shooting, Keller
//! (1968), Numerical methods for two-point boundary-value problems.

use std::f64::consts::TAU;

use hertzian::Complex;

use crate::differential::expression::{Expression, Wave};
use crate::differential::integrate::{Lost, Motions};
use crate::differential::model::{COORDINATES, Contact, Law, Model, State, Term};
use crate::differential::multiple_shooting::{
    Closed, FARTHER, NEARER, Periodic, amplified, eigenvalues, jacobian, product, row_sum,
};

/// Tolerance of the motions, relative to the size of the orbit.
const TOLERANCE: f64 = 1e-12;
/// Distance of the perturbed states of a smooth force.
const APART: f64 = 3e-5;
/// Differences of a slope that bends converge in the first order, those of a root in the half: so many times a change is their error.
const ORDER: f64 = 3.0;

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

    /// Whether the orbit that a state is on has a multiplier of one.
    fn leaves_free(&self, state: &State) -> bool {
        match self.truth(|part| self.after(state, part)) {
            Ok(truth) => {
                let mut multipliers = truth.multipliers.iter();
                multipliers.any(|multiplier| (multiplier - 1.0).norm() <= truth.multiplier_error)
            }
            Err(unsure) => unsure == Unsure::Singular,
        }
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

/// What a motion from rest comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Settles {
    /// To repeat itself.
    Yes,
    /// To repeat itself with a multiplier of one: where nothing holds it any more, every place is as good.
    Anywhere,
    /// To no such thing.
    No,
    /// There was no time to see it.
    Unseen,
}

/// What a motion from rest comes to within so many periods, to a part of its size.
pub fn settles(question: &Question<'_>, periods: usize, until: impl Fn() -> bool) -> Settles {
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
            return Settles::Unseen;
        }
        let Ok(course) = there.course(0, &state) else {
            return Settles::No;
        };
        let apart = there.difference(&course.state, &state).amax();
        let [least, most] = course.extremes[0];
        let size = (most - least) / question.size;
        still = if apart < SETTLED * size { still + 1 } else { 0 };
        state = course.state;
        if still >= 5 {
            return if question.leaves_free(&state) {
                Settles::Anywhere
            } else {
                Settles::Yes
            };
        }
    }
    Settles::No
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
