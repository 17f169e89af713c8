//! A branch of algebraic equations, all of whose events are known:
//!
//! ```text
//! x^3 - 3 x = lambda,     y (x - 3/2) - y^3 = 0,     z = x^2 (only on a part of the branch)                         (1)
//! ```
//!
//! On the branch `y = 0` there are folds at `x = -1` and `1`, and the branch `y^2 = x - 3/2` crosses at `x = 3/2`. A function that
//! vanishes at `x = 1/2` plays a doubling, and one that vanishes at `x = 1.70` and `1.71` two of them within a step. Other functions stand
//! in the place of the cubic where the branch is to be vertical.

use nalgebra::DMatrix;

use super::run;
use crate::branches::branch_start::BranchSwitch;
use crate::branches::observed::Observed;
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::branches::problem::{
    BranchProblem, Change, Read, TestValue, Watched, Zero, ZeroOutcome,
};
use crate::branches::record::Record;
use crate::branches::recurrence::SignedPermutation;
use crate::branches::stability::Stability;
use crate::branches::value::{Chord, chain, solutions};
use crate::continuation::follow::{CurvePoint, FollowOptions, Halted, Start, Step, Stop};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::{Problem, Scale};
use crate::continuation::step_control::StepControl;
use crate::event::EventKind;

const WATCHED: [Watched; 3] = [
    Watched {
        kind: EventKind::BranchPoint,
        bordered: true,
    },
    Watched {
        kind: EventKind::PeriodDoubling,
        bordered: false,
    },
    Watched {
        kind: EventKind::NeimarkSacker,
        bordered: false,
    },
];

/// What the parameter is of `x`, and its slope.
type Shape = fn(f64) -> (f64, f64);

fn cubic(x: f64) -> (f64, f64) {
    (x * x * x - 3.0 * x, 3.0 * x * x - 3.0)
}

struct Algebraic {
    shape: Shape,
    /// Whether `z` is an unknown.
    three: bool,
    /// Behind the first fold other unknowns are asked for, in which the orbit before has no place.
    displaces: bool,
    /// Behind so many points a step is too far, and from there on nothing is found while `z` is an unknown.
    breaks: Option<usize>,
    broken: bool,
    record: Record,
}

impl Algebraic {
    fn of(shape: Shape) -> Self {
        Self {
            shape,
            three: false,
            displaces: false,
            breaks: None,
            broken: false,
            record: Record::default(),
        }
    }

    fn solutions(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.record.points.iter().map(|point| &point.parameters)
    }

    /// What happened, with `x` there.
    fn events(&self) -> Vec<(EventKind, f64)> {
        let events = self.record.events.iter();
        events
            .map(|event| (event.kind, event.point.parameters[0]))
            .collect()
    }
}

impl Problem for Algebraic {
    fn unknowns(&self) -> usize {
        if self.three { 3 } else { 2 }
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let (x, y, parameter) = (u[0], u[1], u[u.len() - 1]);
        let (value, slope) = (self.shape)(x);
        let found = !(self.broken && self.three);
        residual[0] = if found { value - parameter } else { f64::NAN };
        residual[1] = y * (x - 1.5) - y * y * y;
        if self.three {
            residual[2] = u[2] - x * x;
        }
        let Some(jacobian) = jacobian else { return };
        jacobian.core_mut().row_mut(0)[0] = slope;
        jacobian.core_mut().row_mut(1)[0] = y;
        jacobian.core_mut().row_mut(1)[1] = x - 1.5 - 3.0 * y * y;
        let mut column = vec![0.0; self.unknowns()];
        column[0] = -1.0;
        if self.three {
            jacobian.core_mut().row_mut(2)[0] = -2.0 * x;
            jacobian.core_mut().row_mut(2)[2] = 1.0;
        }
        jacobian.set_column(&column);
    }

    fn weights(&self, weights: &mut [f64]) {
        weights.fill(1.0);
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }
}

impl BranchProblem for Algebraic {
    fn equations(&mut self) -> &mut dyn Problem {
        self
    }

    fn watched(&self) -> &[Watched] {
        &WATCHED
    }

