//! Two masses of which one meets a stop: `cargo run --release --example two_masses` draws `two_masses.svg`.
//!
//! A structure with two resonances; where the first mass reaches the stop both lean to higher frequencies, and orbits lose their
//! stability in between. In the manner of the third example of `NLvib`, Krack and Gross (2019). To make it your own, add coordinates
//! (`x[8]` declares eight), springs between them, and stops.

use hertzian::chart::{Chart, Curve, Line, Run, Series};
use hertzian::{Error, FrequencyResponse, Point, Verdict};

hertzian::oscillator! {
    /// Two masses and a stop
    pub TwoMasses(x, y) {
        /// stiffness of the spring between the masses
        param coupling in 0.0..;
        /// damping ratio
        param zeta in 0.0..;
        /// stiffness of the stop
        param stop in 0.0..;
        /// way to the stop
        param distance > 0;
        /// excitation of the first mass
        param drive;

        law wall(gap) { gap > 0 => stop*gap, else => 0 }

        ddot(x) + 2*zeta*dot(x) + x + coupling*(x - y) + wall(x - distance) = drive*cos(omega*t);
        ddot(y) + 2*zeta*dot(y) + y + coupling*(y - x) = 0;
    }
}

/// Traces both masses, and marks where orbits of twice the period, and motions of two frequencies, begin.
pub fn main() -> Result<(), Error> {
    let model = TwoMasses {
        coupling: 0.5,
        zeta: 0.01,
        stop: 3.0,
        distance: 1.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.8).to(1.7);
    let branch = request.bifurcations(true).run()?;

    let mut chart = Chart::new("Two masses, the first with a stop at a distance of 1")
        .x("excitation frequency ω")
        .y("peak-to-peak")
        .curve(curve("first mass", &branch.points, 0))
        .curve(curve("second mass", &branch.points, 1));
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let mut kinds: Vec<_> = branch.events.iter().map(|event| event.kind).collect();
    kinds.dedup();
    while let Some(kind) = kinds.pop() {
        kinds.retain(|other| *other != kind);
        let points = branch.events(kind);
        let points = points.map(|event| [event.point.value, event.point.peak_to_peak()]);
        chart = chart.markers(Series {
            label: kind.to_string(),
            points: points.collect(),
        });
    }
    chart.write("two_masses.svg")?;
    println!("written two_masses.svg");
    Ok(())
}

/// Peak-to-peak of one coordinate: a new run begins where the verdict changes, at the last point before.
fn curve(label: &str, points: &[Point], coordinate: usize) -> Curve {
    let place = |point: &Point| {
        [
            point.value,
            point.observed.motions[coordinate].peak_to_peak(),
        ]
    };
    let mut runs: Vec<Run> = Vec::new();
    for pair in points.windows(2) {
        let line = match pair[1].stability.verdict {
            Verdict::Stable => Line::Stable,
            Verdict::Unstable => Line::Unstable,
            Verdict::Undecided => Line::Undecided,
        };
        match runs.last_mut() {
            Some(run) if run.line == line => run.points.push(place(&pair[1])),
            _ => runs.push(Run {
                line,
                points: pair.iter().map(place).collect(),
            }),
        }
    }
    Curve {
        label: label.to_owned(),
        runs,
    }
}
