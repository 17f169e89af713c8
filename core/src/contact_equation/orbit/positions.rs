//! Positions at many phases. On an interval where the motion is in closed form the exponentials of a pair of states at all of these are computed at once, and
//! positions follow from the states on the interval without the velocities and the states of the linear part between them.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, section 7.15 (motions as sums over pairs of states).

use super::motion::Motion;
use crate::contact_equation::linear_part::block::{add_both, pair, times};
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::wave::turn;

/// A phase that is asked for, shifted into an interval.
#[derive(Debug, Clone, Copy)]
struct Asked {
    place: usize,
    interval: usize,
    phase: f64,
}

/// Room for all phases on an interval.
#[derive(Debug, Default)]
struct Room {
    /// From where it begins.
    ways: Vec<f64>,
    found: Found,
    /// State by state, or cosines and sines.
    states: Vec<f64>,
    turns: [Vec<f64>; 2],
    column: Vec<f64>,
}

/// All positions at these phases, one phase after the other.
pub(in crate::contact_equation) fn positions(motion: &Motion<'_>, phases: &[f64]) -> Vec<f64> {
    let skeleton = &motion.equations.skeleton;
    let coordinates = motion.equations.values.linear.rows.len();
    let mut positions = vec![0.0; phases.len() * coordinates];
    let asked = phases.iter().enumerate().map(|(place, phase)| {
        let (interval, phase) = motion.interval(*phase);
        Asked {
            place,
            interval,
            phase,
        }
    });
    let mut asked: Vec<Asked> = asked.collect();
    asked.sort_by_key(|of| of.interval);
    let mut room = Room::default();
    let mut state = vec![0.0; 2 * coordinates];
    for asked in asked.chunk_by(|a, b| a.interval == b.interval) {
        let interval = asked[0].interval;
        if motion.is_closed(interval) {
            room.write(motion, interval, asked, &mut positions);
            continue;
        }
        for of in asked {
            motion.state(interval, of.phase, &mut state);
            let to = &mut positions[of.place * coordinates..][..coordinates];
            to.copy_from_slice(&state[..coordinates]);
        }
    }
    let image = &skeleton.recurrence().image;
    if !image.is_identity() {
        for of in &asked {
            let turns = ((phases[of.place] - of.phase) / skeleton.length).round() as i64;
            let image = image.power(turns.rem_euclid(image.order() as i64) as usize);
            let to = &mut positions[of.place * coordinates..][..coordinates];
            state[..coordinates].copy_from_slice(to);
            for (coordinate, to) in to.iter_mut().enumerate() {
                let (place, sign) = image.entry(coordinate);
                *to = sign * state[place];
            }
        }
    }
    positions
}

impl Room {
    /// Writes positions on an interval in closed form.
    fn write(
        &mut self,
        motion: &Motion<'_>,
        interval: usize,
        asked: &[Asked],
        positions: &mut [f64],
    ) {
        let (values, count) = (motion.values(interval), asked.len());
        let passed = &motion.equations.passed[interval];
        let linear = &values.linear;
        self.ways.clear();
        let ways = asked.iter().map(|of| of.phase - passed.phases[0]);
        self.ways.extend(ways);
        self.states.clear();
        self.states.resize(passed.free.len() * count, 0.0);
        for (r, block) in linear.blocks.iter().enumerate() {
            self.found.find(block, &self.ways, 1.0 / values.base);
            let free = pair(&passed.free, r);
            let turned = times(block.deviation, free);
            let both = [&self.found.c[..count], &self.found.k[..count]];
            for i in 0..2 {
                let to = &mut self.states[(2 * r + i) * count..][..count];
                add_both(both, [free[i], turned[i]], to);
            }
        }
        for wave in values.load.iter().filter(|wave| !wave.is_resonant()) {
            let [cosines, sines] = &mut self.turns;
            let turned = asked.iter().map(|of| turn(wave.harmonic * of.phase));
            cosines.clear();
            sines.clear();
            for turned in turned {
                cosines.push(turned.re);
                sines.push(turned.im);
            }
            let states = self.states.chunks_exact_mut(count);
            for (to, [response, _]) in states.zip(&wave.steady) {
                add_both([cosines, sines], [response.re, -response.im], to);
            }
        }
        let coordinates = linear.rows.len();
        for (coordinate, row) in linear.rows.iter().enumerate() {
            self.column.clear();
            self.column.resize(count, 0.0);
            for seen in row {
                let states = &self.states[2 * seen.block * count..][..2 * count];
                add_both(
                    states.split_at(count).into(),
                    seen.position,
                    &mut self.column,
                );
            }
            for (of, x) in asked.iter().zip(&self.column) {
                positions[of.place * coordinates + coordinate] = *x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_equation::tests::first;

    crate::oscillator! {
        /// Two masses between stops: orbits come back with signs changed after half of the period.
        Between(x, y) {
            law right(g) { g > 0 => 20*g, else => 0 }
            law left(g) { g < 0 => 20*g, else => 0 }
            ddot(x) + 0.1*dot(x) + x - 0.5*(y - x) + right(x - 0.8) + left(x + 0.8) = 1.2*cos(omega*t);
            ddot(y) + 9*dot(y) + 2*y + 0.5*(y - x) = 0.1*sin(3*omega*t);
        }
    }

    #[test]
    fn positions_are_those_phase_by_phase() {
        let system = Between {};
        let (mut equations, u) = first(&system, None, 1.1, [16, 1]);
        equations.compute(&u, false);
        let motion = Motion::of(&equations);
        assert!(!equations.failed && motion.intervals() > 2);
        let phases: Vec<f64> = (0..40)
            .map(|sample| 0.37 * f64::from(sample) - 2.0)
            .collect();
        let found = positions(&motion, &phases);
        let mut state = vec![0.0; 4];
        for (phase, found) in phases.iter().zip(found.chunks_exact(2)) {
            motion.at(*phase, &mut state);
            for (found, exact) in found.iter().zip(&state) {
                assert!((found - exact).abs() < 1e-13, "{phase}: {found} {exact}");
            }
        }
    }
}
