//! How the matrices over segments change along a direction of the states.
//!
//! With the derivatives of the flow over a segment by its beginning and by the variables, second derivatives do not depend on the order in
//! which they are taken: along any direction `(s', p')`
//!
//! ```text
//! B = [ dphi/ds, dphi/dp ],     (dphi/ds)' v = X (s', p'),     X = d/dh B(s + h v; p)   at h = 0                (1)
//! D(h) = ( B(h) - B(-h) ) / 2h,     T_jk = T_j,k-1 + ( T_j,k-1 - T_j-1,k-1 ) / (4^k - 1),   T_j0 = D(h / 2^j)  (2)
//! ```
//!
//! so that one direction `v`, the vector of a multiplier, serves the frequency and every parameter, and none of these is changed: a step
//! never leaves the range of a parameter. `B` is the exact derivative of the discrete motion. It is differenced (2): second derivatives of
//! laws at fixed times are not integrable for exponents below one, while `B` is smooth as long as the same levels are crossed in the same
//! order. The error of a column is what the last step of (2) changed, as Ridders has it; where steps become so short that it is noise, it
//! grows again, and the best is taken.
//!
//! Source: Ridders (1982), Accurate computation of F'(x) and F'(x) F''(x), Adv. Eng. Softw. 4.

use nalgebra::{DMatrix, DVector};

use super::cycle::Cycle;
use super::error::SensitivityError;
use super::reader::Along;
use super::slopes::Slopes;
use crate::system::Variable;
use crate::time::FlowError;

/// The first step: no part of the orbit changes by more than this part of its size.
const FIRST: f64 = 1e-4;
/// Halvings of the step.
const LEVELS: usize = 7;
/// The first step is so often made shorter by this, where other levels are crossed at it.
const SHORTER: f64 = 0.2;
const SHORTENED: usize = 6;
/// Errors below this part of a column are small enough, or of this part of the largest column.
const ENOUGH: f64 = 1e-7;
const LEAST: f64 = 1e-2;
/// An error that has grown by this from the best is noise.
const WORSE: f64 = 4.0;

/// `X` of (1) for all segments, one below the other: states in their units, and a column for each entry of a state and for each variable.
#[derive(Debug, Clone)]
pub(super) struct Change {
    values: DMatrix<f64>,
    /// Of the norms of the columns.
    errors: Vec<f64>,
    /// What counts as one in an entry of a state.
    units: Vec<f64>,
}

impl Change {
    /// `X (s', p')` over a segment.
    pub(super) fn over(&self, segment: usize, along: &Along) -> DVector<f64> {
        let order = self.units.len();
        let rows = self.values.rows(segment * order, order);
        rows * DVector::from_iterator(rows.ncols(), self.times(segment, along))
    }

    /// A direction as the columns are multiplied by it.
    fn times<'c>(&'c self, segment: usize, along: &'c Along) -> impl Iterator<Item = f64> + 'c {
        let states = &along.states.as_slice()[segment * self.units.len()..];
        let states = states.iter().zip(&self.units).map(|(s, unit)| s / unit);
        states.chain(along.weights.iter().copied())
    }

    /// The largest that `X (s', p')` could be, and its error.
    pub(super) fn bounds(&self, along: &Along) -> [f64; 2] {
        let segments = 0..self.values.nrows() / self.units.len();
        let of = segments.map(|segment| {
            let columns = self.values.column_iter().zip(&self.errors);
            let terms = columns.zip(self.times(segment, along));
            terms.fold([0.0; 2], |[size, sum], ((column, error), times)| {
                [
                    size + column.norm() * times.abs(),
                    sum + error * times.abs(),
                ]
            })
        });
        of.fold([0.0_f64; 2], |most, next| {
            [most[0].max(next[0]), most[1].max(next[1])]
        })
    }
}

