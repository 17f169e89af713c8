//! How gaps, forces and accelerations move along a direction: the derivatives of (1), (2) and (3) of [`slopes`](super).

use super::instant::times;
use super::{Direction, Instant, Moved, Slopes};
use crate::law::{Derivatives, On, Variation};
use crate::laws::single::Single;
use crate::model::layout::Term;
use crate::system::Wave;

impl Slopes {
    /// The derivative of (1) along a direction.
    pub(super) fn gap_along(
        &self,
        contact: usize,
        at: &Instant,
        direction: Direction<'_>,
    ) -> [f64; 2] {
        let n = self.layout.coordinates;
        let (q, v) = at.state.split_at(n);
        let (dq, dv) = direction.state.split_at(n);
        let layout = &self.layout.contacts[contact];
        let base = [self.base, direction.by.map_or(0.0, |by| by.base)];
        let value = |term: &Term| self.value(term.coefficient, direction);
        let mut sum = [0.0; 2];
        for term in &layout.gap {
            let [w, slope, bend] = self.wave(term.wave, at);
            let (dw, dslope) = (slope * direction.phase, bend * direction.phase);
            let ([d, dd], i) = (value(term), term.index);
            sum[0] += dd * w * q[i] + d * (dw * q[i] + w * dq[i]);
            sum[1] += dd * (w * v[i] + base[0] * slope * q[i])
                + d * (dw * v[i] + w * dv[i] + base[1] * slope * q[i])
                + d * base[0] * (dslope * q[i] + slope * dq[i]);
        }
        for term in &layout.offset {
            let [w, slope, bend] = self.wave(term.wave, at);
            let (dw, dslope) = (slope * direction.phase, bend * direction.phase);
            let [delta, ddelta] = value(term);
            sum[0] -= ddelta * w + delta * dw;
            sum[1] -= (ddelta * base[0] + delta * base[1]) * slope + delta * base[0] * dslope;
        }
        sum
    }

    /// A coefficient, and how it moves.
    pub(in crate::sensitivity) fn value(
        &self,
        coefficient: usize,
        direction: Direction<'_>,
    ) -> [f64; 2] {
        let by = direction.by.map_or(0.0, |by| by.coefficients[coefficient]);
        [self.coefficients[coefficient], by]
    }

    /// (2)
    fn force_along(&self, contact: usize, at: &Instant, direction: Direction<'_>) -> f64 {
        let Single {
            by_gap, by_rate, ..
        } = at.forces[contact];
        let layout = &self.layout.contacts[contact];
        let law = self.system.law(layout.law);
        if law.facts().pieces[at.pieces[contact]].force == Variation::Zero {
            return 0.0;
        }
        let [dg, dr] = self.gap_along(contact, at, direction);
        let mut change = by_gap * dg + by_rate * dr;
        let Some(by) = direction.by else {
            return change;
        };
        for &(argument, coefficient) in &layout.arguments {
            if by.coefficients[coefficient] != 0.0 {
                change += self.by_argument(contact, at, argument) * by.coefficients[coefficient];
            }
        }
        change
    }

    /// The derivative of a force by an argument: computed once at an instant, however many directions ask for it.
    fn by_argument(&self, contact: usize, at: &Instant, argument: usize) -> f64 {
        let kept = &at.by_arguments[self.first_argument[contact] + argument];
        kept.get().unwrap_or_else(|| {
            let by = self.computed_by_argument(contact, at, argument);
            kept.set(Some(by));
            by
        })
    }

    fn computed_by_argument(&self, contact: usize, at: &Instant, argument: usize) -> f64 {
        let law = self.system.law(self.layout.contacts[contact].law);
        let [gap, rate] = at.gaps[contact];
        let (mut force, mut by_gap, mut by_rate, mut by) = ([0.0], [0.0], [0.0], [0.0]);
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        let on = On::Piece(at.pieces[contact]);
        let arguments = &self.contacts[contact].arguments;
        law.derivatives_and_by(argument, on, arguments, &[gap], &[rate], out, &mut by);
        by[0]
    }

