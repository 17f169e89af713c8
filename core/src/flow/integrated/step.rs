//! One step of collocation, to a given phase or to a level.
//!
//! The accelerations `a_j` at the nodes are iterated: positions and rates from them by (2) of [`map`](super::map), forces
//! from those. The iteration converges as `(theta^2)^k / (2 k)!` on a step that a vibration passes by the angle `theta`, so
//! that long steps cost few evaluations, and each evaluation is one batch.
//!
//! A step that ends on a level has its width as one more unknown: after every sweep it is corrected by
//!
//! ```text
//! dwidth = (level - g_end) / (g_end' / Omega)                                                                 (1)
//! ```
//!
//! so that the law is never asked for gaps beyond its piece once the iteration has settled, and the switch is where the
//! motion itself is. (Henon (1982), On the numerical computation of Poincare maps, has the same aim with the gap as the
//! independent variable, which fails where the gap turns.)
//!
//! Source: Hairer, Lubich and Wanner (2006), Geometric Numerical Integration, sections II.1.4 and VIII.6.

use multiversion::multiversion;

use crate::flow::FlowError;
use crate::flow::field::{Anchor, End};

use super::engine::Engine;
use super::map::Tables;

/// Sweeps before a step is given up.
const MOST_SWEEPS: usize = 30;
/// Sweeps that may grow.
const FIRST_SWEEPS: usize = 6;
/// What is left of the iteration, in parts of the tolerance.
const ITERATED: f64 = 0.01;
/// The largest change of the width in one correction (1).
const LARGEST_CORRECTION: f64 = 0.3;

/// What became of an iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Solved {
    Yes,
    No,
}

/// The convergence of an iteration.
#[derive(Debug, Clone, Copy)]
struct Convergence {
    sweep: usize,
    change: f64,
}

impl Convergence {
    const NEW: Self = Self {
        sweep: 0,
        change: f64::INFINITY,
    };

    /// Takes the change of a sweep; whether the iteration is over, and how.
    fn next(&mut self, change: f64, enough: f64) -> Option<Solved> {
        let ratio = (change / self.change).min(1.0);
        let grows = self.sweep >= FIRST_SWEEPS && change > 0.9 * self.change;
        self.sweep += 1;
        self.change = change;
        if change.is_nan() || change == f64::INFINITY {
            return Some(Solved::No);
        }
        if change * ratio <= enough && self.sweep > 1 {
            return Some(Solved::Yes);
        }
        (grows || self.sweep == MOST_SWEEPS).then_some(Solved::No)
    }
}