/// (1) along directions in which the beginnings of all segments move, in units of states.
///
/// # Errors
/// If motions beside the orbit cannot be continued, or cross other levels however near they are.
pub(super) fn along(
    cycle: &mut Cycle,
    states: &[f64],
    variables: &[Variable],
    directions: &[DVector<f64>],
) -> Result<Vec<Change>, SensitivityError> {
    let system = cycle.system.clone();
    let mut slopes = Slopes::new(&system, &[]);
    slopes.set(&cycle.values, cycle.omega);
    let mut lines = Lines {
        slopes,
        states,
        variables,
        crossed: Vec::new(),
    };
    lines.crossed = lines.at(cycle, None)?.1;
    let changes = directions.iter();
    let changes = changes.map(|direction| lines.change(cycle, direction));
    changes.collect()
}

/// The pieces that all gaps are on, segment by segment, from switch to switch.
type Crossed = Vec<(usize, Vec<usize>)>;

/// Straight lines through an orbit.
struct Lines<'l> {
    slopes: Slopes,
    states: &'l [f64],
    variables: &'l [Variable],
    /// By the orbit itself.
    crossed: Crossed,
}

impl Lines<'_> {
    /// `B` of all segments at a place of a line, or on the orbit, and what is crossed in which order.
    fn at(
        &self,
        cycle: &mut Cycle,
        place: Option<(&DVector<f64>, f64)>,
    ) -> Result<(DMatrix<f64>, Crossed), FlowError> {
        let mut states = self.states.to_vec();
        if let Some((direction, h)) = place {
            for (i, (state, d)) in states.iter_mut().zip(direction).enumerate() {
                *state += h * d * cycle.unit(i);
            }
        }
        let mut crossed: Crossed = Vec::new();
        let mut room = vec![0.0; cycle.order()];
        let evaluated = cycle.evaluate_seen(&states, self.variables, &mut |segment, stretch| {
            let (from, to) = stretch.phases();
            let middle = 0.5 * (from + to);
            stretch.state(middle, &mut room);
            let next = (segment, self.slopes.pieces(middle, &room));
            if crossed.last() != Some(&next) {
                crossed.push(next);
            }
        })?;
        let order = cycle.order();
        let mut all = DMatrix::zeros(cycle.unknowns(), order + self.variables.len());
        for (segment, matrix) in cycle.matrices(&evaluated).iter().enumerate() {
            all.view_mut((segment * order, 0), (order, order))
                .copy_from(matrix);
        }
        for (index, by) in evaluated.by.iter().enumerate() {
            for (i, by) in by.iter().enumerate() {
                all[(i, order + index)] = by / cycle.unit(i);
            }
        }
        Ok((all, crossed))
    }

    fn change(
        &self,
        cycle: &mut Cycle,
        direction: &DVector<f64>,
    ) -> Result<Change, SensitivityError> {
        let length = direction.amax() / cycle.size(self.states).max(f64::MIN_POSITIVE);
        let mut step = if length > 0.0 { FIRST / length } else { FIRST };
        let mut sizes = vec![cycle.size(self.states); cycle.order()];
        sizes.extend(
            self.variables
                .iter()
                .map(|&variable| match cycle.value(variable) {
                    0.0 => 1.0,
                    value => value.abs(),
                }),
        );
        for _ in 0..SHORTENED {
            let mut table = Table::new(&sizes);
            match self.extrapolate(cycle, direction, step, &mut table) {
                Ok(()) if table.is_known() => {
                    return Ok(Change {
                        values: table.best,
                        errors: table.errors,
                        units: (0..cycle.order()).map(|i| cycle.unit(i)).collect(),
                    });
                }
                Err(error @ FlowError::Cancelled { .. }) => return Err(error.into()),
                Ok(()) | Err(_) => step *= SHORTER,
            }
        }
        Err(SensitivityError::Beside)
    }

    /// (2), as far as the same levels are crossed.
    fn extrapolate(
        &self,
        cycle: &mut Cycle,
        direction: &DVector<f64>,
        first: f64,
        table: &mut Table,
    ) -> Result<(), FlowError> {
        for level in 0..LEVELS {
            let step = first * 0.5_f64.powi(level as i32);
            let (ahead, a) = self.at(cycle, Some((direction, step)))?;
            let (behind, b) = self.at(cycle, Some((direction, -step)))?;
            if a != self.crossed || b != self.crossed {
                return Ok(());
            }
            if table.add((ahead - behind) / (2.0 * step)) {
                return Ok(());
            }
        }
        Ok(())
    }
}