    fn test(&mut self, index: usize, at: &CurvePoint) -> TestValue {
        let (x, y) = (at.u[0], at.u[1]);
        TestValue::plain(match index {
            // z = x^2 has one on its diagonal, and adds to the border what x has.
            0 => {
                let [t, s, l] = [0, 1, at.u.len() - 1].map(|i| at.tangent[i]);
                let t = if self.three {
                    t + 2.0 * x * at.tangent[2]
                } else {
                    t
                };
                let rows = [
                    [(self.shape)(x).1, 0.0, -1.0],
                    [y, x - 1.5 - 3.0 * y * y, 0.0],
                    [t, s, l],
                ];
                DMatrix::from_fn(3, 3, |i, j| rows[i][j]).determinant()
            }
            1 => x - 0.5,
            _ => (x - 1.70) * (x - 1.71),
        })
    }

    fn aim(&self) -> f64 {
        1e-12
    }

    fn vanishes(&mut self, _: Change, located: &Located) -> bool {
        located.test.abs() <= 1e-9
    }

    fn record(&self) -> &Record {
        &self.record
    }

    fn record_mut(&mut self) -> &mut Record {
        &mut self.record
    }

    fn read(&mut self, _: &mut Newton, at: &CurvePoint) -> Read {
        if self.displaces && at.u[0] > -1.0 {
            return Read::Refused;
        }
        if self.breaks == Some(self.points()) && !self.broken {
            self.broken = true;
            return Read::TooFar;
        }
        self.record.points.push(orbit(&at.u));
        // From here on, and for a while.
        if [20, 60].contains(&self.points()) {
            Read::Resize
        } else {
            Read::Kept
        }
    }

    fn keep(&mut self, _: &mut Newton, _: Step<'_>, zero: &Zero) -> ZeroOutcome {
        self.record.events.push(Event {
            kind: zero.change.kind,
            point: orbit(&zero.root.located.point.u),
            error: zero.root.error,
            test: zero.root.located.test,
            after: zero.after,
            contacts: 0,
            tangent: Vec::new(),
        });
        ZeroOutcome::Event
    }

    fn remap(&mut self, halted: &mut Halted) {
        self.three = !self.three;
        for vector in halted.vectors() {
            if self.three {
                vector.insert(2, 0.0);
            } else {
                vector.remove(2);
            }
        }
        if self.displaces && halted.point.u[0] > -1.0 {
            self.displaces = false;
            halted.previous = None;
        }
    }

    fn revert(&mut self) {
        self.three = !self.three;
    }

    fn count(&mut self, _: &Newton) {}
}

/// A solution as an orbit that does not move.
fn orbit(u: &[f64]) -> Point {
    Point {
        value: u[u.len() - 1],
        parameters: u.to_vec(),
        orbit: Orbit {
            series: Vec::new(),
            states: vec![u[0], 0.0],
            coordinates: 1,
            omega: 1.0,
            base: 1.0,
            period: 1,
            parts: 1,
            symmetric: false,
            image: SignedPermutation::identity(),
        },
        stability: Stability::unknown(),
        observed: Observed::extremes(Vec::new(), 0),
        error: None,
    }
}

const NEWTON: NewtonOptions = NewtonOptions {
    tolerance: 1e-11,
    iterations: 12,
    damped: false,
};

fn followed(from: f64, to: f64, start: Start) -> (Algebraic, Stop) {
    followed_of(cubic, from, to, start)
}

fn followed_of(shape: Shape, from: f64, to: f64, start: Start) -> (Algebraic, Stop) {
    followed_by(Algebraic::of(shape), from, to, start)
}

fn followed_by(mut branch: Algebraic, from: f64, to: f64, start: Start) -> (Algebraic, Stop) {
    let options = FollowOptions {
        from,
        to,
        points: 2000,
        steps: StepControl::default(),
        newton: NEWTON,
    };
    let stop = run(&mut branch, start, options).unwrap();
    (branch, stop)
}

/// All of them in both directions, while the number of unknowns changes twice.
#[test]
fn every_event_is_found_where_it_is() {
    let known = [
        (EventKind::Fold, -1.0),
        (EventKind::PeriodDoubling, 0.5),
        (EventKind::Fold, 1.0),
        (EventKind::BranchPoint, 1.5),
        (EventKind::NeimarkSacker, 1.70),
        (EventKind::NeimarkSacker, 1.71),
    ];
    for (from, to, x) in [(-8.0, 8.0, -2.4), (8.0, -8.0, 2.4)] {
        let (branch, stop) = followed(from, to, Start::Near(vec![x, 0.0, from]));
        assert_eq!(
            (stop, &branch.record.turns[..]),
            (Stop::ReachedEnd, &[][..])
        );
        assert!(branch.solutions().any(|u| u.len() == 4));
        let mut events = branch.events();
        events.sort_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(events.len(), known.len(), "{events:?}");
        for ((kind, at), (wanted, exact)) in events.iter().zip(known) {
            assert!(
                *kind == wanted && (at - exact).abs() < 1e-9,
                "{kind} at {at}"
            );
        }
    }
}

