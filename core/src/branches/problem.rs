//! What a method of computing periodic orbits gives to the [engine](super::engine) that follows branches of them.
//!
//! The engine knows the curve, test functions and what their changes of sign mean. A method knows its equations, how orbits are read
//! off solutions, what errors it makes, and where its branches end because they become those of more regular orbits.

use nalgebra::Complex;

use super::engine::Walk;
use super::extreme::Extreme;
use super::record::{Kept, Record};
use crate::continuation::follow::{Continue, CurvePoint, Halted, Step, Stop};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::{AsProblem, Problem};
use crate::event::EventKind;
use crate::laws::generic::narrow::Narrow;

/// Value of a test function: `mantissa exp(exponent)`, since determinants of many unknowns leave the range of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct TestValue {
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) mantissa: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) exponent: f64,
}

impl TestValue {
    /// It was not computed, or cannot be.
    pub(crate) const UNKNOWN: Self = Self::plain(f64::NAN);

    /// A number.
    pub(crate) const fn plain(value: f64) -> Self {
        Self {
            mantissa: value,
            exponent: 0.0,
        }
    }

    /// In units of `exp(reference)`.
    pub(crate) fn relative_to(self, reference: f64) -> f64 {
        self.mantissa * (self.exponent - reference).exp()
    }

    pub(crate) fn is_known(self) -> bool {
        !self.mantissa.is_nan()
    }

    /// Zero counts for one side, so that an event at a point belongs to one step.
    pub(crate) fn is_negative(self) -> bool {
        self.mantissa < 0.0
    }
}

/// A test function that the engine watches besides the slope of the parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Watched {
    /// What happens where it vanishes.
    pub(crate) kind: EventKind,
    /// It is the determinant of the equations with the tangent as their border (Keller 1977), which stays away from zero at a fold.
    pub(crate) bordered: bool,
}

/// What became of a point that was given to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Read {
    /// It was kept.
    Kept,
    /// It was kept, and the walk goes on with other unknowns.
    Resize,
    /// It was kept, and the walk goes on with other unknowns once the step to it has been looked at in the present ones.
    ResizeBehind,
    /// It is to be read again with other unknowns.
    Refused,
    /// The step to it is to be made again, shorter; where there is none, it is refused.
    TooFar,
    /// No equations are found for what is behind the point before it: the walk ends.
    Lost,
    /// It was kept, and the walk ends: the caller asked for it, or the orbit could not be read.
    Stop,
}

/// What became of a place where a test function vanishes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ZeroOutcome {
    /// It is an event.
    Event,
    /// Nothing happens there.
    Nothing,
    /// It could not be read.
    Unread,
    /// It is an event, or one passed before, and the branch ends there.
    Ends(Stop),
}

/// A test function of an event: the slope of the parameter, or one that is [`Watched`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub(crate) enum Test {
    Slope,
    Watched(usize),
}

/// A sign that changes within a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Change {
    pub(crate) test: Test,
    pub(crate) kind: EventKind,
}

/// Where a test function was located.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Root {
    pub(crate) located: Located,
    /// What the search leaves in the parameter.
    pub(crate) error: f64,
}

/// A zero of a test function.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Zero {
    pub(crate) change: Change,
    pub(crate) root: Root,
    /// Test functions are in units of `exp(reference)`.
    pub(crate) reference: f64,
    /// How much the test function changes with the parameter, at least: from the zero to either end of the step.
    pub(crate) steepness: f64,
    /// The lesser of its sizes at both ends.
    pub(crate) least: f64,
    /// Another test function, which is no modulus, changes its sign in the step too.
    pub(crate) told: bool,
    /// Number of points of the branch before it.
    pub(crate) after: usize,
}

