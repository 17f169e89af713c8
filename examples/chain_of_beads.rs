//! A chain of beads pressed together: `cargo run --release --example chain_of_beads` draws `chain_of_beads.svg`.
//!
//! ```text
//! x_j'' + loss x_j' = h(x_j-1 - x_j) - h(x_j - x_j+1),    h(gap) = 2/3 max(1 + gap, 0)^(3/2),    x_0 = drive cos(omega t),  x_5 = 0
//! ```
//!
//! Four equal spheres between an actuator and a wall, which touch as Hertz has it: Nesterenko (1983). Lengths are in units of the approach
//! of two centres under the pressing force, time in units of the mass over the stiffness of a contact there. Of small motions the
//! resonances are at `2 sin(k pi/10)`, and nothing passes above 2; of larger ones they bend to lower frequencies, as contacts soften and
//! then open. To make it your own, change the number of beads, make one lighter, or press less.

use hertzian::chart::{Scale, View};
use hertzian::{Error, EventKind, FrequencyResponse};

hertzian::oscillator! {
    /// Chain of four beads
    pub Beads(x[4]) {
        /// what each loses to its guide
        param loss = 0.03 in 0.0..;
        /// amplitude of the actuator
        param drive = 0.02 in 0.0..;

        let last = 3;
        law hertz(gap) { gap > -1 => 2/3*(1 + gap)^1.5, else => 0 }

        ddot(x[0]) + loss*dot(x[0]) + hertz(x[0] - x[1]) - hertz(drive*cos(omega*t) - x[0]) = 0;
        for j in 1..last {
            ddot(x[j]) + loss*dot(x[j]) + hertz(x[j] - x[j + 1]) - hertz(x[j - 1] - x[j]) = 0;
        }
        ddot(x[last]) + loss*dot(x[last]) + hertz(x[last]) - hertz(x[last - 1] - x[last]) = 0;

        /// what arrives at the last bead
        output arrives = x[last];
    }
}

/// Traces what arrives at three amplitudes of the actuator.
pub fn main() -> Result<(), Error> {
    let mut branches = Vec::new();
    for drive in [0.01, 0.05, 0.1] {
        let model = Beads {
            drive,
            ..Beads::default()
        };
        let request = FrequencyResponse::of(&model).from(2.2).to(0.2);
        let branch = request.run()?;
        println!("actuator by {drive}:");
        for event in &branch.events {
            println!("  {}", branch.describe(event));
        }
        branches.push(branch);
    }
    let view = View::new().scale(Scale::Logarithmic);
    let view = view.events([EventKind::Fold, EventKind::PeriodDoubling]);
    let chart = view.together(&branches)?;
    let chart = chart.title("Four beads between an actuator and a wall, loss 0.03");
    let chart = chart.x("frequency / root of contact stiffness over mass");
    let chart = chart.y("peak-to-peak of the last bead / static approach");
    Ok(chart.write("chain_of_beads.svg")?)
}
