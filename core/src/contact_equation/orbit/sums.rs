//! Integrals of a signal and of its square over an interval, by the phase.
//!
//! Without forces at nodes a signal is a sum of exponentials, and so are both integrals:
//!
//! ```text
//! x = Re sum_a z_a e^(m_a t),    int x dt = Re sum_a z_a I(m_a),    I(m) = (e^(m s) - 1) / m
//! int x^2 dt = Re sum_ab z_a (z_b I(m_a + m_b) + conj(z_b) I(m_a + conj(m_b))) / 2                              (1)
//! ```
//!
//! With these, states are known at the nodes of a Gauss rule, whose weights are the last row of (2) in [`nodes`](crate::contact_equation::collocation::nodes). It
//! serves where the last coefficients of the signal in Legendre polynomials are below `1e-8` of its largest value; or below `1e-6` where nothing turns by more
//! radians than half of the nodes, so that what follows is ever smaller. The rule leaves out products of two such.
//!
//! Where a signal is a small difference of large exponentials, as the force of a contact that hardly closes, nothing of the second integral is left of (1).
//!
//! There and elsewhere a Gauss rule of eight nodes on a part of `s`, with the phase as `s^2 (3 - 2 s)`, is compared with the same rule on its halves, which are taken where
//! both agree to `1e-9` of the largest value, and halved again where they do not: until the parts are as short as half of a period of what rings by more than
//! `1e-6` of the signal. What rings by less is noise in the rules, which have hundreds of nodes then: of a mean it leaves some hundredth of that.
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, section 6.2 (automatic integration); Trefethen (2013), Approximation Theory and
//! Approximation Practice, chapter 19 (what Gauss rules leave out); for (1), elementary.

use nalgebra::Complex;

use super::signal::Signal;
use crate::numeric::fourier::gauss;

/// Nodes of a rule.
const NODES: usize = 8;
/// Two rules agree if they differ by this part of the largest value: the finer one has twice as many digits.
const AGREE: f64 = 1e-9;
/// What rings by less than this part of a signal is left to the rules.
const RINGS: f64 = 1e-6;
/// Last coefficients of a signal, in parts of its largest value, with which the rule of the nodes serves, and where all that it has turns slowly.
const TAIL: f64 = 1e-8;
const SLOW_TAIL: f64 = 1e-6;
/// Parts of an interval in which every rule is halved once more, at most to the power of two.
const LEAST: usize = 3;
const MOST: usize = 14;
/// Where the integral of the square is less than this part of what its exponentials could make of it, it is what rounding leaves of their sum.
const CANCELLED: f64 = 1e-6;
/// Below this a series takes the place of `e^x - 1`.
const SMALL: f64 = 0.1;

/// `z e^(m t)`
#[derive(Debug, Clone, Copy)]
pub(super) struct Exponential {
    pub(super) z: Complex<f64>,
    pub(super) m: Complex<f64>,
}

/// Those of a signal over its interval.
pub(super) fn integrals_of(signal: &mut Signal<'_, '_>) -> [f64; 2] {
    let phases = signal.phases();
    if let Some(of) = signal.exponentials() {
        let base = signal.base();
        let time = (phases[1] - phases[0]) / base;
        let sums = of_exponentials(&of, time);
        let size = |of: &Exponential| of.z.norm() * (of.m.re * time).max(0.0).exp();
        let most: f64 = of.iter().map(size).sum();
        if sums[1] > CANCELLED * most * most * time {
            return sums.map(|sum| sum * base);
        }
    }
    by_nodes(signal, phases).unwrap_or_else(|| by_rules(signal, phases))
}

/// By the values at the nodes of the forces, where these resolve the signal.
fn by_nodes(signal: &Signal<'_, '_>, [begin, end]: [f64; 2]) -> Option<[f64; 2]> {
    let nodes = signal.nodes()?;
    let n = nodes.count();
    let values: Vec<f64> = (0..n).map(|node| signal.at_node(node).value).collect();
    let largest = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let turns = signal.turns_above(0.0) * (end - begin);
    let tail = if turns <= 0.5 * n as f64 {
        SLOW_TAIL
    } else {
        TAIL
    };
    if nodes.tail(&values) > tail * largest {
        return None;
    }
    let mut sums = [0.0; 2];
    for (x, weight) in values.iter().zip(&nodes.once[n * n..]) {
        let weight = weight * (end - begin);
        sums[0] += weight * x;
        sums[1] += weight * x * x;
    }
    Some(sums)
}

/// (1), over a time.
fn of_exponentials(of: &[Exponential], time: f64) -> [f64; 2] {
    let grown: Vec<Complex<f64>> = of.iter().map(|of| (of.m * time).exp()).collect();
    let mut sums = [0.0; 2];
    for (a, (first, by)) in of.iter().zip(&grown).enumerate() {
        sums[0] += (first.z * integral(first.m, *by, time)).re;
        for (place, (second, of_second)) in of[..=a].iter().zip(&grown).enumerate() {
            let both = second.z * integral(first.m + second.m, by * of_second, time);
            let conjugate = second.m.conj();
            let apart =
                second.z.conj() * integral(first.m + conjugate, by * of_second.conj(), time);
            // Each pair is in (1) twice.
            let times = if place == a { 0.5 } else { 1.0 };
            sums[1] += times * (first.z * (both + apart)).re;
        }
    }
    sums
}

