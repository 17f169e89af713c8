//! Which way the branch bends that begins at a period doubling, or where a symmetry breaks.
//!
//! At a distance `e` along the critical direction, the orbit of the new branch is at
//!
//! ```text
//! lambda(e) = lambda(0) + k e^2 + O(e^4)                                                                      (1)
//! ```
//!
//! `k` is the cubic coefficient of the normal form but for a positive or negative factor that does not vanish. It is taken from
//! two orbits of the new branch, at `e` and `e / 2`, so that the term of the next order cancels; the third derivatives of the map
//! are not needed, and need not exist. (1) holds as far as no level begins or ceases to be crossed along the branch: where the orbit at
//! `e` has passed such a grazing, a smaller `e` is taken.
//!
//! Source: Kuznetsov (2004), Elements of Applied Bifurcation Theory, sections 4.5 and 9.3 (the generalised flip).

use super::codimension_one::Curve;
use crate::branches::recurrence::SignedPermutation;
use crate::continuation::newton::{Border, Newton};
use crate::continuation::problem::Scale;
use crate::error::Error;
use crate::shooting::branch_switch::direction;
use crate::shooting::equations::Equations;
use crate::shooting::problem::ShootingProblem;
use crate::system::Variable;

/// `e`, in units of the orbit's size: what is left of the next order falls as `e^4`, and the error of the flow grows as `e^-2`.
const DISTANCE: f64 = 2.5e-3;
/// The same for a closed form.
const EXACT: f64 = 6.25e-4;
/// What it is compared with is so many times as far.
const FARTHER: f64 = 2.0;
/// Smaller ones are these parts of it.
const PARTS: [f64; 3] = [1.0, 0.25, 0.0625];

/// Orbits of the new branch, beside those of a curve.
pub(super) struct CubicCoefficient {
    equations: Equations,
    newton: Newton,
    second: Variable,
    /// Of coordinates on the orbits of the curve.
    image: SignedPermutation,
    scale: Scale,
    /// `e`
    distance: f64,
}

impl CubicCoefficient {
    /// Of a curve; at a larger distance to compare with.
    ///
    /// # Errors
    /// If there is no flow.
    pub(super) fn new(
        problem: &ShootingProblem,
        curve: &Curve<'_>,
        farther: bool,
    ) -> Result<Self, Error> {
        let distance = if problem.source.exact {
            EXACT
        } else {
            DISTANCE
        };
        let span = curve.equations.span.doubled();
        let frame = curve.equations.frame.clone();
        let equations = Equations::new(problem, curve.equations.tolerance, span, frame)?;
        Ok(Self {
            newton: Newton::new(&equations),
            equations,
            second: curve.second,
            image: curve.equations.span.recurrence.image.clone(),
            distance: if farther {
                FARTHER * distance
            } else {
                distance
            },
            scale: Scale {
                parameter: curve.units[1],
                oscillation: curve.units[0],
                mean: curve.units[0],
            },
        })
    }

    /// `k` at a point of the curve, whose unknowns end with both parameters.
    pub(super) fn at(
        &mut self,
        problem: &ShootingProblem,
        curve: &Curve<'_>,
        u: &[f64],
    ) -> Option<f64> {
        let last = u.len() - 1;
        self.equations.flow.set(self.second, u[last]).ok()?;
        let states = curve.equations.states_of(&u[..last]);
        let again = self.image.of_states(&states, curve.equations.order() / 2);
        let states = [states, again].concat();
        let u = self.equations.unknowns_of(&states, u[last - 1]);
        let direction = direction(&mut self.equations, &u, &self.image)?;
        let crossed = self.crossings(&u)?;
        PARTS.into_iter().find_map(|part| {
            let e = part * self.distance;
            let (far, same) = self.coefficient(problem, &u, &direction, e)?;
            if self.crossings(&same)? != crossed {
                return None;
            }
            let (near, _) = self.coefficient(problem, &u, &direction, 0.5 * e)?;
            Some((4.0 * near - far) / 3.0)
        })
    }

    /// How often levels are crossed along an orbit.
    fn crossings(&mut self, u: &[f64]) -> Option<usize> {
        let before = self.equations.flow.work().switches;
        self.equations.trace(u, &mut |_| {}).ok()?;
        Some(self.equations.flow.work().switches - before)
    }

    /// `(lambda(e) - lambda(0)) / e^2`, and the orbit.
    fn coefficient(
        &mut self,
        problem: &ShootingProblem,
        u: &[f64],
        direction: &[f64],
        e: f64,
    ) -> Option<(f64, Vec<f64>)> {
        let (norm, scale) = (self.newton.norm(), self.scale);
        let length = norm.length(scale, direction);
        let unit: Vec<f64> = direction.iter().map(|x| x / length).collect();
        let mut row = vec![0.0; unit.len()];
        norm.linear_form(scale, &unit, &mut row);
        let mut beside: Vec<f64> = u.iter().zip(&unit).map(|(x, d)| x + e * d).collect();
        let border = Border {
            row: &row,
            value: crate::numeric::linear::dot(&row, &beside),
        };
        let options = problem.newton(self.equations.tolerance, self.equations.frame.ratio);
        let corrected =
            self.newton
                .correct(&mut self.equations, &mut beside, border, scale, options);
        corrected.ok()?;
        let last = u.len() - 1;
        Some(((beside[last] - u[last]) / (e * e), beside))
    }
}
