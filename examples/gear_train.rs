//! Gears between two shafts: `cargo run --release --example gear_train` draws `gear_train.svg`.
//!
//! Motor, pinion, wheel and load, which turn freely: two torsional shafts, and between them a mesh with backlash and an error of the profile,
//! after Kahraman and Singh (1991). Rotations are lengths along the line of action, in units of half the backlash; inertias over squared
//! radii in units of that of the pinion; time is such that the stiffness of the mesh is one. The torque presses the teeth together; they
//! part where the gap moves by more than it makes of it, at the marks of grazing. To make it your own, change inertias and shafts.

use hertzian::chart::{Page, View};
use hertzian::{Error, FrequencyResponse, Shooting};

hertzian::oscillator! {
    /// Gears between two shafts
    pub GearTrain(motor, pinion, wheel, load) {
        /// stiffness of either shaft
        param shaft = 0.1 > 0;
        /// damping ratio
        param zeta = 0.03 in 0.0..;
        /// torque
        param torque = 0.2 > 0;
        /// amplitude of the error of the profile
        param profile = 0.05 in 0.0..;

        law teeth(gap) { gap > 1 => gap - 1, -1 <= gap <= 1 => 0, gap < -1 => gap + 1 }
        let mesh = teeth(pinion - wheel - profile*cos(omega*t)) + 2*zeta*(dot(pinion) - dot(wheel));
        let drives = shaft*(motor - pinion) + zeta*shaft*(dot(motor) - dot(pinion));
        let driven = shaft*(wheel - load) + zeta*shaft*(dot(wheel) - dot(load));
        4*ddot(motor) + drives = torque;
        ddot(pinion) - drives + mesh = 0;
        2*ddot(wheel) - mesh + driven = 0;
        8*ddot(load) - driven = -torque;

        /// deformation of the mesh
        output relative = pinion - wheel;
        /// twist of the shaft of the motor
        output twist = motor - pinion;
    }
}

/// Traces the resonance of the shafts and that of the mesh, by shooting: all motions are known in closed form between switches.
pub fn main() -> Result<(), Error> {
    let request = FrequencyResponse::of(&GearTrain::default()).by(Shooting::new());
    let branch = request.from(0.2).to(1.8).run()?;
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let page = Page::new(1).chart(branch.chart());
    let page = page.chart(branch.chart_of(&View::new().of("twist".parse()?))?);
    Ok(page.write("gear_train.svg")?)
}
