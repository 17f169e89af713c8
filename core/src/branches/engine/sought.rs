//! Functions that may pass zero twice within a step: all test functions, and those of two pairs of multipliers that may meet.

use super::meeting::Meeting;
use super::seen::{Seen, signs};
use crate::branches::problem::{BranchProblem, Test, TestValue};
use crate::event::EventKind;

/// Below this a test function is rounding.
pub(super) fn noise_of(problem: &dyn BranchProblem, test: Test, at: &Seen) -> f64 {
    match test {
        Test::Slope => at.point.narrowness() * problem.vanishing(),
        Test::Watched(index) => problem.noise(index).max(problem.vanishing()),
    }
}

/// All test functions.
pub(super) fn tests(problem: &dyn BranchProblem) -> impl Iterator<Item = Test> + use<> {
    let watched = (0..problem.watched().len()).map(Test::Watched);
    [Test::Slope].into_iter().chain(watched)
}

/// A function that may pass zero twice within a step.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sought {
    Test(Test),
    /// That of two pairs of multipliers, whose moduli tell it afterwards.
    Meeting(Meeting),
}

impl Sought {
    pub(super) fn value(self, seen: &Seen) -> TestValue {
        match self {
            Self::Test(test) => seen.value(test),
            Self::Meeting(meeting) => meeting.value(seen),
        }
    }

    /// What falls steeply and is not of multipliers alone is that of a branch which bends, or which another one crosses: tangents tell little of
    /// which way it goes there.
    pub(super) fn may_have_kinks(self, problem: &dyn BranchProblem) -> bool {
        match self {
            Self::Test(Test::Slope) => false,
            Self::Test(Test::Watched(index)) => problem.is_of_multipliers(index),
            Self::Meeting(_) => true,
        }
    }

    /// Whether another one tells the same between these points.
    pub(super) fn is_copy(self, problem: &dyn BranchProblem, points: [&Seen; 2]) -> bool {
        matches!(self, Self::Test(test) if is_conjugate(problem, points, test))
    }

    /// Whether the parts of a step show already what it would tell.
    pub(super) fn is_seen(
        self,
        problem: &dyn BranchProblem,
        parts: &[Seen],
        earlier: &Seen,
    ) -> bool {
        match self {
            Self::Test(test) => {
                is_hidden(problem, parts, test) || self.is_copy(problem, [earlier, &parts[0]])
            }
            Self::Meeting(_) => {
                let mut moduli = moduli(problem);
                moduli.any(|index| is_hidden(problem, parts, Test::Watched(index)))
            }
        }
    }

    /// Whether a step behind so many points was divided for it.
    pub(super) fn is_among(self, divided: &[(usize, Test)], after: usize) -> bool {
        matches!(self, Self::Test(test) if divided.contains(&(after, test)))
    }
}

/// All that are looked at from an orbit on.
pub(super) fn sought_from(problem: &dyn BranchProblem, seen: &Seen) -> Vec<Sought> {
    let meetings = meetings(problem, seen);
    tests(problem).map(Sought::Test).chain(meetings).collect()
}

/// Those of them that are of multipliers.
pub(super) fn of_multipliers(problem: &dyn BranchProblem, seen: &Seen) -> Vec<Sought> {
    let watched = 0..problem.watched().len();
    let of_map = watched.filter(|index| problem.is_of_multipliers(*index));
    let of_map = of_map.map(|index| Sought::Test(Test::Watched(index)));
    of_map.chain(meetings(problem, seen)).collect()
}

/// All pairs of multipliers beside each other.
fn meetings(problem: &dyn BranchProblem, seen: &Seen) -> impl Iterator<Item = Sought> + use<> {
    let moduli = moduli(problem).next();
    let meetings = moduli.map(|index| Meeting::all(seen, problem.noise(index)));
    meetings.into_iter().flatten().map(Sought::Meeting)
}

/// The moduli of multipliers among what is watched.
fn moduli(problem: &dyn BranchProblem) -> impl Iterator<Item = usize> + use<'_> {
    let watched = problem.watched().iter().enumerate();
    let moduli = watched.filter(|(_, watched)| watched.kind == EventKind::NeimarkSacker);
    moduli.map(|(index, _)| index)
}

/// Whether a test function has one sign at both ends of a step and the other one inside.
pub(super) fn is_hidden(problem: &dyn BranchProblem, parts: &[Seen], test: Test) -> bool {
    let [first, inner @ .., last] = parts else {
        return false;
    };
    let differ = |ends: [&Seen; 2]| signs(problem, ends, test).map(|[x, y]| x != y);
    differ([first, last]) == Some(false)
        && inner.iter().any(|seen| differ([first, seen]) == Some(true))
}

/// Whether it is the modulus of the second of a pair, which tells what that of the first does.
fn is_conjugate(problem: &dyn BranchProblem, points: [&Seen; 2], test: Test) -> bool {
    let Test::Watched(index) = test else {
        return false;
    };
    let watched = problem.watched();
    let of_modulus = |index: usize| watched[index].kind == EventKind::NeimarkSacker;
    index > 0
        && of_modulus(index)
        && of_modulus(index - 1)
        && points
            .iter()
            .all(|seen| seen.values[index] == seen.values[index - 1])
}
