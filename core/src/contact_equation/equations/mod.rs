//! The equations of an orbit on a [skeleton](super::skeleton), by one [`pass`] from its beginning to its end: [`integrals`] of the forces of an
//! interval, the states at all its [`targets`], and what is left when switches are [`eliminated`] too. [`setting`] is what all orbits of a branch
//! have in common, [`pass_results`] what a pass leaves for those who look at the motion.
//!
//! Over an interval of length `s` that begins at `tau_a` with the states `y_a`, at a part `psi` of it,
//!
//! ```text
//! y = e^(A psi s) (y_a - y_p(tau_a)) + y_p(tau) + int_0^(psi s) e^(A (psi s - t)) B f dt                      (1)
//! ```
//!
//! with the steady response `y_p` to the load, and the polynomials through the forces `f` at the nodes. The equations are
//!
//! ```text
//! f - phi(g, g') = 0 at the nodes,    g = level at switches,    y_end - S y_begin = 0                        (2)
//! ```
//!
//! with the image `S` of the coordinates after which the orbit comes back. Derivatives are carried along; forces are eliminated interval by
//! interval ([`chain`](crate::continuation::chain)), so that they are those by the states at the beginning and by switches. Of many modes the
//! states at the beginning are eliminated instead, mode by mode ([`paired`]). With `X f` for the integral of (1), where everything is held but the length,
//!
//! ```text
//! d(X f)/ds = X f / s + A int_0^(psi s) (psi - t / s) e^(A (psi s - t)) B f dt                                (3)
//! ```
//!
//! The map of the states is what is left when switches are eliminated too: perturbed states have their own switches.
//!
//! ```text
//! M = S^-1 (E_y - E_w W^-1 W_y),    rows E of the end, W of switches; columns y of states, w of switches      (4)
//! ```
//!
//! Intervals whose forces are affine have no `f`: (1) is then that of their [configuration](super::linear_part::configuration).
//!
//! Source: the integral equation of the periodic contact force, Babitsky (1998), Theory of Vibro-Impact Systems and Applications,
//! section 2.2, in causal form; collocation at Gauss nodes, Hairer, Norsett and Wanner (1993), section II.7.

mod eliminated;
pub(super) mod integrals;
mod paired;
pub(super) mod pass;
pub(super) mod pass_results;
pub(super) mod setting;
mod sink;
mod tables;
mod targets;
mod workspace;

use std::cell::OnceCell;
use std::f64::consts::TAU;
use std::sync::Arc;

use self::eliminated::Eliminated;
use self::pass_results::{Extremes, Image, Passed};
use self::setting::Setting;
use self::sink::Sink;
use self::workspace::Room;
use super::linear_part::block::{Block, add};
use super::linear_part::configuration::Configuration;
use super::linear_part::values::Values;
use super::skeleton::Skeleton;
use super::skeleton::placement::{Kink, Told};
use crate::continuation::arrow::links::{Basis, PairLinks};
use crate::continuation::chain::{Chain, Size};
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::continuation::problem::Problem;

/// What rounding leaves of the phase between two switches in one place.
pub(super) const BACK: f64 = 1e-9;
/// Part of the parameter's unit for differences of fourth order.
const DIFFERENCE: f64 = 1e-3;
/// An angle of which that part changes nothing that the difference does not see.
const TURNED: f64 = 3.0;

/// What of a gap.
#[derive(Debug, Clone, Copy)]
enum Of {
    Gap,
    Slope,
}

/// What derivatives a pass makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Derived {
    Nothing,
    /// Those by all that are no forces, of which there may be many.
    Chained,
    /// Those of [`paired`] equations.
    Paired,
}

