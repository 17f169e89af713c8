//! Equivalent linearisation: the balance in the harmonics of the load alone, from amplitudes in geometric sequence and both
//! phases. Of several solutions the one of smallest amplitude comes first, which is the one that small drives lead to.
//!
//! Source: Krylov and Bogoliubov (1943), Introduction to Non-Linear Mechanics.

use super::StartRequest;
use super::effort::Effort;
use super::fixed::{Fixed, geometric, oscillation, spread};
use crate::model::layout::Layout;

/// Relative difference of residuals up to which amplitudes are on a plateau, as all tiny ones are.
const PLATEAU: f64 = 1e-6;
/// Relative difference up to which solutions are one.
const SAME: f64 = 1e-6;

/// Different solutions in the harmonics of the load alone, smallest amplitude first.
pub(super) fn equivalent_linearisation(
    request: StartRequest<'_>,
    rest: Option<&[f64]>,
    effort: &mut Effort,
) -> Vec<Vec<f64>> {
    let load = Layout::of(request.system).load_harmonic();
    let stride = request.resolution.stride;
    let harmonics = load.clamp(stride, request.resolution.harmonics.max(stride));
    let mut fixed = Fixed::new(request, harmonics);
    let origin = rest.map_or_else(|| fixed.zeros(), |rest| spread(rest, &fixed));
    let mut pattern = load_pattern(&mut fixed);
    if pattern.iter().all(|x| *x == 0.0) {
        pattern[2 * stride - 1] = 1.0;
    }
    let mut found: Vec<Vec<f64>> = Vec::new();
    for mut u in valleys(&mut fixed, &origin, &pattern, effort) {
        if effort.is_spent() {
            break;
        }
        let solved = fixed.solve(&mut u, request.damped(60), effort).is_ok();
        if solved && !found.iter().any(|other| is_same(other, &u)) {
            found.push(u);
        }
    }
    let length = fixed.balance.length();
    found.sort_by(|a, b| oscillation(a, length).total_cmp(&oscillation(b, length)));
    found
}

/// Whether two solutions are one, whatever their parameter, the last entry, is measured in.
fn is_same(a: &[f64], b: &[f64]) -> bool {
    let [a, b] = [a, b].map(|u| &u[..u.len() - 1]);
    let size = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut pairs = a.iter().zip(b);
    pairs.all(|(x, y)| (x - y).abs() <= SAME * size)
}

/// The smallest amplitude, and where the residual is smaller than at the neighbours, along a pattern from the origin and back.
fn valleys(
    fixed: &mut Fixed<'_>,
    origin: &[f64],
    pattern: &[f64],
    effort: &mut Effort,
) -> Vec<Vec<f64>> {
    let mut starts = Vec::new();
    for sign in [1.0, -1.0] {
        let along: Vec<_> = geometric()
            .map(|a| {
                let u: Vec<f64> = origin
                    .iter()
                    .zip(pattern)
                    .map(|(x, p)| x + sign * a * p)
                    .collect();
                (fixed.residual(&u, effort), u)
            })
            .collect();
        let valleys = along
            .windows(3)
            .filter(|w| w[1].0 < (1.0 - PLATEAU) * w[0].0 && w[1].0 <= w[2].0)
            .map(|w| w[1].1.clone());
        if sign > 0.0 {
            starts.extend(along.first().map(|(_, u)| u.clone()));
        }
        starts.extend(valleys);
    }
    starts
}

/// The oscillating part of the load as a unit vector of the extended unknowns.
fn load_pattern(fixed: &mut Fixed<'_>) -> Vec<f64> {
    let mut pattern = fixed.zeros();
    let n = pattern.len() - 1;
    pattern[n] = 0.0;
    fixed.balance.set(fixed.value);
    let coefficients = fixed.balance.coefficients();
    fixed.balance.add_load(coefficients, 1.0, &mut pattern[..n]);
    let length = fixed.balance.length();
    for (index, x) in pattern[..n].iter_mut().enumerate() {
        if index % length == 0 {
            *x = 0.0;
        }
    }
    let norm = crate::numeric::linear::dot(&pattern, &pattern).sqrt();
    if norm > 0.0 {
        for x in &mut pattern {
            *x /= norm;
        }
    }
    pattern
}
