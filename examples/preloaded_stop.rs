//! A stop with a preload: `cargo run --release --example preloaded_stop` draws `preloaded_stop.svg`.
//!
//! The stop pushes back with its preload as soon as it is touched, so that the force jumps at the level; Shaw and Holmes (1983) without
//! the preload. Where orbits begin to touch it the branch has a corner, and turns there without a fold. To make it your own, change the
//! preload, the stiffness, or add a second stop.

use hertzian::chart::{Chart, Curve, event_markers};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Oscillator with a preloaded stop
    pub PreloadedStop(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// stiffness of the stop
        param stiffness in 0.0..;
        /// preload of the stop
        param preload in 0.0..;
        /// way to the stop
        param distance > 0;
        /// excitation
        param drive;

        law stop(gap) {
            gap >= 0 => preload + stiffness*gap,
            else     => 0,
        }
        ddot(x) + 2*zeta*dot(x) + x + stop(x - distance) = drive*cos(omega*t);
    }
}

/// Traces a curve for each preload, and marks where the branch folds and where the stop is touched first.
pub fn main() -> Result<(), Error> {
    let mut chart = Chart::new("A stop at a distance of 1, stiffness 2, damping ratio 2 %")
        .x("excitation frequency ω")
        .y("peak-to-peak of x");
    let mut marks = Vec::new();
    for preload in [0.0, 0.05, 0.2] {
        let model = PreloadedStop {
            zeta: 0.02,
            stiffness: 2.0,
            preload,
            distance: 1.0,
            drive: 0.1,
        };
        let request = FrequencyResponse::of(&model)
            .from(0.7)
            .to(1.4)
            .tolerance(1e-4);
        let branch = request.bifurcations(true).run()?;
        println!("preload {preload}:");
        for event in &branch.events {
            println!("  {event}");
            let place = [event.point.value, event.point.peak_to_peak()];
            marks.push((event.kind, place));
        }
        chart = chart.curve(Curve {
            label: format!("preload {preload}"),
            runs: branch.runs(),
        });
    }
    // Where grazing is marked the stop is touched first.
    let chart = event_markers(marks).fold(chart, Chart::marks);
    chart.write("preloaded_stop.svg")?;
    println!("written preloaded_stop.svg");
    Ok(())
}
