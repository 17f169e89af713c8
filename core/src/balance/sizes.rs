//! How large the terms are that a residual is summed from.
//!
//! Rounding of one harmonic of a term is relative to all of the term, as transforms between time and harmonics spread it. So every
//! equation of a coordinate has the same size, the sum of
//!
//! ```text
//! |Omega^2 M D^2 u|,   |Omega C D u|,   |K u|,   |f|,   |e| (|phi| + |phi_g| |g| + |phi_r| |g'|)                         (1)
//! ```
//!
//! where `|.|` of a series is the sum of its coefficients by size, and `|g|` is that of the terms of a gap, before they cancel.

use super::Balance;
use super::alike::Alike;
use super::terms::{block, block_mut, stretched};

impl Balance<'_> {
    /// Writes (1) for every equation at the variable set last.
    pub(super) fn sizes_of_terms(&mut self, u: &[f64], sizes: &mut [f64]) {
        sizes.fill(0.0);
        let (base, length) = (self.base(), self.length());
        for index in 0..self.alike.len() {
            let Alike { contact, count } = self.alike[index];
            self.contact_derivatives(u, contact);
            let size = count * self.size_of_contact(u, contact);
            for e in &self.layout.contacts[contact].force {
                sizes[e.index * length] += self.coefficients[e.coefficient].abs() * size;
            }
        }
        let value = |coefficient: usize| self.coefficients[coefficient].abs();
        for (entries, factor, order) in [
            (&self.layout.mass, base * base, 2),
            (&self.layout.damping, base, 1),
            (&self.layout.stiffness, 1.0, 0),
        ] {
            for entry in entries {
                let size = derivative(block(u, entry.column, length), order);
                sizes[entry.row * length] += factor * value(entry.coefficient) * size;
            }
        }
        for entry in &self.layout.load {
            sizes[entry.row * length] += value(entry.coefficient);
        }
        for coordinate in 0..self.layout.coordinates {
            let of_one = block_mut(sizes, coordinate, length);
            let size = of_one[0];
            of_one.fill(size);
        }
    }

    /// The last term of (1) without its direction, for the contact whose derivatives are in the scratch series.
    fn size_of_contact(&self, u: &[f64], contact: usize) -> f64 {
        let (length, period) = (self.length(), self.resolution.period);
        let layout = &self.layout.contacts[contact];
        let value = |coefficient: usize| self.coefficients[coefficient].abs();
        let (mut gap, mut rate) = (0.0, 0.0);
        for d in &layout.gap {
            let moved = block(u, d.index, length);
            let wave = f64::from(stretched(d.wave, period).harmonic);
            let [size, slope] = [0, 1].map(|order| derivative(moved, order));
            gap += value(d.coefficient) * size;
            rate += value(d.coefficient) * (wave * size + slope);
        }
        for offset in &layout.offset {
            let wave = f64::from(stretched(offset.wave, period).harmonic);
            gap += value(offset.coefficient);
            rate += value(offset.coefficient) * wave;
        }
        let s = &self.scratch;
        let [force, by_gap, by_rate] =
            [&s.force, &s.by_gap, &s.by_rate].map(|series| derivative(series, 0));
        force + by_gap * gap + by_rate * self.base() * rate
    }
}

/// Sum of the coefficients of a derivative by the phase, by size.
fn derivative(series: &[f64], order: i32) -> f64 {
    let weight = |index: usize| (index.div_ceil(2) as f64).powi(order);
    series
        .iter()
        .enumerate()
        .map(|(index, x)| weight(index) * x.abs())
        .sum()
}
