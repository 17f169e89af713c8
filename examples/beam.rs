//! A cantilever of a few finite elements with a stop at its tip: `cargo run --release --example beam` draws `beam.svg`.
//!
//! Mass and stiffness are matrices, here of Euler-Bernoulli elements with a deflection and a slope at each node; the contact is a law by
//! itself, attached to a direction of the structure. To make it your own, take matrices of your finite-element program. Lengths are in
//! units of the beam, time in units in which its first resonance is at 3.516 (Blevins: the square of 1.8751).

use hertzian::FrequencyResponse;
use hertzian::structure::{Contact, DMatrix, Structure, assemble, parameter};

hertzian::law! {
    /// Elastic stop
    pub Stop(gap, k) { gap > 0 => k*gap, else => 0 }
}

/// Elements along the beam.
const ELEMENTS: usize = 3;
/// Deflection and slope of every node but the clamped one, from the tip on.
const FREE: usize = 2 * ELEMENTS;

/// Assembles the beam, attaches the stop, traces the first resonance, and draws it.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mass, stiffness) = beam();
    // Damping that grows with the frequency: 1 % at the first resonance.
    let damping = 2.0 * 0.01 / 3.516 * &stiffness;
    let mut direction = vec![0.0; FREE];
    direction[0] = 1.0;
    let structure = Structure::of(&mass, &damping, &stiffness)
        .name("Cantilever with a stop")
        .cosine(0, 1, parameter("drive", 2e-4))
        .output("tip", direction.clone())
        .contact(
            Contact::new(Stop)
                .arguments([parameter("k", 20.0)])
                .direction(direction)
                .offset(parameter("distance", 1e-3)),
        )
        .build()?;
    let request = FrequencyResponse::of(&structure).from(3.0).to(5.0);
    let branch = request.tolerance(1e-3).run()?;
    println!("{} points, {}", branch.points.len(), branch.stopped);
    for fold in branch.folds() {
        println!("{}", branch.describe(fold));
    }
    let chart = branch.chart().y("peak-to-peak of the tip / length");
    let chart = chart.x("excitation frequency ω, in units of √(EI/ρA)/L²");
    chart.write("beam.svg")?;
    println!("written beam.svg");
    Ok(())
}

/// Mass and stiffness, clamped at the last node.
fn beam() -> (DMatrix<f64>, DMatrix<f64>) {
    let h = 1.0 / ELEMENTS as f64;
    // Of an element of length one, and what slopes are multiplied by in another one.
    let inertia = [
        156.0, 22.0, 54.0, -13.0, 22.0, 4.0, 13.0, -3.0, 54.0, 13.0, 156.0, -22.0, -13.0, -3.0,
        -22.0, 4.0,
    ];
    let bending = [
        12.0, 6.0, -12.0, 6.0, 6.0, 4.0, -6.0, 2.0, -12.0, -6.0, 12.0, -6.0, 6.0, 2.0, -6.0, 4.0,
    ];
    let slopes = |row: usize, column: usize| h.powi((row % 2 + column % 2) as i32);
    let whole = |entries: [f64; 16], factor: f64| {
        let entry = |row, column| factor * slopes(row, column) * entries[4 * row + column];
        let element = DMatrix::from_fn(4, 4, entry);
        assemble(FREE, (0..ELEMENTS).map(|number| (2 * number, &element)))
    };
    (whole(inertia, h / 420.0), whole(bending, h.powi(-3)))
}
