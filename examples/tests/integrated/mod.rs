//! What examples find, against an integration that shares nothing with the library: equations are written once more, by hand.

mod approach;
mod bolted_joint;
mod chain_of_beads;
mod gear_mesh;
mod reference;

use hertzian::Orbit;

/// Derivative of a state at a time, on the sides of the levels that are told.
type Slope<'a> = dyn Fn(f64, &[f64], &[bool]) -> Vec<f64> + 'a;

/// Equations of first order whose right-hand side is smooth between the zeros of some levels.
struct Equations<'a> {
    slope: &'a Slope<'a>,
    levels: &'a dyn Fn(&[f64]) -> Vec<f64>,
}

impl Equations<'_> {
    /// The states at the ends of equal steps, by the method of Kutta (1901). A step in which a level is crossed is divided there.
    fn states(&self, start: &[f64], duration: f64, steps: usize) -> Vec<Vec<f64>> {
        let mut states = vec![start.to_vec()];
        let mut state = start.to_vec();
        let mut sides = self.sides(&state);
        for step in 0..steps {
            let [mut time, end] = [step, step + 1].map(|at| duration * at as f64 / steps as f64);
            loop {
                let whole = self.step(time, &state, &sides, end - time);
                if self.sides(&whole) == sides {
                    state = whole;
                    break;
                }
                let (mut before, mut behind) = (0.0, end - time);
                for _ in 0..60 {
                    let middle = 0.5 * (before + behind);
                    if self.sides(&self.step(time, &state, &sides, middle)) == sides {
                        before = middle;
                    } else {
                        behind = middle;
                    }
                }
                state = self.step(time, &state, &sides, behind);
                sides = self.sides(&state);
                time += behind;
            }
            states.push(state.clone());
        }
        states
    }

    fn step(&self, time: f64, state: &[f64], sides: &[bool], length: f64) -> Vec<f64> {
        let moved = |slope: &[f64], by: f64| -> Vec<f64> {
            let both = state.iter().zip(slope);
            both.map(|(x, slope)| x + by * slope).collect()
        };
        let half = 0.5 * length;
        let first = (self.slope)(time, state, sides);
        let second = (self.slope)(time + half, &moved(&first, half), sides);
        let third = (self.slope)(time + half, &moved(&second, half), sides);
        let fourth = (self.slope)(time + length, &moved(&third, length), sides);
        let mean =
            (0..state.len()).map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        moved(&mean.collect::<Vec<_>>(), length)
    }

    fn sides(&self, state: &[f64]) -> Vec<bool> {
        let levels = (self.levels)(state);
        levels.into_iter().map(|level| level > 0.0).collect()
    }

    /// The state after so many periods of 600 steps.
    fn after(&self, start: &[f64], period: f64, periods: usize) -> Vec<f64> {
        (0..periods).fold(start.to_vec(), |state, _| {
            let mut states = self.states(&state, period, 600);
            states.pop().expect("an end")
        })
    }

    /// Derivative of the state after a time by the first two entries of that before, by differences of such sizes.
    fn derivative(&self, start: &[f64], duration: f64, sizes: [f64; 2]) -> [[f64; 2]; 2] {
        let column = |entry: usize| {
            let ends = [1.0, -1.0].map(|sign| {
                let mut state = start.to_vec();
                state[entry] += sign * sizes[entry];
                self.after(&state, duration, 1)
            });
            [0, 1].map(|i| (ends[0][i] - ends[1][i]) / (2.0 * sizes[entry]))
        };
        let [first, second] = [column(0), column(1)];
        [[first[0], second[0]], [first[1], second[1]]]
    }
}

/// Smallest value, largest value, and root of the mean square of an entry that was followed over a period.
fn extremes_and_rms(states: &[Vec<f64>], entry: usize) -> [f64; 3] {
    let values = || states.iter().map(|state| state[entry]);
    let square: f64 = values().skip(1).map(|x| x * x).sum();
    [
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
        (square / (states.len() - 1) as f64).sqrt(),
    ]
}

fn period(orbit: &Orbit) -> f64 {
    std::f64::consts::TAU / orbit.base
}

/// Whether numbers agree, relative to the second.
fn agree(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within * b.abs(), "{a}, {b}");
}
