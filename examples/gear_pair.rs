//! A gear pair with backlash: `cargo run --release --example gear_pair` draws `gear_pair.svg`.
//!
//! The transmission error of a spur gear pair, Kahraman and Singh (1990), in units of half the backlash, time in units of the linear
//! resonance. Where the motion exceeds the mean deformation of the teeth they part, and the resonance leans to lower frequencies.
//! To make it your own, change the torque, the error of the profile, or the stiffness of one flank.

use hertzian::chart::View;
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Gear pair with backlash
    pub GearPair(x) {
        /// damping ratio
        param zeta = 0.05 in 0.0..;
        /// mean torque, as the deformation of the teeth that it makes
        param torque = 0.1 > 0;
        /// amplitude of the error of the profile
        param profile = 0.05 in 0.0..;

        law mesh(gap) {
            gap > 1        => gap - 1,
            -1 <= gap <= 1 => 0,
            gap < -1       => gap + 1,
        }
        ddot(x) + 2*zeta*dot(x) + mesh(x) = torque + profile*omega^2*cos(omega*t);
    }
}

/// Traces a curve for each error of the profile, and marks where the teeth part.
pub fn main() -> Result<(), Error> {
    let mut branches = Vec::new();
    for profile in [0.005, 0.02, 0.05, 0.1] {
        let model = GearPair {
            profile,
            ..GearPair::default()
        };
        let request = FrequencyResponse::of(&model).from(0.4).to(1.6);
        let branch = request.bifurcations(true).run()?;
        println!("error of the profile {profile}:");
        for event in &branch.events {
            println!("  {event}");
        }
        branches.push(branch);
    }
    // Where grazing is marked the gap touches the level one, and the teeth are pressed together no more.
    let chart = View::new().together(&branches)?;
    let chart = chart.title("Gear pair with backlash, damping ratio 5 %, mean deformation 0.1");
    let chart = chart.x("mesh frequency / linear resonance");
    let chart = chart.y("peak-to-peak of the transmission error / half the backlash");
    chart.write("gear_pair.svg")?;
    println!("written gear_pair.svg");
    Ok(())
}
