//! What is read off an orbit, with its errors: one step from it to a solution with more nodes tells what the nodes leave out.

use nalgebra::DMatrix;

use super::equations::Equations;
use super::motion::{Motion, Within};
use super::run::{DIFFERENCE, Run};
use crate::branches::moduli::multipliers;
use crate::branches::observed::{Motion as Extent, Observed};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::stability::{Stability, Verdict};
use crate::continuation::follow::CurvePoint;
use crate::numeric::roots::Place;
use crate::numeric::spectrum::distance;
use crate::orbit::observe::Accuracy;
use crate::shooting::reading::Reader;

/// What one step from a finer solution says of the error is multiplied by this.
const SAFETY: f64 = 2.0;
/// As many orbits are compared with one whose errors a finer solution has shown.
const SCREENED: usize = 31;
/// What their forces leave out may be so many times as much.
const MOST: f64 = 30.0;
/// Roundings in the last coefficients of forces.
const ROUNDED: f64 = 16.0;
/// Phases at which two motions are compared.
const COMPARED: usize = 24;
/// Where the branch is steeper than this part, as before a fold, what is varied moves the orbit by more.
const STEEPER: f64 = 0.5;

/// Errors that a finer solution has shown.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Screened {
    /// What the forces of every contact on every interval left out there, and how often gaps crossed levels.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    tails: Vec<f64>,
    switches: usize,
    /// Of the motion across the tangent at any phase, and of what is varied. One number, as peak-to-peak, may be right by chance where
    /// its error changes sign.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    apart: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    shift: f64,
    /// How what is varied changes along the branch.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    slope: f64,
    /// Of peak-to-peak where what is varied has its value, and of the multipliers or the map that has them.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    error: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    spread: f64,
    /// As many orbits may still be compared with it.
    left: usize,
}

impl Screened {
    /// How many times as large errors may be where forces leave so much out: they are products of what the forces and what the rule of
    /// integration leave out. `None` if they leave out so much more that this says nothing.
    fn grown(&self, tails: &[f64]) -> Option<f64> {
        let pairs = tails.iter().zip(&self.tails);
        let ratio = pairs.fold(1.0, |most: f64, (now, then)| most.max(now / then));
        (ratio <= MOST && tails.len() == self.tails.len()).then_some(SAFETY * ratio * ratio)
    }
}

/// An orbit that was read.
pub(super) struct ReadOrbit {
    pub(super) point: Point,
    pub(super) map: Option<DMatrix<f64>>,
    /// What one step to a finer solution changes in what is varied.
    pub(super) shift: f64,
    /// The map of that finer solution.
    pub(super) finer: Option<DMatrix<f64>>,
}