/// The equations on one skeleton.
pub(super) struct Equations {
    pub(super) setting: Setting,
    pub(super) values: Values,
    /// Those of the skeleton.
    pub(super) configurations: Vec<Configuration>,
    /// What is varied where `values` are, and where they were made.
    at: f64,
    pub(super) made: f64,
    /// The frequency there, by which velocities count along a branch.
    base: f64,
    pub(super) skeleton: Skeleton,
    /// Positions and velocities that the unknowns count from.
    pub(super) reference: Vec<f64>,
    /// Weight of a phase, and of velocities, in the norm.
    pub(super) size: f64,
    /// `T` of the linear part, and its inverse.
    basis: Arc<Basis>,
    /// Residuals; derivatives of those that are not of a force at a node, by the unknowns that are none and the parameter, row by row, when
    /// forces are eliminated; and how those are. Where there are pairs they are made for the map alone.
    pub(super) residual: Vec<f64>,
    pub(super) matrix: Vec<f64>,
    pub(super) chain: Chain,
    /// The same with nothing eliminated, where that is cheaper.
    pairs: Option<Box<PairLinks>>,
    pub(super) eliminated: Eliminated,
    pub(super) passed: Vec<Passed>,
    /// Of the last pass, when they are asked for.
    pub(super) extremes: Extremes,
    /// Where slopes of forces jump between switches in it, when that is asked for.
    pub(super) kinks: OnceCell<Vec<Kink>>,
    /// Contacts in each other's place when an orbit has come back, once they were seen.
    pub(super) images: OnceCell<Vec<Image>>,
    /// The last orbit of the branch, and the last one that was found.
    pub(super) known: [Vec<f64>; 2],
    room: Room,
    /// Unknowns of the last pass, and which derivatives it has made.
    pub(super) last: Vec<f64>,
    derived: Derived,
    /// It has the derivatives by the parameter.
    by_parameter: bool,
    column: Vec<f64>,
    /// The values cannot be computed.
    pub(super) failed: bool,
}

impl Equations {
    /// On a skeleton, where what is varied has a value; `None` where the system has no such values.
    pub(super) fn new(
        setting: Setting,
        value: f64,
        skeleton: Skeleton,
        reference: Vec<f64>,
        size: f64,
    ) -> Option<Self> {
        let values = setting.values(value)?;
        let configurations = setting.configurations(&values, &skeleton)?;
        let mut equations = Self {
            basis: paired::basis(&values.linear),
            base: values.base,
            values,
            configurations,
            at: value,
            made: value,
            setting,
            skeleton,
            reference,
            size,
            residual: Vec::new(),
            matrix: Vec::new(),
            chain: Chain::default(),
            pairs: None,
            eliminated: Eliminated::default(),
            passed: Vec::new(),
            extremes: Extremes::default(),
            kinks: OnceCell::new(),
            images: OnceCell::new(),
            known: [Vec::new(), Vec::new()],
            room: Room::default(),
            last: Vec::new(),
            derived: Derived::Nothing,
            by_parameter: false,
            column: Vec::new(),
            failed: false,
        };
        equations.resize();
        Some(equations)
    }

    /// The same with more nodes.
    pub(super) fn finer_equations(&self, value: f64) -> Option<Self> {
        self.on(self.skeleton.finer(), value)
    }

    /// The same on another skeleton.
    pub(super) fn on(&self, skeleton: Skeleton, value: f64) -> Option<Self> {
        let (setting, reference) = (self.setting.clone(), self.reference.clone());
        Self::new(setting, value, skeleton, reference, self.size)
    }

    fn resize(&mut self) {
        let n = self.skeleton.unknowns();
        self.residual = vec![0.0; n];
        self.pairs = paired::links(&self.skeleton).map(Box::new);
        self.eliminated = Eliminated::default();
        self.column = vec![0.0; n];
        self.passed = vec![Passed::default(); self.skeleton.intervals.len()];
        self.room = Room::new(&self.skeleton);
        if self.pairs.is_none() {
            self.make_chain();
        }
    }

    /// Room for derivatives by all that are no forces.
    fn make_chain(&mut self) {
        let told = self.skeleton.told();
        self.matrix = vec![0.0; told * (told + 1)];
        let sizes = self.skeleton.intervals.iter().map(|interval| Size {
            count: interval.forces(),
            couples: interval.configuration.is_some(),
        });
        self.chain = Chain::new(sizes, self.skeleton.order, told);
        self.room.carry(&self.skeleton);
    }

