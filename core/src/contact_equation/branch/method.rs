//! The contact equation as the engine of branches sees it.

use nalgebra::{Complex, DMatrix};

use super::closed_states::pass_first;
use super::events;
use super::first_orbit::FirstOrbit;
use super::resume_state::Rest;
use crate::branches::branch_start::step_on_other_branch;
use crate::branches::checkpoint::keep;
use crate::branches::engine::{STOPPED, Search, Walk};
use crate::branches::extreme::{self, Extreme};
use crate::branches::moduli;
use crate::branches::point::Point;
use crate::branches::problem::{
    BranchProblem, Change, Read, TestValue, Touch, Watched, Zero, ZeroOutcome,
};
use crate::branches::progress::{Progress, See};
use crate::branches::record::Record;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::problem::FIRST;
use crate::contact_equation::reading::ReadOrbit;
use crate::contact_equation::run::Run;
use crate::contact_equation::switches::fits::Fits;
use crate::continuation::follow::{Continue, CurvePoint, Halted, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::{Problem, Scale};
use crate::event::EventKind;
use crate::laws::generic::narrow::Narrow;
use crate::shooting::test_functions::{self, Tests};

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
pub(super) const VANISHED: f64 = 1e-14;
/// A test function must vanish as exactly.
pub(super) const VANISHING: f64 = 1e-9;
/// A point is refused so often at most.
pub(in crate::contact_equation) const REFUSALS: usize = 8;
/// As many of them may be for panels that do not end at the kinks of the orbit: they move again as it is solved for.
pub(in crate::contact_equation) const RELOCATED: usize = 6;
/// A step is made again shorter so often at most, where it leaps over a touch of a level where the force jumps, over a touch and a change of
/// the order of switches, or to where no equations are found.
pub(super) const SHORTENED: usize = 8;
/// The same where the orbit before it has no place in the equations of the point: what disappears between both may do so in any step.
pub(super) const DISPLACED: usize = 3;
/// Multipliers that may be wrong by more are not compared with one.
const COARSE: f64 = 1e-3;
/// Parts of the tolerance below which fewer nodes do, and how many points are followed with more of them before fewer are tried: a number
/// of nodes that was not enough is not tried again at once.
const PLENTY: f64 = 1e-4;
pub(super) const HELD: usize = 12;
/// What is varied at a point that has no place in other equations: far beyond every range.
const NOWHERE: f64 = f64::MAX;

/// A branch by the contact equation.
pub(in crate::contact_equation) struct ContactBranch<'b, 'r> {
    pub(in crate::contact_equation) run: &'b mut Run<'r>,
    watched: Vec<Watched>,
    /// The test functions computed last, and where.
    tested: Option<(Vec<f64>, Tests)>,
    /// The last orbit that was kept.
    pub(in crate::contact_equation) last: Option<Last>,
    /// The equations that the walk goes on with, and its last point in them.
    next: Option<Next>,
    /// Where it was before the last step.
    pub(in crate::contact_equation) rest: Option<Box<Rest>>,
    /// The equations before, while others are tried.
    before: Option<Before>,
    /// The first orbit, where equations have changed since.
    pub(super) first: Option<FirstOrbit>,
    /// The same as a point of the present equations, in which the walk does not have it yet.
    first_here: Option<CurvePoint>,
    /// Where it was in them before it was found there, while the walk goes over to that.
    moved: Option<Vec<f64>>,
    /// The last step has passed it, as states tell.
    passes_first: bool,
    /// Other equations lead nowhere from the last point.
    pub(super) stuck: bool,
    /// How often the last point was refused.
    pub(in crate::contact_equation) refused: usize,
    /// How often the step to it was made again, shorter.
    pub(super) shortened: usize,
    /// The same, since the last orbit that was kept had no place in its equations.
    pub(super) displaced: usize,
    /// The last orbit that was kept, in the present unknowns; empty where it is not known in them.
    pub(in crate::contact_equation) kept: Vec<f64>,
    /// Points that are followed before fewer nodes are tried.
    pub(in crate::contact_equation) held: usize,
    visit: See<'b>,
}

/// What test functions of an orbit follow from, whatever its equations.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Last {
    /// What is varied, and what the bordered determinant is divided by.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    value: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    slope: f64,
    /// The map of the states column by column, if it is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    map: Vec<f64>,
}

