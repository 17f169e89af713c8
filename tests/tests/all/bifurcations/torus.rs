//! Neimark-Sacker bifurcations.

use std::f64::consts::TAU;

use hertzian::{EventKind, FrequencyResponse, Shooting};
use hertzian_tests::TwoMasses;

hertzian::oscillator! {
    /// Two oscillators under a circulatory force, as of a shaft with internal friction.
    pub Circulatory(x, y) {
        param c > 0;
        param k > 0;
        param p;
        param drive;
        ddot(x) + c*dot(x) + k*x + p*y = drive*cos(omega*t);
        ddot(y) + c*dot(y) + k*y - p*x = 0;
    }
}

/// `s^2 + c s + k + i p = 0` has the root `s = -i sqrt(k)` at `p = c sqrt(k)`: flutter.
#[test]
fn flutter_begins_where_the_characteristic_equation_says() {
    let (c, k) = (0.1_f64, 1.44_f64);
    let model = Circulatory {
        c,
        k,
        p: 0.05,
        drive: 0.3,
    };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("p")
        .omega(0.7);
    let branch = shooting.from(0.05).to(0.2).run().unwrap();
    let [event] = &branch.events[..] else {
        panic!("{:?}", branch.events);
    };
    assert_eq!(event.kind, EventKind::NeimarkSacker);
    let error = (event.point.value - c * k.sqrt()).abs();
    // Four multipliers are rounded.
    assert!(
        error < 1e-10 && error <= event.error + 1e-15,
        "{event} {error:.1e}"
    );
    let angle = (k.sqrt() * TAU / 0.7).rem_euclid(TAU);
    let multiplier = event.point.stability.multipliers[0];
    let expected = [angle, TAU - angle];
    let found = multiplier.arg().rem_euclid(TAU);
    assert!(
        expected.iter().any(|angle| (angle - found).abs() < 1e-8),
        "{multiplier}"
    );
}

/// At omega 0.61861 a torus is born and at 0.73878 the period doubles, by an independent computation with five digits.
#[test]
fn two_masses_with_a_stop() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(0.55)
        .to(0.8)
        .run()
        .unwrap();
    for (kind, omega) in [
        (EventKind::NeimarkSacker, 0.61861),
        (EventKind::PeriodDoubling, 0.73878),
    ] {
        let near = |value: f64| (value - omega).abs() < 1e-5;
        let found = branch.events(kind).any(|event| near(event.point.value));
        assert!(found, "{kind} {omega}: {:?}", branch.events);
    }
}
