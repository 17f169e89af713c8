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

use crate::time::FlowError;
use crate::time::field::batch::{Anchor, End};

use super::engine::{Engine, write_scales};
use super::map::Tables;
use super::rule::{dot, tail};

/// Sweeps before a step is given up.
const MOST_SWEEPS: usize = 30;
/// Sweeps that may grow.
const FIRST_SWEEPS: usize = 6;
/// Sweeps after which a gap off its piece is likely to stay there, if it is off by a part of what it moves on the step.
const WATCH_FROM: usize = 3;
const CLEARLY: f64 = 0.05;
/// What is left of the iteration, in parts of the tolerance.
const ITERATED: f64 = 0.01;
/// Rounding of the width of a landing, in parts of what it is made of.
const SETTLED: f64 = 4.0 * f64::EPSILON;
/// The largest change of the width in one correction (1).
const LARGEST_CORRECTION: f64 = 0.3;

/// What became of an iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Solved {
    Yes,
    No,
    /// Not to the end: a gap leaves its piece.
    Strays,
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

    /// Takes the change of a sweep, in parts of the motion; whether the iteration is over, and how. From a change of more than the motion itself,
    /// as where an iterate runs far up an exponential, the ratio to the next is none of a contraction.
    fn next(&mut self, change: f64, enough: f64) -> Option<Solved> {
        let ratio = if self.change <= 1.0 {
            (change / self.change).min(1.0)
        } else {
            1.0
        };
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

impl<const S: usize> Engine<S> {
    /// Solves the step of a given width. If asked to, ends early where a gap leaves its piece.
    pub(super) fn solve(&mut self, width: f64, table: usize, watch: bool) -> Solved {
        self.guess(width, table);
        let mut convergence = Convergence::NEW;
        loop {
            self.integrate();
            let change = self.sweep();
            let solved = convergence.next(change, ITERATED * self.tolerance);
            let strays = watch && convergence.sweep >= WATCH_FROM && self.strays();
            if solved.is_some() || strays {
                self.integrate();
                self.finish();
                return solved.unwrap_or(Solved::Strays);
            }
        }
    }

    /// Starts a step of a width with the acceleration that it has at its start.
    pub(super) fn guess(&mut self, width: f64, table: usize) {
        self.trial.width = width;
        self.trial.table = table;
        self.trial.landing = None;
        self.place();
        for (a, here) in self.batch.a.iter_mut().zip(&self.instant.a) {
            *a = [here[0]; S];
        }
        self.anchor(None);
        self.integrate();
        self.finish();
    }

    /// Puts the nodes where they are.
    fn place(&mut self) {
        let phase = self.phase();
        let tables = &self.tables[self.trial.table];
        let parts = (&tables.passed, &tables.left);
        self.field
            .place(&mut self.batch, phase, self.trial.width, parts);
    }

    /// Solves the step that ends on a level of a contact, from a guess of its width and of its states.
    pub(super) fn land(
        &mut self,
        guess: f64,
        table: usize,
        contact: usize,
        level: usize,
    ) -> Solved {
        self.trial.width = guess;
        self.trial.table = table;
        self.trial.landing = Some((contact, level));
        self.anchor(None);
        self.place();
        let start = self.phase();
        let value = self.field.contacts[contact].levels[level];
        let mut before = f64::INFINITY;
        for sweep in 0..MOST_SWEEPS {
            let change = self.sweep();
            self.integrate();
            self.finish();
            let width = self.trial.width;
            let gap = self
                .field
                .gap(contact, &self.trial.q, &self.trial.v, start + width);
            let by_phase = gap.rate / self.field.base();
            let correction = (value - gap.value) / by_phase;
            if !correction.is_finite() || !change.is_finite() {
                return Solved::No;
            }
            let size = gap.size.max(self.here.gaps[contact].size) + value.abs();
            let size = size / by_phase.abs() + width.abs();
            let settled = correction.abs() <= SETTLED * size;
            let remains = match sweep {
                // This change is from what was not the same step.
                0 => f64::INFINITY,
                1 => change,
                _ if before > 1.0 => change,
                _ => change * (change / before).min(1.0),
            };
            before = change;
            if remains <= ITERATED * self.tolerance && settled {
                // Measured from the start until here: an iteration from both ends would converge as one of a boundary
                // value problem, slowly.
                self.anchor(Some((contact, level)));
                self.sweep();
                self.integrate();
                self.finish();
                return Solved::Yes;
            }
            if !settled {
                let most = LARGEST_CORRECTION * width.abs();
                self.widen(correction.clamp(-most, most));
            }
        }
        Solved::No
    }

    /// Makes the step wider by a little.
    fn widen(&mut self, growth: f64) {
        self.trial.width += growth;
        let phase = self.phase();
        let tables = &self.tables[self.trial.table];
        let parts = (&tables.passed, &tables.left);
        self.field
            .widen(&mut self.batch, phase, self.trial.width, growth, parts);
        self.drift(growth);
    }

    /// Moves the states at the nodes along the motion once the width has grown by a little: frozen at their old places in
    /// the step they would have to be iterated anew.
    fn drift(&mut self, growth: f64) {
        let time = growth / self.field.base();
        let passed = &self.tables[self.trial.table].passed;
        let batch = &mut self.batch;
        for i in 0..self.here.q.len() {
            for j in 0..S {
                let (time, v, a) = (time * passed[j], batch.v[i][j], batch.a[i][j]);
                let shift = time * (v + 0.5 * time * a);
                batch.v[i][j] = v + time * a;
                batch.q[i][j] += shift;
                batch.shift[0][i][j] += shift;
            }
        }
    }

    /// Whether a gap at a node is clearly off its piece.
    fn strays(&self) -> bool {
        self.batch
            .contacts
            .iter()
            .enumerate()
            .any(|(contact, samples)| {
                let levels = &self.field.contacts[contact].levels;
                let piece = self.here.pieces[contact];
                let anchor = self.anchors[contact].gap;
                let (mut least, mut most) = (anchor, anchor);
                for rise in &samples.rise {
                    least = least.min(anchor + rise);
                    most = most.max(anchor + rise);
                }
                let margin = CLEARLY * (most - least);
                piece
                    .checked_sub(1)
                    .is_some_and(|lower| least < levels[lower] - margin)
                    || levels.get(piece).is_some_and(|upper| most > upper + margin)
            })
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
            let (rate, shift) = (&mut batch.v[i], &mut start[i]);
            integrate(tables, time, v, &batch.a[i], rate, shift);
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
        let time = self.time().abs();
        let base = self.field.base().abs();
        self.batch.ends[0].copy_from_slice(&self.here.q);
        self.before[0].copy_from_slice(&self.batch.a);
        self.field
            .accelerate(&mut self.batch, &self.here.pieces, &self.anchors);
        self.work.forces += S;
        let mut change = 0.0_f64;
        for (i, &[position, rate]) in self.scales.iter().enumerate() {
            let most = largest_difference(&self.batch.a[i], &self.before[0][i]);
            let scale = rate.max(base * position).max(largest(&self.batch.v[i]));
            change = larger(change, time * most / scale);
        }
        change
    }

    /// States at the nodes of another step from the same start, from those of the last trial.
    pub(super) fn resample(&mut self, width: f64, table: usize) {
        let n = self.here.q.len();
        self.before[0].copy_from_slice(&self.batch.q);
        self.before[1].copy_from_slice(&self.batch.v);
        let map = self.tables[self.trial.table].map;
        let scale = width / self.trial.width;
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
            let end =
                self.weights[0] * self.here.q[i] + inner + self.weights[S + 1] * self.trial.q[i];
            self.trial.q[i] = end;
            self.batch.shift[0][i] = self.batch.q[i].map(|q| q - self.here.q[i]);
        }
    }

    /// Has errors relative to the motion as far as it is known: a trial that was not taken may have run far away from it.
    pub(super) fn scale(&mut self) {
        write_scales(&self.here.sizes, self.field.base(), &mut self.scales);
    }

    /// The error of the motion on this step in parts of the tolerance, from how fast its Legendre coefficients fall.
    pub(super) fn error(&mut self) -> f64 {
        let time = self.time().abs();
        let tables = &self.tables[self.trial.table];
        for (i, size) in self.trial.sizes.iter_mut().enumerate() {
            let [position, rate] = self.here.sizes[i];
            *size = [
                larger(position, largest(&self.batch.q[i])),
                larger(rate, largest(&self.batch.v[i])),
            ];
        }
        write_scales(&self.trial.sizes, self.field.base(), &mut self.scales);
        let mut error = 0.0_f64;
        for (i, &[position, rate]) in self.scales.iter().enumerate() {
            let of_rate = tail(&tables.highest, &self.batch.a[i]) * time / (2 * S) as f64;
            error = larger(error, of_rate / rate);
            error = larger(error, of_rate * time / (2 * S) as f64 / position);
        }
        error / self.tolerance
    }

    /// Takes the trial over.
    pub(super) fn accept(&mut self) -> Result<(), FlowError> {
        self.here.sizes.copy_from_slice(&self.trial.sizes);
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

/// The larger of two numbers; a NaN if either is one.
pub(super) fn larger(x: f64, y: f64) -> f64 {
    if x > y || x.is_nan() { x } else { y }
}

/// The largest size of a row's entries; a NaN or the largest of the others if there are NaNs.
#[inline]
fn largest<const S: usize>(x: &[f64; S]) -> f64 {
    let mut most = [0.0_f64; 4];
    for part in x.chunks_exact(4) {
        for l in 0..4 {
            most[l] = most[l].max(part[l].abs());
        }
    }
    most[0].max(most[1]).max(most[2].max(most[3]))
}

/// The largest size of the entries' differences; infinite if they are not finite.
#[inline]
fn largest_difference<const S: usize>(x: &[f64; S], y: &[f64; S]) -> f64 {
    let mut difference = [0.0; S];
    let mut sum = 0.0;
    for j in 0..S {
        difference[j] = x[j] - y[j];
        sum += 0.0 * difference[j];
    }
    if sum == 0.0 {
        largest(&difference)
    } else {
        f64::INFINITY
    }
}

/// Equation (2) of [`map`](super::map): rates and changes of position at the nodes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn integrate<const S: usize>(
    tables: &Tables<S>,
    time: f64,
    v: f64,
    a: &[f64; S],
    rate: &mut [f64; S],
    shift: &mut [f64; S],
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
