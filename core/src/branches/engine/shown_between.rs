//! What orbits within a step show that its ends do not: at touches, behind them, and in the middle of what is long between them.
//!
//! Where something happens in a step, other things may happen beside it, and no second difference of its ends is a bound across that. So the step is
//! taken in parts, which are looked at as steps are, and what changes its sign in them more often than between both ends is recorded.

use super::Engine;
use super::seen::{Seen, signs};
use super::sought::tests;
use super::step_parts::{distance, insert, is_on_way, step_between};
use crate::branches::problem::{BranchProblem, Change, Test};
use crate::continuation::locate::inside;
use crate::continuation::newton::Newton;

/// A part of a step is long from this part of it on.
const LONG: f64 = 0.25;
/// Events of one kind and one step whose values differ by less, as a part of the range, are one.
const SAME: f64 = 1e-9;

impl Engine {
    /// Records what an orbit shows inside of a step and its ends do not.
    pub(super) fn record_pair(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &[Seen],
        after: usize,
    ) {
        let known = self.divided.clone();
        let hidden: Vec<Test> = tests(problem)
            .filter(|test| shows_more(problem, parts, *test) && !known.contains(&(after, *test)))
            .collect();
        let first = problem.record().events.len();
        let places = problem.record().turns.len();
        let wanted = |change: &Change| hidden.contains(&change.test);
        for pair in parts.windows(2) {
            self.record_all(problem, newton, [&pair[0], &pair[1]], after, wanted);
            if self.ended.is_some() {
                return;
            }
        }
        let range = (self.options.to - self.options.from).abs();
        problem
            .record_mut()
            .drop_again([first, places], SAME * range);
        let turns = &problem.record().turns;
        self.unlocated.retain(|turn| turns.contains(turn));
        self.note_divided(problem, parts, after);
    }

    /// Records what orbits within a step show, and others between these, and its ends do not.
    pub(super) fn record_between(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [a, b]: [Seen; 2],
        inner: Vec<Seen>,
        after: usize,
    ) {
        if inner.is_empty() {
            return;
        }
        let place = self.seen.iter().position(|seen| seen.point == a.point);
        let earlier = place.and_then(|place| place.checked_sub(1));
        let earlier = earlier.map(|place| self.seen[place].clone());
        let mut parts = vec![a, b];
        for seen in inner {
            insert(newton, &mut parts, seen);
        }
        self.halve_long(problem, newton, &mut parts);
        let before = usize::from(earlier.is_some());
        parts.splice(0..0, earlier);
        self.divide_parts(problem, newton, &mut parts, before);
        if before > 0 {
            self.record_before(
                problem,
                newton,
                [&parts[0], &parts[1], &parts[2]],
                after - 1,
            );
        }
        if self.ended.is_none() {
            self.record_pair(problem, newton, &parts[before..], after);
        }
    }

    /// Adds the orbits in the middle of long parts of a step in which something happens: no second difference is a bound across that.
    fn halve_long(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &mut Vec<Seen>,
    ) {
        let long = LONG * distance(newton, &parts[0].point, &parts[parts.len() - 1].point);
        let contraction = newton.contraction();
        let mut place = 0;
        while place + 1 < parts.len() {
            let pair = [&parts[place], &parts[place + 1]];
            let step = step_between(pair);
            place += 1;
            if distance(newton, step.before, step.next) < long {
                continue;
            }
            let options = self.options.newton;
            let middle = inside(problem.equations(), newton, step, 0.5, options);
            if let Some(middle) = middle.filter(|middle| is_on_way(newton, step, middle)) {
                let falls = parts[place - 1].falls;
                parts.insert(place, Seen::at(problem, &middle, falls));
                place += 1;
            }
        }
        newton.remember_contraction(contraction);
    }
}

/// Whether a test function changes its sign between the parts of a step more often than its ends tell.
fn shows_more(problem: &dyn BranchProblem, parts: &[Seen], test: Test) -> bool {
    let differ = |a: &Seen, b: &Seen| signs(problem, [a, b], test).is_some_and(|[x, y]| x != y);
    let [first, .., last] = parts else {
        return false;
    };
    let changes = parts.windows(2).filter(|pair| differ(&pair[0], &pair[1]));
    changes.count() > usize::from(differ(first, last))
}
