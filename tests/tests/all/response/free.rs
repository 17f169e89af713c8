//! Systems that nothing holds along some direction, against the same systems in relative coordinates, and closed forms.

use hertzian::error::ErrorKind;
use hertzian::{Branch, FrequencyResponse, ModelError, Shooting, Stability, Verdict};

hertzian::oscillator! {
    /// Two gears, coupled by their teeth only.
    pub Free(a, b) {
        param j1 > 0;
        param j2 > 0;
        param c in 0.0..;
        param k > 0;
        param half > 0;
        param torque;
        param brake;
        param drive;
        law mesh(gap) {
            gap > half => k*(gap - half),
            -half <= gap <= half => 0,
            gap < -half => k*(gap + half),
        }
        j1*ddot(a) + c*(dot(a) - dot(b)) + mesh(a - b) = torque + drive*cos(omega*t);
        j2*ddot(b) - c*(dot(a) - dot(b)) - mesh(a - b) = -brake;
    }
}

hertzian::oscillator! {
    /// The same in `u = a - b`: the second equation times `j1/(j1 + j2)` from the first times `j2/(j1 + j2)`.
    pub Relative(u) {
        param j1 > 0;
        param j2 > 0;
        param c in 0.0..;
        param k > 0;
        param half > 0;
        param torque;
        param drive;
        law mesh(gap) {
            gap > half => k*(gap - half),
            -half <= gap <= half => 0,
            gap < -half => k*(gap + half),
        }
        j1*j2/(j1 + j2)*ddot(u) + c*dot(u) + mesh(u) = torque + j2/(j1 + j2)*drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Two masses with a spring between them.
    pub Sprung(a, b) {
        param m1 > 0;
        param m2 > 0;
        param k > 0;
        param c in 0.0..;
        param ground in 0.0..;
        param load;
        m1*ddot(a) + ground*m1*dot(a) + c*(dot(a) - dot(b)) + k*(a - b) = load + cos(omega*t);
        m2*ddot(b) + ground*m2*dot(b) - c*(dot(a) - dot(b)) - k*(a - b) = -load;
    }
}

const FREE: Free = Free {
    j1: 1.0,
    j2: 2.0,
    c: 0.1,
    k: 1.0,
    half: 1.0,
    torque: 0.1,
    brake: 0.1,
    drive: 0.05,
};

/// The same gears with a unit of length and one of time, in which the mesh has its stiffness.
fn scaled(length: f64, time: f64) -> (Free, Relative) {
    let force = length / (time * time);
    let free = Free {
        c: FREE.c / time,
        k: FREE.k / (time * time),
        half: length,
        torque: FREE.torque * force,
        brake: FREE.brake * force,
        drive: FREE.drive * force,
        ..FREE
    };
    let relative = Relative {
        j1: free.j1,
        j2: free.j2,
        c: free.c,
        k: free.k,
        half: free.half,
        torque: free.torque,
        drive: free.drive,
    };
    (free, relative)
}

/// Largest and smallest `a - b` of a point of the gears, by many samples: its peak-to-peak to about the square of their distance.
fn relative_peak_to_peak(point: &hertzian::Point) -> f64 {
    let period = std::f64::consts::TAU / point.omega();
    let at = |i: i32| {
        let time = period * f64::from(i) / 20_000.0;
        point.orbit.state_at(0, time).unwrap().0 - point.orbit.state_at(1, time).unwrap().0
    };
    let (low, high) = (0..20_000)
        .map(at)
        .fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
    high - low
}

/// Multipliers, largest first, agree to what both state.
fn agree(free: &Stability, relative: &Stability) {
    assert_eq!(free.rigid, 2);
    assert_eq!(relative.rigid, 0);
    assert_eq!(free.multipliers.len(), 2);
    let bound = free.error + relative.error;
    for (x, y) in free.multipliers.iter().zip(&relative.multipliers) {
        assert!((x - y).norm() <= bound, "{free:?} {relative:?}");
    }
    assert_eq!(free.verdict, relative.verdict);
}

fn same_folds(free: &Branch, relative: &Branch) {
    let of = |branch: &Branch| -> Vec<(f64, f64)> {
        let folds = branch.folds();
        folds.map(|fold| (fold.point.value, fold.error)).collect()
    };
    let (free, relative) = (of(free), of(relative));
    assert_eq!((free.len(), relative.len()), (2, 2));
    for ((x, dx), (y, dy)) in free.into_iter().zip(relative) {
        assert!((x - y).abs() <= dx + dy, "{x} {dx} {y} {dy}");
        assert!(dx < 1e-6 * x, "{x} {dx}");
    }
}

/// In both directions and with units of 1e-5 and 1e5.
#[test]
fn free_gears_have_the_response_of_their_relative_motion() {
    for (length, time) in [(1.0, 1.0), (1e-5, 1e-5), (1e5, 1e5), (1e-5, 1.0)] {
        let (free, relative) = scaled(length, time);
        for (from, to) in [(0.4, 2.0), (2.0, 0.4)] {
            let (from, to) = (from / time, to / time);
            let free = FrequencyResponse::of(&free).from(from).to(to).run();
            let relative = FrequencyResponse::of(&relative).from(from).to(to).run();
            let (free, relative) = (free.unwrap(), relative.unwrap());
            same_folds(&free, &relative);
            for omega in [0.6, 0.9, 1.0, 1.5] {
                let omega = omega / time;
                let (free, relative) = (free.at(omega).unwrap(), relative.at(omega).unwrap());
                assert_eq!(free.len(), relative.len());
                for (free, relative) in free.iter().zip(&relative) {
                    let (x, y) = (relative_peak_to_peak(free), relative.peak_to_peak());
                    assert!((x - y).abs() < 1e-6 * y, "{omega} {x} {y}");
                    agree(&free.stability, &relative.stability);
                }
            }
        }
    }
}

/// An unbalanced load is no start that was not found: it is said what carries the gears away, wherever in the range that is.
#[test]
fn unbalanced_gears_are_carried_away() {
    let model = Free {
        brake: 0.11,
        ..FREE
    };
    let error = FrequencyResponse::of(&model).from(0.4).to(2.0).run();
    let error = error.unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NoOrbit);
    let Some(ModelError::CarriedAway {
        load, direction, ..
    }) = error.downcast_ref()
    else {
        panic!("{error}");
    };
    assert!((load + 0.01).abs() < 1e-15, "{load}");
    assert_eq!(direction, "a + b");
    // In balance at the beginning of the range only.
    let varied = FrequencyResponse::of(&FREE).vary("torque").omega(0.7);
    let error = varied.from(0.1).to(0.2).run().unwrap_err();
    assert!(
        matches!(error.downcast_ref(), Some(ModelError::CarriedAway { load, .. }) if (load - 0.0137).abs() < 1e-12),
        "{error}"
    );
}

