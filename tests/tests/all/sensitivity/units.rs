//! What is said of an orbit does not depend on the unit of time.

use hertzian::{EventKind, FrequencyResponse, Shooting};

hertzian::oscillator! {
    /// With a time in units of which `speed` make one.
    Scaled(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        param speed > 0;
        ddot(x)/speed^2 + 2*zeta/speed*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t) + load;
    }
}

fn scaled(speed: f64, drive: f64) -> Scaled {
    Scaled {
        zeta: 0.01,
        load: 0.0,
        drive,
        speed,
    }
}

#[test]
fn conditions_and_errors_are_the_same() {
    let of = |speed: f64| {
        let model = scaled(speed, 0.1);
        let request = FrequencyResponse::of(&model).stability(false);
        let branch = request.from(1.4 * speed).to(1.6 * speed).run().unwrap();
        let orbit = &branch.at(1.5 * speed).unwrap()[0];
        let wanted = ["x:p2p".parse().unwrap()];
        let at = branch.sensitivities_of(orbit, &wanted).unwrap();
        let by = at.of("x:p2p", "omega").unwrap();
        (at.condition, by.value * speed, by.error * speed)
    };
    let ((a, by_a, _), (b, by_b, error)) = (of(1.0), of(8000.0));
    assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    assert!((by_a / by_b - 1.0).abs() < 1e-8, "{by_a} {by_b}");
    assert!(error < 1e-8 * by_b.abs(), "{error:e} {by_b}");
}

/// A load breaks the symmetry of figure 2a whatever the unit of time, and without anything that is read off the place has its condition.
#[test]
fn what_breaks_a_symmetry_is_the_same() {
    for speed in [1.0, 1e7] {
        let model = scaled(speed, 0.1);
        let request = FrequencyResponse::of(&model).by(Shooting::new().tolerance(1e-13));
        let branch = request.from(0.4 * speed).to(0.405 * speed).run().unwrap();
        let mut events = branch.events.iter();
        let event = events.find(|event| event.kind == EventKind::SymmetryBreaking);
        let event = event.expect("a broken symmetry");
        assert!((event.point.value / speed - 0.402_310_407_656_194).abs() < 1e-8);
        let found = branch.event_sensitivities(event).unwrap();
        assert_eq!(found.of_place("load"), None, "{speed}");
        let by_drive = found.of_place("drive").unwrap();
        assert!(by_drive.value.is_finite() && by_drive.value != 0.0);
        let missing: Vec<&str> = found.missing.iter().map(|own| own.what.as_str()).collect();
        assert_eq!(
            missing,
            ["place by load", "measured", "moving", "multipliers"]
        );
        let chart = branch.tornado(event, &found, &["load=0.1".parse().unwrap()]);
        let chart = chart.unwrap().to_svg();
        assert!(chart.contains("breaks the symmetry") && !chart.contains("what is varied"));
    }
}