/// An orbit of which a gap touches a level.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Touch {
    /// The test function is the extreme less its level.
    pub(crate) located: Located,
    pub(crate) extreme: Extreme,
    /// What the search leaves in the parameter.
    pub(crate) error: f64,
    /// What the parameter changes by while the extreme rises by half of the gap's range.
    pub(crate) rate: f64,
    /// Number of contacts that touch a level.
    pub(crate) contacts: usize,
    /// Whether the branch turns back there.
    pub(crate) turns: bool,
    /// Number of points of the branch before it.
    pub(crate) after: usize,
}

/// Equations of periodic orbits by some method. Unknowns may change in number and meaning after any point.
pub(crate) trait BranchProblem {
    /// The equations alone.
    fn equations(&mut self) -> &mut dyn Problem;

    /// Test functions besides the slope of the parameter.
    fn watched(&self) -> &[Watched];

    /// Value of a test function, unknown where the orbit cannot be looked at.
    fn test(&mut self, index: usize, at: &CurvePoint) -> TestValue;

    /// Component of the unit tangent along the parameter, in units of its scale, between points of a branch.
    fn slope(&mut self, at: &CurvePoint) -> f64 {
        at.parameter_slope()
    }

    /// Logarithms of the complex multipliers with a positive imaginary part, where moduli are watched.
    fn pairs(&mut self, at: &CurvePoint) -> Option<Vec<Complex<f64>>> {
        let _ = at;
        None
    }

    /// What is smaller is rounding: of all test functions, and of the slope.
    fn vanishing(&self) -> f64 {
        self.aim()
    }

    /// A function that is smaller at both ends of a step is rounding all along.
    fn noise(&self, index: usize) -> f64 {
        let _ = index;
        0.0
    }

    /// Whether a test function is of multipliers alone, and so the same whatever the unknowns are.
    fn is_of_multipliers(&self, index: usize) -> bool {
        self.watched()[index].kind == EventKind::NeimarkSacker
    }

    /// A test function is driven below this.
    fn aim(&self) -> f64;

    /// Whether a test function has vanished, or jumps where it was located.
    fn vanishes(&mut self, change: Change, located: &Located) -> bool;

    /// What was gathered so far.
    fn record(&self) -> &Record;

    /// The same, to be changed.
    fn record_mut(&mut self) -> &mut Record;

    /// Number of points kept.
    fn points(&self) -> usize {
        self.record().points.len()
    }

