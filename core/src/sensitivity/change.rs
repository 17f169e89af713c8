//! How the matrices over segments change along a direction of the states.
//!
//! With the derivatives of the flow over a segment by its beginning and by the variables, second derivatives do not depend on the order in
//! which they are taken: along any direction `(s', p')`
//!
//! ```text
//! B = [ dphi/ds, dphi/dp ],     (dphi/ds)' v = X (s', p'),     X = d/dh B(s + h v; p)   at h = 0                (1)
//! D(h) = ( B(h) - B(-h) ) / 2h,     T_jk = T_j,k-1 + ( T_j,k-1 - T_j-1,k-1 ) / (4^k - 1),   T_j0 = D(h / 2^j)  (2)
//! X = D(h) + 8 R / 3h,   R = B(h/2) - B(0) - h D(h) / 2 - ( B(h) - 2 B(0) + B(-h) ) / 8                         (3)
//! ```
//!
//! so that one direction `v`, the vector of a multiplier, serves the frequency and every parameter, and none of these is changed: a step
//! never leaves the range of a parameter. `B` is the exact derivative of the discrete motion. It is differenced (2): second derivatives of
//! laws at fixed times are not integrable for exponents below one, while `B` is smooth as long as the same levels are crossed in the same
//! order. As a rule (3), the slope of the polynomial of third degree through four values, of which `B(0)` is known, is enough: its error is of order
//! three. Else the value at `-h/2` begins the second row of (2). The error of a column is what the last step of (2), or (3), changed, as Ridders has
//! it, and what the flow may leave in its values, over the step; where steps become so short that it is noise, it grows again, and the best is
//! taken.
//!
//! Source: Ridders (1982), Accurate computation of F'(x) and F'(x) F''(x), Adv. Eng. Softw. 4.

use nalgebra::{DMatrix, DVector};

use super::cycle::{Cycle, Evaluated};
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
/// By how much (3), and a row of (2), make an error of values larger, over the step: the sums of the sizes of their weights.
const OF_HALF: f64 = 16.0 / 3.0;
const OF_ROW: f64 = 2.0;

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

/// The pieces that all gaps are on, segment by segment, from switch to switch.
pub(super) type Crossed = Vec<(usize, Vec<usize>)>;

/// The equations at states, and what motions from there cross in which order.
///
/// # Errors
/// If motions cannot be continued.
pub(super) fn seen(
    cycle: &mut Cycle,
    states: &[f64],
    variables: &[Variable],
) -> Result<(Evaluated, Crossed), FlowError> {
    let slopes = gaps(cycle);
    seen_by(cycle, &slopes, states, variables)
}

/// The gaps of a system at the present values.
fn gaps(cycle: &Cycle) -> Slopes {
    let mut slopes = Slopes::new(&cycle.system, &[]);
    slopes.set(&cycle.values, cycle.omega);
    slopes
}

fn seen_by(
    cycle: &mut Cycle,
    slopes: &Slopes,
    states: &[f64],
    variables: &[Variable],
) -> Result<(Evaluated, Crossed), FlowError> {
    let mut crossed: Crossed = Vec::new();
    let mut room = vec![0.0; cycle.order()];
    let evaluated = cycle.evaluate_seen(states, variables, &mut |segment, stretch| {
        let (from, to) = stretch.phases();
        let middle = 0.5 * (from + to);
        stretch.state(middle, &mut room);
        let last = crossed.last();
        let is_same = last.is_some_and(|(own, pieces)| {
            *own == segment && slopes.pieces(middle, &room).eq(pieces.iter().copied())
        });
        if !is_same {
            crossed.push((segment, slopes.pieces(middle, &room).collect()));
        }
    })?;
    Ok((evaluated, crossed))
}

/// An orbit, from which straight lines lead.
pub(super) struct Centre<'c> {
    slopes: Slopes,
    states: &'c [f64],
    variables: &'c [Variable],
    /// `B`
    value: DMatrix<f64>,
    crossed: Crossed,
}

