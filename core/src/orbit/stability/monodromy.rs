//! The monodromy matrix of an orbit, integrated from switch to switch: the authority on stability.
//!
//! Between the phases at which a gap crosses a level, perturbations obey the linear equation (1) of
//! [`linearised`](super::linearised); at such a phase they jump with the field (saltation). On a panel where the equation is
//! constant, as on affine pieces, one exponential is exact. On the others the steps are those of
//! [`magnus`](super::magnus), graded towards ends where the slopes are a broken power of the distance. The power of the grading
//! is the one that makes the exponents whole, so that the graded equation is smooth.
//!
//! The error is estimated along with the matrix `P`. What the fourth order lacks in each step is carried along to the end,
//!
//! ```text
//! L_(k+1) = exp(Omega_k) L_k + D_k P_(k+1),        q = sum |D_k| / sum |C_k/12|                               (1)
//! ```
//!
//! and `q L` is about as large as the error of `P` (within a factor of two on the orbits that were tried). The error of the
//! multipliers is how far they move for such an error of the matrix, whatever its signs. The number of steps follows from it,
//! with the sixth root. How far they move for rounding errors of the matrix, near a double multiplier by the root of these, is added:
//! no steps make it smaller. Where a law may be sharp, and where panels are graded, twice the steps are taken as well, and the change
//! counts: commutators do not show what the steps leave of an integral. Of a system of one coordinate the determinant is known by
//! Liouville's formula,
//! `det P = exp(int trace A)`, and gives the smaller multiplier however small it is. Where the matrix of others has lost small
//! multipliers, they are found from its factors: see [`product`](super::product).
//!
//! Cost: on affine pieces one exponential for each panel, otherwise about three evaluations of the slopes and one exponential
//! for each of some eight steps.
//!
//! Sources: Leine and Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7 (saltation);
//! Blanes et al. (2009), The Magnus expansion and some of its applications (steps).

use std::f64::consts::TAU;

use super::fundamental::{Fundamental, FundamentalOfFactors, FundamentalOfMany, FundamentalOfTwo};
use super::linearised::{Linearised, Panel};
use super::method::{Cost, Floquet, Found};
use super::orbit::Orbit;
use super::path::Path;
use crate::laws::generic::scales::Sight;
use crate::numeric::fourier::grading::Grading;
use crate::numeric::spectrum::distance;

/// Steps per period at first.
const FIRST_DENSITY: f64 = 8.0;
/// Steps per period at most.
const LARGEST_DENSITY: f64 = 2048.0;
/// Steps per period up to which a law that is sharp may ask for more.
const SHARPEST: f64 = 64.0;
/// Ratio of the errors with a step and with half of it, at least; the order would be 64.
const HALVED: f64 = 8.0;
/// Steps for each wave of a stiffness or a direction that varies in time, at least.
const STEPS_PER_WAVE: f64 = 2.0;
/// Numbers of steps on a panel; above, powers of two and half as many more.
const COUNTS: [usize; 10] = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16];
/// Error of the next orbit, in parts of what is aimed at.
const TARGET: f64 = 0.15;
/// Largest order of a matrix whose factors are asked for small multipliers in any case.
const SMALL: usize = 8;
/// Fewest steps on a graded panel, for each power of its map: that is a polynomial of a degree below twice the power, of which three nodes
/// a step integrate five, and nothing else tells what they leave of it.
const FEWEST: usize = 2;

/// Integrates orbits, one after the other.
#[derive(Debug)]
pub(crate) struct Monodromy {
    /// Steps per period that shall suffice for the next orbit.
    density: f64,
    path: Path,
    linearised: Linearised,
    /// Multipliers over many decades are wanted whatever it costs.
    complete: bool,
    /// The nodes of the last orbit do not see its laws.
    overlooks: bool,
    /// A panel of the last orbit is graded: commutators do not show what is left of its integral.
    graded: bool,
    /// How many times the fewest steps are made on a graded panel.
    finer: usize,
    /// Of the last system of several coordinates.
    many: Option<FundamentalOfMany>,
    cost: Cost,
}

