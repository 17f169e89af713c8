//! Multipliers outside of the unit circle, counted at the ends of a step and at the events that were located in it.
//!
//! A step in which a pair of multipliers leaves the circle and one of both comes back at minus one looks at its ends like one in which a
//! single multiplier has left. At the event that was located, `k` multipliers besides that which crosses there are outside; where nothing else
//! happens between it and an end of the step,
//!
//! ```text
//! n in { k, k + 1 },    of a pair    n in { k, k + 2 }                                                        (1)
//! ```
//!
//! are outside at that end, and events one after the other lead from the number at one end to that at the other one. Where (1) does not hold, or events that were
//! located do not lead there, the step is halved, and each half is looked at. What is not located there is none if the events
//! that were located between both ends of the half lead by (1) from one number to the other.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 4 (a bifurcation is where the number of
//! multipliers outside of the circle changes).

use super::Engine;
use super::seen::{Seen, changes, is_modulus, signs};
use super::step_parts::step_between;
use crate::branches::moduli;
use crate::branches::point::Event;
use crate::branches::problem::{BranchProblem, Change, Test};
use crate::continuation::locate::inside;
use crate::continuation::newton::Newton;
use crate::event::{EventKind, Turn};

/// A step is divided until it is shorter than this part of its value, which takes fewer halvings than so many: what is so near to an event, as
/// beside a touch, is one with it. Near a fold the value says nothing of that, since it goes as the square of the way; there it is halved as often.
const HALVINGS: usize = 24;
const SHORTEST: f64 = 1e-7;
/// No more events than so many explain a turn.
const MOST: usize = 6;
/// Where a part is divided: in the middle, or beside it if there is no orbit found there.
pub(super) const PLACES: [f64; 5] = [0.5, 0.3, 0.7, 0.1, 0.9];
/// Logarithms of moduli that are as small are those of multipliers that cross together, as copies do.
const TOGETHER: f64 = 1e-6;

impl Engine {
    /// Records what passes the unit circle between two points beside the events from that number on, as far as (1) tells that something does; not if
    /// there are more turns than that by now.
    pub(super) fn record_hidden(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        pair: [&Seen; 2],
        [known, turns, after]: [usize; 3],
    ) {
        // What was not located will not be in a part of it.
        if problem.record().turns.len() > turns {
            return;
        }
        let mut parts = vec![[pair[0].clone(), pair[1].clone()]];
        for _ in 0..HALVINGS {
            let mut halves = Vec::new();
            for [a, b] in parts {
                let located = changes(problem, &a, &b);
                let events = problem.record().events.get(known..).unwrap_or_default();
                let span = span(problem, [&a, &b], events);
                let is_long = span[1] - span[0] > SHORTEST * span[1].abs();
                let alone = events.iter().any(|event| {
                    // A fold may be beyond both ends, and far from both along the branch however near they are in value.
                    let between = is_among(span, event);
                    (event.kind == EventKind::Fold || (is_long && between))
                        && hides(problem, [&a, &b], event)
                });
                let hides = located.iter().any(|change| !is_modulus(change))
                    && (alone || is_long && !follow(problem, [&a, &b], events, &located));
                let middle = hides
                    .then(|| self.middle(problem, newton, [&a, &b]))
                    .flatten();
                let Some(middle) = middle else {
                    continue;
                };
                for pair in [[&a, &middle], [&middle, &b]] {
                    let own = problem.record().turns.len();
                    self.record_all(problem, newton, pair, after, is_modulus);
                    if self.ended.is_some() {
                        return;
                    }
                    self.take_back(problem, pair, known, own);
                }
                if problem.record().turns.len() == turns {
                    halves.extend([[a, middle.clone()], [middle, b]]);
                }
            }
            if halves.is_empty() {
                return;
            }
            parts = halves;
        }
    }

