//! A bolted joint that opens, in SI units: `cargo run --release --example bolted_joint` draws `bolted_joint.svg`.
//!
//! A bolt presses a part on its base, whose roughness carries as Hertz contacts do. Where the excitation exceeds the preload the joint opens,
//! and the resonance leans to lower frequencies. To make it your own, change the bolt, the preload, or the exponent of the joint.

use hertzian::chart::{Frequency, Page, View};
use hertzian::{Error, FrequencyResponse, Point};

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

/// Traces the resonance, and draws the opening and the force between the faces.
pub fn main() -> Result<(), Error> {
    let model = BoltedJoint::default();
    let request = FrequencyResponse::of(&model).from(1500.0).to(4500.0);
    let branch = request.run()?;
    for fold in branch.folds() {
        println!("{}", branch.describe(fold));
    }
    let opens = |point: &&Point| point.observed.outputs[0].maximum > 0.0;
    if let Some(point) = branch.points.iter().find(opens) {
        let hertz = Frequency::Hertz.of(point.value);
        println!("opens at {hertz:.1} Hz, {}", point.stability.verdict);
    }
    let view = View::new().frequency(Frequency::Hertz);
    let opening = branch.chart_of(&view.clone().of("opening:max".parse()?))?;
    let pressing = branch.chart_of(&view.of("pressing:max".parse()?))?;
    let page = Page::new(2).chart(opening).chart(pressing);
    page.write("bolted_joint.svg")?;
    println!("written bolted_joint.svg");
    Ok(())
}