    /// What was kept so far.
    fn kept(&self) -> Kept<'_> {
        self.record().kept()
    }

    /// Whether a point belongs to what comes after the end of the branch. It is not kept then.
    fn is_beyond(&mut self, at: &CurvePoint) -> bool {
        let _ = at;
        false
    }

    /// The branch point that the step to a point beyond the end passes, where the branch ends on another one, if that is known.
    fn joint(
        &mut self,
        newton: &mut Newton,
        step: Step<'_>,
        options: NewtonOptions,
    ) -> Option<CurvePoint> {
        let _ = (newton, step, options);
        None
    }

    /// The step to a point beyond the end is made again: nothing has ended yet.
    fn goes_on(&mut self) {}

    /// Ends the branch within the step to a point beyond its end. If it only seemed to be one, the point is kept, and how it was read
    /// returned: the walk cannot be halted there for other unknowns.
    fn end(&mut self, newton: &mut Newton, step: Step<'_>, options: NewtonOptions) -> Option<Read> {
        let _ = (newton, step, options);
        None
    }

    /// Reads the orbit at a point, whose factors Newton's method holds, and keeps it.
    fn read(&mut self, newton: &mut Newton, at: &CurvePoint) -> Read;

    /// Reads a zero of a test function, whose factors Newton's method holds unless branches cross there, and keeps it.
    fn keep(&mut self, newton: &mut Newton, step: Step<'_>, zero: &Zero) -> ZeroOutcome;

    /// Whether touches of levels are looked for. Where the force jumps they always are.
    fn seeks_touches(&self) -> bool {
        false
    }

    /// Whether the force jumps at a level of some contact.
    fn force_jumps(&self) -> bool {
        false
    }

    /// Whether the branch may have a corner of any angle where a level is touched: the force jumps there, or its slope is unbounded.
    fn corners(&self) -> bool {
        self.force_jumps()
    }

    /// Writes the extremes of all gaps over the period of a solution, seen from all levels: in order of contacts, levels and phases.
    /// Says whether they could be read.
    fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        let _ = (u, extremes);
        false
    }

    /// The same of the gaps alone whose laws may have narrow places, seen from zero; where there are none nothing is read.
    fn plain_extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        let _ = (u, extremes);
        false
    }

    /// Whether orbits in a narrow place of a law, or beside a touch where the force jumps, are known as well as others. Of few harmonics there they are
    /// not, and what happens between them may be theirs alone: they are not made points of the branch, and no more of them are looked for.
    fn resolves_sharp(&self) -> bool {
        true
    }

    /// Adds the narrow places that the law of a contact has at a solution in a range of its gap.
    fn narrow_places(&mut self, u: &[f64], contact: usize, range: [f64; 2], to: &mut Vec<Narrow>) {
        let _ = (u, contact, range, to);
    }

    /// Adds gaps at fixed phases to the extremes, seen from levels where the force jumps, if the unknowns have a kink where such a gap
    /// passes a level.
    fn add_beginnings(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) {
        let _ = (u, extremes);
    }

    /// Writes the linear form of extended unknowns that gap less level is where an extreme of a solution lies, in its units. Of the
    /// parameter a part of this `range` is little. Says whether that is known.
    fn extreme_form(&mut self, u: &[f64], extreme: &Extreme, range: f64, form: &mut [f64]) -> bool {
        let _ = (u, extreme, range, form);
        false
    }

    /// Unknowns near those of a solution, in which an extreme has about a height, in its units: where an unknown tells that, on the other side of
    /// a level where the force jumps too.
    fn lifted(&mut self, u: &[f64], extreme: &Extreme, height: f64) -> Option<Vec<f64>> {
        let _ = (u, extreme, height);
        None
    }

    /// Whether the equations, as they are now, are those of the motion at a solution: other gaps may have passed their levels.
    fn describes(&mut self, at: &CurvePoint) -> bool {
        let _ = at;
        true
    }

    /// How slowly, at a solution, a gap passes a level where the force jumps while it is slowed down: the height at which it would turn,
    /// in units of half of the gap's range. The least of all; infinite where there is none, or it is not known.
    fn slowest(&mut self, u: &[f64]) -> f64 {
        let _ = u;
        f64::INFINITY
    }

    /// Reads the orbit at a touch, whose factors Newton's method holds, and keeps it as an event. It was found near a step.
    fn keep_touch(&mut self, newton: &mut Newton, step: Step<'_>, touch: &Touch) {
        let _ = (newton, step, touch);
    }

    /// Takes more of the equations into the matrix from here on. Says whether there was something to take.
    fn couple_fully(&mut self) -> bool {
        false
    }

    /// The same for one search; `false` takes it back.
    fn couple_fully_once(&mut self, on: bool) -> bool {
        let _ = on;
        false
    }

    /// Changes the unknowns as the last point asked for, and the vectors of a walk with them.
    fn remap(&mut self, halted: &mut Halted) {
        let _ = halted;
    }

    /// Takes the last change back, since nothing was found with it. What changes its unknowns in [`remap`](Self::remap) must do so here.
    fn revert(&mut self) {}

    /// Remembers where the walk is, in case that it is interrupted in the next step. The walk ends where this breaks.
    fn onward(&mut self, walk: Walk) -> Continue {
        let _ = walk;
        Continue::Continue(())
    }

    /// Adds up the work of a walk that ended or is resumed.
    fn count(&mut self, newton: &Newton);
}

impl AsProblem for dyn BranchProblem + '_ {
    fn problem(&mut self) -> &mut dyn Problem {
        self.equations()
    }
}