impl Last {
    fn tests(&self) -> Tests {
        let order = self.map.len().isqrt();
        let map = (order > 0).then(|| DMatrix::from_column_slice(order, order, &self.map));
        Tests::of(map.as_ref(), self.slope)
    }

    /// Whether it is one of so many states: it may have been read from a file.
    pub(super) fn is_of(&self, order: usize) -> bool {
        let whole = self.map.is_empty() || self.map.len() == order * order;
        let slope = self.slope.is_nan() || self.slope.is_finite() && self.slope != 0.0;
        whole && slope && self.map.iter().chain([&self.value]).all(|x| x.is_finite())
    }
}

/// What the bordered determinant is divided by. Where the slope is rounding, nothing is known of the quotient.
fn divisor(at: &CurvePoint) -> f64 {
    at.known_slope(VANISHING).unwrap_or(f64::NAN)
}

/// What the walk was followed by before.
struct Before {
    equations: Equations,
    resolution: usize,
    /// The first orbit in these equations, where it was remembered.
    first: Vec<f64>,
}

/// What the walk goes on with.
struct Next {
    equations: Equations,
    u: Vec<f64>,
    resolution: usize,
    same: Same,
}

/// The most that equations have in common with those before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Same {
    /// The orbit alone.
    Orbit,
    /// Its switches too: panels end elsewhere.
    Switches,
    /// Its panels too: pairs of switches are told by other shapes of their gaps.
    Panels,
}

/// A point that no curve passes, in so many extended unknowns.
fn nowhere(scale: Scale, length: usize) -> CurvePoint {
    let mut u = vec![0.0; length];
    u[length - 1] = NOWHERE;
    CurvePoint {
        u,
        tangent: vec![0.0; length],
        scale,
    }
}

/// Beside a touch a tangent in other unknowns is a difference across it, and may lead back. The last step tells which way the walk goes.
fn look_ahead(at: &mut CurvePoint, previous: &CurvePoint, equations: &Equations) {
    let step: Vec<f64> = at.u.iter().zip(&previous.u).map(|(a, b)| a - b).collect();
    let newton = Newton::new(equations);
    if newton.norm().product(at.scale, &step, &at.tangent) < 0.0 {
        at.tangent = step;
    }
}

impl<'b, 'r> ContactBranch<'b, 'r> {
    pub(in crate::contact_equation) fn new(run: &'b mut Run<'r>, visit: See<'b>) -> Self {
        let watched = if run.problem.asked.stability {
            let skeleton = &run.equations.skeleton;
            test_functions::watched(skeleton.recurrence().doubling(), skeleton.order)
        } else {
            Vec::new()
        };
        Self {
            held: if run.resolution > FIRST { HELD } else { 0 },
            run,
            watched,
            tested: None,
            last: None,
            next: None,
            rest: None,
            before: None,
            first: None,
            first_here: None,
            moved: None,
            passes_first: false,
            stuck: false,
            refused: 0,
            shortened: 0,
            displaced: 0,
            kept: Vec::new(),
            visit,
        }
    }

    fn tests(&mut self, at: &CurvePoint) -> &Tests {
        let known = self.tested.take().filter(|(u, _)| *u == at.u);
        let found = known.unwrap_or_else(|| {
            let own = self.run.equations.map(&at.u);
            let last = self.last.as_ref();
            let known = |last: &&Last| last.value == at.parameter() && !last.map.is_empty();
            let tests = match (own, last.filter(known)) {
                (Some(own), _) => {
                    let values = self.run.last_map.values(&own).to_vec();
                    Tests::with(Some(&own), values, divisor(at))
                }
                // The last orbit may have other equations, in which it was looked at.
                (None, Some(last)) => last.tests(),
                (None, None) => {
                    let ordered = self.run.ordered(at);
                    let ordered = ordered.map(|(mut equations, at)| {
                        let map = equations.map(&at.u);
                        Tests::of(map.as_ref(), divisor(&at))
                    });
                    ordered.unwrap_or_else(|| Tests::of(None, divisor(at)))
                }
            };
            (at.u.clone(), tests)
        });
        &self.tested.insert(found).1
    }

