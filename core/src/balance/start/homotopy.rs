//! Homotopies: the wanted orbit at the end of a branch whose beginning is easy to find.
//!
//! In the *drive*: the orbit is followed from rest while the oscillating load grows from nothing. In the *frequency*: inertia
//! prevails at high frequencies, so that an orbit is easily found there, and followed down to the frequency wanted.
//!
//! Source: Allgower and Georg (1990), Introduction to Numerical Continuation Methods, chapter 1 (embedding).

use std::ops::ControlFlow;

use super::effort::Effort;
use super::fixed::{Fixed, spread};
use super::{StartRequest, at_rest, near};
use crate::balance::{Balance, Resolution};
use crate::continuation::follow::{FollowOptions, Halt, Start, Visit, follow};
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::continuation::step_control::StepControl;
use crate::system::Variable;

/// Points of a branch, at most.
const POINTS: usize = 2000;
/// Largest step, in parts of the size of the unknowns: only the end counts, and the angle between tangents keeps to the branch.
const STEP: f64 = 0.4;
/// Multiples of the frequency wanted at which a branch is begun.
const HIGHER: [f64; 4] = [1.3, 2.0, 4.0, 10.0];

/// Follows the orbit from rest while the drive grows from nothing.
pub(super) fn in_drive(
    request: StartRequest<'_>,
    rest: &[f64],
    effort: &mut Effort,
) -> Option<Vec<f64>> {
    let request = coupled(request);
    let mut fixed = Fixed::new(request, request.resolution.harmonics);
    let mut u = spread(rest, &fixed);
    let last = u.len() - 1;
    let mut oscillating = vec![0.0; last];
    fixed.balance.set(fixed.value);
    fixed
        .balance
        .add_load(fixed.balance.coefficients(), -1.0, &mut oscillating);
    fixed.balance.set_drive_factor(0.0);
    fixed
        .balance
        .add_load(fixed.balance.coefficients(), 1.0, &mut oscillating);
    let mut problem = Drive {
        balance: fixed.balance,
        value: request.value,
        extended: u.clone(),
        held: u.clone(),
        oscillating,
    };
    u[last] = 0.0;
    let mut end = followed(&mut problem, fixed.newton, u, [0.0, 1.0], request, effort)?;
    end[last] = request.value;
    Some(end)
}

/// Follows an orbit down from a higher frequency.
pub(super) fn in_frequency(request: StartRequest<'_>, effort: &mut Effort) -> Option<Vec<f64>> {
    let wanted = match request.variable {
        Variable::Omega => request.value,
        Variable::Parameter(_) => request.omega,
    };
    HIGHER.into_iter().find_map(|times| {
        let begun = StartRequest {
            omega: times * wanted,
            variable: Variable::Omega,
            value: times * wanted,
            ..coupled(request)
        };
        if effort.is_spent() {
            return None;
        }
        let rest = at_rest(begun, effort);
        let u = near(begun, &rest, effort).ok()?;
        let Fixed {
            mut balance,
            newton,
            ..
        } = Fixed::new(begun, request.resolution.harmonics);
        let range = [begun.value, wanted];
        let mut end = followed(&mut balance, newton, u, range, request, effort)?;
        let last = end.len() - 1;
        end[last] = request.value;
        Some(end)
    })
}

/// With all harmonics coupled: this is tried where a start is hard, and a step that the tail spoils costs more than it saves.
fn coupled(request: StartRequest<'_>) -> StartRequest<'_> {
    let resolution = Resolution {
        core: request.resolution.harmonics,
        ..request.resolution
    };
    StartRequest {
        resolution,
        ..request
    }
}

/// The end of a branch, if it reaches the end of its range with the work allowed.
fn followed<P: Problem>(
    problem: &mut P,
    mut newton: Newton,
    start: Vec<f64>,
    [from, to]: [f64; 2],
    request: StartRequest<'_>,
    effort: &mut Effort,
) -> Option<Vec<f64>> {
    let options = FollowOptions {
        from,
        to,
        points: POINTS,
        steps: StepControl::with_largest(STEP),
        newton: NewtonOptions {
            iterations: 12,
            damped: false,
            ..request.newton
        },
    };
    let mut end = None;
    let outcome = follow(
        problem,
        &mut newton,
        Start::Near(start),
        options,
        &mut |_, newton, visit| {
            if let Visit::Point(point) = visit
                && point.parameter() == to
            {
                end = Some(point.u.clone());
            }
            effort.take(newton);
            if effort.is_spent() {
                ControlFlow::Break(Halt::Stop)
            } else {
                ControlFlow::Continue(())
            }
        },
    );
    effort.take(&mut newton);
    outcome.ok().and(end)
}

/// The balance at a fixed value, as a function of the factor of its drive.
struct Drive<'a> {
    balance: Balance<'a>,
    value: f64,
    /// Workspace for extended unknowns, and for a direction.
    extended: Vec<f64>,
    held: Vec<f64>,
    /// The oscillating load with its sign in the residual: the derivative by the factor.
    oscillating: Vec<f64>,
}

impl Drive<'_> {
    /// Takes the unknowns at the fixed value, and the factor.
    fn take(&mut self, u: &[f64]) {
        let n = self.balance.unknowns();
        self.extended[..n].copy_from_slice(&u[..n]);
        self.extended[n] = self.value;
        self.balance.set_drive_factor(u[n]);
    }
}

impl Problem for Drive<'_> {
    fn unknowns(&self) -> usize {
        self.balance.unknowns()
    }

    fn partition(&self) -> Partition {
        self.balance.partition()
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        self.take(u);
        let Some(jacobian) = jacobian else {
            self.balance.evaluate(&self.extended, residual, None);
            return;
        };
        self.balance
            .evaluate(&self.extended, residual, Some(&mut *jacobian));
        jacobian.set_column(&self.oscillating);
    }

    fn apply(&mut self, u: &[f64], direction: &[f64], derivative: &mut [f64]) {
        let n = self.balance.unknowns();
        self.take(u);
        self.held[..n].copy_from_slice(&direction[..n]);
        self.held[n] = 0.0;
        self.balance.apply(&self.extended, &self.held, derivative);
        for (to, by) in derivative.iter_mut().zip(&self.oscillating) {
            *to += by * direction[n];
        }
    }

    fn terms(&mut self, u: &[f64], terms: &mut [f64]) -> bool {
        self.take(u);
        self.balance.terms(&self.extended, terms)
    }

    fn weights(&self, weights: &mut [f64]) {
        self.balance.weights(weights);
    }

    fn is_mean(&self, unknown: usize) -> bool {
        self.balance.is_mean(unknown)
    }

    fn is_cancelled(&self) -> bool {
        self.balance.is_cancelled()
    }

    fn operations(&self) -> u64 {
        self.balance.operations()
    }
}
