//! A bolted joint that opens, in SI units: `cargo run --release --example bolted_joint` draws `bolted_joint.svg`.
//!
//! A bolt presses a part on its base, whose roughness carries as Hertz contacts do. Where the excitation exceeds the preload the joint opens,
//! and the resonance leans to lower frequencies. To make it your own, change the bolt, the preload, or the exponent of the joint.

use hertzian::chart::{Frequency, Page, View};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Bolted joint
    pub BoltedJoint(x: m) {
        /// mass of the part
        param mass: kg = 2 > 0;
        /// stiffness of the bolt
        param bolt: N/m = 5e6 > 0;
        /// force of the bolt where the joint just closes
        param preload: N = 1000 in 0.0..;
        /// stiffness of the joint
        param joint: N/m^1.5 = 1e9 > 0;
        param damping: N*s/m = 100 in 0.0..;
        /// excitation
        param drive: N = 300;

        law faces(gap) { gap > 0 => joint*gap^1.5, else => 0 }
        mass*ddot(x) + damping*dot(x) + bolt*x + faces(x) = preload + drive*cos(omega*t);

        /// how far the joint is open
        output opening: um = -x;
        /// force between the faces
        output pressing: kN = force(faces);
    }
}

/// Traces the resonance, says where the joint begins to open, and draws the opening and the force between the faces.
pub fn main() -> Result<(), Error> {
    let request = FrequencyResponse::of(&BoltedJoint::default());
    let branch = request.from(1500.0).to(4500.0).bifurcations(true).run()?;
    for event in &branch.events {
        let hertz = Frequency::Hertz.of(event.point.value);
        println!("{}, {hertz:.1} Hz", branch.describe(event));
    }
    let view = View::new().frequency(Frequency::Hertz);
    let opening = branch.chart_of(&view.clone().of("opening:max".parse()?))?;
    let pressing = branch.chart_of(&view.of("pressing:max".parse()?))?;
    let page = Page::new(2).chart(opening).chart(pressing);
    page.write("bolted_joint.svg")?;
    Ok(())
}