impl<const S: usize> Engine<'_, S> {
    /// Solves the step of a given width.
    pub(super) fn solve(&mut self, width: f64, table: usize) -> Solved {
        self.trial.width = width;
        self.trial.table = table;
        self.trial.landing = None;
        let tables = &self.tables[table];
        let phase = self.here.from + self.here.passed;
        self.field
            .place(&mut self.batch, phase, width, &tables.passed, &tables.left);
        for (a, here) in self.batch.a.iter_mut().zip(&self.instant.a) {
            *a = [here[0]; S];
        }
        self.anchor(None);
        let mut convergence = Convergence::NEW;
        loop {
            self.integrate();
            let change = self.sweep();
            if let Some(solved) = convergence.next(change, ITERATED * self.tolerance) {
                self.integrate();
                self.finish();
                return solved;
            }
        }
    }

    /// Solves the step that ends on a level of a contact, from a guess of its width and the states of the last trial.
    pub(super) fn land(
        &mut self,
        guess: f64,
        table: usize,
        contact: usize,
        level: usize,
    ) -> Solved {
        self.resample(guess, table);
        self.trial.width = guess;
        self.trial.table = table;
        self.trial.landing = Some((contact, level));
        self.anchor(Some((contact, level)));
        let phase = self.here.from + self.here.passed;
        let value = self.field.contacts[contact].levels[level];
        let mut convergence = Convergence::NEW;
        for _ in 0..MOST_SWEEPS + 10 {
            let tables = &self.tables[table];
            let width = self.trial.width;
            self.field
                .place(&mut self.batch, phase, width, &tables.passed, &tables.left);
            let change = self.sweep();
            self.integrate();
            self.finish();
            let gap = self
                .field
                .gap(contact, &self.trial.q, &self.trial.v, phase + width);
            let by_phase = gap.rate / self.field.base();
            let correction = (value - gap.value) / by_phase;
            let rounding =
                4.0 * f64::EPSILON * ((gap.size + value.abs()) / by_phase.abs() + width.abs());
            let solved = convergence.next(change, ITERATED * self.tolerance);
            if solved == Some(Solved::No) || !correction.is_finite() {
                return Solved::No;
            }
            if correction.abs() <= rounding && solved == Some(Solved::Yes) {
                return Solved::Yes;
            }
            let most = LARGEST_CORRECTION * width.abs();
            self.trial.width += correction.clamp(-most, most);
        }
        Solved::No
    }

    /// Gaps are measured from the start of the step; that of a contact which lands, from its level at the end.
    fn anchor(&mut self, landing: Option<(usize, usize)>) {
        for (anchor, gap) in self.anchors.iter_mut().zip(&self.here.gaps) {
            *anchor = Anchor {
                end: End::Start,
                gap: gap.value,
            };
        }
        if let Some((contact, level)) = landing {
            self.anchors[contact] = Anchor {
                end: End::End,
                gap: self.field.contacts[contact].levels[level],
            };
        }
    }

    /// Rates and positions at the nodes from the accelerations there.
    fn integrate(&mut self) {
        let time = self.time();
        let tables = &self.tables[self.trial.table];
        let batch = &mut self.batch;
        for i in 0..self.here.q.len() {
            let (q, v) = (self.here.q[i], self.here.v[i]);
            let [start, end] = &mut batch.shift;
            let rows = (&mut batch.v[i], &mut start[i]);
            integrate(tables, time, v, &batch.a[i], rows);
            batch.q[i] = start[i].map(|shift| q + shift);
            if self.trial.landing.is_some() {
                integrate_left(tables, time, v, &batch.a[i], &mut end[i]);
            }
        }
    }

    /// The state at the end.
    fn finish(&mut self) {
        let time = self.time();
        let tables = &self.tables[self.trial.table];
        for i in 0..self.here.q.len() {
            let a = &self.batch.a[i];
            let v = self.here.v[i];
            self.trial.v[i] = v + time * dot(&tables.end_rate, a);
            self.trial.q[i] = self.here.q[i] + time * (v + time * dot(&tables.end_position, a));
        }
        self.batch.ends[0].copy_from_slice(&self.here.q);
        self.batch.ends[1].copy_from_slice(&self.trial.q);
    }

    /// New accelerations; how much rates change by that, relative to their scales.
    fn sweep(&mut self) -> f64 {
        let time = self.time();
        self.batch.ends[0].copy_from_slice(&self.here.q);
        self.before[0].copy_from_slice(&self.batch.a);
        self.field
            .accelerate(&mut self.batch, &self.here.pieces, &self.anchors);
        self.work.forces += S;
        let mut change = 0.0_f64;
        for i in 0..self.here.q.len() {
            let [mut most, mut size] = [0.0_f64; 2];
            for j in 0..S {
                let difference = self.batch.a[i][j] - self.before[0][i][j];
                most = larger(most, difference.abs());
                size = larger(size, self.batch.v[i][j].abs());
            }
            let [position, rate] = self.scales(&self.here.sizes, i);
            // On a step that is short beside the motion's own time, an error of the rate hardly moves the position.
            change = larger(
                change,
                time.abs() * most / larger(rate, size).max(position * self.field.base().abs()),
            );
        }
        change
    }

    /// States at the nodes of another step from the same start, from those of the last trial.
    fn resample(&mut self, width: f64, table: usize) {
        let n = self.here.q.len();
        self.before[0].copy_from_slice(&self.batch.q);
        self.before[1].copy_from_slice(&self.batch.v);
        let map = self.tables[self.trial.table].map;
        let scale = width / self.trial.width;
        let mut q_end = [0.0; 2];
        for j in 0..S {
            let passed = scale * self.tables[table].passed[j];
            let u = map.inverse(passed, 1.0 - passed);
            self.rule.interpolation(u, &mut self.weights);
            let w = &self.weights;
            for i in 0..n {
                let at = |start: f64, rows: &[[f64; S]], end: f64| {
                    let inner: f64 = rows[i].iter().zip(&w[1..]).map(|(x, w)| x * w).sum();
                    w[0] * start + inner + w[S + 1] * end
                };
                self.batch.q[i][j] = at(self.here.q[i], &self.before[0], self.trial.q[i]);
                self.batch.v[i][j] = at(self.here.v[i], &self.before[1], self.trial.v[i]);
            }
        }
        let u = map.inverse(scale, 1.0 - scale);
        self.rule.interpolation(u, &mut self.weights);
        for i in 0..n {
            let inner: f64 = self.before[0][i]
                .iter()
                .zip(&self.weights[1..])
                .map(|(x, w)| x * w)
                .sum();
            q_end[0] =
                self.weights[0] * self.here.q[i] + inner + self.weights[S + 1] * self.trial.q[i];
            self.batch.ends[1][i] = q_end[0];
            for j in 0..S {
                self.batch.shift[0][i][j] = self.batch.q[i][j] - self.here.q[i];
                self.batch.shift[1][i][j] = self.batch.q[i][j] - q_end[0];
            }
        }
    }

    /// The error of the motion on this step in parts of the tolerance, from how fast its Legendre coefficients fall.
    pub(super) fn error(&self) -> f64 {
        let time = self.time().abs();
        let tables = &self.tables[self.trial.table];
        let mut sizes = self.here.sizes.clone();
        for (i, size) in sizes.iter_mut().enumerate() {
            for j in 0..S {
                size[0] = larger(size[0], self.batch.q[i][j].abs());
                size[1] = larger(size[1], self.batch.v[i][j].abs());
            }
        }
        let mut error = 0.0_f64;
        for i in 0..sizes.len() {
            let [position, rate] = self.scales(&sizes, i);
            let of_rate = tail(tables, &self.batch.a[i]) * time / (2 * S) as f64;
            error = larger(error, of_rate / rate);
            error = larger(error, of_rate * time / (2 * S) as f64 / position);
        }
        error / self.tolerance
    }

    /// Takes the trial over.
    pub(super) fn accept(&mut self) -> Result<(), FlowError> {
        for i in 0..self.here.q.len() {
            let size = &mut self.here.sizes[i];
            for j in 0..S {
                size[0] = size[0].max(self.batch.q[i][j].abs());
                size[1] = size[1].max(self.batch.v[i][j].abs());
            }
        }
        self.here.q.copy_from_slice(&self.trial.q);
        self.here.v.copy_from_slice(&self.trial.v);
        self.here.passed += self.trial.width;
        self.here.on.fill(None);
        self.work.steps += 1;
        let finite = self
            .here
            .q
            .iter()
            .chain(&self.here.v)
            .all(|x| x.is_finite());
        if finite {
            Ok(())
        } else {
            Err(FlowError::NotFinite {
                phase: self.phase(),
            })
        }
    }
}

