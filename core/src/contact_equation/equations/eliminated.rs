//! What is left when switches are eliminated too from the equations of a pass, in which forces are: the map of the states over the period,
//! and a step of Newton's method across a tangent.
//!
//! Numbers of equations are those of [`equations`](crate::contact_equation::equations).

use nalgebra::DMatrix;

use super::{Derived, Equations};
use crate::branches::recurrence::SignedPermutation;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::numeric::linear::{Lu, Matrix};

/// Room for both, made when it is first asked for.
#[derive(Debug, Default)]
pub(in crate::contact_equation) struct Eliminated {
    inner: Option<Solver>,
    whole: Option<Solver>,
    /// The same where there are pairs.
    paired: Option<Jacobian>,
}

#[derive(Debug)]
struct Solver {
    matrix: Matrix,
    lu: Lu,
    column: Vec<f64>,
    /// How switches change by states, row by row, and a row of the map.
    through: Vec<f64>,
    row: Vec<f64>,
}

impl Solver {
    fn of(order: usize) -> Self {
        Self {
            matrix: Matrix::zeros(order),
            lu: Lu::new(order),
            column: vec![0.0; order],
            through: Vec::new(),
            row: Vec::new(),
        }
    }

    /// (4), from the derivatives of residuals row by row.
    fn map(
        &mut self,
        derivatives: &[f64],
        unknowns: usize,
        order: usize,
        image: &SignedPermutation,
    ) -> Option<DMatrix<f64>> {
        let row = |row: usize| &derivatives[row * (unknowns + 1)..][..unknowns];
        let inner = unknowns - order;
        for i in 0..inner {
            let entries = &row(order + i)[order..];
            self.matrix.row_mut(i).copy_from_slice(entries);
        }
        self.lu.factorise(&mut self.matrix).ok()?;
        self.through.resize(inner * order, 0.0);
        for j in 0..order {
            for (i, x) in self.column.iter_mut().enumerate() {
                *x = row(order + i)[j];
            }
            self.lu.solve(&self.matrix, &mut self.column);
            for (i, x) in self.column.iter().enumerate() {
                self.through[i * order + j] = *x;
            }
        }
        let mut map = DMatrix::zeros(order, order);
        self.row.resize(order, 0.0);
        for i in 0..order {
            let (entries, by_switches) = row(i).split_at(order);
            self.row.copy_from_slice(entries);
            let (place, sign) = image.state_entry(i, order / 2);
            self.row[place] += sign;
            for (factor, through) in by_switches.iter().zip(self.through.chunks_exact(order)) {
                for (x, by) in self.row.iter_mut().zip(through) {
                    *x -= factor * by;
                }
            }
            for (j, x) in self.row.iter().enumerate() {
                map[(place, j)] = sign * x;
            }
        }
        Some(map)
    }
}

impl Equations {
    /// The map (4) of the states until the orbit comes back: positions, and velocities by the frequency. `None` too where the unknowns are
    /// those of no motion, since switches are in another order.
    pub(in crate::contact_equation) fn map(&mut self, u: &[f64]) -> Option<DMatrix<f64>> {
        self.pass_for(u, Derived::Chained);
        if self.failed || !self.is_in_order() {
            return None;
        }
        if self.chain.singular().is_some() {
            return None;
        }
        let (told, order) = (self.skeleton.told(), self.skeleton.order);
        let inner = &mut self.eliminated.inner;
        let inner = inner.get_or_insert_with(|| Solver::of(told - order));
        let image = &self.skeleton.recurrence().image;
        let mut map = inner.map(&self.matrix, told, order, image)?;
        // Velocities count by the frequency.
        let (half, velocity) = (order / 2, self.unit(order - 1));
        let (mut by_positions, mut by_velocities) = map.columns_range_pair_mut(..half, half..);
        by_positions.rows_mut(half, half).unscale_mut(velocity);
        by_velocities.rows_mut(0, half).scale_mut(velocity);
        map.iter().all(|x| x.is_finite()).then_some(map)
    }

    /// A step of Newton's method from these unknowns, in the plane across a tangent of which states, switches and the parameter count.
    /// `None` where the matrix is singular.
    pub(in crate::contact_equation) fn across(
        &mut self,
        u: &[f64],
        tangent: &[f64],
    ) -> Option<Vec<f64>> {
        self.compute(u, true);
        if self.failed {
            return None;
        }
        if self.pairs.is_some() {
            return self.across_pairs(tangent);
        }
        if self.chain.singular().is_some() {
            return None;
        }
        let told = self.skeleton.told();
        let whole = &mut self.eliminated.whole;
        let Solver {
            matrix, lu, column, ..
        } = whole.get_or_insert_with(|| Solver::of(told + 1));
        for (row, entries) in self.matrix.chunks_exact(told + 1).enumerate() {
            matrix.row_mut(row).copy_from_slice(entries);
        }
        let last = matrix.row_mut(told);
        last[..told].copy_from_slice(&tangent[..told]);
        last[told] = tangent[tangent.len() - 1];
        lu.factorise(matrix).ok()?;
        let mut step = self.residual.clone();
        self.chain.forward(&mut step);
        column[..told].copy_from_slice(&step[..told]);
        column[told] = 0.0;
        lu.solve(matrix, column);
        step[..told].copy_from_slice(&column[..told]);
        self.chain.back(column, &mut step[told..]);
        step.push(column[told]);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// The same from what the last pass has left where there are pairs.
    fn across_pairs(&mut self, tangent: &[f64]) -> Option<Vec<f64>> {
        let (told, unknowns) = (self.skeleton.told(), self.skeleton.unknowns());
        let partition = self.partition();
        let pairs = self.pairs.as_deref_mut()?;
        let jacobian = self.eliminated.paired.as_mut();
        let jacobian = match jacobian {
            Some(jacobian) => jacobian,
            None => self.eliminated.paired.insert(Jacobian::new(partition)),
        };
        jacobian.take_pairs(pairs);
        let mut step = self.residual.clone();
        step.push(0.0);
        let mut border = tangent[..told].to_vec();
        border.resize(unknowns, 0.0);
        border.push(tangent[tangent.len() - 1]);
        jacobian.set_border(&border);
        jacobian.factorise().ok()?;
        jacobian.solve(&mut step);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }
}
