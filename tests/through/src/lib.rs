//! Declares models by macros that another package re-exports; `hertzian` is no dependency of this one.

use hertzian_renamed::hz::{FrequencyResponse, law::Law, law::On};

hertzian_renamed::oscillator! {
    /// A linear oscillator.
    pub Linear(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// amplitude of the force
        param drive;
        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    }
}

hertzian_renamed::law! {
    /// Hertz's contact.
    pub Hertz(gap) { gap > 0 => gap^1.5, else => 0 }
}

/// Half of the way from the least to the greatest displacement; not a number if no orbit is found.
pub fn amplitude(zeta: f64, drive: f64, omega: f64) -> f64 {
    let model = Linear { zeta, drive };
    let orbit = FrequencyResponse::of(&model).orbit(omega);
    orbit.map_or(f64::NAN, |orbit| 0.5 * orbit.motion().peak_to_peak())
}

/// The force of [`Hertz`] at a gap.
pub fn force(gap: f64) -> f64 {
    let mut force = [0.0];
    Hertz.force(On::AllPieces, &[], &[gap], &[0.0], &mut force);
    force[0]
}
