//! Events of a branch: what changed its sign in a step, and where it vanishes.
//!
//! With the map `M` of [`equations`](super::equations) and the slope `l'` of the parameter along the branch:
//!
//! | event | test function |
//! |---|---|
//! | fold | `l'` vanishes, and `det(M - I)` changes its sign with it |
//! | branch point | `det(M - I)` vanishes and `l'` does not; or `l'` does, and `det(M - I)` keeps its sign: a branch that ends on another one, as of twice the period at a period doubling |
//! | period doubling | `det(M + I)` vanishes; with odd symmetry the symmetry breaks there |
//! | Neimark-Sacker | the product of `mu_i mu_j - 1` over all pairs of multipliers vanishes, and a pair is complex |
//! | grazing | none: the number of times that a gap crosses a level changes, and so the place is found by halving |
//!
//! The bordered matrix of Newton's method has the determinant `det(M - I) / l'`, so these branch points are where it
//! changes its sign.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4 (test functions);
//! Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems, for the determinant.

use std::cell::RefCell;

use nalgebra::{Complex, DMatrix};

use super::companion::{self, Companion, multipliers};
use super::crossing::locate_crossing;
use super::cycle::{Cycle, CycleEvent};
use super::equations::Equations;
use super::run::{Run, add, observe};
use super::setting::Setting;
use crate::branch::{EventKind, Turn};
use crate::continuation::follow::CurvePoint;
use crate::continuation::locate::locate;
use crate::newton::{Newton, NewtonOptions};
use crate::stability::{Stability, distance, eigenvalues};

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
const VANISHED: f64 = 1e-14;
/// What rounding leaves in the value of a grazing, where the distance from a level has a root to be told apart from.
const TOUCHED: f64 = 2e-12;
/// What rounding leaves in the value of an event.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The test functions at one orbit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tests {
    slope: f64,
    /// `det(M - I)`
    minus: f64,
    /// `det(M + I)`
    plus: f64,
    /// The product of `mu_i mu_j - 1`, and whether the pair that is nearest to one is complex.
    pairs: f64,
    complex: bool,
}

/// Which of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Test {
    Slope,
    Minus,
    Plus,
    Pairs,
}

/// A test function that changed its sign, and what that means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Change {
    pub(super) test: Test,
    pub(super) kind: EventKind,
}

impl Change {
    /// A branch that another one meets or crosses.
    pub(super) const BRANCHES: Self = Self {
        test: Test::Minus,
        kind: EventKind::BranchPoint,
    };
}

/// Where it is zero.
struct Place {
    point: CurvePoint,
    test: f64,
    /// What the search leaves in the parameter.
    error: f64,
}

impl Tests {
    pub(super) fn of(map: Option<&DMatrix<f64>>, slope: f64) -> Self {
        let determinant = |shift: f64| {
            map.map_or(f64::NAN, |map| {
                let shifted = map + DMatrix::identity(map.nrows(), map.ncols()) * shift;
                shifted.determinant()
            })
        };
        let (pairs, complex) = map.map_or((f64::NAN, false), product_of_pairs);
        Self {
            slope,
            minus: determinant(-1.0),
            plus: determinant(1.0),
            pairs,
            complex,
        }
    }

    fn value(&self, test: Test) -> f64 {
        match test {
            Test::Slope => self.slope,
            Test::Minus => self.minus,
            Test::Plus => self.plus,
            Test::Pairs => self.pairs,
        }
    }

    /// What changes its sign from one orbit to the next. Without maps every turn counts as a fold.
    pub(super) fn changes(a: Self, b: Self, half: bool) -> Vec<Change> {
        let turned = (a.slope < 0.0) != (b.slope < 0.0);
        let minus = a.minus * b.minus < 0.0;
        let known = !a.minus.is_nan() && !b.minus.is_nan();
        let mut changes = Vec::new();
        if turned {
            let kind = if minus || !known {
                EventKind::Fold
            } else {
                EventKind::BranchPoint
            };
            let test = Test::Slope;
            changes.push(Change { test, kind });
        } else if minus {
            changes.push(Change::BRANCHES);
        }
        if a.plus * b.plus < 0.0 {
            let kind = if half {
                EventKind::SymmetryBreaking
            } else {
                EventKind::PeriodDoubling
            };
            let test = Test::Plus;
            changes.push(Change { test, kind });
        }
        // A pair of real ones whose product is one is nothing special.
        if a.pairs * b.pairs < 0.0 && a.complex && b.complex {
            changes.push(Change {
                test: Test::Pairs,
                kind: EventKind::NeimarkSacker,
            });
        }
        changes
    }
}

