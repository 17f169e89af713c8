//! Linear modes that harmonics beyond those of the correction meet.
//!
//! Nothing is computed of harmonics above `2 K`. Free masses hardly follow them, but a mode of mass, damping and constant stiffness
//! does where `k Omega` is near its frequency. The residual is extrapolated from the harmonics `3/2 K` to `2 K` as a power,
//!
//! ```text
//! |R_k| <= E (2 K / k)^p,     E = max over 3/2 K < k <= 2 K of |R_k| (k / 2 K)^p                                  (1)
//! ```
//!
//! with `p = 1` where a force jumps or its stiffness is unbounded (there `p = 1 + alpha` for an exponent `alpha` below one), and `p = 2`
//! where its slope jumps, the slowest of the others; and the two harmonics beside the frequency of each mode answer to it.
//!
//! Source: Katznelson (2004), An Introduction to Harmonic Analysis, section I.4 (order of Fourier coefficients).

use nalgebra::DMatrix;

use crate::balance::{Balance, Lattice};
use crate::numeric::spectrum::eigenvalues;

/// Highest mode that is looked at, in units of the highest harmonic of the correction: next to nothing is left of a power beyond.
const FARTHEST: f64 = 1e6;
/// Modes above `2 K` that are looked at: the lowest, which answer most.
const MODES: usize = 4;

/// Frequencies of the linear modes, as long as their matrices stay as they are.
#[derive(Debug, Default)]
pub(super) struct Modes {
    mass: Vec<f64>,
    stiffness: Vec<f64>,
    /// In increasing order.
    frequencies: Vec<f64>,
}

impl Modes {
    /// Frequencies of `M x'' + K x = 0`, with matrices row by row.
    fn frequencies(&mut self, mass: &[f64], stiffness: &[f64]) -> &[f64] {
        if self.mass != mass || self.stiffness != stiffness {
            self.mass = mass.to_vec();
            self.stiffness = stiffness.to_vec();
            let n = mass.len().isqrt();
            let [m, k] = [mass, stiffness].map(|entries| DMatrix::from_row_slice(n, n, entries));
            let squares = m.lu().solve(&k).map_or(Vec::new(), |of| eigenvalues(&of));
            let real = squares.iter().map(|square| square.re);
            self.frequencies = real.filter(|w| *w > 0.0).map(f64::sqrt).collect();
            self.frequencies.sort_by(f64::total_cmp);
        }
        &self.frequencies
    }

    /// Adds to bounds, one for each coordinate, on amplitudes of the harmonics above those of the residual of a balance that meet
    /// a mode, given its matrices of mass, damping and stiffness.
    pub(super) fn add_bounds(
        &mut self,
        balance: &Balance<'_>,
        [mass, damping, stiffness]: &[Vec<f64>; 3],
        residual: &[f64],
        bounds: &mut [f64],
    ) {
        let (n, length) = (bounds.len(), balance.length());
        let top = balance.resolution().harmonics;
        let base = balance.base();
        let beyond = base * top as f64;
        let met: Vec<f64> = self
            .frequencies(mass, stiffness)
            .iter()
            .copied()
            .filter(|frequency| (beyond..FARTHEST * beyond).contains(frequency))
            .take(MODES)
            .collect();
        if met.is_empty() {
            return;
        }
        let power = if has_jumps(balance) { 1 } else { 2 };
        let size = |i: usize, k: usize| {
            let at = i * length + 2 * k - 1;
            residual[at].hypot(residual[at + 1])
        };
        let envelope: Vec<f64> = (0..n)
            .map(|i| {
                let parts = (3 * top / 4 + 1..=top)
                    .map(|k| size(i, k) * (k as f64 / top as f64).powi(power));
                parts.fold(0.0, f64::max)
            })
            .collect();
        let Lattice { first, step } = balance.resolution().lattice();
        let mut known = top;
        for frequency in met {
            // The two harmonics of the orbit on either side of it.
            let below = (frequency / base).floor() as usize;
            let below = below - below.saturating_sub(first) % step;
            for k in [below, below + step].into_iter().filter(|k| *k > known) {
                let w = base * k as f64;
                let part = (top as f64 / k as f64).powi(power);
                add_answer(
                    [mass, damping, stiffness],
                    w,
                    |j| part * envelope[j],
                    bounds,
                );
            }
            known = known.max(below + step);
        }
    }
}

/// Whether the force of a contact jumps at a level, at rest or in motion, or is steeper there than any line.
fn has_jumps(balance: &Balance<'_>) -> bool {
    balance.layout().contacts.iter().any(|contact| {
        let facts = balance.system().law(contact.law).facts();
        let mut levels = facts.levels.iter();
        levels.any(|level| level.force_jumps || level.by_rate_jumps || level.unbounded_by_gap)
    })
}

/// Adds `| (K + i w C - w^2 M)^-1 | E`.
fn add_answer(
    [mass, damping, stiffness]: [&Vec<f64>; 3],
    w: f64,
    envelope: impl Fn(usize) -> f64,
    bounds: &mut [f64],
) {
    let n = bounds.len();
    let real = |entry: usize| stiffness[entry] - w * w * mass[entry];
    if n == 1 {
        bounds[0] += envelope(0) / real(0).hypot(w * damping[0]);
        return;
    }
    let matrix = super::dynamic_stiffness(n, real, |entry| w * damping[entry]);
    let units = DMatrix::from_fn(2 * n, n, |row, column| f64::from(u8::from(row == column)));
    let Some(answer) = matrix.lu().solve(&units) else {
        bounds.fill(f64::INFINITY);
        return;
    };
    for (i, bound) in bounds.iter_mut().enumerate() {
        let parts = (0..n).map(|j| envelope(j) * answer[(i, j)].hypot(answer[(i + n, j)]));
        *bound += parts.sum::<f64>();
    }
}
