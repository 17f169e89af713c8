//! What moves on an interval without forces at nodes, on an even grid of it: of every pair of states what it does by itself, of every wave the angle. A signal there is a sum of
//! rows of these, with no exponential of its own. With `e^(A h)` for steps of twice as many each, of `n` samples,
//!
//! ```text
//! y(t_(k + m)) = e^(A m h) y(t_k),    k < m,    m = 1, 2, 4, ..                                                (1)
//! ```
//!
//! so that a sample has the rounding of `log2 n` products. Pairs are followed when a signal sees them.
//!
//! Source: Moler and Van Loan (2003), Nineteen Dubious Ways to Compute the Exponential of a Matrix, Twenty-Five Years Later, method 3 (powers by squares).

use std::cell::OnceCell;

use multiversion::multiversion;

use super::motion::Motion;
use crate::contact_equation::linear_part::block::{Block, Pair, Square, pair};
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::linear::Seen;
use crate::contact_equation::linear_part::wave::turn;

/// A row that sees more than this part of all pairs has the exponentials of all at once.
const MANY: usize = 8;

/// Samples at even distances.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) phases: Vec<f64>,
    /// Cosines and sines of every wave that is not in resonance.
    waves: Vec<Both>,
    pairs: Vec<OnceCell<Both>>,
    /// Exponentials of all pairs: to the beginning of the grid, and over the steps of (1).
    powers: OnceCell<Vec<Found>>,
}

/// Two numbers for each sample: those of the first kind, then those of the second.
#[derive(Debug)]
struct Both(Vec<f64>);

impl Both {
    fn halves(&self) -> [&[f64]; 2] {
        self.0.split_at(self.0.len() / 2).into()
    }
}

impl Grid {
    /// Of so many parts between two phases of an interval.
    pub(super) fn new(
        motion: &Motion<'_>,
        interval: usize,
        [from, to]: [f64; 2],
        parts: usize,
    ) -> Self {
        let values = motion.values(interval);
        let phase = |sample: usize| from + (to - from) * (sample as f64 / parts as f64);
        let phases: Vec<f64> = (0..=parts).map(phase).collect();
        let waves = values.load.iter().filter(|wave| !wave.is_resonant());
        let waves = waves.map(|wave| {
            let step = wave.harmonic * (to - from) / parts as f64;
            let begin = turn(wave.harmonic * from);
            let turned = |m: usize| {
                let turned = turn(step * m as f64);
                [[turned.re, -turned.im], [turned.im, turned.re]]
            };
            doubled([begin.re, begin.im], parts, turned)
        });
        Self {
            waves: waves.collect(),
            pairs: (0..values.linear.blocks.len())
                .map(|_| OnceCell::new())
                .collect(),
            powers: OnceCell::new(),
            phases,
        }
    }

    fn ends(&self) -> [f64; 2] {
        [self.phases[0], self.phases[self.phases.len() - 1]]
    }

    /// Adds what a wave of this amplitude is, and its rate where it turns so fast.
    pub(super) fn add_wave(
        &self,
        wave: usize,
        [re, im]: [f64; 2],
        turns: f64,
        [values, rates]: [&mut [f64]; 2],
    ) {
        let turns_of = self.waves[wave].halves();
        let both = [[re, -im], [-turns * im, -turns * re]];
        add_seen(turns_of, both, values, rates);
    }

    /// Adds what a row sees of the pairs.
    pub(super) fn add_row(
        &self,
        motion: &Motion<'_>,
        interval: usize,
        row: &[Seen],
        [values, rates]: [&mut [f64]; 2],
    ) {
        let many = MANY * row.len() > self.pairs.len();
        for seen in row {
            let pair = self.pairs[seen.block].get_or_init(|| {
                if many {
                    self.pair_of_many(motion, interval, seen.block)
                } else {
                    self.pair(motion, interval, seen.block)
                }
            });
            let both = [seen.position, seen.rate];
            add_seen(pair.halves(), both, values, rates);
        }
    }

    /// How long it takes to where the grid begins, and from one sample to the next.
    fn times(&self, motion: &Motion<'_>, interval: usize) -> [f64; 2] {
        let [begin, _] = motion.phases(interval);
        let [from, to] = self.ends();
        let base = motion.values(interval).base;
        let parts = self.phases.len() - 1;
        [(from - begin) / base, (to - from) / base / parts as f64]
    }

    /// A pair of states at all samples.
    fn pair(&self, motion: &Motion<'_>, interval: usize, r: usize) -> Both {
        let [before, step] = self.times(motion, interval);
        let block: &Block = &motion.values(interval).linear.blocks[r];
        let mut free = pair(&motion.equations.passed[interval].free, r);
        if before > 0.0 {
            free = block.carried(block.kernel(before), free);
        }
        let power = |m: usize| block.exponential(step * m as f64);
        doubled(free, self.phases.len() - 1, power)
    }

