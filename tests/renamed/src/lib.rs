//! Declares models by a dependency that is called `hz` here.

pub use hz;
pub use hz::{law, oscillator};

use hz::FrequencyResponse;
use hz::law::{Law, On};

oscillator! {
    /// A linear oscillator.
    pub Linear(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// amplitude of the force
        param drive;
        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    }
}

hz::law! {
    /// A force that grows as the square of the gap.
    pub Square(gap, k) { gap > 0 => k*gap^2, else => 0 }
}

/// Half of the way from the least to the greatest displacement; not a number if no orbit is found.
pub fn amplitude(zeta: f64, drive: f64, omega: f64) -> f64 {
    let model = Linear { zeta, drive };
    let orbit = FrequencyResponse::of(&model).orbit(omega);
    orbit.map_or(f64::NAN, |orbit| 0.5 * orbit.motion().peak_to_peak())
}

/// The force of [`Square`] at a gap.
pub fn force(k: f64, gap: f64) -> f64 {
    let mut force = [0.0];
    Square.force(On::AllPieces, &[k], &[gap], &[0.0], &mut force);
    force[0]
}
