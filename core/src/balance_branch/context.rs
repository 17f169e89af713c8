//! What it takes to compute further orbits of a branch, and those at a value.

use std::sync::Arc;

use crate::balance::critical_block::{CriticalBlock, Part};
use crate::balance::resolution::{Chooser, resize};
use crate::balance::start::{Motion, StartRequest};
use crate::balance::symmetry::Permutations;
use crate::balance::truncation::RefinedBalance;
use crate::balance::{Balance, Parity, Resolution};
use crate::balance_branch::point_evaluator::PointEvaluator;
use crate::branches::branch::Branch;
use crate::branches::checkpoint::Keep;
use crate::branches::error::OrbitError;
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::solve::{Toward, along};
use crate::branches::value::{Chord, orbits_at};
use crate::cancel::Cancel;
use crate::continuation::follow::{CurvePoint, FollowOptions};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::numeric::fourier::series;
use crate::orbit::observe::Accuracy;
use crate::orbit::stability::Method;
use crate::system::{System, Variable};

/// What the core leaves out, relative to the diagonal of the tail.
const COUPLING: f64 = 0.02;
/// Harmonics that are always in the core, for each period of the excitation.
const LEAST_CORE: usize = 6;
/// A core pays when the harmonics are so many times as many.
const WORTHWHILE: f64 = 1.5;
/// A value asked for is met to this part of the range.
const VALUE_TOLERANCE: f64 = 1e-13;

/// Events that a run looks for. Where a symmetry breaks is located always.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EventSelection {
    Folds,
    /// And doublings of the period.
    Doublings,
    /// And crossings of branches, tori, and touches of levels.
    All,
}

/// What it takes to compute further orbits of a branch. Shooting has such a list of its own: of other equations, with some of the same names.
#[derive(Debug, Clone)]
pub(crate) struct BranchContext {
    pub(crate) system: Arc<dyn System>,
    pub(crate) parameters: Vec<f64>,
    pub(crate) omega: f64,
    pub(crate) variable: Variable,
    pub(crate) resolution: Resolution,
    pub(crate) newton: NewtonOptions,
    /// The orbits lack the odd symmetry that others of the system have.
    pub(crate) asymmetric: bool,
    /// Harmonics of the most regular orbits of the system, whose contacts are in each other's place after a part of the period, are
    /// multiples of this one.
    pub(crate) stride: usize,
    /// Coordinates that may be in each other's place, at every time or a part of the period later.
    pub(crate) permutations: Permutations,
    /// Which events are looked for.
    pub(crate) selection: EventSelection,
    /// How multipliers are computed, where they are.
    pub(crate) stability: Option<Method>,
    /// What the tolerance is of.
    pub(crate) accuracy: Accuracy,
    /// How harmonics follow the tolerance, where they do.
    pub(crate) chooser: Option<Chooser>,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) cancel: Cancel,
    /// Keeps what was found.
    pub(crate) keep: Option<Arc<dyn Keep>>,
}

