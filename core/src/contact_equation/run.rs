//! What is done with the curve of orbits: what is read off every orbit, and which equations the next ones have.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};

use super::equations::Equations;
use super::motion::{GapExtreme, Motion, Within};
use super::plan::{self, Frame, Gaps, Plan};
use super::problem::{ContactProblem, RESOLUTIONS};
use super::skeleton::Told;
use crate::branches::extreme::Extreme;
use crate::branches::observed::{Motion as Extent, Observed};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::record::Record;
use crate::branches::recurrence::Recurrence;
use crate::branches::stability::{Stability, Verdict};
use crate::continuation::follow::CurvePoint;
use crate::continuation::statistics::Statistics;
use crate::numeric::roots::Place;
use crate::numeric::spectrum::{distance, eigenvalues};
use crate::shooting::reading::Reader;

/// What one step from a finer solution says of the error is multiplied by this.
const SAFETY: f64 = 2.0;
/// As many orbits are compared with one whose errors a finer solution has shown.
const SCREENED: usize = 7;
/// What their forces leave out may be so many times as much.
const ALIKE: f64 = 4.0;
/// Phases at which two motions are compared.
const COMPARED: usize = 24;
/// Where the branch is steeper than this part, as before a fold, what is varied moves the orbit by more.
const STEEPER: f64 = 0.5;
/// They must be known to this part of the tolerance.
const LITTLE: f64 = 0.1;
/// Tangents in other unknowns are differences over so much of the largest entry.
const DIFFERENCE: f64 = 1e-5;
/// A gap that is beyond its level by this part of its size is elsewhere.
const BEYOND: f64 = 1e-9;
/// What `H` of a pair may be where its gap touches the level.
const TOUCHES: f64 = 1e-9;
/// An extreme belongs to a pair of switches whose middle is as near.
const SAME: f64 = 0.3;

/// What a branch has gathered, and the equations that it is followed by.
pub(super) struct Run<'r> {
    pub(super) problem: &'r ContactProblem,
    pub(super) frame: Frame,
    /// Place among the resolutions.
    pub(super) resolution: usize,
    pub(super) equations: Equations,
    /// The same orbits with more nodes, made when they are asked for.
    finer: Option<Equations>,
    /// What the last of them has said.
    screened: Option<Screened>,
    pub(super) record: Record,
    pub(super) statistics: Statistics,
}

/// Errors that a finer solution has shown.
struct Screened {
    /// What forces left out there.
    tail: f64,
    /// Of the motion across the tangent at any phase, and of what is varied. One number, as peak-to-peak, may be right by chance where
    /// its error changes sign.
    apart: f64,
    shift: f64,
    /// How what is varied changes along the branch.
    slope: f64,
    /// Of peak-to-peak where what is varied has its value, and of the multipliers or the map that has them.
    error: f64,
    spread: f64,
    /// As many orbits may still be compared with it.
    left: usize,
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

/// What the gaps of an orbit say of its equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fits {
    /// They are right.
    Yes,
    /// They are right, and others are better from here on.
    Soon,
    /// The orbit is none: a gap is on another piece.
    No,
}

impl<'r> Run<'r> {
    pub(super) fn new(
        problem: &'r ContactProblem,
        frame: Frame,
        resolution: usize,
        equations: Equations,
    ) -> Self {
        Self {
            problem,
            frame,
            resolution,
            equations,
            finer: None,
            screened: None,
            record: Record::default(),
            statistics: Statistics::default(),
        }
    }

