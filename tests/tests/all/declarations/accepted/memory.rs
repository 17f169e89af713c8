//! Coordinates that remember: an equation of first order beside those of motion, declared as its derivative, against closed forms and an
//! integrator of three states.

use std::f64::consts::TAU;

use hertzian::system::System;
use hertzian::{ContactEquation, FrequencyResponse, HarmonicBalance, OrbitMethod, Point, Shooting};

hertzian::oscillator! {
    /// A spring, and beside it a spring in series with a damper (Maxwell, Zener): `R = c z' + k (z - x) = 0` as `R' + omega R = 0`.
    Zener(x, z) {
        param k > 0;
        param c > 0;
        ddot(x) + x + k*(x - z) = 0.3*cos(omega*t);
        c*ddot(z) + k*(dot(z) - dot(x)) + omega*(c*dot(z) + k*(z - x)) = 0;
    }
}

hertzian::oscillator! {
    /// A contact on a layer that creeps: a spring beside a damper, without mass between.
    Creeping(x, z) {
        param k > 0;
        param c > 0;
        law contact(gap) { gap > 0 => gap^1.5, else => 0 }
        law changes(gap) { gap > 0 => 1.5*gap^0.5*dot(gap) + omega*gap^1.5, else => 0 }
        ddot(x) + contact(x - z) = 1 + 0.8*cos(omega*t);
        c*ddot(z) + k*dot(z) + omega*(c*dot(z) + k*z) - changes(x - z) = 0;
    }
}

/// One orbit by each method, with all that is read off it.
fn orbits(system: &dyn System, omega: f64) -> [(&'static str, Point); 3] {
    let request = FrequencyResponse::of(system);
    let contact = request.clone().by(ContactEquation::new());
    let shooting = request.clone().by(Shooting::new());
    let balance = request.by(HarmonicBalance::new());
    [
        ("balance", orbit(&balance, omega)),
        ("shooting", orbit(&shooting, omega)),
        ("contact equation", orbit(&contact, omega)),
    ]
}

fn orbit<M: OrbitMethod>(request: &FrequencyResponse<M>, omega: f64) -> Point {
    let point = request.orbit(omega).expect("an orbit");
    request.complete(&point).expect("its series")
}

/// `x = 0.3 / (1 - omega^2 + k i omega c / (k + i omega c))`
#[test]
fn a_damper_in_series_has_its_complex_stiffness() {
    let (k, c) = (0.7, 0.4);
    let system = Zener { k, c };
    for omega in [0.5, 1.1, 2.3] {
        let square = k * k + (omega * c).powi(2);
        let real = 1.0 - omega * omega + k * (omega * c).powi(2) / square;
        let imaginary = k * k * omega * c / square;
        let expected = 0.6 / real.hypot(imaginary);
        for (method, point) in orbits(&system, omega) {
            let found = point.peak_to_peak() / expected;
            assert!((found - 1.0).abs() < 1e-9, "{method} {omega}: {found}");
            // What the derivative adds decays by itself.
            let added = (-TAU).exp();
            let mut multipliers = point.stability.multipliers.iter();
            assert!(multipliers.any(|m| (m - added).norm() < 1e-8), "{method}");
        }
    }
}

/// The state after a period, peak-to-peak of `x`, the largest force, and the part of the time in contact, of the equations as they are: three
/// states, by the method of Kutta (1901).
fn integrated(k: f64, c: f64, omega: f64, start: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let push = |[x, _, z]: [f64; 3]| (x - z).max(0.0).powf(1.5);
    let slope = |t: f64, s: [f64; 3]| {
        let load = 1.0 + 0.8 * (omega * t).cos();
        [s[1], load - push(s), (push(s) - k * s[2]) / c]
    };
    let along = |s: [f64; 3], by: f64, d: [f64; 3]| std::array::from_fn(|i| s[i] + by * d[i]);
    let steps = 20_000;
    let h = TAU / omega / f64::from(steps);
    let (mut s, mut touching) = (start, 0.0);
    let [mut least, mut most, mut largest] = [s[0], s[0], push(s)];
    for step in 0..steps {
        let t = h * f64::from(step);
        let first = slope(t, s);
        let second = slope(t + 0.5 * h, along(s, 0.5 * h, first));
        let third = slope(t + 0.5 * h, along(s, 0.5 * h, second));
        let fourth = slope(t + h, along(s, h, third));
        let sum = |i: usize| first[i] + 2.0 * (second[i] + third[i]) + fourth[i];
        s = std::array::from_fn(|i| s[i] + h / 6.0 * sum(i));
        (least, most, largest) = (s[0].min(least), s[0].max(most), push(s).max(largest));
        touching += f64::from(u8::from(push(s) > 0.0));
    }
    (s, [most - least, largest, touching / f64::from(steps)])
}

/// Orbits come back where they began, in the three states of the equations as they are, by each method.
#[test]
fn a_contact_on_a_layer_that_creeps_is_that_of_its_three_states() {
    let (k, c) = (2.0, 1.5);
    let system = Creeping { k, c };
    for omega in [0.6, 0.9] {
        for (method, point) in orbits(&system, omega) {
            let state = point.orbit.state();
            let start = [state[0], state[2], state[1]];
            let (end, [size, largest, touching]) = integrated(k, c, omega, start);
            let away = end.iter().zip(start).map(|(a, b)| (a - b).abs());
            let away = away.fold(0.0, f64::max) / size;
            assert!(away < 1e-7, "{method} {omega}: {away:e}");
            let found = point.peak_to_peak() / size;
            let stated = point.error.expect("an error") + 1e-7;
            assert!((found - 1.0).abs() < stated, "{method} {omega}: {found}");
            let contact = &point.observed.contacts[0];
            let (force, fraction) = (contact.peak_force, contact.fraction);
            assert!((force / largest - 1.0).abs() < 3e-6, "{method} {force}");
            assert!((fraction - touching).abs() < 2e-4, "{method} {fraction}");
        }
    }
}