impl Run<'_> {
    /// The orbit at unknowns of the last pass, without its stability and error.
    pub(super) fn observed(&self, equations: &Equations, value: f64) -> Point {
        let problem = &self.problem.asked;
        let motion = Motion::of(equations);
        let coordinates = equations.values.linear.positions.nrows();
        let rate = equations.values.base;
        let found = motion.extremes().coordinates.iter();
        let motions = found.map(|[minimum, maximum]| Extent {
            minimum: minimum.value,
            maximum: maximum.value,
            ..Extent::NONE
        });
        let skeleton = &equations.skeleton;
        let recurrence = skeleton.recurrence();
        let mut outputs = problem.output_reader(value, recurrence);
        if let Some(outputs) = &mut outputs {
            for interval in 0..motion.intervals() {
                let [from, to] = motion.phases(interval);
                if to > from {
                    outputs.include(&Within {
                        motion: &motion,
                        interval,
                    });
                }
            }
        }
        let mut states = vec![0.0; 2 * coordinates * problem.period];
        let segment = skeleton.length / problem.period as f64;
        for (index, state) in states.chunks_exact_mut(2 * coordinates).enumerate() {
            motion.at(segment * index as f64, state);
        }
        let switches = switches(equations);
        Point {
            value,
            parameters: problem.parameters_at(value),
            orbit: Orbit {
                series: Vec::new(),
                states,
                coordinates,
                omega: problem.omega_at(value),
                base: rate / recurrence.period as f64,
                period: recurrence.period,
                parts: recurrence.parts,
                symmetric: recurrence.image.is_minus(),
                image: recurrence.image.clone(),
            },
            stability: Stability::unknown(),
            observed: Observed {
                outputs: outputs.map_or_else(Vec::new, Reader::motions),
                ..Observed::extremes(motions.collect(), switches * recurrence.parts)
            },
            error: None,
        }
    }

    /// Reads an orbit with everything that is asked for, its errors as a finer solution shows them.
    pub(super) fn read(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        let (mut point, map) = self.read_plainly(at)?;
        let Some(Finer { u: other, shift }) = self.corrected(at) else {
            point.error = Some(f64::INFINITY);
            return Some(unknown(point, map));
        };
        let mut finer = self.finer.take()?;
        let finer_map = if map.is_some() {
            finer.map(&other)
        } else {
            finer.compute(&other, false);
            None
        };
        if finer.failed {
            point.error = Some(f64::INFINITY);
            return Some(unknown(point, map));
        }
        let apart = self.apart(&finer, &point, other[other.len() - 1]);
        let everywhere = everywhere([&self.equations, &finer]);
        self.finer = Some(finer);
        let size = self.accuracy().peak_to_peak(&point.observed);
        let steepness = self.steepness(at).unwrap_or_else(|| self.rise(&point));
        let error = SAFETY * (apart + steepness * shift.abs()) / size;
        point.error = Some(stated(error));
        let mut spread = 0.0;
        if let Some(map) = &map {
            let parts = self.equations.skeleton.recurrence().parts;
            let found = multipliers(map, parts);
            let known = finer_map.as_ref();
            let apart = |finer| distance(&found, &multipliers(finer, parts));
            let moved = known.map_or(f64::INFINITY, apart);
            point.stability = Stability::of(found, SAFETY * moved);
            let of_map = |finer: &DMatrix<f64>| parts as f64 * (map - finer).norm();
            spread = known.map_or(f64::INFINITY, |finer| moved.max(of_map(finer)));
        }
        self.screened = Some(Screened {
            tails: self.tails(&at.u),
            switches: switches(&self.equations),
            apart: everywhere.max(apart),
            shift: shift.abs(),
            slope: at.parameter_slope().abs(),
            error: error.max(SAFETY * everywhere / size),
            spread: SAFETY * spread,
            left: SCREENED,
        });
        Some(ReadOrbit {
            point,
            map,
            shift,
            finer: finer_map,
        })
    }

    /// Reads an orbit of the walk. Near one whose errors a finer solution has shown it has those, as many times as large as what its forces
    /// leave out tells. Where that is more than is asked for, and every so often, a finer solution is asked again.
    pub(super) fn read_on(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        if matches!(self.accuracy(), Accuracy::Output(_)) {
            return self.read(at);
        }
        let slope = at.parameter_slope().abs();
        let alike = |known: &Screened| known.left > 0 && slope >= STEEPER * known.slope;
        if !self.screened.as_ref().is_some_and(alike) {
            return self.read(at);
        }
        let (mut point, map) = self.read_plainly(at)?;
        let tails = self.tails(&at.u);
        let rise = self.rise(&point);
        let size = self.accuracy().peak_to_peak(&point.observed);
        let same = |known: &&mut Screened| known.switches == switches(&self.equations);
        let known = self.screened.as_mut().filter(same);
        let grown = known.and_then(|known| known.grown(&tails).map(|grown| (known, grown)));
        let Some((known, grown)) = grown else {
            return self.read(at);
        };
        known.left -= 1;
        let error = SAFETY * (known.apart + rise * known.shift) / size;
        let error = grown * error.max(known.error);
        let spread = grown * known.spread;
        if error.is_nan() || error > self.problem.tolerance {
            return self.read(at);
        }
        point.error = Some(stated(error));
        if let Some(map) = &map {
            let parts = self.equations.skeleton.recurrence().parts;
            point.stability = Stability::of(multipliers(map, parts), spread);
            if point.stability.verdict == Verdict::Undecided {
                return self.read(at);
            }
        }
        Some(ReadOrbit {
            point,
            map,
            shift: f64::NAN,
            finer: None,
        })
    }

    /// An orbit without its errors, and the map of its states if stability is asked for.
    fn read_plainly(&mut self, at: &CurvePoint) -> Option<(Point, Option<DMatrix<f64>>)> {
        let map = if self.problem.asked.stability {
            self.statistics.monodromies += 1;
            Some(self.equations.map(&at.u)?)
        } else {
            self.equations.compute(&at.u, false);
            None
        };
        Some((self.observed(&self.equations, at.parameter()), map))
    }

    /// How peak-to-peak changes with what is varied, along the tangent.
    fn steepness(&mut self, at: &CurvePoint) -> Option<f64> {
        if matches!(self.accuracy(), Accuracy::Output(_)) {
            return None;
        }
        let extremes = self.equations.extremes.get()?.coordinates.clone();
        let slope = at.parameter_slope();
        let step = DIFFERENCE / at.tangent.iter().fold(1e-3, |m: f64, t| m.max(t.abs()));
        let moved = at.u.iter().zip(&at.tangent);
        let moved: Vec<f64> = moved.map(|(x, t)| x + step * t).collect();
        self.equations.compute(&moved, false);
        let known = !self.equations.failed && slope != 0.0;
        let steepness = known
            .then(|| apart(&self.equations, &extremes, self.accuracy()) / (step * slope).abs());
        self.equations.compute(&at.u, false);
        steepness
    }

    /// What the error is of.
    fn accuracy(&self) -> Accuracy {
        self.problem.asked.accuracy
    }

    /// How far a finer orbit at a value is from this one in what the error is of.
    fn apart(&self, finer: &Equations, point: &Point, value: f64) -> f64 {
        let accuracy = self.accuracy();
        if let Accuracy::Output(_) = accuracy {
            let [own, other] = [point, &self.observed(finer, value)]
                .map(|point| accuracy.peak_to_peak(&point.observed));
            return (other - own).abs();
        }
        let motions = self.equations.extremes.get();
        apart(
            finer,
            motions.map_or(&[][..], |found| &found.coordinates),
            accuracy,
        )
    }

    /// The same, since the last point.
    fn rise(&self, point: &Point) -> f64 {
        self.record.points.last().map_or(0.0, |last| {
            let by = (point.value - last.value).abs();
            if by > 0.0 {
                let of = |point: &Point| match self.accuracy() {
                    Accuracy::Coordinates => point.peak_to_peak(),
                    one => one.peak_to_peak(&point.observed),
                };
                (of(point) - of(last)).abs() / by
            } else {
                0.0
            }
        })
    }

    /// What the forces at the nodes leave out on every interval, by the size of their last coefficients. What is less than their rounding is
    /// as large as that.
    fn tails(&self, u: &[f64]) -> Vec<f64> {
        let forces = &u[..u.len() - 1];
        let first = forces.len() - self.equations.skeleton.forces;
        let largest = forces[first..].iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        let least = (ROUNDED * f64::EPSILON * largest).max(f64::MIN_POSITIVE);
        let mut tails = Vec::new();
        for interval in &self.equations.skeleton.intervals {
            for active in &interval.active {
                let forces = &u[active.first..][..interval.nodes.count()];
                tails.push(interval.nodes.tail(forces).max(least));
            }
        }
        tails
    }

    /// The orbit with more nodes, by one step of Newton's method in the plane across the tangent.
    fn corrected(&mut self, at: &CurvePoint) -> Option<Finer> {
        if self.finer.is_none() {
            self.finer = self.equations.finer_equations(at.parameter());
        }
        let finer = self.finer.as_mut()?;
        let mut u = self.equations.skeleton.interpolated(&finer.skeleton, &at.u);
        let tangent = self
            .equations
            .skeleton
            .interpolated(&finer.skeleton, &at.tangent);
        let step = finer.across(&u, &tangent)?;
        for (x, by) in u.iter_mut().zip(&step) {
            *x -= by;
        }
        let shift = step[step.len() - 1];
        Some(Finer { u, shift })
    }
}

