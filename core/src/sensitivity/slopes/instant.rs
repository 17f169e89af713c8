//! A motion at one instant: gaps by (1), forces by (2) and accelerations by (3) of [`slopes`](super).

use nalgebra::DMatrix;

use super::{Instant, Slopes};
use crate::law::{On, Variation};
use crate::laws::single::Single;
use crate::system::{Part, Wave};

/// How far beside a level slopes are taken that are none on it, as a part of the motion over a radian.
const INSIDE: f64 = 1e-10;

/// A wave at a phase, and its first two derivatives by the phase.
fn wave(wave: Wave, phase: f64) -> [f64; 3] {
    if wave == Wave::CONSTANT {
        return [1.0, 0.0, 0.0];
    }
    let h = f64::from(wave.harmonic);
    let (sine, cosine) = (h * phase).sin_cos();
    let [value, slope] = match wave.part {
        Part::Cosine => [cosine, -sine],
        Part::Sine => [sine, cosine],
    };
    [value, h * slope, -h * h * value]
}

/// A matrix times a vector.
pub(in crate::sensitivity) fn times(matrix: &DMatrix<f64>, vector: &[f64], out: &mut [f64]) {
    for (row, out) in out.iter_mut().enumerate() {
        *out = (0..vector.len())
            .map(|j| matrix[(row, j)] * vector[j])
            .sum();
    }
}

impl Slopes {
    /// A wave at an instant.
    pub(in crate::sensitivity) fn wave(&self, wave: Wave, at: &Instant) -> [f64; 3] {
        if wave == Wave::CONSTANT {
            return [1.0, 0.0, 0.0];
        }
        let known = self.waves.iter().position(|own| *own == wave);
        known.map_or([f64::NAN; 3], |index| at.waves[index])
    }

    /// The pieces that the gaps are on.
    pub(in crate::sensitivity) fn pieces<'p>(
        &'p self,
        phase: f64,
        state: &'p [f64],
    ) -> impl Iterator<Item = usize> + 'p {
        self.contacts
            .iter()
            .enumerate()
            .map(move |(index, contact)| {
                let gap = self.gap(index, phase, state)[0];
                contact.levels.iter().filter(|&&level| gap > level).count()
            })
    }

    /// (1)
    pub(in crate::sensitivity) fn gap(
        &self,
        contact: usize,
        phase: f64,
        state: &[f64],
    ) -> [f64; 2] {
        let (q, v) = state.split_at(self.layout.coordinates);
        let layout = &self.layout.contacts[contact];
        let mut sum = [0.0; 2];
        for term in &layout.gap {
            let [w, slope, _] = wave(term.wave, phase);
            let d = self.coefficients[term.coefficient];
            sum[0] += d * w * q[term.index];
            sum[1] += d * (w * v[term.index] + self.base * slope * q[term.index]);
        }
        for term in &layout.offset {
            let [w, slope, _] = wave(term.wave, phase);
            let delta = self.coefficients[term.coefficient];
            sum[0] -= delta * w;
            sum[1] -= delta * self.base * slope;
        }
        sum
    }

    /// The motion at one instant, with every contact on a piece.
    pub(in crate::sensitivity) fn at(
        &self,
        phase: f64,
        state: &[f64],
        pieces: &[usize],
    ) -> Instant {
        let mut at = self.instant();
        self.look(phase, state, pieces, &mut at);
        at
    }

    /// The same into room that there is.
    pub(in crate::sensitivity) fn look(
        &self,
        phase: f64,
        state: &[f64],
        pieces: &[usize],
        at: &mut Instant,
    ) {
        at.phase = phase;
        at.state.copy_from_slice(state);
        at.pieces.copy_from_slice(pieces);
        for (value, &of) in at.waves.iter_mut().zip(&self.waves) {
            *value = wave(of, phase);
        }
        at.by_arguments.iter_mut().for_each(|by| by.set(None));
        at.gaps.clear();
        at.forces.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let piece = pieces[index];
            let [gap, rate] = self.gap(index, phase, state);
            // Where a stretch ends rounding must not take the gap off its piece.
            let lower = piece.checked_sub(1).map(|level| contact.levels[level]);
            let gap = lower.map_or(gap, |lower| gap.max(lower));
            let gap = contact
                .levels
                .get(piece)
                .map_or(gap, |&upper| gap.min(upper));
            let law = self.system.law(self.layout.contacts[index].law);
            let force = if law.facts().pieces[piece].force == Variation::Zero {
                Single {
                    force: 0.0,
                    by_gap: 0.0,
                    by_rate: 0.0,
                }
            } else {
                Single::of(law, On::Piece(piece), &contact.arguments, [gap, rate])
            };
            at.gaps.push([gap, rate]);
            at.forces.push(force);
        }
        self.load(at);
        times(&self.inverse_mass, &at.loads, &mut at.acceleration);
    }

    /// The right-hand side of (3).
    fn load(&self, at: &mut Instant) {
        let mut loads = std::mem::take(&mut at.loads);
        loads.fill(0.0);
        let (q, v) = at.state.split_at(self.layout.coordinates);
        let c = &self.coefficients;
        for e in &self.layout.load {
            loads[e.row] += c[e.coefficient] * self.wave(e.wave, at)[0];
        }
        for e in &self.layout.damping {
            loads[e.row] -= c[e.coefficient] * v[e.column];
        }
        for e in &self.layout.stiffness {
            loads[e.row] -= c[e.coefficient] * self.wave(e.wave, at)[0] * q[e.column];
        }
        for (contact, force) in self.layout.contacts.iter().zip(&at.forces) {
            for e in &contact.force {
                loads[e.index] -= c[e.coefficient] * self.wave(e.wave, at)[0] * force.force;
            }
        }
        at.loads = loads;
    }

    /// How the state moves with the phase.
    pub(in crate::sensitivity) fn write_rate(&self, at: &Instant, rate: &mut [f64]) {
        let velocities = &at.state[self.layout.coordinates..];
        let by_time = velocities.iter().chain(at.acceleration.iter());
        for (rate, x) in rate.iter_mut().zip(by_time) {
            *rate = x / self.base;
        }
    }

    /// Where a gap stands on a level at which its force has no slope, that of its own piece beside it: along a motion that stays on the level what
    /// it is multiplied by is zero.
    pub(in crate::sensitivity) fn step_inside(&self, at: &mut Instant) {
        for (index, contact) in self.contacts.iter().enumerate() {
            if at.forces[index].by_gap.is_finite() {
                continue;
            }
            let piece = at.pieces[index];
            let [gap, rate] = at.gaps[index];
            let lower = piece.checked_sub(1).map(|level| contact.levels[level]);
            let step = INSIDE * (rate / self.base).abs();
            let inside = if lower == Some(gap) {
                gap + step
            } else {
                gap - step
            };
            let law = self.system.law(self.layout.contacts[index].law);
            let on = On::Piece(piece);
            let beside = Single::of(law, on, &contact.arguments, [inside, rate]);
            at.gaps[index][0] = inside;
            at.forces[index].by_gap = beside.by_gap;
            at.forces[index].by_rate = beside.by_rate;
        }
    }
}
