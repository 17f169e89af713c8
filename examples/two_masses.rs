//! Two masses of which one meets a stop: `cargo run --release --example two_masses` draws `two_masses.svg`.
//!
//! A structure with two resonances; where the first mass reaches the stop both lean to higher frequencies, and orbits lose their
//! stability in between. In the manner of the third example of `NLvib`, Krack and Gross (2019). To make it your own, add coordinates
//! (`x[8]` declares eight), springs between them, and stops.

use hertzian::chart::{Chart, event_markers};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Two masses and a stop
    pub TwoMasses(x, y) {
        /// stiffness of the spring between the masses
        param coupling in 0.0..;
        /// damping ratio
        param zeta in 0.0..;
        /// stiffness of the stop
        param stop in 0.0..;
        /// way to the stop
        param distance > 0;
        /// excitation of the first mass
        param drive;

        law wall(gap) { gap > 0 => stop*gap, else => 0 }

        ddot(x) + 2*zeta*dot(x) + x + coupling*(x - y) + wall(x - distance) = drive*cos(omega*t);
        ddot(y) + 2*zeta*dot(y) + y + coupling*(y - x) = 0;
    }
}

/// Traces both masses, and marks where orbits of twice the period, and motions of two frequencies, begin.
pub fn main() -> Result<(), Error> {
    let model = TwoMasses {
        coupling: 0.5,
        zeta: 0.01,
        stop: 3.0,
        distance: 1.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.8).to(1.7);
    let branch = request.bifurcations(true).run()?;

    let marks = branch.events.iter().map(|event| {
        let size = event.point.observed.motions[0].peak_to_peak();
        (event.kind, [event.point.value, size])
    });
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let chart = Chart::new("Two masses x and y, x with a stop at a distance of 1")
        .x("excitation frequency / resonance of either mass alone")
        .y("peak-to-peak / distance of the stop")
        .curve(branch.curve("x")?)
        .curve(branch.curve("y")?);
    let chart = event_markers(marks).fold(chart, Chart::marks);
    chart.write("two_masses.svg")?;
    println!("written two_masses.svg");
    Ok(())
}