impl BranchContext {
    /// The balance at one of the branch's resolutions.
    pub(crate) fn balance(&self, resolution: Resolution) -> Balance<'_> {
        Balance::new(
            self.system.as_ref(),
            &self.parameters,
            self.omega,
            self.variable,
            resolution,
        )
        .until(&self.cancel)
    }

    /// A evaluator of orbits of that resolution.
    pub(crate) fn evaluator(&self, resolution: Resolution) -> PointEvaluator<'_> {
        let finer = RefinedBalance::new(
            self.system.as_ref(),
            &self.parameters,
            self.omega,
            self.variable,
            resolution,
        );
        PointEvaluator::new(finer, self.stability, self.chooser.is_some(), self.accuracy)
    }

    /// What becomes singular at bifurcations of orbits of that resolution: the even harmonics where they have odd ones only, those
    /// of twice the period, which are harmonics of the declared one where an even number of them is in it, and all, where that is
    /// looked for.
    pub(crate) fn blocks(&self, resolution: Resolution) -> Vec<CriticalBlock<'_>> {
        let odd = resolution.parity == Parity::Odd;
        let all = self.selection == EventSelection::All;
        let doublings = !odd && self.selection != EventSelection::Folds;
        let wanted = [
            (odd, Part::Even),
            (doublings, Part::doubled(resolution.stride)),
            (all, Part::Own),
        ];
        let wanted = wanted.into_iter().filter(|(wanted, _)| *wanted);
        wanted
            .map(|(_, part)| self.block(part, resolution))
            .collect()
    }

    /// One part of the Jacobian.
    pub(crate) fn block(&self, part: Part, resolution: Resolution) -> CriticalBlock<'_> {
        CriticalBlock::new(
            part,
            self.system.as_ref(),
            &self.parameters,
            self.omega,
            self.variable,
            resolution,
        )
    }

    /// An orbit as extended unknowns of the resolution asked for.
    pub(crate) fn unknowns_of(&self, orbit: &Orbit, value: f64) -> Vec<f64> {
        let mut u = orbit.series.clone();
        u.push(value);
        let length = series::length(self.resolution.harmonics);
        let mut u = resize(&u, orbit.coordinates, length);
        let partition = self.balance(self.resolution).partition();
        partition.clear_others(&mut u);
        u
    }

    /// The same resolution with another number of harmonics, and with a core if that pays.
    pub(crate) fn with_harmonics(&self, harmonics: usize, core: usize) -> Resolution {
        let pays = WORTHWHILE * core as f64 <= harmonics as f64;
        Resolution {
            harmonics,
            core: if pays { core } else { harmonics },
            ..self.resolution
        }
    }

    /// The size of the core that an orbit asks for: large enough that the iteration converges fast.
    pub(crate) fn core_for(&self, u: &[f64]) -> usize {
        let mut balance = self.balance(self.resolution);
        let mut jacobian = Jacobian::new(balance.partition());
        let mut residual = vec![0.0; u.len() - 1];
        balance.evaluate(u, &mut residual, Some(&mut jacobian));
        let least = LEAST_CORE * self.resolution.period * self.resolution.stride;
        balance.core_size(COUPLING).max(least)
    }

    /// What a start is asked for; `motion` moves states of the system in time.
    pub(crate) fn start_request<'s>(
        &'s self,
        options: FollowOptions,
        motion: &'s Motion<'s>,
    ) -> StartRequest<'s> {
        StartRequest {
            system: self.system.as_ref(),
            parameters: &self.parameters,
            omega: self.omega,
            variable: self.variable,
            value: options.from,
            resolution: self.resolution,
            newton: options.newton,
            motion: Some(motion),
            cancel: &self.cancel,
        }
    }

    /// The orbit at a value near given unknowns, with the direction of the branch: to larger values for a positive side.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn along(&self, first: &[f64], side: f64, value: f64) -> Result<CurvePoint, Error> {
        let resolution = self.resolution;
        let mut balance = self.balance(Resolution {
            core: resolution.harmonics,
            ..resolution
        });
        let mut newton = Newton::new(&balance);
        let mut u = first.to_vec();
        let last = u.len() - 1;
        u[last] = value;
        let range = (self.to - self.from).abs();
        let toward = Toward { side, range };
        along(&mut balance, &mut newton, u, toward, self.newton)
            .map_err(|reason| OrbitError::NoStart { value, reason }.into())
    }

    /// See [`Branch::at`](crate::Branch::at).
    pub(crate) fn at(&self, branch: &Branch, value: f64) -> Result<Vec<Point>, Error> {
        let same = |a: &Point, b: &Point| is_same(&a.orbit, &b.orbit);
        let search = |ends: [&Point; 2], value: f64, _: usize| self.between(ends, value);
        orbits_at(branch, value, 1, search, same)
    }

    /// The orbit at a value between those of two neighbours, with their harmonics, or more where the tolerance asks for them.
    fn between(&self, [a, b]: [&Point; 2], value: f64) -> Result<Point, Error> {
        let mut harmonics = a.orbit.harmonics().max(b.orbit.harmonics());
        let Searched {
            mut point,
            mut error,
        } = self.searched([a, b], value, harmonics)?;
        let mut chooser = self.chooser.clone();
        loop {
            let chosen = chooser.as_mut().and_then(|c| c.decide(harmonics, error));
            let Some(more) = chosen.filter(|&chosen| chosen > harmonics) else {
                return Ok(point);
            };
            harmonics = more;
            match self.searched([a, b], value, harmonics) {
                Ok(better) => Searched { point, error } = better,
                // What was found stands, with its error.
                Err(_) => return Ok(point),
            }
        }
    }

    /// The orbit at a value between those of two neighbours, searched along the chord of the two.
    fn searched(
        &self,
        [a, b]: [&Point; 2],
        value: f64,
        harmonics: usize,
    ) -> Result<Searched, Error> {
        let mut balance = self.balance(self.with_harmonics(harmonics, harmonics));
        let newton = &mut Newton::new(&balance);
        let extended = |point: &Point| {
            let mut u = point.orbit.series.clone();
            u.push(point.value);
            resize(&u, point.orbit.coordinates, series::length(harmonics))
        };
        let chord = Chord {
            ends: [extended(a), extended(b)],
            range: (self.to - self.from).abs(),
            tolerance: VALUE_TOLERANCE,
        };
        let located = chord.at(&mut balance, newton, value, self.newton);
        let lost = OrbitError::Lost {
            value,
            from: a.value,
            to: b.value,
        };
        let located = located.filter(|located| located.vanishes).ok_or(lost)?;
        let mut u = located.point.u.clone();
        let last = u.len() - 1;
        u[last] = value;
        let mut evaluator = self.evaluator(balance.resolution());
        let point = evaluator.read(&mut balance, newton, &u, Some(&located.point));
        let error = evaluator.by_harmonics(point.error.unwrap_or(f64::INFINITY));
        Ok(Searched { point, error })
    }
}

/// An orbit that was searched, with the part of its error that more harmonics take away.
struct Searched {
    point: Point,
    error: f64,
}

/// Whether two orbits are one to nine digits.
fn is_same(a: &Orbit, b: &Orbit) -> bool {
    let size = a.series.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let near = |(x, y): (&f64, &f64)| (x - y).abs() <= 1e-9 * size;
    let same = |i| a.row(i).iter().zip(b.row(i)).all(near);
    a.omega == b.omega && (0..a.coordinates).all(same)
}
