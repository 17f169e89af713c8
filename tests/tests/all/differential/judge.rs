//! One model: its branches by both methods in both directions, compared with each other and with what is true of some orbits.

use std::cell::Cell;
use std::error::Error as _;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::{Duration, Instant};

use hertzian::error::chain;
use hertzian::generic::Declaration;
use hertzian::time::FlowError;
use hertzian::{
    Branch, ContactEquation, Error, FrequencyResponse, ModelError, OrbitError, Shooting,
};
use hertzian_tests::random::Random;

use crate::differential::draw;
use crate::differential::model::Model;
use crate::differential::report::{Kind, Report};
use crate::differential::truth::{Question, Settles, settles};
use hertzian_tests::passage::{Passage, Walked, as_far, matched};

/// Points of a branch by the balance and by shooting at most.
const POINTS: [usize; 2] = [120, 80];
/// Time of the processor that a model may take by the balance and by shooting, and as much again by the contact equation. What is begun is
/// ended, so that some take longer.
const BUDGET: Duration = Duration::from_secs(3);
/// Units of time and length of the other declaration of a model.
const UNITS: [f64; 2] = [1e5, 1e5];
/// Periods in which a motion from rest has to settle where no orbit was found.
const SETTLING: usize = 1000;

/// How two branches of a model are compared: what is counted, and what is said.
struct Pair {
    pairs: &'static str,
    events: &'static str,
    /// What an event is that only one of them has.
    alone: Kind,
    /// Where the other one of two events was found.
    other: &'static str,
}

/// The same of two branches that are compared only if both go from end to end.
struct Whole {
    /// One of them does not.
    early: &'static str,
    /// They are not one branch.
    apart: &'static str,
    pair: Pair,
}

/// A branch, and the same backwards.
const DIRECTIONS: Whole = Whole {
    early: "pairs of directions with a branch that ends early",
    apart: "pairs of directions on two branches",
    pair: Pair {
        pairs: "pairs of directions",
        events: "events, forth and back",
        alone: Kind::OneDirection,
        other: "backwards",
    },
};

/// By the balance, and by shooting.
const METHODS: Whole = Whole {
    early: "pairs of methods with a branch that ends early",
    apart: "pairs of methods on two branches",
    pair: Pair {
        pairs: "pairs of methods",
        events: "events, balance and shooting",
        alone: Kind::OneMethod,
        other: "by shooting",
    },
};

/// By shooting, and by the contact equation.
const CONTACT: Whole = Whole {
    early: "pairs with the contact equation with a branch that ends early",
    apart: "pairs with the contact equation on two branches",
    pair: Pair {
        pairs: "pairs of shooting and the contact equation",
        events: "events, shooting and the contact equation",
        alone: Kind::OneEquation,
        other: "by the contact equation",
    },
};

/// A branch, and the same in other units.
const IN_UNITS: Pair = Pair {
    pairs: "pairs of units",
    events: "events, in two units",
    alone: Kind::OtherUnits,
    other: "in other units",
};

/// One model at work.
pub struct Case {
    index: u64,
    pub model: Rc<Model>,
    pub random: Random,
    pub clock: Clock,
    pub report: Report,
}

/// Time of the processor, and whether what is at work was cut short.
pub struct Clock {
    begun: Duration,
    out: Cell<bool>,
}

impl Clock {
    fn spent(&self) -> Duration {
        now().saturating_sub(self.begun)
    }

    /// To go on, or not.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.spent() > BUDGET {
            self.out.set(true);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

/// What this thread has worked, where the system tells (Linux does), or the time.
fn now() -> Duration {
    thread_local! {
        static STARTED: Instant = Instant::now();
    }
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let spent = text.split_whitespace().next().and_then(|t| t.parse().ok());
    spent.map_or_else(|| STARTED.with(Instant::elapsed), Duration::from_nanos)
}

impl Case {
    pub fn of(index: u64) -> Self {
        Self {
            index,
            model: Rc::new(draw::model(index, [1.0; 2])),
            random: Random::of(!index),
            clock: Clock {
                begun: now(),
                out: Cell::new(false),
            },
            report: Report::default(),
        }
    }

    /// What it comes to.
    pub fn judged(mut self) -> Report {
        self.report.count("models");
        match self.model.declared() {
            Ok(system) => self.compare(&system),
            Err(error) => self.find(Kind::Refused, error.to_string()),
        }
        if self.clock.out.get() {
            self.report.count("models that ran out of time");
        }
        if !self.report.findings.is_empty() {
            self.report.texts.insert(self.index, self.text());
        }
        let spent = self.clock.spent().as_secs_f64();
        self.report.times.push((spent, self.index));
        self.report
    }

