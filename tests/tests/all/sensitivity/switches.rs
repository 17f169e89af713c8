//! What jumps where gaps switch: two contacts at once, and means that are known.

use std::f64::consts::TAU;

use hertzian::{FrequencyResponse, System};

use super::points::compare;

hertzian::oscillator! {
    /// Spring and damper are two laws on one gap, which switch at once.
    TwoLaws(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law spring(gap) { gap > 0 => gap^1.5, else => 0 }
        law damper(gap) { gap > 0 => 0.1 + 2*zeta*dot(gap), else => 0 }
        output a = ddot(x) + x;
        ddot(x) + spring(x) + damper(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Two masses with dampers of their own. They move alike as long as they are alike.
    Pair(x, y) {
        param zeta in 0.0..;
        param other in 0.0..;
        param drive;
        law left(gap) { gap > 0 => gap + 2*zeta*dot(gap), else => 0 }
        law right(gap) { gap > 0 => gap + 2*other*dot(gap), else => 0 }
        output both = ddot(x) + ddot(y);
        ddot(x) + left(x) = drive*cos(omega*t) + 1;
        ddot(y) + right(y) = drive*cos(omega*t) + 1;
    }
}

#[test]
fn of_two_laws_on_one_gap() {
    let make = |v: &[f64]| -> Box<dyn System> {
        let [zeta, load, drive] = [v[0], v[1], v[2]];
        Box::new(TwoLaws { zeta, load, drive })
    };
    compare("two laws", &[0.05, 1.0, 1.3], 0.5, [0.45, 0.55], &make);
}

/// The mean of all forces is the load, and their derivatives sum up to its own: by the load one, by all else nothing. That of a law that is both is
/// known as well.
#[test]
fn forces_of_two_laws_sum_up_to_the_load() {
    let model = TwoLaws {
        zeta: 0.05,
        load: 1.0,
        drive: 1.3,
    };
    let branch = FrequencyResponse::of(&model).stability(false);
    let branch = branch.from(0.45).to(0.55).run().unwrap();
    let orbit = &branch.at(0.5).unwrap()[0];
    let at = branch.sensitivities(orbit).unwrap();
    for (by, expected) in [("omega", 0.0), ("zeta", 0.0), ("load", 1.0), ("drive", 0.0)] {
        let [a, b] = ["spring:mean", "damper:mean"].map(|name| at.of(name, by).unwrap());
        let apart = (a.value + b.value - expected).abs();
        assert!(apart < 1e-11, "{by}: {a:?} {b:?}");
    }
    // By differences of orbits at a flow of 1e-13.
    let asked = ["damper:rms", "damper:h1"].map(|name| name.parse().unwrap());
    let found = branch.sensitivities_of(orbit, &asked).unwrap();
    let request = super::shot(&model, &orbit.orbit);
    for wanted in &asked {
        let name = wanted.to_string();
        let of = |change: f64| {
            let orbit = request.orbit(0.5 + change).unwrap();
            let branch = request.clone().from(0.5).to(0.501).max_points(2);
            let branch = branch.run().unwrap();
            branch.measured(wanted, &orbit).unwrap().unwrap()
        };
        let expected = super::richardson(1e-4, of);
        let derivative = found.of(&name, "omega").unwrap();
        super::assert_near(&name, derivative, expected, 1.0, 1e-6);
    }
}

/// Where one of them changes alone, their switches part. What is linear in the forces has a derivative still, and what is of one of them; the square of
/// the sum has one to each side.
#[test]
fn where_switches_part_a_square_has_no_derivative() {
    let model = Pair {
        zeta: 0.05,
        other: 0.05,
        drive: 1.3,
    };
    let branch = FrequencyResponse::of(&model).stability(false);
    let branch = branch.from(1.45).to(1.55).run().unwrap();
    let at = branch.sensitivities(&branch.at(1.5).unwrap()[0]).unwrap();
    let value = |name: &str, by: &str| at.of(name, by).unwrap().value;
    // Each moves as if it were alone.
    for name in ["rms", "mean", "h1", "max"] {
        assert_eq!(value(&format!("x:{name}"), "other"), 0.0);
        let [a, b] = [("x", "zeta"), ("y", "other")];
        let [a, b] = [a, b].map(|(of, by)| value(&format!("{of}:{name}"), by));
        assert!((a - b).abs() < 1e-9 * a.abs().max(1.0), "{name}: {a} {b}");
    }
    let [a, b] = ["zeta", "other"].map(|by| value("both:h1", by));
    assert!((a - b).abs() < 1e-9 * a.abs() && a != 0.0, "{a} {b}");
    assert!(value("both:rms", "zeta").is_nan() && value("both:rms", "drive").is_finite());
    let mut missing = at.missing.iter().map(|own| own.what.as_str());
    assert!(missing.any(|what| what == "both:rms by other"));
}

/// The mean force is the load to rounding, and so is its derivative; the impulse is that over a period, `2 pi load / omega`.
#[test]
fn the_mean_force_is_the_load_to_rounding() {
    hertzian::oscillator! {
        Loaded(x) {
            param zeta in 0.0..;
            param load;
            param drive;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + load;
        }
    }
    let model = Loaded {
        zeta: 0.05,
        load: 1.0,
        drive: 1.3,
    };
    let request = FrequencyResponse::of(&model).stability(false);
    let branch = request.from(1.45).to(1.55).run().unwrap();
    let omega: f64 = 1.5;
    let orbit = &branch.at(omega).unwrap()[0];
    let wanted = ["contact:mean", "contact:impulse", "contact:impacts"];
    let wanted = wanted.map(|name| name.parse().unwrap());
    let at = branch.sensitivities_of(orbit, &wanted).unwrap();
    let period = TAU / omega;
    let expected = [
        ("contact:mean", "omega", 0.0),
        ("contact:mean", "load", 1.0),
        ("contact:mean", "drive", 0.0),
        ("contact:mean", "zeta", 0.0),
        ("contact:impulse", "omega", -period / omega),
        ("contact:impulse", "load", period),
        ("contact:impulse", "drive", 0.0),
    ];
    for (name, by, expected) in expected {
        let found = at.of(name, by).unwrap();
        let apart = (found.value - expected).abs();
        println!("{name} by {by}: {found:?} {expected} {apart:e}");
        assert!(apart < 1e-12, "{name} by {by}: {found:?} {expected}");
        assert!(apart <= found.error, "{name} by {by}: {found:?} {expected}");
    }
    let missing: Vec<&str> = at.missing.iter().map(|own| own.what.as_str()).collect();
    assert_eq!(missing, ["contact:impacts"]);
    let everything = branch.sensitivities(orbit).unwrap();
    assert!(everything.of("contact:impulse", "load").is_some());
}
