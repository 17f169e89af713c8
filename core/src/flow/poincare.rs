//! Poincare sections: where a motion passes a surface, located on its dense output.
//!
//! A surface is `g(tau, state) = 0`. Along each smooth stretch `g` is sampled; a change of sign is closed in to the last bits of
//! the phase. Where `g` has the same sign at two samples, comes nearer to zero behind the first and goes away from it before the
//! second, its extremum between them is closed in as well, so that two crossings in quick succession are not lost.
//!
//! Source of the iteration: Chandrupatla (1997), Advances in Engineering Software 28, 145.

use std::f64::consts::TAU;

use super::gap::Gap;
use super::stroboscope::Stroboscope;
use super::{FlowError, Stretch};
use crate::error::Error;
use crate::layout::Layout;
use crate::system::System;
use crate::validate;

/// Samples in one period, at least.
const SAMPLES: f64 = 64.0;
/// Part of the distance of two samples over which a slope is taken: a dip that ends within it has a depth of about its square.
const ASIDE: f64 = 1e-5;
/// Golden section: each step keeps this part of an interval.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Which crossings of a surface count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From below to above.
    Rising,
    /// From above to below.
    Falling,
    /// All.
    Both,
}

/// A function of phase and state.
type Function<'a> = dyn Fn(f64, &[f64]) -> f64 + Send + Sync + 'a;

/// A surface in the space of phase and state.
///
/// ```
/// use hertzian::flow::poincare::{Direction, Section};
/// use hertzian::flow::stroboscope::Stroboscope;
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear { drive: 3.0 };
/// let mut map = Stroboscope::of(&model, 1.0)?;
/// let mut state = [0.0, 0.0];
/// let mut crossings = 0;
/// // Once it has settled, the motion passes zero upwards once in each period.
/// (0..20).try_for_each(|_| map.map(&mut state))?;
/// let section = Section::entry(0, 0.0, Direction::Rising);
/// section.follow(&mut map, &mut state, 5, &mut |_| crossings += 1)?;
/// assert_eq!(crossings, 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Section<'a> {
    function: Box<Function<'a>>,
    direction: Direction,
    /// Entries that a state must have.
    entries: usize,
}

impl std::fmt::Debug for Section<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Section")
            .field("direction", &self.direction)
            .finish_non_exhaustive()
    }
}

/// A crossing of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Crossing<'a> {
    /// Periods since the start.
    pub periods: f64,
    /// Phase, between that of the stroboscope and one period later.
    pub phase: f64,
    /// Coordinates, then their rates.
    pub state: &'a [f64],
    /// Whether `g` rises.
    pub rises: bool,
}

impl<'a> Section<'a> {
    /// The zeros of a continuous function of phase and state.
    pub fn new(
        direction: Direction,
        function: impl Fn(f64, &[f64]) -> f64 + Send + Sync + 'a,
    ) -> Self {
        Self {
            function: Box::new(function),
            direction,
            entries: 0,
        }
    }

    /// One entry of the state passes a value: a coordinate, or with `entry >= n` its rate.
    pub fn entry(entry: usize, value: f64, direction: Direction) -> Self {
        Self {
            entries: entry + 1,
            ..Self::new(direction, move |_, state| state[entry] - value)
        }
    }

    /// The gap of a contact of a system passes a value, at given values of the parameters and of `omega`.
    ///
    /// # Errors
    /// If there is no such contact, or the values cannot be used.
    pub fn gap(
        system: &dyn System,
        (parameters, omega): (&[f64], f64),
        contact: usize,
        (value, direction): (f64, Direction),
    ) -> Result<Self, Error> {
        validate::values(system, parameters, omega)?;
        let layout = Layout::of(system);
        let contact = layout.contacts.get(contact).ok_or(Error::Option {
            name: "contact",
            value: contact as f64,
            must: "must be the position of a contact, counted from zero",
        })?;
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let base = omega / f64::from(system.facts().divisor);
        let gap = Gap::new(contact, &coefficients, base);
        let distance = move |phase: f64, state: &[f64]| gap.at(phase, state).0 - value;
        Ok(Self {
            entries: 2 * layout.coordinates,
            ..Self::new(direction, distance)
        })
    }

    fn counts(&self, rises: bool) -> bool {
        match self.direction {
            Direction::Rising => rises,
            Direction::Falling => !rises,
            Direction::Both => true,
        }
    }