    /// The declaration and the range.
    pub fn text(&self) -> String {
        let [from, to] = self.model.range;
        let given = self.model.parameters.iter().map(|p| (&p.name, p.value));
        format!(
            "{}{:?}\nfrom {from:?} to {to:?}\n",
            self.model.text(),
            given.collect::<Vec<_>>()
        )
    }

    pub fn find(&mut self, kind: Kind, text: String) {
        self.report.find(kind, self.index, text);
    }

    fn compare(&mut self, system: &Declaration) {
        let [from, to] = self.model.range;
        let Some((forth, branch)) = self.balance("balance", system, [from, to], true) else {
            return;
        };
        let back = self.balance("balance, backwards", system, [to, from], false);
        if let Some((back, _)) = &back {
            self.whole(&DIRECTIONS, &forth, back);
        }
        let shot = self.shooting("shooting", system, [from, to], true);
        if let Some(shot) = &shot {
            self.whole(&METHODS, &forth, shot);
        }
        self.other_units(&forth, &branch);
        if let Some(shot) = &shot
            && let Some(back) = self.shooting("shooting, backwards", system, [to, from], false)
        {
            self.whole(&DIRECTIONS, shot, &back);
        }
        self.clock.begun = now();
        let other = self.contact_equation("contact equation", system, [from, to], true);
        if let (Some(shot), Some(other)) = (&shot, &other) {
            self.whole(&CONTACT, shot, other);
        }
        let name = "contact equation, backwards";
        if let Some(other) = other
            && let Some(back) = self.contact_equation(name, system, [to, from], false)
        {
            self.whole(&DIRECTIONS, &other, &back);
        }
    }

    /// A branch by the contact equation. Some systems have no equations, and some first orbits are not found: both are counted.
    fn contact_equation(
        &mut self,
        name: &'static str,
        system: &Declaration,
        [from, to]: [f64; 2],
        judge: bool,
    ) -> Option<Passage> {
        if self.clock.flow().is_break() {
            return None;
        }
        let request = FrequencyResponse::of(system).by(ContactEquation::new());
        let request = request.from(from).to(to).max_points(POINTS[0]);
        let Ok(branch) = request.run_with(|_| self.clock.flow()) else {
            let what = "branches by the contact equation that did not begin";
            self.report.count(what);
            return None;
        };
        self.report.count("branches by the contact equation");
        let passage = Passage::of(name, &branch);
        if judge {
            self.cycles(name, &branch);
        }
        self.passed(&passage).then_some(passage)
    }

    /// A branch by the balance, its orbits judged.
    fn balance(
        &mut self,
        name: &'static str,
        system: &Declaration,
        [from, to]: [f64; 2],
        judge: bool,
    ) -> Option<(Passage, Branch)> {
        if self.clock.flow().is_break() {
            return None;
        }
        let request = FrequencyResponse::of(system)
            .from(from)
            .to(to)
            .bifurcations(true)
            .max_points(POINTS[0]);
        let branch = match request.run_with(|_| self.clock.flow()) {
            Ok(branch) => branch,
            Err(error) => {
                self.no_branch(name, from, &error);
                return None;
            }
        };
        self.report.count("branches by the balance");
        let passage = Passage::of(name, &branch);
        if judge {
            self.orbits(&branch);
        }
        self.passed(&passage).then_some((passage, branch))
    }

    fn shooting(
        &mut self,
        name: &'static str,
        system: &Declaration,
        [from, to]: [f64; 2],
        judge: bool,
    ) -> Option<Passage> {
        if self.clock.flow().is_break() {
            return None;
        }
        let request = FrequencyResponse::of(system)
            .by(Shooting::new())
            .from(from)
            .to(to)
            .max_points(POINTS[1]);
        let branch = match request.run_with(|_| self.clock.flow()) {
            Ok(branch) => branch,
            Err(error) => {
                self.no_branch(name, from, &error);
                return None;
            }
        };
        self.report.count("branches by shooting");
        let passage = Passage::of(name, &branch);
        if judge {
            self.cycles(name, &branch);
        }
        self.passed(&passage).then_some(passage)
    }

    /// Whether a branch has points, and all of them are numbers; changes of the verdict.
    fn passed(&mut self, passage: &Passage) -> bool {
        let mut places = passage.places.iter();
        if let Some(place) = places.find(|place| !place.peak_to_peak.is_finite()) {
            self.find(Kind::NotFinite, format!("{}: {place:?}", passage.name));
            return false;
        }
        for text in passage.unexplained() {
            self.find(Kind::ChangeWithoutEvent, text);
        }
        if !passage.whole {
            self.report
                .count("branches that ended before the end of the range");
        }
        !passage.places.is_empty()
    }

