//! Declarations that must compile, and what their types say of themselves.

mod laws;
mod memory;
mod places;

use hertzian::law::On;
use hertzian::system::{Place, System};

/// A coefficient of the equations: what stands at one place, added.
pub fn coefficient(system: &dyn System, place: Place, omega: f64) -> f64 {
    let facts = system.facts();
    let mut parameters = vec![0.0; facts.parameters.len()];
    system.values(&mut parameters);
    let mut values = vec![0.0; facts.places.len()];
    system.coefficients(&parameters, omega, &mut values);
    facts
        .places
        .iter()
        .zip(&values)
        .filter(|(other, _)| **other == place)
        .map(|(_, value)| value)
        .sum()
}

/// A force of one law.
pub fn force(system: &dyn System, law: usize, arguments: &[f64], gap: f64, rate: f64) -> f64 {
    let mut force = [0.0];
    system
        .law(law)
        .force(On::AllPieces, arguments, &[gap], &[rate], &mut force);
    force[0]
}
