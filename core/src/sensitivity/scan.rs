//! One pass along an orbit: where it switches, and where its signals have their extremes.
//!
//! Stretches on the same pieces are one arc. The slope of a signal along the motion,
//!
//! ```text
//! y' = y_s (v, a) / Omega + y_tau,                                                                            (1)
//! ```
//!
//! is known exactly, so that an extreme inside of a stretch is a zero of (1) between two samples. At the ends of an arc one-sided limits count.

use super::cycle::{Cycle, Stop};
use super::slopes::{Direction, Instant, Moved, Slopes};
use crate::numeric::roots::{self, Place};
use crate::time::{FlowError, Stretch};

/// Samples of a stretch are at most so far apart in phase, and there are at least so many steps between them.
const APART: f64 = 0.1;
const FEWEST: usize = 4;
/// Rounding of the phases of switches that are at one phase.
const AT_ONCE: f64 = 1e-12;
/// A switch is looked at this part of its arc before it is passed, where the state surely belongs to the arc.
const BEFORE: f64 = 1e-10;

/// A part of the motion on the same pieces.
#[derive(Debug, Clone)]
pub(super) struct Arc {
    pub(super) segment: usize,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) pieces: Vec<usize>,
}

/// Where a gap crosses a level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Switch {
    pub(super) contact: usize,
    pub(super) level: usize,
    /// The arc that ends there; the next one begins.
    pub(super) arc: usize,
}

/// Where a signal has its largest or its smallest value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extreme {
    pub(super) value: f64,
    pub(super) phase: f64,
    /// Also the one whose pieces count.
    pub(super) arc: usize,
    /// It is a limit at the end of the arc, where a switch is, or at its beginning.
    pub(super) end: Option<End>,
}

/// An end of an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    First,
    Last,
}

/// What a pass along the orbit has found.
#[derive(Debug, Clone, Default)]
pub(super) struct Scan {
    pub(super) arcs: Vec<Arc>,
    pub(super) switches: Vec<Switch>,
    /// Largest and smallest value of each signal.
    pub(super) extremes: Vec<[Option<Extreme>; 2]>,
    /// Where gaps have extremes: contact, phase, arc, gap.
    pub(super) turns: Vec<Turn>,
}

/// An extreme of a gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub(super) contact: usize,
    pub(super) arc: usize,
    pub(super) phase: f64,
    pub(super) gap: f64,
}

/// A motion at a phase of a stretch: signals and their slopes, gaps and their rates.
struct Sample {
    phase: f64,
    values: Vec<f64>,
    slopes: Vec<f64>,
    gaps: Vec<[f64; 2]>,
}

/// Workspace of a pass.
struct Room {
    state: Vec<f64>,
    rate: Vec<f64>,
    at: Instant,
    moved: Moved,
    /// The last two samples, and one between them.
    samples: [Sample; 3],
}

impl Room {
    fn new(slopes: &Slopes) -> Self {
        let sample = || Sample {
            phase: 0.0,
            values: vec![0.0; slopes.count()],
            slopes: vec![0.0; slopes.count()],
            gaps: vec![[0.0; 2]; slopes.contacts()],
        };
        Self {
            state: vec![0.0; slopes.order()],
            rate: vec![0.0; slopes.order()],
            at: slopes.instant(),
            moved: slopes.moved(),
            samples: [sample(), sample(), sample()],
        }
    }
}