    /// Follows a motion for some periods and shows its crossings, in order.
    ///
    /// A motion that starts on the surface and leaves it has not crossed it.
    ///
    /// # Errors
    /// If the motion cannot be continued: what came before has been shown. If a state has not the entries that the surface asks
    /// for.
    pub fn follow(
        &self,
        map: &mut Stroboscope<'_>,
        state: &mut [f64],
        periods: usize,
        see: &mut dyn FnMut(Crossing<'_>),
    ) -> Result<(), FlowError> {
        if state.len() < self.entries || state.len() != map.order() {
            return Err(FlowError::Entries {
                entries: state.len(),
                expected: map.order(),
            });
        }
        let mut search = Search {
            section: self,
            state: state.to_vec(),
            side: None,
            last: 0.0,
        };
        let phase = map.start();
        search.last = (self.function)(phase, state);
        search.passed(search.last);
        for period in 0..periods {
            let mut show = |stretch: &dyn Stretch| {
                search.scan(stretch, &mut |at, state, rises| {
                    see(Crossing {
                        periods: period as f64 + (at - phase) / TAU,
                        phase: at,
                        state,
                        rises,
                    });
                });
            };
            map.show_period(state, &mut show)?;
        }
        Ok(())
    }
}

/// What is remembered along a motion.
struct Search<'s, 'a> {
    section: &'s Section<'a>,
    /// Room.
    state: Vec<f64>,
    /// Whether the motion was above the surface when last it was not on it.
    side: Option<bool>,
    /// `g` at the end of what has been scanned. It is carried from stretch to stretch, since rounding could change its sign
    /// where one is evaluated by the other's polynomial.
    last: f64,
}

impl Search<'_, '_> {
    fn value(&mut self, stretch: &dyn Stretch, phase: f64) -> f64 {
        stretch.state(phase, &mut self.state);
        (self.section.function)(phase, &self.state)
    }

    /// Whether the side changes at a value; on the surface it does not.
    fn passed(&mut self, value: f64) -> bool {
        if value == 0.0 || value.is_nan() {
            return false;
        }
        let above = value > 0.0;
        self.side.replace(above).is_some_and(|side| side != above)
    }

    fn scan(&mut self, stretch: &dyn Stretch, see: &mut dyn FnMut(f64, &[f64], bool)) {
        let (from, to) = stretch.phases();
        if to <= from {
            return;
        }
        let count = ((to - from) / TAU * SAMPLES).ceil().max(2.0);
        let at = |i: f64| {
            if i == count {
                to
            } else {
                from + (to - from) * (i / count)
            }
        };
        let mut here = (from, self.last);
        for i in 1..=count as usize {
            let phase = at(i as f64);
            let next = (phase, self.value(stretch, phase));
            if let Some(extreme) = self.dip(stretch, here, next) {
                self.cross(stretch, here, extreme, see);
                self.cross(stretch, extreme, next, see);
            } else {
                self.cross(stretch, here, next, see);
            }
            here = next;
        }
        self.last = here.1;
    }

    /// The extremum between two places that are not on different sides, if it may lie on the other side.
    fn dip(
        &mut self,
        stretch: &dyn Stretch,
        from: (f64, f64),
        to: (f64, f64),
    ) -> Option<(f64, f64)> {
        let sign = if from.1 == 0.0 { to.1 } else { from.1 }.signum();
        if from.1 * to.1 < 0.0 || sign.is_nan() {
            return None;
        }
        let aside = ASIDE * (to.0 - from.0);
        // The value at the start may be that of the stretch before, and differ from this one by rounding.
        let behind = self.value(stretch, from.0 + aside) - self.value(stretch, from.0);
        if sign * behind >= 0.0 {
            return None;
        }
        let before = to.1 - self.value(stretch, to.0 - aside);
        if sign * before <= 0.0 {
            return None;
        }
        let extreme = self.extremum(stretch, from.0, to.0, sign > 0.0);
        (sign * extreme.1 < 0.0).then_some(extreme)
    }

    /// Shows the crossing between two places, if there is one.
    fn cross(
        &mut self,
        stretch: &dyn Stretch,
        from: (f64, f64),
        to: (f64, f64),
        see: &mut dyn FnMut(f64, &[f64], bool),
    ) {
        if self.passed(to.1) && self.section.counts(to.1 > 0.0) {
            let phase = self.zero(stretch, from, to);
            stretch.state(phase, &mut self.state);
            see(phase, &self.state, to.1 > 0.0);
        }
    }

