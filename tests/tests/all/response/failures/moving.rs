//! The primitive of a rate term where the contact moves.

use std::f64::consts::TAU;

use hertzian::{Aft, Complex, FrequencyResponse, HarmonicBalance, Shooting};

use super::models::{distance, first};

hertzian::oscillator! {
    /// A contact at the end of a lever whose length varies: force and gap are both by the lever.
    Lever(x) {
        param zeta in 0.0..;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + (1 + 0.5*cos(omega*t))*contact((1 + 0.5*cos(omega*t))*x) = drive*sin(omega*t) + 0.5;
    }
}

/// With `G = 2 zeta max(g, 0)` and a lever `e`, `e dG/dt = d(e G)/dt - (de/dt) G`: to take `i k omega` times the series of `e G` for
/// the damping force forgets the second part.
#[test]
fn a_moving_contact_has_a_second_part() {
    let (zeta, omega) = (0.2, 0.9);
    let model = Lever { zeta, drive: 0.8 };
    let request = FrequencyResponse::of(&model).by(HarmonicBalance::new());
    let request = request.from(omega).to(0.91);
    let branch = first(&request);
    let orbit = &branch.points[0].orbit;
    let mean = |f: &dyn Fn(f64) -> Complex<f64>| -> Complex<f64> {
        let samples = 1 << 18;
        let sum: Complex<f64> = (0..samples)
            .map(|index| f(TAU * (f64::from(index) + 0.5) / f64::from(samples)))
            .sum();
        sum / f64::from(samples)
    };
    // Lever and its rate, gap and its rate, at a phase.
    let motion = |tau: f64| {
        let (x, v) = orbit.state_at(0, tau / omega).unwrap();
        let (lever, turn) = (1.0 + 0.5 * tau.cos(), -0.5 * omega * tau.sin());
        (lever, turn, lever * x, lever * v + turn * x)
    };
    let wave = |tau: f64| Complex::new(tau.cos(), -tau.sin());
    let force = |tau| {
        let (lever, _, gap, rate) = motion(tau);
        let force = if gap > 0.0 { 2.0 * zeta * rate } else { 0.0 };
        wave(tau) * (lever * force)
    };
    let primitive = |tau| {
        let (lever, turn, gap, _) = motion(tau);
        let primitive = 2.0 * zeta * gap.max(0.0);
        (
            wave(tau) * (lever * primitive),
            wave(tau) * (turn * primitive),
        )
    };
    let exact = mean(&force);
    let misused = mean(&|tau| primitive(tau).0) * Complex::new(0.0, omega);
    let both = misused - mean(&|tau| primitive(tau).1);
    println!("first harmonic {exact:.6}, by the first part {misused:.6}, by both {both:.6}");
    assert!((both - exact).norm() < 1e-4 * exact.norm());
    assert!((misused - exact).norm() > 0.3 * exact.norm());
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new().tolerance(1e-11))
        .near_orbit(orbit);
    let cycle = shooting.orbit(omega).unwrap();
    let stability = &branch.points[0].stability;
    let error = distance(&stability.multipliers, &cycle.stability.multipliers);
    println!("default {error:.1e}, estimate {:.1e}", stability.error);
    assert!(error < stability.error && stability.verdict == cycle.stability.verdict);
    // The primitive as it is used here has both parts.
    let sampled = first(&request.harmonics(40).aft(Aft::Primitive).samples(8192));
    let size = sampled.points[0].peak_to_peak() / cycle.peak_to_peak();
    assert!((size - 1.0).abs() < 1e-5, "{size}");
}
