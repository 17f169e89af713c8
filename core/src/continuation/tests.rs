//! Curves whose folds are known.

use std::ops::ControlFlow;

use super::follow::{FollowOptions, Outcome, Start, Stop, Visit, follow};
use super::problem::Problem;
use super::step::StepControl;
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
