//! The tip of a force microscope above a surface: `cargo run --release --example adhesion` draws `adhesion.svg`.
//!
//! Outside of the surface the tip is attracted, inside it is repelled as by Hertz: Derjaguin, Muller and Toporov (1975), as used by
//! Garcia and Perez (2002). Attraction bends the resonance to lower frequencies, contact to higher ones, so that several amplitudes
//! belong to one frequency. Lengths are in nanometres, forces in those that bend the lever by one, time in units of its free resonance.
//! To make it your own, change the lever, the sample, or the distance.

use hertzian::chart::{Chart, Curve, Series, event_markers};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Tip above a surface
    pub Tip(x) {
        /// quality of the resonance
        param quality > 0;
        /// amplitude of the free resonance
        param free in 0.0..;
        /// distance of the surface from the tip at rest
        param distance;
        /// attraction
        param attraction in 0.0..;
        /// spacing of atoms, where the attraction ends
        param spacing > 0;
        /// stiffness of the contact
        param contact in 0.0..;

        law surface(gap) {
            gap > 0 => contact*gap^1.5 - attraction/spacing^2,
            else    => -attraction*(spacing - gap)^-2,
        }
        ddot(x) + dot(x)/quality + x + surface(x - distance) = free/quality*cos(omega*t);
    }
}

/// Traces the resonance at three distances: far, near, and nearer than the free amplitude.
pub fn main() -> Result<(), Error> {
    let mut chart =
        Chart::new("Tip of a force microscope, free amplitude 10 nm, quality factor 400")
            .x("excitation frequency / free resonance")
            .y("peak-to-peak of the tip [nm]");
    let mut folds = Vec::new();
    for distance in [12.0, 10.0, 8.0] {
        let model = Tip {
            quality: 400.0,
            free: 10.0,
            distance,
            attraction: 0.004,
            spacing: 0.165,
            contact: 0.1,
        };
        let branch = FrequencyResponse::of(&model).from(0.994).to(1.006).run()?;
        println!("surface {distance} nm from the tip at rest:");
        for fold in branch.folds() {
            println!("  {}", branch.describe(fold));
            folds.push((fold.kind, [fold.point.value, fold.point.peak_to_peak()]));
        }
        // The other end of a branch that turned back.
        let again = FrequencyResponse::of(&model).from(1.006).to(0.994).run()?;
        let stable = again.at(1.0)?;
        for point in stable.iter().chain(&branch.at(1.0)?) {
            let size = point.peak_to_peak();
            println!(
                "  at the free resonance {size:.3} nm, {}",
                point.stability.verdict
            );
        }
        chart = chart.curve(Curve {
            label: format!("surface {distance} nm away"),
            runs: branch.runs(),
        });
    }
    let surface = Series {
        label: "to the surface at 8 nm and back".to_owned(),
        points: vec![[0.994, 16.0], [1.006, 16.0]],
    };
    let chart = event_markers(folds).fold(chart, Chart::marks);
    chart.reference(surface).write("adhesion.svg")?;
    println!("written adhesion.svg");
    Ok(())
}
