//! `cargo run --release --example contact_resonance`: the primary resonance of a ball that its weight presses on a plane.
//!
//! Rigaud and Perret-Liaudet measured it (2001, 2003). With the displacement in units of the static one and time in units
//! of the linear resonance,
//!
//! ```text
//! q'' + H(q) (2 zeta q' + 2/3 q^(3/2)) = 2/3 (1 + sigma cos omega t)                 (1)
//! ```
//!
//! The chapter "A measured contact" of the book says what agrees with what they describe, and what could not be compared.

use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;

use hertzian::backbone::FreeOscillation;
use hertzian::chart::{Chart, Curve, Markers, Reference};
use hertzian::{Branch, Error, FrequencyResponse, Point};
use hertzian_examples::program::print;

hertzian::oscillator! {
    Ball(q) {
        /// damping ratio in contact
        param zeta in 0.0..;
        /// amplitude of the excitation in units of the weight
        param sigma in 0.0..;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + 2/3*gap^1.5,
            else    => 0,
        }
        ddot(q) + contact(q) = 2/3 + 2/3*sigma*cos(omega*t);
    }
}

/// The damping ratio that was identified is not known to us; contacts of steel have around one percent.
const ZETA: f64 = 0.01;
/// Excitations from an almost linear resonance to one with impacts.
const SIGMA: [f64; 4] = [0.004, 0.02, 0.03, 0.034];
/// Free oscillation touches zero at `q = (5/2)^(2/3)`: there `2/3 q = 4/15 q^(5/2)`.
const TOUCH: f64 = 1.842_015_749_320_193;

fn main() -> ExitCode {
    let printed = run(Path::new("contact_resonance.svg")).and_then(|text| Ok(print(&text)?));
    match printed {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(path: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let mut chart = Chart::new("A ball pressed on a plane by its weight, damping ratio 1 %")
        .x("frequency / linear resonance")
        .y("peak-to-peak / static displacement");
    let mut folds = Vec::new();
    let mut text = String::new();
    writeln!(
        text,
        "sigma  peak   at      jumps at              contact lost from"
    )?;
    for sigma in SIGMA {
        let model = Ball { zeta: ZETA, sigma };
        let branch = FrequencyResponse::of(&model).from(1.1).to(0.75).run()?;
        writeln!(text, "{}", described(sigma, &branch))?;
        folds.extend(
            branch
                .folds()
                .map(|fold| [fold.point.value, fold.point.peak_to_peak()]),
        );
        chart = chart.curve(Curve {
            label: format!("σ = {sigma}"),
            runs: branch.runs(),
        });
    }
    let touch = free_oscillation(TOUCH)?.last().copied();
    chart
        .reference(Reference {
            label: "free oscillation".to_owned(),
            points: free_oscillation(3.0)?,
        })
        .markers(Markers {
            label: "fold".to_owned(),
            points: folds,
        })
        .markers(Markers {
            label: "free oscillation leaves contact".to_owned(),
            points: touch.into_iter().collect(),
        })
        .write(path)?;
    if let Some([omega, size]) = touch {
        writeln!(
            text,
            "free oscillation leaves contact at {omega:.6}, peak-to-peak {size:.6}"
        )?;
    }
    writeln!(text, "written {}", path.display())?;
    Ok(text)
}

/// Largest vibration, folds, and where on the branch contact is lost first.
fn described(sigma: f64, branch: &Branch<'_>) -> String {
    let largest = branch
        .points
        .iter()
        .max_by(|a, b| a.peak_to_peak().total_cmp(&b.peak_to_peak()));
    let peak = largest.map_or([f64::NAN; 2], |point| [point.peak_to_peak(), point.value]);
    let jumps: Vec<_> = branch
        .folds()
        .map(|fold| format!("{:.4}", fold.point.value))
        .collect();
    let leaves = |point: &&Point| point.motion().minimum < 0.0;
    let lost = branch
        .points
        .iter()
        .find(leaves)
        .map(|point| format!("{:.3}", point.value));
    let (jumps, lost) = (
        jumps.join(" and "),
        lost.unwrap_or_else(|| "never".to_owned()),
    );
    format!(
        "{sigma:<6} {:.3}  {:.4}  {jumps:<20}  {lost}",
        peak[0], peak[1]
    )
}

/// The backbone of (1) up to this highest position: what the resonance follows as the excitation grows.
fn free_oscillation(highest: f64) -> Result<Vec<[f64; 2]>, Error> {
    let model = Ball {
        zeta: 0.0,
        sigma: 0.0,
    };
    let curve = FreeOscillation::of(&model).from(1.02).to(highest).run()?;
    let points = curve
        .points
        .iter()
        .map(|point| [point.omega, point.peak_to_peak()]);
    Ok(points.collect())
}