    /// Forgets the finer equations, since there are others.
    pub(super) fn clear_finer(&mut self) {
        self.finer = None;
        self.screened = None;
    }

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
        let recurrence = Recurrence::whole(problem.period);
        let mut outputs = problem.output_reader(value, &recurrence);
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
        for (period, state) in states.chunks_exact_mut(2 * coordinates).enumerate() {
            let (interval, phase) = motion.interval(TAU * period as f64);
            motion.state(interval, phase, state);
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
                base: rate / problem.period as f64,
                period: problem.period,
                parts: recurrence.parts,
                symmetric: false,
                image: recurrence.image,
            },
            stability: Stability::unknown(),
            observed: Observed {
                outputs: outputs.map_or_else(Vec::new, Reader::motions),
                ..Observed::extremes(motions.collect(), switches)
            },
            error: None,
        }
    }

    /// Reads an orbit with everything that is asked for, its errors as a finer solution shows them.
    pub(super) fn read(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        let (mut point, map) = self.read_plainly(at)?;
        let Some(Finer { u: other, shift }) = self.corrected(at) else {
            point.error = Some(f64::INFINITY);
            return Some(ReadOrbit {
                point,
                map,
                shift: f64::INFINITY,
                finer: None,
            });
        };
        let mut finer = self.finer.take()?;
        let finer_map = if map.is_some() {
            finer.map(&other)
        } else {
            finer.compute(&other, false);
            None
        };
        let motions = self.equations.extremes.get();
        let extremes = motions.map_or(&[][..], |found| &found.coordinates);
        let apart = apart(&finer, extremes);
        let everywhere = everywhere([&self.equations, &finer]);
        self.finer = Some(finer);
        let size = point.observed.motions.iter().map(Extent::peak_to_peak);
        let size = size.fold(0.0, f64::max);
        let steepness = self.steepness(at).unwrap_or_else(|| self.rise(&point));
        let error = SAFETY * (apart + steepness * shift.abs()) / size;
        point.error = Some(error + 100.0 * f64::EPSILON);
        let mut spread = 0.0;
        if let Some(map) = &map {
            let found = eigenvalues(map);
            let known = finer_map.as_ref();
            let moved = known.map_or(f64::INFINITY, |finer| distance(&found, &eigenvalues(finer)));
            point.stability = Stability::of(found, SAFETY * moved);
            spread = known.map_or(f64::INFINITY, |finer| moved.max((map - finer).norm()));
        }
        self.screened = Some(Screened {
            tail: self.tail(&at.u),
            apart: everywhere,
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

    /// Reads an orbit of the walk. Where forces are resolved as well as at the last orbit whose errors a finer solution has shown, it has
    /// those, and a safety.
    pub(super) fn read_on(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        let tail = self.tail(&at.u);
        let enough = LITTLE * self.problem.tolerance;
        let slope = at.parameter_slope().abs();
        let known = self.screened.as_mut().filter(|known| {
            let alike = tail <= ALIKE * known.tail && slope >= STEEPER * known.slope;
            known.left > 0 && alike && known.error <= enough
        });
        let Some(known) = known else {
            return self.read(at);
        };
        known.left -= 1;
        let ratio = SAFETY * (tail / known.tail).max(1.0);
        let (apart, shift) = (ratio * known.apart, ratio * known.shift);
        let spread = ratio * known.spread;
        let (mut point, map) = self.read_plainly(at)?;
        let size = point.observed.motions.iter().map(Extent::peak_to_peak);
        let size = size.fold(0.0, f64::max);
        let error = SAFETY * (apart + self.rise(&point) * shift) / size;
        point.error = Some(error + 100.0 * f64::EPSILON);
        if let Some(map) = &map {
            point.stability = Stability::of(eigenvalues(map), spread);
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
        let extremes = self.equations.extremes.get()?.coordinates.clone();
        let slope = at.parameter_slope();
        let step = DIFFERENCE / at.tangent.iter().fold(1e-3, |m: f64, t| m.max(t.abs()));
        let moved = at.u.iter().zip(&at.tangent);
        let moved: Vec<f64> = moved.map(|(x, t)| x + step * t).collect();
        self.equations.compute(&moved, false);
        let known = !self.equations.failed && slope != 0.0;
        let steepness = known.then(|| apart(&self.equations, &extremes) / (step * slope).abs());
        self.equations.compute(&at.u, false);
        steepness
    }

    /// The same, since the last point.
    fn rise(&self, point: &Point) -> f64 {
        self.record.points.last().map_or(0.0, |last| {
            let by = (point.value - last.value).abs();
            if by > 0.0 {
                (point.peak_to_peak() - last.peak_to_peak()).abs() / by
            } else {
                0.0
            }
        })
    }

    /// What the forces at the nodes leave out, by the size of their last coefficients.
    fn tail(&self, u: &[f64]) -> f64 {
        let mut sum = f64::MIN_POSITIVE;
        for interval in &self.equations.skeleton.intervals {
            for active in &interval.active {
                let forces = &u[active.first..][..interval.nodes.count()];
                sum += interval.nodes.tail(forces);
            }
        }
        sum
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
        finer.compute(&u, true);
        if finer.failed {
            return None;
        }
        let n = finer.skeleton.unknowns();
        let told = finer.skeleton.order + finer.skeleton.switches.len();
        let mut matrix = DMatrix::from_row_iterator(
            n + 1,
            n + 1,
            finer
                .matrix()
                .iter()
                .copied()
                .chain(std::iter::repeat_n(0.0, n + 1)),
        );
        for column in (0..told).chain([n]) {
            matrix[(n, column)] = tangent[column];
        }
        let mut residual = DVector::zeros(n + 1);
        residual.rows_mut(0, n).copy_from_slice(finer.residual());
        let update = matrix.lu().solve(&residual)?;
        for (x, by) in u.iter_mut().zip(update.iter()) {
            *x -= by;
        }
        let shift = update[n];
        u.iter()
            .all(|x| x.is_finite())
            .then_some(Finer { u, shift })
    }

    /// Whether the equations still fit the orbit of their last pass.
    pub(super) fn fits(&self, u: &[f64]) -> Fits {
        let motion = Motion::of(&self.equations);
        let skeleton = &self.equations.skeleton;
        let mut last = skeleton.begin;
        for passed in &self.equations.passed {
            if passed.phases[1] < passed.phases[0] - BEYOND || passed.phases[1] < last - BEYOND {
                return Fits::No;
            }
            last = passed.phases[1];
        }
        let found = motion.extremes().gaps.concat();
        let mut fits = self.pairs_fit(u);
        if self.meets_another(u, &found) {
            fits = Fits::Soon;
        }
        for extreme in &found {
            match self.extreme_fits(u, extreme, &found) {
                Fits::No => return Fits::No,
                Fits::Soon => fits = Fits::Soon,
                Fits::Yes => {}
            }
        }
        fits
    }

    /// Whether switches are told as they should be, and the beginning is away from them.
    fn pairs_fit(&self, u: &[f64]) -> Fits {
        let skeleton = &self.equations.skeleton;
        let phases: Vec<f64> = (0..skeleton.switches.len())
            .map(|switch| skeleton.phase(u, switch))
            .collect();
        let ways = phases.windows(2).map(|pair| pair[1] - pair[0]);
        for (first, way) in ways.enumerate() {
            let [a, b] = [skeleton.switches[first], skeleton.switches[first + 1]];
            let same = (a.contact, a.level) == (b.contact, b.level) && a.rises != b.rises;
            let alone = a.told == Told::Alone && b.told == Told::Alone;
            let pair = matches!(a.told, Told::First { .. });
            if same && alone && way < plan::SHORTER || same && pair && way > plan::LONG {
                return Fits::Soon;
            }
        }
        for (index, switch) in skeleton.switches.iter().enumerate() {
            if matches!(switch.told, Told::Second { .. }) && u[skeleton.slot(index)] < plan::FAR {
                return Fits::Soon;
            }
        }
        let (Some(first), Some(last)) = (phases.first(), phases.last()) else {
            return Fits::Yes;
        };
        let [before, after] = [
            skeleton.begin + skeleton.length - last,
            first - skeleton.begin,
        ];
        let around = before + after;
        if before.min(after) < 0.2 * around && around > plan::CLOSE {
            return Fits::Soon;
        }
        Fits::Yes
    }

    /// Whether an extreme that is watched comes near another one, with which it may end.
    fn meets_another(&self, u: &[f64], found: &[GapExtreme]) -> bool {
        let skeleton = &self.equations.skeleton;
        skeleton.switches.iter().enumerate().any(|(index, switch)| {
            let Told::First { other, .. } = switch.told else {
                return false;
            };
            let extreme = GapExtreme {
                contact: switch.contact,
                interval: 0,
                phase: skeleton.phase(u, index),
                gap: 0.0,
                maximum: switch.rises,
            };
            let short = u[skeleton.slot(other)] <= 0.0;
            short && !plan::is_lonely(&extreme, found, skeleton.length, plan::TOO_NEAR)
        })
    }

    fn extreme_fits(&self, u: &[f64], extreme: &GapExtreme, all: &[GapExtreme]) -> Fits {
        let GapExtreme {
            contact,
            interval,
            gap,
            maximum,
            ..
        } = *extreme;
        let levels = &self.equations.values.contacts[contact].levels;
        let own = all.iter().filter(|other| other.contact == contact);
        let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), other| {
            (low.min(other.gap), high.max(other.gap))
        });
        let size = (high - low).max(f64::MIN_POSITIVE);
        let skeleton = &self.equations.skeleton;
        let piece = skeleton.intervals[interval].pieces[contact];
        let mut fits = Fits::Yes;
        for (level, value) in levels.iter().enumerate() {
            let above = gap - value;
            let beyond = if level < piece { -above } else { above };
            if beyond > BEYOND * size {
                return Fits::No;
            }
            let lonely = || plan::is_lonely(extreme, all, skeleton.length, plan::LONELY);
            if (above < 0.0) == maximum && lonely() && self.is_near(u, extreme, level) {
                fits = Fits::Soon;
            }
        }
        fits
    }

    /// Whether an extreme that is short of a level is to be watched and is not yet.
    fn is_near(&self, u: &[f64], extreme: &GapExtreme, level: usize) -> bool {
        let skeleton = &self.equations.skeleton;
        let place = (extreme.contact, level);
        let phase = extreme.phase;
        let above = extreme.gap - self.equations.values.contacts[place.0].levels[level];
        let watched = skeleton.switches.iter().enumerate().any(|(index, switch)| {
            let told = matches!(switch.told, Told::First { .. });
            let apart = (skeleton.phase(u, index) - phase).rem_euclid(skeleton.length);
            let near = apart.min(skeleton.length - apart) < SAME;
            told && (switch.contact, switch.level) == place && near
        });
        if watched {
            return false;
        }
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| {
            let (interval, phase) = motion.interval(phase);
            motion.state(interval, phase, state);
        };
        let gaps = self.gaps(&at);
        let square = -above / gaps.bend(place.0, phase);
        (plan::NEAR..=0.0).contains(&square)
    }

    fn gaps<'g>(&'g self, at: plan::At<'g>) -> Gaps<'g> {
        Gaps {
            values: &self.equations.values,
            at,
            coordinates: self.equations.values.linear.positions.nrows(),
        }
    }

    /// Looks at the motion at unknowns of the present equations.
    fn at<T>(
        &mut self,
        u: &[f64],
        look: impl FnOnce(&Motion<'_>, &Gaps<'_>) -> Option<T>,
    ) -> Option<T> {
        self.equations.compute(u, false);
        if self.equations.failed {
            return None;
        }
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| {
            let (interval, phase) = motion.interval(phase);
            motion.state(interval, phase, state);
        };
        look(&motion, &self.gaps(&at))
    }

    /// Equations that fit the orbit at these unknowns better, and its unknowns there.
    pub(super) fn replanned(&mut self, u: &[f64]) -> Option<(Equations, Vec<f64>)> {
        let frame = Frame {
            resolution: RESOLUTIONS[self.resolution],
            ..self.frame.clone()
        };
        let setting = &self.problem.setting;
        self.at(u, |motion, gaps| {
            let plan: Plan = plan::replanned(motion, u, gaps);
            plan.equations(setting, u[u.len() - 1], gaps, &frame)
        })
    }

    /// An orbit as unknowns of other equations, in which one near it has the unknowns `near`.
    pub(super) fn transferred(
        &mut self,
        u: &[f64],
        to: &Equations,
        near: &[f64],
    ) -> Option<Vec<f64>> {
        self.at(u, |motion, gaps| {
            plan::transferred(motion, u, gaps, to, near)
        })
    }

    /// A point of the branch as one of other equations. Its tangent is a difference.
    pub(super) fn point_in(
        &mut self,
        point: &CurvePoint,
        to: &Equations,
        near: &[f64],
    ) -> Option<CurvePoint> {
        let u = self.transferred(&point.u, to, near)?;
        let mut beside = |step: f64| {
            let moved = point.u.iter().zip(&point.tangent);
            let moved: Vec<f64> = moved.map(|(x, t)| x + step * t).collect();
            self.transferred(&moved, to, near)
        };
        let step = DIFFERENCE / point.tangent.iter().fold(1e-3, |m: f64, t| m.max(t.abs()));
        let ends = beside(step).zip(beside(-step));
        let tangent = ends.map_or_else(
            || {
                // The direction of what is varied is known.
                let mut tangent = vec![0.0; u.len()];
                tangent[u.len() - 1] = point.tangent[point.tangent.len() - 1];
                tangent
            },
            |(a, b)| {
                a.iter()
                    .zip(&b)
                    .map(|(x, y)| (x - y) / (2.0 * step))
                    .collect()
            },
        );
        Some(CurvePoint {
            u,
            tangent,
            scale: point.scale,
        })
    }

    /// All extremes of gaps as the engine sees them.
    pub(super) fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        extremes.clear();
        self.equations.compute(u, false);
        if self.equations.failed {
            return false;
        }
        let motion = Motion::of(&self.equations);
        let length = self.equations.skeleton.length;
        for (contact, found) in motion.extremes().gaps.iter().enumerate() {
            let mut found = found.clone();
            found.sort_by(|a, b| {
                let place = |extreme: &GapExtreme| extreme.phase.rem_euclid(length);
                place(a).total_cmp(&place(b))
            });
            let gaps = found.iter().map(|extreme| extreme.gap);
            let (low, high) = gaps.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            });
            let size = 0.5 * (high - low);
            let levels = &self.equations.values.contacts[contact].levels;
            for (level, value) in levels.iter().enumerate() {
                extremes.extend(found.iter().map(|extreme| Extreme {
                    contact,
                    level,
                    tau: TAU * extreme.phase.rem_euclid(length) / length,
                    maximum: extreme.maximum,
                    above: (extreme.gap - value) / size,
                    size,
                    jumps: false,
                    begins: false,
                }));
            }
        }
        true
    }

    /// Writes the linear form of unknowns that gap less level is at an extreme that is short of it, in units of the extreme: by (3) of
    /// [`skeleton`](super::skeleton) a multiple of `H`. Says whether the extreme is watched.
    pub(super) fn extreme_form(&self, u: &[f64], extreme: &Extreme, form: &mut [f64]) -> bool {
        let watched = self.watched(u, extreme);
        if let Some((square, bend)) = watched {
            form.fill(0.0);
            form[square] = -bend / extreme.size;
        }
        watched.is_some()
    }

    /// The unknown `H` of the pair that watches an extreme which is short of its level, and half of `g''`.
    pub(super) fn watched(&self, u: &[f64], extreme: &Extreme) -> Option<(usize, f64)> {
        let skeleton = &self.equations.skeleton;
        let mut switches = skeleton.switches.iter().enumerate();
        switches.find_map(|(index, switch)| {
            let Told::First { other, bend } = switch.told else {
                return None;
            };
            let phase = TAU * skeleton.phase(u, index) / skeleton.length;
            let apart = (phase - extreme.tau).rem_euclid(TAU);
            let same = (switch.contact, switch.level, switch.rises)
                == (extreme.contact, extreme.level, extreme.maximum);
            let square = skeleton.slot(other);
            let short = same && apart.min(TAU - apart) < SAME && u[square] <= TOUCHES;
            short.then_some((square, bend))
        })
    }

    /// What the other multipliers make of a determinant that vanishes with the one nearest to a critical value.
    pub(super) fn others(&mut self, u: &[f64], critical: f64) -> f64 {
        let Some(map) = self.equations.map(u) else {
            return 1.0;
        };
        let distance = |m: &Complex<f64>| (m - critical).norm();
        let mut distances: Vec<f64> = eigenvalues(&map).iter().map(distance).collect();
        distances.sort_by(f64::total_cmp);
        let product: f64 = distances.iter().skip(1).product();
        product.max(1.0) * distances.last().copied().unwrap_or(1.0).max(1.0)
    }
}

/// An orbit with more nodes.
struct Finer {
    u: Vec<f64>,
    /// What it changes in what is varied.
    shift: f64,
}

/// How far a finer orbit is from where the coordinates of another one are smallest and largest: the error of these values, to first order.
fn apart(finer: &Equations, extremes: &[[Place; 2]]) -> f64 {
    let motion = Motion::of(finer);
    let off = |coordinate: usize, place: &Place| {
        let (interval, phase) = motion.interval(place.x);
        motion.coordinate(coordinate, interval, phase)[0] - place.value
    };
    let pairs = extremes.iter().enumerate();
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