/// A step whose first orbit has no place in the unknowns of its last one cannot be looked at: that the branch turned in it is said.
#[test]
fn a_turn_in_a_step_that_is_not_seen_is_said() {
    let branch = Algebraic {
        displaces: true,
        ..Algebraic::of(cubic)
    };
    let (branch, stop) = followed_by(branch, -8.0, 8.0, Start::Near(vec![-2.4, 0.0, -8.0]));
    assert_eq!(stop, Stop::ReachedEnd);
    let [turn] = branch.record.turns[..] else {
        panic!("{:?}", branch.record.turns);
    };
    assert!(turn.kind == EventKind::Fold && turn.test.is_nan());
    // The cubic is two at its fold, and its orbits before and behind are known.
    let ends = &branch.record.points[turn.after - 1..=turn.after];
    assert!(ends[0].parameters[0] < -1.0 && ends[1].parameters[0] > -1.0);
    assert!((turn.value - 2.0).abs() < 0.1, "{turn:?}");
    let folds = branch.events().into_iter();
    let folds: Vec<_> = folds.filter(|event| event.0 == EventKind::Fold).collect();
    assert!(folds.len() == 1 && (folds[0].1 - 1.0).abs() < 1e-9);
}

/// Other unknowns have led on from the point at which they were gone over to, by five points, before a walk goes back by one of these and finds nothing there. The former
/// unknowns belong to a point that was passed long before: the walk ends where it is.
#[test]
fn a_walk_that_finds_nothing_where_it_went_back_ends_there() {
    let branch = Algebraic {
        breaks: Some(25),
        ..Algebraic::of(cubic)
    };
    let (branch, stop) = followed_by(branch, -8.0, 8.0, Start::Near(vec![-2.4, 0.0, -8.0]));
    assert!(matches!(stop, Stop::StepTooShort { .. }), "{stop:?}");
    assert!(branch.broken && branch.three);
    // The cubic is followed from left to right, and no point twice.
    let places: Vec<f64> = branch.solutions().map(|u| u[0]).collect();
    assert_eq!(places.len(), 25);
    assert!(places.windows(2).all(|pair| pair[0] < pair[1]));
}

/// Between the folds the branch has three solutions at a value.
#[test]
fn solutions_at_a_value_are_the_roots_of_the_cubic() {
    let (branch, _) = followed(-8.0, 8.0, Start::Near(vec![-2.4, 0.0, -8.0]));
    let [x, y] = [-1.0, 1.0].map(|x: f64| vec![x, 0.0, x * x * x - 3.0 * x]);
    let plain = |u: &[f64]| vec![u[0], u[1], u[u.len() - 1]];
    let points: Vec<Vec<f64>> = branch.solutions().map(|u| plain(u)).collect();
    let after = |fold: f64| points.iter().filter(|u| u[0] < fold).count();
    let turns = [(after(-1.0), &x), (after(1.0), &y)];
    let found = solutions(
        &chain(&points, &turns),
        1.0,
        |u| u[2],
        |[a, b]| {
            let mut problem = Algebraic::of(cubic);
            let mut newton = Newton::new(&problem);
            let chord = Chord {
                ends: [a.clone(), b.clone()],
                range: 16.0,
                tolerance: 1e-13,
            };
            let found = chord.at(&mut problem, &mut newton, 1.0, NEWTON);
            found.map(|found| found.point.u).ok_or(())
        },
        |a, b| (a[0] - b[0]).abs() < 1e-9,
    );
    // x^3 - 3 x = 1 has the roots 2 cos(pi/9 + 2 pi k/3).
    let exact = [7, 5, 1].map(|k| 2.0 * (f64::from(k) * std::f64::consts::PI / 9.0).cos());
    let found = found.unwrap();
    assert_eq!(found.len(), exact.len());
    for (u, x) in found.iter().zip(exact) {
        assert!((u[0] - x).abs() < 1e-10, "{} {x}", u[0]);
    }
}

