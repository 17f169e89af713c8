//! A thousand variants of a design: `cargo run --release --example variants` draws `variants.svg`.
//!
//! The play of a stop, its stiffness and the damping scatter as those of parts do that are made; of each variant the response is traced, in a
//! few milliseconds. To make it your own, change what scatters, or let threads share the work: models and errors can be sent to them.

use hertzian::{Error, FrequencyResponse, chart::Chart, chart::Series};

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
    // Evenly over a cube, by powers of the root of `x^4 = x + 1`.
    let scatter = |index: i32, power| (f64::from(index) / 1.220_744_f64.powi(power)).fract() - 0.5;
    let mut jumps = Vec::new();
    for index in 1..=1000 {
        let mut part = Part::default();
        part.play *= 1.0 + 0.4 * scatter(index, 1);
        part.stop *= 1.0 + 0.5 * scatter(index, 2);
        part.damping *= 1.0 + 0.4 * scatter(index, 3);
        let request = FrequencyResponse::of(&part).from(95.0).to(150.0);
        let branch = request.tolerance(1e-3).stability(false).run()?;
        let folds = branch.folds().map(|fold| fold.point.value);
        jumps.extend(folds.reduce(f64::max).map(|jump| [part.play, jump]));
    }
    let chart = Chart::new("A thousand variants").x("way to the stop [mm]");
    let chart = chart.y("jump at ω [rad/s]").markers(Series::new("", jumps));
    Ok(chart.write("variants.svg")?)
}
