//! A thousand variants of a design: `cargo run --release --example variants` draws `variants.svg`.
//!
//! The play of a stop, its stiffness and the damping scatter as those of parts do that are made; of each variant the response is traced, in a
//! few milliseconds. To make it your own, change what scatters, or let threads share the work: models and errors can be sent to them.

use hertzian::chart::{Chart, Series};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Part with a stop
    pub Part(x: mm) {
        param mass: t = 1e-3 > 0;
        param spring: N/mm = 10 > 0;
        param damping: N*s/mm = 2e-3 in 0.0..;
        /// way to the stop
        param play: mm = 0.5 > 0;
        param stop: N/mm^1.5 = 20 in 0.0..;
        param drive: N = 0.4;

        law hertz(gap) { gap > 0 => stop*gap^1.5, else => 0 }
        mass*ddot(x) + damping*dot(x) + spring*x + hertz(x - play) = drive*cos(omega*t);
    }
}

/// Traces all of them, and draws over the play where each jumps down as the frequency rises.
pub fn main() -> Result<(), Error> {
    let mut jumps = Vec::new();
    for index in 1..=1000 {
        // Evenly over a cube, by powers of the root of `x^4 = x + 1`.
        let scatter =
            |power: i32| (f64::from(index) / 1.220_744_084_605_76_f64.powi(power)).fract() - 0.5;
        let mut part = Part::default();
        part.play *= 1.0 + 0.4 * scatter(1);
        part.stop *= 1.0 + 0.5 * scatter(2);
        part.damping *= 1.0 + 0.4 * scatter(3);
        let request = FrequencyResponse::of(&part).from(95.0).to(150.0);
        let branch = request.tolerance(1e-3).stability(false).run()?;
        let folds = branch.folds().map(|fold| fold.point.value);
        jumps.extend(folds.reduce(f64::max).map(|jump| [part.play, jump]));
    }
    println!("{} of 1000 variants jump", jumps.len());
    let jumps = Series {
        label: "jump".to_owned(),
        points: jumps,
    };
    let chart = Chart::new("A thousand parts whose play, stop and damping scatter");
    let chart = chart
        .x("way to the stop [mm]")
        .y("frequency of the jump ω [rad/s]");
    chart.markers(jumps).write("variants.svg")?;
    println!("written variants.svg");
    Ok(())
}