/// The table (2), with the best of each column.
struct Table<'t> {
    /// What counts as one in what columns are multiplied by.
    sizes: &'t [f64],
    before: Vec<DMatrix<f64>>,
    best: DMatrix<f64>,
    errors: Vec<f64>,
}

impl<'t> Table<'t> {
    fn new(sizes: &'t [f64]) -> Self {
        Self {
            sizes,
            before: Vec::new(),
            best: DMatrix::zeros(0, 0),
            errors: vec![f64::INFINITY; sizes.len()],
        }
    }

    fn is_known(&self) -> bool {
        self.errors.iter().all(|error| error.is_finite())
    }

    /// Adds a row that begins with a difference; whether it was the last.
    fn add(&mut self, difference: DMatrix<f64>) -> bool {
        if self.before.is_empty() {
            self.best = difference.clone();
        }
        let mut row = vec![difference];
        let mut least = vec![f64::INFINITY; self.errors.len()];
        for (k, shorter) in self.before.iter().enumerate() {
            let factor = 4.0_f64.powi(k as i32 + 1) - 1.0;
            let next = &row[k] + (&row[k] - shorter) / factor;
            for (index, least) in least.iter_mut().enumerate() {
                let apart =
                    |other: &DMatrix<f64>| (next.column(index) - other.column(index)).norm();
                let [a, b] = [apart(&row[k]), apart(shorter)];
                // What is no number is no error.
                let error = if a.is_finite() && b.is_finite() {
                    a.max(b)
                } else {
                    f64::INFINITY
                };
                *least = least.min(error);
                if error < self.errors[index] {
                    self.errors[index] = error;
                    self.best.set_column(index, &next.column(index));
                }
            }
            row.push(next);
        }
        self.before = row;
        self.is_last(&least)
    }

    /// Whether every column is known well enough, or does not become better.
    fn is_last(&self, least: &[f64]) -> bool {
        let sizes = self.best.column_iter().zip(self.sizes);
        let sizes: Vec<f64> = sizes.map(|(column, size)| column.norm() * size).collect();
        let largest = sizes.iter().fold(0.0, |m: f64, size| m.max(*size));
        let columns = self.errors.iter().zip(least).enumerate();
        let mut columns = columns.map(|(index, (&error, &least))| {
            let size = sizes[index].max(LEAST * largest);
            error * self.sizes[index] <= ENOUGH * size || least > WORSE * error
        });
        self.is_known() && columns.all(|is_done| is_done)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `exp` at zero and a column of zeros: both are known, and the one is one.
    #[test]
    fn differences_are_extrapolated_column_by_column() {
        let mut table = Table::new(&[1.0, 1.0]);
        let mut steps = 0;
        for level in 0..LEVELS {
            let h = 0.1 * 0.5_f64.powi(level as i32);
            let difference = (h.exp() - (-h).exp()) / (2.0 * h);
            steps += 1;
            if table.add(DMatrix::from_row_slice(1, 2, &[difference, 0.0])) {
                break;
            }
        }
        assert!(table.is_known() && steps == 4, "{steps}");
        assert!((table.best[(0, 0)] - 1.0).abs() <= table.errors[0]);
        assert!(table.errors[0] < 1e-8 && table.errors[1] == 0.0);
    }

    /// A difference that is no number is passed over, and what follows counts.
    #[test]
    fn no_number_is_never_the_best() {
        let mut table = Table::new(&[1.0]);
        for difference in [f64::NAN, 1.0, 1.0] {
            table.add(DMatrix::from_element(1, 1, difference));
        }
        assert!(table.is_known());
        assert_eq!((table.best[(0, 0)], table.errors[0]), (1.0, 0.0));
    }
}
