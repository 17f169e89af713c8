//! Rules of integration over an interval, from one target to the next: what forces at nodes do to a pair of states, and how that changes
//! with the length of the interval.
//!
//! Numbers of equations are those of [`equations`](super::equations).

use super::block::{Block, times};
use super::nodes::Nodes;

/// Adds a multiple.
pub(super) fn add(to: &mut [f64], factor: f64, of: &[f64]) {
    for (to, of) in to.iter_mut().zip(of) {
        *to += factor * of;
    }
}

/// Integrals of both parts of the kernel times every polynomial, up to every target.
pub(super) fn integrate(
    block: &Block,
    nodes: &Nodes,
    time: f64,
    once: &mut [f64],
    twice: &mut [f64],
) {
    let n = nodes.count();
    let rule = nodes.between(block.rate() * time);
    let mut before = 0.0;
    for (way, &psi) in nodes.targets.iter().enumerate() {
        let step = block.kernel((psi - before) * time);
        before = psi;
        let (done, to) = (way * n, (way + 1) * n);
        if way == 0 {
            once[..n].fill(0.0);
            twice[..n].fill(0.0);
        } else {
            for l in 0..n {
                let [a, b] = [once[done - n + l], twice[done - n + l]];
                (once[done + l], twice[done + l]) = block.compose(step, a, b);
            }
        }
        for point in 0..rule.points {
            let place = way * rule.points + point;
            let kernel = block.kernel(rule.left[place] * time);
            let weighted = &rule.weighted[place * n..][..n];
            add(&mut once[done..to], kernel.c * time, weighted);
            add(&mut twice[done..to], kernel.k * time, weighted);
        }
    }
}

/// (3) from target to target: with `X_(j+1) = e^(A h) X_j + s sum_q w_q e^(A d_q s) f_q`, where `h` and `d_q s` are times,
/// `dX_(j+1)/ds = e^(A h) (dX_j/ds + (h / s) A X_j) + sum_q w_q (1 + d_q s A) e^(A d_q s) f_q`.
pub(super) fn by_time(
    block: &Block,
    nodes: &Nodes,
    time: f64,
    load: impl Fn(usize) -> [f64; 2],
    to: &mut [[f64; 2]],
) {
    let n = nodes.count();
    let rule = nodes.between(block.rate() * time);
    let (mut integral, mut slope) = ([0.0; 2], [0.0; 2]);
    let mut before = 0.0;
    for (way, &psi) in nodes.targets.iter().enumerate() {
        let step = psi - before;
        before = psi;
        let e = block.exponential(step * time);
        let driven = times(block.matrix, integral);
        slope = times(e, [0, 1].map(|i| slope[i] + step * driven[i]));
        integral = times(e, integral);
        for point in 0..rule.points {
            let place = way * rule.points + point;
            let mut sum = [0.0; 2];
            for (l, weight) in rule.weighted[place * n..][..n].iter().enumerate() {
                let load = load(l);
                sum = [sum[0] + weight * load[0], sum[1] + weight * load[1]];
            }
            let left = rule.left[place] * time;
            let carried = times(block.exponential(left), sum);
            let driven = times(block.matrix, carried);
            for i in 0..2 {
                integral[i] += time * carried[i];
                slope[i] += carried[i] + left * driven[i];
            }
        }
        to[way] = slope;
    }
}
