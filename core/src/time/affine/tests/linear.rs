//! Systems without switches, whose solutions are written in every book, and near which other formulas lose digits.

use std::f64::consts::TAU;

use super::flow;
use crate::oscillator;
use crate::time::{Flow, Stretch};

oscillator! {
    /// A linear oscillator.
    Linear(x) {
        /// damping
        param damping;
        /// stiffness
        param stiffness;
        /// constant load
        param load;
        /// amplitude of a cosine
        param cosine;

        ddot(x) + damping*dot(x) + stiffness*x = load + cosine*cos(omega*t);
    }
}

fn linear(damping: f64, stiffness: f64, load: f64, cosine: f64) -> Linear {
    Linear {
        damping,
        stiffness,
        load,
        cosine,
    }
}

/// Follows a motion for some periods, with and without looking at its stretches, and compares with the exact position and
/// velocity at a time: to some rounding errors of the largest state so far and of the angle passed.
fn check(
    model: &Linear,
    omega: f64,
    periods: f64,
    start: [f64; 2],
    exact: impl Fn(f64) -> [f64; 2],
) {
    let mut flow = flow(model, omega);
    let end = TAU * periods;
    let rate = 1.0_f64.max(model.damping.abs() + model.stiffness.abs().sqrt());
    let mut size = 1.0_f64;
    let mut compare = |found: [f64; 2], phase: f64| {
        let time = phase / omega;
        let exact = exact(time);
        size = size.max(exact[0].abs()).max(exact[1].abs());
        let allowed = size * f64::EPSILON * (20.0 + rate * time);
        for (found, exact) in found.iter().zip(exact) {
            let error = (found - exact).abs();
            assert!(
                error < allowed,
                "{model:?} at {time}: {error:e}, {allowed:e}"
            );
        }
    };
    let mut slow = start;
    let mut see = |stretch: &dyn Stretch| {
        let (from, to) = stretch.phases();
        for part in [0.0, 0.3, 1.0] {
            let phase = from + part * (to - from);
            let mut state = [0.0; 2];
            stretch.state(phase, &mut state);
            compare(state, phase);
        }
    };
    flow.advance(0.0, end, &mut slow, None, Some(&mut see))
        .unwrap();
    let mut fast = start;
    flow.advance(0.0, end, &mut fast, None, None).unwrap();
    compare(slow, end);
    compare(fast, end);
}

/// `sin(x) / x`
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

#[test]
fn resonance_grows_with_time() {
    let exact = |t: f64| [0.5 * t * t.sin(), 0.5 * (t.sin() + t * t.cos())];
    check(&linear(0.0, 1.0, 0.0, 1.0), 1.0, 20.3, [0.0; 2], exact);
}

/// `x = 2 sin((1 + w) t/2) sin((1 - w) t/2) / (1 - w^2)` from rest.
#[test]
fn near_resonance_keeps_its_digits() {
    for detuning in [1e-3, 1e-6, 1e-9, 1e-12, -1e-9] {
        let omega = 1.0 - detuning;
        let d = 1.0 - omega;
        let exact = |t: f64| {
            let (s, u) = (0.5 * (1.0 + omega) * t, 0.5 * d * t);
            let over = t * sinc(u) / (1.0 + omega);
            let velocity = s.cos() * over * 0.5 * (1.0 + omega) + s.sin() * u.cos() / (1.0 + omega);
            [s.sin() * over, velocity]
        };
        check(&linear(0.0, 1.0, 0.0, 1.0), omega, 7.7, [0.0; 2], exact);
    }
}

/// `x = exp(-s t) (x0 C + (v0 + s x0) S)` with `C = cos(r t)`, `S = sin(r t)/r`, `r^2 = k - s^2`; two exponentials if that is
/// negative.
fn decay(damping: f64, stiffness: f64, [x, v]: [f64; 2], t: f64) -> [f64; 2] {
    let s = 0.5 * damping;
    let square = stiffness - s * s;
    let r = square.abs().sqrt();
    if square < 0.0 {
        let (a, b) = (r - s, -r - s);
        let (first, second) = ((v - b * x) / (2.0 * r), (a * x - v) / (2.0 * r));
        let (p, q) = ((a * t).exp(), (b * t).exp());
        return [first * p + second * q, first * a * p + second * b * q];
    }
    let (cosine, sine) = ((r * t).cos(), t * sinc(r * t));
    let e = (-s * t).exp();
    [
        e * (x * cosine + (v + s * x) * sine),
        e * (v * cosine - (s * v + stiffness * x) * sine),
    ]
}

#[test]
fn every_kind_of_damping() {
    for (damping, stiffness) in [
        (0.0, 1.0),
        (0.3, 1.0),
        (2.0, 1.0),
        (2.0 - 2e-9, 1.0),
        (5.0, 1.0),
        (300.0, 1.0),
        (0.1, -0.5),
        (0.0, -1.0),
        (-0.2, 1.0),
        (1e-9, 1.0),
        (0.7, 0.0),
    ] {
        let start = [0.7, -0.4];
        let exact = |t| decay(damping, stiffness, start, t);
        check(
            &linear(damping, stiffness, 0.0, 0.0),
            1.3,
            1.9,
            start,
            exact,
        );
    }
}

/// Under a constant load `x = 2 sin^2(r t/2) / k`, also as the stiffness vanishes.
#[test]
fn little_stiffness_under_a_load() {
    for stiffness in [1.0, 1e-3, 1e-6, 1e-9, 1e-15, 0.0] {
        let r = f64::sqrt(stiffness);
        let exact = |t: f64| {
            let half = 0.5 * t * sinc(0.5 * r * t);
            [2.0 * half * half, 2.0 * half * (0.5 * r * t).cos()]
        };
        check(&linear(0.0, stiffness, 1.0, 0.0), 0.7, 3.0, [0.0; 2], exact);
    }
}

/// Without stiffness `v = (1 - exp(-c t))/c`, and the position is its integral.
#[test]
fn little_damping_under_a_load() {
    for damping in [1e-3, 1e-6, 1e-9, 1e-15] {
        let exact = |t: f64| {
            let u: f64 = damping * t;
            let series = (0..8)
                .rev()
                .fold(0.0, |sum, k| 1.0 / f64::from(k + 2) * (1.0 - u * sum));
            // t^2 (1/2 - u/6 + u^2/24 - ...)
            [t * t * series, -(-u).exp_m1() / damping]
        };
        check(&linear(damping, 0.0, 1.0, 0.0), 0.7, 3.0, [0.0; 2], exact);
    }
}

/// A slow force on a free mass: the particular solution is a million times the motion.
#[test]
fn free_flight_under_a_slow_force() {
    let omega = 1e-3;
    let exact = |t: f64| {
        let half = (0.5 * omega * t).sin() / omega;
        [2.0 * half * half, 2.0 * half * (0.5 * omega * t).cos()]
    };
    check(&linear(0.0, 0.0, 0.0, 1.0), omega, 1e-3, [0.0; 2], exact);
    check(&linear(0.0, 0.0, 0.0, 1.0), omega, 1.7, [0.0; 2], exact);
}
