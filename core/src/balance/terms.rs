//! Series of gaps and rates, and the linear terms of the balance.

use crate::model::layout::{ContactLayout, Term};
use crate::numeric::fourier::series;
use crate::system::Wave;

/// A wave of the declaration in harmonics of the orbit's own period.
pub(crate) fn stretched(wave: Wave, period: usize) -> Wave {
    Wave {
        harmonic: wave.harmonic * period as u32,
        part: wave.part,
    }
}

/// One coordinate's or equation's part of a vector.
pub(super) fn block(u: &[f64], index: usize, length: usize) -> &[f64] {
    &u[index * length..][..length]
}

/// The same, to be written.
pub(super) fn block_mut(u: &mut [f64], index: usize, length: usize) -> &mut [f64] {
    &mut u[index * length..][..length]
}

/// The pairs of two series of one length, by harmonic.
fn pairs<'s>(
    u: &'s [f64],
    to: &'s mut [f64],
) -> impl Iterator<Item = (f64, &'s [f64], &'s mut [f64])> {
    let pairs = u[1..].chunks_exact(2).zip(to[1..].chunks_exact_mut(2));
    let pairs = pairs.enumerate();
    pairs.map(|(index, (pair, to))| ((index + 1) as f64, pair, to))
}

/// Adds `factor D^2 u`, with `D^2 u = -k^2 u` for harmonic `k`.
pub(super) fn add_inertia(u: &[f64], factor: f64, to: &mut [f64]) {
    for (k, pair, to) in pairs(u, to) {
        to[0] -= factor * k * k * pair[0];
        to[1] -= factor * k * k * pair[1];
    }
}

/// Adds `factor D u`.
pub(crate) fn add_derivative(u: &[f64], factor: f64, to: &mut [f64]) {
    for (k, pair, to) in pairs(u, to) {
        to[0] += factor * k * pair[1];
        to[1] -= factor * k * pair[0];
    }
}

/// Writes the series of `d . q - delta` for the directions and offset that the coefficients give.
pub(crate) fn gap_series(
    contact: &ContactLayout,
    coefficients: &[f64],
    period: usize,
    u: &[f64],
    length: usize,
    gap: &mut [f64],
) {
    gap.fill(0.0);
    for &Term {
        index,
        wave,
        coefficient,
    } in &contact.gap
    {
        let wave = stretched(wave, period);
        series::add_product(
            block(u, index, length),
            wave,
            coefficients[coefficient],
            gap,
        );
    }
    for term in &contact.offset {
        let wave = stretched(term.wave, period);
        let value = -coefficients[term.coefficient];
        series::add_wave(gap, wave.harmonic as usize, wave.part, value);
    }
}

/// Writes the series of the rate: base frequency times the phase derivative of the gap.
pub(crate) fn rate_series(gap: &[f64], base: f64, rate: &mut [f64]) {
    series::differentiate(gap, rate);
    for x in rate.iter_mut() {
        *x *= base;
    }
}
