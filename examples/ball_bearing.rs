//! A loaded ball bearing with clearance: `cargo run --release --example ball_bearing` draws `ball_bearing.svg`.
//!
//! Eight balls pass under the load, so that the bearing is now stiffer and now softer, and the shaft shakes without any unbalance:
//! varying compliance, after Sunnersjo (1978). Lengths are in units in which the load presses one ball by one, times in units of the
//! mass on that spring. To make it your own, change the number of balls, the clearance, or add an unbalance on the right.

use hertzian::chart::Chart;
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Shaft on eight balls
    pub Bearing(y, x) {
        /// damping ratio
        param zeta = 0.05 in 0.0..;
        /// clearance between shaft and balls
        param clearance = 0.2;
        /// load along y
        param load = 1;

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

/// Traces the motion of the shaft along the load, `y`, and across it, `x`.
pub fn main() -> Result<(), Error> {
    let model = Bearing::default();
    let request = FrequencyResponse::of(&model).from(0.65).to(0.3);
    let branch = request.tolerance(1e-3).run()?;
    println!("{} points, {}", branch.points.len(), branch.stopped);
    if let Some(peak) = branch.largest("y")? {
        let balls = 8.0 * 0.4 * peak.value / std::f64::consts::TAU;
        println!(
            "largest along the load: {:.4} at {:.4}, where balls pass {balls:.4} times a unit of time",
            peak.peak_to_peak(),
            peak.value,
        );
    }
    Chart::new("Eight balls under a load along y, damping ratio 5 %, clearance 0.2")
        .x("speed of the shaft ω")
        .y("peak-to-peak of the shaft")
        .curve(branch.curve("y")?)
        .curve(branch.curve("x")?)
        .write("ball_bearing.svg")?;
    println!("written ball_bearing.svg");
    Ok(())
}