    fn no_branch(&mut self, name: &str, value: f64, error: &Error) {
        let refused = || format!("{name} from {value:?}: {}", chain(error));
        let source = error.source();
        let motion = source.and_then(|source| source.downcast_ref());
        if let Some(reason) = motion.or_else(|| error.downcast_ref()) {
            if let FlowError::Rests { .. } | FlowError::StepTooShort { .. } = reason {
                self.find(Kind::Refused, refused());
            } else {
                self.report
                    .count("branches that did not begin: a motion was lost");
            }
            return;
        }
        if let Some(ModelError::Free { .. }) = error.downcast_ref()
            && self.model.is_free()
        {
            self.report
                .count("branches that did not begin: nothing holds the system");
            return;
        }
        let carried = matches!(error.downcast_ref(), Some(ModelError::CarriedAway { .. }));
        let none = matches!(
            error.downcast_ref(),
            Some(
                OrbitError::NoStart { .. }
                    | OrbitError::SearchLimit { .. }
                    | OrbitError::NoSuchPeriod { .. }
            )
        );
        if !carried && !none {
            self.find(Kind::Refused, refused());
            return;
        }
        self.report.count("branches without a start");
        let model = Rc::clone(&self.model);
        let question = Question::of(&model, value, 1, model.size);
        let settled = settles(&question, SETTLING, || self.clock.flow().is_break());
        match settled {
            Settles::Yes => self.find(Kind::NoStart, format!("{name} from {value:?}: {error}")),
            Settles::Anywhere => self.report.count(
                "branches without a start where nothing holds what motion from rest settles to",
            ),
            Settles::No => self
                .report
                .count("branches without a start where motion from rest does not settle"),
            Settles::Unseen => self
                .report
                .count("branches without a start, and no time to see whether motion settles"),
        }
    }

    /// Events of a branch against those of the other one, where both go from end to end.
    fn whole(&mut self, whole: &Whole, one: &Passage, other: &Passage) {
        if !(one.whole && other.whole) {
            return self.report.count(whole.early);
        }
        if !one.shares_ends(other) {
            return self.report.count(whole.apart);
        }
        self.events(&whole.pair, one, other);
    }

    /// Events of two branches that are one.
    fn events(&mut self, pair: &Pair, one: &Passage, other: &Passage) {
        self.report.count(pair.pairs);
        let matched = matched(one, other, self.model.range);
        for (alone, missing) in matched.alone.iter().zip([other, one]) {
            for event in alone {
                let text = format!("{event} is missing by {}", missing.name);
                let placed = event.error.is_finite();
                self.find(if placed { pair.alone } else { Kind::Unplaced }, text);
            }
        }
        for (ratio, event, seen) in matched.both {
            let text = format!("{event}, {} {seen}", pair.other);
            self.event(pair.events, ratio, &text);
        }
    }

    fn event(&mut self, name: &'static str, ratio: f64, text: &str) {
        if ratio > 3.0 {
            self.find(Kind::EventValue, text.to_owned());
        }
        self.report.ratio(name, ratio);
    }

    /// The same model in other units.
    fn other_units(&mut self, passage: &Passage, branch: &Branch) {
        let model = draw::model(self.index, UNITS);
        let [from, to] = model.range;
        let system = match model.declared() {
            Ok(system) => system,
            Err(error) => return self.find(Kind::Refused, format!("in other units: {error}")),
        };
        let other = self.balance("balance in other units", &system, [from, to], false);
        let Some((mut other, other_branch)) = other else {
            return;
        };
        // Back to the units of the passage.
        for place in &mut other.places {
            place.value *= UNITS[0];
            place.peak_to_peak /= UNITS[1];
        }
        for event in &mut other.events {
            event.value *= UNITS[0];
            event.error *= UNITS[0];
            event.peak_to_peak /= UNITS[1];
        }
        if passage.whole != other.whole || !passage.shares_ends(&other) {
            if self.clock.out.get() {
                return;
            }
            let walked = |passage: &Passage, branch, units| Walked {
                passage: passage.clone(),
                branch,
                units,
            };
            let one = walked(passage, branch, [1.0; 2]);
            let two = walked(&other, &other_branch, [UNITS[0], UNITS[1].recip()]);
            if let Some([one, two]) = as_far(&one, &two) {
                return self.events(&IN_UNITS, &one, &two);
            }
            let text = format!(
                "{} points, then {}; in other units {} points, then {}",
                passage.places.len(),
                passage.ended,
                other.places.len(),
                other.ended
            );
            return self.find(Kind::OtherUnits, text);
        }
        self.events(&IN_UNITS, passage, &other);
    }
}
