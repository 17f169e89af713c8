//! Outputs by name: against closed forms, what the equations say of means and harmonics, and motions integrated here.

mod drawn;
mod said;
mod structures;

use std::f64::consts::TAU;

use hertzian::observe::{Reading, Wanted};

use hertzian::{Branch, FrequencyResponse, HarmonicBalance, Point, RequestError, Shooting};

hertzian::oscillator! {
    /// Linear, seen from a floor that moves.
    Isolated(x) {
        param zeta = 0.1;
        param drive = 0.3;
        param floor = 0.05;
        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
        output path = x + floor*cos(omega*t);
        output speed = 2*dot(x);
        output shaking = ddot(x);
        output turned = x*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A mass that is thrown off a rough surface.
    Thrown(x: mm) {
        param m: t = 1 > 0;
        param c: N*s/mm = 0.1;
        param k: N/mm^1.5 = 1 > 0;
        param load: N = 1;
        param drive: N = 0.8;
        law ground(gap) { gap > 0 => k*gap^1.5, else => 0 }
        m*ddot(x) + c*dot(x) + ground(x) = drive*cos(omega*t) + load;
        output tooth: mN = force(ground);
        output speed: m/s = dot(x);
        /// what an accelerometer shows
        output shaking = ddot(x);
        output carried = ground(x) + c*dot(x);
    }
}

hertzian::oscillator! {
    /// A stop that pushes back as soon as it is touched.
    Preloaded(x) {
        law stop(gap) { gap > 0 => 2 + 20*gap + dot(gap)/5, else => 0 }
        ddot(x) + 0.1*dot(x) + x + 2*stop(x - 1) = 0.5*cos(omega*t);
        output force = force(stop);
        output shaking = ddot(x);
    }
}

hertzian::oscillator! {
    /// Half a period of its motion is the other half with opposite signs.
    Symmetric(x) {
        law stop(gap) { gap > 1 => 5*(gap - 1), gap < -1 => 5*(gap + 1), else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x) = 0.9*cos(omega*t);
        output speed = dot(x);
        output push = force(stop) + 0.5*cos(omega*t);
        output turned = x*cos(omega*t) + 0.25;
    }
}

fn at(system: &dyn hertzian::System, omega: f64) -> (Branch, Point) {
    within(system, omega, 1e-8)
}

fn within(system: &dyn hertzian::System, omega: f64, tolerance: f64) -> (Branch, Point) {
    let request = FrequencyResponse::of(system).by(HarmonicBalance::new());
    let request = request.from(omega).to(1.001 * omega);
    let branch = request.tolerance(tolerance).run().expect("a branch");
    let point = branch.points[0].clone();
    (branch, point)
}

fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance * (1.0 + expected.abs()),
        "{found} {expected} {error:e}"
    );
}

/// An orbit that is on no branch is read by its request.
#[test]
fn an_orbit_alone_is_read_as_one_of_a_branch() {
    let (omega, model) = (0.8, Isolated::default());
    let request = FrequencyResponse::of(&model);
    let (re, im) = (1.0 - omega * omega, 2.0 * model.zeta * omega);
    let speed = 2.0 * omega * model.drive / re.hypot(im);
    let point = request.orbit(omega).expect("an orbit");
    let reading = request.reading("speed", &point).expect("an output");
    close(reading.motion.peak_to_peak(), 2.0 * speed, 1e-9);
    let wanted: Wanted = "speed:h1".parse().expect("a measure");
    let measured = request.measured(&wanted, &point).expect("an output");
    close(measured.expect("a harmonic"), speed, 1e-9);
    let by_shooting = request.clone().by(Shooting::new());
    let states = by_shooting.orbit(omega).expect("an orbit");
    let measured = by_shooting.measured(&wanted, &states).expect("an output");
    close(measured.expect("a harmonic"), speed, 1e-8);
    let error = request.reading("stop", &point).unwrap_err();
    assert!(matches!(
        error.downcast_ref(),
        Some(RequestError::UnknownSignal { .. })
    ));
}

