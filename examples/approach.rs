//! A force microscope approaches a surface and leaves it: `cargo run --release --example approach` draws `approach.svg`.
//!
//! The tip is driven at its free resonance while the surface comes nearer, until it is beyond where the tip rests. Two stable motions belong
//! to most distances, and the branch joins both sides: Garcia and San Paulo (2000). To make it your own, change the lever, the sample, or the
//! excitation.

use hertzian::{Error, FrequencyResponse, chart::View};

hertzian::oscillator! {
    /// Tip above a surface
    pub Approached(x: nm) {
        /// stiffness of the lever
        param lever: nN/nm = 2 > 0;
        /// free resonance
        param resonance: rad/s = 1e6 > 0;
        param quality: 1 = 400 > 0;
        /// excitation, as the amplitude of the free resonance
        param free: nm = 10 in 0.0..;
        /// surface from the tip at rest
        param distance: nm = 14;
        /// attraction
        param attraction: nN*nm^2 = 0.008 in 0.0..;
        /// spacing of atoms, where the attraction ends
        param spacing: nm = 0.165 > 0;
        /// stiffness of the contact
        param contact: nN/nm^1.5 = 0.2 in 0.0..;

        law surface(gap) { gap > 0 => contact*gap^1.5 - attraction/spacing^2, else => -attraction*(spacing - gap)^-2 }
        lever/resonance^2*(ddot(x) + resonance/quality*dot(x)) + lever*x + surface(x - distance) = lever*free/quality*cos(omega*t);
    }
}

/// Follows the branch from both sides, and says what there is at 5 nm.
pub fn main() -> Result<(), Error> {
    let request = FrequencyResponse::of(&Approached::default()).vary("distance");
    for (from, to) in [(14.0, -2.0), (-2.0, 14.0)] {
        let branch = request.clone().omega(1e6).from(from).to(to).run()?;
        println!("from {from} nm {}:", branch.points[0].stability.verdict);
        for point in branch.at(5.0)? {
            let amplitude = branch.describe_measured("x:h1", &point)?;
            let force = branch.describe_measured("surface:max", &point)?;
            println!("  {}, {amplitude}, {force}", point.stability.verdict);
        }
        let chart = branch.chart_of(&View::new().of("x:h1".parse()?))?;
        chart.write("approach.svg")?;
    }
    Ok(())
}
