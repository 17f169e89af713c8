//! One pass over an orbit: the states from cut to cut, residuals, and derivatives by all unknowns.
//!
//! Numbers of equations are those of [`equations`](super::equations).

use super::block::{Block, product, row_times, times};
use super::equations::Passed;
use super::integrals::{add, by_time, by_time_of_free, integrate};
use super::place::Place;
use super::room::Room;
use super::skeleton::{Active, Interval, Skeleton};
use super::values::{Values, dot, pair};
use crate::law::{Derivatives, On};
use crate::system::System;

/// A pass at unknowns.
pub(super) struct Pass<'p> {
    pub(super) system: &'p dyn System,
    pub(super) values: &'p Values,
    pub(super) skeleton: &'p Skeleton,
    pub(super) u: &'p [f64],
    /// The frequency, where it is varied and nothing but the time depends on it.
    pub(super) omega: Option<f64>,
    pub(super) derivatives: bool,
    pub(super) residual: &'p mut [f64],
    pub(super) matrix: &'p mut [f64],
    pub(super) room: &'p mut Room,
}

/// An interval at these unknowns.
struct Stretch<'i> {
    interval: &'i Interval,
    from: Place,
    to: Place,
    /// In units of time.
    time: f64,
    /// Input directions move with the phase.
    moves: bool,
}

