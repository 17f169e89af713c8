//! States from which orbits are looked for at a value.
//!
//! Orbits at one value may be of very different sizes, and what is not known yet is often as large as one of those that are. So boxes of several
//! sizes lie around each orbit that known branches have at the value, and around what all of them reach in the range; points of the additive
//! sequence of Roberts (2018), which fills a box evenly, are in each of them in turn.

use super::diagram::{Diagram, DiagramBranch};
use super::matching::around;
use crate::branches::point::Point;

/// Sizes of boxes, where one is that of an orbit.
const BOXES: [f64; 3] = [1.0, 0.4, 3.0];
/// The same where all solutions are asked for: beside a small response that nothing leads away from there may be a large one.
const WIDE: [f64; 4] = [1.0, 0.4, 3.0, 6.0];
/// A coordinate counts as large as this part of the largest one, at least.
const LEAST: f64 = 1e-3;

/// How far orbits reach: the least and the largest of each coordinate.
#[derive(Debug, Clone)]
pub(super) struct Reach(Vec<[f64; 2]>);

impl Reach {
    pub(super) fn new(coordinates: usize) -> Self {
        Self(vec![[f64::INFINITY, f64::NEG_INFINITY]; coordinates])
    }

    pub(super) fn include(&mut self, coordinate: usize, low: f64, high: f64) {
        let [least, largest] = self.0[coordinate];
        self.0[coordinate] = [least.min(low), largest.max(high)];
    }

    fn include_orbit(&mut self, point: &Point) {
        for (i, motion) in point.observed.motions.iter().enumerate() {
            self.include(i, motion.minimum, motion.maximum);
        }
    }
}

/// A box of states.
#[derive(Debug, Clone)]
struct Around {
    middle: Vec<f64>,
    /// Half of its edges.
    units: Vec<f64>,
}

impl Around {
    fn of(Reach(reach): &Reach, omega: f64) -> Self {
        let half = |[low, high]: [f64; 2]| 0.5 * (high - low);
        let largest = reach.iter().copied().map(half).fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let sizes = reach.iter().map(|ends| half(*ends).max(LEAST * largest));
        let sizes: Vec<f64> = sizes.collect();
        let speeds = sizes.iter().map(|size| omega * size);
        let middle = reach.iter().map(|[low, high]| 0.5 * (low + high));
        Self {
            middle: middle.chain(vec![0.0; reach.len()]).collect(),
            units: sizes.iter().copied().chain(speeds).collect(),
        }
    }
}

/// Boxes at a value.
#[derive(Debug, Clone)]
pub(super) struct Starts {
    around: Vec<Around>,
    boxes: &'static [f64],
    /// Sizes of the entries of a state, of all orbits of the range.
    pub(super) units: Vec<f64>,
}

/// One of the states in the boxes.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub(super) state: Vec<f64>,
    /// Sizes of its entries, of the orbit that its box is around.
    pub(super) units: Vec<f64>,
    /// One of numbers from 0 to 1.
    pub(super) part: f64,
    /// How often all boxes were gone through before.
    pub(super) turn: usize,
}

impl Starts {
    /// Around orbits of some branches at a value, and around a reach.
    pub(super) fn at(value: f64, omega: f64, diagram: &Diagram, reach: &Reach, wide: bool) -> Self {
        let alone = |point: &Point| {
            let mut reach = Reach::new(reach.0.len());
            reach.include_orbit(point);
            Around::of(&reach, omega)
        };
        let branches = diagram.branches.iter();
        let local =
            branches.flat_map(|branch| around(&branch.branch, diagram.begin(branch), value));
        let mut all: Vec<Around> = local.map(alone).collect();
        let of_range = Around::of(reach, omega);
        let units = of_range.units.clone();
        all.push(of_range);
        Self {
            around: all,
            boxes: if wide { &WIDE } else { &BOXES },
            units,
        }
    }

    /// One of a sequence of states.
    pub(super) fn draw(&self, index: usize) -> Start {
        let (sizes, count) = (self.boxes.len(), self.around.len());
        let Around { middle, units } = &self.around[index / sizes % count];
        let size = self.boxes[index % sizes];
        let mut parts = sequence(index, middle.len() + 1);
        let part = parts.next().map_or(0.5, |part| 0.5 * (1.0 + part));
        let entries = parts.zip(middle).zip(units);
        let state = entries.map(|((part, middle), unit)| middle + size * part * unit);
        Start {
            state: state.collect(),
            units: units.iter().map(|unit| size.max(1.0) * unit).collect(),
            part,
            turn: index / (sizes * count),
        }
    }
}

/// How far all orbits of branches reach; `None` if there is none.
pub(super) fn reach(branches: &[DiagramBranch], coordinates: usize) -> Option<Reach> {
    let mut reach = Reach::new(coordinates);
    let mut points = branches.iter().flat_map(|branch| &branch.branch.points);
    reach.include_orbit(points.next()?);
    points.for_each(|point| reach.include_orbit(point));
    Some(reach)
}

/// A point of the sequence that fills the cube from -1 to 1 evenly: multiples of the powers of the root of `x^(n + 1) = x + 1`
/// (Roberts 2018).
fn sequence(index: usize, entries: usize) -> impl Iterator<Item = f64> {
    let power = 1.0 / (entries + 1) as f64;
    let root = (0..60).fold(1.5, |x: f64, _| (1.0 + x).powf(power));
    (1..=entries).map(move |j| 2.0 * ((index + 1) as f64 / root.powi(j as i32)).fract() - 1.0)
}
