//! Where orbits graze, against a closed form.

use hertzian::{EventKind, FrequencyResponse, Shooting};

hertzian::oscillator! {
    /// Meets a stop where its linear resonance is higher than the gap.
    Stopped(x) {
        param zeta in 0.0..;
        param play > 0;
        param drive;
        law stop(gap) { gap > play => 10*(gap - play), else => 0 }
        ddot(x) + 2*zeta*dot(x) + x + stop(x) = drive*cos(omega*t);
    }
}

/// With `r = 1 - omega^2` the amplitude is `play` where `r^2 + (2 zeta omega)^2 = (drive / play)^2 = s`; with `w = omega^2` the derivative of
/// `(1 - w)^2 + 4 zeta^2 w - s` is that of the place.
#[test]
fn moves_as_the_linear_resonance_does() {
    let model = Stopped {
        zeta: 0.05,
        play: 1.0,
        drive: 0.3,
    };
    let branch = FrequencyResponse::of(&model)
        .bifurcations(true)
        .from(0.5)
        .to(1.0)
        .run()
        .unwrap();
    let mut grazing = branch
        .events
        .iter()
        .filter(|e| matches!(e.kind, EventKind::Grazing { .. }));
    let event = grazing.next().unwrap();
    let moves = branch.event_sensitivities(event).unwrap();
    let (zeta, play, drive) = (0.05_f64, 1.0_f64, 0.3_f64);
    let half = 1.0 - 2.0 * zeta * zeta;
    let s = (drive / play).powi(2);
    let w = half - (half * half - 1.0 + s).sqrt();
    let omega = w.sqrt();
    assert!((event.point.value - omega).abs() < 1e-6);
    let by_w = -2.0 * (1.0 - w) + 4.0 * zeta * zeta;
    let by_omega = by_w * 2.0 * omega;
    let expected = [
        ("zeta", -8.0 * zeta * w / by_omega),
        ("play", -2.0 * s / play / by_omega),
        ("drive", 2.0 * s / drive / by_omega),
    ];
    for (name, expected) in expected {
        let found = moves.of_place(name).unwrap();
        assert!(
            (found.value - expected).abs() < 1e-8,
            "{name} {found:?} {expected}"
        );
    }
    assert!(!moves.measured.is_empty());
}

/// A preload makes the force jump at the touch.
#[test]
fn where_a_force_jumps_there_is_none() {
    hertzian::oscillator! {
        Preloaded(x) {
            param play > 0;
            law stop(gap) { gap > play => 1 + 10*(gap - play), else => 0 }
            ddot(x) + 0.1*dot(x) + x + stop(x) = 0.3*cos(omega*t);
        }
    }
    let request = FrequencyResponse::of(&Preloaded { play: 1.0 }).by(Shooting::new());
    let branch = request.from(0.5).to(0.9).run().unwrap();
    let event = branch.events(EventKind::Grazing { turns: false }).next();
    let error = branch.event_sensitivities(event.unwrap()).unwrap_err();
    assert!(error.to_string().contains("the force jumps"), "{error}");
}