#[test]
fn linear_outputs_are_the_closed_form() {
    let (omega, model) = (0.8, Isolated::default());
    let (branch, point) = at(&model, omega);
    let (re, im) = (1.0 - omega * omega, 2.0 * model.zeta * omega);
    let (size, lag) = (model.drive / re.hypot(im), im.atan2(re));
    let speed = branch.reading("speed", &point).expect("an output");
    close(speed.motion.peak_to_peak(), 4.0 * omega * size, 1e-12);
    close(
        speed.motion.rms.unwrap(),
        2.0 * omega * size / 2.0_f64.sqrt(),
        1e-12,
    );
    close(speed.motion.crest_factor().unwrap(), 2.0_f64.sqrt(), 1e-12);
    let line = speed.spectrum()[1];
    close(line.omega, omega, 1e-15);
    close(line.amplitude, 2.0 * omega * size, 1e-12);
    // The rate leads by a quarter.
    close((line.phase - lag + TAU / 4.0).sin(), 0.0, 1e-12);
    let shaking = branch.reading("shaking", &point).expect("an output");
    close(shaking.motion.maximum, omega * omega * size, 1e-12);
    let path = branch.reading("path", &point).expect("an output");
    let absolute = (size * lag.cos() + model.floor).hypot(size * lag.sin());
    close(path.motion.maximum, absolute, 1e-12);
    // x cos = size/2 ( cos lag + cos(2 omega t - lag) )
    let turned = branch.reading("turned", &point).expect("an output");
    close(turned.motion.mean.unwrap(), 0.5 * size * lag.cos(), 1e-12);
    close(turned.spectrum()[2].amplitude, 0.5 * size, 1e-12);
    for (name, reading) in [("speed", &speed), ("path", &path)] {
        let index = ["path", "speed"]
            .iter()
            .position(|own| *own == name)
            .unwrap();
        assert_eq!(point.observed.outputs[index], reading.motion);
    }
    let measured = |text: &str| {
        let value = branch.measured(&text.parse().expect(text), &point);
        value.expect("a value").expect("it is known")
    };
    assert_eq!(measured("speed:max"), speed.motion.maximum);
    assert_eq!(
        measured("x:h1"),
        branch.reading("x", &point).unwrap().spectrum()[1].amplitude
    );
    close(measured("x:phase1"), lag, 1e-12);
}

/// Positions, velocities and accelerations over a period, by the classical method of Runge and Kutta: smooth forces only.
fn integrated(
    state: [f64; 2],
    omega: f64,
    count: usize,
    force: impl Fn(f64, f64, f64) -> f64,
) -> Vec<[f64; 3]> {
    let step = TAU / omega / count as f64;
    let (mut x, mut v) = (state[0], state[1]);
    let mut all = Vec::new();
    for index in 0..count {
        let t = index as f64 * step;
        all.push([x, v, force(t, x, v)]);
        let h = 0.5 * step;
        let a1 = force(t, x, v);
        let (x2, v2) = (x + h * v, v + h * a1);
        let a2 = force(t + h, x2, v2);
        let (x3, v3) = (x + h * v2, v + h * a2);
        let a3 = force(t + h, x3, v3);
        let (x4, v4) = (x + step * v3, v + step * a3);
        let a4 = force(t + step, x4, v4);
        x += step / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
        v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    all
}

/// An output by its name, and what it is of position, velocity and acceleration.
type Known<'k> = (&'k str, &'k dyn Fn(&[f64; 3]) -> f64);

/// Extremes, mean, root of the mean square and second harmonic of an output are those of samples over a period.
fn is_read_off(name: &str, values: &[f64], reading: &Reading) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|y| y * y).sum::<f64>() / count;
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let size = largest - smallest;
    let sum = |part: fn(f64) -> f64| {
        let terms = values.iter().enumerate();
        let terms = terms.map(|(j, y)| y * part(2.0 * TAU * j as f64 / count));
        2.0 * terms.sum::<f64>() / count
    };
    let amplitude = sum(f64::cos).hypot(sum(f64::sin));
    let found = reading.motion;
    for (found, expected) in [
        (found.maximum, largest),
        (found.minimum, smallest),
        (found.mean.unwrap(), mean),
        (found.rms.unwrap(), square.sqrt()),
        (reading.spectrum()[2].amplitude, amplitude),
    ] {
        assert!(
            (found - expected).abs() < 1e-6 * size,
            "{name} {found} {expected}"
        );
    }
}

