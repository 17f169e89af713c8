//! Orbits of the contact equation, read off where their motion is stiff: they are solved for again at their value with so many nodes that more of them change nothing, and everything
//! is read from what their motion is made of. No motion is integrated.
//!
//! An orbit that is kept has its states at the beginnings of periods. Equations are found as for a first orbit, near the motion by [steps](super::march) from
//! these, and their solution is the same orbit if positions there are the same as far as they are known. With positions `x` of the solution, and `y` of that with
//! more nodes, which is the one that is read, nodes are enough where
//!
//! ```text
//! |y - x| <= 1e-10                                                                                             (1)
//! ```
//!
//! in parts of the size of the orbit, and in the output that the error is of as a part of it; or a hundredth of the stated error where that is more. Beside a fold, where the value tells nothing, the orbit is solved for along
//! the branch: [`held`]. Where no such solution is found there is nothing to be read, nor where nothing turns fast,
//! and integrations are quicker.
//!
//! Source: Stetter (1978), The defect correction principle and discretization methods, Numerische Mathematik 29 (errors from one step on finer equations).

mod held;

use std::f64::consts::TAU;

use self::held::Held;
use super::compute;
use super::equations::Equations;
use super::guess::Guess;
use super::orbit::motion::{Motion, Within};
use super::problem::ContactProblem;
use super::reading::stretch::Read;
use super::run::Run;
use super::switches::fits::Fits;
use crate::branches::observed::{EXTREMES, Motion as Extent, part_of};
use crate::branches::point::Point;
use crate::numeric::roots::Place;
use crate::orbit::observe::Accuracy;
use crate::shooting::complete::{self, Readings};
use crate::shooting::signals::{Found, Reader};
use crate::time::signals::Asked;

/// (1)
const KNOWN: f64 = 1e-10;
const PART: f64 = 1e-2;
/// How often more nodes are taken, and phases at which positions are compared.
const FINER: usize = 6;
const COMPARED: usize = 24;
/// Positions that are farther off than so many times the error, or this part of the size if that is more, are of another orbit.
const FAR: f64 = 100.0;
const ROUNDING: f64 = 1e-9;
/// Where the error is of an output, or not known, positions are not known to it, and are of another orbit beyond this part of the size.
const AT_MOST: f64 = 1e-3;

/// An orbit that was solved for again.
pub(crate) struct Solved<'p> {
    run: Run<'p>,
    value: f64,
}

impl<'p> Solved<'p> {
    /// One that is known by its states. `None` where it is not found by the contact equation.
    pub(crate) fn of(problem: &'p ContactProblem, point: &Point) -> Option<Self> {
        if point.orbit.states.is_empty() {
            return None;
        }
        let guess = Guess::by_steps(problem, point)?;
        Self::at_value(problem, &guess).or_else(|| {
            let cancelled = problem.asked.cancel.is_cancelled();
            (!cancelled).then(|| Self::along(problem, &guess))?
        })
    }

    /// At its value.
    fn at_value(problem: &'p ContactProblem, guess: &Guess<'_>) -> Option<Self> {
        let (mut run, mut u) = compute::like(problem, guess)?;
        loop {
            run.equations.compute(&u, false);
            let Some(overlooked) = run.overlooks() else {
                break;
            };
            u = compute::solved_with(&mut run, &u, overlooked.needed?)?;
        }
        Self::refined(run, u, Held::Value, guess.point)
    }

    /// Along the branch, where its states are.
    fn along(problem: &'p ContactProblem, guess: &Guess<'_>) -> Option<Self> {
        let (mut run, u, held) = held::along(problem, guess)?;
        run.equations.compute(&u, false);
        if run.overlooks().is_some() {
            return None;
        }
        Self::refined(run, u, held, guess.point)
    }

    /// With nodes that are enough.
    fn refined(mut run: Run<'p>, u: Vec<f64>, held: Held, point: &Point) -> Option<Self> {
        refine(&mut run, u, held, point)?;
        let value = point.value;
        let solved = Self { run, value };
        solved.is_at(point).then_some(solved)
    }

    /// Whether it is an orbit that is known.
    fn is_at(&self, point: &Point) -> bool {
        let size = 2.0 * point.size();
        let error = known(point);
        let accuracy = self.run.problem.asked.accuracy;
        let far = match (accuracy, error) {
            (Accuracy::Output(_), Some(error)) => error.max(AT_MOST),
            (_, Some(error)) => FAR * error + ROUNDING,
            (_, None) => AT_MOST,
        };
        let found = self.motion().states_of_parts(point.orbit.states().count());
        let coordinates = point.orbit.coordinates();
        let states = found
            .chunks_exact(2 * coordinates)
            .zip(point.orbit.states());
        let mut pairs = states.flat_map(|(a, b)| a[..coordinates].iter().zip(b));
        let is_near = pairs.all(|(a, b)| (a - b).abs() <= far * size);
        is_near && self.has_output(point)
    }