impl<'c> Centre<'c> {
    /// Of equations that are known at its states, by these variables.
    pub(super) fn known(
        cycle: &Cycle,
        states: &'c [f64],
        variables: &'c [Variable],
        evaluated: &Evaluated,
        crossed: Crossed,
    ) -> Self {
        Self {
            slopes: gaps(cycle),
            states,
            variables,
            value: both(cycle, evaluated),
            crossed,
        }
    }

    /// (1) along a direction in which the beginnings of all segments move, in units of states.
    ///
    /// # Errors
    /// If motions beside the orbit cannot be continued, or cross other levels however near they are.
    pub(super) fn change(
        &self,
        cycle: &mut Cycle,
        direction: &DVector<f64>,
    ) -> Result<Change, SensitivityError> {
        let size = cycle.size(self.states);
        // An orbit at rest has no size.
        let size = if size > 0.0 { size } else { 1.0 };
        let length = direction.amax() / size;
        let mut step = if length > 0.0 { FIRST / length } else { FIRST };
        let mut sizes = vec![size; cycle.order()];
        sizes.extend(
            self.variables
                .iter()
                .map(|&variable| match cycle.value(variable) {
                    0.0 => 1.0,
                    value => value.abs(),
                }),
        );
        let columns = self.value.column_iter();
        let noise: Vec<f64> = columns.map(|column| cycle.leaves * column.norm()).collect();
        for _ in 0..SHORTENED {
            let mut table = Table::new(&sizes, noise.clone());
            match self.extrapolate(cycle, direction, step, &mut table) {
                Ok(()) if table.is_known() => {
                    return Ok(Change {
                        errors: table.errors(),
                        values: table.best,
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
        let mut pair: Option<[DMatrix<f64>; 2]> = None;
        for level in 0..LEVELS {
            let step = first * 0.5_f64.powi(level as i32);
            let Some(ahead) = self.beside(cycle, direction, step)? else {
                return Ok(());
            };
            if let Some(pair) = &pair
                && level == 1
                && table.take_half([&self.value, &pair[0], &pair[1], &ahead], first)
            {
                return Ok(());
            }
            let Some(behind) = self.beside(cycle, direction, -step)? else {
                return Ok(());
            };
            if table.add((&ahead - &behind) / (2.0 * step), step) {
                return Ok(());
            }
            pair = Some([ahead, behind]);
        }
        Ok(())
    }

    /// `B` at a place of a line; nothing where other levels are crossed, or in another order.
    fn beside(
        &self,
        cycle: &mut Cycle,
        direction: &DVector<f64>,
        h: f64,
    ) -> Result<Option<DMatrix<f64>>, FlowError> {
        let mut states = self.states.to_vec();
        for (i, (state, d)) in states.iter_mut().zip(direction).enumerate() {
            *state += h * d * cycle.unit(i);
        }
        let (evaluated, crossed) = seen_by(cycle, &self.slopes, &states, self.variables)?;
        Ok((crossed == self.crossed).then(|| both(cycle, &evaluated)))
    }
}

/// `B` of all segments, one below the other.
fn both(cycle: &Cycle, evaluated: &Evaluated) -> DMatrix<f64> {
    let (order, variables) = (cycle.order(), evaluated.by.len());
    let mut all = DMatrix::zeros(cycle.unknowns(), order + variables);
    for (segment, matrix) in cycle.matrices(evaluated).iter().enumerate() {
        all.view_mut((segment * order, 0), (order, order))
            .copy_from(matrix);
    }
    for (index, by) in evaluated.by.iter().enumerate() {
        for (i, by) in by.iter().enumerate() {
            all[(i, order + index)] = by / cycle.unit(i);
        }
    }
    all
}

/// The table (2), with the best of each column.
struct Table<'t> {
    /// What counts as one in what columns are multiplied by.
    sizes: &'t [f64],
    /// What the flow may leave in each column of `B`.
    noise: Vec<f64>,
    before: Vec<DMatrix<f64>>,
    best: DMatrix<f64>,
    /// What the last step of (2) or (3) changed, and what noise may be in it.
    errors: Vec<f64>,
    floors: Vec<f64>,
}

impl<'t> Table<'t> {
    fn new(sizes: &'t [f64], noise: Vec<f64>) -> Self {
        Self {
            sizes,
            floors: noise.clone(),
            noise,
            before: Vec::new(),
            best: DMatrix::zeros(0, 0),
            errors: vec![f64::INFINITY; sizes.len()],
        }
    }

    /// Of the norms of the columns.
    fn errors(&self) -> Vec<f64> {
        let both = self.errors.iter().zip(&self.floors);
        both.map(|(error, floor)| error + floor).collect()
    }

    fn is_known(&self) -> bool {
        self.errors.iter().all(|error| error.is_finite())
    }

    /// (3), from `B` at `0`, `h`, `-h` and `h / 2`; whether that is enough.
    fn take_half(&mut self, [here, ahead, behind, half]: [&DMatrix<f64>; 4], h: f64) -> bool {
        let slope = (ahead - behind) / (2.0 * h);
        let bend = (ahead - here * 2.0 + behind) / 8.0;
        let change = (half - here - &slope * (0.5 * h) - bend) * (8.0 / (3.0 * h));
        for (index, error) in self.errors.iter_mut().enumerate() {
            *error = Some(change.column(index).norm())
                .filter(|error| error.is_finite())
                .unwrap_or(f64::INFINITY);
            self.floors[index] = OF_HALF * self.noise[index] / h;
        }
        self.best = slope + change;
        let is_enough = self.is_last(&self.errors);
        if !is_enough {
            self.errors.fill(f64::INFINITY);
        }
        is_enough
    }

    /// Adds a row that begins with a difference over a step; whether it was the last.
    fn add(&mut self, difference: DMatrix<f64>, step: f64) -> bool {
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
                    self.floors[index] = OF_ROW * self.noise[index] / step;
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
        let mut table = Table::new(&[1.0, 1.0], vec![0.0; 2]);
        let mut steps = 0;
        for level in 0..LEVELS {
            let h = 0.1 * 0.5_f64.powi(level as i32);
            let difference = (h.exp() - (-h).exp()) / (2.0 * h);
            steps += 1;
            if table.add(DMatrix::from_row_slice(1, 2, &[difference, 0.0]), h) {
                break;
            }
        }
        assert!(table.is_known() && steps == 4, "{steps}");
        assert!((table.best[(0, 0)] - 1.0).abs() <= table.errors[0]);
        assert!(table.errors[0] < 1e-8 && table.errors[1] == 0.0);
    }

    /// A cubic is differentiated exactly by four values, a power of four with an error of order three; noise of the values is in the error.
    #[test]
    fn four_values_are_enough_where_the_change_is_small() {
        let h = 0.125;
        let at = |x: f64| DMatrix::from_row_slice(1, 2, &[x + 2.0 * x.powi(3), x.powi(4)]);
        let values = [at(0.0), at(h), at(-h), at(0.5 * h)];
        let mut table = Table::new(&[1.0, 1.0], vec![1e-12, 0.0]);
        let [a, b, c, d] = &values;
        assert!(!table.take_half([a, b, c, d], h));
        assert!((table.best[(0, 0)] - 1.0).abs() < 1e-15);
        assert!((table.best[(0, 1)] + 0.5 * h.powi(3)).abs() < 1e-15);
        let linear = |x: f64| DMatrix::from_row_slice(1, 1, &[x]);
        let values = [linear(0.0), linear(h), linear(-h), linear(0.5 * h)];
        let mut table = Table::new(&[1.0], vec![1e-12]);
        let [a, b, c, d] = &values;
        assert!(table.take_half([a, b, c, d], h));
        assert_eq!(table.best[(0, 0)], 1.0);
        let expected = 16e-12 / (3.0 * h);
        assert!((table.errors()[0] - expected).abs() < 1e-12 * expected);
    }

    /// A difference that is no number is passed over, and what follows counts.
    #[test]
    fn no_number_is_never_the_best() {
        let mut table = Table::new(&[1.0], vec![0.0]);
        for difference in [f64::NAN, 1.0, 1.0] {
            table.add(DMatrix::from_element(1, 1, difference), 1.0);
        }
        assert!(table.is_known());
        assert_eq!((table.best[(0, 0)], table.errors[0]), (1.0, 0.0));
    }
}
