//! Modes that ring and modes that do not: the first are followed wherever extremes may depend on them, the others cost no samples. Against motions of the flow in closed
//! form, sampled densely.

use std::f64::consts::TAU;

use super::first;
use crate::branches::point::Point;
use crate::contact_equation::orbit::extremes::Sampled;
use crate::contact_equation::orbit::motion::Motion;
use crate::system::System;
use crate::time;
use crate::time::Stretch;
use crate::{ContactEquation, FrequencyResponse};

crate::oscillator! {
    /// A slow mode and one that is two hundred times as fast, damped so little that it rings through the period where the stop makes it ring.
    Fast(x, y) {
        param share;
        law stop(g) { g > 0 => 2000*g, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x + share*y - 0.5) = 0.3*cos(omega*t);
        ddot(y) + 0.04*dot(y) + 40_000*y + share*stop(x + share*y - 0.5) = 0;
    }
}

/// The extremes of a number of the state over a period, from so many samples.
fn sampled(
    system: &dyn System,
    state: &[f64],
    begin: f64,
    omega: f64,
    of: impl Fn(&[f64]) -> f64,
) -> [f64; 2] {
    let mut flow = time::of(system, omega, 1e-12).unwrap();
    let mut state = state.to_vec();
    let mut found = [f64::INFINITY, f64::NEG_INFINITY];
    let mut here = vec![0.0; state.len()];
    let mut see = |stretch: &dyn Stretch| {
        let (from, to) = stretch.phases();
        let samples = (20_000.0 * (to - from)).ceil() as usize;
        for sample in 0..=samples {
            let part = sample as f64 / samples as f64;
            stretch.state(from + (to - from) * part, &mut here);
            let value = of(&here);
            found = [found[0].min(value), found[1].max(value)];
        }
    };
    flow.advance(begin, begin + TAU, &mut state, None, Some(&mut see))
        .unwrap();
    found
}

/// The first orbit of a branch.
fn orbit(system: &dyn System, omega: f64) -> Point {
    let request = FrequencyResponse::of(system).by(ContactEquation::new());
    let request = request.from(omega).to(1.01 * omega).stability(false);
    let mut branch = request.run().unwrap();
    branch.points.remove(0)
}

#[test]
fn a_fast_mode_that_rings_is_seen() {
    let omega = 1.1;
    let system = Fast { share: 0.4 };
    let point = orbit(&system, omega);
    let state = &point.orbit.states[..4];
    for coordinate in 0..2 {
        let dense = sampled(&system, state, 0.0, omega, |state| state[coordinate]);
        let size = dense[1] - dense[0];
        let found = &point.observed.motions[coordinate];
        // Samples are a hundredth of a radian of the fast mode apart.
        assert!((found.minimum - dense[0]).abs() < 1e-4 * size);
        assert!((found.maximum - dense[1]).abs() < 1e-4 * size);
        assert!(found.minimum <= dense[0] + 1e-6 * size);
        assert!(found.maximum >= dense[1] - 1e-6 * size);
    }
}

#[test]
fn a_fast_mode_that_does_not_ring_costs_no_samples() {
    let omega = 1.1;
    // The stop does not move it: it is at rest.
    let system = Fast { share: 0.0 };
    let point = orbit(&system, omega);
    let state = &point.orbit.states[..4];
    let dense = sampled(&system, state, 0.0, omega, |state| state[0]);
    let found = &point.observed.motions[0];
    assert!((found.minimum - dense[0]).abs() < 1e-6);
    assert!((found.maximum - dense[1]).abs() < 1e-6);
    // Eight to its shortest period would be two thousand.
    let (mut equations, u) = first(&system, None, omega, [16, 1]);
    equations.compute(&u, false);
    let motion = Motion::of(&equations);
    motion.gap_extremes();
    motion.coordinate_extremes();
    let samples: usize = motion.sampled().iter().map(Sampled::count).sum();
    assert!(samples < 200, "{samples}");
}

crate::oscillator! {
    /// The same with outputs, one of which is read instant by instant.
    Read(x, y) {
        law stop(g) { g > 0 => 2000*g, else => 0 }
        output sum = x + 0.4*y + 0.25;
        ddot(x) + 0.02*dot(x) + x + stop(x + 0.4*y - 0.5) = 0.3*cos(omega*t);
        ddot(y) + 0.4*dot(y) + 400*y + 0.4*stop(x + 0.4*y - 0.5) = 0;
    }
}

/// Means of an output that is a sum of coordinates, in closed form, are those of a sum over the samples of the motion.
#[test]
fn outputs_in_closed_form_are_those_of_samples() {
    let omega = 1.1;
    let system = Read {};
    let request = crate::FrequencyResponse::of(&system).by(crate::ContactEquation::new());
    let branch = request.from(omega).to(1.11).stability(false).run().unwrap();
    let point = &branch.points[0];
    let found = point.observed.outputs[0];
    let mut flow = time::of(&system, omega, 1e-12).unwrap();
    let mut state = point.orbit.states[..4].to_vec();
    let mut sums = [0.0; 2];
    let mut here = vec![0.0; 4];
    let mut see = |stretch: &dyn Stretch| {
        let (from, to) = stretch.phases();
        // Simpson's rule.
        let parts = 2 * (2000.0 * (to - from)).ceil() as usize;
        for part in 0..=parts {
            stretch.state(from + (to - from) * (part as f64 / parts as f64), &mut here);
            let x = here[0] + 0.4 * here[1] + 0.25;
            let weight = match part {
                0 => 1.0,
                _ if part == parts => 1.0,
                _ if part % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let weight = weight * (to - from) / (3.0 * parts as f64) / TAU;
            sums[0] += weight * x;
            sums[1] += weight * x * x;
        }
    };
    flow.advance(0.0, TAU, &mut state, None, Some(&mut see))
        .unwrap();
    let rms = sums[1].sqrt();
    assert!((found.mean.unwrap() - sums[0]).abs() < 1e-8 * rms);
    assert!((found.rms.unwrap() - rms).abs() < 1e-8 * rms);
}

crate::oscillator! {
    /// A mode beside one that does not turn: it is damped so much that one exponent is near zero and the other far from it.
    Heavy(x, y) {
        param damping;
        law stop(g) { g > 0 => 10*g^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + x + 0.3*(x - y) + stop(x - 0.5) = 0.2*cos(omega*t);
        ddot(y) + damping*dot(y) + y - 0.3*(x - y) = 0;
    }
}

#[test]
fn what_decays_at_once_costs_no_samples() {
    let omega = 1.1;
    for damping in [2.0, 20.0, 1e3, 1e4] {
        let system = Heavy { damping };
        let (mut equations, u) = first(&system, None, omega, [16, 1]);
        equations.compute(&u, false);
        let motion = Motion::of(&equations);
        motion.gap_extremes();
        motion.coordinate_extremes();
        let samples: usize = motion.sampled().iter().map(Sampled::count).sum();
        assert!(samples < 400, "{damping}: {samples}");
    }
    let system = Heavy { damping: 20.0 };
    let point = orbit(&system, omega);
    let state = &point.orbit.states[..4];
    let dense = sampled(&system, state, 0.0, omega, |state| state[0]);
    let found = &point.observed.motions[0];
    assert!((found.minimum - dense[0]).abs() < 1e-7);
    assert!((found.maximum - dense[1]).abs() < 1e-7);
}
