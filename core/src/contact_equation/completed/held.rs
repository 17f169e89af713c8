//! What holds an orbit where it is solved for again: its value, or beside a fold, where Newton's method at the value leads nowhere or to the other limb,
//! its place along the branch.
//!
//! Of a curve of solutions `u(s)` with the tangent `t` the orbit is the one whose positions `x` at the beginnings of periods are nearest to those that
//! are known, `p`, by steps
//!
//! ```text
//! s = x_t . (p - x) / (x_t . x_t),    x_t = (x(u + e t) - x(u)) / e                                            (1)
//! ```
//!
//! each corrected in the plane across the tangent. The first solution has the product of its unknowns with those of the guess, as a fold does not turn in
//! that.
//!
//! Source: Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (a plane in place of the value).

use crate::branches::point::Point;
use crate::branches::solve;
use crate::contact_equation::compute::{self, AT_START};
use crate::contact_equation::equations::Equations;
use crate::contact_equation::guess::Guess;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::problem::{ContactProblem, FIRST};
use crate::contact_equation::run::{Run, difference_step};
use crate::contact_equation::switches::fits::Fits;
use crate::continuation::newton::{Border, Newton};
use crate::numeric::linear::dot;

/// Steps (1): each squares what is left.
const STEPS: usize = 3;
/// The value may be off by this part of it: at a fold it is known to as much.
const BESIDE: f64 = 1e-7;

/// What holds an orbit.
pub(super) enum Held {
    Value,
    /// The plane across a tangent.
    Along(Vec<f64>),
}

impl Held {
    /// The same in other equations.
    pub(super) fn rearranged(&self, from: &Equations, to: &Equations) -> Self {
        match self {
            Self::Value => Self::Value,
            Self::Along(tangent) => Self::Along(from.rearranged(to, tangent)),
        }
    }

    /// Solves equations from near.
    pub(super) fn solve(&self, equations: &mut Equations, u: &mut [f64]) -> Option<()> {
        let mut newton = Newton::new(equations);
        match self {
            Self::Value => {
                let found = solve::at_value(equations, &mut newton, u, AT_START);
                found.ok().map(|_| ())
            }
            Self::Along(tangent) => across(equations, &mut newton, u, tangent),
        }
    }
}

/// Solves for the orbit in the plane through these unknowns across a direction.
fn across(
    equations: &mut Equations,
    newton: &mut Newton,
    u: &mut [f64],
    direction: &[f64],
) -> Option<()> {
    let scale = solve::scale_at(newton, u);
    let mut row = vec![0.0; u.len()];
    newton.norm().linear_form(scale, direction, &mut row);
    let border = Border {
        row: &row,
        value: dot(&row, u),
    };
    let found = newton.correct(equations, u, border, scale, AT_START);
    found.ok().map(|_| ())
}

/// The orbit of a guess along its branch: equations that fit it, its unknowns, and what holds it.
pub(super) fn along<'p>(
    problem: &'p ContactProblem,
    guess: &Guess<'_>,
) -> Option<(Run<'p>, Vec<f64>, Held)> {
    let point = guess.point;
    let recurrence = point.orbit.recurrence();
    let planned = compute::planned(problem, guess, point.value, FIRST, &recurrence).ok()?;
    let (mut equations, mut u) = (planned.equations, planned.u);
    let mut newton = Newton::new(&equations);
    let direction = u.clone();
    across(&mut equations, &mut newton, &mut u, &direction)?;
    let mut tangent = vec![0.0; u.len()];
    for _ in 0..STEPS {
        newton.tangent(&mut equations, &u, &mut tangent, true);
        let step = nearer(&mut equations, &u, &tangent, point)?;
        for (x, t) in u.iter_mut().zip(&tangent) {
            *x += step * t;
        }
        across(&mut equations, &mut newton, &mut u, &tangent)?;
    }
    let apart = (u[u.len() - 1] - point.value).abs();
    let mut run = Run::new(problem, planned.frame, planned.resolution, equations);
    run.equations.compute(&u, false);
    let fits = !run.equations.failed && run.fits(&u) != Fits::No;
    (fits && apart <= BESIDE * point.value.abs()).then_some((run, u, Held::Along(tangent)))
}

/// (1)
fn nearer(equations: &mut Equations, u: &[f64], tangent: &[f64], point: &Point) -> Option<f64> {
    let step = difference_step(&equations.skeleton, u, tangent);
    let moved: Vec<f64> = u.iter().zip(tangent).map(|(x, t)| x + step * t).collect();
    let [here, there] = [u, &moved].map(|u| {
        equations.compute(u, false);
        positions(equations, point)
    });
    let known = point.orbit.states();
    let known = known.flat_map(|state| &state[..point.orbit.coordinates()]);
    let mut sums = [0.0; 2];
    for ((here, there), known) in here.iter().zip(&there).zip(known) {
        let rate = (there - here) / step;
        sums[0] += rate * (known - here);
        sums[1] += rate * rate;
    }
    let by = sums[0] / sums[1];
    by.is_finite().then_some(by)
}

/// Positions at the beginnings of periods in the orbit of the last pass.
fn positions(equations: &Equations, point: &Point) -> Vec<f64> {
    let states = Motion::of(equations).states_of_parts(point.orbit.states().count());
    let coordinates = point.orbit.coordinates();
    let states = states.chunks_exact(2 * coordinates);
    let positions = states.flat_map(|state| state[..coordinates].iter().copied());
    positions.collect()
}
