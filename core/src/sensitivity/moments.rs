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
//!
//! Integrals are Gauss rules between switches, on a variable that is graded at both ends of an arc, where derivatives of forces go as powers of the
//! distance from the level.

use nalgebra::DVector;

use super::cycle::{Cycle, Evaluated, Stop};
use super::scan::{End, Extreme, Scan};
use super::slopes::{By, Direction, Slopes};
use crate::numeric::fourier::gauss;
use crate::orbit::observe::Measure;
use crate::system::Variable;
use crate::time::FlowError;

/// Angle of the highest harmonic over a part of an arc that one rule is for.
const ANGLE: f64 = 4.0;

/// How states and variables move together.
#[derive(Debug, Clone)]
pub(super) struct Along {
    /// Of the states at the beginnings of all segments.
    pub(super) states: DVector<f64>,
    /// Of each variable that the equations were evaluated with.
    pub(super) weights: Vec<f64>,
}

/// A number, and its derivatives along all directions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slope {
    pub(super) value: f64,
    pub(super) by: Vec<f64>,
}

impl Slope {
    fn zero(directions: usize) -> Self {
        Self {
            value: 0.0,
            by: vec![0.0; directions],
        }
    }

    /// A function of several numbers, with its derivatives by them.
    fn of<const N: usize>(parts: [&Self; N], value: f64, slopes: [f64; N]) -> Self {
        let sum = |index: usize| {
            parts
                .iter()
                .zip(slopes)
                .map(|(part, s)| s * part.by[index])
                .sum()
        };
        Self {
            value,
            by: (0..parts[0].by.len()).map(sum).collect(),
        }
    }

    fn scaled(mut self, factor: f64) -> Self {
        self.value *= factor;
        self.by.iter_mut().for_each(|x| *x *= factor);
        self
    }
}

/// What is to be read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Needs {
    pub(super) extremes: bool,
    /// Means and squares.
    pub(super) integrals: bool,
    pub(super) harmonics: usize,
    /// Nodes of a rule.
    pub(super) nodes: usize,
}

/// What is read off one signal.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    pub(super) largest: Option<Slope>,
    pub(super) smallest: Option<Slope>,
    /// Mean, mean of the square, and the series.
    pub(super) mean: Slope,
    pub(super) square: Slope,
    pub(super) series: Vec<[Slope; 2]>,
}

/// A node of a rule.
struct Node {
    stop: usize,
    arc: usize,
    weight: f64,
    /// In radians of the orbit's own first harmonic.
    angle: f64,
}

/// Where an orbit is looked at.
pub(super) struct Places {
    scan: Scan,
    pub(super) stops: Vec<Stop>,
    /// By position among the stops.
    switches: Vec<usize>,
    extremes: Vec<[Option<usize>; 2]>,
    nodes: Vec<Node>,
    needs: Needs,
}