    /// How well multipliers are known along the last step.
    fn last_error(&self) -> f64 {
        self.run.record.last_error(VANISHING)
    }

    /// What happens at a zero, if anything does: as by shooting. What it asks (`tests`, `last_error`) is of each method, and test functions
    /// are computed for moduli alone, so that neither can be handed to one function before.
    fn kind(&mut self, zero: &Zero) -> Option<EventKind> {
        let test_functions::Test::Modulus(place) = test_functions::Test::of(zero.change.test)
        else {
            return Some(zero.change.kind);
        };
        let tells = zero.told || zero.least <= self.last_error();
        let doubling = self.watched[test_functions::DOUBLING].kind;
        let tests = self.tests(&zero.root.located.point);
        tests.seen_by_modulus(place, tells, doubling)
    }

    /// Prepares the equations that fit an orbit. Says whether there are any.
    fn prepare(&mut self, u: &[f64], resolution: usize) -> bool {
        let former = std::mem::replace(&mut self.run.resolution, resolution);
        let planned = self.run.replanned(u);
        self.run.resolution = former;
        if resolution > former {
            self.held = HELD;
        }
        self.next = planned.map(|(equations, u)| Next {
            equations,
            u,
            resolution,
            same: Same::Orbit,
        });
        self.next.is_some()
    }

    /// Prepares the same equations with panels that end at the kinks of an orbit. Says whether there are any.
    fn prepare_at_kinks(&mut self, u: &[f64]) -> bool {
        let found = self.run.equations.at_kinks(u);
        self.next = found.map(|equations| Next {
            u: self.run.equations.rearranged(&equations, u),
            equations,
            resolution: self.run.resolution,
            same: Same::Switches,
        });
        self.next.is_some()
    }

    /// Prepares the same equations with pairs that are told by the shapes of gaps on an orbit. Says whether these are others.
    fn prepare_reshaped(&mut self, at: &CurvePoint) -> bool {
        let skeleton = self.run.reshaped(&at.u);
        let value = self.run.equations.made;
        let found = skeleton.and_then(|skeleton| self.run.equations.on(skeleton, value));
        self.next = found.map(|equations| {
            let (from, to) = (&self.run.equations.skeleton, &equations.skeleton);
            let [u, _] = from.told_by(to, &at.u, &at.tangent);
            Next {
                u,
                equations,
                resolution: self.run.resolution,
                same: Same::Panels,
            }
        });
        self.next.is_some()
    }

    /// Whether the equations that were prepared have a place for the last orbit that was kept, where the present ones have one. Panels that end at the kinks of
    /// another orbit may step over its own, and are to tell the same of its multipliers.
    fn holds_last(&mut self) -> bool {
        let Some(next) = self.next.as_mut().filter(|_| !self.kept.is_empty()) else {
            return true;
        };
        if next.same == Same::Orbit {
            let placed = self.run.transferred(&self.kept, &next.equations, &next.u);
            return placed.is_some();
        }
        let there = self.run.equations.rearranged(&next.equations, &self.kept);
        let Some(last) = self.last.as_ref().filter(|last| !last.map.is_empty()) else {
            return true;
        };
        let map = next.equations.map(&there);
        map.is_none_or(|map| Tests::of(Some(&map), last.slope).tell_as(&last.tests()))
    }

    /// Whether the step to an orbit is to be made again, shorter, since the equations that were prepared there have no place for the orbit before
    /// it: what happened in the step is looked for between points that both have a place in them.
    fn is_displaced(&mut self) -> bool {
        if self.displaced >= DISPLACED || self.holds_last() {
            return false;
        }
        let kept = std::mem::take(&mut self.kept);
        // Where a gap hardly passes its level any more, no step is short enough.
        let is_slow = !kept.is_empty() && self.run.slowest(&kept) < STOPPED;
        self.kept = kept;
        if is_slow {
            return false;
        }
        self.next = None;
        self.displaced += 1;
        self.refused = 0;
        true
    }

