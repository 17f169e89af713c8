//! Extremes of the coordinates and of the gaps of an orbit, from one walk along its period.
//!
//! States are sampled: those of the pass where its nodes are dense enough, else eight to the shortest period of the linear part, its load
//! and the directions that move, six on an interval at least. Between two samples that are `h` apart, with values `x`, `y` and slopes `v`,
//! `w`, the slope of the cubic through all of these is, with `r = y - x` at the part `s` of the way,
//!
//! ```text
//! h p'(s) = a s^2 + b s + h v,    a = 3 h (v + w) - 6 r,    b = 6 r - 4 h v - 2 h w                            (1)
//! ```
//!
//! Where a slope changes its sign between two samples, its zero is located to `1e-9` of their distance: of a gap every one, of a coordinate
//! those that may be its smallest or its largest value, as far as the value of the cubic at the zero of (1) tells. Where a gap has slopes of
//! one sign at both ends, and (1) at `s = -b / (2 a)` is less than a tenth of the larger of them or has the other sign, the motion itself is
//! looked at there, and both parts in the same way, to four halvings.
//!
//! Nothing proves that the cubic is near the motion. A maximum and a minimum of a gap between two samples of which (1) does not tell are not
//! seen, and neither is a contact that begins and ends between them.
//!
//! Source: de Boor (2001), A Practical Guide to Splines, chapter IV (cubic Hermite interpolation).

use super::motion::Motion;
use crate::contact_equation::equations::pass_results::{Extremes, GapExtreme};
use crate::contact_equation::skeleton::placement::Told;
use crate::numeric::roots::{self, Place};

/// Samples of a rate in the shortest period of what an interval without nodes can do.
const SAMPLES: f64 = 8.0;
/// The same at least.
const FEWEST: f64 = 6.0;
/// More are not taken, however fast the motion is.
const MOST: f64 = 1e6;
/// Accuracy of the phase of an extreme, in parts of the distance of two samples.
const LOCATED: f64 = 1e-9;
/// Two extremes of a gap as near as this are one.
const SEEN_TWICE: f64 = 1e-6;
/// The rate of a gap is looked at between samples where it may come as near to zero, in parts of the larger one of both, so often at most.
const DIPS: f64 = 0.1;
const HALVINGS: usize = 4;
/// As far from an extreme that is known, in parts of the distance of two samples, its rate has a sign.
const ASIDE: f64 = 1e-3;
/// A cubic may be wrong by this part of the range of a coordinate.
const FORETOLD: f64 = 0.02;

/// A turn of a coordinate between two phases.
#[derive(Debug, Clone, Copy)]
struct Turn {
    interval: usize,
    /// Phases, and velocities there.
    ends: [Place; 2],
    /// The position, about.
    about: f64,
}

/// Turns of a coordinate, and its smallest and largest sample.
#[derive(Debug, Clone)]
struct Turns {
    /// Minima and maxima.
    of: [Vec<Turn>; 2],
    best: [Place; 2],
}

/// Phases of an interval with the states there.
#[derive(Debug, Default)]
struct Samples {
    phases: Vec<f64>,
    states: Vec<f64>,
}

impl Extremes {
    /// Of the motion of the last pass.
    pub(in crate::contact_equation) fn of(motion: &Motion<'_>) -> Self {
        let values = &motion.equations.values;
        let coordinates = values.linear.positions.nrows();
        let mut gaps = vec![Vec::new(); values.contacts.len()];
        let none = |value: f64| Place { x: 0.0, value };
        let nothing = Turns {
            of: [Vec::new(), Vec::new()],
            best: [none(f64::INFINITY), none(f64::NEG_INFINITY)],
        };
        let mut turns = vec![nothing; coordinates];
        let mut samples = Samples::default();
        let mut ends = vec![None; values.contacts.len()];
        for interval in 0..motion.intervals() {
            let [from, to] = motion.phases(interval);
            if to <= from {
                continue;
            }
            samples.take(motion, interval);
            for (contact, gaps) in gaps.iter_mut().enumerate() {
                if !values.contacts[contact].levels.is_empty() {
                    let scan = Scan {
                        motion,
                        interval,
                        contact,
                        found: gaps,
                    };
                    samples.gap(scan, &mut ends[contact]);
                }
            }
            for (coordinate, turns) in turns.iter_mut().enumerate() {
                samples.coordinate(motion, interval, coordinate, turns);
            }
        }
        for (contact, gaps) in gaps.iter_mut().enumerate() {
            add_short(motion, contact, gaps);
        }
        let coordinates = turns.into_iter().enumerate();
        let coordinates = coordinates.map(|(coordinate, turns)| turns.located(motion, coordinate));
        let coordinates: Vec<[Place; 2]> = coordinates.collect();
        Self {
            coordinates: of_period(motion, &coordinates),
            gaps,
        }
    }
}

