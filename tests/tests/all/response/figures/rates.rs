//! What the contact equation states of the errors of outputs and of multipliers, against orbits by shooting, of models drawn at random whose
//! forces bend, or turn sharply, in the rate of their gaps: stops that do not pull, friction, damping one way only, a ball on a table.

use hertzian::generic::Declaration;
use hertzian::observe::Motion;
use hertzian::{ContactEquation, FrequencyResponse, Point, Shooting};
use hertzian_tests::random::Random;

/// Models, unless the variable `HERTZIAN_RATES` says how many.
const MODELS: u64 = 60;
/// Values of the frequency of each of them.
const VALUES: usize = 4;
/// Points of a branch at most.
const POINTS: usize = 100;
/// What a tolerance of 1e-12 leaves of an orbit by shooting, relative to it, and of its multipliers.
const SHOT: f64 = 1e-10;
const SHOT_MULTIPLIERS: f64 = 1e-8;
/// Another orbit of the same model is farther than this, relative to the size.
const OTHER: f64 = 1e-2;

/// A stop at `x`, as it is written.
fn stop(random: &mut Random) -> String {
    let (k, c) = (random.magnitude(2.0, 100.0), random.between(0.1, 1.5));
    let e = [1.0, 1.5, 1.5, 2.0][random.below(4)];
    match random.below(4) {
        0 | 1 => format!("gap > 0 => max(0, {k}*gap^{e}*(1 + {c}*dot(gap))), else => 0"),
        2 => format!("gap > 0 => {k}*gap^{e}*(1 + {c}*max(0, dot(gap))), else => 0"),
        _ => format!("gap > 0 => {k}*gap^{e}, else => 0"),
    }
}

/// What rubs, as it is written.
fn rub(random: &mut Random) -> String {
    let (mu, w) = (random.magnitude(0.01, 0.3), random.magnitude(3e-3, 0.3));
    match random.below(4) {
        0 | 1 => format!("{mu}*tanh(dot(gap)/{w})"),
        2 => format!("{mu}*dot(gap)/sqrt(dot(gap)^2 + {w}^2)"),
        _ => format!("{mu}*abs(dot(gap))*dot(gap)"),
    }
}

/// A model, as it is written.
fn model(random: &mut Random) -> String {
    let (c, drive) = (random.magnitude(0.02, 0.2), random.between(0.2, 0.8));
    let distance = random.between(0.2, 1.2);
    let stop = stop(random);
    let rub = rub(random);
    let head = format!("law stop(gap) {{ {stop} }}");
    let on = format!("ddot(x) + {c}*dot(x) + x + stop(x - {distance})");
    match random.below(4) {
        0 => format!("One(x) {{ {head} {on} = {drive}*cos(omega*t); }}"),
        1 => {
            format!(
                "Rubs(x) {{ {head} law rub(gap) {{ {rub} }} {on} + rub(x) = {drive}*cos(omega*t); }}"
            )
        }
        2 => format!(
            "Two(x, y) {{ {head} law rub(gap) {{ {rub} }} {on} + 0.4*(x - y) = {drive}*cos(omega*t);
             ddot(y) + {c}*dot(y) + y + 0.4*(y - x) + rub(y) = 0; }}"
        ),
        _ => {
            let (k, b) = (random.magnitude(50.0, 1000.0), random.between(0.05, 0.4));
            let a = random.between(0.1, 0.4);
            format!(
                "Ball(x) {{ law table(gap) {{ gap > 0 => {k}*gap^1.5*(1 + {b}*dot(gap)), else => 0 }}
                 ddot(x) - table({a}*cos(omega*t) - x) = -1; }}"
            )
        }
    }
}

/// How often an error was within so many times what is stated.
#[derive(Debug, Default)]
struct Count {
    all: usize,
    within: usize,
    within_three: usize,
}

impl Count {
    fn add(&mut self, error: f64, stated: f64, shot: f64) -> bool {
        self.all += 1;
        self.within += usize::from(error <= stated + shot);
        self.within_three += usize::from(error <= 3.0 * stated + shot);
        error <= stated + shot
    }

    fn assert_holds(&self) {
        let all = self.all as f64;
        assert!(self.within as f64 >= 0.95 * all, "{self:?}");
        assert!(self.within_three as f64 >= 0.995 * all, "{self:?}");
    }
}

/// The same orbit by shooting, if it is found.
fn shot(model: &Declaration, orbit: &Point) -> Option<Point> {
    let request = FrequencyResponse::of(model)
        .by(Shooting::new().tolerance(1e-12))
        .stability(true);
    request.near_orbit(&orbit.orbit).orbit(orbit.value).ok()
}

/// The largest error of the coordinates, relative to the largest of them.
fn error(orbit: &Point, exact: &Point) -> f64 {
    let motions = &orbit.observed.motions;
    let size = motions.iter().map(Motion::peak_to_peak).fold(0.0, f64::max);
    let pairs = motions.iter().zip(&exact.observed.motions);
    let errors = pairs.map(|(a, b)| (a.peak_to_peak() - b.peak_to_peak()).abs());
    errors.fold(0.0, f64::max) / size
}

/// How far the multiplier is from the next one of the other orbit that is farthest from it.
fn error_of_multipliers(orbit: &Point, exact: &Point) -> f64 {
    let others = &exact.stability.multipliers;
    let own = orbit.stability.multipliers.iter();
    let nearest = own.map(|m| {
        let apart = others.iter().map(|other| (m - other).norm());
        apart.fold(f64::INFINITY, f64::min)
    });
    nearest.fold(0.0, f64::max)
}

#[test]
fn stated_errors_hold_where_forces_bend_in_the_rate() {
    let models = std::env::var("HERTZIAN_RATES").map_or(MODELS, |count| count.parse().unwrap());
    let (mut outputs, mut multipliers, mut lost) = (Count::default(), Count::default(), 0);
    for index in 0..models {
        let mut random = Random::of(5000 + index);
        let text = model(&mut random);
        let model = Declaration::parse(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let from = random.between(0.6, 2.0);
        let request = FrequencyResponse::of(&model).by(ContactEquation::new());
        let request = request.from(from).to(1.2 * from).max_points(POINTS);
        let Ok(branch) = request.stability(true).run() else {
            lost += 1;
            continue;
        };
        for _ in 0..VALUES {
            let value = from * random.between(1.0, 1.2);
            for orbit in branch.at(value).unwrap_or_default() {
                let exact = shot(&model, &orbit);
                let found = exact.filter(|exact| error(&orbit, exact) < OTHER);
                let Some(exact) = found else {
                    lost += 1;
                    continue;
                };
                let (off, stated) = (error(&orbit, &exact), orbit.error.unwrap());
                if !outputs.add(off, stated, SHOT) {
                    println!("{index} at {value}: {off:.1e}, stated {stated:.1e}: {text}");
                }
                let off = error_of_multipliers(&orbit, &exact);
                let stated = orbit.stability.error;
                if !multipliers.add(off, stated, SHOT_MULTIPLIERS) {
                    println!(
                        "{index} at {value}: multipliers {off:.1e}, stated {stated:.1e}: {text}"
                    );
                }
            }
        }
    }
    println!("{outputs:?}, multipliers {multipliers:?}, {lost} lost");
    assert!(outputs.all as u64 >= 2 * models, "{outputs:?} {lost}");
    outputs.assert_holds();
    multipliers.assert_holds();
}