impl Pass<'_> {
    fn columns(&self) -> usize {
        self.u.len()
    }

    fn pairs(&self) -> usize {
        self.values.linear.blocks.len()
    }

    /// The states where the period begins. Unknown there are positions and velocities, whatever the modes are.
    pub(super) fn begin(&mut self, reference: &[f64]) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let inverse = &self.values.linear.inverse;
        self.room.by.fill(0.0);
        for i in 0..order {
            let row = &mut self.room.by[i * columns..][..order];
            self.room.y[i] = 0.0;
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = inverse[(i, j)];
                self.room.y[i] += *entry * (self.u[j] + reference[j]);
            }
        }
    }

    /// Residuals of the period.
    pub(super) fn close(&mut self, reference: &[f64]) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let linear = &self.values.linear;
        let n = order / 2;
        for i in 0..order {
            let half = if i < n {
                &linear.positions
            } else {
                &linear.velocities
            };
            let through = half.row(i % n);
            let known = self.u[i] + reference[i];
            let pairs = through.iter().zip(&self.room.y);
            self.residual[i] = pairs.map(|(a, y)| a * y).sum::<f64>() - known;
            if !self.derivatives {
                continue;
            }
            let row = &mut self.matrix[i * columns..][..columns];
            for (factor, by) in through.iter().zip(self.room.by.chunks_exact(columns)) {
                if *factor != 0.0 {
                    add(row, *factor, by);
                }
            }
            row[i] -= 1.0;
        }
    }

    /// Over an interval.
    pub(super) fn go(&mut self, interval: &Interval, passed: &mut Passed) {
        let from = self.skeleton.place(self.u, interval.from);
        let to = self.skeleton.place(self.u, interval.to);
        let time = (to.phase - from.phase) / self.values.base;
        let mut moving = interval.active.iter();
        let stretch = Stretch {
            interval,
            from,
            to,
            time,
            moves: moving.any(|active| !self.values.contacts[active.contact].input.is_constant()),
        };
        passed.phases = [from.phase, to.phase];
        self.values
            .write_steady(from.phase, &mut self.room.steady_from);
        let free = self.room.y.iter().zip(&self.room.steady_from[0]);
        passed.free.clear();
        passed.free.extend(free.map(|(y, steady)| y - steady));
        passed.forced.clear();
        passed.states.clear();
        passed.states.extend_from_slice(&self.room.y);
        if time > 0.0 {
            self.interior(&stretch, passed);
        } else {
            self.nowhere(interval);
        }
        if let Some(switch) = interval.ends {
            self.at_switch(&stretch, switch);
        }
    }

    /// There is no way between two switches that do not take place: the forces there are zero.
    fn nowhere(&mut self, interval: &Interval) {
        let columns = self.columns();
        for active in &interval.active {
            for row in active.first..active.first + interval.nodes.count() {
                self.residual[row] = self.u[row];
                if self.derivatives {
                    self.matrix[row * columns + row] = 1.0;
                }
            }
        }
    }

    /// Nodes of an interval, and the states at its end.
    fn interior(&mut self, stretch: &Stretch<'_>, passed: &mut Passed) {
        let nodes = stretch.interval.nodes;
        if stretch.interval.active.is_empty() {
            self.target(stretch, passed, nodes.count());
        } else {
            self.integrals(stretch);
            self.inputs(stretch);
            if self.derivatives {
                self.by_time(stretch);
            }
            for node in 0..nodes.count() {
                self.target(stretch, passed, node);
                for place in 0..stretch.interval.active.len() {
                    self.node(stretch, place, node);
                }
            }
            self.laws(stretch);
            self.target(stretch, passed, nodes.count());
        }
        self.end(stretch);
    }

    /// Integrals of (1) up to every target, from target to target:
    /// `X(t + h) = e^(A h) X(t) + int_t^(t + h)`.
    fn integrals(&mut self, stretch: &Stretch<'_>) {
        let (nodes, time) = (stretch.interval.nodes, stretch.time);
        let n = nodes.count();
        let size = (n + 1) * n;
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let once = &mut self.room.once[r * size..][..size];
            let twice = &mut self.room.twice[r * size..][..size];
            if block.is_free() {
                for (to, of) in once.iter_mut().zip(&nodes.once) {
                    *to = time * of;
                }
                for (to, of) in twice.iter_mut().zip(&nodes.twice) {
                    *to = time * time * of;
                }
                continue;
            }
            integrate(block, nodes, time, once, twice);
        }
    }

    /// What the forces at the nodes do to the states.
    fn inputs(&mut self, stretch: &Stretch<'_>) {
        let (order, nodes) = (self.skeleton.order, stretch.interval.nodes);
        let n = nodes.count();
        self.room.load.fill(0.0);
        self.room.load_by.fill(0.0);
        let length = stretch.to.phase - stretch.from.phase;
        for (place, active) in stretch.interval.active.iter().enumerate() {
            let contact = &self.values.contacts[active.contact];
            for node in 0..n {
                let phase = stretch.from.phase + nodes.targets[node] * length;
                let input = &mut self.room.input[(place * n + node) * order..][..order];
                contact.input.write(phase, 0, input);
                let force = self.u[active.first + node];
                add(&mut self.room.load[node * order..][..order], force, input);
                if stretch.moves {
                    let by = &mut self.room.target.by_from;
                    contact.input.write(phase, 1, by);
                    add(&mut self.room.load_by[node * order..][..order], force, by);
                }
            }
        }
    }

    /// How what the forces do changes with the time, (3): the integrals of both factors of every way between targets are derived.
    fn by_time(&mut self, stretch: &Stretch<'_>) {
        let (nodes, time) = (stretch.interval.nodes, stretch.time);
        let (order, n) = (self.skeleton.order, nodes.count());
        let room = &mut *self.room;
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let to = &mut room.by_time[r * (n + 1)..][..=n];
            let load = |l: usize| pair(&room.load[l * order..], r);
            if block.is_free() {
                by_time_of_free(block, nodes, time, load, to);
            } else {
                by_time(block, nodes, time, load, to);
            }
        }
    }

    /// The states at a target.
    fn target(&mut self, stretch: &Stretch<'_>, passed: &mut Passed, index: usize) {
        let nodes = stretch.interval.nodes;
        let psi = nodes.targets[index];
        let length = stretch.to.phase - stretch.from.phase;
        let phase = if index == nodes.count() {
            stretch.to.phase
        } else {
            stretch.from.phase + psi * length
        };
        let (time, base) = (stretch.time, self.values.base);
        let room = &mut *self.room;
        self.values.write_steady(phase, &mut room.steady);
        let resonant =
            self.values
                .write_resonant(stretch.from.phase, psi * time, &mut room.resonant);
        (room.target.psi, room.target.phase) = (psi, phase);
        for r in 0..self.values.linear.blocks.len() {
            let block = self.values.linear.blocks[r];
            let e = block.exponential(psi * time);
            room.exponentials[r] = e;
            let free = times(e, pair(&passed.free, r));
            let forced = forced(room, stretch, &block, [r, index]);
            let moved = times(block.matrix, free);
            let driven = if stretch.interval.active.is_empty() {
                [0.0; 2]
            } else {
                room.by_time[r * (nodes.count() + 1) + index]
            };
            let begun = [1, 2].map(|which| times(e, pair(&room.steady_from[which], r)));
            for i in 0..2 {
                let at = 2 * r + i;
                let mut by_time = psi * moved[i] + driven[i];
                let target = &mut room.target;
                target.state[at] = free[i] + room.steady[0][at] + forced[0][i];
                target.by_from[at] = (1.0 - psi) * room.steady[1][at] - begun[0][i] + forced[1][i];
                target.by_to[at] = psi * room.steady[1][at] + forced[2][i];
                target.by_omega[at] = room.steady[2][at] - begun[1][i];
                if resonant {
                    target.state[at] += room.resonant[0][at];
                    by_time += psi * room.resonant[1][at];
                    target.by_from[at] += room.resonant[2][at];
                    target.by_omega[at] += room.resonant[3][at];
                }
                target.by_from[at] -= by_time / base;
                target.by_to[at] += by_time / base;
                // The base frequency is a part of the one that is varied, and the time is as long as that is short.
                if let Some(omega) = self.omega {
                    target.by_omega[at] *= base / omega;
                    target.by_omega[at] -= by_time * time / omega;
                }
                passed.forced.push(forced[0][i]);
            }
        }
        passed.states.extend_from_slice(&room.target.state);
    }

    /// Writes gap or rate of a contact at the target, less what it is in the equations of motion, and returns it with its explicit
    /// derivatives by the phase and by the varied frequency.
    fn output(&mut self, contact: usize, rate: bool) -> [f64; 3] {
        let contact = &self.values.contacts[contact];
        let (room, base) = (&mut *self.room, self.values.base);
        let tau = room.target.phase;
        let state = &room.target.state;
        let per = self.omega.map_or(0.0, |omega| base / omega);
        let [gap, other] = &mut room.output;
        let [gap_by, other_by] = &mut room.output_by;
        if !rate {
            contact.gap.write(tau, 0, gap);
            contact.gap.write(tau, 1, gap_by);
            let value = dot(gap, state) - contact.offset.value(tau, 0);
            let by_phase = dot(gap_by, state) - contact.offset.value(tau, 1);
            return [value, by_phase, 0.0];
        }
        // g' = d . q' + (d' . q - delta') tau'
        contact.rate.write(tau, 0, other);
        contact.rate.write(tau, 1, other_by);
        contact.gap.write(tau, 1, gap_by);
        let turning = dot(gap_by, state) - contact.offset.value(tau, 1);
        let value = dot(other, state) + base * turning;
        add(other, base, gap_by);
        let mut by_phase = dot(other_by, state) - base * contact.offset.value(tau, 2);
        contact.gap.write(tau, 2, gap_by);
        by_phase += base * dot(gap_by, state);
        gap.copy_from_slice(other);
        [value, by_phase, turning * per]
    }

    /// Gap or rate at the target, and its derivatives by the extended unknowns, but for those of the forces in the interval.
    fn output_row(
        &mut self,
        stretch: &Stretch<'_>,
        contact: usize,
        rate: bool,
        row: &mut [f64],
    ) -> f64 {
        let [value, by_phase, by_omega] = self.output(contact, rate);
        if !self.derivatives {
            return value;
        }
        let columns = self.columns();
        row.fill(0.0);
        let room = &*self.room;
        let output = &room.output[0];
        for (r, e) in room.exponentials.iter().enumerate() {
            let through = row_times(pair(output, r), *e);
            for i in 0..2 {
                if through[i] != 0.0 {
                    add(
                        row,
                        through[i],
                        &room.by[(2 * r + i) * columns..][..columns],
                    );
                }
            }
        }
        let target = &room.target;
        let from = dot(output, &target.by_from) + (1.0 - target.psi) * by_phase;
        let to = dot(output, &target.by_to) + target.psi * by_phase;
        for (unknown, slope) in stretch.from.slopes() {
            row[unknown] += from * slope;
        }
        for (unknown, slope) in stretch.to.slopes() {
            row[unknown] += to * slope;
        }
        if self.omega.is_some() {
            row[columns - 1] += dot(output, &target.by_omega) + by_omega;
        }
        value
    }

    /// Adds the derivatives by the forces in the interval, up to a target.
    fn add_own(&self, stretch: &Stretch<'_>, index: usize, row: &mut [f64]) {
        let (order, n) = (self.skeleton.order, stretch.interval.nodes.count());
        let size = (n + 1) * n;
        let room = &*self.room;
        for (place, active) in stretch.interval.active.iter().enumerate() {
            let row = &mut row[active.first..active.first + n];
            for (r, block) in self.values.linear.blocks.iter().enumerate() {
                let output = pair(&room.output[0], r);
                let turned = row_times(output, block.deviation);
                let once = &room.once[r * size + index * n..][..n];
                let twice = &room.twice[r * size + index * n..][..n];
                for (l, entry) in row.iter_mut().enumerate() {
                    let input = pair(&room.input[(place * n + l) * order..], r);
                    *entry += once[l] * product(output, input) + twice[l] * product(turned, input);
                }
            }
        }
    }

    /// Gap and rate of an active contact at a node.
    fn node(&mut self, stretch: &Stretch<'_>, place: usize, node: usize) {
        let columns = self.columns();
        let at = place * stretch.interval.nodes.count() + node;
        let contact = stretch.interval.active[place].contact;
        for rate in [false, true] {
            let rows = if rate {
                &mut self.room.rate_rows
            } else {
                &mut self.room.gap_rows
            };
            let mut rows = std::mem::take(rows);
            let row = &mut rows[at * columns..][..columns];
            let value = self.output_row(stretch, contact, rate, row);
            if self.derivatives {
                self.add_own(stretch, node, row);
            }
            if rate {
                self.room.rates[at] = value;
                self.room.rate_rows = rows;
            } else {
                self.room.gaps[at] = value;
                self.room.gap_rows = rows;
            }
        }
    }

    /// Residuals at the nodes.
    fn laws(&mut self, stretch: &Stretch<'_>) {
        let n = stretch.interval.nodes.count();
        for (place, active) in stretch.interval.active.iter().enumerate() {
            self.law(active, place * n..(place + 1) * n);
        }
    }

    fn law(&mut self, active: &Active, nodes: std::ops::Range<usize>) {
        let columns = self.columns();
        let contact = &self.values.contacts[active.contact];
        let room = &mut *self.room;
        let out = Derivatives {
            force: &mut room.forces[nodes.clone()],
            by_gap: &mut room.by_gap[nodes.clone()],
            by_rate: &mut room.by_rate[nodes.clone()],
        };
        let (gaps, rates) = (&room.gaps[nodes.clone()], &room.rates[nodes.clone()]);
        let law = self.system.law(contact.law);
        law.derivatives(
            On::Piece(active.piece),
            &contact.arguments,
            gaps,
            rates,
            out,
        );
        for (l, at) in nodes.enumerate() {
            let row = active.first + l;
            self.residual[row] = self.u[row] - room.forces[at];
            if !self.derivatives {
                continue;
            }
            let (by_gap, by_rate) = (room.by_gap[at], room.by_rate[at]);
            let entries = &mut self.matrix[row * columns..][..columns];
            let gap = &room.gap_rows[at * columns..][..columns];
            for (entry, gap) in entries.iter_mut().zip(gap) {
                *entry = -by_gap * gap;
            }
            if by_rate != 0.0 {
                add(
                    entries,
                    -by_rate,
                    &room.rate_rows[at * columns..][..columns],
                );
            }
            entries[row] += 1.0;
        }
    }

    /// Goes over to the states at the end.
    fn end(&mut self, stretch: &Stretch<'_>) {
        self.room.y.copy_from_slice(&self.room.target.state);
        if !self.derivatives {
            return;
        }
        let (order, columns) = (self.skeleton.order, self.columns());
        for r in 0..self.pairs() {
            let e = self.room.exponentials[r];
            let room = &mut *self.room;
            for i in 0..2 {
                let row = &mut room.by_next[(2 * r + i) * columns..][..columns];
                row.fill(0.0);
                add(row, e[i][0], &room.by[2 * r * columns..][..columns]);
                add(row, e[i][1], &room.by[(2 * r + 1) * columns..][..columns]);
                for (unknown, slope) in stretch.from.slopes() {
                    row[unknown] += room.target.by_from[2 * r + i] * slope;
                }
                for (unknown, slope) in stretch.to.slopes() {
                    row[unknown] += room.target.by_to[2 * r + i] * slope;
                }
                if self.omega.is_some() {
                    row[columns - 1] += room.target.by_omega[2 * r + i];
                }
            }
        }
        let n = stretch.interval.nodes.count();
        let size = (n + 1) * n;
        let room = &mut *self.room;
        for (place, active) in stretch.interval.active.iter().enumerate() {
            for (r, block) in self.values.linear.blocks.iter().enumerate() {
                let once = &room.once[r * size + n * n..][..n];
                let twice = &room.twice[r * size + n * n..][..n];
                for l in 0..n {
                    let input = pair(&room.input[(place * n + l) * order..], r);
                    let turned = times(block.deviation, input);
                    for i in 0..2 {
                        room.by_next[(2 * r + i) * columns + active.first + l] +=
                            once[l] * input[i] + twice[l] * turned[i];
                    }
                }
            }
        }
        std::mem::swap(&mut room.by, &mut room.by_next);
    }

    /// Gap less level where an interval ends.
    fn at_switch(&mut self, stretch: &Stretch<'_>, switch: usize) {
        let columns = self.columns();
        let of = self.skeleton.switches[switch];
        let level = self.values.contacts[of.contact].levels[of.level];
        // Everything that an output depends on is in the states there.
        let room = &mut *self.room;
        room.exponentials.fill([[1.0, 0.0], [0.0, 1.0]]);
        room.target.psi = 1.0;
        room.target.phase = stretch.to.phase;
        room.target.state.copy_from_slice(&room.y);
        for by in [
            &mut room.target.by_from,
            &mut room.target.by_to,
            &mut room.target.by_omega,
        ] {
            by.fill(0.0);
        }
        let mut rows = std::mem::take(&mut self.room.switch_rows);
        let row = &mut rows[switch * columns..][..columns];
        let gap = self.output_row(stretch, of.contact, false, row);
        self.room.switch_rows = rows;
        let mut rows = std::mem::take(&mut self.room.slope_rows);
        let row = &mut rows[switch * columns..][..columns];
        let rate = self.output_row(stretch, of.contact, true, row);
        let base = self.values.base;
        for entry in &mut rows[switch * columns..][..columns] {
            *entry /= base;
        }
        if let Some(omega) = self.omega {
            rows[(switch + 1) * columns - 1] -= rate / (base * omega);
        }
        self.room.slope_rows = rows;
        self.room.at_switch[switch] = [gap - level, rate / base];
    }
}

