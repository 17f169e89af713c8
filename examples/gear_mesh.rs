//! Gears whose mesh is now stiffer and now softer: `cargo run --release --example gear_mesh` draws `gear_mesh.svg`.
//!
//! Two gears that turn freely, pressed together by a torque, after Kahraman and Singh (1991); lengths are along the line of action. The
//! displacement of one against the other is an output, whose root mean square is what is measured. To make it your own, change the
//! masses, the play, or the variation of the mesh.

use hertzian::{Error, FrequencyResponse, chart::View};

hertzian::oscillator! {
    /// Gears that turn freely
    pub GearMesh(pinion: m, wheel: m) {
        /// mass of the pinion, its inertia over the square of its radius
        param pinion_mass: kg = 1 > 0;
        param wheel_mass: kg = 2 > 0;
        /// mean stiffness of the mesh
        param mesh: N/m = 2e8 > 0;
        /// how much the stiffness varies, as part of the mean
        param variation: 1 = 0.2 in 0.0..1.0;
        param damping: N*s/m = 1000 in 0.0..;
        /// half of the backlash
        param play: m = 5e-5 > 0;
        /// torque over radius
        param load: N = 2000;

        law teeth(gap) { gap > play => gap - play, -play <= gap <= play => 0, gap < -play => gap + play }
        let force = mesh*(1 + variation*cos(omega*t))*teeth(pinion - wheel) + damping*(dot(pinion) - dot(wheel));
        pinion_mass*ddot(pinion) + force = load;
        wheel_mass*ddot(wheel) - force = -load;

        /// deformation of the mesh
        output relative: um = pinion - wheel;
    }
}

/// Traces the resonance, and says where it folds and where the period doubles.
pub fn main() -> Result<(), Error> {
    let request = FrequencyResponse::of(&GearMesh::default());
    let branch = request.from(8e3).to(4e4).bifurcations(true).run()?;
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let rms = branch.chart_of(&View::new().of("relative:rms".parse()?))?;
    rms.write("gear_mesh.svg")?;
    Ok(())
}