/// `I(m)`, with `e^(m s)`.
fn integral(m: Complex<f64>, grown: Complex<f64>, time: f64) -> Complex<f64> {
    let x = m * time;
    if x.norm_sqr() > SMALL * SMALL {
        return (grown - 1.0) / m;
    }
    let mut sum = Complex::new(1.0, 0.0);
    for order in (2..=11).rev() {
        sum = sum * x / f64::from(order) + 1.0;
    }
    sum * time
}

/// A rule: both integrals, and the largest value.
#[derive(Debug, Clone, Copy)]
struct Rule {
    sums: [f64; 2],
    largest: f64,
}

/// By rules, over an interval between two phases.
fn by_rules(signal: &mut Signal<'_, '_>, ends: [f64; 2]) -> [f64; 2] {
    let turns = signal.turns_above(RINGS) * (ends[1] - ends[0]);
    // The phase moves by 3/2 of the mean at most.
    let parts = (1.5 * turns / std::f64::consts::PI).max(1.0);
    let deepest = (parts.log2().ceil() as usize).clamp(LEAST, MOST);
    let mut sums = [0.0; 2];
    let whole = rule(signal, ends, [0.0, 1.0]);
    part(signal, ends, [0.0, 1.0], whole, deepest, &mut sums);
    sums
}

fn rule(signal: &mut Signal<'_, '_>, [begin, end]: [f64; 2], [from, to]: [f64; 2]) -> Rule {
    let mut found = Rule {
        sums: [0.0; 2],
        largest: 0.0,
    };
    let of = gauss::rule(NODES);
    for (node, weight) in of.nodes.iter().zip(&of.weights) {
        let s = from + (to - from) * node;
        let weight = weight * (to - from) * (end - begin) * 6.0 * s * (1.0 - s);
        let x = signal
            .at(begin + (end - begin) * s * s * (3.0 - 2.0 * s))
            .value;
        found.sums[0] += weight * x;
        found.sums[1] += weight * x * x;
        found.largest = found.largest.max(x.abs());
    }
    found
}

fn part(
    signal: &mut Signal<'_, '_>,
    ends: [f64; 2],
    [from, to]: [f64; 2],
    whole: Rule,
    deepest: usize,
    sums: &mut [f64; 2],
) {
    let middle = 0.5 * (from + to);
    let halves = [[from, middle], [middle, to]];
    let rules = halves.map(|half| rule(signal, ends, half));
    let place = |s: f64| s * s * (3.0 - 2.0 * s);
    let length = (ends[1] - ends[0]) * (place(to) - place(from));
    let largest = rules[0].largest.max(rules[1].largest);
    let apart = |of: usize| (whole.sums[of] - rules[0].sums[of] - rules[1].sums[of]).abs();
    let agree =
        apart(0) <= AGREE * largest * length && apart(1) <= AGREE * largest * largest * length;
    if agree || deepest == 0 {
        for rule in rules {
            sums[0] += rule.sums[0];
            sums[1] += rule.sums[1];
        }
        return;
    }
    for (half, rule) in halves.into_iter().zip(rules) {
        part(signal, ends, half, rule, deepest - 1, sums);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x = 2 + e^(-t) cos 3 t + 1e-3 e^(-0.01 t) sin 1000 t`, by a rule of many nodes.
    #[test]
    fn integrals_of_exponentials_are_those_of_rules() {
        let of = |re: f64, im: f64, m: [f64; 2]| Exponential {
            z: Complex::new(re, im),
            m: Complex::new(m[0], m[1]),
        };
        let sum = [
            of(2.0, 0.0, [0.0, 0.0]),
            of(1.0, 0.0, [-1.0, 3.0]),
            of(0.0, -1e-3, [-0.01, 1000.0]),
            of(0.3, 0.0, [-0.02, 0.0]),
        ];
        for time in [1e-3, 0.4, 2.3] {
            let mut exact = [0.0; 2];
            let rule = gauss::rule(8);
            let parts = 2000;
            for part in 0..parts {
                for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                    let t = time * (f64::from(part) + node) / f64::from(parts);
                    let x = 2.0 + (-t).exp() * (3.0 * t).cos();
                    let x = x + 1e-3 * (-0.01 * t).exp() * (1000.0 * t).sin();
                    let x = x + 0.3 * (-0.02 * t).exp();
                    exact[0] += weight * x * time / f64::from(parts);
                    exact[1] += weight * x * x * time / f64::from(parts);
                }
            }
            let found = of_exponentials(&sum, time);
            for (found, exact) in found.into_iter().zip(exact) {
                assert!(
                    (found - exact).abs() < 1e-13 * exact,
                    "{time}: {found} {exact}"
                );
            }
        }
    }
}
