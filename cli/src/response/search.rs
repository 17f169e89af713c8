//! `--search`: initial states whose motions settle to orbits that no branch leads to.

use std::f64::consts::TAU;

use hertzian::System;
use hertzian::attractors::basin::{Axis, Basin, Grid};
use hertzian::system::{Place, Wave};

use super::options::Options;
use super::run::Failure;

/// Longest period of an orbit that is looked for, and cells along each side of a grid of initial states.
const LONGEST: usize = 5;
const CELLS: usize = 64;

/// Whether attractors can be looked for: a grid is for one coordinate, and as large as the force on it tells.
///
/// # Errors
/// If there are several coordinates, a value is outside the range, or there is no force where attractors are looked for.
pub fn check(options: &Options, model: &dyn System) -> Result<(), Failure> {
    let coordinates = model.facts().coordinates.len();
    if !options.search.is_empty() && coordinates > 1 {
        let message = format!("--search is for one coordinate, and there are {coordinates}");
        return Err(Failure::Option(message));
    }
    let (from, to) = (options.range.from, options.range.to);
    // Whether the range can be used, the library says.
    let range = from.min(to)..=from.max(to);
    let usable = from.is_finite() && to.is_finite();
    for &value in &options.search {
        if usable && !range.contains(&value) {
            let name = options.varied();
            let message =
                format!("--search {value}: must be between {from} and {to}, the range of {name}");
            return Err(Failure::Option(message));
        }
        if acceleration(options, model, value) == 0.0 {
            let message = format!(
                "--search {value}: the right-hand side of the equation is zero there, and does not say how far motions go"
            );
            return Err(Failure::Option(message));
        }
    }
    Ok(())
}

/// What motions from those states settle to.
pub fn basin(options: &Options, model: &dyn System, value: f64) -> Basin {
    let grid = grid(options, model, value);
    Basin::of(model).grid(grid).longest(LONGEST).patience(3000)
}

/// Initial states to which orbits of up to five periods in free flight under the load come near: with the acceleration `a` one
/// flight of `T` rises `a T^2 / 8` and falls back with the speed `a T / 2`.
pub fn grid(options: &Options, model: &dyn System, value: f64) -> Grid {
    let (_, omega) = values_at(options, model, value);
    let periods = LONGEST * model.facts().divisor as usize;
    let time = periods as f64 * TAU / omega;
    let acceleration = acceleration(options, model, value);
    let (height, speed) = (0.15 * acceleration * time * time, 0.5 * acceleration * time);
    let axis = |entry: usize, from: f64, to: f64| Axis::of(entry).from(from).to(to).cells(CELLS);
    Grid::new(
        vec![0.0, 0.0],
        axis(0, -height, 0.2 * height),
        axis(1, -speed, speed),
    )
}

/// Parameters and frequency where what varies has a value.
fn values_at(options: &Options, model: &dyn System, value: f64) -> (Vec<f64>, f64) {
    let facts = model.facts();
    let mut parameters = vec![0.0; facts.parameters.len()];
    model.values(&mut parameters);
    let mut names = facts.parameters.iter().map(|parameter| &parameter.name);
    match names.position(|name| name == options.varied()) {
        Some(index) => {
            parameters[index] = value;
            (parameters, options.model.frequency())
        }
        None => (parameters, value),
    }
}

/// The constant force on the first coordinate or the amplitude of the one that varies, whichever is larger, over the mass.
fn acceleration(options: &Options, model: &dyn System, value: f64) -> f64 {
    let (parameters, omega) = values_at(options, model, value);
    let places = &model.facts().places;
    let mut coefficients = vec![0.0; places.len()];
    model.coefficients(&parameters, omega, &mut coefficients);
    let (mut mass, mut constant, mut amplitude) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (place, coefficient) in places.iter().zip(coefficients) {
        match place {
            Place::Mass { row: 0, column: 0 } => mass += coefficient,
            Place::Load { row: 0, wave } if *wave == Wave::CONSTANT => constant += coefficient,
            Place::Load { row: 0, .. } => amplitude = amplitude.hypot(coefficient),
            _ => {}
        }
    }
    constant.abs().max(amplitude) / mass.abs()
}