/// By shooting too, whichever of the parameters is varied, a mass by which the centre depends on it among them.
#[test]
fn free_gears_are_found_by_shooting_as_their_relative_motion() {
    for (length, time) in [(1.0, 1.0), (1e-5, 1e-5), (1e-5, 1.0)] {
        let (free, relative) = scaled(length, time);
        for (name, from, to, at) in [
            (
                "omega",
                0.4 / time,
                2.0 / time,
                [0.6, 0.9, 1.0, 1.5].map(|x| x / time),
            ),
            ("j2", 2.0, 0.4, [1.9, 1.3, 0.7, 0.5]),
            (
                "c",
                0.05 / time,
                0.5 / time,
                [0.06, 0.1, 0.2, 0.4].map(|x| x / time),
            ),
        ] {
            let of = |system: &dyn hertzian::System| {
                let mut request = FrequencyResponse::of(system).by(Shooting::new());
                request = request.from(from).to(to);
                if name != "omega" {
                    request = request.vary(name).omega(0.9 / time);
                }
                request.run().unwrap()
            };
            let (free, relative) = (of(&free), of(&relative));
            let folds = [&free, &relative].map(|branch| branch.folds().count());
            assert_eq!(folds[0], folds[1], "{name}");
            for (free, relative) in free.folds().zip(relative.folds()) {
                let apart = (free.point.value - relative.point.value).abs();
                assert!(
                    apart <= free.error + relative.error,
                    "{name}: {free} {relative}"
                );
            }
            for value in at {
                let (free, relative) = (free.at(value).unwrap(), relative.at(value).unwrap());
                assert_eq!(free.len(), relative.len(), "{name} {value}");
                for (free, relative) in free.iter().zip(&relative) {
                    agree(&free.stability, &relative.stability);
                    let [a, b, va, vb] = free.orbit.state()[..] else {
                        unreachable!()
                    };
                    let [u, v] = relative.orbit.state()[..] else {
                        unreachable!()
                    };
                    let near = |x: f64, y: f64| (x - y).abs() <= 1e-8 * relative.peak_to_peak();
                    assert!(
                        near(a - b, u) && near((va - vb) * time, v * time),
                        "{name} {value}"
                    );
                }
            }
        }
    }
}

