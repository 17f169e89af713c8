//! One pass over an orbit: the states from cut to cut by (1), residuals by (2), and derivatives by all unknowns, by the length of an interval
//! as in (3).
//!
//! Numbers of equations are those of [`equations`](crate::contact_equation::equations).

use super::integrals::Loaded;
use super::pass_results::Passed;
use super::sink::Sink;
use super::targets::Way;
use super::workspace::Room;
use crate::contact_equation::linear_part::block::{add, add_both, pair, row_times};
use crate::contact_equation::linear_part::configuration::Configuration;
use crate::contact_equation::linear_part::contact::Instant;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::interval::{Active, Interval};
use crate::contact_equation::skeleton::phases::Place;
use crate::continuation::arrow::links::Basis;
use crate::law::{Derivatives, On};
use crate::numeric::linear::{add_product, dot};
use crate::system::System;

/// Time of an interval whose ends are in one place by chance, as where several gaps have their extremes at once. They move apart when unknowns
/// change, and what changes with the time is divided by it.
const HARDLY: f64 = 1e-150;

/// A pass at unknowns.
pub(super) struct Pass<'p> {
    pub(in crate::contact_equation) system: &'p dyn System,
    pub(in crate::contact_equation) values: &'p Values,
    pub(in crate::contact_equation) configurations: &'p [Configuration],
    pub(in crate::contact_equation) skeleton: &'p Skeleton,
    pub(in crate::contact_equation) u: &'p [f64],
    /// The frequency, where it is varied and nothing but the time depends on it.
    pub(in crate::contact_equation) omega: Option<f64>,
    /// `T` of the linear part.
    pub(in crate::contact_equation) basis: &'p Basis,
    pub(in crate::contact_equation) residual: &'p mut [f64],
    pub(in crate::contact_equation) sink: Sink<'p>,
    pub(in crate::contact_equation) room: &'p mut Room,
}

/// An interval at these unknowns.
struct Stretch<'i> {
    index: usize,
    interval: &'i Interval,
    /// What has its forces, if it is not the linear part alone.
    configuration: Option<&'i Configuration>,
    from: Place,
    to: Place,
    /// In units of time.
    time: f64,
    /// The first unknown that rows of derivatives have.
    first: usize,
}

impl Stretch<'_> {
    /// Adds the derivatives of what changes so with where the interval begins and ends. The places of these are among the first columns.
    fn add_slopes(&self, [from, to, _]: [f64; 3], row: &mut [f64]) {
        for (unknown, slope) in self.from.slopes() {
            row[unknown - self.first] += from * slope;
        }
        for (unknown, slope) in self.to.slopes() {
            row[unknown - self.first] += to * slope;
        }
    }
}