impl Monodromy {
    /// By factors, if `complete`, where the matrix has lost small multipliers; otherwise for small systems only.
    pub(crate) fn new(complete: bool) -> Self {
        Self {
            complete,
            overlooks: false,
            graded: false,
            finer: 1,
            density: FIRST_DENSITY,
            path: Path::default(),
            linearised: Linearised::default(),
            many: None,
            cost: Cost::default(),
        }
    }

    /// The monodromy matrix with this many steps per period on panels that need steps, in coordinates and phase derivatives, column
    /// by column.
    #[cfg(test)]
    pub(super) fn matrix(&mut self, orbit: &Orbit<'_>, density: f64) -> Vec<f64> {
        assert!(self.linearised.load(orbit));
        self.path.load(orbit);
        let mut solution = FundamentalOfMany::new(2 * orbit.layout.coordinates);
        solution.begin();
        self.integrate(&mut solution, orbit, density);
        solution.matrices()[0].to_vec()
    }

    /// Multipliers with this many steps per period, and the part of their error that more steps make smaller.
    fn at_density(&mut self, orbit: &Orbit<'_>, density: f64) -> (Found, f64) {
        let order = 2 * orbit.layout.coordinates;
        self.cost.spectra += 1;
        self.cost.order = self.cost.order.max(order);
        let (multipliers, [by_steps, by_rounding], matrix) = if order == 2 && orbit.rigid.is_none()
        {
            let mut solution = FundamentalOfTwo::new();
            self.integrate(&mut solution, orbit, density);
            let (multipliers, errors) = solution.multipliers();
            (multipliers, errors, solution.matrices()[0].to_vec())
        } else {
            let kept = self
                .many
                .take()
                .filter(|solution| solution.order() == order);
            let mut solution = kept.unwrap_or_else(|| FundamentalOfMany::new(order));
            solution.begin();
            self.integrate(&mut solution, orbit, density);
            if let Some(rigid) = orbit.rigid {
                solution.take_out(rigid);
            }
            let (mut multipliers, errors) = solution.multipliers();
            let matrix = solution.matrices()[0].to_vec();
            let lost = solution.has_lost(&multipliers)
                && (self.complete || order <= SMALL)
                && orbit.rigid.is_none();
            self.many = Some(solution);
            if lost {
                let mut factors = FundamentalOfFactors::new(order);
                self.integrate(&mut factors, orbit, density);
                let (found, _) = factors.multipliers();
                if !found.is_empty() {
                    multipliers = found;
                }
            }
            (multipliers, errors, matrix)
        };
        let known = !multipliers.is_empty();
        let found = Found {
            error: if known {
                by_steps + by_rounding
            } else {
                f64::INFINITY
            },
            multipliers,
            bound: None,
            matrix,
        };
        (found, by_steps)
    }

    /// With twice the steps, and the error that the change tells: commutators do not show what a peak of the damping leaves in the
    /// trace, and other nodes do.
    fn halved(&mut self, orbit: &Orbit<'_>, density: f64, coarse: &Found) -> (Found, f64) {
        self.finer = 2;
        let (mut finer, _) = self.at_density(orbit, 2.0 * density);
        self.finer = 1;
        self.linearised.look();
        let changed = distance(&coarse.multipliers, &finer.multipliers) / HALVED;
        finer.error = finer.error.max(changed);
        (finer, changed)
    }

    fn integrate(&mut self, solution: &mut impl Fundamental, orbit: &Orbit<'_>, density: f64) {
        self.path.begin();
        self.graded = false;
        if self.path.cuts.is_empty() {
            self.panel(solution, orbit, [0.0, TAU], None, density);
        }
        for index in 0..self.path.cuts.len() {
            let (from, to) = (self.path.cuts[index], self.path.next(index));
            self.path.pass(&from);
            if to.tau > from.tau {
                self.panel(solution, orbit, [from.tau, to.tau], Some(index), density);
            }
            let matrices = solution.matrices();
            self.linearised.jump(orbit, &self.path, &to, matrices);
        }
    }

