//! Where gaps switch: the state there, how it moves, and what the signals are on either side.
//!
//! A flow stops beside a switch and not on it, where it could be on either side. With the distance `d` of the stop from the switch,
//!
//! ```text
//! s(tau + d) = s + s_tau d + O(d^2),          s'(tau + d) = s' + (s_tau)' d + ...,                            (1)
//! ```
//!
//! the state and its derivatives are those before the switch. Several gaps may switch at once, each at its own rate: a signal jumps contact by
//! contact, and jumps of all of them sum up to that of the signal. A square of a signal jumps in another way where another contact is the
//! first; where their places move apart it has a derivative to each side, and none.

use super::moments::Moments;
use super::reader::Reader;
use super::slopes::{Direction, Instant};

/// Places of contacts that switch at once move alike if they differ by no more than this part: flows leave less.
const ALIKE: f64 = 1e-6;

/// What is shown a switch by its number, and the signals before and after it.
type See<'s> = &'s mut dyn FnMut(usize, &[f64], &[f64]);

/// A place where gaps switch, at the end of an arc.
pub(super) struct Landing {
    /// The arc that ends.
    pub(super) arc: usize,
    pub(super) phase: f64,
    /// Those that switch there, by their numbers among all switches.
    pub(super) switches: std::ops::Range<usize>,
    pub(super) state: Vec<f64>,
    /// How that moves with the phase, before the switch.
    pub(super) rate: Vec<f64>,
    /// How it moves along each direction at a fixed phase, before the switch.
    pub(super) moved: Vec<Vec<f64>>,
}