#[test]
fn outputs_with_forces_are_those_of_the_integrated_motion() {
    let (omega, model) = (0.9, Thrown::default());
    let (branch, point) = at(&model, omega);
    assert!(
        point.observed.contacts[0].fraction < 1.0,
        "it is thrown off"
    );
    let state = point.orbit.state();
    let ground = |x: f64| model.k * x.max(0.0).powf(1.5);
    let acceleration = |t: f64, x: f64, v: f64| {
        model.drive * (omega * t).cos() + model.load - model.c * v - ground(x)
    };
    let count = 40_000;
    let motion = integrated([state[0], state[1]], omega, count, acceleration);
    let outputs: [Known<'_>; 4] = [
        ("tooth", &|s| 1e3 * ground(s[0])),
        ("speed", &|s| 1e-3 * s[1]),
        ("shaking", &|s| s[2]),
        ("carried", &|s| ground(s[0]) + model.c * s[1]),
    ];
    for (index, (name, of)) in outputs.into_iter().enumerate() {
        let values: Vec<f64> = motion.iter().map(of).collect();
        let reading = branch.reading(name, &point).expect(name);
        is_read_off(name, &values, &reading);
        assert_eq!(point.observed.outputs[index], reading.motion, "{name}");
    }
    // Nothing but the ground holds the load.
    let impulse = point.observed.contacts[0].impulse.expect("it was read off");
    close(impulse, model.load * TAU / omega, 1e-9);
    assert_eq!(point.observed.contacts[0].impacts(), 1);
    let measured = |text: &str| {
        let value = branch.measured(&text.parse().expect(text), &point);
        value.expect("a value").expect("it is known")
    };
    assert_eq!(measured("ground:impulse"), impulse);
    assert_eq!(measured("ground:impacts"), 1.0);
    close(measured("tooth:mean"), 1e3 * model.load, 1e-9);
    let parts = measured("ground:piece1") + measured("ground:piece2");
    close(parts, 1.0, 1e-12);
    close(
        measured("ground:piece2"),
        point.observed.contacts[0].fraction,
        1e-12,
    );
    close(measured("tooth:max"), 1e3 * measured("ground:max"), 1e-12);
}

/// Outputs at orbits of shooting are those of the integrated motion, without anything else being asked for.
#[test]
fn outputs_of_orbits_by_shooting_are_those_of_the_integrated_motion() {
    let (omega, model) = (0.9, Thrown::default());
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let branch = request.from(omega).to(0.91).tolerance(1e-9).run();
    let branch = branch.expect("a branch");
    let point = &branch.points[0];
    let state = point.orbit.state();
    let ground = |x: f64| model.k * x.max(0.0).powf(1.5);
    let acceleration = |t: f64, x: f64, v: f64| {
        model.drive * (omega * t).cos() + model.load - model.c * v - ground(x)
    };
    let motion = integrated([state[0], state[1]], omega, 40_000, acceleration);
    let outputs: [Known<'_>; 4] = [
        ("tooth", &|s| 1e3 * ground(s[0])),
        ("speed", &|s| 1e-3 * s[1]),
        ("shaking", &|s| s[2]),
        ("carried", &|s| ground(s[0]) + model.c * s[1]),
    ];
    for (index, (name, of)) in outputs.into_iter().enumerate() {
        let values: Vec<f64> = motion.iter().map(of).collect();
        let reading = branch.reading(name, point).expect(name);
        is_read_off(name, &values, &reading);
        let read = point.observed.outputs[index];
        for (found, expected) in [
            (read.maximum, reading.motion.maximum),
            (read.minimum, reading.motion.minimum),
            (read.mean.unwrap(), reading.motion.mean.unwrap()),
            (read.rms.unwrap(), reading.motion.rms.unwrap()),
        ] {
            close(found, expected, 1e-9 * (1.0 + expected.abs()));
        }
    }
    // Nothing but the ground holds the load.
    let measured = |text: &str| {
        let value = branch.measured(&text.parse().expect(text), point);
        value.expect("a value").expect("it is known")
    };
    close(measured("ground:impulse"), model.load * TAU / omega, 1e-7);
    close(measured("tooth:mean"), 1e3 * model.load, 1e-4);
    close(measured("tooth:max"), 1e3 * measured("ground:max"), 1e-5);
    assert_eq!(measured("ground:impacts"), 1.0);
    close(
        measured("ground:piece1") + measured("ground:piece2"),
        1.0,
        1e-12,
    );
    assert_eq!(branch.leading().name, "tooth");
    let table = branch.to_csv();
    let cells = table.lines().flat_map(|line| line.split(','));
    let header = cells.clone().position(|cell| cell == "tooth_rms [mN]");
    let column = header.expect("a column");
    for line in table.lines().skip(1) {
        let cell = line.split(',').nth(column).expect("a cell");
        assert!(cell.parse::<f64>().expect("a number") > 0.0);
    }
}

