//! A loaded ball bearing with clearance: `cargo run --release --example ball_bearing` draws `ball_bearing.svg`.
//!
//! Eight balls pass under the load, so that the bearing is now stiffer and now softer, and the shaft shakes without any unbalance:
//! varying compliance, after Sunnersjo (1978). Lengths are in units in which the load presses one ball by one, times in units of the
//! mass on that spring. To make it your own, change the number of balls, the clearance, or add an unbalance on the right.

use hertzian::chart::{Chart, Series};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Shaft on eight balls
    pub Bearing(y, x) {
        /// damping ratio
        param zeta in 0.0..;
        /// clearance between shaft and balls
        param clearance;
        /// load along y
        param load;

        // The cage turns slower than the shaft.
        let cage = 2/5*omega*t;
        law ball(gap) { gap > 0 => gap^1.5, else => 0 }

        ddot(y) + 2*zeta*dot(y) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            cos(angle)*ball(y*cos(angle) + x*sin(angle) - clearance)
        } = load;
        ddot(x) + 2*zeta*dot(x) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            sin(angle)*ball(y*cos(angle) + x*sin(angle) - clearance)
        } = 0;
    }
}

/// Traces the motion of the shaft along the load and across it.
pub fn main() -> Result<(), Error> {
    let model = Bearing {
        zeta: 0.05,
        clearance: 0.2,
        load: 1.0,
    };
    let request = FrequencyResponse::of(&model).from(0.65).to(0.3);
    let branch = request.tolerance(1e-3).run()?;
    println!("{} points, {}", branch.points.len(), branch.stopped);

    // A curve over the frequency for each coordinate.
    let curve = |coordinate: usize, label: &str| Series {
        label: label.to_owned(),
        points: branch
            .points
            .iter()
            .map(|point| (point.value, &point.observed.motions[coordinate]))
            .map(|(omega, motion)| [omega, motion.peak_to_peak()])
            .collect(),
    };
    let along = curve(0, "along the load");
    let peak = along
        .points
        .iter()
        .fold([0.0; 2], |a, b| if b[1] > a[1] { *b } else { a });
    println!(
        "largest along the load: {:.4} at {:.4}, where balls pass {:.4} times a unit of time",
        peak[1],
        peak[0],
        8.0 * 0.4 * peak[0] / std::f64::consts::TAU
    );
    let resonance = Series {
        label: "largest along the load".to_owned(),
        points: vec![[peak[0], 0.0], peak],
    };
    Chart::new("Eight balls under a load, damping ratio 5 %, clearance 0.2")
        .x("speed of the shaft ω")
        .y("peak-to-peak of the shaft")
        .trace(along)
        .trace(curve(1, "across the load"))
        .reference(resonance)
        .write("ball_bearing.svg")?;
    println!("written ball_bearing.svg");
    Ok(())
}
