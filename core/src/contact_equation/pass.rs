//! One pass over an orbit: the states from cut to cut, residuals, and derivatives by all unknowns.
//!
//! Numbers of equations are those of [`equations`](super::equations).

use super::block::{Block, Pair, product, row_times, times};
use super::equations::Passed;
use super::integrals::{add, by_time, integrate};
use super::place::Place;
use super::room::Room;
use super::skeleton::{Active, Interval, Skeleton};
use super::values::{Instant, Values, dot, dot_lanes, pair};
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
        let [steady, by_phase, by_base] = &mut self.room.steady_from;
        self.values
            .write_steady(from.phase, steady, Some([by_phase, by_base]));
        let free = self.room.y.iter().zip(&*steady);
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
        if stretch.interval.active.is_empty() {
            self.target(stretch, passed, 0);
        } else {
            self.integrals(stretch);
            self.loads(stretch);
            if self.derivatives {
                self.by_time(stretch);
            }
            for index in 0..=stretch.interval.nodes.count() {
                self.target(stretch, passed, index);
            }
            self.outputs(stretch);
            for (place, active) in stretch.interval.active.iter().enumerate() {
                self.law(stretch, place, active);
            }
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
    fn loads(&mut self, stretch: &Stretch<'_>) {
        let (order, nodes) = (self.skeleton.order, stretch.interval.nodes);
        let n = nodes.count();
        let Room {
            input, load, rows, ..
        } = &mut *self.room;
        for load in &mut *load {
            load.fill(0.0);
        }
        let length = stretch.to.phase - stretch.from.phase;
        for (place, active) in stretch.interval.active.iter().enumerate() {
            let contact = &self.values.contacts[active.contact];
            for node in 0..n {
                let psi = nodes.targets[node];
                let phase = stretch.from.phase + psi * length;
                let input = &mut input[(place * n + node) * order..][..order];
                contact.input.write(phase, 0, input);
                let force = self.u[active.first + node];
                for (state, input) in input.iter().enumerate() {
                    load[0][state * n + node] += force * input;
                }
                if stretch.moves {
                    contact.input.write(phase, 1, &mut rows[0]);
                    for (state, by) in rows[0].iter().enumerate() {
                        load[1][state * n + node] += (1.0 - psi) * force * by;
                        load[2][state * n + node] += psi * force * by;
                    }
                }
            }
        }
    }

    /// How what the forces do changes with the time, (3): the integrals of both factors of every way between targets are derived.
    fn by_time(&mut self, stretch: &Stretch<'_>) {
        let (nodes, time) = (stretch.interval.nodes, stretch.time);
        let n = nodes.count();
        let room = &mut *self.room;
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let to = &mut room.by_time[r * (n + 1)..][..=n];
            let loads = &room.load[0][2 * r * n..][..2 * n];
            if block.is_free() {
                // X f = s S1 f + s^2 D S2 f
                for (index, to) in to.iter_mut().enumerate() {
                    let [once, twice] =
                        [&nodes.once, &nodes.twice].map(|table| &table[index * n..][..n]);
                    let of = |table: &[f64]| [0, 1].map(|i| dot_lanes(table, &loads[i * n..][..n]));
                    let (once, turned) = (of(once), times(block.deviation, of(twice)));
                    *to = [0, 1].map(|i| once[i] + 2.0 * time * turned[i]);
                }
            } else {
                by_time(block, nodes, time, |l| [loads[l], loads[n + l]], to);
            }
        }
    }

    /// The states at a target; at the end where there are no nodes.
    fn target(&mut self, stretch: &Stretch<'_>, passed: &mut Passed, index: usize) {
        let nodes = stretch.interval.nodes;
        let active = !stretch.interval.active.is_empty();
        let last = !active || index == nodes.count();
        let psi = if last { 1.0 } else { nodes.targets[index] };
        let phase = if last {
            stretch.to.phase
        } else {
            stretch.from.phase + psi * (stretch.to.phase - stretch.from.phase)
        };
        let (time, order) = (stretch.time, self.skeleton.order);
        let room = &mut *self.room;
        let [steady, by_phase, by_base] = &mut room.steady;
        let by = self.derivatives.then_some([&mut by_phase[..], by_base]);
        self.values.write_steady(phase, steady, by);
        let resonant =
            self.values
                .write_resonant(stretch.from.phase, psi * time, &mut room.resonant);
        let pairs = order / 2;
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let room = &mut *self.room;
            let e = block.exponential(psi * time);
            room.targets.exponentials[index * pairs + r] = e;
            let free = times(e, pair(&passed.free, r));
            let forced = if active {
                forced(room, stretch, block, [r, index], 0)
            } else {
                [0.0; 2]
            };
            for i in 0..2 {
                let at = 2 * r + i;
                let mut state = free[i] + room.steady[0][at] + forced[i];
                if resonant {
                    state += room.resonant[0][at];
                }
                room.targets.states[index * order + at] = state;
            }
            passed.forced.extend(forced);
            if self.derivatives {
                let slope = times(block.matrix, free).map(|by| psi * by);
                self.slopes(stretch, [r, index], psi, slope, resonant);
            }
        }
        let states = &self.room.targets.states[index * order..][..order];
        passed.states.extend_from_slice(states);
    }

    /// How the states of a pair at a target change with where the interval begins and ends, and with the frequency. What is free changes
    /// so with the time.
    fn slopes(
        &mut self,
        stretch: &Stretch<'_>,
        [r, index]: [usize; 2],
        psi: f64,
        free: Pair,
        resonant: bool,
    ) {
        let (time, base, order) = (stretch.time, self.values.base, self.skeleton.order);
        let count = stretch.interval.nodes.count();
        let block = &self.values.linear.blocks[r];
        let room = &mut *self.room;
        let active = !stretch.interval.active.is_empty();
        let driven = if active {
            room.by_time[r * (count + 1) + index]
        } else {
            [0.0; 2]
        };
        let moved = [1, 2].map(|which| {
            if stretch.moves {
                forced(room, stretch, block, [r, index], which)
            } else {
                [0.0; 2]
            }
        });
        let e = room.targets.exponentials[index * (order / 2) + r];
        let begun = [1, 2].map(|which| times(e, pair(&room.steady_from[which], r)));
        for i in 0..2 {
            let at = 2 * r + i;
            let mut by_time = free[i] + driven[i];
            let mut by_from = (1.0 - psi) * room.steady[1][at] - begun[0][i] + moved[0][i];
            let by_to = psi * room.steady[1][at] + moved[1][i];
            let mut by_omega = room.steady[2][at] - begun[1][i];
            if resonant {
                by_time += psi * room.resonant[1][at];
                by_from += room.resonant[2][at];
                by_omega += room.resonant[3][at];
            }
            // The base frequency is a part of the one that is varied, and the time is as long as that is short.
            if let Some(omega) = self.omega {
                by_omega = (by_omega * base - by_time * time) / omega;
            }
            let targets = &mut room.targets;
            targets.by_from[index * order + at] = by_from - by_time / base;
            targets.by_to[index * order + at] = by_to + by_time / base;
            targets.by_omega[index * order + at] = by_omega;
        }
    }

    fn instant(&self, tau: f64) -> Instant {
        let base = self.values.base;
        Instant {
            tau,
            base,
            by_omega: self.omega.map_or(0.0, |omega| base / omega),
        }
    }

    /// Gaps and rates at the nodes.
    fn outputs(&mut self, stretch: &Stretch<'_>) {
        let (order, nodes) = (self.skeleton.order, stretch.interval.nodes);
        let n = nodes.count();
        let length = stretch.to.phase - stretch.from.phase;
        for (place, active) in stretch.interval.active.iter().enumerate() {
            let contact = &self.values.contacts[active.contact];
            for node in 0..n {
                let at = place * n + node;
                let instant = self.instant(stretch.from.phase + nodes.targets[node] * length);
                let room = &mut *self.room;
                let rows = [&mut room.gap_rows, &mut room.rate_rows];
                let rows = rows.map(|rows| &mut rows[at * order..][..order]);
                let states = &room.targets.states[node * order..][..order];
                let output = contact.output(instant, states, rows, &mut room.rows[0]);
                (room.gaps[at], room.rates[at]) = (output.gap, output.rate);
                room.outputs[at] = output;
            }
        }
    }

    /// Residuals at the nodes of a contact.
    fn law(&mut self, stretch: &Stretch<'_>, place: usize, active: &Active) {
        let n = stretch.interval.nodes.count();
        let nodes = place * n..(place + 1) * n;
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
        for (node, at) in nodes.enumerate() {
            let row = active.first + node;
            self.residual[row] = self.u[row] - self.room.forces[at];
            if self.derivatives {
                self.row(stretch, at, node, row);
            }
        }
    }

    /// Derivatives of a residual at a node.
    fn row(&mut self, stretch: &Stretch<'_>, at: usize, node: usize, row: usize) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let psi = stretch.interval.nodes.targets[node];
        let known = stretch.interval.active[0].first;
        let room = &mut *self.room;
        let by = [-room.by_gap[at], -room.by_rate[at]];
        let [output, turned, _] = &mut room.rows;
        let rows = [&room.gap_rows, &room.rate_rows].map(|rows| &rows[at * order..][..order]);
        for ((output, gap), rate) in output.iter_mut().zip(rows[0]).zip(rows[1]) {
            *output = by[0] * gap + by[1] * rate;
        }
        let of = &room.outputs[at];
        let by_phase = by[0] * of.by_phase[0] + by[1] * of.by_phase[1];
        let entries = &mut self.matrix[row * columns..][..columns];
        let exponentials = &room.targets.exponentials[node * (order / 2)..][..order / 2];
        for (r, (e, block)) in exponentials
            .iter()
            .zip(&self.values.linear.blocks)
            .enumerate()
        {
            let output = pair(output, r);
            let through = row_times(output, *e);
            for i in 0..2 {
                let by = &room.by[(2 * r + i) * columns..][..columns];
                add(&mut entries[..known], through[i], &by[..known]);
                entries[columns - 1] += through[i] * by[columns - 1];
            }
            let of = row_times(output, block.deviation);
            turned[2 * r..2 * r + 2].copy_from_slice(&of);
        }
        let at_node = |of: &[f64]| dot(output, &of[node * order..][..order]);
        let from = at_node(&room.targets.by_from) + (1.0 - psi) * by_phase;
        let to = at_node(&room.targets.by_to) + psi * by_phase;
        for (unknown, slope) in stretch.from.slopes() {
            entries[unknown] += from * slope;
        }
        for (unknown, slope) in stretch.to.slopes() {
            entries[unknown] += to * slope;
        }
        if self.omega.is_some() {
            let by_omega = at_node(&room.targets.by_omega) + by[1] * of.by_omega;
            entries[columns - 1] += by_omega;
        }
        add_own(self.values, room, stretch, node, entries);
        entries[row] += 1.0;
    }

    /// Goes over to the states at the end.
    fn end(&mut self, stretch: &Stretch<'_>) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let n = stretch.interval.nodes.count();
        let index = if stretch.interval.active.is_empty() {
            0
        } else {
            n
        };
        let room = &mut *self.room;
        let states = &room.targets.states[index * order..][..order];
        room.y.copy_from_slice(states);
        if !self.derivatives {
            return;
        }
        let size = (n + 1) * n;
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let e = room.targets.exponentials[index * (order / 2) + r];
            let (one, other) = room.by[2 * r * columns..][..2 * columns].split_at(columns);
            for i in 0..2 {
                let row = &mut room.by_next[(2 * r + i) * columns..][..columns];
                for ((to, one), other) in row.iter_mut().zip(one).zip(other) {
                    *to = e[i][0] * one + e[i][1] * other;
                }
                let at = index * order + 2 * r + i;
                for (unknown, slope) in stretch.from.slopes() {
                    row[unknown] += room.targets.by_from[at] * slope;
                }
                for (unknown, slope) in stretch.to.slopes() {
                    row[unknown] += room.targets.by_to[at] * slope;
                }
                if self.omega.is_some() {
                    row[columns - 1] += room.targets.by_omega[at];
                }
            }
            for (place, active) in stretch.interval.active.iter().enumerate() {
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

    /// Gap less level where an interval ends, and its slope. Everything that they depend on is in the states there.
    fn at_switch(&mut self, stretch: &Stretch<'_>, switch: usize) {
        let (columns, base) = (self.columns(), self.values.base);
        let of = self.skeleton.switches[switch];
        let contact = &self.values.contacts[of.contact];
        let instant = self.instant(stretch.to.phase);
        let room = &mut *self.room;
        let [gap, rate, another] = &mut room.rows;
        let output = contact.output(instant, &room.y, [gap, rate], another);
        room.at_switch[switch] = [output.gap - contact.levels[of.level], output.rate / base];
        if !self.derivatives {
            return;
        }
        let by_omega = |omega: f64| (output.by_omega - output.rate / omega) / base;
        let sides = [
            (&*gap, &mut room.switch_rows, 1.0, 0.0),
            (
                &*rate,
                &mut room.slope_rows,
                1.0 / base,
                self.omega.map_or(0.0, by_omega),
            ),
        ];
        for ((of, rows, factor, by_omega), by_phase) in sides.into_iter().zip(output.by_phase) {
            let row = &mut rows[switch * columns..][..columns];
            row.fill(0.0);
            for (x, by) in of.iter().zip(room.by.chunks_exact(columns)) {
                if *x != 0.0 {
                    add(row, factor * x, by);
                }
            }
            for (unknown, slope) in stretch.to.slopes() {
                row[unknown] += factor * by_phase * slope;
            }
            row[columns - 1] += by_omega;
        }
    }
}

/// What forces, or one of their changes, have done to a pair of states up to a target.
fn forced(
    room: &Room,
    stretch: &Stretch<'_>,
    block: &Block,
    [r, index]: [usize; 2],
    which: usize,
) -> Pair {
    let n = stretch.interval.nodes.count();
    let size = (n + 1) * n;
    let of = |table: &[f64]| {
        let row = &table[r * size + index * n..][..n];
        [0, 1].map(|i| dot_lanes(row, &room.load[which][(2 * r + i) * n..][..n]))
    };
    let (plain, turned) = (of(&room.once), times(block.deviation, of(&room.twice)));
    [0, 1].map(|i| plain[i] + turned[i])
}

/// Adds the derivatives of what depends like a row on the states at a node by the forces in the interval.
fn add_own(values: &Values, room: &Room, stretch: &Stretch<'_>, node: usize, entries: &mut [f64]) {
    let [output, turned, _] = &room.rows;
    let (order, n) = (output.len(), stretch.interval.nodes.count());
    let size = (n + 1) * n;
    for (place, active) in stretch.interval.active.iter().enumerate() {
        let moves = !values.contacts[active.contact].input.is_constant();
        let entries = &mut entries[active.first..active.first + n];
        for r in 0..order / 2 {
            let [output, turned] = [output, turned].map(|of| pair(of, r));
            let once = &room.once[r * size + node * n..][..n];
            let twice = &room.twice[r * size + node * n..][..n];
            let input = |l: usize| pair(&room.input[(place * n + l) * order..], r);
            if moves {
                for (l, entry) in entries.iter_mut().enumerate() {
                    let input = input(l);
                    *entry += once[l] * product(output, input) + twice[l] * product(turned, input);
                }
            } else {
                let [x, y] = [output, turned].map(|of| product(of, input(0)));
                for ((entry, once), twice) in entries.iter_mut().zip(once).zip(twice) {
                    *entry += once * x + twice * y;
                }
            }
        }
    }
}
