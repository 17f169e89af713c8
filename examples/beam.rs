//! A cantilever of a few finite elements with a stop at its tip: `cargo run --release --example beam` draws `beam.svg`.
//!
//! Mass and stiffness are matrices, here of Euler-Bernoulli elements with a deflection and a slope at each node; the contact is a law by
//! itself, attached to a direction of the structure. To make it your own, take matrices of your finite-element program. Lengths are in
//! units of the beam, time in units in which its first resonance is at 3.516 (Blevins: the square of 1.8751).

use hertzian::structure::{Contact, DMatrix, Structure, assemble, parameter};
use hertzian::{FrequencyResponse, Shooting};

hertzian::law! {
    /// Elastic stop
    pub Stop(gap, k) { gap > 0 => k*gap, else => 0 }
}

/// Of an element of length one and mass 420: deflection and slope at one end, and at the other.
const INERTIA: [i16; 16] = [
    156, 22, 54, -13, 22, 4, 13, -3, 54, 13, 156, -22, -13, -3, -22, 4,
];
/// Of an element of length and bending stiffness one.
const BENDING: [i16; 16] = [12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4];

/// Assembles the beam from the tip to the clamp, attaches the stop, traces the first resonance, says what there is at 3.9, and draws it.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Slopes are per element, of which there are three.
    let assembled = |element: [i16; 16], factor: f64| {
        let element = factor * DMatrix::from_row_slice(4, 4, &element.map(f64::from));
        assemble(6, (0..3).map(|number| (2 * number, &element)))
    };
    let (mass, stiffness) = (assembled(INERTIA, 1.0 / 1260.0), assembled(BENDING, 27.0));
    // Damping that grows with the frequency: 1 % at the first resonance.
    let damping = 2.0 * 0.01 / 3.516 * &stiffness;
    let tip = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let stop = Contact::new(Stop).arguments([parameter("k", 20.0)]);
    let stop = stop.direction(tip).offset(parameter("distance", 1e-3));
    let beam = Structure::of(&mass, &damping, &stiffness).output("tip", tip);
    let beam = beam.contact(stop).cosine(0, 1, parameter("drive", 2e-4));
    let request = FrequencyResponse::of(&beam.name("Cantilever with a stop").build()?);
    // The stop is a straight line, so that motions are known in closed form between its switches.
    let branch = request.from(3.0).to(5.0).by(Shooting::new()).run()?;
    for point in branch.at(3.9)? {
        let size = branch.describe_size(&point);
        println!("at 3.9 {size}, {}", point.stability.verdict);
    }
    branch.plot("beam.svg")?;
    Ok(())
}