    /// Has everything eliminated as if there were few modes.
    #[cfg(test)]
    pub(super) fn keep_chain(&mut self) {
        self.pairs = None;
        self.make_chain();
    }

    /// Derivatives as Newton's method needs them.
    fn usual(&self) -> Derived {
        if self.pairs.is_some() {
            Derived::Paired
        } else {
            Derived::Chained
        }
    }

    /// Goes over to a value of what is varied. Says whether the system has one there.
    fn set(&mut self, value: f64) -> bool {
        if value == self.at {
            return true;
        }
        if self.setting.plain {
            let divisor = f64::from(self.setting.system.facts().divisor);
            self.values.set_omega(value, divisor);
            for of in &mut self.configurations {
                of.values.set_base(self.values.base);
            }
        } else {
            let Some(values) = self.setting.values(value) else {
                return false;
            };
            let configurations = self.setting.configurations(&values, &self.skeleton);
            let Some(configurations) = configurations else {
                return false;
            };
            (self.values, self.configurations) = (values, configurations);
            self.room.forget();
            self.basis = paired::basis(&self.values.linear);
        }
        self.at = value;
        true
    }

    /// Residuals, and their derivatives by the unknowns if asked for. What the last pass has is not computed again.
    pub(super) fn pass(&mut self, u: &[f64], derivatives: bool) {
        let asked = if derivatives {
            self.usual()
        } else {
            Derived::Nothing
        };
        self.pass_for(u, asked);
    }

    /// The same with derivatives of a kind.
    fn pass_for(&mut self, u: &[f64], asked: Derived) {
        let known = self.last == u;
        if known && (self.derived == asked || asked == Derived::Nothing) {
            return;
        }
        let n = self.skeleton.unknowns();
        self.last.clear();
        // Derivatives do not move them.
        if !known {
            self.extremes = Extremes::default();
            self.kinks = OnceCell::new();
        }
        self.failed = !self.set(u[n]);
        if self.failed {
            self.residual.fill(f64::NAN);
            return;
        }
        self.last.extend_from_slice(u);
        self.derived = asked;
        self.by_parameter = false;
        if asked == Derived::Chained && self.matrix.is_empty() {
            self.make_chain();
        }
        let sign = paired::sign(&self.skeleton).unwrap_or_default();
        let sink = match (asked, &mut self.pairs) {
            (Derived::Nothing, _) => Sink::Nowhere,
            (Derived::Paired, Some(pairs)) => {
                pairs.begin(&self.basis, sign);
                Sink::Pairs(pairs)
            }
            _ => {
                self.chain.begin();
                Sink::Chain {
                    chain: &mut self.chain,
                    matrix: &mut self.matrix,
                }
            }
        };
        let omega = self.setting.at_omega(u[n]);
        let mut pass = pass::Pass {
            system: self.setting.system.as_ref(),
            values: &self.values,
            configurations: &self.configurations,
            skeleton: &self.skeleton,
            u,
            omega: self.setting.plain.then_some(omega),
            basis: &self.basis,
            residual: &mut self.residual,
            sink,
            room: &mut self.room,
        };
        pass.begin(&self.reference);
        for (interval, passed) in self.passed.iter_mut().enumerate() {
            pass.go(interval, passed);
        }
        pass.close(&self.reference);
        self.switches(u);
        // Unknowns that belong to no motion, as of a frequency of zero.
        self.failed = !self.residual.iter().all(|x| x.is_finite());
    }

    /// Equations (2) and (3) of [`skeleton`](super::skeleton).
    fn switches(&mut self, u: &[f64]) {
        for index in 0..self.skeleton.switches.len() {
            match self.skeleton.switches[index].told {
                Told::Alone => {
                    let row = self.skeleton.slot(index);
                    self.residual[row] = self.room.at_switch[index][0];
                    self.write_row(row, &[(index, Of::Gap, 1.0)], None);
                }
                Told::First { other, bend, .. } => {
                    self.touching(u, [index, other], bend);
                }
                Told::Second { .. } => {}
            }
        }
    }