    /// The resolution that the last error asks for.
    fn wanted(&self, point: &Point) -> usize {
        let now = self.run.resolution;
        if self.run.is_coarse(point) {
            now + 1
        } else if self.run.excess(point) < PLENTY && now > FIRST && self.held == 0 {
            now - 1
        } else {
            now
        }
    }

    /// Of nodes that step over a narrow place: where panels end elsewhere no orbit was found, or one that asks for others. The step was too
    /// long for them.
    fn shorter_or_lost(&mut self) -> Read {
        if self.shortened >= SHORTENED {
            return Read::Lost;
        }
        self.shortened += 1;
        self.refused = 0;
        Read::TooFar
    }

    /// What is done with an orbit that was read, by equations that fit it.
    fn decide(&mut self, at: &CurvePoint, read: ReadOrbit, fits: Fits, stuck: bool) -> Read {
        let wanted = match read.overlooks {
            Some(overlooked) => overlooked.needed.unwrap_or(self.run.resolution),
            None => self.wanted(&read.point),
        };
        let coarse = wanted > self.run.resolution;
        let again = !stuck && self.refused < REFUSALS;
        // As many nodes may do where panels end at the kinks of this orbit.
        let fails = self.run.excess(&read.point) > 1.0;
        let tried = self.refused >= RELOCATED;
        let moved = fails && again && !tried && self.run.has_moved_kinks();
        if moved && self.prepare_at_kinks(&at.u) {
            if self.is_displaced() {
                return Read::TooFar;
            }
            self.refused += 1;
            return Read::Refused;
        }
        if coarse && again && self.prepare(&at.u, wanted) {
            if self.is_displaced() {
                return Read::TooFar;
            }
            self.refused += 1;
            return Read::Refused;
        }
        if read.overlooks.is_some() {
            return self.shorter_or_lost();
        }
        self.refused = 0;
        self.shortened = 0;
        self.displaced = 0;
        let before = std::mem::replace(&mut self.kept, at.u.clone());
        self.held = self.held.saturating_sub(1);
        self.run.equations.known[0].clone_from(&at.u);
        if !self.keep_point(at, read) {
            return Read::Stop;
        }
        if self.first.is_some() && pass_first(&self.run.record.points, at.scale.parameter) {
            self.passes_first = true;
            // Where the orbit before has no place in the present unknowns there is no step to be looked at.
            return if before.is_empty() {
                Read::Resize
            } else {
                Read::ResizeBehind
            };
        }
        let other = fits == Fits::Soon || wanted != self.run.resolution;
        if other && !stuck && self.prepare(&at.u, wanted) {
            return Read::ResizeBehind;
        }
        if fits == Fits::Moved && !stuck && self.prepare_at_kinks(&at.u) {
            return Read::ResizeBehind;
        }
        if !other && !stuck && self.prepare_reshaped(at) {
            return Read::ResizeBehind;
        }
        let first = self.first.as_mut();
        self.first_here = first.and_then(|first| first.ahead(self.run, &before, at));
        if self.first_here.is_some() {
            return Read::ResizeBehind;
        }
        Read::Kept
    }

    /// Where the first orbit of a walk is in the equations that it goes on with.
    fn first_in(&mut self, halted: &Halted, next: &Next) -> Option<CurvePoint> {
        let begun = !self.run.record.points.is_empty() && halted.first.parameter() < NOWHERE;
        if self.first.is_none() && begun {
            self.first = FirstOrbit::new(self.run, &halted.first);
        }
        let first = self.first.as_mut()?;
        // Between equations with the same switches unknowns go over as they are.
        if next.same != Same::Orbit && halted.first.parameter() < NOWHERE {
            return self.point_in(&halted.first, next);
        }
        first.placed(self.run, &next.equations, &next.u)
    }

