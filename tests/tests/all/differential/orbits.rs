//! Orbits of a branch against what is true of them.

use std::rc::Rc;

use hertzian::{Branch, Point, Stability, Verdict};

use crate::differential::integrate::Lost;
use crate::differential::judge::Case;
use crate::differential::model::{COORDINATES, Model, State};
use crate::differential::report::Kind;
use crate::differential::truth::{Question, Truth, Unsure};

/// Orbits of a branch by the balance, and by shooting or the contact equation, that are looked at.
const ORBITS: [usize; 2] = [3, 1];
/// How far from the true orbit a state may be, relative to the size.
const NEAR: f64 = 1e-2;
/// A motion from a state is lost where the rounding of the state grows to this part of it within the period.
const LOST: f64 = 1e-4;

impl Case {
    /// Some points: anywhere, and an unstable one.
    fn chosen(&mut self, verdicts: &[Verdict], count: usize) -> Vec<usize> {
        let unstable = |index: &usize| verdicts[*index] == Verdict::Unstable;
        let unstable: Vec<usize> = (0..verdicts.len()).filter(unstable).collect();
        let mut chosen = Vec::new();
        for turn in 0..count.min(verdicts.len()) {
            chosen.push(if turn == 1 && !unstable.is_empty() {
                unstable[self.random.below(unstable.len())]
            } else {
                self.random.below(verdicts.len())
            });
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }

    /// Orbits by the balance.
    pub fn orbits(&mut self, branch: &Branch) {
        let verdicts: Vec<_> = branch.points.iter().map(|p| p.stability.verdict).collect();
        let model = Rc::clone(&self.model);
        for index in self.chosen(&verdicts, ORBITS[0]) {
            let point = &branch.points[index];
            let motions = point.observed.motions.iter();
            let size = motions.fold(0.0, |size: f64, m| size.max(0.5 * m.peak_to_peak()));
            let name = format!("balance at {:?}", point.value);
            let question = Question::of(&model, point.value, point.orbit.period, size);
            let state = |part: f64| Ok(state_at(&model, point, part * question.time));
            self.point(&name, &question, state, point);
        }
    }

    /// Orbits of which a state is kept: by shooting, and by the contact equation.
    pub fn cycles(&mut self, method: &str, branch: &Branch) {
        let verdicts: Vec<_> = branch.points.iter().map(|c| c.stability.verdict).collect();
        let model = Rc::clone(&self.model);
        for index in self.chosen(&verdicts, ORBITS[1]) {
            let cycle = &branch.points[index];
            let mut first = State::default();
            let start = cycle.orbit.state();
            let (positions, velocities) = start.split_at(model.coordinates);
            first[..positions.len()].copy_from_slice(positions);
            first[COORDINATES..][..velocities.len()].copy_from_slice(velocities);
            let extremes = cycle.observed.motions.iter();
            let size = extremes.fold(0.0, |size: f64, e| size.max(0.5 * e.peak_to_peak()));
            let name = format!("{method} at {:?}", cycle.value);
            let question = Question::of(&model, cycle.value, cycle.orbit.period, size);
            // From a state that is exact to all digits a motion is lost within a period of such a multiplier; that of the orbit is not.
            let largest = cycle.stability.multipliers.first();
            let is_lost = largest.is_some_and(|m| m.norm() * f64::EPSILON > LOST);
            let completed = is_lost.then(|| branch.complete(cycle).ok()).flatten();
            let state = |part: f64| match &completed {
                Some(point) => Ok(state_at(&model, point, part * question.time)),
                None => question.after(&first, part),
            };
            self.point(&name, &question, state, cycle);
        }
    }

    /// What a point states of its orbit: that it is one, the verdict, the multipliers, the peak-to-peak.
    fn point(
        &mut self,
        name: &str,
        question: &Question<'_>,
        state: impl Fn(f64) -> Result<State, Lost>,
        point: &Point,
    ) {
        // Three times what is stated, of half of a peak-to-peak. Where that is infinite nothing is said of the orbit.
        let allowed = 3.0 * 2.0 * point.error.unwrap_or(0.0);
        let Some(truth) = self.truth(question, state, (name, allowed), &point.stability) else {
            return;
        };
        let Some(stated) = point.error.filter(|error| error.is_finite()) else {
            self.report.count("orbits without a stated error");
            return;
        };
        let stated = stated * point.peak_to_peak();
        let [exact, unsure] = truth.peak_to_peak;
        let error = (point.peak_to_peak() - exact).abs();
        self.stated(
            ("peak-to-peak", Kind::PeakToPeak),
            name,
            [error, stated, unsure],
        );
    }

    /// What is true of an orbit, of which such an error is stated, if it is known; the verdict and the multipliers are compared with it.
    fn truth(
        &mut self,
        question: &Question<'_>,
        state: impl Fn(f64) -> Result<State, Lost>,
        (name, stated): (&str, f64),
        stability: &Stability,
    ) -> Option<Truth> {
        if self.clock.flow().is_break() {
            return None;
        }
        self.report.count("orbits");
        if stability.rigid > 0 {
            // A shift of the whole is not determined: the state that comes back is one of many.
            self.report.count("orbits of a system that nothing holds");
            return None;
        }
        let truth = match question.truth(state) {
            Ok(truth) => truth,
            Err(unsure) => {
                self.unsure((name, stated), unsure, stability);
                return None;
            }
        };
        if truth.correction > NEAR.max(stated) {
            // Motions beside an orbit of which no multiplier is known leave it within its period, and what they close to is any other one.
            let largest = stability.multipliers.first().map_or(f64::NAN, |m| m.norm());
            let leaves = stability.error > largest.max(1.0);
            if truth.error < 0.1 * truth.correction && !leaves {
                let text = format!(
                    "{name}: the true one is {:.1e} of its size away",
                    truth.correction
                );
                self.find(Kind::Elsewhere, text);
            }
            self.report.count("orbits, the truth of which is not sure");
            return None;
        }
        self.verdict(name, &truth, stability);
        Some(truth)
    }

    fn unsure(&mut self, (name, stated): (&str, f64), unsure: Unsure, stability: &Stability) {
        self.report.count(match unsure {
            Unsure::Lost(_) => "orbits, the motion of which was lost",
            Unsure::Singular => "orbits with a multiplier of one",
            Unsure::Open(_) => "orbits that did not close",
            Unsure::Touching => "orbits too near a level to be disturbed",
            Unsure::Growing(_) => "orbits of a multiplier too large to close",
        });
        if let Unsure::Open(left) = unsure
            && left > NEAR.max(stated)
        {
            let largest = stability.multipliers.first().map_or(f64::NAN, |m| m.norm());
            let text = format!("{name}: {left:.1e} of its size open, |mu| {largest:.3e}");
            self.find(Kind::NotClosed, text);
        }
    }

    fn verdict(&mut self, name: &str, truth: &Truth, stability: &Stability) {
        let exact = truth.multipliers[0].norm();
        let unsure = truth.multiplier_error;
        let margin = match stability.verdict {
            Verdict::Stable => exact - 1.0,
            Verdict::Unstable => 1.0 - exact,
            Verdict::Undecided => {
                self.report.count("verdicts undecided");
                return;
            }
        };
        let error = hertzian_tests::distance(&stability.multipliers, &truth.multipliers);
        let stated = stability.error;
        if margin > unsure {
            let largest = stability.multipliers[0].norm();
            let text = format!(
                "{name}: {}, |mu| {largest:.9} +- {stated:.1e}; it is {exact:.9} +- {unsure:.0e}",
                stability.verdict
            );
            self.find(Kind::FalseVerdict, text);
        } else if margin.abs() < unsure {
            self.report.count("verdicts that the truth leaves open");
        } else {
            self.report.count("verdicts that are right");
        }
        self.stated(
            ("multipliers", Kind::Multipliers),
            name,
            [error, stated, unsure],
        );
    }

    /// A true error, the stated one, and what the true one is known to.
    fn stated(
        &mut self,
        (of, kind): (&'static str, Kind),
        name: &str,
        [error, stated, unsure]: [f64; 3],
    ) {
        if unsure > stated {
            self.report.count(match kind {
                Kind::PeakToPeak => "peak-to-peak, stated more exactly than the truth is known",
                _ => "multipliers, stated more exactly than the truth is known",
            });
        }
        let ratio = (error - unsure).max(0.0) / stated;
        if ratio > 3.0 {
            let text =
                format!("{name}: {error:.2e} true (known to {unsure:.0e}), {stated:.2e} stated");
            self.find(kind, text);
        }
        self.report.ratio(of, ratio);
    }
}

/// The state at a time, by the series of an orbit.
fn state_at(model: &Model, point: &Point, time: f64) -> State {
    let mut state = State::default();
    for i in 0..model.coordinates {
        (state[i], state[COORDINATES + i]) = point.orbit.state_at(i, time).unwrap();
    }
    state
}