/// A damper to ground makes the turning part of what has to be found: shooting refuses that by the name of the direction.
#[test]
fn shooting_refuses_what_turns_against_a_damper() {
    let model = Sprung {
        m1: 1.0,
        m2: 3.0,
        k: 2.0,
        c: 0.2,
        ground: 0.3,
        load: 0.7,
    };
    let error = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .orbit(0.7)
        .unwrap_err();
    assert!(
        matches!(error.downcast_ref(), Some(ModelError::Free { direction }) if direction == "a + b"),
        "{error}"
    );
}

/// `u = a - b` has amplitude `(1/m1) / |k/m - omega^2 + i c omega/m|`, and the centre of mass `1/((m1 + m2) omega^2)`: with
/// `a = s + m2/(m1 + m2) u` the complex amplitude of `a` follows. Multipliers of the relative motion are `exp(lambda T)` with
/// `m lambda^2 + c lambda + k = 0`, and that of the centre of mass is `exp(-ground T)`.
#[test]
fn a_free_pair_has_its_closed_form() {
    use nalgebra::Complex;
    for (ground, c) in [(0.0, 0.2), (0.3, 0.2), (0.3, 0.0)] {
        let model = Sprung {
            m1: 1.0,
            m2: 3.0,
            k: 2.0,
            c,
            ground,
            load: 0.7,
        };
        let request = FrequencyResponse::of(&model);
        let point = request.orbit(0.8).unwrap();
        if ground == 0.0 && c > 0.0 {
            // Where the centre of mass is, too.
            let shot = request.clone().by(Shooting::new()).orbit(0.8).unwrap();
            let states = shot.orbit.state();
            for (coordinate, x) in states[..2].iter().enumerate() {
                let (y, w) = point.orbit.state_at(coordinate, 0.0).unwrap();
                let v = states[2 + coordinate];
                assert!(
                    (x - y).abs() < 1e-9 && (v - w).abs() < 1e-9,
                    "{x} {y} {v} {w}"
                );
            }
        }
        let (w, whole, reduced) = (0.8, 4.0, 0.75);
        let i = Complex::<f64>::i();
        let centre = 1.0 / (whole * (i * w * ground - w * w));
        let relative = 1.0 / (model.k / reduced - w * w + i * w * (model.c / reduced + ground));
        let a = centre + relative * 0.75;
        let series = point.orbit.series(0).unwrap();
        assert!((series[1] - a.re).abs() < 1e-12 && (series[2] + a.im).abs() < 1e-12);
        // The mean: nothing of the centre of mass, and the load on the spring.
        let (mean_a, mean_b) = (series[0], point.orbit.series(1).unwrap()[0]);
        assert!((mean_a - mean_b - 0.7 / 2.0).abs() < 1e-12);
        assert!((mean_a + 3.0 * mean_b).abs() < 1e-12);
        let period = std::f64::consts::TAU / w;
        let damping = Complex::from(c / reduced + ground);
        let root = (damping * damping * 0.25 - model.k / reduced).sqrt();
        let mut expected = vec![
            ((-damping * 0.5 + root) * period).exp(),
            ((-damping * 0.5 - root) * period).exp(),
        ];
        if ground > 0.0 {
            expected.push(Complex::from((-ground * period).exp()));
        }
        let found = &point.stability;
        assert_eq!(found.rigid, if ground > 0.0 { 1 } else { 2 });
        assert_eq!(found.multipliers.len(), expected.len());
        assert_eq!(found.verdict, Verdict::Stable);
        for expected in expected {
            let mut apart = found.multipliers.iter().map(|m| (m - expected).norm());
            assert!(apart.any(|x| x < 1e-9), "{expected} {found:?}");
        }
    }
}
