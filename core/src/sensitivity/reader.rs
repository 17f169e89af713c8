//! What is read off signals of an orbit, and how it moves along directions.
//!
//! Along a direction in which the states at the beginnings of the segments move by `s'`, a variable by `p'` and a switch therefore by
//! `sigma'`,
//!
//! ```text
//! sigma' = - ( g_s s' + g_p p' - level' ) / (dg/dtau),                                                        (1)
//! (max y)' = y_s s' + y_p p'                                  at the extreme, where y_tau = 0,                (2)
//! (lim y)' = y_s (s' + s_tau sigma') + y_p p' + y_tau sigma'  of a limit at a switch,                         (3)
//! ( int y w )' = int (y_s s' + y_p p') w  +  sum ( y_before - y_after ) w sigma'.                             (4)
//! ```

use nalgebra::DVector;

use super::cycle::{Cycle, Evaluated};
use super::landing::Landing;
use super::moments::{Moments, Slope};
use super::sample_phases::Places;
use super::scan::{End, Extreme};
use super::slopes::{By, Direction, Instant, Moved, Slopes};
use crate::system::Variable;

/// How states and variables move together.
#[derive(Debug, Clone)]
pub(super) struct Along {
    /// Of the states at the beginnings of all segments.
    pub(super) states: DVector<f64>,
    /// Of each variable that the equations were evaluated with.
    pub(super) weights: Vec<f64>,
}

/// An orbit at the places where it is looked at.
pub(super) struct Reader<'r> {
    pub(super) places: &'r Places,
    pub(super) slopes: &'r Slopes,
    pub(super) evaluated: &'r Evaluated,
    /// How the coefficients move along each direction.
    pub(super) by: Vec<By>,
    pub(super) directions: &'r [Along],
    order: usize,
    pub(super) landings: Vec<Landing>,
    /// How each switch moves along each direction.
    pub(super) shifts: Vec<Vec<f64>>,
    pub(super) period: usize,
}

impl<'r> Reader<'r> {
    pub(super) fn new(
        places: &'r Places,
        slopes: &'r Slopes,
        evaluated: &'r Evaluated,
        variables: &[Variable],
        directions: &'r [Along],
        cycle: &Cycle,
    ) -> Self {
        let of_variables: Vec<By> = variables.iter().map(|&v| slopes.by(v)).collect();
        let by = directions
            .iter()
            .map(|along| combined(&of_variables, &along.weights));
        let mut reader = Self {
            places,
            slopes,
            evaluated,
            by: by.collect(),
            directions,
            order: cycle.order(),
            landings: Vec::new(),
            shifts: Vec::new(),
            period: cycle.period,
        };
        reader.landings = reader.landings();
        let landings = reader.landings.iter();
        reader.shifts = landings.flat_map(|own| reader.shifts_of(own)).collect();
        reader
    }

    /// How the state at a stop moves along a direction.
    pub(super) fn moved(&self, stop: usize, direction: usize, moved: &mut [f64]) {
        let along = &self.directions[direction];
        let first = self.places.stops[stop].segment * self.order;
        let begin = &along.states.as_slice()[first..][..self.order];
        let weights = along.weights.iter().copied();
        self.evaluated.stops[stop].moved(begin, weights, moved);
    }

    /// Writes the signals at a stop on the pieces of an arc, and how they move along all directions.
    fn signals(&self, stop: usize, arc: usize, room: &mut Signals) {
        let pieces = &self.places.scan.arcs[arc].pieces;
        let state = &self.evaluated.stops[stop].state;
        let phase = self.places.stops[stop].phase;
        self.slopes.look(phase, state, pieces, &mut room.at);
        self.slopes.write(&room.at, &mut room.values);
        let directions = self.directions.len();
        for direction in 0..directions {
            self.moved(stop, direction, &mut room.state);
            let along = Direction {
                state: &room.state,
                by: Some(&self.by[direction]),
                phase: 0.0,
            };
            let slopes = room.slopes.iter_mut().skip(direction).step_by(directions);
            self.slopes.along(&room.at, along, &mut room.moved, slopes);
        }
    }

    /// What is read off every signal.
    pub(super) fn moments(&self) -> Vec<Moments> {
        let (directions, needs) = (self.directions.len(), &self.places.needs);
        let zero = Slope::zero(directions);
        let empty = |&harmonics: &usize| Moments {
            largest: None,
            smallest: None,
            mean: zero.clone(),
            square: zero.clone(),
            series: vec![[zero.clone(), zero.clone()]; harmonics],
            is_nothing: false,
        };
        let mut moments: Vec<Moments> = needs.harmonics.iter().map(empty).collect();
        let mut room = Signals::new(self.slopes, directions);
        let mut waves = vec![[0.0; 2]; needs.highest()];
        for node in &self.places.nodes {
            self.signals(node.stop, node.arc, &mut room);
            for (index, wave) in waves.iter_mut().enumerate() {
                *wave = ((index + 1) as f64 * node.angle).sin_cos().into();
            }
            let slopes = room.slopes.chunks_exact(directions);
            for ((moments, &value), by) in moments.iter_mut().zip(&room.values).zip(slopes) {
                moments.add(value, by, node.weight, &waves);
            }
        }
        if needs.integrals || needs.highest() > 0 {
            self.add_jumps(&mut moments);
        }
        let whole = std::f64::consts::TAU * self.period as f64;
        for (signal, moments) in moments.iter_mut().enumerate() {
            moments.divide(whole);
            if needs.extremes {
                let [largest, smallest] = [0, 1].map(|which| self.extreme(signal, which));
                (moments.largest, moments.smallest) = (largest, smallest);
            }
            let mut arcs = self.places.scan.arcs.iter();
            moments.is_nothing = arcs.all(|arc| self.slopes.is_nothing(signal, &arc.pieces));
        }
        moments
    }

