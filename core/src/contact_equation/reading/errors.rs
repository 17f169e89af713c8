//! How far two orbits are apart in what the error is of, and what that is measured by.
//!
//! Of an orbit `x` and a finer one `y` the extremes differ, to first order, by as much as the motions where that of the first is, at `t`:
//!
//! ```text
//! max y - max x = y(t) - x(t) + O(y'(t)^2)                                                                     (1)
//! ```
//!
//! Where another extreme is nearly as far, the largest one of `y` may be elsewhere, so that extremes of both are compared as well.
//! (1) may vanish by chance. So the motions are compared at 24 phases as well where an error is to serve for orbits near by.
//!
//! Source: Danskin (1967), The Theory of Max-Min and its Application to Weapons Allocation Problems (derivatives of a largest value).

use nalgebra::Complex;

use super::plain_outputs::{self, Plain};
use crate::branches::moduli::{self, multipliers};
use crate::branches::observed::{EXTREMES, Motion as Extent, Observed, part_of};
use crate::branches::point::Point;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::linear_part::block::Block;
use crate::contact_equation::orbit::extremes::extremes_of;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::orbit::positions::positions;
use crate::contact_equation::run::{MULTIPLIERS, Run, difference_step};
use crate::continuation::follow::CurvePoint;
use crate::numeric::roots::Place;
use crate::orbit::observe::Accuracy;

/// A growth by more is no number to be computed with.
const LARGEST: f64 = 300.0;
/// Roundings of states at the beginning, of which finer equations have as many.
const GROWN: f64 = 100.0;
/// Where rounding of what is varied moves an orbit by this part of its size, the branch is vertical.
const VERTICAL: f64 = 1e-3;
/// Coordinates come farther than a few phases tell, by less than this factor.
const BEYOND: f64 = 2.0;
/// Roundings of an output in a configuration.
const ROUNDINGS: f64 = 8.0;
/// Phases at which two motions are compared.
const COMPARED: usize = 24;

/// How fast things change with what is varied.
pub(in crate::contact_equation) struct Steepness {
    pub(in crate::contact_equation) peak_to_peak: f64,
    pub(in crate::contact_equation) multipliers: f64,
}

impl Steepness {
    /// How far both move where what is varied is shifted.
    pub(in crate::contact_equation) fn along(&self, shift: f64) -> [f64; 2] {
        [self.peak_to_peak, self.multipliers].map(|steepness| {
            if shift == 0.0 {
                0.0
            } else {
                steepness * shift.abs()
            }
        })
    }

    /// As far as peak-to-peak changes alone.
    pub(in crate::contact_equation) fn of_peak_to_peak(peak_to_peak: f64) -> Self {
        Self {
            peak_to_peak,
            multipliers: 0.0,
        }
    }

    /// Whether it is so large that rounding of what is varied alone makes another orbit, whose value tells nothing.
    fn is_vertical(&self, point: &Point, size: f64) -> bool {
        let [along, moved] = self.along(f64::EPSILON * point.value);
        let multipliers = point.stability.multipliers.iter().map(|m| m.norm());
        let largest = multipliers.fold(1.0, f64::max);
        let errors = [part_of(along, size), moved / (MULTIPLIERS * largest)];
        let known = errors.iter().all(|error| error.is_finite());
        known && errors.iter().any(|error| *error > VERTICAL)
    }

    /// Where the branch is vertical, the errors of an orbit and of its multipliers apart from those of its value: the first is given, and how far that
    /// moves multipliers.
    pub(in crate::contact_equation) fn own_errors(
        &self,
        point: &Point,
        size: f64,
        [own, moved]: [f64; 2],
    ) -> Option<[f64; 2]> {
        let errors = [part_of(own, size), point.stability.error - moved];
        self.is_vertical(point, size).then_some(errors)
    }
}

