//! What a method says of an orbit of a branch.

use crate::balance::truncation::RefinedBalance;
use crate::balance_branch::context::BranchContext;
use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::continuation::newton::{Border, Newton};
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::numeric::linear::dot;
use crate::orbit::stability::judge::Judge;
use crate::orbit::stability::{Answer, Method};

/// The orbit has moved further than this by the time its factors are known: then they are those of another one.
const MOVED: f64 = 1e-3;

impl Branch {
    /// Applies a method to an orbit of this branch.
    ///
    /// # Errors
    /// If the orbit belongs to a system with another number of coordinates or parameters, or the branch is a [backbone](crate::backbone), of
    /// the stability of which nothing is known, or was read from a file and has no [model](Self::attach).
    pub fn multipliers(&self, point: &Point, method: Method) -> Result<Answer, Error> {
        self.is_no_backbone()?;
        let point = &self.complete(point)?;
        let context = &self.context(point)?;
        let facts = context.system.facts();
        let (entries, expected) = (point.orbit.coordinates(), facts.coordinates.len());
        if entries != expected {
            let (entries, expected) = (2 * entries, 2 * expected);
            return Err(RequestError::State { entries, expected }.into());
        }
        let (values, expected) = (point.parameters.len(), facts.parameters.len());
        if values != expected {
            return Err(RequestError::Values { values, expected }.into());
        }
        let harmonics = point.orbit.harmonics();
        let resolution = context.with_harmonics(harmonics, harmonics);
        let mut balance = context.balance(resolution);
        let mut u = point.orbit.series.clone();
        u.push(point.value);
        let mut finer = RefinedBalance::new(
            context.system.as_ref(),
            &point.parameters,
            point.orbit.omega,
            context.variable,
            resolution,
        );
        let mut newton = Newton::new(&balance);
        let corrected =
            factorise(context, &mut balance, &mut newton, &u) && finer.correct(&u, &mut newton);
        balance.set(point.value);
        Ok(Judge::new(method).answer(&balance, corrected.then_some(&finer), &u))
    }
}

/// Makes the factors at an orbit, with a border that holds the parameter fast or, near a fold, the way along the branch;
/// false if that fails.
fn factorise(
    context: &BranchContext,
    problem: &mut dyn Problem,
    newton: &mut Newton,
    u: &[f64],
) -> bool {
    let range = (context.to - context.from).abs();
    let scale = newton.norm().scale_at(u, range, &mut [0.0; 2]);
    let last = u.len() - 1;
    let mut row = vec![0.0; u.len()];
    let mut stay = |newton: &mut Newton, row: &[f64]| {
        let mut moved = u.to_vec();
        let value = dot(row, u);
        let border = Border { row, value };
        let found = newton.correct(problem, &mut moved, border, scale, context.newton);
        let difference: Vec<f64> = moved.iter().zip(u).map(|(a, b)| a - b).collect();
        let stayed = found.is_ok() && newton.norm().length(scale, &difference) < MOVED;
        stayed.then(|| {
            let mut tangent = vec![0.0; u.len()];
            newton.tangent(problem, &moved, &mut tangent, false);
            tangent
        })
    };
    row[last] = 1.0;
    let mut along = stay(newton, &row);
    if along.is_none() {
        // At a fold the parameter cannot be held fast, but the size of the orbit can.
        newton.norm().linear_form(scale, u, &mut row);
        along = stay(newton, &row);
    }
    let Some(along) = along else {
        return false;
    };
    newton.norm().linear_form(scale, &along, &mut row);
    stay(newton, &row).is_some()
}