    /// (3), and the derivatives of all forces.
    pub(super) fn move_forces(&self, at: &Instant, direction: Direction<'_>, room: &mut Moved) {
        let n = self.layout.coordinates;
        let (q, v) = at.state.split_at(n);
        let (dq, dv) = direction.state.split_at(n);
        for (contact, force) in room.forces.iter_mut().enumerate() {
            *force = self.force_along(contact, at, direction);
        }
        let loads = &mut room.loads;
        loads.fill(0.0);
        let waves = |w: Wave| {
            let [value, slope, _] = self.wave(w, at);
            [value, slope * direction.phase]
        };
        for e in &self.layout.load {
            let ([c, dc], [w, dw]) = (self.value(e.coefficient, direction), waves(e.wave));
            loads[e.row] += dc * w + c * dw;
        }
        for e in &self.layout.damping {
            let [c, dc] = self.value(e.coefficient, direction);
            loads[e.row] -= dc * v[e.column] + c * dv[e.column];
        }
        for e in &self.layout.stiffness {
            let ([c, dc], [w, dw]) = (self.value(e.coefficient, direction), waves(e.wave));
            loads[e.row] -= (dc * w + c * dw) * q[e.column] + c * w * dq[e.column];
        }
        for e in &self.mass {
            let [_, dc] = self.value(e.coefficient, direction);
            loads[e.row] -= dc * at.acceleration[e.column];
        }
        for (index, contact) in self.layout.contacts.iter().enumerate() {
            for e in &contact.force {
                let ([c, dc], [w, dw]) = (self.value(e.coefficient, direction), waves(e.wave));
                let force = at.forces[index].force;
                loads[e.index] -= (dc * w + c * dw) * force + c * w * room.forces[index];
            }
        }
        times(&self.inverse_mass, loads, &mut room.acceleration);
    }

    /// Writes how the rate of the state, by the phase, moves along a direction.
    pub(in crate::sensitivity) fn rate_along(
        &self,
        at: &Instant,
        direction: Direction<'_>,
        room: &mut Moved,
        out: &mut [f64],
    ) {
        self.move_forces(at, direction, room);
        let n = self.layout.coordinates;
        let velocities = at.state[n..].iter().zip(&direction.state[n..]);
        let by_time = velocities.chain(at.acceleration.iter().zip(&room.acceleration));
        let base = direction.by.map_or(0.0, |by| by.base) / self.base;
        for (out, (x, dx)) in out.iter_mut().zip(by_time) {
            *out = (dx - x * base) / self.base;
        }
    }

    /// How much the gap of a contact grows beside a level, along a direction; and by the phase, along the motion.
    pub(in crate::sensitivity) fn distance_along(
        &self,
        at: &Instant,
        contact: usize,
        level: usize,
        direction: Direction<'_>,
    ) -> [f64; 2] {
        let [mut change, _] = self.gap_along(contact, at, direction);
        let layout = &self.layout.contacts[contact];
        if let Some(by) = direction.by {
            let law = self.system.law(layout.law);
            let mut levels = vec![0.0; self.contacts[contact].levels.len()];
            for &(argument, coefficient) in &layout.arguments {
                let moved = by.coefficients[coefficient];
                if moved != 0.0 {
                    law.levels_by(&self.contacts[contact].arguments, argument, &mut levels);
                    change -= moved * levels[level];
                }
            }
        }
        [change, at.gaps[contact][1] / self.base]
    }

    /// How the rate of a gap grows with the phase along the motion.
    pub(in crate::sensitivity) fn bend(&self, at: &Instant, contact: usize) -> f64 {
        let mut rate = vec![0.0; self.order()];
        self.write_rate(at, &mut rate);
        let motion = Direction {
            state: &rate,
            by: None,
            phase: 1.0,
        };
        self.gap_along(contact, at, motion)[1]
    }
}