impl Places {
    /// Of the orbit from these states.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn of(
        cycle: &mut Cycle,
        slopes: &Slopes,
        states: &[f64],
        needs: Needs,
    ) -> Result<Self, FlowError> {
        let scan = Scan::of(cycle, slopes, states, false)?;
        let mut stops: Vec<Stop> = scan.switches.iter().map(|s| scan.stop_of(s)).collect();
        let switches = (0..stops.len()).collect();
        let mut place = |stop: Stop| {
            stops.push(stop);
            stops.len() - 1
        };
        let extremes = scan.extremes.iter().map(|pair| {
            pair.map(|extreme| {
                let extreme = extreme.filter(|e| needs.extremes && e.end.is_none())?;
                let segment = scan.arcs[extreme.arc].segment;
                let phase = extreme.phase;
                Some(place(Stop { segment, phase }))
            })
        });
        let extremes = extremes.collect();
        let mut nodes = Vec::new();
        if needs.integrals || needs.harmonics > 0 {
            let rule = gauss::rule(needs.nodes);
            for (index, arc) in scan.arcs.iter().enumerate() {
                let passed = cycle.passed(arc.segment);
                let length = arc.to - arc.from;
                let waves = needs.harmonics.max(4 * cycle.period) as f64;
                let angle = waves * length / cycle.period as f64;
                let parts = (angle / ANGLE / needs.nodes as f64 * 8.0).ceil().max(1.0);
                for part in 0..parts as usize {
                    for (x, weight) in rule.nodes.iter().zip(&rule.weights) {
                        let s = (part as f64 + x) / parts;
                        let phase = arc.from + length * s * s * (3.0 - 2.0 * s);
                        let segment = arc.segment;
                        nodes.push(Node {
                            stop: place(Stop { segment, phase }),
                            arc: index,
                            weight: weight / parts * length * 6.0 * s * (1.0 - s),
                            angle: (passed + phase) / cycle.period as f64,
                        });
                    }
                }
            }
        }
        let mut places = Self {
            scan,
            stops,
            switches,
            extremes,
            nodes,
            needs,
        };
        places.sort();
        Ok(places)
    }

    /// Puts the stops into the order of the motion.
    fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.stops.len()).collect();
        let stops = &self.stops;
        order.sort_by(|&a, &b| {
            let (a, b) = (stops[a], stops[b]);
            a.segment.cmp(&b.segment).then(a.phase.total_cmp(&b.phase))
        });
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        self.stops = order.iter().map(|&old| stops[old]).collect();
        self.switches
            .iter_mut()
            .for_each(|stop| *stop = place[*stop]);
        let extremes = self.extremes.iter_mut().flatten().flatten();
        extremes.for_each(|stop| *stop = place[*stop]);
        self.nodes
            .iter_mut()
            .for_each(|node| node.stop = place[node.stop]);
    }
}

