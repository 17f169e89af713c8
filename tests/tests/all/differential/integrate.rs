//! Motions of a drawn model, by a method that shares no code with the library.
//!
//! Dormand and Prince's formulas of order eight with an error of order seven (Prince and Dormand 1981, J. Comput. Appl. Math. 7, 67,
//! table 2: RK8(7)13M). A step ends where a gap meets a level: it is taken again, shorter, until it ends there to rounding, so
//! that nothing is interpolated. Within a step every contact keeps the force of its piece.
//!
//! Where a smooth force changes on a width far below the motion, all stages of a step, and its error with them, may pass the change
//! without a trace: a step is so short that the variable of the force goes by no more than a part of its width, or of its distance
//! from where the change is.

use std::f64::consts::TAU;

use crate::differential::model::{CONTACTS, COORDINATES, Model, Pieces, State, Variable};
use hertzian_tests::tableau::{A, B, C, LOWER, STAGES};

/// Steps of one motion at most.
const STEPS: usize = 400_000;
/// Steps in a period at least.
const LEAST: f64 = 24.0;
/// Parts of the width of a sharp force, and of the distance from it, that its variable may go by within a step.
const WIDTH: f64 = 1.0;
const DISTANCE: f64 = 0.3;

/// How motions are computed.
pub struct Motions<'a> {
    pub model: &'a Model,
    values: Vec<f64>,
    omega: f64,
    /// Sizes of positions and velocities, which the tolerance is relative to.
    pub sizes: State,
    pub tolerance: f64,
    levels: Vec<Vec<f64>>,
    /// By contact: what its force changes fast with, and the width.
    sharp: Vec<Option<(Variable, f64)>>,
    /// By contact: where its slope jumps on a piece.
    bends: Vec<Option<(Variable, f64)>>,
}

/// Where a motion went.
#[derive(Debug, Clone)]
pub struct Course {
    pub state: State,
    /// Smallest and largest value of every coordinate.
    pub extremes: [[f64; 2]; COORDINATES],
    /// Number of times a gap passed a level.
    pub switches: usize,
    /// Smallest rate of a gap at a level, relative to the sizes.
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
struct Step {
    time: f64,
    from: State,
    pieces: Pieces,
    slope: State,
}

impl<'a> Motions<'a> {
    pub fn of(model: &'a Model, omega: f64, sizes: State, tolerance: f64) -> Self {
        let values = model.values();
        let levels = (0..model.contacts.len()).map(|contact| {
            let mut levels = Vec::new();
            model.levels(contact, &values, &mut levels);
            levels
        });
        Self {
            model,
            sharp: (0..model.contacts.len())
                .map(|contact| model.sharp(contact, &values))
                .collect(),
            bends: (0..model.contacts.len())
                .map(|contact| model.bend(contact, &values))
                .collect(),
            levels: levels.collect(),
            values,
            omega,
            sizes,
            tolerance,
        }
    }

    /// The motion from a state at a time until another one.
    pub fn course(&self, state: &State, [begin, end]: [f64; 2]) -> Result<Course, Lost> {
        let count = self.model.coordinates;
        let mut course = Course {
            state: *state,
            extremes: std::array::from_fn(|i| [state[i]; 2]),
            switches: 0,
            slowest: f64::INFINITY,
        };
        let largest = f64::min(TAU / self.omega, end - begin) / LEAST;
        let (mut time, mut step) = (begin, 0.1 * largest);
        let mut pieces = self.pieces(begin, state);
        for _ in 0..STEPS {
            let left = end - time;
            if left <= 1e-14 * end {
                return Ok(course);
            }
            let last = step >= left;
            let length = if last { left } else { step };
            let here = Step {
                time,
                from: course.state,
                pieces,
                slope: self.slope(time, &course.state, &pieces),
            };
            let sight = self.sight(&here);
            let shortest = 1e-12 * end;
            if length > sight && length > shortest {
                step = sight.max(shortest);
                continue;
            }
            let (mut to, error) = self.step(&here, length);
            if error <= 1.0 && length > shortest && self.passed(&here, &to, length) {
                step = 0.5 * length;
                continue;
            }
            if !(error <= 1.0 || length < 1e-14 * end && error.is_finite()) {
                if !error.is_finite() && length < 1e-14 * end {
                    return Err(Lost::Diverged);
                }
                step = length * (0.9 * error.powf(-0.125)).clamp(0.1, 0.8);
                if !error.is_finite() {
                    step = 0.1 * length;
                }
                continue;
            }
            let grown = (0.9 * error.max(1e-10).powf(-0.125)).clamp(0.3, 4.0);
            let mut taken = length;
            let switch = self.switch(&here, &to, length);
            if let Some((contact, piece, at)) = switch {
                taken = at;
                to = self.step(&here, at).0;
                pieces[contact] = piece;
                let gap = self.gap(contact, time + at, &to);
                course.slowest = course.slowest.min(gap[1].abs() / self.rate_size(contact));
                course.switches += 1;
            } else {
                step = (length * grown).min(largest);
            }
            let bend = self.bend(&here, &to, taken);
            if let Some(at) = bend.filter(|_| switch.is_none()) {
                taken = at;
                to = self.step(&here, at).0;
            }
            self.widen(&here, &to, taken, &mut course.extremes[..count]);
            time = if last && switch.is_none() && bend.is_none() {
                end
            } else {
                time + taken
            };
            course.state = to;
        }
        Err(Lost::Long)
    }