/// Smallest and largest values over the period, from those until the orbit comes back: then coordinates have the motions of their images.
fn of_period(motion: &Motion<'_>, found: &[[Place; 2]]) -> Vec<[Place; 2]> {
    let skeleton = &motion.equations.skeleton;
    let image = &skeleton.recurrence().image;
    let mut most = found.to_vec();
    for turns in 1..image.order() {
        let image = image.power(turns);
        let later = skeleton.length * turns as f64;
        for (coordinate, most) in most.iter_mut().enumerate() {
            let (place, sign) = image.entry(coordinate);
            let mut ends = found[place].map(|end| Place {
                x: end.x + later,
                value: sign * end.value,
            });
            if sign < 0.0 {
                ends.reverse();
            }
            if ends[0].value < most[0].value {
                most[0] = ends[0];
            }
            if ends[1].value > most[1].value {
                most[1] = ends[1];
            }
        }
    }
    most
}

impl Samples {
    fn take(&mut self, motion: &Motion<'_>, interval: usize) {
        self.phases.clear();
        self.states.clear();
        let passed = &motion.equations.passed[interval];
        let [from, to] = passed.phases;
        let of = &motion.equations.skeleton.intervals[interval];
        let parts = (SAMPLES * motion.fastest(interval) * (to - from)).max(FEWEST);
        let known = !of.active.is_empty() && parts * of.nodes.widest() <= 1.0;
        let order = motion.equations.skeleton.order;
        if known {
            self.phases.push(from);
            let targets = of.nodes.targets.iter();
            self.phases
                .extend(targets.map(|psi| from + psi * (to - from)));
            self.states.extend_from_slice(&passed.states);
            return;
        }
        let parts = parts.ceil().min(MOST) as usize;
        self.states.resize((parts + 1) * order, 0.0);
        for (part, states) in self.states.chunks_exact_mut(order).enumerate() {
            let phase = from + (to - from) * (part as f64 / parts as f64);
            self.phases.push(phase);
            motion.states(interval, phase, states);
        }
    }

    fn states(&self, index: usize) -> &[f64] {
        let order = self.states.len() / self.phases.len();
        &self.states[index * order..][..order]
    }

    /// Extremes of a gap. Which sign its rate has where two intervals meet, as at an extreme of another gap that is opposite to it, is rounding:
    /// it is one for both of them.
    fn gap(&self, mut scan: Scan<'_, '_>, end: &mut Option<Seen>) {
        let last = self.phases.len() - 1;
        let mut before = scan.of(self.phases[0], self.states(0));
        if let Some(end) = end.filter(|end| (end.x - before.x).abs() <= SEEN_TWICE) {
            before.rate = end.rate;
        }
        for index in 1..=last {
            let mut next = scan.of(self.phases[index], self.states(index));
            let here = next;
            if index == 1 {
                scan.move_inside(&mut before, next.x, true);
            }
            if index == last {
                scan.move_inside(&mut next, before.x, false);
            }
            scan.between(before, next, HALVINGS);
            before = here;
        }
        *end = Some(before);
    }

    /// Turns of a coordinate.
    fn coordinate(
        &self,
        motion: &Motion<'_>,
        interval: usize,
        coordinate: usize,
        turns: &mut Turns,
    ) {
        let at = |index: usize| motion.coordinate_of(coordinate, self.states(index));
        let mut before = at(0);
        turns.see(self.phases[0], before[0]);
        for index in 1..self.phases.len() {
            let next = at(index);
            let ends = [self.phases[index - 1], self.phases[index]];
            turns.see(ends[1], next[0]);
            if (before[1] > 0.0) != (next[1] > 0.0) {
                let time = (ends[1] - ends[0]) / motion.equations.values.base;
                let velocities = [before[1], next[1]];
                let turn = Turn {
                    interval,
                    ends: [0, 1].map(|end| Place {
                        x: ends[end],
                        value: velocities[end],
                    }),
                    about: of_cubic([before, next], time),
                };
                turns.of[usize::from(before[1] > 0.0)].push(turn);
            }
            before = next;
        }
    }
}

/// A gap and its rate by the phase.
#[derive(Debug, Clone, Copy)]
struct Seen {
    x: f64,
    gap: f64,
    rate: f64,
}

/// The search for the extremes of a gap on an interval.
struct Scan<'s, 'm> {
    motion: &'s Motion<'m>,
    interval: usize,
    contact: usize,
    found: &'s mut Vec<GapExtreme>,
}

impl Scan<'_, '_> {
    fn of(&self, x: f64, states: &[f64]) -> Seen {
        let [gap, rate] = self.motion.gap_of(self.contact, x, states);
        let rate = rate / self.motion.equations.values.base;
        Seen { x, gap, rate }
    }

    fn at(&self, x: f64) -> Seen {
        let [gap, rate] = self.motion.gap(self.contact, self.interval, x);
        let rate = rate / self.motion.equations.values.base;
        Seen { x, gap, rate }
    }

    /// Where an interval begins or ends at an extreme that is short of a level, which is added afterwards, the sign of the rate is that beside it.
    fn move_inside(&self, end: &mut Seen, other: f64, begins: bool) {
        let skeleton = &self.motion.equations.skeleton;
        let beside = if begins {
            self.interval.checked_sub(1)
        } else {
            Some(self.interval + 1).filter(|next| *next < self.motion.intervals())
        };
        let Some(beside) = beside.filter(|beside| self.is_nowhere(*beside)) else {
            return;
        };
        let ends = skeleton.intervals[beside.min(self.interval)].ends;
        let Some(switch) = ends.map(|switch| skeleton.switches[switch]) else {
            return;
        };
        let told = match switch.told {
            Told::First { .. } => !begins,
            Told::Second { .. } => begins,
            Told::Alone => false,
        };
        if told && switch.contact == self.contact {
            *end = self.at(end.x + ASIDE * (other - end.x));
        }
    }