/// An orbit at the places where it is looked at.
pub(super) struct Reader<'r> {
    pub(super) places: &'r Places,
    pub(super) slopes: &'r Slopes,
    pub(super) evaluated: &'r Evaluated,
    /// How the coefficients move along each direction.
    by: Vec<By>,
    directions: &'r [Along],
    order: usize,
    /// How each switch moves along each direction.
    shifts: Vec<Vec<f64>>,
    period: usize,
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
            shifts: Vec::new(),
            period: cycle.period,
        };
        let switches = 0..places.switches.len();
        reader.shifts = switches.map(|index| reader.shift(index)).collect();
        reader
    }

    /// How the state at a stop moves along a direction.
    fn moved(&self, stop: usize, direction: usize) -> Vec<f64> {
        let along = &self.directions[direction];
        let first = self.places.stops[stop].segment * self.order;
        let begin = &along.states.as_slice()[first..][..self.order];
        self.evaluated.stops[stop].moved(begin, along.weights.iter().copied())
    }

    /// (1)
    fn shift(&self, index: usize) -> Vec<f64> {
        let switch = &self.places.scan.switches[index];
        let stop = self.places.switches[index];
        let pieces = &self.places.scan.arcs[switch.arc].pieces;
        let state = &self.evaluated.stops[stop].state;
        let at = self.slopes.at(self.places.stops[stop].phase, state, pieces);
        let of = |direction: usize| {
            let moved = self.moved(stop, direction);
            let along = Direction {
                state: &moved,
                by: Some(&self.by[direction]),
                phase: 0.0,
            };
            let (contact, level) = (switch.contact, switch.level);
            let [grows, rate] = self.slopes.distance_along(&at, contact, level, along);
            -grows / rate
        };
        (0..self.directions.len()).map(of).collect()
    }

    /// Signals at a stop on the pieces of an arc, and how they move along all directions.
    fn signals(&self, stop: usize, arc: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
        let pieces = &self.places.scan.arcs[arc].pieces;
        let state = &self.evaluated.stops[stop].state;
        let at = self.slopes.at(self.places.stops[stop].phase, state, pieces);
        let count = self.slopes.count();
        let mut values = vec![0.0; count];
        self.slopes.write(&at, &mut values);
        let of = |direction: usize| {
            let moved = self.moved(stop, direction);
            let along = Direction {
                state: &moved,
                by: Some(&self.by[direction]),
                phase: 0.0,
            };
            let mut slopes = vec![0.0; count];
            self.slopes.along(&at, along, &mut slopes);
            slopes
        };
        (values, (0..self.directions.len()).map(of).collect())
    }

    /// What is read off every signal.
    pub(super) fn moments(&self) -> Vec<Moments> {
        let (directions, needs) = (self.directions.len(), self.places.needs);
        let zero = Slope::zero(directions);
        let empty = Moments {
            largest: None,
            smallest: None,
            mean: zero.clone(),
            square: zero.clone(),
            series: vec![[zero.clone(), zero]; needs.harmonics],
        };
        let mut moments = vec![empty; self.slopes.count()];
        for node in &self.places.nodes {
            let (values, slopes) = self.signals(node.stop, node.arc);
            for (signal, moments) in moments.iter_mut().enumerate() {
                let by = slopes.iter().map(|slopes| slopes[signal]).collect();
                let value = values[signal];
                moments.add(&Slope { value, by }, node.weight, node.angle);
            }
        }
        if needs.integrals || needs.harmonics > 0 {
            self.add_jumps(&mut moments);
        }
        let whole = std::f64::consts::TAU * self.period as f64;
        for (signal, moments) in moments.iter_mut().enumerate() {
            moments.divide(whole);
            if needs.extremes {
                let [largest, smallest] = [0, 1].map(|which| self.extreme(signal, which));
                (moments.largest, moments.smallest) = (largest, smallest);
            }
        }
        moments
    }

    /// The sum of (4).
    fn add_jumps(&self, moments: &mut [Moments]) {
        for (index, switch) in self.places.scan.switches.iter().enumerate() {
            let stop = self.places.switches[index];
            let (before, _) = self.signals(stop, switch.arc);
            let (after, _) = self.signals(stop, switch.arc + 1);
            let segment = self.places.stops[stop].segment;
            let passed = self.passed(segment);
            let angle = (passed + self.places.stops[stop].phase) / self.period as f64;
            for (signal, moments) in moments.iter_mut().enumerate() {
                moments.jump([before[signal], after[signal]], &self.shifts[index], angle);
            }
        }
    }

    /// What is added to a phase in a segment, for that of the orbit: segments are of equal length.
    fn passed(&self, segment: usize) -> f64 {
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
            let (_, slopes) = self.signals(stop, extreme.arc);
            return Some(Slope {
                value: extreme.value,
                by: slopes.iter().map(|slopes| slopes[signal]).collect(),
            });
        }
        self.limit(signal, &extreme)
    }

    fn limit(&self, signal: usize, extreme: &Extreme) -> Option<Slope> {
        let ends_at = match extreme.end? {
            End::Last => extreme.arc,
            End::First => extreme.arc.checked_sub(1)?,
        };
        let scan = &self.places.scan;
        let index = scan
            .switches
            .iter()
            .position(|switch| switch.arc == ends_at)?;
        let stop = self.places.switches[index];
        let (state, phase) = (
            &self.evaluated.stops[stop].state,
            self.places.stops[stop].phase,
        );
        // The state moves with the switch alike on both sides of it: that of the arc before is known.
        let before = self.slopes.at(phase, state, &scan.arcs[ends_at].pieces);
        let rate = self.slopes.state_rate(&before);
        let at = self.slopes.at(phase, state, &scan.arcs[extreme.arc].pieces);
        let mut slopes = vec![0.0; self.slopes.count()];
        let by = (0..self.directions.len()).map(|direction| {
            let shift = self.shifts[index][direction];
            let moved = self.moved(stop, direction);
            let with: Vec<f64> = moved
                .iter()
                .zip(&rate)
                .map(|(s, r)| s + r * shift)
                .collect();
            let along = Direction {
                state: &with,
                by: Some(&self.by[direction]),
                phase: shift,
            };
            self.slopes.along(&at, along, &mut slopes);
            slopes[signal]
        });
        Some(Slope {
            value: extreme.value,
            by: by.collect(),
        })
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
        on.into_iter().map(|on| on.scaled(1.0 / whole)).collect()
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

impl Moments {
    fn add(&mut self, signal: &Slope, weight: f64, angle: f64) {
        let value = signal.value;
        self.mean.add(value, weight, &signal.by, weight);
        self.square
            .add(value * value, weight, &signal.by, 2.0 * weight * value);
        for (index, [cosine, sine]) in self.series.iter_mut().enumerate() {
            let (s, c) = ((index + 1) as f64 * angle).sin_cos();
            cosine.add(value, weight * c, &signal.by, weight * c);
            sine.add(value, weight * s, &signal.by, weight * s);
        }
    }

    fn jump(&mut self, [before, after]: [f64; 2], shifts: &[f64], angle: f64) {
        let jump = before - after;
        self.mean.add(0.0, 0.0, shifts, jump);
        self.square
            .add(0.0, 0.0, shifts, before * before - after * after);
        for (index, [cosine, sine]) in self.series.iter_mut().enumerate() {
            let (s, c) = ((index + 1) as f64 * angle).sin_cos();
            cosine.add(0.0, 0.0, shifts, jump * c);
            sine.add(0.0, 0.0, shifts, jump * s);
        }
    }

    fn divide(&mut self, whole: f64) {
        for sum in [&mut self.mean, &mut self.square] {
            *sum = sum.clone().scaled(1.0 / whole);
        }
        for part in self.series.iter_mut().flatten() {
            *part = part.clone().scaled(2.0 / whole);
        }
    }

    /// What is asked of the signal; `None` where it has no derivative, or is one of contacts.
    pub(super) fn measure(&self, measure: Measure) -> Option<Slope> {
        let (largest, smallest) = (self.largest.as_ref(), self.smallest.as_ref());
        let rms = || {
            let rms = self.square.value.max(0.0).sqrt();
            (rms > 0.0).then(|| Slope::of([&self.square], rms, [0.5 / rms]))
        };
        Some(match measure {
            Measure::PeakToPeak => {
                let (a, b) = (largest?, smallest?);
                Slope::of([a, b], a.value - b.value, [1.0, -1.0])
            }
            Measure::Maximum => largest?.clone(),
            Measure::Minimum => smallest?.clone(),
            Measure::Mean => self.mean.clone(),
            Measure::Rms => rms()?,
            Measure::CrestFactor => {
                let (a, b, rms) = (largest?, smallest?, rms()?);
                let far = if a.value >= -b.value {
                    (a, 1.0)
                } else {
                    (b, -1.0)
                };
                let (value, sign) = (far.0.value * far.1, far.1);
                let crest = value / rms.value;
                Slope::of([far.0, &rms], crest, [sign / rms.value, -crest / rms.value])
            }
            Measure::Amplitude(harmonic) => {
                let [c, s] = self.series.get(harmonic.checked_sub(1)?)?;
                let amplitude = c.value.hypot(s.value);
                let parts = [c.value / amplitude, s.value / amplitude];
                (amplitude > 0.0).then(|| Slope::of([c, s], amplitude, parts))?
            }
            Measure::Phase(harmonic) => {
                let [c, s] = self.series.get(harmonic.checked_sub(1)?)?;
                let square = c.value.powi(2) + s.value.powi(2);
                let parts = [-s.value / square, c.value / square];
                (square > 0.0).then(|| Slope::of([c, s], s.value.atan2(c.value), parts))?
            }
            _ => return None,
        })
    }
}

impl Slope {
    /// Adds a value times a weight, and derivatives times another one.
    fn add(&mut self, value: f64, weight: f64, by: &[f64], times: f64) {
        self.value += weight * value;
        self.by
            .iter_mut()
            .zip(by)
            .for_each(|(sum, x)| *sum += times * x);
    }
}
