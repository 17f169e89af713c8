//! A step that was taken, and what is known between its ends.
//!
//! The derivatives `da` of the accelerations at the nodes, (1) of [`tangent`](super::tangent), say how a column moves over a part of the step as
//! they say it of the whole: with the weights `w` of the points of interpolation at `u`,
//!
//! ```text
//! r_k = sum_j w_j (A D)_jk,    p_k = sum_j w_j (A D A D)_jk                                                    (1)
//! dv(u) = dv_0 + T r . da + kappa ( v(u) - v_0 )                                                               (2)
//! dq(u) = dq_0 + T ( m dv_0 + T p . da ) + kappa ( 2 (q(u) - q_0) - T m v_0 )                                  (3)
//! ```

use crate::time::{Stretch, Tangent};

use super::engine::Engine;
use super::map::Tables;
use super::roots::MOST;
use super::rule::{Rule, dot};

/// What is shown every step that was taken.
pub(super) type Watch<'w, const S: usize> = &'w mut dyn FnMut(&View<'_, S>);

/// The trial as a stretch of motion.
pub(super) struct View<'b, const S: usize> {
    pub(super) engine: &'b Engine<S>,
    /// At its start.
    pub(super) tangent: Option<&'b Tangent>,
}

impl<const S: usize> View<'_, S> {
    /// Weights of the points of interpolation at a phase.
    fn weights(&self, phase: f64) -> [f64; MOST] {
        let Engine {
            rule,
            tables,
            trial,
            ..
        } = self.engine;
        let (start, end) = self.phases();
        let rule: &Rule<S> = rule;
        let tables: &Tables<S> = &tables[trial.table];
        let (passed, left) = ((phase - start) / trial.width, (end - phase) / trial.width);
        let mut weights = [0.0; MOST];
        rule.interpolation(tables.map.inverse(passed, left), &mut weights[..S + 2]);
        weights
    }

    fn state_by(&self, weights: &[f64; MOST], state: &mut [f64]) {
        let Engine {
            here, trial, batch, ..
        } = self.engine;
        let n = here.q.len();
        let at = |start: f64, row: &[f64; S], end: f64| {
            let inner: f64 = row.iter().zip(&weights[1..]).map(|(x, w)| x * w).sum();
            weights[0] * start + inner + weights[S + 1] * end
        };
        for i in 0..n {
            state[i] = at(here.q[i], &batch.q[i], trial.q[i]);
            state[n + i] = at(here.v[i], &batch.v[i], trial.v[i]);
        }
    }

    /// Writes state and tangent at a phase of the step, by (2) and (3).
    pub(super) fn tangent(&self, phase: f64, state: &mut [f64], columns: &mut [f64]) {
        let weights = self.weights(phase);
        self.state_by(&weights, state);
        let Some(tangent) = self.tangent else { return };
        let Engine {
            tables,
            here,
            trial,
            moved,
            field,
            ..
        } = self.engine;
        let tables = &tables[trial.table];
        // (1)
        let nodes: &[f64; S] = weights[1..=S].try_into().unwrap_or(&[f64::NAN; S]);
        let last = weights[S + 1];
        let rate: [f64; S] =
            std::array::from_fn(|k| dot(nodes, &tables.weak_rate[k]) + last * tables.end_rate[k]);
        let position: [f64; S] = std::array::from_fn(|k| {
            dot(nodes, &tables.weak_position[k]) + last * tables.end_position[k]
        });
        let time = self.engine.time();
        let part = time * (phase - self.phases().0) / trial.width;
        let n = here.q.len();
        let homogeneous = tangent.homogeneous(2 * n);
        let before = tangent.columns.chunks_exact(2 * n);
        let both = before.zip(columns.chunks_exact_mut(2 * n)).enumerate();
        for (index, (before, to)) in both {
            let by = index.checked_sub(homogeneous).map(|by| tangent.by[by]);
            let kappa = by.map_or(0.0, |by| -field.base_by(by) / field.base());
            let (dq, dv) = before.split_at(n);
            for i in 0..n {
                let da = &moved[index * n + i];
                let (q, v) = (here.q[i], here.v[i]);
                to[i] = dq[i]
                    + part * dv[i]
                    + time * time * dot(&position, da)
                    + kappa * (2.0 * (state[i] - q) - part * v);
                to[n + i] = dv[i] + time * dot(&rate, da) + kappa * (state[n + i] - v);
            }
        }
    }
}

impl<const S: usize> Stretch for View<'_, S> {
    fn phases(&self) -> (f64, f64) {
        let start = self.engine.phase();
        (start, start + self.engine.trial.width)
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        self.state_by(&self.weights(phase), state);
    }
}