    fn is_nowhere(&self, interval: usize) -> bool {
        let [from, to] = self.motion.phases(interval);
        to <= from
    }

    /// Adds the extremes between two phases. Where the rate has one sign at both ends, the parabola (1) tells whether it has another one between
    /// them.
    fn between(&mut self, before: Seen, next: Seen, halvings: usize) {
        let time = next.x - before.x;
        if (before.rate > 0.0) != (next.rate > 0.0) {
            let slope = |phase: f64| self.at(phase).rate;
            let place = |of: &Seen| Place {
                x: of.x,
                value: of.rate,
            };
            let root = roots::root(place(&before), place(&next), LOCATED * time, slope);
            let Some(phase) = root else { return };
            self.found.push(GapExtreme {
                contact: self.contact,
                interval: self.interval,
                phase,
                gap: self.at(phase).gap,
                maximum: before.rate > 0.0,
            });
            return;
        }
        let [v, w] = [before.rate, next.rate].map(|rate| rate * time);
        let way = next.gap - before.gap;
        // (1)
        let (a, b) = (3.0 * (v + w) - 6.0 * way, 6.0 * way - 4.0 * v - 2.0 * w);
        let s = -b / (2.0 * a);
        let turns = v.signum() * (v + 0.5 * b * s) < DIPS * v.abs().max(w.abs());
        if halvings > 0 && turns && s > 0.0 && s < 1.0 {
            let middle = self.at(before.x + s * time);
            self.between(before, middle, halvings - 1);
            self.between(middle, next, halvings - 1);
        }
    }
}

impl Turns {
    fn see(&mut self, x: f64, value: f64) {
        if value < self.best[0].value {
            self.best[0] = Place { x, value };
        }
        if value > self.best[1].value {
            self.best[1] = Place { x, value };
        }
    }

    /// The smallest and the largest value.
    fn located(mut self, motion: &Motion<'_>, coordinate: usize) -> [Place; 2] {
        let spread = FORETOLD * (self.best[1].value - self.best[0].value);
        for (side, turns) in self.of.iter_mut().enumerate() {
            let sign = if side == 1 { 1.0 } else { -1.0 };
            turns.sort_by(|a, b| (sign * b.about).total_cmp(&(sign * a.about)));
            let best = &mut self.best[side];
            for turn in turns {
                if sign * (best.value - turn.about) > spread {
                    break;
                }
                let [a, b] = turn.ends;
                let velocity = |phase: f64| motion.coordinate(coordinate, turn.interval, phase)[1];
                let within = LOCATED * (b.x - a.x);
                if let Some(x) = roots::root(a, b, within, velocity) {
                    let value = motion.coordinate(coordinate, turn.interval, x)[0];
                    if sign * (value - best.value) > 0.0 {
                        *best = Place { x, value };
                    }
                }
            }
        }
        self.best
    }
}

/// The value of the cubic through positions and velocities on both sides at the zero of (1).
fn of_cubic([[x, v], [y, w]]: [[f64; 2]; 2], time: f64) -> f64 {
    let (v, w) = (v * time, w * time);
    // (1)
    let a = 6.0 * (x - y) + 3.0 * (v + w);
    let b = -6.0 * (x - y) - 4.0 * v - 2.0 * w;
    let root = (b * b - 4.0 * a * v).max(0.0).sqrt();
    let q = -0.5 * (b + root.copysign(b));
    let s = [v / q, q / a]
        .into_iter()
        .find(|s| (0.0..=1.0).contains(s))
        .unwrap_or(0.5);
    let t = 1.0 - s;
    (1.0 + 2.0 * s) * t * t * x + s * t * t * v + s * s * (3.0 - 2.0 * s) * y - s * s * t * w
}

/// Extremes that are short of a level stand where two intervals meet: rounding says whether they are seen within one. They are those of
/// pairs of switches in one place.
fn add_short(motion: &Motion<'_>, contact: usize, found: &mut Vec<GapExtreme>) {
    let skeleton = &motion.equations.skeleton;
    for (first, switch) in skeleton.switches.iter().enumerate() {
        let Told::First { other, .. } = switch.told else {
            continue;
        };
        let intervals = [first, other].map(|switch| skeleton.before(switch));
        let [Some(before), Some(between)] = intervals else {
            continue;
        };
        let phase = motion.phases(before)[1];
        if switch.contact != contact || phase < motion.phases(between)[1] {
            continue;
        }
        found.retain(|extreme| (extreme.phase - phase).abs() > SEEN_TWICE);
        found.push(GapExtreme {
            contact,
            interval: before,
            phase,
            gap: motion.gap(contact, before, phase)[0],
            maximum: switch.rises,
        });
    }
}