impl Run<'_> {
    /// How peak-to-peak and, with the multipliers of the map of these unknowns, those change with what is varied, along the tangent.
    pub(in crate::contact_equation) fn steepness(
        &mut self,
        at: &CurvePoint,
        point: &Point,
        here: Option<&[Complex<f64>]>,
    ) -> Option<Steepness> {
        let accuracy = self.accuracy();
        let extremes = match accuracy {
            Accuracy::Output(_) => Vec::new(),
            _ => self.equations.extremes.coordinates.get()?.clone(),
        };
        let slope = at.tangent[at.tangent.len() - 1];
        let step = difference_step(&self.equations.skeleton, &at.u, &at.tangent);
        let moved = at.u.iter().zip(&at.tangent);
        let moved: Vec<f64> = moved.map(|(x, t)| x + step * t).collect();
        let multipliers = if let Some(here) = here {
            let parts = self.equations.skeleton.recurrence().parts;
            let there = self.equations.map(&moved);
            there.map_or(f64::INFINITY, |there| {
                let there = multipliers(&there, parts);
                moduli::distance(here, &there, self.equations.skeleton.order)
            })
        } else {
            self.equations.compute(&moved, false);
            0.0
        };
        let known = !self.equations.failed && slope != 0.0;
        let apart = known.then(|| {
            if let Accuracy::Output(_) = accuracy {
                let value = moved[moved.len() - 1];
                self.changed(point, self.asked_output(&self.equations, value))
            } else {
                apart(&self.equations, &extremes, accuracy)
            }
        });
        self.equations.compute(&at.u, false);
        let by = (step * slope).abs();
        apart.map(|apart| Steepness {
            peak_to_peak: apart / by,
            multipliers: multipliers / by,
        })
    }

    /// How much of an output is rounding of the states of the last pass.
    pub(in crate::contact_equation) fn noise(&self, point: &Point) -> f64 {
        let motions = point.observed.motions.iter();
        let farthest = motions.map(Extent::farthest).fold(0.0, f64::max);
        let grown = self.grown() * farthest;
        grown
            + match self.accuracy() {
                Accuracy::Output(output) => {
                    let changed = self.rounded(point, output);
                    if self.equations.configurations.is_empty() {
                        return grown + changed;
                    }
                    // States of configurations are taken over and given back: twice as many roundings, of which finer equations show none.
                    let own = point.observed.outputs.get(output);
                    2.0 * changed + ROUNDINGS * f64::EPSILON * own.map_or(0.0, Extent::farthest)
                }
                Accuracy::Coordinates | Accuracy::Coordinate(_) => 0.0,
            }
    }

    /// The output that the error is of, if it is a sum of coordinates.
    pub(super) fn plain_output(&self, value: f64) -> Option<Plain> {
        let Accuracy::Output(output) = self.accuracy() else {
            return None;
        };
        let asked = &self.problem.asked;
        let (parameters, omega) = (asked.parameters_at(value), asked.omega_at(value));
        plain_outputs::one(asked.system.as_ref(), &parameters, omega, output)
    }

    /// What rounding of states does to an output: of a sum of coordinates where all add up, of others as it is seen.
    fn rounded(&self, point: &Point, output: usize) -> f64 {
        if let Some(plain) = self.plain_output(point.value) {
            return BEYOND * EXTREMES * f64::EPSILON * plain.added(&point.observed.motions);
        }
        // What is in closed form has not the errors of the rules, which are not those of rounding.
        let [own, other] = [false, true].map(|rounded| {
            let outputs = self.outputs_by_rules(point.value, rounded);
            outputs.get(output).copied()
        });
        let pair = own.zip(other);
        pair.map_or(f64::NAN, |(own, other)| own.apart(&other))
    }

    /// What rounding of the states at the beginning of a period has come to at its end, relative to them, where motions of the linear part grow.
    pub(in crate::contact_equation) fn grown(&self) -> f64 {
        let blocks = self.equations.values.linear.blocks.iter();
        let growth = blocks.map(Block::growth).fold(0.0, f64::max);
        // Exponents are by time.
        let time = self.equations.skeleton.length / self.equations.values.base;
        GROWN * f64::EPSILON * (growth * time).min(LARGEST).exp_m1()
    }

    /// What the output that the error is of does in an orbit by these equations.
    fn asked_output(&self, equations: &Equations, value: f64) -> Option<Extent> {
        let Accuracy::Output(output) = self.accuracy() else {
            return None;
        };
        if let Some(plain) = self.plain_output(value) {
            return Some(plain.motion(&Motion::of(equations)));
        }
        self.outputs(equations, value).get(output).copied()
    }

    /// How far the output that the error is of is from what it does in another orbit.
    fn changed(&self, point: &Point, other: Option<Extent>) -> f64 {
        let Accuracy::Output(output) = self.accuracy() else {
            return f64::NAN;
        };
        let pair = point.observed.outputs.get(output).zip(other);
        pair.map_or(f64::NAN, |(own, there)| own.apart(&there))
    }

    /// What errors are measured by: what they are of, and the largest coordinate for one that is at rest.
    pub(in crate::contact_equation) fn size(&self, point: &Point, noise: f64) -> f64 {
        let Observed {
            motions, outputs, ..
        } = &point.observed;
        let largest = Accuracy::Coordinates.peak_to_peak(&point.observed);
        match self.accuracy() {
            Accuracy::Coordinates => largest,
            Accuracy::Coordinate(index) => {
                let own = motions.get(index);
                let rounding = motions.iter().map(Extent::farthest).fold(0.0, f64::max);
                let noise = EXTREMES * f64::EPSILON * rounding;
                own.filter(|own| !own.is_at_rest(noise))
                    .map_or(largest, Extent::peak_to_peak)
            }
            Accuracy::Output(index) => {
                let own = outputs.get(index);
                own.map_or(f64::NAN, |own| own.measure(noise))
            }
        }
    }

    /// What the error is of.
    pub(in crate::contact_equation) fn accuracy(&self) -> Accuracy {
        self.problem.asked.accuracy
    }

    /// How far a finer orbit at a value is from this one in what the error is of.
    pub(in crate::contact_equation) fn apart(
        &self,
        finer: &Equations,
        point: &Point,
        value: f64,
    ) -> f64 {
        let accuracy = self.accuracy();
        if let Accuracy::Output(_) = accuracy {
            return self.changed(point, self.asked_output(finer, value));
        }
        let motions = self.equations.extremes.coordinates.get();
        apart(finer, motions.map_or(&[][..], |found| found), accuracy)
    }

    /// How far peak-to-peak of a finer orbit is from that of this one where they have their extremes at different places: of two that are nearly as
    /// far, errors between nodes choose. Zero where an output is asked for, whose extremes are looked for in both.
    pub(in crate::contact_equation) fn other_extremes(&self, finer: &Equations) -> f64 {
        let Some(found) = self.equations.extremes.coordinates.get() else {
            return 0.0;
        };
        let asked = match self.accuracy() {
            Accuracy::Coordinate(one) => one..one + 1,
            Accuracy::Coordinates => 0..found.len(),
            Accuracy::Output(_) => return 0.0,
        };
        let others = extremes_of(&Motion::of(finer), asked.clone());
        let extent = |[low, high]: &[Place; 2]| high.value - low.value;
        let own = asked.filter_map(|coordinate| found.get(coordinate));
        let apart = own.zip(&others).map(|(a, b)| extent(b) - extent(a));
        apart.fold(0.0, |most: f64, apart| most.max(apart.abs()))
    }

    /// The largest difference of a coordinate from a finer motion, and that of the output that the error is of, if it is a sum of coordinates: in that
    /// an error of a gap is not seen. Both are at least what the error is of where it is of theirs.
    pub(super) fn everywhere(&self, finer: &Equations, value: f64, apart: f64) -> [f64; 2] {
        let output = self.plain_output(value);
        let motions = [&self.equations, finer].map(Motion::of);
        let skeleton = &self.equations.skeleton;
        let coordinates = self.equations.values.linear.positions.nrows();
        // An output has no image: it is of other coordinates in the next part.
        let parts = if output.is_some() {
            skeleton.recurrence().parts
        } else {
            1
        };
        let of_output = matches!(self.accuracy(), Accuracy::Output(_));
        let mut most = [if of_output { 0.0 } else { apart }, apart];
        let phase =
            |sample: usize| skeleton.begin + skeleton.length * (sample as f64 / COMPARED as f64);
        let phases: Vec<f64> = (0..COMPARED * parts).map(phase).collect();
        let [own, other] = motions.each_ref().map(|motion| positions(motion, &phases));
        for (a, b) in own
            .chunks_exact(coordinates)
            .zip(other.chunks_exact(coordinates))
        {
            let own = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            most[0] = own.fold(most[0], f64::max);
            most[1] = match &output {
                Some(output) => most[1].max(output.apart([a, b])),
                None => most[1].max(most[0]),
            };
        }
        most
    }

    /// How peak-to-peak changes with what is varied since the last point.
    pub(in crate::contact_equation) fn rise(&self, point: &Point) -> f64 {
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
}

/// How far a finer orbit is from where the coordinates of another one, or the one that the error is of, are smallest and largest: the error
/// of these values, by (1).
fn apart(finer: &Equations, extremes: &[[Place; 2]], accuracy: Accuracy) -> f64 {
    let motion = Motion::of(finer);
    let mut state = vec![0.0; finer.skeleton.order];
    let comes_back = finer.skeleton.recurrence().image.is_identity();
    let mut off = |coordinate: usize, place: &Place| {
        if comes_back {
            // One coordinate of many.
            let (interval, phase) = motion.interval(place.x);
            let row = &finer.values.linear.rows[coordinate];
            return motion.seen(row, interval, phase)[0] - place.value;
        }
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
