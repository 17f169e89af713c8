//! What lies between two points that the signs of test functions at both do not show.
//!
//! A function that has one sign at both ends of a step may have passed zero twice: two folds, or two bifurcations of a kind. An orbit of the
//! other sign is looked for [between them](super::dip), and [beside a turn](super::beside_turn), and divides the step. It may be in the step before
//! the last one, since a point beside the second zero says nothing until the next one is known.

use std::iter;

use super::Engine;
use super::dip::{Dip, Within};
use super::seen::{Former, Seen};
use super::sought::{Sought, is_hidden, of_multipliers, sought_from, tests};
use super::step_parts::insert;
use crate::branches::problem::{BranchProblem, Test};
use crate::continuation::newton::Newton;

impl Engine {
    /// A step divided so that no test function changes its sign twice in a part, as far as can be seen. What shows in the step
    /// before it, from the `earlier` point on, is recorded.
    pub(super) fn parts(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        earlier: Option<&Seen>,
        [a, b]: [Seen; 2],
        after: usize,
    ) -> Vec<Seen> {
        let mut parts = self.through_narrow(problem, newton, [a, b]);
        self.doubted = parts.len() > 2;
        self.divide_parts(problem, newton, &mut parts, 0);
        let displaced = self.earlier.take().filter(|_| earlier.is_none());
        let displaced = displaced.filter(|at| at.u.len() == parts[0].point.u.len());
        let displaced = displaced.map(|at| Seen::at(problem, &at, parts[0].falls));
        let former = self.former.take().filter(|_| displaced.is_none());
        if let Some(earlier) = earlier.or(displaced.as_ref()) {
            let mut looks = Vec::new();
            for sought in sought_from(problem, &parts[0]) {
                if sought.is_seen(problem, &parts, earlier) {
                    continue;
                }
                let points = [earlier, &parts[0], &parts[parts.len() - 1]];
                match self.dip(problem, newton, points, &mut looks, sought) {
                    Some(Dip::Last(found)) => insert(newton, &mut parts, found),
                    // Found as the last step, when it was that.
                    Some(Dip::Before(_)) if sought.is_among(&self.divided, after - 1) => {}
                    Some(Dip::Before(found)) => {
                        let parts = [earlier.clone(), found, parts[0].clone()];
                        self.record_pair(problem, newton, &parts, after - 1);
                    }
                    None => {}
                }
                if self.ended.is_some() {
                    return parts;
                }
            }
        }
        if let Some(former) = former {
            self.divide_behind(problem, newton, former, &mut parts);
        }
        self.note_divided(problem, &parts, after);
        self.divided.retain(|(place, _)| *place + 1 >= after);
        let mut index = 0;
        while index + 1 < parts.len() {
            let pair = [&parts[index], &parts[index + 1]];
            // What is only looked at leaves the walk as it is.
            let contraction = newton.contraction();
            let beside = self.beside_turn(problem, newton, pair);
            newton.remember_contraction(contraction);
            if let Some(beside) = beside {
                parts.splice(index + 1..=index, beside);
                index += 2;
            }
            index += 1;
        }
        parts
    }

    /// Records what the first of these points show in the step between the first two that both of its ends do not: that step is behind so many points, and it
    /// was looked at before the third one was known.
    pub(super) fn record_before(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        after: usize,
    ) {
        let mut looks = Vec::new();
        for sought in sought_from(problem, points[1]) {
            if sought.is_copy(problem, [points[0], points[1]]) {
                continue;
            }
            let within = Within::First;
            let found = self.dip_within(problem, newton, points, within, &mut looks, sought);
            let Some(Dip::Before(found)) = found else {
                continue;
            };
            if !sought.is_among(&self.divided, after) {
                let parts = [points[0].clone(), found, points[1].clone()];
                self.record_pair(problem, newton, &parts, after);
            }
            if self.ended.is_some() {
                return;
            }
        }
    }

    /// Divides the first step behind a point that has other unknowns, as far as slopes and multipliers tell: what else there is to compare is of
    /// the equations.
    fn divide_behind(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        former: Former,
        parts: &mut Vec<Seen>,
    ) {
        let mut looks = Vec::new();
        let within = Within::Last(former.way);
        let earlier = former.before(&parts[0]);
        let slope = Sought::Test(Test::Slope);
        let sought = of_multipliers(problem, &parts[0]).into_iter();
        for sought in iter::once(slope).chain(sought) {
            if sought.is_seen(problem, parts, &earlier) {
                continue;
            }
            let points = [&earlier, &parts[0], &parts[parts.len() - 1]];
            let found = self.dip_within(problem, newton, points, within, &mut looks, sought);
            if let Some(Dip::Last(found)) = found {
                insert(newton, parts, found);
            }
        }
    }

    /// Divides parts of one step where a function passes zero twice in one of them, as far as three of their ends tell. So many of the first are no
    /// parts of it, and stay as they are.
    pub(super) fn divide_parts(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &mut Vec<Seen>,
        before: usize,
    ) {
        let mut middle = 1;
        while middle + 1 < parts.len() {
            let mut looks = Vec::new();
            for sought in sought_from(problem, &parts[middle]) {
                let points = [middle - 1, middle, middle + 1].map(|place| &parts[place]);
                let (found, place) = match self.dip(problem, newton, points, &mut looks, sought) {
                    Some(Dip::Last(found)) => (found, middle + 1),
                    Some(Dip::Before(found)) if middle > before => (found, middle),
                    Some(Dip::Before(_)) | None => continue,
                };
                parts.insert(place, found);
                middle += 1;
                break;
            }
            middle += 1;
        }
    }

    /// Notes for which test functions the parts of a step show what its ends do not.
    pub(super) fn note_divided(
        &mut self,
        problem: &dyn BranchProblem,
        parts: &[Seen],
        after: usize,
    ) {
        for test in tests(problem) {
            if is_hidden(problem, parts, test) && !self.divided.contains(&(after, test)) {
                self.divided.push((after, test));
            }
        }
    }
}