    /// A point of the branch in the equations that the walk goes on with, if it has a place there.
    fn point_in(&mut self, of: &CurvePoint, next: &Next) -> Option<CurvePoint> {
        let Next {
            equations, u, same, ..
        } = next;
        let found = match same {
            Same::Orbit => self.run.point_in(of, equations, u)?,
            Same::Switches => CurvePoint {
                u: self.run.equations.rearranged(equations, &of.u),
                tangent: self.run.equations.rearranged(equations, &of.tangent),
                scale: of.scale,
            },
            Same::Panels => {
                let (from, to) = (&self.run.equations.skeleton, &equations.skeleton);
                let [u, tangent] = from.told_by(to, &of.u, &of.tangent);
                CurvePoint {
                    u,
                    tangent,
                    scale: of.scale,
                }
            }
        };
        let mut numbers = found.u.iter().chain(&found.tangent);
        numbers.all(|x| x.is_finite()).then_some(found)
    }

    /// Whether a halted walk keeps its unknowns, and something else of it changes.
    fn keeps_unknowns(&mut self, halted: &mut Halted) -> bool {
        if std::mem::take(&mut self.passes_first) {
            halted.passes_first();
            self.moved = None;
            self.before = None;
            return true;
        }
        if let Some(found) = self.first_here.take() {
            let first = self.first.as_mut();
            self.moved = first.map(|first| first.is_at(found.u.clone()));
            halted.first = found;
            self.before = None;
            return true;
        }
        false
    }

    fn keep_point(&mut self, at: &CurvePoint, read: ReadOrbit) -> bool {
        let ReadOrbit { point, map, .. } = read;
        let values = map.as_ref().map(|map| self.run.last_map.values(map));
        let values = values.map_or_else(Vec::new, <[_]>::to_vec);
        let tests = Tests::with(map.as_ref(), values, divisor(at));
        self.last = Some(Last {
            value: at.parameter(),
            slope: divisor(at),
            map: map.map_or_else(Vec::new, |map| map.as_slice().to_vec()),
        });
        self.tested = Some((at.u.clone(), tests));
        let done = self.run.record.points.len() + 1;
        let answer = (self.visit)(Progress::orbit(done, &point));
        self.run.record.points.push(point);
        answer.is_continue()
    }
}

// Test functions are those of a map over the period, as by shooting; where the map comes from is another thing, so what asks for them
// is written for both.
impl BranchProblem for ContactBranch<'_, '_> {
    fn equations(&mut self) -> &mut dyn Problem {
        &mut self.run.equations
    }

    fn watched(&self) -> &[Watched] {
        &self.watched
    }

    fn test(&mut self, index: usize, at: &CurvePoint) -> TestValue {
        TestValue::plain(self.tests(at).value(test_functions::Test::watched(index)))
    }

    fn slope(&mut self, at: &CurvePoint) -> f64 {
        self.run.slope(at)
    }

    fn pairs(&mut self, at: &CurvePoint) -> Option<Vec<Complex<f64>>> {
        let watches = !self.watched.is_empty();
        watches.then(|| moduli::pairs(&self.tests(at).multipliers))
    }

    fn is_of_multipliers(&self, index: usize) -> bool {
        !self.watched[index].bordered
    }

    fn vanishing(&self) -> f64 {
        VANISHING
    }

    fn noise(&self, index: usize) -> f64 {
        match test_functions::Test::watched(index) {
            test_functions::Test::Modulus(_) => self.last_error().min(COARSE),
            _ => 0.0,
        }
    }

    fn aim(&self) -> f64 {
        VANISHED
    }

    fn vanishes(&mut self, change: Change, located: &Located) -> bool {
        let point = &located.point;
        let unit = match test_functions::Test::of(change.test) {
            test_functions::Test::Slope => point.narrowness(),
            test_functions::Test::Bordered => {
                self.run.others(point, 1.0) / point.parameter_slope().abs()
            }
            test_functions::Test::Plus => self.run.others(point, -1.0),
            test_functions::Test::Modulus(_) => return located.test.abs() <= self.last_error(),
        };
        located.test.abs() <= VANISHING * unit
    }