    /// Whether the output that the error of an orbit is of does the same, as far as it is known.
    fn has_output(&self, point: &Point) -> bool {
        let (Accuracy::Output(output), Some(error)) =
            (self.run.problem.asked.accuracy, known(point))
        else {
            return true;
        };
        let outputs = self.outputs();
        let Some((found, known)) = outputs.get(output).zip(point.observed.outputs.get(output))
        else {
            return true;
        };
        let size = known.peak_to_peak();
        let rounding = ROUNDING * (size + known.farthest());
        found.apart(known) <= FAR * error * size + rounding
    }

    fn equations(&self) -> &Equations {
        &self.run.equations
    }

    fn motion(&self) -> Motion<'_> {
        Motion::of(self.equations())
    }

    fn outputs(&self) -> Vec<Extent> {
        self.run.outputs(self.equations(), self.value)
    }

    /// Signals, with so many harmonics.
    pub(crate) fn found(&self, asked: Asked) -> Vec<Found> {
        let period = self.equations().skeleton.recurrence().period;
        let harmonics = complete::harmonics(&self.run.problem.asked, period);
        self.read(asked, harmonics).found()
    }

    /// The orbit with its series, and everything that is read off.
    pub(crate) fn complete(&self, point: &Point) -> Point {
        let asked = &self.run.problem.asked;
        let motion = self.motion();
        let extent = |[minimum, maximum]: &[Place; 2]| Extent {
            minimum: minimum.value,
            maximum: maximum.value,
            ..Extent::NONE
        };
        let extremes = motion.coordinate_extremes().iter().map(extent).collect();
        let readings = Readings {
            outputs: self.outputs(),
            samples: self.samples(&motion, point),
            extremes,
            contacts: self.read(Asked::Contacts, 0),
        };
        complete::assembled(asked, point, readings)
    }

    /// What is asked for, along the motion.
    fn read(&self, asked: Asked, harmonics: usize) -> Reader<'p> {
        let motion = self.motion();
        let recurrence = self.equations().skeleton.recurrence();
        let problem = &self.run.problem.asked;
        let mut reader = problem.reader(self.value, asked, recurrence, harmonics);
        for interval in 0..motion.intervals() {
            let [from, to] = motion.phases(interval);
            if to > from {
                let motion = &motion;
                reader.include(&Read::new(Within { motion, interval }));
            }
        }
        reader
    }

    /// Positions at equal distances over the period, coordinate by coordinate.
    fn samples(&self, motion: &Motion<'_>, point: &Point) -> Vec<f64> {
        let (coordinates, period) = (point.orbit.coordinates(), point.orbit.period);
        let each = complete::samples(&self.run.problem.asked);
        let count = each * period;
        let mut samples = vec![0.0; coordinates * count];
        let mut state = vec![0.0; 2 * coordinates];
        for index in 0..count {
            motion.at(TAU * index as f64 / each as f64, &mut state);
            for (i, x) in state[..coordinates].iter().enumerate() {
                samples[i * count + index] = *x;
            }
        }
        samples
    }
}

/// The stated error, if there is one.
fn known(point: &Point) -> Option<f64> {
    point.error.filter(|error| error.is_finite())
}

/// Goes over to more nodes, until these are enough by (1). `None` if they never are.
fn refine(run: &mut Run<'_>, mut u: Vec<f64>, mut held: Held, point: &Point) -> Option<()> {
    let enough = known(point).map_or(KNOWN, |error| KNOWN.max(PART * error));
    let mut apart = if run.equations.skeleton.forces > 0 {
        f64::INFINITY
    } else {
        0.0
    };
    run.equations.compute(&u, false);
    for _ in 0..FINER {
        if apart <= enough {
            break;
        }
        let mut finer = run.equations.finer_at(&u)?;
        let mut there = run.equations.rearranged(&finer, &u);
        held = held.rearranged(&run.equations, &finer);
        held.solve(&mut finer, &mut there)?;
        finer.compute(&there, false);
        apart = differ(run, &finer, point);
        u = there;
        run.equations = finer;
    }
    run.equations.compute(&u, false);
    let fits = !run.equations.failed && run.fits(&u) != Fits::No;
    (apart <= enough && fits).then_some(())
}

/// The left of (1): in positions at equal distances, and in the output that the error is of.
fn differ(run: &Run<'_>, finer: &Equations, point: &Point) -> f64 {
    if run.equations.failed || finer.failed {
        return f64::INFINITY;
    }
    let coordinates = point.orbit.coordinates();
    let [own, other] = [&run.equations, finer].map(|of| Motion::of(of).states_of_parts(COMPARED));
    let positions = |index: usize| index % (2 * coordinates) < coordinates;
    let pairs = own.iter().zip(&other).enumerate();
    let pairs = pairs.filter(|(index, _)| positions(*index));
    let apart = pairs.fold(0.0, |most: f64, (_, (a, b))| most.max((a - b).abs()));
    let apart = apart / (2.0 * point.size());
    let Accuracy::Output(output) = run.problem.asked.accuracy else {
        return apart;
    };
    let [own, other] = [&run.equations, finer].map(|of| run.outputs(of, point.value));
    let pair = own.get(output).zip(other.get(output));
    pair.map_or(apart, |(a, b)| {
        let rounding = EXTREMES * f64::EPSILON * a.farthest();
        apart.max(part_of((a.apart(b) - rounding).max(0.0), a.peak_to_peak()))
    })
}
