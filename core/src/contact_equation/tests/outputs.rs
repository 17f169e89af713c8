//! What is read where the error is of an output: that output as if it were of coordinates, these from a few phases until they are completed.

use crate::branches::observed::Motion;
use crate::{Branch, ContactEquation, FrequencyResponse, Shooting};

crate::oscillator! {
    /// Two masses, of which the second meets a ball; one output is a sum, the other the force.
    Measured(x, y) {
        law ball(g) { g > 0 => 30*g^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + x + 0.3*(x - y) = 0.2*cos(omega*t);
        ddot(y) + 0.04*dot(y) + 9*y - 0.3*(x - y) + ball(y - 0.05) = 0;
        output tip = x - 2*y + 0.25;
        output force = force(ball);
    }
}

fn branch(accuracy: Option<&str>) -> Branch {
    let request = FrequencyResponse::of(&Measured {}).by(ContactEquation::new());
    let request = request.from(1.0).to(1.2).tolerance(1e-8);
    let request = match accuracy {
        Some(name) => request.accuracy_of(name),
        None => request,
    };
    request.run().unwrap()
}

fn near(a: &Motion, b: &Motion, part: f64) -> bool {
    (a.maximum - b.maximum).abs() + (a.minimum - b.minimum).abs() <= part * b.peak_to_peak()
}

#[test]
fn coordinates_are_completed_where_the_error_is_of_an_output() {
    let whole = branch(None);
    assert!(whole.points.iter().all(|point| !point.observed.sampled));
    for name in ["tip", "force"] {
        let branch = branch(Some(name));
        for point in branch.points.iter().step_by(5) {
            let observed = &point.observed;
            assert!(observed.sampled);
            assert_eq!((observed.motions.len(), observed.read().len()), (2, 1));
            let completed = branch.complete(point).unwrap().observed;
            assert!(!completed.sampled);
            assert!(near(&completed.motions[0], &observed.motions[0], 1e-7));
            // 48 phases are within two per cent of a motion that is nearly a wave.
            assert!(near(&observed.motions[1], &completed.motions[1], 0.05));
            let exact = FrequencyResponse::of(&Measured {}).by(Shooting::new());
            let exact = exact.tolerance(1e-11).near_orbit(&point.orbit);
            let exact = exact.orbit(point.value).unwrap();
            assert!(near(
                &completed.motions[1],
                &exact.observed.motions[1],
                1e-7
            ));
        }
    }
}

/// The error that is stated of a sum of coordinates covers the true one, and is as small as is asked for.
#[test]
fn stated_errors_of_sums_hold() {
    let branch = branch(Some("tip"));
    for point in &branch.points {
        let exact = FrequencyResponse::of(&Measured {}).by(Shooting::new());
        let exact = exact
            .tolerance(1e-12)
            .near_orbit(&point.orbit)
            .accuracy_of("tip");
        let exact = exact.orbit(point.value).unwrap();
        let exact = exact.observed.outputs[0];
        let own = point.observed.outputs[0];
        let apart = (own.peak_to_peak() - exact.peak_to_peak()).abs() / exact.peak_to_peak();
        let stated = point.error.unwrap();
        assert!(
            apart <= stated + 1e-12,
            "{}: {apart:e} {stated:e}",
            point.value
        );
        assert!(stated <= 1e-8, "{}: {stated:e}", point.value);
    }
}

crate::oscillator! {
    /// A damped elastic stop on each side of the first of two masses: orbits come back with signs changed after half of the period.
    Between(x, y) {
        law right(g, kr, cr) { g > 0 => kr*g + cr*dot(g), else => 0 }
        law left(g, kl, cl) { g < 0 => kl*g + cl*dot(g), else => 0 }
        param k = 20;
        param c = 0.2;
        param lean = 0;
        ddot(x) + 0.1*dot(x) + x - 0.5*(y - x) + right(x - 0.8, k, c) + left(x + 0.8, k, c) = 1.2*cos(omega*t) + lean;
        ddot(y) + 0.1*dot(y) + 2*y + 0.5*(y - x) = 0;
        output push = force(right);
        output pull = force(left);
        output rate = dot(x) - 2*dot(y) + 0.1;
        output both = x + 0.05*force(left) - 0.02*force(right) - 0.3;
        output shaking = ddot(y);
    }
}

/// Forces, rates and sums of them are in closed form, an acceleration is read by rules beside them: all as they are read off the orbit by shooting.
#[test]
fn outputs_of_affine_forces_are_those_of_rules() {
    for (lean, c, omega) in [(0.0, 0.2, 1.1), (0.05, 0.0, 1.3)] {
        let system = Between {
            c,
            lean,
            ..Between::default()
        };
        let request = FrequencyResponse::of(&system);
        let exact = request.by(Shooting::new()).tolerance(1e-12);
        let exact = exact.orbit(omega).unwrap();
        let request = FrequencyResponse::of(&system).by(ContactEquation::new());
        let own = request.near_orbit(&exact.orbit).orbit(omega).unwrap();
        assert_eq!(own.orbit.parts, if lean == 0.0 { 2 } else { 1 });
        let pairs = own.observed.outputs.iter().zip(&exact.observed.outputs);
        for (output, (own, exact)) in pairs.enumerate() {
            let small = 1e-8 * exact.peak_to_peak();
            let numbers = |of: &Motion| [of.minimum, of.maximum, of.mean.unwrap(), of.rms.unwrap()];
            for (own, exact) in numbers(own).into_iter().zip(numbers(exact)) {
                assert!(
                    (own - exact).abs() < small,
                    "{lean} {output}: {own} {exact}"
                );
            }
        }
        // Rounding takes no force beyond where its piece ends.
        let [push, pull] = [0, 1].map(|output| own.observed.outputs[output]);
        assert!(c > 0.0 || push.minimum == 0.0 && pull.maximum == 0.0);
    }
}

crate::oscillator! {
    /// Before an elastic stop.
    Hardly(x) {
        law stop(g) { g > 0 => 3*g, else => 0 }
        param distance;
        ddot(x) + 0.1*dot(x) + x + stop(x - distance) = cos(omega*t);
        output push = force(stop);
    }
}

/// The stop is closed by a ten-millionth of its distance: the square of its force is a difference of numbers that are `1e14` times as large.
#[test]
fn forces_of_contacts_that_hardly_close_are_read() {
    // Of the linear response: (1 - 2^2)^2 + (0.1 2)^2.
    let amplitude = 1.0 / 9.04_f64.sqrt();
    let system = Hardly {
        distance: (1.0 - 1e-7) * amplitude,
    };
    let request = FrequencyResponse::of(&system);
    let exact = request
        .by(Shooting::new())
        .tolerance(1e-12)
        .orbit(2.0)
        .unwrap();
    let request = FrequencyResponse::of(&system).by(ContactEquation::new());
    let own = request.near_orbit(&exact.orbit).orbit(2.0).unwrap();
    let [own, exact] = [own, exact].map(|found| found.observed.outputs[0]);
    assert!(exact.maximum > 0.0);
    for [own, exact] in [
        [own.maximum, exact.maximum],
        [own.mean.unwrap(), exact.mean.unwrap()],
        [own.rms.unwrap(), exact.rms.unwrap()],
    ] {
        assert!((own / exact - 1.0).abs() < 1e-6, "{own:e} {exact:e}");
    }
}

crate::oscillator! {
    /// Two masses, one between elastic stops and the other one between balls: orbits come back with signs changed after half of the period.
    Mixed(x, y) {
        law right(g) { g > 0 => 20*g + 0.2*dot(g), else => 0 }
        law left(g) { g < 0 => 20*g + 0.2*dot(g), else => 0 }
        law upper(g) { g > 0 => 30*g^1.5, else => 0 }
        law lower(g) { g > 0 => 30*g^1.5, else => 0 }
        param lean = 0;
        ddot(x) + 0.1*dot(x) + x - 0.5*(y - x) + right(x - 0.6) + left(x + 0.6) = 1.2*cos(omega*t) + lean;
        ddot(y) + 0.1*dot(y) + 2*y + 0.5*(y - x) + upper(y - 0.2) - lower(-y - 0.2) = 0;
        output push = force(right);
        output grip = force(upper);
        output rate = dot(x) - 2*dot(y) + 0.1;
        output both = x + 0.05*force(left) - 0.02*force(lower) - 0.3;
        output sum = x - 2*y + 0.25;
    }
}

/// Between balls forces are unknown at nodes: there outputs with rates or forces of balls are read by rules, and in closed form on all other intervals.
#[test]
fn outputs_partly_by_rules_are_those_of_shooting() {
    for lean in [0.0, 0.05] {
        let system = Mixed { lean };
        let request = FrequencyResponse::of(&system).tolerance(1e-11);
        let exact = request.clone().by(Shooting::new()).tolerance(1e-12);
        let exact = exact.orbit(1.1).unwrap();
        let request = request.by(ContactEquation::new());
        let own = request.near_orbit(&exact.orbit).orbit(1.1).unwrap();
        assert_eq!(own.orbit.parts, if lean == 0.0 { 2 } else { 1 });
        let [push, grip] = [0, 1].map(|output| exact.observed.outputs[output].maximum);
        assert!(push > 1.0 && grip > 0.05, "{push} {grip}");
        let pairs = own.observed.outputs.iter().zip(&exact.observed.outputs);
        for (output, (own, exact)) in pairs.enumerate() {
            let small = 1e-8 * exact.peak_to_peak();
            let numbers = |of: &Motion| [of.minimum, of.maximum, of.mean.unwrap(), of.rms.unwrap()];
            for (own, exact) in numbers(own).into_iter().zip(numbers(exact)) {
                assert!(
                    (own - exact).abs() < small,
                    "{lean} {output}: {own} {exact}"
                );
            }
        }
    }
}