/// Onto the other branch, `y^2 = x - 3/2`, on both sides.
#[test]
fn the_branch_that_crosses_is_followed() {
    let from = [1.5, 0.0, 1.5_f64.powi(3) - 4.5];
    let along = [0.0, 1.0, 0.0];
    for side in [-1.0, 1.0] {
        let mut problem = Algebraic::of(cubic);
        let mut newton = Newton::new(&problem);
        let switch = BranchSwitch {
            from: &from,
            along: &along,
            held: &along,
            scale: Scale::UNIT,
        };
        let step = 0.01 * side;
        let first = switch.first_point(&mut problem, &mut newton, step, NEWTON);
        let start = Start::Along(Box::new(first.unwrap()));
        let (branch, stop) = followed(from[2], 8.0, start);
        assert_eq!(stop, Stop::ReachedEnd);
        for u in branch.solutions() {
            assert!((u[1] * u[1] - (u[0] - 1.5)).abs() < 1e-10 && u[1] * side > 0.0);
        }
    }
}

/// The branch that crosses turns where it does: one place, and not a fold. The doublings play on both sides of it.
#[test]
fn a_branch_that_turns_where_another_crosses_has_one_event_there() {
    let from = 2.5_f64.powi(3) - 7.5;
    let (branch, stop) = followed(from, -8.0, Start::Near(vec![2.5, -1.0, from]));
    assert_eq!(
        (stop, &branch.record.turns[..]),
        (Stop::LeftAtStart, &[][..])
    );
    let known = [
        (EventKind::NeimarkSacker, 1.71),
        (EventKind::NeimarkSacker, 1.70),
        (EventKind::BranchPoint, 1.5),
        (EventKind::NeimarkSacker, 1.70),
        (EventKind::NeimarkSacker, 1.71),
    ];
    let events = branch.events();
    assert_eq!(events.len(), known.len(), "{events:?}");
    for ((kind, at), (wanted, exact)) in events.iter().zip(known) {
        assert!(
            *kind == wanted && (at - exact).abs() < 1e-8,
            "{kind} at {at}"
        );
    }
}

/// Distance from the stretch from -1 to 1, and a slope there that is nothing but rounding.
fn from_stretch(x: f64) -> (f64, f64) {
    (x - x.clamp(-1.0, 1.0), 1e-14 * (1e7 * x).sin())
}

/// A branch that is vertical over a stretch, and goes on as it came.
#[test]
fn a_vertical_stretch_has_no_folds() {
    let shape = |x| {
        let (d, rounding) = from_stretch(x);
        (d * d * d, 3.0 * d * d + rounding)
    };
    for end in [-2.0, 2.0] {
        let start = Start::Near(vec![1.0_f64.copysign(end) + end, 0.0, end * end * end]);
        let (branch, stop) = followed_of(shape, end * end * end, -end * end * end, start);
        assert_eq!(
            (stop, &branch.record.turns[..]),
            (Stop::ReachedEnd, &[][..])
        );
        let inside = branch.solutions().filter(|u| u[0].abs() < 1.0);
        assert!(inside.count() > 3);
        let mut events = branch.events().into_iter();
        assert_eq!(events.find(|(kind, _)| *kind == EventKind::Fold), None);
    }
}

/// A branch that is vertical over a stretch, and goes back as it came.
#[test]
fn a_branch_that_turns_at_a_vertical_stretch_has_one_fold_there() {
    let shape = |x| {
        let (d, rounding) = from_stretch(x);
        (-d * d, -2.0 * d + rounding)
    };
    for end in [-2.0, 2.0] {
        let start = Start::Near(vec![1.0_f64.copysign(end) + end, 0.0, -end * end]);
        let (branch, stop) = followed_of(shape, -end * end, 8.0, start);
        assert_eq!(
            (stop, &branch.record.turns[..]),
            (Stop::LeftAtStart, &[][..])
        );
        let mut folds = branch.events();
        folds.retain(|(kind, _)| *kind == EventKind::Fold);
        let [(_, x)] = folds[..] else {
            panic!("{folds:?}");
        };
        assert!(x.abs() < 1.0 + 1e-9, "{x}");
    }
}
