//! The [extremes](Extreme) of gaps, from the motion along an orbit.
//!
//! What is asked is that of `balance_branch/run/gap_extremes.rs`, line by line. That reads a series, whose gap has as many harmonics; this passes
//! a motion, which may fail, of a part that stands for the whole. Values of the parameter, and the arguments and levels of a contact that follow
//! from them, are held by the balance there and by the problem here, so that loops over contacts are the same in form alone.

use std::f64::consts::TAU;

use super::equations::{Equations, Span};
use super::gap_scan::{self, Room};
use super::problem::ShootingProblem;
use crate::branches::extreme::{Bend, Extreme};
use crate::branches::recurrence::Recurrence;
use crate::laws::generic::narrow::Narrow;
use crate::laws::generic::scales::Scales;
use crate::model::layout::Layout;
use crate::model::validate;
use crate::time::Stretch;
use crate::time::gap::Gap;

/// Derivatives by the parameter are differences over this part of its range.
const DIFFERENCE: f64 = 1e-6;

/// What rounding leaves in a phase.
const ROUNDING: f64 = 1e-12;
/// A gap that differs from a level by this part of its size stands on it.
const STANDS: f64 = 1e-10;
/// Accelerations are differences over this phase.
const SHORT: f64 = 1e-3;

/// Reads extremes of gaps off orbits.
pub(super) struct GapExtremes<'r> {
    problem: &'r ShootingProblem,
    /// Of the whole orbit, where the unknowns are those of a part; its own, so that Newton's method is not disturbed.
    pub(super) equations: Equations,
    /// The part that the unknowns are of.
    part: Span,
    layout: Layout,
    gap: Gap,
    coefficients: Vec<f64>,
    arguments: Vec<f64>,
    levels: Vec<f64>,
    state: Vec<f64>,
    ends: [Vec<f64>; 2],
    /// One entry per contact.
    scales: Vec<Option<Scales>>,
}

impl<'r> GapExtremes<'r> {
    pub(super) fn new(problem: &'r ShootingProblem, mut equations: Equations) -> Self {
        let part = equations.span.clone();
        equations.divide(Span {
            recurrence: Recurrence::whole(part.recurrence.period),
            segments: part.recurrence.parts * part.segments,
        });
        let layout = Layout::of(problem.system.as_ref());
        let system = problem.system.as_ref();
        let contacts = layout.contacts.iter();
        let scales = contacts.map(|of| Scales::of(system.law(of.law)));
        Self {
            scales: scales.collect(),
            problem,
            gap: Gap::default(),
            coefficients: vec![0.0; layout.coefficients],
            arguments: Vec::new(),
            levels: Vec::new(),
            state: vec![0.0; equations.order()],
            ends: [vec![0.0; equations.order()], vec![0.0; equations.order()]],
            layout,
            part,
            equations,
        }
    }

    /// The unknowns of the whole orbit.
    fn whole(&self, u: &[f64]) -> Vec<f64> {
        let last = u.len() - 1;
        let coordinates = self.equations.order() / 2;
        let Recurrence { parts, image, .. } = &self.part.recurrence;
        let states = self.equations.states_of(u);
        let mut whole = Vec::with_capacity(parts * states.len());
        for part in 0..*parts {
            whole.extend(image.power(part).of_states(&states, coordinates));
        }
        self.equations.unknowns_of(&whole, u[last])
    }

    /// Goes over to a contact where what is varied has a value.
    fn set(&mut self, contact: usize, value: f64) {
        let Self {
            problem,
            layout,
            coefficients,
            ..
        } = self;
        let (system, omega) = (problem.system.as_ref(), problem.omega_at(value));
        system.coefficients(&problem.parameters_at(value), omega, coefficients);
        let of = &layout.contacts[contact];
        self.gap
            .set(of, coefficients, omega / f64::from(problem.divisor));
        let law = system.law(of.law);
        self.arguments.resize(of.argument_count, 0.0);
        self.levels.resize(law.facts().levels.len(), 0.0);
        of.arguments(coefficients, &mut self.arguments);
        law.levels(&self.arguments, &mut self.levels);
    }