    /// The same, with exponentials of all pairs at once.
    fn pair_of_many(&self, motion: &Motion<'_>, interval: usize, r: usize) -> Both {
        let linear = &motion.values(interval).linear;
        let powers = self.powers.get_or_init(|| {
            let [before, step] = self.times(motion, interval);
            let doublings = (0..usize::BITS).map(|power| 1_usize << power);
            let steps = doublings.take_while(|m| *m < self.phases.len());
            let times = std::iter::once(before).chain(steps.map(|m| step * m as f64));
            let of = |time: f64| {
                let mut found = Found::default();
                linear.kernels.find(&linear.blocks, time, &mut found);
                found
            };
            times.map(of).collect()
        });
        let block: &Block = &linear.blocks[r];
        let free = pair(&motion.equations.passed[interval].free, r);
        let free = block.carried(powers[0].kernel(r), free);
        let power = |m: usize| {
            let power = &powers[1 + m.ilog2() as usize];
            block.exponential_of(power.kernel(r))
        };
        doubled(free, self.phases.len() - 1, power)
    }
}

/// Adds what two rows see of pairs.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_seen(
    [first, second]: [&[f64]; 2],
    [position, rate]: [Pair; 2],
    values: &mut [f64],
    rates: &mut [f64],
) {
    let to = values.iter_mut().zip(rates);
    for ((a, b), (value, slope)) in first.iter().zip(second).zip(to) {
        *value += position[0] * a + position[1] * b;
        *slope += rate[0] * a + rate[1] * b;
    }
}

/// Writes the products of a matrix and pairs.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn write_products(
    by: Square,
    [first, second]: [&[f64]; 2],
    to_first: &mut [f64],
    to_second: &mut [f64],
) {
    let to = to_first.iter_mut().zip(to_second);
    for ((a, b), (x, y)) in first.iter().zip(second).zip(to) {
        *x = by[0][0] * a + by[0][1] * b;
        *y = by[1][0] * a + by[1][1] * b;
    }
}