/// What both methods read off one orbit differs by no more than the sum of what they state.
#[test]
fn both_methods_read_the_same_outputs() {
    let both = |system: &dyn hertzian::System, omega: f64, tolerance: f64| {
        let (balance, by_balance) = within(system, omega, tolerance);
        let request = FrequencyResponse::of(system).by(Shooting::new());
        let request = request.near_orbit(&by_balance.orbit);
        let request = request.from(omega).to(1.001 * omega).tolerance(tolerance);
        let shot = request.run().expect("a branch");
        let by_shooting = &shot.points[0];
        let size = by_balance.observed.motions[0].peak_to_peak();
        let stated = by_balance.error.expect("one") + by_shooting.error.expect("one");
        for (index, output) in balance.model.outputs.iter().enumerate() {
            let [a, b] = [&by_balance, by_shooting].map(|point| point.observed.outputs[index]);
            let error = stated * a.peak_to_peak().max(size) + 1e-12;
            let name = &output.name;
            close(a.mean.unwrap(), b.mean.unwrap(), error);
            close(a.rms.unwrap(), b.rms.unwrap(), error);
            // What is stated is of displacements. The harmonics that the balance leaves out count more in an extreme of a rate or a force.
            let of_extremes = if name == "path" { error } else { 100.0 * error };
            close(a.maximum, b.maximum, of_extremes);
            close(a.minimum, b.minimum, of_extremes);
            let [a, b] = [(&balance, &by_balance), (&shot, by_shooting)]
                .map(|(branch, point)| branch.reading(name, point).expect("a signal"));
            for harmonic in 0..4 {
                let [a, b] = [&a, &b].map(|reading| reading.spectrum()[harmonic].amplitude);
                close(a, b, error);
            }
        }
    };
    both(&Isolated::default(), 0.8, 1e-8);
    both(&Thrown::default(), 0.9, 1e-8);
    both(&Preloaded {}, 1.1, 1e-6);
    both(&Symmetric {}, 0.7, 1e-8);
}

#[test]
fn a_force_that_jumps_is_read_from_both_sides() {
    let (branch, point) = within(&Preloaded {}, 1.1, 1e-3);
    let contact = point.observed.contacts[0];
    assert!(contact.fraction > 0.0 && contact.fraction < 1.0);
    let force = branch.reading("force", &point).expect("an output").motion;
    close(force.maximum, contact.maximum_force, 1e-12);
    close(force.minimum, contact.minimum_force, 1e-12);
    close(
        force.mean.unwrap() * TAU / 1.1,
        contact.impulse.unwrap(),
        1e-9,
    );
    // The equation of motion, one moment after the other: between the switches the acceleration is that of the series.
    let shaking = branch.reading("shaking", &point).expect("an output").motion;
    assert!(shaking.minimum < -2.0 * force.maximum + 1.0);
    close(shaking.mean.unwrap(), 0.0, 1e-9);
}