impl Pass<'_> {
    /// States where the period begins if rows have them, switches, and the parameter.
    fn columns(&self) -> usize {
        self.skeleton.told() + 1 - self.first()
    }

    /// The first unknown that rows of derivatives have.
    fn first(&self) -> usize {
        self.sink.first(self.skeleton.order)
    }

    fn derivatives(&self) -> bool {
        self.sink.is_asked()
    }

    /// The states where the period begins. Unknown there are positions and velocities, whatever the modes are.
    pub(in crate::contact_equation) fn begin(&mut self, reference: &[f64]) {
        let (order, columns) = (self.skeleton.order, self.columns());
        for i in 0..order {
            let row = self.basis.from.row(i);
            let known = row.map(|(j, x)| x * (self.u[j] + reference[j]));
            self.room.y[i] = known.sum();
        }
        if !matches!(self.sink, Sink::Chain { .. }) {
            return;
        }
        self.room.by.fill(0.0);
        for i in 0..order {
            for (j, x) in self.basis.from.row(i) {
                self.room.by[i * columns + j] = x;
            }
        }
    }

    /// Residuals of the period.
    pub(super) fn close(&mut self, reference: &[f64]) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let image = &self.skeleton.recurrence().image;
        let last = self.skeleton.intervals.len() - 1;
        for i in 0..order {
            let (place, sign) = image.state_entry(i, order / 2);
            let known = self.u[place] + reference[place];
            let through = self.basis.to.row(i).map(|(j, x)| x * self.room.y[j]);
            self.residual[i] = through.sum::<f64>() - sign * known;
            // Where there are pairs it is known how they come back.
            let Sink::Chain { chain, matrix } = &mut self.sink else {
                continue;
            };
            let row = &mut matrix[i * columns..][..columns];
            row.fill(0.0);
            let form = &mut self.room.rows[0];
            form.fill(0.0);
            for (j, factor) in self.basis.to.row(i) {
                form[j] = factor;
                add(row, factor, &self.room.by[j * columns..][..columns]);
            }
            chain.read(i, last, 1.0, form);
            row[place] -= sign;
        }
    }

    /// Over an interval. Where two contacts switch in another order than they are told in, its way is negative, and (1) goes back: to first
    /// order in it the forces do what they do in the right order.
    pub(super) fn go(&mut self, index: usize, passed: &mut Passed) {
        let interval = &self.skeleton.intervals[index];
        let from = self.skeleton.place(self.u, interval.from);
        let to = self.skeleton.place(self.u, interval.to);
        let way = (to.phase - from.phase) / self.values.base;
        let nowhere = way == 0.0 && self.skeleton.is_within_pair(interval);
        let time = if way == 0.0 { HARDLY } else { way };
        let stretch = Stretch {
            index,
            interval,
            configuration: interval
                .configuration
                .map(|index| &self.configurations[index]),
            from,
            to,
            time,
            first: self.first(),
        };
        let values = stretch.configuration.map_or(self.values, |of| &of.values);
        passed.phases = [from.phase, to.phase];
        let [steady, by_phase, by_base] = &mut self.room.steady_from;
        values.write_steady(from.phase, steady, Some([by_phase, by_base]));
        let begun = match stretch.configuration {
            Some(of) => {
                of.take(&self.room.y, &mut self.room.rows[0]);
                &self.room.rows[0]
            }
            None => &self.room.y,
        };
        let free = begun.iter().zip(&*steady);
        passed.free.clear();
        passed.free.extend(free.map(|(y, steady)| y - steady));
        passed.forced.clear();
        passed.load.clear();
        passed.stiffness.clear();
        if matches!(self.sink, Sink::Chain { .. }) {
            let nodes = interval.active.len() * interval.nodes.count();
            passed.stiffness.resize(nodes, 0.0);
        }
        passed.states.clear();
        passed.states.extend_from_slice(&self.room.y);
        self.sink.clear(index);
        if nowhere {
            self.nowhere(&stretch);
        } else {
            self.interior(&stretch, passed);
        }
        if let Some(switch) = interval.ends {
            self.at_switch(&stretch, switch);
        }
    }

    /// There is no way between the two switches of a pair that do not take place, wherever they are: the forces there are zero.
    fn nowhere(&mut self, stretch: &Stretch<'_>) {
        let interval = stretch.interval;
        let first = interval.first();
        for row in first..first + interval.forces() {
            self.residual[row] = self.u[row];
            if let Some([own, ..]) = self.sink.equation_mut(stretch.index, row - first) {
                own[row - first] = 1.0;
            }
        }
        self.room.by_next.fill(0.0);
        self.pass_on(stretch);
    }

    /// Eliminates the forces of an interval, whose derivatives are written.
    fn pass_on(&mut self, stretch: &Stretch<'_>) {
        if let Sink::Chain { chain, .. } = &mut self.sink {
            let room = &mut *self.room;
            chain.pass(stretch.index, &room.by, &mut room.by_next);
            std::mem::swap(&mut room.by, &mut room.by_next);
        }
    }

    /// Nodes of an interval, and the states at its end.
    fn interior(&mut self, stretch: &Stretch<'_>, passed: &mut Passed) {
        let active = &stretch.interval.active[..];
        let (loaded, derivatives) = (self.loaded(stretch), self.derivatives());
        let room = &mut *self.room;
        let place = room.integrals_of[stretch.index];
        if !active.is_empty() {
            room.integrals[place].fill(&loaded);
        }
        let [_, by_phase, by_base] = &room.steady_from;
        let whole = [1.0];
        let way = Way {
            values: stretch.configuration.map_or(self.values, |of| &of.values),
            phases: loaded.phases,
            time: loaded.time,
            psi: if active.is_empty() {
                &whole
            } else {
                &loaded.nodes.targets
            },
            free: &passed.free,
            begun: [by_phase, by_base],
            integrals: (!active.is_empty()).then(|| &room.integrals[place]),
            omega: self.omega,
            derivatives,
        };
        room.targets.fill(&way);
        let targets = way.psi.len();
        if let Some(of) = stretch.configuration {
            self.end_of(of, stretch);
            passed.states.extend_from_slice(&self.room.y);
            return;
        }
        self.pass_by(stretch, targets, passed);
        for (place, active) in active.iter().enumerate() {
            self.outputs(stretch, place, active);
            self.law(stretch, place, active);
        }
        let nodes = passed.stiffness.len();
        passed.stiffness.copy_from_slice(&self.room.by_gap[..nodes]);
        self.end(stretch);
    }

    fn loaded<'l>(&self, stretch: &Stretch<'l>) -> Loaded<'l>
    where
        Self: 'l,
    {
        Loaded {
            interval: stretch.index,
            values: self.values,
            nodes: stretch.interval.nodes,
            active: &stretch.interval.active,
            phases: [stretch.from.phase, stretch.to.phase],
            time: stretch.time,
            u: self.u,
            derivatives: self.derivatives(),
        }
    }

    /// Leaves the states at the targets, and what forces did to them, for whoever looks at the motion.
    fn pass_by(&self, stretch: &Stretch<'_>, targets: usize, passed: &mut Passed) {
        let order = self.skeleton.order;
        let place = self.room.integrals_of[stretch.index];
        let forced = !stretch.interval.active.is_empty();
        if forced {
            passed
                .load
                .extend_from_slice(self.room.integrals[place].load());
        }
        for target in 0..targets {
            let states = (0..order).map(|state| self.room.targets.state(target, state));
            passed.states.extend(states);
            if forced {
                let integrals = &self.room.integrals[place];
                let of = (0..order).map(|state| integrals.forced(0, state)[target]);
                passed.forced.extend(of);
            }
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

    /// Gaps and rates of a contact at the nodes.
    fn outputs(&mut self, stretch: &Stretch<'_>, place: usize, active: &Active) {
        let (order, n) = (self.skeleton.order, stretch.interval.nodes.count());
        let contact = &self.values.contacts[active.contact];
        for node in 0..n {
            let at = place * n + node;
            let instant = self.instant(self.room.targets.phases[node]);
            let room = &mut *self.room;
            let rows = [&mut room.gap_rows, &mut room.rate_rows];
            let rows = rows.map(|rows| &mut rows[at * order..][..order]);
            let [states, another, _] = &mut room.rows;
            room.targets.write(node, states);
            let output = contact.output(instant, states, rows, another);
            (room.gaps[at], room.rates[at]) = (output.gap, output.rate);
            room.outputs[at] = output;
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
            if !self.room.forces[at].is_finite() {
                self.hold(active, at);
            }
            let row = active.first + node;
            self.residual[row] = self.u[row] - self.room.forces[at];
            if self.derivatives() {
                self.row(stretch, at, node, row);
            }
        }
    }

    /// Takes the force at the level where there is none beyond it, as of a power: guesses lie there, and orbits where switches of two contacts
    /// pass each other.
    fn hold(&mut self, active: &Active, at: usize) {
        let contact = &self.values.contacts[active.contact];
        let room = &mut *self.room;
        let gap = contact.held(active.piece, room.gaps[at]);
        let out = Derivatives {
            force: &mut room.forces[at..=at],
            by_gap: &mut room.by_gap[at..=at],
            by_rate: &mut room.by_rate[at..=at],
        };
        let (law, piece) = (self.system.law(contact.law), On::Piece(active.piece));
        law.derivatives(piece, &contact.arguments, &[gap], &[room.rates[at]], out);
        room.by_gap[at] = 0.0;
    }

    /// Derivatives of a residual at a node.
    fn row(&mut self, stretch: &Stretch<'_>, at: usize, node: usize, row: usize) {
        let order = self.skeleton.order;
        let psi = stretch.interval.nodes.targets[node];
        let loaded = self.loaded(stretch);
        let room = &mut *self.room;
        let by = [-room.by_gap[at], -room.by_rate[at]];
        let [output, turned, _] = &mut room.rows;
        let rows = [&room.gap_rows, &room.rate_rows].map(|rows| &rows[at * order..][..order]);
        for ((output, gap), rate) in output.iter_mut().zip(rows[0]).zip(rows[1]) {
            *output = by[0] * gap + by[1] * rate;
        }
        let local = row - stretch.interval.first();
        let Some([own, by_states, direct]) = self.sink.equation_mut(stretch.index, local) else {
            return;
        };
        let of = &room.outputs[at];
        let by_phase = by[0] * of.by_phase[0] + by[1] * of.by_phase[1];
        let mut slopes = [(1.0 - psi) * by_phase, psi * by_phase, by[1] * of.by_omega];
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let output = pair(output, r);
            let through = row_times(output, block.deviation);
            turned[2 * r..2 * r + 2].copy_from_slice(&through);
            let [c, k] = room.targets.kernel(node, r);
            for i in 0..2 {
                by_states[2 * r + i] = c * output[i] + k * through[i];
                let by = room.targets.slopes(node, 2 * r + i);
                for (to, by) in slopes.iter_mut().zip(by) {
                    *to += output[i] * by;
                }
            }
        }
        stretch.add_slopes(slopes, direct);
        if self.omega.is_some() {
            direct[direct.len() - 1] += slopes[2];
        }
        room.integrals[room.integrals_of[stretch.index]].add_own(
            &loaded,
            0..order / 2,
            [output, turned],
            node,
            own,
        );
        own[local] += 1.0;
    }

    /// Goes over to the states at the end.
    fn end(&mut self, stretch: &Stretch<'_>) {
        let active = &stretch.interval.active[..];
        let target = if active.is_empty() {
            0
        } else {
            stretch.interval.nodes.count()
        };
        let loaded = self.loaded(stretch);
        let room = &mut *self.room;
        room.targets.write(target, &mut room.y);
        for (r, block) in self.values.linear.blocks.iter().enumerate() {
            let [c, k] = room.targets.kernel(target, r);
            let d = block.deviation;
            for i in 0..2 {
                let state = 2 * r + i;
                let Some([carried, driven]) = self.sink.state_mut(stretch.index, state) else {
                    return;
                };
                for (j, carried) in carried.iter_mut().enumerate() {
                    *carried = c * f64::from(u8::from(i == j)) + k * d[i][j];
                }
                if !active.is_empty() {
                    // Nothing but the pair is looked at.
                    let [unit_row, turned, _] = &mut room.rows;
                    let place = 2 * r..2 * r + 2;
                    unit_row[place.clone()].copy_from_slice(&[0.0; 2]);
                    unit_row[state] = 1.0;
                    turned[place].copy_from_slice(&d[i]);
                    room.integrals[room.integrals_of[stretch.index]].add_own(
                        &loaded,
                        r..r + 1,
                        [unit_row, turned],
                        target,
                        driven,
                    );
                }
            }
        }
        self.move_end(stretch, target);
        self.pass_on(stretch);
    }

    /// How the states at the end move with the ends of the interval and with the parameter.
    fn move_end(&mut self, stretch: &Stretch<'_>, target: usize) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let room = &mut *self.room;
        let varied = self.omega.is_some();
        match &mut self.sink {
            Sink::Nowhere => {}
            Sink::Chain { .. } => {
                for state in 0..order {
                    let direct = &mut room.by_next[state * columns..][..columns];
                    direct.fill(0.0);
                    let slopes = room.targets.slopes(target, state);
                    stretch.add_slopes(slopes, direct);
                    if varied {
                        direct[columns - 1] += slopes[2];
                    }
                }
            }
            Sink::Pairs(pairs) => {
                let link = pairs.link_mut(stretch.index);
                let places = [stretch.from, stretch.to].map(|place| place.slopes());
                let first = stretch.first;
                link.set_ends(places.map(|of| of.map(move |(unknown, by)| (unknown - first, by))));
                for state in 0..order {
                    let [from, to, omega] = room.targets.slopes(target, state);
                    *link.slopes_mut(state) = [from, to, if varied { omega } else { 0.0 }];
                }
            }
        }
    }

    /// The same where forces are in a configuration: states are taken over to it where the interval begins, and given back, so that
    /// derivatives are `S E S^-1` with those `E` of its own states.
    fn end_of(&mut self, of: &Configuration, stretch: &Stretch<'_>) {
        let (order, columns) = (self.skeleton.order, self.columns());
        let room = &mut *self.room;
        room.targets.write(0, &mut room.rows[0]);
        of.give(&room.rows[0], &mut room.y);
        // Where there are pairs, there are no configurations.
        let Sink::Chain { chain, .. } = &mut self.sink else {
            return;
        };
        let [to, from] = &of.rows;
        for (r, block) in of.values.linear.blocks.iter().enumerate() {
            let [c, k] = room.targets.kernel(0, r);
            let d = block.deviation;
            let pair = from[2 * r * order..][..2 * order].split_at(order);
            for i in 0..2 {
                let row = &mut room.carried[(2 * r + i) * order..][..order];
                row.fill(0.0);
                let mut factors = d[i].map(|x| k * x);
                factors[i] += c;
                add_both(pair.into(), factors, row);
            }
        }
        let link = chain.link_mut(stretch.index);
        let all = link.all_carried_mut();
        all.fill(0.0);
        add_product(to, &room.carried, order, all, &mut room.placed);
        let slopes = room.targets.slopes_at_one(order);
        for (state, factors) in to.chunks_exact(order).enumerate() {
            let direct = &mut room.by_next[state * columns..][..columns];
            direct.fill(0.0);
            let slopes = slopes.map(|by| dot(factors, by));
            stretch.add_slopes(slopes, direct);
            if self.omega.is_some() {
                direct[columns - 1] += slopes[2];
            }
        }
        self.pass_on(stretch);
    }

    /// Gap less level where an interval ends, and its slope. Everything that they depend on is in the states there.
    fn at_switch(&mut self, stretch: &Stretch<'_>, switch: usize) {
        let (columns, base) = (self.columns(), self.values.base);
        let (asked, chained) = (self.derivatives(), matches!(self.sink, Sink::Chain { .. }));
        let of = self.skeleton.switches[switch];
        let contact = &self.values.contacts[of.contact];
        let instant = self.instant(stretch.to.phase);
        let room = &mut *self.room;
        let [gap, rate, another] = &mut room.rows;
        let output = contact.output(instant, &room.y, [gap, rate], another);
        room.at_switch[switch] = [output.gap - contact.levels[of.level], output.rate / base];
        if !asked {
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
            // Where there are pairs, forms of the states are enough.
            let through = of.iter().zip(room.by.chunks_exact(columns));
            for (x, by) in through.filter(|(x, _)| chained && **x != 0.0) {
                add(row, factor * x, by);
            }
            stretch.add_slopes([0.0, factor * by_phase, 0.0], row);
            row[columns - 1] += by_omega;
        }
        room.read_at[switch] = stretch.index;
        let forms = [&mut room.gap_forms, &mut room.slope_forms];
        for ((of, forms), factor) in [&*gap, &*rate]
            .into_iter()
            .zip(forms)
            .zip([1.0, 1.0 / base])
        {
            let order = of.len();
            for (to, of) in forms[switch * order..].iter_mut().zip(of) {
                *to = factor * of;
            }
        }
    }
}
