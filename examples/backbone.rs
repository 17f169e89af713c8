//! Resonances and their backbone: `cargo run --release --example backbone` draws `backbone.svg`.
//!
//! As the drive of a nonlinear oscillator grows, its resonance follows the frequency of the free oscillation without damping: the backbone.
//! Here a Hertzian spring in both directions, which has no linear resonance at all. To make it your own, change the spring; the last
//! highest position says how far the free oscillation is followed.

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::chart::{Chart, Curve, Series};
use hertzian::{Error, FrequencyResponse, Point};

hertzian::oscillator! {
    /// Spring of Hertz's exponent in both directions
    pub Hertz(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// excitation amplitude
        param drive;

        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t);
    }
}

/// Damping ratio of the driven oscillator.
const ZETA: f64 = 0.03;

/// Traces the resonances, the free oscillation, and where the response lags a quarter of a period behind the drive.
pub fn main() -> Result<(), Error> {
    let mut chart = Chart::new("A Hertzian spring in both directions, damping ratio 3 %")
        .x("frequency ω")
        .y("peak-to-peak of x");
    for drive in [0.02, 0.05, 0.1] {
        let model = Hertz { zeta: ZETA, drive };
        let branch = FrequencyResponse::of(&model).from(0.4).to(1.6).run()?;
        for fold in branch.folds() {
            println!("drive {drive}: {fold}");
        }
        chart = chart.curve(Curve {
            label: format!("drive {drive}"),
            runs: branch.runs(),
        });
    }

    let undamped = Hertz {
        zeta: 0.0,
        drive: 0.0,
    };
    let free = FreeOscillation::of(&undamped).from(0.1).to(2.2).run()?;
    println!(
        "free oscillation: {} points, {}",
        free.points.len(),
        free.stopped
    );

    let driven = Hertz {
        zeta: ZETA,
        drive: 0.02,
    };
    let request = PhaseResonance::of(&driven).vary("drive").to(0.1);
    let resonance = request.between(0.4, 1.6).run()?;
    println!(
        "phase resonance: {} points, {}",
        resonance.points.len(),
        resonance.stopped
    );

    let place = |p: &Point| [p.omega(), p.peak_to_peak()];
    chart
        .reference(Series {
            label: "free oscillation".to_owned(),
            points: free.points.iter().map(place).collect(),
        })
        .trace(Series {
            label: "phase resonance".to_owned(),
            points: resonance.points.iter().map(place).collect(),
        })
        .write("backbone.svg")?;
    println!("written backbone.svg");
    Ok(())
}
