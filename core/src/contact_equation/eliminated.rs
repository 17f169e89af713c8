//! What is left when forces and switches are eliminated from the equations of a pass: the map of the states over the period, and a step
//! of Newton's method across a tangent.
//!
//! Numbers of equations are those of [`equations`](super::equations).

use nalgebra::DMatrix;

use super::equations::Equations;
use crate::numeric::linear::{Lu, Matrix};

/// Room for both, of one number of unknowns.
#[derive(Debug)]
pub(super) struct Eliminated {
    inner: Matrix,
    inner_lu: Lu,
    whole: Matrix,
    whole_lu: Lu,
    column: Vec<f64>,
}

impl Eliminated {
    /// Of so many unknowns, some of them states.
    pub(super) fn new(unknowns: usize, order: usize) -> Self {
        let others = unknowns - order;
        Self {
            inner: Matrix::zeros(others),
            inner_lu: Lu::new(others),
            whole: Matrix::zeros(unknowns + 1),
            whole_lu: Lu::new(unknowns + 1),
            column: vec![0.0; others],
        }
    }

    /// (4), from the derivatives of residuals row by row.
    fn map(&mut self, derivatives: &[f64], unknowns: usize, order: usize) -> Option<DMatrix<f64>> {
        let row = |row: usize| &derivatives[row * (unknowns + 1)..][..unknowns];
        let mut map =
            DMatrix::from_fn(order, order, |i, j| row(i)[j] + f64::from(u8::from(i == j)));
        let others = unknowns - order;
        if others == 0 {
            return Some(map);
        }
        for i in 0..others {
            self.inner
                .row_mut(i)
                .copy_from_slice(&row(order + i)[order..]);
        }
        self.inner_lu.factorise(&mut self.inner).ok()?;
        for j in 0..order {
            for (i, x) in self.column.iter_mut().enumerate() {
                *x = row(order + i)[j];
            }
            self.inner_lu.solve(&self.inner, &mut self.column);
            for i in 0..order {
                let through = row(i)[order..].iter().zip(&self.column);
                map[(i, j)] -= through.map(|(a, x)| a * x).sum::<f64>();
            }
        }
        Some(map)
    }
}

impl Equations {
    /// The map (4) of the states over the period: positions, and velocities by the frequency.
    pub(super) fn map(&mut self, u: &[f64]) -> Option<DMatrix<f64>> {
        self.pass(u, true);
        if self.failed {
            return None;
        }
        let (n, order) = (self.skeleton.unknowns(), self.skeleton.order);
        let mut map = self.eliminated.map(&self.matrix, n, order)?;
        for i in 0..order {
            for j in 0..order {
                map[(i, j)] *= self.unit(j) / self.unit(i);
            }
        }
        map.iter().all(|x| x.is_finite()).then_some(map)
    }

    /// A step of Newton's method from these unknowns, in the plane across a tangent of which states, switches and the parameter count.
    /// `None` where the matrix is singular.
    pub(super) fn across(&mut self, u: &[f64], tangent: &[f64]) -> Option<Vec<f64>> {
        self.compute(u, true);
        if self.failed {
            return None;
        }
        let n = self.skeleton.unknowns();
        let told = self.skeleton.order + self.skeleton.switches.len();
        let Eliminated {
            whole, whole_lu, ..
        } = &mut self.eliminated;
        for (row, entries) in self.matrix.chunks_exact(n + 1).enumerate() {
            whole.row_mut(row).copy_from_slice(entries);
        }
        let last = whole.row_mut(n);
        last.fill(0.0);
        for column in (0..told).chain([n]) {
            last[column] = tangent[column];
        }
        whole_lu.factorise(whole).ok()?;
        let mut step = self.residual.clone();
        step.push(0.0);
        whole_lu.solve(whole, &mut step);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }
}