impl Reader<'_> {
    /// All of them, in the order of the motion.
    pub(super) fn landings(&self) -> Vec<Landing> {
        let switches = &self.places.scan.switches;
        let mut all = Vec::new();
        let mut first = 0;
        while let Some(switch) = switches.get(first) {
            let same = switches[first..].iter().take_while(|s| s.arc == switch.arc);
            let next = first + same.count();
            all.push(self.landing(switch.arc, first..next));
            first = next;
        }
        all
    }

    /// (1)
    fn landing(&self, number: usize, switches: std::ops::Range<usize>) -> Landing {
        let arc = &self.places.scan.arcs[number];
        let stop = self.places.switches[switches.start];
        let phase = self.places.stops[stop].phase;
        let left = arc.to - phase;
        let mut state = self.evaluated.stops[stop].state.clone();
        let at = self.slopes.at(phase, &state, &arc.pieces);
        let mut rate = vec![0.0; state.len()];
        self.slopes.write_rate(&at, &mut rate);
        let (mut room, mut change) = (self.slopes.moved(), rate.clone());
        let moved = (0..self.directions.len()).map(|direction| {
            let mut moved = vec![0.0; state.len()];
            self.moved(stop, direction, &mut moved);
            let along = self.direction(direction, &moved, 0.0);
            self.slopes.rate_along(&at, along, &mut room, &mut change);
            let both = moved.iter_mut().zip(&change);
            both.for_each(|(s, by_phase)| *s += by_phase * left);
            moved
        });
        let moved = moved.collect();
        let both = state.iter_mut().zip(&rate);
        both.for_each(|(s, by_phase)| *s += by_phase * left);
        let there = self.slopes.at(arc.to, &state, &arc.pieces);
        self.slopes.write_rate(&there, &mut rate);
        Landing {
            arc: number,
            phase: arc.to,
            switches,
            state,
            rate,
            moved,
        }
    }

    /// A direction, in which the state moves in a known way.
    pub(super) fn direction<'d>(
        &'d self,
        number: usize,
        state: &'d [f64],
        phase: f64,
    ) -> Direction<'d> {
        Direction {
            state,
            by: Some(&self.by[number]),
            phase,
        }
    }

    /// How the switches of a landing move: (1) of [`reader`](super::reader).
    pub(super) fn shifts_of(&self, landing: &Landing) -> Vec<Vec<f64>> {
        let scan = &self.places.scan;
        let pieces = &scan.arcs[landing.arc].pieces;
        let at = self.slopes.at(landing.phase, &landing.state, pieces);
        let of = |switch: usize| {
            let switch = &scan.switches[switch];
            let directions = landing.moved.iter().enumerate();
            let shifts = directions.map(|(number, moved)| {
                let along = self.direction(number, moved, 0.0);
                let (contact, level) = (switch.contact, switch.level);
                let [grows, rate] = self.slopes.distance_along(&at, contact, level, along);
                -grows / rate
            });
            shifts.collect()
        };
        landing.switches.clone().map(of).collect()
    }

    /// The signals before and after each switch of a landing, in an order.
    fn cross(&self, landing: &Landing, order: impl Iterator<Item = usize>, see: See<'_>) {
        let scan = &self.places.scan;
        let mut pieces = scan.arcs[landing.arc].pieces.clone();
        let next = &scan.arcs[landing.arc + 1].pieces;
        let mut at = self.slopes.at(landing.phase, &landing.state, &pieces);
        let mut before = vec![0.0; self.slopes.count()];
        self.slopes.write(&at, &mut before);
        let mut after = before.clone();
        for switch in order {
            let contact = scan.switches[switch].contact;
            pieces[contact] = next[contact];
            (self.slopes).look(landing.phase, &landing.state, &pieces, &mut at);
            self.slopes.write(&at, &mut after);
            see(switch, &before, &after);
            before.copy_from_slice(&after);
        }
    }

    /// The sum of (4) of [`reader`](super::reader).
    pub(super) fn add_jumps(&self, moments: &mut [Moments]) {
        for landing in &self.landings {
            let segment = self.places.scan.arcs[landing.arc].segment;
            let angle = (self.passed(segment) + landing.phase) / self.period as f64;
            let forth = landing.switches.clone();
            self.cross(landing, forth.clone(), &mut |switch, before, after| {
                let shifts = &self.shifts[switch];
                let both = before.iter().zip(after);
                for (moments, (&before, &after)) in moments.iter_mut().zip(both) {
                    moments.jump([before, after], shifts, angle);
                }
            });
            if forth.len() > 1 {
                self.part_squares(landing, moments);
            }
        }
    }

    /// Squares have no derivative where they jump in another way in another order.
    fn part_squares(&self, landing: &Landing, moments: &mut [Moments]) {
        let directions = self.directions.len();
        let order = landing.switches.clone();
        // What the one order and the other one add, and how large it is, by signal and direction.
        let mut apart = vec![[0.0, 0.0]; moments.len() * directions];
        let mut add = |sign: f64, switch: usize, before: &[f64], after: &[f64]| {
            let jumps = before.iter().zip(after).map(|(a, b)| (a - b) * (a + b));
            for (of_signal, jump) in apart.chunks_exact_mut(directions).zip(jumps) {
                for ([sum, size], shift) in of_signal.iter_mut().zip(&self.shifts[switch]) {
                    *sum += sign * jump * shift;
                    *size += (jump * shift).abs();
                }
            }
        };
        self.cross(landing, order.clone(), &mut |switch, before, after| {
            add(1.0, switch, before, after);
        });
        self.cross(landing, order.rev(), &mut |switch, before, after| {
            add(-1.0, switch, before, after);
        });
        for (moments, apart) in moments.iter_mut().zip(apart.chunks_exact(directions)) {
            for (by, [sum, size]) in moments.square.by.iter_mut().zip(apart) {
                if sum.abs() > ALIKE * size {
                    *by = f64::NAN;
                }
            }
        }
    }

    /// How the place of a signal's limit at a landing moves: with that of the contacts at which it jumps, or of all if it is continuous. No
    /// number where these part.
    pub(super) fn shift_of_limit(&self, landing: &Landing, signal: usize) -> Vec<f64> {
        let mut own = Vec::new();
        let order = landing.switches.clone();
        self.cross(landing, order.clone(), &mut |switch, before, after| {
            if before[signal] != after[signal] {
                own.push(switch);
            }
        });
        if own.is_empty() {
            own = order.collect();
        }
        let of = |direction: usize| {
            let mut shifts = own.iter().map(|&switch| self.shifts[switch][direction]);
            let first = shifts.next().unwrap_or(f64::NAN);
            let is_alike =
                |shift: f64| (shift - first).abs() <= ALIKE * shift.abs().max(first.abs());
            if shifts.all(is_alike) {
                first
            } else {
                f64::NAN
            }
        };
        (0..self.directions.len()).map(of).collect()
    }

    /// The motion at a landing on the pieces of an arc beside it, with slopes of forces that are numbers.
    pub(super) fn beside(&self, landing: &Landing, arc: usize) -> Instant {
        let pieces = &self.places.scan.arcs[arc].pieces;
        let mut at = self.slopes.at(landing.phase, &landing.state, pieces);
        self.slopes.step_inside(&mut at);
        at
    }
}