    /// Takes back turns from that number on if events from a number on explain what was looked for. Where the branch bends by more than a right angle between
    /// an event and an orbit, the search along the tangent there passes the event and comes to orbits beyond both.
    fn take_back(
        &mut self,
        problem: &mut dyn BranchProblem,
        pair: [&Seen; 2],
        known: usize,
        turns: usize,
    ) {
        let record = problem.record();
        let events = record.events.get(known..).unwrap_or_default();
        if record.turns.len() == turns || !explain(problem, pair, events) {
            return;
        }
        let taken: Vec<Turn> = problem.record_mut().turns.drain(turns..).collect();
        self.unlocated.retain(|turn| !taken.contains(turn));
    }

    /// An orbit between two others.
    fn middle(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [a, b]: [&Seen; 2],
    ) -> Option<Seen> {
        let (step, options) = (step_between([a, b]), self.options.newton);
        let found = PLACES
            .into_iter()
            .find_map(|part| inside(problem.equations(), newton, step, part, options))?;
        Some(Seen::at(problem, &found, a.falls))
    }
}

/// Whether an event between two points does not agree with what is outside of the unit circle at both.
fn hides(problem: &dyn BranchProblem, pair: [&Seen; 2], event: &Event) -> bool {
    let ends = pair.map(|seen| outside(problem, seen));
    beside(event).is_some_and(|fits| ends.iter().flatten().any(|outside| !fits.contains(outside)))
}

/// The values between two points: where the branch turns between both, up to the fold there as well. Among these events that is the nearest one on the
/// side that the branch goes to.
fn span(problem: &dyn BranchProblem, pair: [&Seen; 2], events: &[Event]) -> [f64; 2] {
    let [a, b] = step_between(pair).parameters();
    let [mut least, mut most] = [a.min(b), a.max(b)];
    let Some([falls, true]) =
        signs(problem, pair, Test::Slope).map(|[before, after]| [before, before != after])
    else {
        return [least, most];
    };
    let (end, sign) = if falls { (least, -1.0) } else { (most, 1.0) };
    let folds = events.iter().filter(|event| event.kind == EventKind::Fold);
    let beyond = folds.filter(|fold| sign * (fold.point.value - end) >= -known_within(fold));
    let values = beyond.map(|fold| fold.point.value);
    let nearest = values.min_by(|x, y| (x - end).abs().total_cmp(&(y - end).abs()));
    if let Some(value) = nearest {
        (least, most) = (least.min(value), most.max(value));
    }
    [least, most]
}

/// Whether an event is among the values between two points, as far as it is known.
fn is_among([from, to]: [f64; 2], event: &Event) -> bool {
    let error = known_within(event);
    (from - error..=to + error).contains(&event.point.value)
}

/// How far the value of an event may be from the true one: no farther than what is one with it, or every part would have an event that is hardly known.
fn known_within(event: &Event) -> f64 {
    event.error.min(SHORTEST * event.point.value.abs())
}

/// Whether some of the events between two points, each of them once, lead from what is outside of the unit circle at one of the points, by (1), to another number at
/// the other one. Beside a fold values do not tell the order of events, so that any is tried.
fn explain(problem: &dyn BranchProblem, pair: [&Seen; 2], events: &[Event]) -> bool {
    let [Some(here), Some(there)] = pair.map(|seen| outside(problem, seen)) else {
        return false;
    };
    let span = span(problem, pair, events);
    let between = |event: &&Event| is_among(span, event);
    let ways: Vec<_> = events.iter().filter(between).filter_map(beside).collect();
    here != there && ways.len() <= MOST && lead(&ways, 0, here, &|_, number| number == there)
}

