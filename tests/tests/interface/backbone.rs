//! A backbone is a branch: it is drawn, written and read as any other, and has no orbits but its own.

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::stability::Method;
use hertzian::{Branch, Error, OrbitMethodKind, RequestError};

hertzian::oscillator! {
    /// Linear in contact, with the frequency two, and free below.
    Ball(x, y) {
        param drive = 0.0;
        law contact(gap) { gap > 0 => 4*gap, else => 0 }
        ddot(x) + contact(x) = 4 + drive*cos(omega*t);
        ddot(y) + 9*y = 0;
    }
}

hertzian::oscillator! {
    Linear(x) {
        param drive = 0.1;
        ddot(x) + 0.1*dot(x) + 4*x = drive*cos(omega*t);
    }
}

/// Both: small motions of a ball, which keep contact, and a resonance at the frequency two with the amplitude `drive/0.2`.
fn backbones() -> [Branch; 2] {
    let free = FreeOscillation::of(&Ball::default());
    let free = free.from(1.1).to(1.9).near_rest(&[1.1, 0.0], 2.0).run();
    let resonance = PhaseResonance::of(&Linear::default()).vary("drive");
    let resonance = resonance.to(0.2).between(1.0, 3.0).run();
    [free, resonance].map(|curve| curve.expect("a backbone"))
}

/// The column of a table.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let mut names = lines.next().expect("names").split(',');
    let place = names.position(|own| own == name).expect("a column");
    let cell = |line: &str| line.split(',').nth(place)?.parse().ok();
    lines.map(|line| cell(line).expect("a number")).collect()
}

#[test]
fn a_table_has_the_closed_form() {
    let [free, resonance] = backbones();
    assert_eq!(
        (free.varied.as_str(), resonance.varied.as_str()),
        ("omega", "drive")
    );
    let csv = free.to_csv();
    let sizes = column(&csv, "peak_to_peak");
    for (omega, minimum) in column(&csv, "omega").iter().zip(column(&csv, "min")) {
        assert!((omega - 2.0).abs() < 1e-9, "{omega}");
        assert!(minimum > 0.0);
    }
    assert!((sizes[0] - 0.2).abs() < 1e-9 && (sizes[sizes.len() - 1] - 1.8).abs() < 1e-9);
    let csv = resonance.to_csv();
    let drives = column(&csv, "drive");
    assert_eq!(drives, column(&csv, "value"));
    for (drive, size) in drives.iter().zip(column(&csv, "peak_to_peak")) {
        assert!((size - 10.0 * drive).abs() < 1e-7, "{drive} {size}");
    }
    // The drive balances damping: the power is half of c (omega a)^2.
    let powers = column(&csv, "dissipated_power");
    for (drive, power) in drives.iter().zip(powers) {
        assert!((power - 0.05 * (10.0 * drive).powi(2)).abs() < 1e-8);
    }
}

/// An orbit that is at rest in two states has a series when it is completed: of a free ball `1 + a cos(2 t)`.
#[test]
fn an_orbit_is_completed() {
    let [free, _] = backbones();
    let last = free.points.last().expect("an orbit");
    let ends: Vec<f64> = last.orbit.states().map(|state| state[0]).collect();
    assert!(
        (ends[0] - 1.9).abs() < 1e-9 && (ends[1] - 0.1).abs() < 1e-9,
        "{ends:?}"
    );
    let completed = free.complete(last).expect("a series");
    let series = completed.orbit.series(0).expect("a series");
    assert!((series[0] - 1.0).abs() < 1e-7 && (series[1] - 0.9).abs() < 1e-7);
    let force = completed.observed.contacts[0].peak_force;
    assert!((force - 4.0 * 1.9).abs() < 1e-7, "{force}");
    let rms = free.measured(&"x:rms".parse().expect("a measure"), last);
    let expected = 1.0_f64.hypot(0.9 / std::f64::consts::SQRT_2);
    assert!((rms.expect("a motion").expect("rms") - expected).abs() < 1e-7);
    assert_eq!(free.method(), Some(OrbitMethodKind::Shooting));
}

/// Whether it says that there are no orbits but its own.
fn is_refused<T>(found: Result<T, Error>) -> bool {
    let error = found.err().expect("a backbone");
    matches!(error.downcast_ref(), Some(RequestError::Backbone))
}

fn has_no_others(curve: &Branch) -> bool {
    is_refused(curve.at(curve.points[0].value)) && is_refused(curve.resume().run())
}

#[test]
fn it_has_no_orbits_but_its_own() {
    assert!(backbones().iter().all(has_no_others));
}

/// Its frequency goes with the orbit: derivatives at a fixed frequency are none of its own, and nothing is known of its stability.
fn has_no_derivatives(curve: &Branch) -> bool {
    let point = curve.points.last().expect("an orbit");
    let wanted = ["x:p2p".parse().expect("a measure")];
    is_refused(curve.sensitivities(point))
        && is_refused(curve.sensitivities_of(point, &wanted))
        && is_refused(curve.quick_sensitivities_of(point, &wanted, &["drive"]))
        && is_refused(curve.multipliers(point, Method::Hill))
}

#[test]
fn it_has_no_derivatives_and_no_multipliers() {
    assert!(backbones().iter().all(has_no_derivatives));
}

#[test]
fn what_is_read_is_what_was_written() {
    let path = std::env::temp_dir().join(format!("hertzian-backbone-{}.json", std::process::id()));
    let models: [&dyn hertzian::System; 2] = [&Ball::default(), &Linear::default()];
    for (curve, model) in backbones().iter().zip(models) {
        curve.write(&path).expect("written");
        let mut read = Branch::read(&path).expect("a branch");
        assert_eq!(read, *curve);
        assert!(has_no_others(&read));
        read.attach(model).expect("its model");
        assert!(has_no_others(&read) && has_no_derivatives(&read));
        let last = read.points.last().expect("an orbit");
        assert_eq!(read.complete(last), curve.complete(last));
        // And once more.
        read.write(&path).expect("written");
        assert!(has_no_others(&Branch::read(&path).expect("a branch")));
    }
    std::fs::remove_file(path).ok();
}

#[test]
fn it_is_drawn() {
    use hertzian::chart::View;

    let [free, resonance] = backbones();
    assert!(free.chart().to_svg().contains("excitation frequency"));
    assert!(resonance.chart().to_svg().contains("drive"));
    let uncertain = ["drive=1%".parse().expect("an uncertainty")];
    for view in [View::new(), View::new().harmonics(2)] {
        assert!(is_refused(free.band(&view, &uncertain)));
        assert!(is_refused(resonance.band(&view, &uncertain)));
    }
}