    /// Where a slope of a force jumps first within a step.
    fn bend(&self, here: &Step, to: &State, length: f64) -> Option<f64> {
        let mut first: Option<f64> = None;
        for (contact, bend) in self.bends.iter().enumerate() {
            let Some((of, place)) = *bend else { continue };
            let beyond = |time: f64, state: &State| {
                self.variable(contact, of, here.time + time, state) - place
            };
            let (begin, end) = (beyond(0.0, &here.from), beyond(length, to));
            let size = match of {
                Variable::Gap => self.rate_size(contact) / self.omega,
                Variable::Rate => self.rate_size(contact),
            };
            // A step that begins there leaves it.
            if begin.abs() > 1e-13 * size && begin * end < 0.0 {
                let at = root((0.0, begin), (length, end), |time| {
                    beyond(time, &self.step(here, time).0)
                });
                first = Some(first.map_or(at, |first| first.min(at)));
            }
        }
        first
    }

    /// What the force of a contact changes fast with, less where it changes.
    fn variable(&self, contact: usize, of: Variable, time: f64, state: &State) -> f64 {
        let [value, rate] = self.gap(contact, time, state);
        match of {
            Variable::Gap => value,
            Variable::Rate => rate,
        }
    }

    /// The longest step that does not pass a sharp force unseen, as its variable moves in the beginning.
    fn sight(&self, here: &Step) -> f64 {
        let ahead = 1e-7 / self.omega;
        let mut moved = here.from;
        for (x, slope) in moved.iter_mut().zip(here.slope) {
            *x += ahead * slope;
        }
        let sharp = self.sharp.iter().enumerate();
        let steps = sharp.filter_map(|(contact, sharp)| {
            let (of, width) = (*sharp)?;
            let from = self.variable(contact, of, here.time, &here.from);
            let to = self.variable(contact, of, here.time + ahead, &moved);
            let speed = (to - from).abs() / ahead;
            Some((WIDTH * width + DISTANCE * from.abs()) / speed)
        });
        steps.fold(f64::INFINITY, f64::min)
    }

    /// Whether a step that was taken went by a sharp force faster than it began to.
    fn passed(&self, here: &Step, to: &State, length: f64) -> bool {
        let mut sharp = self.sharp.iter().enumerate();
        sharp.any(|(contact, sharp)| {
            let Some((of, width)) = *sharp else {
                return false;
            };
            let from = self.variable(contact, of, here.time, &here.from);
            let to = self.variable(contact, of, here.time + length, to);
            (to - from).abs() > 2.0 * (WIDTH * width + DISTANCE * from.abs())
        })
    }

    fn slope(&self, time: f64, state: &State, pieces: &Pieces) -> State {
        self.model
            .derivative(&self.values, self.omega, time, (state, pieces))
    }

    /// A gap and its rate.
    fn gap(&self, contact: usize, time: f64, state: &State) -> [f64; 2] {
        let gap = self
            .model
            .gap(contact, &self.values, self.omega, time, state);
        [gap.value, gap.rate]
    }

    /// What a rate of the gap is compared with.
    fn rate_size(&self, contact: usize) -> f64 {
        let terms = self.model.contacts[contact].terms.iter();
        terms.fold(f64::MIN_POSITIVE, |size, term| {
            size.max(self.sizes[COORDINATES + term.coordinate])
        })
    }

    /// The piece of every contact at a time; on a level the one that the gap moves to.
    fn pieces(&self, time: f64, state: &State) -> Pieces {
        let mut pieces = [0; CONTACTS];
        for (contact, levels) in self.levels.iter().enumerate() {
            let [value, rate] = self.gap(contact, time, state);
            let above = |level: &&f64| value > **level || value == **level && rate > 0.0;
            pieces[contact] = levels.iter().filter(above).count();
        }
        pieces
    }