    /// Goes from a cut to the next.
    fn panel(
        &mut self,
        solution: &mut impl Fundamental,
        orbit: &Orbit<'_>,
        [start, end]: [f64; 2],
        cut: Option<usize>,
        density: f64,
    ) {
        if self.linearised.is_constant(orbit, &self.path) {
            self.cost.slopes += self.linearised.evaluate_constant(orbit, &self.path);
            self.cost.exponentials += 1;
            let to = solution.scaled(0);
            self.linearised.constant_matrix(end - start, to);
            solution.constant();
            return;
        }
        let ends = cut.map_or([&[][..]; 2], |index| self.path.ends(index));
        let [start_power, end_power] = ends.map(|cuts| self.path.grading(cuts));
        let grading = Grading {
            start: start_power,
            end: end_power,
        }
        .balanced();
        self.graded |= grading != Grading::NONE;
        let least = if grading == Grading::NONE {
            1
        } else {
            let power = grading.start.max(grading.end) as usize;
            self.finer * FEWEST * power
        };
        let wanted = (density * (end - start) / TAU).ceil() as usize;
        let steps = count(wanted.max(least));
        let panel = Panel {
            start,
            end,
            grading,
            steps,
        };
        self.cost.slopes += self.linearised.evaluate(orbit, &self.path, &panel, ends);
        self.cost.exponentials += steps;
        for step in 0..steps {
            for node in 0..3 {
                let to = solution.scaled(node);
                self.linearised.matrix(orbit, 3 * step + node, to);
            }
            solution.step();
        }
    }
}

/// The next number of steps for which nodes are kept.
fn count(least: usize) -> usize {
    if let Some(count) = COUNTS.into_iter().find(|&count| count >= least) {
        return count;
    }
    let power = least.next_power_of_two();
    let between = power / 4 * 3;
    if between >= least { between } else { power }
}

/// By how much the number of steps is to be multiplied for the error to become what is aimed at.
fn factor(error: f64, aim: f64) -> f64 {
    let factor = (error / (TARGET * aim)).powf(1.0 / 6.0);
    // Steps that are far too long leave nothing finite: an infinite factor.
    if factor.is_nan() {
        f64::INFINITY
    } else {
        factor
    }
}

/// Steps per period for the next orbit, after so many with this error.
fn next_density(density: f64, error: f64, aim: f64) -> f64 {
    let next = density * factor(error, aim).clamp(0.5, 1.3);
    next.clamp(FIRST_DENSITY, LARGEST_DENSITY)
}

impl Floquet for Monodromy {
    fn multipliers(&mut self, orbit: &Orbit<'_>, aim: f64) -> Found {
        if !self.linearised.load(orbit) {
            return Found::NOTHING;
        }
        self.path.load(orbit);
        // What varies by itself between two nodes of a step shows in no estimate.
        let waves = orbit.layout.highest_harmonic() * orbit.period;
        let mut density = self.density.max(STEPS_PER_WAVE * waves as f64);
        loop {
            let (found, error) = self.at_density(orbit, density);
            let sight = self.linearised.look();
            if sight == Some(Sight::Missed) && density < SHARPEST {
                density = (2.0 * density).min(SHARPEST);
                continue;
            }
            self.overlooks = sight > Some(Sight::Clear);
            if self.overlooks {
                self.density = density.min(SHARPEST);
                return found;
            }
            if (sight.is_some() || self.graded) && error <= aim && density < LARGEST_DENSITY {
                let (finer, halved) = self.halved(orbit, density, &found);
                if halved <= aim {
                    // A law that is sharp was seen with so many steps, and may not be with fewer.
                    self.density = if sight.is_some() {
                        density
                    } else {
                        next_density(density, error.max(halved), aim)
                    };
                    return finer;
                }
                density = (2.0 * density).min(LARGEST_DENSITY);
                continue;
            }
            if density >= LARGEST_DENSITY || error <= aim {
                self.density = next_density(density, error, aim);
                return found;
            }
            density = (density * factor(error, aim).clamp(1.3, 4.0)).min(LARGEST_DENSITY);
        }
    }

    fn knows_its_error(&self) -> bool {
        true
    }

    fn overlooks(&self) -> bool {
        self.overlooks
    }

    fn pace(&self) -> f64 {
        self.density
    }

    fn keep_pace(&mut self, pace: f64) {
        if (FIRST_DENSITY..=LARGEST_DENSITY).contains(&pace) {
            self.density = pace;
        }
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}