/// What the other multipliers make of a determinant that vanishes with the one nearest to a critical value, and of its rounding.
fn others(equations: &mut Equations<'_>, u: &[f64], critical: f64) -> f64 {
    let Ok(map) = equations.map(u, &mut |_| {}) else {
        return 1.0;
    };
    let mut distances: Vec<f64> = eigenvalues(&map)
        .iter()
        .map(|m| (m - critical).norm())
        .collect();
    distances.sort_by(f64::total_cmp);
    let product: f64 = distances.iter().skip(1).product();
    let largest = distances.last().copied().unwrap_or(1.0);
    product.max(1.0) * largest.max(1.0)
}

/// The product of `mu_i mu_j - 1` over all pairs, and whether the pair whose product is nearest to one is complex.
fn product_of_pairs(map: &DMatrix<f64>) -> (f64, bool) {
    let values = eigenvalues(map);
    let mut product = Complex::new(1.0, 0.0);
    let mut nearest = (f64::INFINITY, false);
    for (i, a) in values.iter().enumerate() {
        for b in &values[i + 1..] {
            let factor = a * b - 1.0;
            product *= factor;
            if factor.norm() < nearest.0 {
                nearest = (factor.norm(), a.im != 0.0 && b.im != 0.0);
            }
        }
    }
    (product.re, nearest.1)
}