/// The size of the first Legendre coefficient that is left out, from the last four that are known.
pub(super) fn tail<const S: usize>(tables: &Tables<S>, a: &[f64; S]) -> f64 {
    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|index| dot(&tables.highest[index], a).abs());
    let (last, before) = (c0 + c1, c2 + c3);
    let ratio = if before > 0.0 {
        (last / before).sqrt().min(1.0)
    } else {
        1.0
    };
    last * ratio
}

/// The larger of two numbers; a NaN if either is one.
pub(super) fn larger(x: f64, y: f64) -> f64 {
    if x > y || x.is_nan() { x } else { y }
}

pub(super) fn dot<const S: usize>(x: &[f64; S], y: &[f64; S]) -> f64 {
    let mut sum = 0.0;
    for j in 0..S {
        sum += x[j] * y[j];
    }
    sum
}

/// Equation (2) of [`map`](super::map): rates and changes of position at the nodes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn integrate<const S: usize>(
    tables: &Tables<S>,
    time: f64,
    v: f64,
    a: &[f64; S],
    (rate, shift): (&mut [f64; S], &mut [f64; S]),
) {
    let (mut first, mut second) = ([0.0; S], [0.0; S]);
    for k in 0..S {
        for j in 0..S {
            first[j] += tables.rate[k][j] * a[k];
            second[j] += tables.position[k][j] * a[k];
        }
    }
    for j in 0..S {
        rate[j] = v + time * first[j];
        shift[j] = time * (tables.passed[j] * v + time * second[j]);
    }
}

/// Changes of position at the nodes since the end: the negative of what is still to come.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn integrate_left<const S: usize>(
    tables: &Tables<S>,
    time: f64,
    v: f64,
    a: &[f64; S],
    shift: &mut [f64; S],
) {
    let mut sum = [0.0; S];
    for k in 0..S {
        for j in 0..S {
            sum[j] += tables.position_left[k][j] * a[k];
        }
    }
    for j in 0..S {
        shift[j] = -time * (tables.left[j] * v + time * sum[j]);
    }
}