/// What forces have done to a pair of states up to a target, and how it changes with where the interval begins and ends, if directions
/// move.
fn forced(
    room: &Room,
    stretch: &Stretch<'_>,
    block: &Block,
    [r, index]: [usize; 2],
) -> [[f64; 2]; 3] {
    let mut sums = [[0.0; 2]; 3];
    if stretch.interval.active.is_empty() {
        return sums;
    }
    let nodes = stretch.interval.nodes;
    let n = nodes.count();
    let size = (n + 1) * n;
    let order = room.y.len();
    let once = &room.once[r * size + index * n..][..n];
    let twice = &room.twice[r * size + index * n..][..n];
    let (mut plain, mut turned) = (sums, sums);
    if !stretch.moves {
        for l in 0..n {
            let load = pair(&room.load[l * order..], r);
            for i in 0..2 {
                plain[0][i] += once[l] * load[i];
                turned[0][i] += twice[l] * load[i];
            }
        }
        let through = times(block.deviation, turned[0]);
        sums[0] = [0, 1].map(|i| plain[0][i] + through[i]);
        return sums;
    }
    for l in 0..n {
        let psi = nodes.targets[l];
        let load = pair(&room.load[l * order..], r);
        let by = pair(&room.load_by[l * order..], r);
        for i in 0..2 {
            let of = [load[i], (1.0 - psi) * by[i], psi * by[i]];
            for (which, of) in of.into_iter().enumerate() {
                plain[which][i] += once[l] * of;
                turned[which][i] += twice[l] * of;
            }
        }
    }
    for which in 0..3 {
        let through = times(block.deviation, turned[which]);
        sums[which] = [0, 1].map(|i| plain[which][i] + through[i]);
    }
    sums
}