/// With what rounding adds; of what does not move, which has no part of itself, nothing is known.
fn stated(error: f64) -> f64 {
    if error.is_nan() {
        f64::INFINITY
    } else {
        error + 100.0 * f64::EPSILON
    }
}

/// An orbit that no finer solution was found for.
fn unknown(point: Point, map: Option<DMatrix<f64>>) -> ReadOrbit {
    ReadOrbit {
        point,
        map,
        shift: f64::INFINITY,
        finer: None,
    }
}

/// An orbit with more nodes.
struct Finer {
    u: Vec<f64>,
    /// What it changes in what is varied.
    shift: f64,
}

/// How far a finer orbit is from where the coordinates of another one, or the one that the error is of, are smallest and largest: the error
/// of these values, to first order.
fn apart(finer: &Equations, extremes: &[[Place; 2]], accuracy: Accuracy) -> f64 {
    let motion = Motion::of(finer);
    let mut state = vec![0.0; finer.skeleton.order];
    let mut off = |coordinate: usize, place: &Place| {
        motion.at(place.x, &mut state);
        state[coordinate] - place.value
    };
    let counts = |index: usize| match accuracy {
        Accuracy::Coordinate(one) => index == one,
        Accuracy::Coordinates | Accuracy::Output(_) => true,
    };
    let pairs = extremes.iter().enumerate();
    let pairs = pairs.filter(|(index, _)| counts(*index));
    let apart = pairs.map(|(coordinate, [low, high])| off(coordinate, high) - off(coordinate, low));
    apart.fold(0.0, |most: f64, apart| most.max(apart.abs()))
}

/// The largest difference of a coordinate between two motions.
fn everywhere(equations: [&Equations; 2]) -> f64 {
    let motions = equations.map(Motion::of);
    let skeleton = &equations[0].skeleton;
    let coordinates = equations[0].values.linear.positions.nrows();
    let mut states = [vec![0.0; 2 * coordinates], vec![0.0; 2 * coordinates]];
    let mut most = 0.0_f64;
    for sample in 0..COMPARED {
        let phase = skeleton.begin + skeleton.length * (sample as f64 / COMPARED as f64);
        for (motion, state) in motions.iter().zip(&mut states) {
            let (interval, phase) = motion.interval(phase);
            motion.state(interval, phase, state);
        }
        let pairs = states[0].iter().zip(&states[1]).take(coordinates);
        most = pairs.fold(most, |most, (a, b)| most.max((a - b).abs()));
    }
    most
}

/// How often gaps cross levels.
fn switches(equations: &Equations) -> usize {
    let passed = equations.skeleton.intervals.iter().zip(&equations.passed);
    let ghosts = passed.filter(|(interval, passed)| {
        interval.ends.is_some() && passed.phases[1] <= passed.phases[0]
    });
    equations.skeleton.switches.len() - 2 * ghosts.count()
}
