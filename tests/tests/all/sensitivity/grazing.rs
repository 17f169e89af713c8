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

/// A preload makes the force jump at the touch. The motion that does not reach the stop is linear up to there, so that the place moves as where it does not
/// jump; and so does what is read off it: the peak-to-peak is twice the play.
#[test]
fn where_a_force_jumps_the_place_is_that_of_the_side_that_does_not_touch() {
    hertzian::oscillator! {
        Preloaded(x) {
            param zeta in 0.0..;
            param play > 0;
            param drive;
            law stop(gap) { gap > play => 0.3 + 4*(gap - play), else => 0 }
            ddot(x) + 2*zeta*dot(x) + x + stop(x) = drive*cos(omega*t);
        }
    }
    let (zeta, play, drive) = (0.05_f64, 1.0_f64, 0.3_f64);
    let request = FrequencyResponse::of(&Preloaded { zeta, play, drive }).by(Shooting::new());
    let branch = request.from(0.5).to(0.9).run().unwrap();
    let half = 1.0 - 2.0 * zeta * zeta;
    let s = (drive / play).powi(2);
    let w = half - (half * half - 1.0 + s).sqrt();
    let omega = w.sqrt();
    let by_omega = (-2.0 * (1.0 - w) + 4.0 * zeta * zeta) * 2.0 * omega;
    let expected = [
        ("zeta", -8.0 * zeta * w / by_omega),
        ("play", -2.0 * s / play / by_omega),
        ("drive", 2.0 * s / drive / by_omega),
    ];
    let mut compared = 0;
    for event in &branch.events {
        if !matches!(event.kind, EventKind::Grazing { .. })
            || (event.point.value - omega).abs() > 1e-4
        {
            continue;
        }
        compared += 1;
        let moves = branch.event_sensitivities(event).unwrap();
        println!("{:?} {} {:?}", event.kind, event.point.value, moves.missing);
        for (name, expected) in expected {
            let found = moves.of_place(name).unwrap();
            println!("{name} {found:?} {expected}");
            let apart = (found.value - expected).abs();
            assert!(apart < 1e-8, "{name} {found:?} {expected}");
        }
        let height = moves.of_moving("x:p2p", "play").unwrap();
        assert!((height.value - 2.0).abs() < 1e-6, "{height:?}");
        let found = branch.event_sensitivities_of(event, &[]).unwrap();
        assert!(found.condition > 1e-3);
    }
    assert!(compared > 0);
}