    /// Finds the extremes of the gap of a contact along a whole orbit, in order of phase. Returns its lowest and its highest value.
    fn find_extremes(&mut self, u: &[f64], found: &mut Vec<gap_scan::Extreme>) -> Option<[f64; 2]> {
        found.clear();
        let [first, end] = &mut self.ends;
        let room = Room {
            state: &mut self.state,
            first,
            end,
        };
        let see = &mut |extreme| found.push(extreme);
        gap_scan::extremes(&self.gap, &mut self.equations, u, room, see)?;
        found.sort_by(|a, b| a.passed.total_cmp(&b.passed));
        let gaps = found.iter().map(|extreme| extreme.gap);
        Some(gaps.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
            [a.min(x), b.max(x)]
        }))
    }

    /// Writes the extremes of all gaps, from every level, in order of phase.
    pub(super) fn read(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> Option<()> {
        extremes.clear();
        let u = &self.whole(u)[..];
        let system = self.problem.system.as_ref();
        let whole = self.equations.span.begins(self.equations.span.segments);
        let mut found = Vec::new();
        for contact in 0..self.layout.contacts.len() {
            self.set(contact, u[u.len() - 1]);
            let facts = system.law(self.layout.contacts[contact].law).facts();
            if self.levels.is_empty() {
                continue;
            }
            let [low, high] = self.find_extremes(u, &mut found)?;
            for (level, value) in self.levels.iter().enumerate() {
                let jumps = facts.levels[level].force_jumps;
                let alike = Extreme {
                    bend: Bend::at(facts, level, &self.arguments),
                    ..Extreme::of(contact, level, 0.5 * (high - low), jumps)
                };
                extremes.extend(seen_from(*value, &found, whole, alike));
            }
        }
        Some(())
    }

    /// The same from zero, of the gaps alone whose laws may have narrow places. Says whether there are any.
    pub(super) fn read_plain(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> Option<bool> {
        extremes.clear();
        if self.scales.iter().all(Option::is_none) {
            return Some(false);
        }
        let value = u[u.len() - 1];
        let mut states = None;
        let whole = self.equations.span.begins(self.equations.span.segments);
        let mut found = Vec::new();
        for contact in 0..self.scales.len() {
            if !self.may_be_narrow(contact, value) {
                continue;
            }
            let u = &states.get_or_insert_with(|| self.whole(u))[..];
            let [low, high] = self.find_extremes(u, &mut found)?;
            let alike = Extreme {
                plain: true,
                ..Extreme::of(contact, 0, 0.5 * (high - low), false)
            };
            extremes.extend(seen_from(0.0, &found, whole, alike));
        }
        Some(states.is_some())
    }

    /// Takes what belongs to a contact, and says whether its law may have narrow places.
    fn may_be_narrow(&mut self, contact: usize, value: f64) -> bool {
        if self.scales[contact].is_none() {
            return false;
        }
        self.set(contact, value);
        let scales = self.scales[contact].as_mut();
        scales.is_some_and(|scales| {
            scales.set(&self.arguments, &self.levels);
            scales.may_be_narrow()
        })
    }

    /// Adds the narrow places of the law of a contact in a range of its gap.
    pub(super) fn narrow(
        &mut self,
        u: &[f64],
        contact: usize,
        range: [f64; 2],
        to: &mut Vec<Narrow>,
    ) {
        self.set(contact, u[u.len() - 1]);
        if let Some(scales) = &mut self.scales[contact] {
            scales.set(&self.arguments, &self.levels);
            scales.narrow(range, to);
        }
    }

    /// Adds the gaps at the phases where segments begin, seen from the levels where the force jumps, to the extremes of an orbit.
    pub(super) fn add_beginnings(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) {
        let whole = self.equations.span.begins(self.equations.span.segments);
        let span = self.equations.span.clone();
        let segments = self.part.segments;
        let states = self.equations.states_of(u);
        let jumping = |extreme: &&Extreme| extreme.jumps;
        let mut levels: Vec<Extreme> = extremes.iter().filter(jumping).copied().collect();
        levels.dedup_by_key(|extreme| (extreme.contact, extreme.level));
        for known in levels {
            self.set(known.contact, u[u.len() - 1]);
            let of_segments = states.chunks_exact(self.equations.order()).take(segments);
            extremes.extend(of_segments.enumerate().map(|(segment, state)| {
                let (gap, _) = self.gap.at(span.phases(segment).0, state);
                Extreme {
                    tau: TAU * span.begins(segment) / whole,
                    maximum: false,
                    above: (gap - self.levels[known.level]) / known.size,
                    begins: true,
                    ..known
                }
            }));
        }
    }

    /// How slowly a gap passes a level where the force jumps while it is slowed down: the height `r^2 / (2 |a|)` at which it would
    /// turn, in units of half of the gap's range, with its rate `r` and acceleration `a` before the level.
    pub(super) fn slowest(&mut self, u: &[f64]) -> Option<f64> {
        let mut extremes = Vec::new();
        self.read(u, &mut extremes)?;
        let u = &self.whole(u)[..];
        let base = self.problem.rate_at(u[u.len() - 1]);
        let mut slowest = f64::INFINITY;
        for contact in 0..self.layout.contacts.len() {
            let Some(size) = extremes
                .iter()
                .find(|extreme| extreme.contact == contact && extreme.jumps)
                .map(|extreme| extreme.size)
            else {
                continue;
            };
            self.set(contact, u[u.len() - 1]);
            let (gap, levels, state) = (&self.gap, &self.levels, &mut self.state);
            let see = &mut |stretch: &dyn Stretch| {
                let (from, to) = stretch.phases();
                let mut at = |phase: f64| {
                    stretch.state(phase, state);
                    gap.at(phase, state)
                };
                let width = (to - from).min(SHORT);
                let ((value, rate), (_, before)) = (at(to), at(to - width));
                let acceleration = (rate - before) * base / width;
                let stands = |level: &f64| (value - level).abs() <= STANDS * size;
                if rate * acceleration < 0.0 && levels.iter().any(stands) {
                    slowest = slowest.min(0.5 * rate * rate / acceleration.abs() / size);
                }
            };
            self.equations.trace(u, see).ok()?;
        }
        Some(slowest)
    }

    /// Writes the linear form of extended unknowns that gap less level is where the extreme lies, in its units. By the parameter itself,
    /// whose range has this length, it is a difference.
    pub(super) fn form(
        &mut self,
        u: &[f64],
        extreme: &Extreme,
        range: f64,
        form: &mut [f64],
    ) -> Option<()> {
        form.fill(0.0);
        let last = u.len() - 1;
        let facts = self.problem.system.facts();
        let step = DIFFERENCE * range;
        let [below, above] = validate::around(facts, self.problem.variable, u[last], step);
        let span = self.equations.span.clone();
        let passed = extreme.tau / TAU * span.begins(span.segments);
        let segment =
            (0..span.segments).rfind(|segment| span.begins(*segment) <= passed + ROUNDING)?;
        let phase = span.phases(segment).0 + (passed - span.begins(segment)).max(0.0);
        let (state, tangent) = {
            let u = &self.whole(u);
            self.equations.tangent_at(u, segment, phase).ok()?
        };
        // Each part is the image of the one before.
        let (part, segment) = (segment / self.part.segments, segment % self.part.segments);
        let image = self.part.recurrence.image.power(part);
        let order = state.len();
        let mut height = |value: f64| {
            self.set(extreme.contact, value);
            self.gap.at(phase, &state).0 - extreme.origin(&self.levels)
        };
        let direct = (height(above) - height(below)) / (above - below);
        self.set(extreme.contact, u[last]);
        let origin = vec![0.0; order];
        let offset = self.gap.at(phase, &origin).0;
        let by = |index: usize| {
            let column = &tangent.columns[index * order..][..order];
            (self.gap.at(phase, column).0 - offset) / extreme.size
        };
        for index in 0..order {
            let (place, sign) = image.state_entry(index, order / 2);
            form[segment * order + place] = sign * by(index);
        }
        let by_motion = if extreme.of_states { 0.0 } else { by(order) };
        form[last] = by_motion + direct / extreme.size;
        Some(())
    }
}

/// Extremes of a gap over a whole orbit of this length, from a level.
fn seen_from(
    level: f64,
    found: &[gap_scan::Extreme],
    whole: f64,
    alike: Extreme,
) -> impl Iterator<Item = Extreme> + '_ {
    found.iter().map(move |extreme| Extreme {
        tau: TAU * extreme.passed / whole,
        maximum: extreme.largest,
        above: (extreme.gap - level) / alike.size,
        ..alike
    })
}