    /// One step, and its error over the tolerance.
    fn step(&self, here: &Step, length: f64) -> (State, f64) {
        let size = 2 * COORDINATES;
        let mut slopes = [State::default(); STAGES];
        slopes[0] = here.slope;
        for stage in 1..STAGES {
            let mut state = here.from;
            for (earlier, slope) in slopes[..stage].iter().enumerate() {
                let weight = length * A[stage][earlier];
                if weight != 0.0 {
                    for i in 0..size {
                        state[i] += weight * slope[i];
                    }
                }
            }
            let time = here.time + C[stage] * length;
            slopes[stage] = self.slope(time, &state, &here.pieces);
        }
        let (mut to, mut worst) = (here.from, 0.0_f64);
        for i in 0..size {
            let (mut sum, mut error) = (0.0, 0.0);
            for stage in 0..STAGES {
                sum += B[stage] * slopes[stage][i];
                error += (B[stage] - LOWER[stage]) * slopes[stage][i];
            }
            to[i] += length * sum;
            let error = (length * error / (self.tolerance * self.sizes[i])).abs();
            // A number that is none is not lost.
            worst = if error <= worst { worst } else { error };
        }
        (to, worst)
    }

    /// The first level that a gap meets in a step: contact, the piece after it, and the time from the beginning.
    fn switch(&self, here: &Step, to: &State, length: f64) -> Option<(usize, usize, f64)> {
        let mut first: Option<(usize, usize, f64)> = None;
        for (contact, levels) in self.levels.iter().enumerate() {
            let piece = here.pieces[contact];
            let low = piece
                .checked_sub(1)
                .map(|index| (levels[index], 1.0, piece - 1));
            let high = levels.get(piece).map(|level| (*level, -1.0, piece + 1));
            for (level, sign, after) in low.into_iter().chain(high) {
                let until = first.map_or(length, |(_, _, at)| at);
                let (end, state) = if until < length {
                    (until, self.step(here, until).0)
                } else {
                    (length, *to)
                };
                let border = (contact, level, sign);
                if let Some(at) = self.met(here, border, (end, &state)) {
                    first = Some((contact, after, at));
                }
            }
        }
        first
    }

    /// Where a gap leaves its piece through a border, within so much of a step.
    fn met(
        &self,
        here: &Step,
        (contact, level, sign): (usize, f64, f64),
        (length, to): (f64, &State),
    ) -> Option<f64> {
        let inside = |[value, rate]: [f64; 2]| [sign * (value - level), sign * rate];
        let after = |time: f64| {
            let state = self.step(here, time).0;
            inside(self.gap(contact, here.time + time, &state))
        };
        let begin = inside(self.gap(contact, here.time, &here.from));
        let end = inside(self.gap(contact, here.time + length, to));
        let (mut low, mut high) = ((0.0, begin[0]), (length, end[0]));
        if begin[1] * end[1] < 0.0 {
            // It has an extremum within.
            let at = root((0.0, begin[1]), (length, end[1]), |time| after(time)[1]);
            let extremum = after(at)[0];
            if extremum < 0.0 && begin[0] > 0.0 {
                high = (at, extremum);
            } else if extremum > 0.0 {
                low = (at, extremum);
            } else if end[0] >= 0.0 {
                return None;
            }
        }
        if high.1 >= 0.0 {
            return None;
        }
        if low.1 <= 0.0 {
            // It begins on the border and leaves at once.
            return (begin[1] < 0.0).then_some(0.0).or(Some(low.0));
        }
        Some(root(low, high, |time| after(time)[0]))
    }

    /// Takes the extremes within a step and at its end in.
    fn widen(&self, here: &Step, to: &State, length: f64, extremes: &mut [[f64; 2]]) {
        for (i, [least, most]) in extremes.iter_mut().enumerate() {
            let mut include = |x: f64| {
                *least = least.min(x);
                *most = most.max(x);
            };
            include(to[i]);
            let velocity = COORDINATES + i;
            if here.from[velocity] * to[velocity] < 0.0 {
                let ends = [(0.0, here.from[velocity]), (length, to[velocity])];
                let at = root(ends[0], ends[1], |time| self.step(here, time).0[velocity]);
                include(self.step(here, at).0[i]);
            }
        }
    }
}

/// A zero between two places of different sign: the Illinois method of Dowell and Jarratt (1971), BIT 11, 168.
fn root(
    (mut a, mut at_a): (f64, f64),
    (mut b, mut at_b): (f64, f64),
    f: impl Fn(f64) -> f64,
) -> f64 {
    for _ in 0..60 {
        let middle = (a * at_b - b * at_a) / (at_b - at_a);
        let middle = if middle > a.min(b) && middle < a.max(b) {
            middle
        } else {
            0.5 * (a + b)
        };
        let at_middle = f(middle);
        if at_middle == 0.0 || (b - a).abs() <= 4.0 * f64::EPSILON * b.abs().max(a.abs()) {
            return middle;
        }
        if at_middle * at_b < 0.0 {
            (a, at_a) = (b, at_b);
        } else {
            at_a *= 0.5;
        }
        (b, at_b) = (middle, at_middle);
    }
    b
}
