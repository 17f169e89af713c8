//! What is read off an orbit, with its errors: one step from it to a solution with more nodes tells what the nodes leave out. How far two
//! orbits are apart is measured in [`errors`], what the finer one leaves out itself in [`finer_rest`], whether one comes back earlier than asked for in [`minimal_period`], whether nodes see narrow
//! places of a law in [`overlooked`].
//!
//! With the equations `F = 0` of more nodes and their Jacobian `J` in the plane across the tangent, at unknowns `u` that are interpolated, what
//! is stated of the error of a quantity `Q` is
//!
//! ```text
//! e = 2 |Q(u - J^-1 F(u)) - Q(u)|                                                                              (1)
//! e_k = 2 (t_k / t)^2 e,    k = 1 .. 31                                                                         (2)
//! ```
//!
//! and what the slope of the branch makes of the change of what is varied. Of an output one of both times in (1) is what the finer solution may leave
//! out itself, by [`finer_rest`], where that is more. (2) is that of orbits behind it on the branch, with the last
//! coefficients `t` of the forces at the nodes, each times what a unit force does: an error is a product of what the forces and of what the
//! rule of integration leaves out. Where (2) is more than the tolerance or says nothing, and after 31 orbits, (1) is asked for again. Neither
//! is a bound.
//!
//! Source: Stetter (1978), The defect correction principle and discretization methods, Numerische Mathematik 29 (errors from one step on finer
//! equations); Trefethen (2013), Approximation Theory and Approximation Practice, chapter 8 (what coefficients tell of the rest).

pub(super) mod errors;
mod finer_rest;
pub(super) mod minimal_period;
pub(super) mod overlooked;
mod piecewise;
mod plain_outputs;
pub(super) mod stretch;

use nalgebra::{Complex, DMatrix};

use self::errors::Steepness;
use self::overlooked::Overlooked;
use self::piecewise::Piecewise;
use self::stretch::Read;
use super::equations::Equations;
use super::orbit::extents;
use super::orbit::extremes::extremes_of;
use super::orbit::motion::{Motion, Within};
use super::run::Run;
use super::run::error_estimate::{SAFETY, SCREENED, Screened};
use super::skeleton::Skeleton;
use super::skeleton::interval::Interval;
use super::skeleton::phases::Opening;
use super::skeleton::placement::Told;
use crate::branches::moduli::{self, multipliers};
use crate::branches::observed::{Motion as Extent, Observed, part_of};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::stability::{Stability, Verdict};
use crate::continuation::follow::CurvePoint;
use crate::numeric::roots::Place;
use crate::orbit::observe::Accuracy;
use crate::shooting::signals::Rounded;

/// Roundings in the last coefficients of forces.
const ROUNDED: f64 = 16.0;
/// Where the branch is steeper than this part, as before a fold, what is varied moves the orbit by more.
const STEEPER: f64 = 0.5;

/// An orbit that was read.
pub(super) struct ReadOrbit {
    pub(super) point: Point,
    pub(super) map: Option<DMatrix<f64>>,
    /// What one step to a finer solution changes in what is varied.
    pub(super) shift: f64,
    /// The map of that finer solution.
    pub(super) finer: Option<DMatrix<f64>>,
    /// Where nodes step over a narrow place of a law, so that a finer solution says nothing.
    pub(super) overlooks: Option<Overlooked>,
}

