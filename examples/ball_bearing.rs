//! A loaded ball bearing with clearance: `cargo run --release --example ball_bearing` draws `ball_bearing.svg`.
//!
//! Eight balls pass under the load, so that the bearing is now stiffer and now softer, and the shaft shakes without any unbalance:
//! varying compliance, after Sunnersjo (1978). Lengths are in units in which the load presses one ball by one, times in units of the
//! mass on that spring. To make it your own, change the number of balls, the clearance, or add an unbalance on the right.

use hertzian::{Error, FrequencyResponse, chart::Page, chart::View};

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
            cos(cage + pi/4*j)*ball(y*cos(cage + pi/4*j) + x*sin(cage + pi/4*j) - clearance)
        } = load;
        ddot(x) + 2*zeta*dot(x) + for j in 0..8 {
            sin(cage + pi/4*j)*ball(y*cos(cage + pi/4*j) + x*sin(cage + pi/4*j) - clearance)
        } = 0;
    }
}

/// Traces the motion of the shaft along the load, `y`, and across it, `x`, and draws the largest one: its path, and the forces of the balls.
pub fn main() -> Result<(), Error> {
    let request = FrequencyResponse::of(&Bearing::default())
        .from(0.65)
        .to(0.3);
    let branch = request.tolerance(1e-3).run()?;
    let mut page = Page::new(2).chart(branch.chart_of(&View::new().of("x".parse()?))?);
    if let Some(peak) = branch.largest("y")? {
        println!("{} at {}", branch.describe_size(peak), peak.value);
        page = page.chart(branch.path(["x", "y"], peak)?);
        page = page.page(branch.panels(peak, &View::new().of("y".parse()?))?);
    }
    page.write("ball_bearing.svg")?;
    Ok(())
}