/// (1)
fn doubled(begin: Pair, parts: usize, power: impl Fn(usize) -> Square) -> Both {
    let samples = parts + 1;
    let mut both = vec![0.0; 2 * samples];
    let (first, second) = both.split_at_mut(samples);
    (first[0], second[0]) = (begin[0], begin[1]);
    let mut known = 1;
    while known < samples {
        let more = known.min(samples - known);
        let by = power(known);
        let (first, first_next) = first.split_at_mut(known);
        let (second, second_next) = second.split_at_mut(known);
        let known_ones = [&first[..more], &second[..more]];
        write_products(by, known_ones, first_next, second_next);
        known += more;
    }
    Both(both)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_equation::linear_part::linear::of_states;
    use crate::contact_equation::orbit::extremes::Sampled;
    use crate::contact_equation::orbit::signal::{Of, Signal};
    use crate::contact_equation::tests::first;

    crate::oscillator! {
        /// Modes that turn, slowly, fast and so fast that they soon decay, and one that does not turn; the stop moves all of them.
        Modes(x, y, z, w) {
            law stop(g) { g > 0 => 40*g, else => 0 }
            let gap = x + 0.4*y + 0.3*z - 0.2*w - 0.5;
            ddot(x) + 0.1*dot(x) + x + stop(gap) = 0.5*cos(omega*t) + 0.1;
            ddot(y) + 0.3*dot(y) + 90*y + 0.4*stop(gap) = 0.2*sin(2*omega*t);
            ddot(z) + 12*dot(z) + 90_000*z + 0.3*stop(gap) = 0;
            ddot(w) + 9*dot(w) + 4*w - 0.2*stop(gap) = 0;
        }
    }

    /// Looks at every interval that takes time of an orbit of the modes.
    fn each_interval(mut look: impl FnMut(&Motion<'_>, &Sampled)) {
        let system = Modes {};
        let (mut equations, u) = first(&system, None, 1.1, [16, 1]);
        equations.compute(&u, false);
        assert!(!equations.failed && !equations.configurations.is_empty());
        let motion = Motion::of(&equations);
        assert!(motion.sampled().len() > 1);
        for sampled in motion.sampled() {
            assert!(motion.is_closed(sampled.interval));
            look(&motion, sampled);
        }
    }

    /// A coordinate and its rate at a phase, by exponentials of their own.
    fn exactly(motion: &Motion<'_>, interval: usize, phase: f64, coordinate: usize) -> [f64; 2] {
        let linear = &motion.equations.values.linear;
        let mut states = vec![0.0; motion.equations.skeleton.order];
        motion.states(interval, phase, &mut states);
        of_states(&linear.rows[coordinate], &states)
    }

    #[test]
    fn samples_of_grids_are_those_instant_by_instant() {
        each_interval(|motion, sampled| {
            let interval = sampled.interval;
            let [from, to] = motion.phases(interval);
            let parts_of = [[0.0, 1.0], [0.25, 0.5], [0.7, 1.0]];
            let parts_of = parts_of.map(|ends| ends.map(|part| from + part * (to - from)));
            for (ends, parts) in parts_of.into_iter().zip([1, 13, 200]) {
                let grid = Grid::new(motion, interval, ends, parts);
                assert_eq!(grid.phases.len(), parts + 1);
                for coordinate in 0..4 {
                    let signal = Signal::new(motion, sampled, Of::Coordinate(coordinate));
                    let samples = signal.on(&grid);
                    for (place, phase) in grid.phases.iter().enumerate() {
                        let exact = exactly(motion, interval, *phase, coordinate);
                        let [value, rate] = [samples.values[place], samples.rates[place]];
                        let at = format!("{interval} {ends:?} {parts} {coordinate} {place}");
                        assert!((value - exact[0]).abs() < 1e-13, "{at}");
                        assert!((rate - exact[1]).abs() < 1e-11, "{at}");
                    }
                }
            }
        });
    }

    /// The pass has left the states at both ends of an interval.
    #[test]
    fn grids_begin_and_end_where_their_interval_does() {
        each_interval(|motion, sampled| {
            let interval = sampled.interval;
            let ends = motion.phases(interval);
            let grid = Grid::new(motion, interval, ends, 9);
            assert_eq!(grid.phases[0], ends[0]);
            assert!((grid.phases[9] - ends[1]).abs() <= f64::EPSILON * ends[1].abs());
            let linear = &motion.equations.values.linear;
            let left = &motion.equations.passed[interval].states;
            let order = motion.equations.skeleton.order;
            let left = [&left[..order], &left[left.len() - order..]];
            for coordinate in 0..4 {
                let signal = Signal::new(motion, sampled, Of::Coordinate(coordinate));
                let samples = signal.on(&grid);
                for (place, states) in [0, 9].into_iter().zip(left) {
                    let [value, rate] = of_states(&linear.rows[coordinate], states);
                    assert!((samples.values[place] - value).abs() < 1e-13);
                    assert!((samples.rates[place] - rate).abs() < 1e-11);
                }
            }
        });
    }

    #[test]
    fn a_grid_of_no_length_is_one_state() {
        each_interval(|motion, sampled| {
            let interval = sampled.interval;
            let [from, to] = motion.phases(interval);
            for phase in [from, 0.5 * (from + to)] {
                let grid = Grid::new(motion, interval, [phase; 2], 6);
                for coordinate in 0..4 {
                    let signal = Signal::new(motion, sampled, Of::Coordinate(coordinate));
                    let samples = signal.on(&grid);
                    let exact = exactly(motion, interval, phase, coordinate);
                    for place in 0..=6 {
                        assert_eq!(grid.phases[place], phase);
                        assert!((samples.values[place] - exact[0]).abs() < 1e-13);
                        assert!((samples.rates[place] - exact[1]).abs() < 1e-11);
                    }
                }
            }
        });
    }

    /// Intervals have several layers here. Instants of the dense samples are a thousandth of a radian of the fastest mode apart.
    #[test]
    fn extremes_are_those_of_dense_samples() {
        let mut dense = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
        let mut found = Vec::new();
        let mut layers = 0;
        each_interval(|motion, sampled| {
            let [from, to] = motion.phases(sampled.interval);
            let samples = (3e5 * (to - from) / motion.equations.values.base) as usize + 2;
            for sample in 0..=samples {
                let phase = from + (to - from) * (sample as f64 / samples as f64);
                for (coordinate, ends) in dense.iter_mut().enumerate() {
                    let [value, _] = exactly(motion, sampled.interval, phase, coordinate);
                    *ends = [ends[0].min(value), ends[1].max(value)];
                }
            }
            layers = layers.max(sampled.layers.len());
            found = motion.coordinate_extremes().to_vec();
        });
        assert!(layers > 2, "{layers}");
        for (found, dense) in found.iter().zip(dense) {
            let size = dense[1] - dense[0];
            assert!((found[0].value - dense[0]).abs() < 1e-6 * size, "{dense:?}");
            assert!((found[1].value - dense[1]).abs() < 1e-6 * size, "{dense:?}");
            // Samples are never beyond an extreme.
            assert!(found[0].value <= dense[0] + 1e-13);
            assert!(found[1].value >= dense[1] - 1e-13);
        }
    }
}