impl<'a> Run<'_, 'a> {
    /// Locates the grazing between two points whose orbits cross levels a different number of times.
    pub(super) fn grazing(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
    ) {
        let after = self.cycles.len() - 1;
        let many = self.cycles[after - 1].switches;
        let half = if equations.span.half { 2 } else { 1 };
        let Ok(other) = equations.again(self.setting) else {
            return;
        };
        let other = RefCell::new(other);
        // The last points on either side, as near to the place as was looked.
        let nearest = RefCell::new([between.0.clone(), between.1.clone()]);
        let side = |point: &CurvePoint| {
            let mut other = other.borrow_mut();
            let before = other.flow.work().switches;
            let counted = other.trace(&point.u, &mut |_| {});
            let switches = half * (other.flow.work().switches - before);
            let behind = counted.is_err() || switches != many;
            nearest.borrow_mut()[usize::from(behind)] = point.clone();
            if behind { -1.0 } else { 1.0 }
        };
        // Near the place Newton's method may fail: then what is known is the bracket.
        let _ = locate(equations, newton, between, self.options, 0.0, side);
        add(&mut self.work, other.borrow().flow.work());
        let [before, behind] = nearest.into_inner();
        let Ok((cycle, _)) = observe(self.setting, equations, &before.u) else {
            let (value, test) = (before.parameter(), f64::NAN);
            self.turns.push(Turn { value, test, after });
            return;
        };
        // The orbits have the error of the flow: it is taken from states to the parameter by what both change in the step.
        let change = (between.1.parameter() - between.0.parameter()).abs();
        let rate = change / equations.apart(&between.0.u, &between.1.u);
        let bracket = (behind.parameter() - before.parameter()).abs();
        let error = bracket + self.cycles[after].error * rate + TOUCHED * cycle.value.abs();
        self.events.push(CycleEvent {
            kind: EventKind::Grazing {
                turns: before.parameter_slope() * behind.parameter_slope() < 0.0,
            },
            cycle,
            error,
            test: 1.0,
            after,
        });
    }

    /// Locates an event between two points.
    pub(super) fn event(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        change: Change,
    ) {
        let options = self.options;
        // The point behind the event has been stored already, unless it is on the branch that this one joins.
        let after = self.cycles.len() - usize::from(self.joined.is_none());
        let place = self.place(equations, newton, between, options, change, VANISHED);
        let Some(place) = place else {
            let value = 0.5 * (between.0.parameter() + between.1.parameter());
            let test = f64::NAN;
            self.turns.push(Turn { value, test, after });
            return;
        };
        let (value, test) = (place.point.parameter(), place.test);
        // A slope is relative to the range, and rounding to the value.
        let unit = match change.test {
            Test::Slope => (value.abs() / place.point.scale.parameter).max(1.0),
            Test::Minus => others(equations, &place.point.u, 1.0),
            Test::Plus => others(equations, &place.point.u, -1.0),
            Test::Pairs => 1.0,
        };
        let vanishes = test.abs() <= self.setting.vanishing(equations.frame.ratio) * unit;
        let event = vanishes.then(|| self.event_at(equations, between, change, &place));
        match event.flatten() {
            Some(event) => self.events.push(CycleEvent { after, ..event }),
            None => self.turns.push(Turn { value, test, after }),
        }
    }

    /// Where a test function of these equations vanishes.
    fn place(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        options: NewtonOptions,
        change: Change,
        vanished: f64,
    ) -> Option<Place> {
        // The problem is busy while a test function is evaluated.
        let other = RefCell::new(equations.again(self.setting).ok()?);
        let value = |point: &CurvePoint| {
            if change.test == Test::Slope {
                return point.parameter_slope();
            }
            let map = other.borrow_mut().map(&point.u, &mut |_| {}).ok();
            Tests::of(map.as_ref(), 0.0).value(change.test)
        };
        let place = if change.kind == EventKind::BranchPoint {
            locate_crossing(equations, newton, between, options, value).map(|crossing| Place {
                point: crossing.point,
                test: crossing.test,
                error: crossing.error,
            })
        } else {
            locate(equations, newton, between, options, vanished, value).map(|located| Place {
                point: located.point,
                test: located.test,
                error: 0.0,
            })
        };
        add(&mut self.work, other.borrow().flow.work());
        place
    }

    /// The event at a place, compared with that of the companion.
    fn event_at(
        &mut self,
        equations: &mut Equations<'a>,
        between: (&CurvePoint, &CurvePoint),
        change: Change,
        place: &Place,
    ) -> Option<CycleEvent> {
        let (span, frame) = (equations.span, equations.frame.clone());
        let size = between.0.scale.oscillation;
        let Companion {
            equations: mut others,
            mut newton,
            options,
            part,
            exact,
            noise,
        } = Companion::new(self.setting, span, frame, size).ok()?;
        let moved = self.place(&mut others, &mut newton, between, options, change, VANISHED);
        self.statistics += newton.statistics;
        let (event, test) = match &moved {
            None => {
                let (cycle, _) = observe(self.setting, equations, &place.point.u).ok()?;
                ((cycle, f64::INFINITY), place.test)
            }
            Some(moved) => {
                let (here, there) = ((equations, place), (&mut others, moved));
                // What is reported is the finer one, or the one that is not disturbed.
                let (best, other) = if exact { (here, there) } else { (there, here) };
                let test = best.1.test;
                (
                    compared(self.setting, change.kind, best, other, (part, noise))?,
                    test,
                )
            }
        };
        add(&mut self.work, others.flow.work());
        let (cycle, error) = event;
        Some(CycleEvent {
            kind: change.kind,
            cycle,
            error,
            test,
            after: 0,
        })
    }
}

/// An event of some equations with its errors, and the error of its value: a part of what it is in others.
fn compared(
    setting: &Setting<'_>,
    kind: EventKind,
    (equations, place): (&mut Equations<'_>, &Place),
    (others, moved): (&mut Equations<'_>, &Place),
    (part, noise): (f64, f64),
) -> Option<(Cycle, f64)> {
    let half = equations.span.half;
    let u = &place.point.u;
    let (mut cycle, map) = observe(setting, equations, u).ok()?;
    let by = (moved.point.parameter() - cycle.value).abs();
    let error = part * by + place.error + moved.error + ROUNDING * cycle.value.abs();
    cycle.error = part * equations.apart(u, &moved.point.u);
    if let Some(map) = map {
        let found = multipliers(&map, half);
        let there = others.map(&moved.point.u, &mut |_| {}).ok()?;
        let there = multipliers(&there, half);
        // One of them is known.
        let critical = match kind {
            EventKind::PeriodDoubling => -1.0,
            _ => 1.0,
        };
        let nearest = found.iter().map(|m| match kind {
            EventKind::NeimarkSacker => (m.norm() - 1.0).abs(),
            _ => (m - critical).norm(),
        });
        let spread = part * distance(&found, &there)
            + nearest.fold(f64::INFINITY, f64::min)
            + companion::moved(&map, &found, half, noise * map.norm().max(1.0));
        cycle.stability = Stability::of(found, spread);
    }
    Some((cycle, error))
}