impl Run<'_> {
    /// The orbit at unknowns of the last pass, without its stability and error.
    pub(super) fn observed(&self, equations: &Equations, value: f64) -> Point {
        let problem = &self.problem.asked;
        let motion = Motion::of(equations);
        let coordinates = equations.values.linear.positions.nrows();
        let rate = equations.values.base;
        let skeleton = &equations.skeleton;
        let recurrence = skeleton.recurrence();
        let switches = switches(equations);
        Point {
            value,
            parameters: problem.parameters_at(value),
            orbit: Orbit {
                series: Vec::new(),
                states: motion.states_of_parts(problem.period),
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
                outputs: self.outputs_of(&motion, value),
                sampled: self.samples_coordinates(),
                ..Observed::extremes(self.motions_of(&motion), switches * recurrence.parts)
            },
            error: None,
        }
    }

    /// Whether coordinates are known from a few phases: the error is of an output.
    fn samples_coordinates(&self) -> bool {
        matches!(self.accuracy(), Accuracy::Output(_))
    }

    /// What all coordinates do.
    fn motions_of(&self, motion: &Motion<'_>) -> Vec<Extent> {
        let of = |[minimum, maximum]: &[Place; 2]| Extent {
            minimum: minimum.value,
            maximum: maximum.value,
            ..Extent::NONE
        };
        if !self.samples_coordinates() {
            return motion.coordinate_extremes().iter().map(of).collect();
        }
        let mut motions = extents::sampled(motion);
        let first = extremes_of(motion, 0..1);
        for (motion, first) in motions.iter_mut().zip(&first) {
            *motion = of(first);
        }
        motions
    }

    /// The outputs of the same.
    pub(super) fn outputs(&self, equations: &Equations, value: f64) -> Vec<Extent> {
        self.outputs_of(&Motion::of(equations), value)
    }

    fn outputs_of(&self, motion: &Motion<'_>, value: f64) -> Vec<Extent> {
        let asked = &self.problem.asked;
        let (parameters, omega) = (asked.parameters_at(value), asked.omega_at(value));
        Piecewise {
            system: asked.system.as_ref(),
            parameters: &parameters,
            omega,
            motion,
        }
        .read()
    }

    /// The outputs of the same by rules of quadrature, with more rounding of states if that is wanted.
    pub(super) fn outputs_by_rules(&self, value: f64, rounded: bool) -> Vec<Extent> {
        let motion = Motion::of(&self.equations);
        let recurrence = self.equations.skeleton.recurrence();
        let Some(mut outputs) = self.problem.asked.output_reader(value, recurrence) else {
            return Vec::new();
        };
        for interval in 0..motion.intervals() {
            let [from, to] = motion.phases(interval);
            let motion = &motion;
            let within = Read::new(Within { motion, interval });
            if to > from && rounded {
                outputs.include(&Rounded(&within));
            } else if to > from {
                outputs.include(&within);
            }
        }
        outputs.motions()
    }

    /// Reads an orbit with everything that is asked for, its errors as a finer solution shows them: those at its value.
    pub(super) fn read(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        let (point, map) = self.read_plainly(at)?;
        self.read_further(at, point, map)
    }

    /// The same of an orbit that was read plainly.
    fn read_further(
        &mut self,
        at: &CurvePoint,
        mut point: Point,
        map: Option<DMatrix<f64>>,
    ) -> Option<ReadOrbit> {
        let overlooks = self.overlooks();
        if overlooks.is_none() {
            return self.read_finer(at, point, map, true);
        }
        point.error = Some(f64::INFINITY);
        Some(ReadOrbit {
            overlooks,
            ..unknown(point, map)
        })
    }

    /// The same of an orbit at an event, whose value has an error of its own: multipliers have those of the orbit that it is of.
    pub(super) fn read_event(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        let (point, map) = self.read_plainly(at)?;
        self.read_finer(at, point, map, false)
    }

    /// What a finer solution shows of the orbit of the last pass.
    fn read_finer(
        &mut self,
        at: &CurvePoint,
        mut point: Point,
        map: Option<DMatrix<f64>>,
        at_value: bool,
    ) -> Option<ReadOrbit> {
        let stiffness = self.stiffness();
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
        let apart = apart.max(self.other_extremes(&finer));
        let [everywhere, of_asked] = self.everywhere(&finer, point.value, apart);
        let distance = self.apart_with_rest(&finer, point.value, apart, of_asked);
        self.finer = Some(finer);
        let moves = apart > 0.0 || self.accuracy().peak_to_peak(&point.observed) > 0.0;
        let noise = if moves { self.noise(&point) } else { 0.0 };
        let size = self.size(&point, noise);
        let parts = self.equations.skeleton.recurrence().parts;
        let found = (map.as_ref()).map(|map| self.last_map.multipliers(map, parts));
        let of_map = found.as_deref().filter(|_| at_value && shift != 0.0);
        let steepness = self.steepness(at, &point, of_map);
        let steepness = steepness.unwrap_or(Steepness::of_peak_to_peak(self.rise(&point)));
        let [along, moved] = steepness.along(shift);
        let error = part_of(distance.stated() + SAFETY * along + noise, size);
        point.error = Some(stated(error));
        let mut spread = 0.0;
        if let Some((map, found)) = map.as_ref().zip(found) {
            let moved = moved + self.grown() * parts as f64 * map.norm().max(1.0);
            (point.stability, spread) = stability(map, found, finer_map.as_ref(), parts, moved);
        }
        let own = [distance.stated() + noise, SAFETY * moved];
        self.own_errors = steepness.own_errors(&point, size, own);
        self.screened = Some(Screened {
            tails: self.tails(&at.u),
            stiffness,
            switches: switches(&self.equations),
            narrowest: self.narrowest(&at.u),
            apart: everywhere,
            of_asked: distance.most,
            shift: shift.abs(),
            slope: at.parameter_slope().abs(),
            error: error.max(part_of(SAFETY * distance.most, size)),
            spread: SAFETY * spread,
            most: [1.0, 1.0],
            left: SCREENED,
        });
        Some(ReadOrbit {
            point,
            map,
            shift,
            finer: finer_map,
            overlooks: None,
        })
    }

    /// Reads an orbit of the walk. Near one whose errors a finer solution has shown it has those, as many times as large as what its forces
    /// leave out tells. Where that is more than is asked for, and every so often, a finer solution is asked again.
    pub(super) fn read_on(&mut self, at: &CurvePoint) -> Option<ReadOrbit> {
        // What a kink beside the end of a panel does to an orbit, the last coefficients of its forces do not tell; nor what they do to an output
        // that is no sum of coordinates.
        let is_output = matches!(self.accuracy(), Accuracy::Output(_));
        let is_foretold = !is_output || self.plain_output(at.parameter()).is_some();
        if !is_foretold || self.equations.has_kinks() {
            return self.read(at);
        }
        let slope = at.parameter_slope().abs();
        let alike = |known: &Screened| known.left > 0 && slope >= STEEPER * known.slope;
        if !self.screened.as_ref().is_some_and(alike) {
            return self.read(at);
        }
        let (mut point, map) = self.read_plainly(at)?;
        let (tails, stiffness) = (self.tails(&at.u), self.stiffness());
        if self.overlooks().is_some() {
            return self.read_further(at, point, map);
        }
        let narrowest = self.narrowest(&at.u);
        let rise = self.rise(&point);
        let noise = if is_output { self.noise(&point) } else { 0.0 };
        let size = self.size(&point, noise);
        let same = |known: &&mut Screened| known.switches == switches(&self.equations);
        let known = self.screened.as_mut().filter(same);
        let grown = known.and_then(|known| {
            let grown = known.grown([&tails, &stiffness], narrowest)?;
            Some((known, grown))
        });
        let Some((known, [grown, spreading])) = grown else {
            return self.read_further(at, point, map);
        };
        known.left -= 1;
        let error = part_of(SAFETY * (known.of_asked + rise * known.shift) + noise, size);
        let error = grown * error.max(known.error);
        let spread = spreading * known.spread;
        if error.is_nan() || error > self.problem.tolerance {
            return self.read_further(at, point, map);
        }
        if let Some(of) = &map {
            let parts = self.equations.skeleton.recurrence().parts;
            let found = self.last_map.multipliers(of, parts);
            let stability = Stability::of(found, spread);
            if stability.verdict == Verdict::Undecided {
                return self.read_further(at, point, map);
            }
            point.stability = stability;
        }
        point.error = Some(stated(error));
        Some(ReadOrbit {
            point,
            map,
            shift: f64::NAN,
            finer: None,
            overlooks: None,
        })
    }

    /// The error of what is read off an orbit at an event, from the same event by finer equations: neither orbit is at a given value, and beside
    /// a fold those at one value tell nothing.
    pub(super) fn error_at_event(&mut self, at: &CurvePoint, finer: &Equations, value: f64) -> f64 {
        self.equations.compute(&at.u, false);
        let point = self.observed(&self.equations, at.parameter());
        let apart = self.apart(finer, &point, value);
        let [_, of_asked] = self.everywhere(finer, value, apart);
        let distance = self.apart_with_rest(finer, value, apart, of_asked);
        let noise = self.noise(&point);
        stated(part_of(distance.stated() + noise, self.size(&point, noise)))
    }

    /// An orbit without its errors, and the map of its states if stability is asked for.
    fn read_plainly(&mut self, at: &CurvePoint) -> Option<(Point, Option<DMatrix<f64>>)> {
        self.own_errors = None;
        let map = if self.problem.asked.stability {
            self.statistics.monodromies += 1;
            Some(self.equations.map(&at.u)?)
        } else {
            self.equations.compute(&at.u, false);
            None
        };
        Some((self.observed(&self.equations, at.parameter()), map))
    }

    /// What the forces at the nodes leave out on every interval, by the size of their last coefficients and of what a unit force does.
    fn tails(&self, u: &[f64]) -> Vec<f64> {
        self.tails_of(&self.equations.skeleton, u)
    }

    /// The same of other equations of these contacts.
    fn tails_of(&self, skeleton: &Skeleton, u: &[f64]) -> Vec<f64> {
        let intervals = skeleton.intervals.iter();
        let of = |interval: &Interval| {
            let nodes = interval.active.len() * interval.nodes.count();
            let first = interval.active.first().map_or(0, |active| active.first);
            &u[first..][..nodes]
        };
        self.left_out(intervals.map(|interval| (interval, of(interval))))
    }

    /// The same of how the forces of the last pass change with their gaps, if derivatives were asked for, and of [`Run::perturbed`].
    fn stiffness(&self) -> Vec<f64> {
        let Equations {
            skeleton, passed, ..
        } = &self.equations;
        let pairs = skeleton.intervals.iter().zip(passed);
        let mut left =
            self.left_out(pairs.map(|(interval, passed)| (interval, &passed.stiffness[..])));
        if passed.iter().any(|passed| !passed.stiffness.is_empty()) {
            left.append(&mut self.perturbed());
        }
        left
    }

    /// What nodes leave out of the forces of perturbed motions, the most of those in which one state at the beginning is perturbed. These may
    /// turn faster than the orbit does. The forces are columns of `D`, (4) of [`chain`](crate::continuation::chain).
    fn perturbed(&self) -> Vec<f64> {
        let Equations {
            skeleton, chain, ..
        } = &self.equations;
        let (mut tails, mut largest) = (Vec::new(), 0.0_f64);
        for (link, interval) in skeleton.intervals.iter().enumerate() {
            let n = interval.nodes.count();
            for (place, active) in interval.active.iter().enumerate() {
                let size = self.equations.values.contacts[active.contact].input.size();
                let mut most = 0.0_f64;
                for state in 0..skeleton.order {
                    let unit = size * self.equations.unit(state);
                    let forces = &chain.by_other(link, state)[place * n..][..n];
                    most = most.max(unit * interval.nodes.tail_of_force(forces));
                    largest = forces.iter().fold(largest, |m, x| m.max(unit * x.abs()));
                }
                tails.push(most);
            }
        }
        raise(&mut tails, largest);
        tails
    }

    /// Half of the shortest way between two switches that may meet where the force jumps; one if there is none.
    fn narrowest(&self, u: &[f64]) -> f64 {
        let skeleton = &self.equations.skeleton;
        let ways = skeleton.switches.iter().filter_map(|switch| {
            let Told::First { other, .. } = switch.told else {
                return None;
            };
            let jumps = skeleton.opened(other) == Opening::Root;
            let way = u[skeleton.slot(other)];
            (jumps && way > 0.0).then_some(way)
        });
        ways.fold(1.0, f64::min)
    }

    /// What functions leave out on intervals, contact by contact, from their values at the nodes. What is less than their rounding is as
    /// large as that.
    fn left_out<'i>(&self, values: impl Iterator<Item = (&'i Interval, &'i [f64])>) -> Vec<f64> {
        let contacts = self.equations.values.contacts.iter();
        let sizes: Vec<f64> = contacts.map(|contact| contact.input.size()).collect();
        let (mut tails, mut largest) = (Vec::new(), 0.0_f64);
        for (interval, values) in values {
            let of_contacts = values.chunks_exact(interval.nodes.count());
            for (active, values) in interval.active.iter().zip(of_contacts) {
                let size = sizes[active.contact];
                tails.push(size * interval.nodes.tail_of_force(values));
                largest = values.iter().fold(largest, |m, x| m.max(size * x.abs()));
            }
        }
        raise(&mut tails, largest);
        tails
    }

    /// The orbit with more nodes, by one step of Newton's method in the plane across the tangent, as in (1).
    fn corrected(&mut self, at: &CurvePoint) -> Option<Finer> {
        // Kinks are elsewhere on every orbit.
        if self.finer.is_none() || self.equations.has_kinks() {
            self.finer = self.equations.finer_at(&at.u);
        }
        let finer = self.finer.as_mut()?;
        let mut u = self.equations.rearranged(finer, &at.u);
        let tangent = self.equations.rearranged(finer, &at.tangent);
        let step = finer.across(&u, &tangent)?;
        for (x, by) in u.iter_mut().zip(&step) {
            *x -= by;
        }
        let shift = step[step.len() - 1];
        Some(Finer { u, shift })
    }
}