    /// What is added to a phase in a segment, for that of the orbit: segments are of equal length.
    pub(super) fn passed(&self, segment: usize) -> f64 {
        let arcs = self.places.scan.arcs.iter();
        let mut firsts = arcs.filter(|arc| arc.segment <= segment);
        let (mut passed, mut last) = (0.0, None);
        for arc in &mut firsts {
            if last != Some(arc.segment) && arc.segment == segment {
                return passed - arc.from;
            }
            passed += arc.to - arc.from;
            last = Some(arc.segment);
        }
        0.0
    }

    /// (2) or (3)
    fn extreme(&self, signal: usize, which: usize) -> Option<Slope> {
        let extreme = self.places.scan.extremes[signal][which]?;
        if let Some(stop) = self.places.extremes[signal][which] {
            let directions = self.directions.len();
            let mut room = Signals::new(self.slopes, directions);
            self.signals(stop, extreme.arc, &mut room);
            return Some(Slope {
                value: extreme.value,
                by: room.slopes[signal * directions..][..directions].to_vec(),
            });
        }
        self.limit(signal, &extreme)
    }

    fn limit(&self, signal: usize, extreme: &Extreme) -> Option<Slope> {
        let ends_at = match extreme.end? {
            End::Last => extreme.arc,
            End::First => extreme.arc.checked_sub(1)?,
        };
        let mut landings = self.landings.iter();
        let landing = landings.find(|landing| landing.arc == ends_at)?;
        let shifts = self.shift_of_limit(landing, signal);
        let at = self.beside(landing, extreme.arc);
        let mut slopes = vec![0.0; self.slopes.count()];
        let (mut with, mut moved) = (vec![0.0; self.order], self.slopes.moved());
        let by = shifts.iter().enumerate().map(|(direction, &shift)| {
            // The state moves with the switch alike on both sides of it: that of the arc before is known.
            with.copy_from_slice(&landing.moved[direction]);
            for (s, r) in with.iter_mut().zip(&landing.rate) {
                *s += r * shift;
            }
            let along = self.direction(direction, &with, shift);
            self.slopes.along(&at, along, &mut moved, slopes.iter_mut());
            slopes[signal]
        });
        Some(Slope {
            value: extreme.value,
            by: by.collect(),
        })
    }

    /// Integrals over the period of the orbit, from means: with its length `T = 2 pi n / Omega`, `(T m)' = T (m' - m Omega' / Omega)`.
    pub(super) fn over_period(&self, mean: &Slope) -> Slope {
        let base = self.slopes.base;
        let length = std::f64::consts::TAU * self.period as f64 / base;
        let both = mean.by.iter().zip(&self.by);
        let by = both.map(|(slope, by)| length * (slope - mean.value * by.base / base));
        Slope {
            value: length * mean.value,
            by: by.collect(),
        }
    }

    /// The part of the period that a gap is on each piece of its law.
    pub(super) fn on_pieces(&self, contact: usize, pieces: usize) -> Vec<Slope> {
        let scan = &self.places.scan;
        let mut on = vec![Slope::zero(self.directions.len()); pieces];
        for arc in &scan.arcs {
            on[arc.pieces[contact]].value += arc.to - arc.from;
        }
        for (switch, shifts) in scan.switches.iter().zip(&self.shifts) {
            if switch.contact != contact {
                continue;
            }
            let [ends, begins] = [0, 1].map(|next| scan.arcs[switch.arc + next].pieces[contact]);
            for (direction, shift) in shifts.iter().enumerate() {
                on[ends].by[direction] += shift;
                on[begins].by[direction] -= shift;
            }
        }
        let whole = std::f64::consts::TAU * self.period as f64;
        for part in &mut on {
            part.scale(1.0 / whole);
        }
        on
    }
}

/// Signals at one place, and how they move: each along all directions.
struct Signals {
    values: Vec<f64>,
    slopes: Vec<f64>,
    at: Instant,
    moved: Moved,
    /// How the state moves along one of them.
    state: Vec<f64>,
}

impl Signals {
    fn new(slopes: &Slopes, directions: usize) -> Self {
        Self {
            values: vec![0.0; slopes.count()],
            slopes: vec![0.0; slopes.count() * directions],
            at: slopes.instant(),
            moved: slopes.moved(),
            state: vec![0.0; slopes.order()],
        }
    }
}

fn combined(by: &[By], weights: &[f64]) -> By {
    let count = by.first().map_or(0, |by| by.coefficients.len());
    let mut sum = By {
        coefficients: vec![0.0; count],
        base: 0.0,
    };
    for (by, &weight) in by.iter().zip(weights) {
        if weight != 0.0 {
            let pairs = sum.coefficients.iter_mut().zip(&by.coefficients);
            pairs.for_each(|(sum, x)| *sum += weight * x);
            sum.base += weight * by.base;
        }
    }
    sum
}