/// Whether some of the events between two points, among them one of each kind that was located there, lead by (1) from what is outside at one of the
/// points to what is outside at the other one; also where what is outside is not known.
fn follow(
    problem: &dyn BranchProblem,
    pair: [&Seen; 2],
    events: &[Event],
    located: &[Change],
) -> bool {
    let [Some(here), Some(there)] = pair.map(|seen| outside(problem, seen)) else {
        return true;
    };
    let span = span(problem, pair, events);
    let between = |event: &&Event| is_among(span, event);
    let known = events.iter().filter(between);
    let known: Option<Vec<_>> = known
        .map(|event| Some((event.kind, beside(event)?)))
        .collect();
    let Some(known) = known.filter(|known| known.len() <= MOST) else {
        return true;
    };
    let ways: Vec<_> = known.iter().map(|(_, way)| *way).collect();
    let is_met = |used: u32| {
        located
            .iter()
            .filter(|change| !is_modulus(change))
            .all(|change| {
                let mut of_kind = (0..known.len()).filter(|index| known[*index].0 == change.kind);
                let used = |index: usize| used & (1 << index) != 0;
                of_kind.clone().next().is_none() || of_kind.any(used)
            })
    };
    lead(&ways, 0, here, &|used, number| {
        number == there && is_met(used)
    })
}

/// Whether ways of which some are used lead from a number to one that is asked for, with the ways that are used then.
fn lead(
    ways: &[[usize; 2]],
    used: u32,
    here: usize,
    is_there: &dyn Fn(u32, usize) -> bool,
) -> bool {
    is_there(used, here)
        || ways.iter().enumerate().any(|(index, [one, other])| {
            let own = 1 << index;
            let next = match here {
                _ if here == *one => other,
                _ if here == *other => one,
                _ => return false,
            };
            used & own == 0 && lead(ways, used | own, *next, is_there)
        })
}

/// The numbers of multipliers outside of the unit circle on both sides of an event, by (1), if its own tell.
fn beside(event: &Event) -> Option<[usize; 2]> {
    let multipliers = &event.point.stability.multipliers;
    let (critical, _) = moduli::nearest(multipliers);
    let crossing = if event.kind == EventKind::NeimarkSacker {
        2
    } else {
        1
    };
    let conjugate = |place: usize| {
        crossing == 2 && (multipliers[place] - multipliers[critical].conj()).norm() < TOGETHER
    };
    let others = (0..multipliers.len()).filter(|place| *place != critical && !conjugate(*place));
    let others: Vec<f64> = others
        .map(|place| moduli::logarithm(multipliers, place))
        .collect();
    let noise = TOGETHER.max(event.point.stability.error);
    if multipliers.is_empty() || !others.iter().all(|modulus| modulus.abs() > noise) {
        return None;
    }
    let others = others.iter().filter(|modulus| **modulus > 0.0).count();
    Some([others, others + crossing])
}

/// Number of multipliers outside of the unit circle at a point, if that is known.
fn outside(problem: &dyn BranchProblem, seen: &Seen) -> Option<usize> {
    let watched = problem.watched().iter().enumerate();
    let moduli = watched
        .filter(|(_, watched)| !watched.bordered && watched.kind == EventKind::NeimarkSacker);
    let mut moduli = moduli.peekable();
    moduli.peek()?;
    moduli.try_fold(0, |count, (index, _)| {
        let value = seen.values[index];
        let tells = value.is_known() && value.mantissa.abs() > problem.noise(index);
        tells.then(|| count + usize::from(!value.is_negative()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fold leads from no multiplier outside to one, a torus to three and a doubling to four: not without the torus, and none of them twice.
    #[test]
    fn a_torus_between_a_fold_and_a_doubling_is_asked_for() {
        let [fold, torus, doubling] = [[0, 1], [1, 3], [3, 4]];
        let leads = |ways: &[[usize; 2]], to: usize| lead(ways, 0, 0, &|_, n| n == to);
        assert!(leads(&[doubling, fold, torus], 4));
        assert!(!leads(&[doubling, fold], 4));
        assert!(leads(&[fold], 1));
        assert!(!lead(&[fold], 0, 0, &|used, n| used == 1 && n == 0));
        let twice = |used: u32, n: usize| used == 3 && n == 0;
        assert!(lead(&[fold, fold], 0, 0, &twice));
    }
}
