//! Derivatives of the motion, moved along with it.
//!
//! The derivative of the collocation equations, (2) of [`map`](super::map), at fixed phases is linear: with `P = da/dq`,
//! `Q = da/dv` and `s = da/dp` at the nodes, and `W = A D`,
//!
//! ```text
//! (I - T^2 P W^2 - T Q W) da = P dq~ + Q dv~ + s                                                              (1)
//! dq~_j = dq_0 + T m_j dv_0 + kappa (T m_j v_0 + 2 T^2 (W^2 a)_j),    dv~_j = dv_0 + kappa T (W a)_j             (2)
//! ```
//!
//! where `kappa = d ln T / dp` is not zero if the unit of time changes with `p`: `T` is a width in phase divided by `Omega`.
//! The result is the exact derivative of the discrete motion.

use crate::system::Variable;
use crate::time::{FlowError, Tangent};

use super::engine::Engine;
use super::rule::{dot, tail};
use super::step::larger;

impl<const S: usize> Engine<S> {
    /// Makes the matrix of (1) for the trial and factorises it.
    pub(super) fn linearise(&mut self, tangent: &Tangent) -> Result<(), FlowError> {
        let n = self.here.q.len();
        self.field.linearise(
            &mut self.batch,
            &self.here.pieces,
            &tangent.by,
            &mut self.slopes,
        );
        self.work.forces += S;
        let time = self.time();
        let tables = &self.tables[self.trial.table];
        for i in 0..n {
            for j in 0..S {
                let row = self.matrix.row_mut(i * S + j);
                for l in 0..n {
                    let by_q = time * time * self.slopes.by_q[i * n + l][j];
                    let by_v = time * self.slopes.by_v[i * n + l][j];
                    let to = &mut row[l * S..][..S];
                    for k in 0..S {
                        to[k] = -by_q * tables.weak_position[k][j] - by_v * tables.weak_rate[k][j];
                    }
                }
                row[i * S + j] += 1.0;
            }
        }
        let phase = self.here.from + self.here.passed;
        self.lu
            .factorise(&mut self.matrix)
            .map_err(|_| FlowError::NotFinite { phase })
    }

    /// Moves the columns over the trial into `to`; the largest error in parts of the tolerance.
    pub(super) fn carry(&mut self, tangent: &Tangent, to: &mut [f64]) -> f64 {
        let n = self.here.q.len();
        let order = 2 * n;
        let time = self.time();
        let homogeneous = tangent.homogeneous(order);
        let count = tangent.columns.len() / order;
        self.moved.resize(count * n, [0.0; S]);
        let mut error = 0.0_f64;
        for (index, (column, to)) in tangent
            .columns
            .chunks_exact(order)
            .zip(to.chunks_exact_mut(order))
            .enumerate()
        {
            let by = index.checked_sub(homogeneous);
            let kappa = by.map_or(0.0, |by| self.kappa(tangent.by[by]));
            self.right_side(column, kappa, by);
            self.lu.solve(&self.matrix, &mut self.right);
            let tables = &self.tables[self.trial.table];
            let (dq, dv) = column.split_at(n);
            let mut of_rate = 0.0_f64;
            for i in 0..n {
                let da: &[f64; S] = self.right[i * S..][..S]
                    .try_into()
                    .unwrap_or(&[f64::NAN; S]);
                self.moved[index * n + i] = *da;
                let moved = self.trial.q[i] - self.here.q[i];
                to[i] = dq[i]
                    + time * (dv[i] + time * dot(&tables.end_position, da))
                    + kappa * (2.0 * moved - time * self.here.v[i]);
                to[n + i] = dv[i]
                    + time * dot(&tables.end_rate, da)
                    + kappa * (self.trial.v[i] - self.here.v[i]);
                of_rate = larger(of_rate, tail(&tables.weak_highest, da));
            }
            let most = |column: &[f64]| column.iter().fold(0.0_f64, |m, x| larger(m, x.abs()));
            let size = &mut self.column_sizes[index];
            size[0] = larger(larger(size[0], most(&to[..n])), most(dq));
            size[1] = larger(larger(size[1], most(&to[n..])), most(dv));
            let base = self.field.base().abs();
            let rate = size[1].max(base * size[0]).max(f64::MIN_POSITIVE);
            let position = size[0].max(time.abs() * size[1]).max(f64::MIN_POSITIVE);
            let of_rate = of_rate * time.abs() / (2 * S) as f64;
            error = larger(error, of_rate / rate);
            error = larger(error, of_rate * time.abs() / (2 * S) as f64 / position);
        }
        error / self.tolerance
    }

    /// `kappa` of (2) for a variable.
    fn kappa(&self, by: Variable) -> f64 {
        -self.field.base_by(by) / self.field.base()
    }

    /// The right-hand side of (1), for a variable by its number.
    fn right_side(&mut self, column: &[f64], kappa: f64, by: Option<usize>) {
        let n = self.here.q.len();
        let time = self.time();
        let tables = &self.tables[self.trial.table];
        let (dq, dv) = column.split_at(n);
        for i in 0..n {
            let to = &mut self.right[i * S..][..S];
            match by {
                Some(by) => to.copy_from_slice(&self.slopes.by_variable[by * n + i]),
                None => to.fill(0.0),
            }
            for l in 0..n {
                let by_q = &self.slopes.by_q[i * n + l];
                let by_v = &self.slopes.by_v[i * n + l];
                for j in 0..S {
                    let passed = time * tables.passed[j];
                    let v = self.here.v[l];
                    let shift = self.batch.shift[0][l][j];
                    let position = dq[l] + passed * dv[l] + kappa * (2.0 * shift - passed * v);
                    let rate = dv[l] + kappa * (self.batch.v[l][j] - v);
                    to[j] += by_q[j] * position + by_v[j] * rate;
                }
            }
        }
    }
}