    fn record(&self) -> &Record {
        &self.run.record
    }

    fn record_mut(&mut self) -> &mut Record {
        &mut self.run.record
    }

    fn is_beyond(&mut self, at: &CurvePoint) -> bool {
        self.run.joined = self.run.earlier(at);
        self.run.joined.is_some()
    }

    fn joint(
        &mut self,
        newton: &mut Newton,
        step: Step<'_>,
        options: NewtonOptions,
    ) -> Option<CurvePoint> {
        if self.watched.is_empty() {
            return None;
        }
        let other = step_on_other_branch(&mut self.run.equations, newton, step, options)?;
        Search::of_joint(self, step, &other, options).place(self, newton)
    }

    fn goes_on(&mut self) {
        self.run.joined = None;
    }

    fn end(&mut self, newton: &mut Newton, step: Step<'_>, options: NewtonOptions) -> Option<Read> {
        let other = step_on_other_branch(&mut self.run.equations, newton, step, options)?;
        if !self.watched.is_empty() {
            Search::of_joint(self, step, &other, options).record(self, newton);
        }
        None
    }

    fn read(&mut self, _: &mut Newton, at: &CurvePoint) -> Read {
        self.first_here = None;
        let stuck = std::mem::take(&mut self.stuck);
        let again = !stuck && self.refused < REFUSALS;
        self.run
            .equations
            .compute(&at.u, self.run.problem.asked.stability);
        let equations = &self.run.equations;
        if equations.failed || equations.is_in_order() {
            let Some(read) = self.run.read_on(at) else {
                return Read::Lost;
            };
            let fits = self.run.fits(&at.u);
            if fits != Fits::No {
                return self.decide(at, read, fits, stuck);
            }
            // Behind a corner there may be nothing near by: it is come to from where it is watched.
            if again && self.shortened < SHORTENED && self.run.has_leapt(&at.u) {
                self.shortened += 1;
                return Read::TooFar;
            }
        }
        // A touch is passed by equations that have the switches around it in their order. Where those of the point behind it lead nowhere, it is
        // come to from where it is watched, too.
        let far = stuck || again && self.run.is_beyond_touch(&at.u);
        if far && self.shortened < SHORTENED {
            self.shortened += 1;
            self.refused = 0;
            return Read::TooFar;
        }
        if !again || !self.prepare(&at.u, self.run.resolution) {
            return Read::Lost;
        }
        if self.is_displaced() {
            return Read::TooFar;
        }
        self.refused += 1;
        Read::Refused
    }

    fn keep(&mut self, _: &mut Newton, step: Step<'_>, zero: &Zero) -> ZeroOutcome {
        let of_modulus = zero.change.kind == EventKind::NeimarkSacker;
        let Some(kind) = self.kind(zero) else {
            return ZeroOutcome::Nothing;
        };
        let Some(mut event) = self.run.event(step, zero, kind) else {
            return ZeroOutcome::Unread;
        };
        let at = &zero.root.located.point.u;
        if event.kind == EventKind::BranchPoint && self.run.breaks_symmetry(at) {
            event.kind = EventKind::SymmetryBreaking;
        }
        if of_modulus && moduli::is_recorded(&self.run.record.events, &event)
            || events::crosses_nothing(&event)
        {
            return ZeroOutcome::Nothing;
        }
        let meets = event.kind == EventKind::BranchPoint && self.run.joined.is_none();
        self.run.record.events.push(event);
        let end = meets.then(|| self.run.meets(at)).flatten();
        end.map_or(ZeroOutcome::Event, ZeroOutcome::Ends)
    }

    fn seeks_touches(&self) -> bool {
        self.run.problem.asked.stability
    }

    fn force_jumps(&self) -> bool {
        extreme::force_jumps(self.run.problem.asked.system.as_ref())
    }

    fn corners(&self) -> bool {
        extreme::corners(self.run.problem.asked.system.as_ref())
    }

    fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        self.run.extremes(u, extremes)
    }

    fn plain_extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        self.run.plain_extremes(u, extremes)
    }

    fn narrow_places(&mut self, _: &[f64], contact: usize, range: [f64; 2], to: &mut Vec<Narrow>) {
        self.run.narrow_places(contact, range, to);
    }

    fn extreme_form(&mut self, u: &[f64], extreme: &Extreme, _: f64, form: &mut [f64]) -> bool {
        // No unknown tells how far an extreme is from a narrow place.
        !extreme.plain && self.run.extreme_form(u, extreme, form)
    }

    fn lifted(&mut self, u: &[f64], extreme: &Extreme, height: f64) -> Option<Vec<f64>> {
        self.run.lifted(u, extreme, height)
    }

    fn slowest(&mut self, u: &[f64]) -> f64 {
        self.run.slowest(u)
    }

    fn describes(&mut self, at: &CurvePoint) -> bool {
        self.run.equations.compute(&at.u, false);
        !self.run.equations.failed && self.run.fits(&at.u) != Fits::No
    }

    fn keep_touch(&mut self, _: &mut Newton, _: Step<'_>, touch: &Touch) {
        events::touch(self.run, touch);
    }

    fn remap(&mut self, halted: &mut Halted) {
        if self.keeps_unknowns(halted) {
            return;
        }
        self.moved = None;
        let Some(next) = self.next.take() else {
            self.before = None;
            return;
        };
        let length = next.u.len();
        let first = self.first_in(halted, &next);
        let mut point = |of: &CurvePoint| self.point_in(of, &next);
        if let Some(known) = point(&halted.point) {
            halted.point.tangent = known.tangent;
        } else {
            halted.point.tangent = vec![0.0; length];
        }
        halted.point.u.clone_from(&next.u);
        halted.previous = halted.previous.as_ref().and_then(&mut point);
        halted.earlier = halted.earlier.as_ref().and_then(&mut point);
        if let Some(previous) = &halted.previous {
            look_ahead(&mut halted.point, previous, &next.equations);
        }
        let here = first
            .as_ref()
            .map_or_else(Vec::new, |first| first.u.clone());
        let place = self.first.as_mut().map(|place| place.is_at(here));
        // A curve is not closed where its first point has no place.
        halted.first = first.unwrap_or_else(|| nowhere(halted.first.scale, length));
        // Before an orbit was kept there is no first one yet.
        if halted.first.parameter() >= NOWHERE && !self.run.record.points.is_empty() {
            halted.loses_first_direction();
        }
        self.kept = match &halted.previous {
            _ if self.refused == 0 => next.u.clone(),
            Some(previous) => previous.u.clone(),
            None => Vec::new(),
        };
        halted.before = None;
        let Next {
            equations,
            u,
            resolution,
            ..
        } = next;
        let former = std::mem::replace(&mut self.run.resolution, resolution);
        let known = std::mem::replace(&mut self.run.equations, equations);
        self.run.equations.known = [u, Vec::new()];
        self.run.clear_finer();
        self.before = Some(Before {
            equations: known,
            resolution: former,
            first: place.unwrap_or_default(),
        });
        self.tested = None;
    }

    fn revert(&mut self) {
        if let (Some(first), Some(former)) = (&mut self.first, self.moved.take()) {
            first.is_at(former);
        }
        if let Some(before) = self.before.take() {
            self.run.equations = before.equations;
            self.run.resolution = before.resolution;
            if let Some(first) = &mut self.first {
                first.is_at(before.first);
            }
            self.run.clear_finer();
            self.tested = None;
            self.kept.clear();
            self.stuck = true;
        }
    }

    fn onward(&mut self, walk: Walk) -> Continue {
        let rest = self.rest(walk);
        let answer = keep(
            self.run.problem.asked.keep.as_ref(),
            self.run.record.kept(),
            &rest,
        );
        self.rest = Some(Box::new(rest));
        answer
    }

    fn count(&mut self, newton: &Newton) {
        self.run.statistics += newton.statistics;
    }
}