    /// The phase between two of different sign where `g` is nearest to zero: Chandrupatla's choice between inverse quadratic
    /// interpolation and bisection.
    fn zero(&mut self, stretch: &dyn Stretch, from: (f64, f64), to: (f64, f64)) -> f64 {
        // It may lie on the surface itself, and has no sign there.
        if from.1 == 0.0 {
            return from.0;
        }
        let (mut a, mut b) = (from, to);
        let mut t = 0.5;
        for _ in 0..100 {
            let phase = a.0 + t * (b.0 - a.0);
            let new = (phase, self.value(stretch, phase));
            if new.1 == 0.0 {
                return phase;
            }
            let old = if (new.1 > 0.0) == (a.1 > 0.0) {
                a
            } else {
                std::mem::replace(&mut b, a)
            };
            a = new;
            let width = (b.0 - a.0).abs();
            if width <= 2.0 * f64::EPSILON * a.0.abs().max(b.0.abs()) {
                break;
            }
            let xi = (a.0 - b.0) / (old.0 - b.0);
            let phi = (a.1 - b.1) / (old.1 - b.1);
            let interpolates = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
            t = if interpolates {
                let by_old = a.1 / (b.1 - a.1) * (old.1 / (b.1 - old.1));
                let by_b =
                    (old.0 - a.0) / (b.0 - a.0) * (a.1 / (old.1 - a.1)) * (b.1 / (old.1 - b.1));
                by_old + by_b
            } else {
                0.5
            };
            let least = f64::EPSILON * a.0.abs() / width;
            t = t.clamp(least, 1.0 - least);
        }
        if a.1.abs() < b.1.abs() { a.0 } else { b.0 }
    }

    /// The smallest `g` between two phases, or the largest: by golden section, until the sign changes.
    fn extremum(&mut self, stretch: &dyn Stretch, from: f64, to: f64, least: bool) -> (f64, f64) {
        let sign = if least { 1.0 } else { -1.0 };
        let (mut low, mut high) = (from, to);
        let mut place = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let mut value = (self.value(stretch, place.0), self.value(stretch, place.1));
        while high - low > 1e-8 * (to - from) {
            if sign * value.0.min(value.1) < 0.0 && sign * value.0.max(value.1) < 0.0 {
                break;
            }
            if sign * value.0 < sign * value.1 {
                high = place.1;
                place = (high - GOLDEN * (high - low), place.0);
                value = (self.value(stretch, place.0), value.0);
            } else {
                low = place.0;
                place = (place.1, low + GOLDEN * (high - low));
                value = (value.1, self.value(stretch, place.1));
            }
        }
        if sign * value.0 < sign * value.1 {
            (place.0, value.0)
        } else {
            (place.1, value.1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::affine::Affine;
    use crate::flow::{Flow, Integrated};

    crate::oscillator! {
        Linear(x) {
            param drive;
            ddot(x) + 4*x = drive*cos(omega*t);
        }
    }

    fn map(model: &Linear) -> Stroboscope<'_> {
        let flow = Affine::new(model, &[model.drive], 1.0).expect("affine");
        Stroboscope::new(Box::new(flow))
    }

    /// `x = cos 2 tau + b` passes zero where `cos 2 tau = -b`.
    fn crossings(offset: f64, direction: Direction) -> Vec<(f64, bool)> {
        let model = Linear { drive: 0.0 };
        let section = Section::entry(0, -offset, direction);
        let mut found = Vec::new();
        let mut state = [1.0, 0.0];
        section
            .follow(&mut map(&model), &mut state, 2, &mut |crossing| {
                found.push((TAU * crossing.periods, crossing.rises));
            })
            .expect("a motion");
        found
    }

    #[test]
    fn crossings_are_where_the_closed_form_says() {
        let offset: f64 = 0.3;
        let angle = (-offset).acos() / 2.0;
        let pi = std::f64::consts::PI;
        let found = crossings(offset, Direction::Both);
        let expected = (0..4).flat_map(|k| {
            let start = pi * f64::from(k);
            [(start + angle, false), (start + pi - angle, true)]
        });
        let expected: Vec<_> = expected.collect();
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (found.0 - expected.0).abs() < 1e-13,
                "{found:?} {expected:?}"
            );
            assert_eq!(found.1, expected.1);
        }
        assert_eq!(crossings(offset, Direction::Rising).len(), 4);
        assert_eq!(crossings(offset, Direction::Falling).len(), 4);
    }

