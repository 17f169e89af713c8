//! Curves whose folds are known.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::crossing::locate_crossing;
use super::follow::{CurvePoint, FollowOptions, Outcome, Start, Step, Stop, Visit, follow};
use super::problem::{Problem, Scale};
use super::step_control::StepControl;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::newton::{Newton, NewtonOptions};

/// `lambda = x - 1.5 w tanh((x - c) / w)`: a line with a pair of folds at `c +- 0.658 w`, where the slope vanishes.
struct Bend {
    centre: f64,
    width: f64,
}

impl Problem for Bend {
    fn unknowns(&self) -> usize {
        1
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let tanh = ((u[0] - self.centre) / self.width).tanh();
        residual[0] = u[0] - 1.5 * self.width * tanh - u[1];
        if let Some(jacobian) = jacobian {
            jacobian.core_mut().row_mut(0)[0] = 1.0 - 1.5 * (1.0 - tanh * tanh);
            jacobian.set_column(&[-1.0]);
        }
    }

    fn weights(&self, weights: &mut [f64]) {
        weights[0] = 1.0;
    }

    fn is_mean(&self, _unknown: usize) -> bool {
        false
    }
}

/// How often the branch turns between zero and one, and its points.
fn turns(mut problem: Bend) -> (usize, usize) {
    let mut newton = Newton::new(&problem);
    let options = FollowOptions {
        from: 0.0,
        to: 1.0,
        points: 10_000,
        steps: StepControl::default(),
        newton: NewtonOptions {
            tolerance: 1e-9,
            iterations: 12,
            damped: false,
        },
    };
    let (mut turns, mut points) = (0, 0);
    let start = Start::Near(vec![0.0, 0.0]);
    let outcome = follow(
        &mut problem,
        &mut newton,
        start,
        options,
        &mut |_, _, seen| {
            match seen {
                Visit::Between(a, b) => {
                    turns +=
                        usize::from((a.parameter_slope() < 0.0) != (b.parameter_slope() < 0.0));
                }
                Visit::Onward(_) => {}
                _ => points += 1,
            }
            ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_ok());
    (turns, points)
}

/// Bends down to the length of a step, wherever the steps happen to fall.
#[test]
fn a_pair_of_folds_is_not_stepped_over() {
    for width in [0.01, 0.02, 0.04] {
        for index in 0..200 {
            let centre = 0.5 + 0.1 * f64::from(index) / 200.0;
            let (turns, points) = turns(Bend { centre, width });
            assert_eq!(turns, 2, "width {width}, centre {centre}");
            assert!(points < 400, "{points}");
        }
    }
}

/// A first step over a fold and out of the range ends at the orbit on the other limb, not at the first one again.
#[test]
fn a_branch_that_turns_at_its_start_ends_on_the_other_limb() {
    let mut problem = Bend {
        centre: 0.5,
        width: 0.04,
    };
    // The fold is where tanh^2 is a third.
    let fold = 0.5 - 0.04 * (1.0_f64 / 3.0).sqrt().atanh();
    let first = fold - 0.001;
    let from = first + 0.06 * ((0.5 - first) / 0.04).tanh();
    let mut newton = Newton::new(&problem);
    let options = FollowOptions {
        from,
        to: 1.0,
        points: 100,
        steps: StepControl::default(),
        newton: NewtonOptions {
            tolerance: 1e-9,
            iterations: 12,
            damped: false,
        },
    };
    let (mut last, mut ends) = (first, Vec::new());
    let start = Start::Near(vec![first, from]);
    let outcome = follow(
        &mut problem,
        &mut newton,
        start,
        options,
        &mut |_, _, seen| {
            match seen {
                Visit::Between(a, b) => ends.push((a.parameter_slope(), b.parameter_slope())),
                Visit::Point(point) | Visit::Again(point) => last = point.u[0],
                Visit::Failed(..) | Visit::Onward(_) => {}
            }
            ControlFlow::Continue(())
        },
    );
    assert!(matches!(outcome, Ok(Outcome::Stopped(Stop::LeftAtStart))));
    assert!(last > fold && last - fold < 0.002, "{last}");
    assert_eq!(ends.len(), 1);
    assert!(ends[0].0 > 0.0 && ends[0].1 < 0.0, "{ends:?}");
}

/// `(x - 1)^2 + (lambda - 1/2)^2 = radius^2`: a curve that closes.
struct Circle {
    radius: f64,
}

impl Problem for Circle {
    fn unknowns(&self) -> usize {
        1
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let [x, lambda] = [(u[0] - 1.0) / self.radius, (u[1] - 0.5) / self.radius];
        residual[0] = x * x + lambda * lambda - 1.0;
        if let Some(jacobian) = jacobian {
            jacobian.core_mut().row_mut(0)[0] = 2.0 * x / self.radius;
            jacobian.set_column(&[2.0 * lambda / self.radius]);
        }
    }

    fn weights(&self, weights: &mut [f64]) {
        weights[0] = 1.0;
    }

    fn is_mean(&self, _unknown: usize) -> bool {
        false
    }
}

/// Wherever it begins and however few steps it takes, a curve is gone round once.
#[test]
fn a_closed_curve_is_gone_round_once() {
    for radius in [0.02, 0.05, 0.2] {
        for index in 0..40 {
            let begin = TAU * f64::from(index) / 40.0;
            let mut problem = Circle { radius };
            let mut newton = Newton::new(&problem);
            let options = FollowOptions {
                from: 0.0,
                to: 1.0,
                points: 1000,
                steps: StepControl::default(),
                newton: NewtonOptions {
                    tolerance: 1e-9,
                    iterations: 12,
                    damped: false,
                },
            };
            let (sin, cos) = begin.sin_cos();
            let first = CurvePoint {
                u: vec![1.0 + radius * cos, 0.5 + radius * sin],
                tangent: vec![-sin, cos],
                scale: Scale {
                    oscillation: 1.0,
                    mean: 1.0,
                    parameter: 1.0,
                },
            };
            let mut angles = vec![begin];
            let outcome = follow(
                &mut problem,
                &mut newton,
                Start::Along(Box::new(first)),
                options,
                &mut |_, _, seen| {
                    if let Visit::Point(at) | Visit::Again(at) = seen {
                        angles.push((at.u[1] - 0.5).atan2(at.u[0] - 1.0));
                    }
                    ControlFlow::Continue(())
                },
            );
            let turned = |pair: &[f64]| {
                let turned = pair[1] - pair[0];
                turned - TAU * (turned / TAU).round()
            };
            let turned: f64 = angles.windows(2).map(turned).sum();
            assert!(
                matches!(outcome, Ok(Outcome::Stopped(Stop::Closed))),
                "{radius} {begin}"
            );
            assert!(
                (TAU..1.15 * TAU).contains(&turned.abs()),
                "{radius} {begin}: {turned}"
            );
        }
    }
}

/// How much the curve that is followed bends in [`Crossed`].
const BEND: f64 = 10.0;

/// `(x - lambda - BEND lambda^4) (x + lambda + lambda^2 / 2) = 0`: two curves that cross at the origin.
struct Crossed;

/// The first of them, and its slope.
fn followed(lambda: f64) -> [f64; 2] {
    [
        lambda + BEND * lambda.powi(4),
        1.0 + 4.0 * BEND * lambda.powi(3),
    ]
}

impl Problem for Crossed {
    fn unknowns(&self) -> usize {
        1
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let [curve, slope] = followed(u[1]);
        let [own, other] = [u[0] - curve, u[0] + u[1] + 0.5 * u[1] * u[1]];
        residual[0] = own * other;
        if let Some(jacobian) = jacobian {
            jacobian.core_mut().row_mut(0)[0] = own + other;
            jacobian.set_column(&[own * (1.0 + u[1]) - other * slope]);
        }
    }

    fn weights(&self, weights: &mut [f64]) {
        weights[0] = 1.0;
    }

    fn is_mean(&self, _unknown: usize) -> bool {
        false
    }
}

/// The cubic over the step is so far from the curve about the crossing that Newton's method lands on the other one from some places.
#[test]
fn a_crossing_is_located_on_the_branch_that_comes_to_it() {
    let mut problem = Crossed;
    let mut newton = Newton::new(&problem);
    let point = |lambda: f64| {
        let [x, slope] = followed(lambda);
        let length = (1.0 + slope * slope).sqrt();
        CurvePoint {
            u: vec![x, lambda],
            tangent: vec![slope / length, 1.0 / length],
            scale: Scale::UNIT,
        }
    };
    for (from, to) in [(-0.1, 0.2), (-0.2, 0.3), (-0.3, 0.3)] {
        let [before, next] = [from, to].map(point);
        let step = Step {
            before: &before,
            next: &next,
        };
        let options = NewtonOptions {
            tolerance: 1e-12,
            iterations: 12,
            damped: false,
        };
        // Vanishes at the crossing along either curve, so that points of both look alike.
        let test = |_: &mut Crossed, at: &CurvePoint| at.u[1];
        let found = locate_crossing(&mut problem, &mut newton, step, options, test).unwrap();
        let lambda = found.point.parameter();
        assert!(lambda.abs() < 1e-9, "{from} to {to}: {lambda:e}");
        let [x, along] = [found.point.tangent[0], found.point.tangent[1]];
        assert!((x - along).abs() < 1e-6, "{from} to {to}: {x} and {along}");
    }
}