impl Scan {
    /// Along the orbit from these states; gaps are looked at where that is asked for.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn of(
        cycle: &mut Cycle,
        slopes: &Slopes,
        states: &[f64],
        gaps: bool,
    ) -> Result<Self, FlowError> {
        let mut scan = Self {
            extremes: vec![[None; 2]; slopes.count()],
            ..Self::default()
        };
        let mut room = Room::new(slopes);
        cycle.trace(states, &mut |segment, stretch| {
            scan.include(slopes, segment, stretch, gaps, &mut room);
        })?;
        scan.find_switches();
        scan.settle_ends();
        Ok(scan)
    }

    fn include(
        &mut self,
        slopes: &Slopes,
        segment: usize,
        stretch: &dyn Stretch,
        gaps: bool,
        room: &mut Room,
    ) {
        let (from, to) = stretch.phases();
        // Gaps that switch so near each other switch at once.
        if to - from <= AT_ONCE * to.abs().max(1.0) {
            return;
        }
        let middle = 0.5 * (from + to);
        stretch.state(middle, &mut room.state);
        match self.arcs.last_mut() {
            Some(arc)
                if arc.segment == segment
                    && slopes
                        .pieces(middle, &room.state)
                        .eq(arc.pieces.iter().copied()) =>
            {
                arc.to = to;
            }
            _ => self.arcs.push(Arc {
                segment,
                from,
                to,
                pieces: slopes.pieces(middle, &room.state).collect(),
            }),
        }
        let steps = FEWEST.max(((to - from) / APART).ceil() as usize);
        for index in 0..=steps {
            // The end is the end itself, so that it is known as one.
            let phase = if index == steps {
                to
            } else {
                from + (to - from) * index as f64 / steps as f64
            };
            self.sample(slopes, stretch, phase, room, 1);
            for signal in 0..slopes.count() {
                self.consider(signal, phase, room.samples[1].values[signal]);
                if index > 0 {
                    self.refine(slopes, stretch, signal, room);
                }
            }
            if gaps && index > 0 {
                self.gap_turns(slopes, stretch, room);
            }
            room.samples.swap(0, 1);
        }
    }

    /// Notes a value of a signal, if it is the largest or the smallest one.
    fn consider(&mut self, signal: usize, phase: f64, value: f64) {
        let extreme = Extreme {
            value,
            phase,
            arc: self.arcs.len() - 1,
            end: None,
        };
        let [largest, smallest] = &mut self.extremes[signal];
        if largest.is_none_or(|known| value > known.value) {
            *largest = Some(extreme);
        }
        if smallest.is_none_or(|known| value < known.value) {
            *smallest = Some(extreme);
        }
    }

    /// Notes an extreme between two samples whose slopes have opposite signs.
    fn refine(&mut self, slopes: &Slopes, stretch: &dyn Stretch, signal: usize, room: &mut Room) {
        let [a, b] = [0, 1].map(|index| Place {
            x: room.samples[index].phase,
            value: room.samples[index].slopes[signal],
        });
        if a.value * b.value >= 0.0 {
            return;
        }
        let root = roots::root(a, b, 0.0, |phase| {
            self.sample(slopes, stretch, phase, room, 2);
            room.samples[2].slopes[signal]
        });
        if let Some(phase) = root {
            self.sample(slopes, stretch, phase, room, 2);
            self.consider(signal, phase, room.samples[2].values[signal]);
        }
    }

    fn gap_turns(&mut self, slopes: &Slopes, stretch: &dyn Stretch, room: &mut Room) {
        for contact in 0..slopes.contacts() {
            let [a, b] = [0, 1].map(|index| Place {
                x: room.samples[index].phase,
                value: room.samples[index].gaps[contact][1],
            });
            if a.value * b.value > 0.0 {
                continue;
            }
            let root = roots::root(a, b, 0.0, |phase| {
                self.sample(slopes, stretch, phase, room, 2);
                room.samples[2].gaps[contact][1]
            });
            if let Some(phase) = root {
                self.sample(slopes, stretch, phase, room, 2);
                self.turns.push(Turn {
                    contact,
                    arc: self.arcs.len() - 1,
                    phase,
                    gap: room.samples[2].gaps[contact][0],
                });
            }
        }
    }

    /// Takes a sample on the last arc.
    fn sample(
        &self,
        slopes: &Slopes,
        stretch: &dyn Stretch,
        phase: f64,
        room: &mut Room,
        number: usize,
    ) {
        let Some(arc) = self.arcs.last() else { return };
        let Room {
            state,
            rate,
            at,
            moved,
            samples,
        } = room;
        let sample = &mut samples[number];
        stretch.state(phase, state);
        slopes.look(phase, state, &arc.pieces, at);
        slopes.write_rate(at, rate);
        sample.phase = phase;
        sample.gaps.copy_from_slice(&at.gaps);
        let direction = Direction {
            state: rate,
            by: None,
            phase: 1.0,
        };
        slopes.write(at, &mut sample.values);
        slopes.along(at, direction, moved, sample.slopes.iter_mut());
    }

    fn find_switches(&mut self) {
        for arc in 0..self.arcs.len().saturating_sub(1) {
            let (before, next) = (&self.arcs[arc], &self.arcs[arc + 1]);
            if before.segment != next.segment {
                continue;
            }
            let pieces = before.pieces.iter().zip(&next.pieces).enumerate();
            for (contact, (a, b)) in pieces {
                if a != b {
                    self.switches.push(Switch {
                        contact,
                        level: *a.min(b),
                        arc,
                    });
                }
            }
        }
    }

    /// An extreme at a switch is a limit there.
    fn settle_ends(&mut self) {
        let (arcs, switches) = (&self.arcs, &self.switches);
        for extreme in self.extremes.iter_mut().flatten().flatten() {
            let arc = &arcs[extreme.arc];
            let ends = |index: usize| switches.iter().any(|switch| switch.arc == index);
            if extreme.phase == arc.to && ends(extreme.arc) {
                extreme.end = Some(End::Last);
            } else if extreme.phase == arc.from && extreme.arc.checked_sub(1).is_some_and(ends) {
                extreme.end = Some(End::First);
            }
        }
    }

    /// The place at which a switch is looked at.
    pub(super) fn stop_of(&self, switch: &Switch) -> Stop {
        let arc = &self.arcs[switch.arc];
        Stop {
            segment: arc.segment,
            phase: arc.to - BEFORE * (arc.to - arc.from),
        }
    }
}
