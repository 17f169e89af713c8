//! What is stated of the error of peak-to-peak, against orbits by shooting, of models drawn at random: attraction beside a contact, jumps,
//! preload, exponents from 0.6 to 4, sharp smooth laws, moving gaps, one and two coordinates.

use hertzian::generic::Declaration;
use hertzian::observe::Motion;
use hertzian::{FrequencyResponse, Point, Shooting};
use hertzian_tests::random::Random;

/// Models, unless the variable `HERTZIAN_PEAKS` says how many.
const MODELS: u64 = 12;
/// What a tolerance of 1e-11 leaves of an orbit by shooting, relative to it, where a force jumps.
const SHOT: f64 = 1e-9;
/// Points of a branch at most: where forces are so sharp that one takes a second, the range is not asked for whole.
const POINTS: usize = 100;
/// Values of the frequency of each model.
const VALUES: usize = 3;
/// Another orbit of the same model is farther than this, relative to the size.
const OTHER: f64 = 0.3;

/// A law, as it is written.
fn law(random: &mut Random) -> String {
    let k = random.magnitude(1.0, 1e3);
    let e = match random.below(4) {
        0 => 1.0,
        1 => 1.5,
        2 => random.between(0.6, 1.0),
        _ => random.between(1.0, 4.0),
    };
    match random.below(8) {
        0 | 1 => {
            // A contact as of Derjaguin, Muller and Toporov, with van der Waals attraction.
            let a = random.magnitude(0.05, 0.5);
            let pull = random.magnitude(1e-3, 0.2);
            let h = pull * a * a;
            format!("gap > 0 => {k}*gap^{e} - {h}/{a}^2, else => -{h}/({a} - gap)^2")
        }
        2 => format!("gap > 0 => {k}*gap^{e}, else => 0"),
        3 => {
            let preload = random.magnitude(0.01, 0.5);
            format!("gap >= 0 => {preload} + {k}*gap^{e}, else => 0")
        }
        4 => {
            let c = random.magnitude(0.01, 2.0);
            format!("gap > 0 => {k}*gap^{e} + {c}*dot(gap), else => 0")
        }
        5 => {
            let width = random.magnitude(0.02, 0.5);
            format!("{}*tanh(gap/{width})", 0.1 * k.sqrt())
        }
        6 => {
            let (other, q) = (random.magnitude(1.0, 1e3), random.between(0.6, 4.0));
            format!(
                "gap > 0.3 => {k}*(gap - 0.3)^{e}, -0.2 <= gap <= 0.3 => 0, gap < -0.2 => -{other}*(-gap - 0.2)^{q}"
            )
        }
        _ => {
            let c = random.magnitude(0.01, 0.5);
            format!(
                "gap > 0 => {k}*gap^{}*(1 + {c}*dot(gap)), else => 0",
                e.max(1.0)
            )
        }
    }
}

/// A model, as it is written.
fn model(random: &mut Random) -> String {
    let law = law(random);
    let (c, drive) = (random.magnitude(5e-3, 0.3), random.magnitude(0.05, 2.0));
    let distance = random.between(-0.5, 1.0);
    let load = match random.below(2) {
        0 => 0.0,
        _ => random.between(-1.0, 2.0),
    };
    let right = format!("{drive}*cos(omega*t) + ({load})");
    let head = format!("law f(gap) {{ {law} }} ddot(x) + {c}*dot(x) + x");
    match random.below(4) {
        0 => {
            let (mass, k) = (random.magnitude(0.3, 3.0), random.magnitude(0.5, 20.0));
            let other = format!("{mass}*ddot(y) + {c}*dot(y) + {k}*y");
            let gap = format!("x - y - ({distance})");
            format!("Pair(x, y) {{ {head} + f({gap}) = {right}; {other} - f({gap}) = 0; }}")
        }
        1 => {
            let moves = random.between(0.05, 0.4);
            let gap = format!("x - ({distance}) - {moves}*cos(omega*t)");
            format!("Moving(x) {{ {head} + f({gap}) = {right}; }}")
        }
        _ => format!("One(x) {{ {head} + f(x - ({distance})) = {right}; }}"),
    }
}

/// The true error of an orbit, of all its coordinates the largest and relative to the largest; `None` where shooting does not find it.
fn error(model: &Declaration, orbit: &Point) -> Option<f64> {
    let request = FrequencyResponse::of(model)
        .by(Shooting::new().tolerance(1e-11))
        .stability(false);
    let exact = request.near_orbit(&orbit.orbit).orbit(orbit.value).ok()?;
    let motions = &orbit.observed.motions;
    let size = motions.iter().map(Motion::peak_to_peak).fold(0.0, f64::max);
    let pairs = motions.iter().zip(&exact.observed.motions);
    // The first coordinate relative to its own, the others to the largest.
    let errors = pairs.enumerate().map(|(coordinate, (motion, exact))| {
        let unit = if coordinate == 0 {
            motion.peak_to_peak()
        } else {
            size
        };
        (motion.peak_to_peak() - exact.peak_to_peak()).abs() / unit
    });
    let error = errors.fold(0.0, f64::max);
    (error < OTHER).then_some(error)
}

#[test]
fn stated_errors_of_peak_to_peak_hold() {
    let models = std::env::var("HERTZIAN_PEAKS").map_or(MODELS, |count| count.parse().unwrap());
    let (mut all, mut within, mut within_three, mut lost) = (0_usize, 0, 0, 0);
    for index in 0..models {
        let mut random = Random::of(index);
        let text = model(&mut random);
        let model = Declaration::parse(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let from = random.magnitude(0.3, 4.0);
        let request = FrequencyResponse::of(&model).from(from).to(1.3 * from);
        let Ok(branch) = request.max_points(POINTS).stability(true).run() else {
            lost += 1;
            continue;
        };
        for _ in 0..VALUES {
            let value = from * random.between(1.0, 1.3);
            for orbit in branch.at(value).unwrap_or_default() {
                let stated = orbit.error.unwrap();
                let Some(error) = error(&model, &orbit) else {
                    lost += 1;
                    continue;
                };
                all += 1;
                within += usize::from(error <= stated + SHOT);
                within_three += usize::from(error <= 3.0 * stated + SHOT);
                if error > stated + SHOT {
                    println!("{index} at {value}: {error:.1e}, stated {stated:.1e}: {text}");
                }
            }
        }
    }
    println!(
        "{within} of {all} within what is stated, {within_three} within three times, {lost} lost"
    );
    assert!(all as u64 >= models, "{all}");
    assert!(within as f64 >= 0.95 * all as f64, "{within} of {all}");
    assert!(
        within_three as f64 >= 0.995 * all as f64,
        "{within_three} of {all}"
    );
}
