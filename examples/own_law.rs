//! A law of your own, with units: `cargo run --release --example own_law` draws `own_law.svg`.
//!
//! A machine on a rubber mount has a bump stop on one side, which stiffens as it is pressed, and a steel snubber on the other. To
//! make it your own, change the pieces of the law: every level of the gap begins another one, and the compiler says if a gap is left
//! between them, or if units do not agree.

use hertzian::chart::{Chart, Curve, event_markers};
use hertzian::{Error, FrequencyResponse};

hertzian::oscillator! {
    /// Machine on a mount with stops
    pub Isolator(x: mm) {
        /// mass
        param mass: t = 0.02 > 0;
        /// stiffness of the mount
        param mount: N/mm = 200 > 0;
        /// damping of the mount
        param damping: N*s/mm = 0.2 in 0.0..;
        /// bump stop, whose force is this times the square of what it is pressed
        param bump: N/mm^2 = 60 in 0.0..;
        /// stiffness of the snubber
        param snubber: N/mm = 500 in 0.0..;
        /// way to the bump stop
        param up: mm = 2 > 0;
        /// way to the snubber
        param down: mm = 1.5 > 0;
        /// excitation
        param drive: N = 40;

        law stops(gap) {
            gap > up           => bump*(gap - up)^2,
            -down <= gap <= up => 0,
            gap < -down        => snubber*(gap + down),
        }
        mass*ddot(x) + damping*dot(x) + mount*x + stops(x) = drive*cos(omega*t);
    }
}

/// Traces a curve for each excitation, with and without contact.
pub fn main() -> Result<(), Error> {
    let mut chart = Chart::new("A machine on a mount with stops, 2 mm above and 1.5 mm below")
        .x("excitation frequency ω [rad/s]")
        .y("peak-to-peak of x [mm]");
    let mut folds = Vec::new();
    for drive in [10.0, 20.0, 40.0, 80.0] {
        // What is not said here has its default.
        let model = Isolator {
            drive,
            ..Isolator::default()
        };
        let branch = FrequencyResponse::of(&model).from(70.0).to(200.0).run()?;
        let largest = branch.points.iter().map(hertzian::Point::peak_to_peak);
        let largest = largest.fold(0.0, f64::max);
        println!("{drive} N: up to {largest:.3} mm");
        for fold in branch.folds() {
            println!("  {}", branch.describe(fold));
            folds.push((fold.kind, [fold.point.value, fold.point.peak_to_peak()]));
        }
        chart = chart.curve(Curve {
            label: format!("excitation {drive} N"),
            runs: branch.runs(),
        });
    }
    let chart = event_markers(folds).fold(chart, Chart::marks);
    chart.write("own_law.svg")?;
    println!("written own_law.svg");
    Ok(())
}