    /// Those of two switches that may meet.
    fn touching(&mut self, u: &[f64], [first, second]: [usize; 2], bend: f64) {
        let rows = [first, second].map(|switch| self.skeleton.slot(switch));
        let told = self.skeleton.opened(first);
        let square = told.square(u[rows[1]]);
        let [half, by_unknown] = told.half(u[rows[1]]);
        let [a, b] = [first, second].map(|switch| self.room.at_switch[switch]);
        if half > 0.0 {
            self.residual[rows[0]] = 0.5 * (a[0] + b[0]);
            let slope = (b[0] - a[0]) / (2.0 * half);
            self.residual[rows[1]] = slope;
            let (per, own) = (0.5 / half, -slope / half * by_unknown);
            let middle = [(first, Of::Gap, 0.5), (second, Of::Gap, 0.5)];
            let apart = [(first, Of::Gap, -per), (second, Of::Gap, per)];
            self.write_row(rows[0], &middle, None);
            self.write_row(rows[1], &apart, Some((rows[1], own)));
        } else {
            self.residual[rows[0]] = a[0] + bend * square;
            self.residual[rows[1]] = a[1];
            self.write_row(rows[0], &[(first, Of::Gap, 1.0)], Some((rows[1], bend)));
            self.write_row(rows[1], &[(first, Of::Slope, 1.0)], None);
        }
    }

    /// Writes derivatives of a sum of what gaps are at switches, and adds one more by an unknown, if they are asked for.
    fn write_row(&mut self, row: usize, terms: &[(usize, Of, f64)], more: Option<(usize, f64)>) {
        let mut sink = match (self.derived, &mut self.pairs) {
            (Derived::Nothing, _) => return,
            (Derived::Paired, Some(pairs)) => Sink::Pairs(pairs),
            _ => Sink::Chain {
                chain: &mut self.chain,
                matrix: &mut self.matrix,
            },
        };
        let order = self.skeleton.order;
        let first = sink.first(order);
        let columns = self.skeleton.told() + 1 - first;
        sink.row_mut(row, [order, columns]).fill(0.0);
        for &(switch, of, factor) in terms {
            let [rows, forms] = match of {
                Of::Gap => [&self.room.switch_rows, &self.room.gap_forms],
                Of::Slope => [&self.room.slope_rows, &self.room.slope_forms],
            };
            let known = &rows[switch * columns..][..columns];
            add(sink.row_mut(row, [order, columns]), factor, known);
            let form = &forms[switch * order..][..order];
            sink.read(row, self.room.read_at[switch], factor, form);
        }
        if let Some((unknown, slope)) = more {
            sink.row_mut(row, [order, columns])[unknown - first] += slope;
        }
    }

    /// Writes the column of the parameter, where it changes more than the time.
    fn parameter_column(&mut self, u: &[f64], column: &mut [f64]) {
        let n = self.skeleton.unknowns();
        let value = u[n];
        let part = if self.set(value) {
            DIFFERENCE / (self.turned(u) / TURNED).max(1.0)
        } else {
            DIFFERENCE
        };
        let step = part * if value == 0.0 { 1.0 } else { value.abs() };
        let mut beside = u.to_vec();
        column.fill(0.0);
        // f' = (8 (f(h) - f(-h)) - (f(2h) - f(-2h))) / 12 h
        for (at, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            beside[n] = value + at * step;
            self.pass(&beside, false);
            for (column, residual) in column.iter_mut().zip(&self.residual) {
                *column += weight * residual / (12.0 * step);
            }
        }
    }

    /// The largest angle, or decay, that a configuration goes through at unknowns: what is varied may change as much of it as of itself.
    fn turned(&self, u: &[f64]) -> f64 {
        let angles = self.skeleton.intervals.iter().filter_map(|interval| {
            let of = &self.configurations[interval.configuration?];
            let rates = of.values.linear.blocks.iter().map(Block::rate);
            let [from, to] =
                [interval.from, interval.to].map(|mark| self.skeleton.place(u, mark).phase);
            let time = (to - from).abs() / self.values.base;
            Some(time * rates.fold(0.0, f64::max))
        });
        angles.fold(0.0, f64::max)
    }