/// What is less than the rounding of the largest value is as large as that.
fn raise(tails: &mut [f64], largest: f64) {
    let least = (ROUNDED * f64::EPSILON * largest).max(f64::MIN_POSITIVE);
    for tail in tails {
        *tail = tail.max(least);
    }
}

/// With what rounding adds, but where there is no error at all.
fn stated(error: f64) -> f64 {
    if error == 0.0 {
        0.0
    } else {
        error + 100.0 * f64::EPSILON
    }
}

/// These multipliers of a map over one of so many parts, with what a finer solution changes in them and how far they move along the branch to
/// its value; and the most that it changes in them or in the map.
fn stability(
    map: &DMatrix<f64>,
    found: Vec<Complex<f64>>,
    finer: Option<&DMatrix<f64>>,
    parts: usize,
    along: f64,
) -> (Stability, f64) {
    let apart = |finer| along + moduli::distance(&found, &multipliers(finer, parts), map.nrows());
    let moved = finer.map_or(f64::INFINITY, apart);
    let of_map = |finer: &DMatrix<f64>| parts as f64 * (map - finer).norm();
    let spread = finer.map_or(f64::INFINITY, |finer| moved.max(of_map(finer)));
    (Stability::of(found, SAFETY * moved), spread)
}

/// An orbit that no finer solution was found for.
fn unknown(point: Point, map: Option<DMatrix<f64>>) -> ReadOrbit {
    ReadOrbit {
        point,
        map,
        shift: f64::INFINITY,
        finer: None,
        overlooks: None,
    }
}

/// An orbit with more nodes.
struct Finer {
    u: Vec<f64>,
    /// What it changes in what is varied.
    shift: f64,
}

/// How often gaps cross levels. Both switches of a pair stand in one place where an extreme is short of its level; those of different
/// contacts may, and count.
fn switches(equations: &Equations) -> usize {
    let skeleton = &equations.skeleton;
    let is_second = |switch: usize| matches!(skeleton.switches[switch].told, Told::Second { .. });
    let passed = skeleton.intervals.iter().zip(&equations.passed);
    let short = passed.filter(|(interval, passed)| {
        interval.ends.is_some_and(is_second) && passed.phases[1] <= passed.phases[0]
    });
    skeleton.switches.len() - 2 * short.count()
}
