//! What is true of an orbit: its multipliers when it is refined by shooting, and what a perturbed motion does.

use std::f64::consts::TAU;

use hertzian::time;
use hertzian::time::FlowError;
use hertzian::{Complex, Event, FrequencyResponse, Point, Shooting, System};
use hertzian_tests::random::Random;

/// Tolerance of the flow, relative to the size of the motion.
const TOLERANCE: f64 = 1e-11;
/// Sizes of orbits beside a fold that differ by less than this part are on one side of it.
const NEAR: f64 = 0.02;
/// A perturbation shall grow or fall by this factor.
const FACTOR: f64 = 1e2;
/// Size of the perturbation of an unstable orbit, relative to the orbit; of a stable one, times the factor.
const SMALL: f64 = 1e-7;

/// The orbit refined by shooting at the same frequency, if it is found there.
pub fn refined(system: &dyn System, point: &Point) -> Option<Point> {
    let shooting = FrequencyResponse::of(system)
        .by(Shooting::new().tolerance(TOLERANCE))
        .near_orbit(&point.orbit);
    let cycle = shooting.orbit(point.value).ok()?;
    let size = point.peak_to_peak();
    let apart = (cycle.peak_to_peak() - size).abs() / size;
    let known = point.error.unwrap_or(f64::INFINITY).max(1e-7);
    (apart < 1e2 * known).then_some(cycle)
}

/// The orbit beside a fold of the branch, where the true fold may lie on the other side of its frequency: at a frequency that is
/// farther from the fold by twice the error stated for it.
pub fn refined_beside(system: &dyn System, point: &Point, fold: &Event) -> Option<Point> {
    let away = (point.value - fold.point.value).signum();
    refined_at(system, point, point.value + away * 2.0 * fold.error)
}

/// The orbit refined by shooting at another frequency close by.
pub fn refined_at(system: &dyn System, point: &Point, omega: f64) -> Option<Point> {
    let shooting = FrequencyResponse::of(system)
        .by(Shooting::new().tolerance(TOLERANCE))
        .near_orbit(&point.orbit);
    let cycle = shooting.orbit(omega).ok()?;
    let apart = cycle.peak_to_peak() / point.peak_to_peak() - 1.0;
    (apart.abs() < NEAR).then_some(cycle)
}

/// Largest distance between two pairs of multipliers, each with its nearest.
pub fn distance(a: &[Complex<f64>], b: &[Complex<f64>]) -> f64 {
    let apart = |i: usize, j: usize| (a[0] - b[i]).norm().max((a[1] - b[j]).norm());
    apart(0, 1).min(apart(1, 0))
}

/// How much a perturbed motion has come nearer to the orbit or gone away from it, after as many periods as its largest multiplier
/// needs for a factor of [`FACTOR`].
///
/// # Errors
/// If the motion cannot be followed that far.
pub fn growth(system: &dyn System, cycle: &Point, random: &mut Random) -> Result<f64, FlowError> {
    let largest = cycle.stability.multipliers[0].norm();
    let periods = (FACTOR.ln() / largest.ln().abs()).ceil() as usize;
    let mut flow = time::of(system, cycle.omega(), TOLERANCE).unwrap();
    let small = if largest < 1.0 { FACTOR * SMALL } else { SMALL };
    let [x, v] = [cycle.orbit.state()[0], cycle.orbit.state()[1]];
    let [length, speed] = [cycle.peak_to_peak(), cycle.omega() * cycle.peak_to_peak()];
    let turn = random.between(0.0, TAU);
    // Two directions at a right angle: one of them has a part along the largest multiplier.
    let mut grown = 0.0_f64;
    for angle in [turn, turn + 0.25 * TAU] {
        let (sine, cosine) = angle.sin_cos();
        let mut state = [x + small * length * cosine, v + small * speed * sine];
        for _ in 0..periods * cycle.orbit.period {
            flow.advance(0.0, TAU, &mut state, None, None)?;
        }
        let apart = ((state[0] - x) / length).hypot((state[1] - v) / speed);
        grown = grown.max(apart / small);
    }
    Ok(grown)
}