#[test]
fn text_has_the_same_outputs() {
    let text = hertzian::generic::Declaration::parse(
        "Thrown(x: mm) {
            param m: t = 1 > 0;
            param c: N*s/mm = 0.1;
            param k: N/mm^1.5 = 1 > 0;
            param load: N = 1;
            param drive: N = 0.8;
            law ground(gap) { gap > 0 => k*gap^1.5, else => 0 }
            m*ddot(x) + c*dot(x) + ground(x) = drive*cos(omega*t) + load;
            output tooth: mN = force(ground);
            output speed: m/s = dot(x);
        }",
    )
    .expect("it is sound");
    let (_, declared) = at(&Thrown::default(), 0.9);
    let (branch, read) = at(&text, 0.9);
    let units: Vec<&str> = (branch.model.outputs.iter())
        .map(|output| output.unit.as_str())
        .collect();
    assert_eq!(units, ["mN", "m/s"]);
    assert_eq!(branch.model.units, ["mm"]);
    assert_eq!(branch.model.parameters[2].unit, "N/mm^1.5");
    assert_eq!(branch.model.contacts, ["ground"]);
    assert_eq!(branch.model.force_units, ["N"]);
    for (a, b) in read.observed.outputs.iter().zip(&declared.observed.outputs) {
        close(a.peak_to_peak(), b.peak_to_peak(), 1e-9);
    }
}

hertzian::oscillator! {
    /// A wheel on a shaft, with a belt that runs on it.
    Wheel(theta: rad, belt: m) {
        param j: kg*m^2 = 1 > 0;
        param c: N*m*s = 0.1;
        param k: N*m = 1;
        param m: kg = 1 > 0;
        param s: N/m = 2;
        param length: m = 1 > 0;
        param drive: N*m = 0.3;
        j*ddot(theta) + c*dot(theta) + k*theta = drive*cos(omega*t);
        m*ddot(belt) + 0.1*m*omega*dot(belt) + s*belt = 0;
        output angle = 2*theta;
        output spin = dot(theta);
        output jolt = ddot(theta);
        output turns: Hz = dot(theta);
        output slip = dot(belt);
        output rate = omega*belt/length;
    }
}

#[test]
fn rates_of_angles_are_not_in_whole_turns() {
    let model = hertzian::Model::of(&Wheel::default());
    let units: Vec<&str> = model.outputs.iter().map(|own| own.unit.as_str()).collect();
    assert_eq!(units, ["rad", "rad/s", "rad/s^2", "Hz", "m/s", "1/s"]);
}

hertzian::oscillator! {
    /// A block and a wheel, each with stops.
    Braked(x: mm, theta: rad) {
        param m: t = 1e-3 > 0;
        param j: t*mm^2 = 1 > 0;
        param k: N/mm = 50 > 0;
        param kt: N*mm = 2000 > 0;
        param arm: mm = 10 > 0;
        param drive: N = 1;
        law stop(gap) { gap > 0 => k*gap, else => 0 }
        law twist(angle) { angle > 0 => kt*angle, else => 0 }
        law soft(gap, s) { gap > 0 => s*gap, else => 0 }
        law part(gap) { gap > 0 => gap, else => 0 }
        m*ddot(x) + 0.1*m*omega*dot(x) + k*x + stop(x) + k*part(x) + soft(x, k) = drive*cos(omega*t);
        j*ddot(theta) + 0.1*j*omega*dot(theta) + kt*theta + arm*stop(arm*theta) + twist(theta) + kt*part(theta) + soft(theta, kt) = arm*drive*cos(omega*t);
        output moment = force(twist);
    }
}

#[test]
fn forces_of_contacts_have_units() {
    let (branch, _) = at(&Braked::default(), 100.0);
    let model = &branch.model;
    let of = |name: &str| model.unit_of(name);
    assert_eq!(model.contacts.len(), model.force_units.len());
    assert_eq!(
        [of("stop_1"), of("stop_2"), of("twist")],
        ["N", "N", "N*mm"]
    );
    // Once as force and once as moment; and a length that is an angle too.
    assert_eq!([of("soft_1"), of("part_1"), of("part_2")], [""; 3]);
    assert_eq!(of("moment"), "N*mm");
    let head = branch.to_csv();
    let head = head.lines().next().expect("names");
    for name in [
        "peak_force [N]",
        "stop_1_min_force [N]",
        "stop_1_max_force [N]",
        "stop_1_piece_2",
        "twist_max_force [N*mm]",
        "twist_impulse [N*mm*s]",
        "twist_impacts",
        "part_1_max_force",
        "soft_2_impulse",
        "moment_rms [N*mm]",
    ] {
        assert!(
            head.split(',').any(|column| column == name),
            "{name}: {head}"
        );
    }
}