    /// Whether the switches of the last pass are in the order that they are told in: those of different contacts may pass each other.
    pub(super) fn is_in_order(&self) -> bool {
        let ways = self.passed.iter().map(|passed| passed.phases);
        ways.into_iter().all(|[from, to]| to >= from - BACK)
    }

    /// Everything at unknowns: residuals, and derivatives if asked for.
    pub(super) fn compute(&mut self, u: &[f64], derivatives: bool) {
        if !derivatives || self.setting.plain || self.last == u && self.by_parameter {
            return self.pass(u, derivatives);
        }
        let mut column = std::mem::take(&mut self.column);
        self.parameter_column(u, &mut column);
        self.pass(u, true);
        let told = self.skeleton.told();
        if let Some(pairs) = &mut self.pairs {
            pairs.set_parameter(&column);
        } else {
            if self.chain.singular().is_none() {
                self.chain.set_parameter(&mut column);
            }
            for (row, slope) in column[..told].iter().enumerate() {
                self.matrix[row * (told + 1) + told] = *slope;
            }
        }
        self.column = column;
        self.by_parameter = true;
    }

    /// What counts as one in a position or velocity: velocities count by the frequency.
    pub(super) fn unit(&self, state: usize) -> f64 {
        if 2 * state < self.skeleton.order {
            1.0
        } else {
            self.values.base
        }
    }

    /// The largest residual.
    fn defect(&mut self, u: &[f64]) -> f64 {
        self.compute(u, false);
        if self.failed {
            return f64::INFINITY;
        }
        self.residual.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    }
}

impl Problem for Equations {
    fn unknowns(&self) -> usize {
        self.skeleton.unknowns()
    }

    fn partition(&self) -> Partition {
        let unknowns = self.skeleton.unknowns();
        if self.pairs.is_some() {
            return Partition::paired(unknowns, self.skeleton.order / 2);
        }
        Partition::chained(unknowns, self.skeleton.told())
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        self.compute(u, jacobian.is_some());
        residual.copy_from_slice(&self.residual);
        let Some(jacobian) = jacobian else { return };
        if let Some(pairs) = &mut self.pairs {
            jacobian.take_pairs(pairs);
            return;
        }
        // The parameter stands last in a row here as there.
        let told = self.skeleton.told();
        for (row, entries) in self.matrix.chunks_exact(told + 1).enumerate() {
            jacobian.core_mut().row_mut(row).copy_from_slice(entries);
        }
        jacobian.take_chain(&self.chain);
    }

    fn prepare(&mut self, u: &mut [f64]) {
        let known = std::mem::take(&mut self.known);
        let mut best: Option<(f64, Vec<f64>)> = None;
        for of in known.iter().filter(|of| of.len() == u.len()) {
            let mut carried = u.to_vec();
            if !self.skeleton.carry_forces(of, &mut carried) {
                continue;
            }
            let plain = best.as_ref().map_or_else(|| self.defect(u), |best| best.0);
            let defect = self.defect(&carried);
            if defect < plain {
                best = Some((defect, carried));
            }
        }
        if let Some((_, carried)) = best {
            u.copy_from_slice(&carried);
        }
        self.known = known;
    }

    fn found(&mut self, u: &[f64]) {
        self.known[1].clear();
        self.known[1].extend_from_slice(u);
    }

    fn weights(&self, weights: &mut [f64]) {
        let order = self.skeleton.order;
        // Of the equations and not of the orbit that they were asked for last: a walk that is resumed has the same.
        weights[..order / 2].fill(1.0);
        weights[order / 2..order].fill(1.0 / (self.base * self.base));
        let whole = self.size / TAU;
        let switches = self.skeleton.switches.len();
        weights[order..order + switches].fill(whole * whole);
        // Forces follow from the motion.
        weights[order + switches..].fill(0.0);
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }

    fn is_cancelled(&self) -> bool {
        self.setting.cancel.is_cancelled()
    }
}