    /// Two crossings within a hundredth of the distance of samples, and a turn just before the surface: wherever the pair lies
    /// between samples, and with stretches that begin anywhere.
    #[test]
    fn two_crossings_between_samples_are_both_found() {
        let model = Linear { drive: 0.0 };
        let flow = |exact: bool| -> Box<dyn Flow + '_> {
            if exact {
                return Box::new(Affine::new(&model, &[0.0], 1.0).expect("affine"));
            }
            Box::new(Integrated::new(&model, &[0.0], 1.0, 1e-13).expect("a flow"))
        };
        let depth: f64 = 1e-7;
        let half = depth.sqrt() / 2_f64.sqrt();
        for (exact, step) in (0..200).map(|k| (k < 100, k % 100)) {
            // From just before a pair to just behind the next one.
            let start = std::f64::consts::PI * (0.5 + 0.99 * f64::from(step) / 100.0) + 1e-3;
            let mut found = Vec::new();
            for depth in [depth, -depth] {
                let mut state = [(2.0 * start).cos(), -2.0 * (2.0 * start).sin()];
                let mut map = Stroboscope::new(flow(exact)).phase(start);
                Section::entry(0, depth - 1.0, Direction::Both)
                    .follow(&mut map, &mut state, 2, &mut |crossing| {
                        found.push(start + TAU * crossing.periods);
                    })
                    .expect("a motion");
            }
            assert_eq!(found.len(), 8, "{start} {found:?}");
            for (k, pair) in found.chunks(2).enumerate() {
                let middle = std::f64::consts::PI * (k as f64 + 1.5);
                for (crossing, sign) in pair.iter().zip([-1.0, 1.0]) {
                    let error = crossing - middle - sign * half;
                    // A crossing at a shallow angle is known to the error of the motion over the slope.
                    assert!(error.abs() < 1e-9, "{error:e}");
                }
            }
        }
    }

    /// A state that is too short for the surface, or for the system, is an error.
    #[test]
    fn entries_are_counted() {
        let model = Linear { drive: 0.0 };
        for (entry, entries) in [(7, 2), (0, 1), (0, 4)] {
            let section = Section::entry(entry, 0.0, Direction::Both);
            let mut state = vec![0.0; entries];
            let error = section
                .follow(&mut map(&model), &mut state, 1, &mut |_| {})
                .expect_err("no such entry");
            assert!(matches!(error, FlowError::Entries { .. }), "{error}");
        }
    }

    /// A surface through the start, through switches and at the ends of periods is passed once each time.
    #[test]
    fn a_surface_at_the_end_of_a_stretch_is_crossed_once() {
        let model = Linear { drive: 0.0 };
        let section = Section::new(Direction::Both, |_, state| state[1]);
        let mut quarters = Vec::new();
        let mut state = [1.0, 0.0];
        section
            .follow(&mut map(&model), &mut state, 10, &mut |crossing| {
                quarters.push((4.0 * crossing.periods).round() as usize);
            })
            .expect("a motion");
        // x' = -2 sin 2 tau: at every quarter of a period. The last one is where the motion ends, on either side by rounding.
        let last = quarters.len();
        assert!(last == 39 || last == 40);
        assert_eq!(quarters, (1..=last).collect::<Vec<_>>());
    }

    /// A stop that moves, `g = x - b cos tau`, and does not push: the motion is `cos 2 tau`, and the crossings are where both
    /// meet.
    #[test]
    fn a_moving_gap_is_crossed_where_it_closes() {
        crate::oscillator! {
            Moving(x) {
                param stiffness in 0.0..;
                law stop(gap) { gap > 0 => gap, else => 0 }
                ddot(x) + 4*x + stiffness*stop(x - 0.5*cos(omega*t)) = 0;
            }
        }
        let model = Moving { stiffness: 0.0 };
        let flow = Affine::new(&model, &[0.0], 1.0).expect("affine");
        let mut map = Stroboscope::new(Box::new(flow));
        let section = Section::gap(&model, (&[0.0], 1.0), 0, (0.0, Direction::Both));
        let mut phases = Vec::new();
        let mut state = [1.0, 0.0];
        section
            .expect("a contact")
            .follow(&mut map, &mut state, 1, &mut |crossing| {
                phases.push(crossing.phase);
            })
            .expect("a motion");
        // cos 2 tau = 0.5 cos tau: with c = cos tau, 2 c^2 - c / 2 - 1 = 0.
        let roots = [-1.0, 1.0].map(|sign: f64| (0.5 + sign * 8.25_f64.sqrt()) / 4.0);
        let (near, far) = (roots[1].acos(), roots[0].acos());
        let expected = [near, far, TAU - far, TAU - near];
        assert_eq!(phases.len(), 4, "{phases:?}");
        for (found, expected) in phases.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
        let of = |values, contact| {
            let section = Section::gap(&model, (values, 1.0), contact, (0.0, Direction::Both));
            section.map(|_| ()).expect_err("it cannot be")
        };
        assert!(matches!(of(&[0.0], 1), Error::Option { .. }));
        assert!(matches!(of(&[0.0, 0.0], 0), Error::Values { .. }));
    }
}
