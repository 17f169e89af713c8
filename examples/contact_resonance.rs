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

use hertzian::backbone::FreeOscillation;
use hertzian::chart::{Chart, Curve, Note, Series, event_markers};
use hertzian::{Branch, Error, Event, EventKind, FrequencyResponse};

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

/// Traces a curve for each excitation, and draws them with the free oscillation.
pub fn main() -> Result<(), Error> {
    let mut chart = Chart::new("A ball pressed on a plane by its weight, damping ratio 1 %")
        .x("frequency / linear resonance")
        .y("peak-to-peak / static displacement");
    let mut folds = Vec::new();
    println!("sigma  peak   at      jumps at              contact lost from");
    for sigma in SIGMA {
        let model = Ball { zeta: ZETA, sigma };
        let branch = FrequencyResponse::of(&model).from(1.1).to(0.75).run()?;
        describe(sigma, &branch);
        let place = |fold: &Event| (fold.kind, [fold.point.value, fold.point.peak_to_peak()]);
        folds.extend(branch.folds().map(place));
        chart = chart.curve(Curve {
            label: format!("σ = {sigma}"),
            runs: branch.runs(),
        });
    }
    let touch = free_oscillation(TOUCH)?.last().copied();
    if let Some(point @ [omega, size]) = touch {
        let label = "leaves contact".to_owned();
        chart = chart.note(Note { label, point });
        println!("free oscillation leaves contact at {omega:.6}, peak-to-peak {size:.6}");
    }
    let free = Series {
        label: "free oscillation".to_owned(),
        points: free_oscillation(3.0)?,
    };
    let chart = event_markers(folds).fold(chart.reference(free), Chart::marks);
    chart.write("contact_resonance.svg")?;
    println!("written contact_resonance.svg");
    Ok(())
}

/// Largest vibration, folds, and where on the branch contact is lost first.
fn describe(sigma: f64, branch: &Branch) {
    let folds = branch.folds().map(|fold| &fold.point);
    let sizes = branch.points.iter().chain(folds);
    let sizes = sizes.map(|p| (p.peak_to_peak(), p.value));
    let (peak, at) = sizes.fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let jumps = branch
        .folds()
        .map(|fold| format!("{:.4}", fold.point.value));
    let jumps = jumps.collect::<Vec<_>>().join(" and ");
    let touches = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    let lost = branch.events.iter().find(touches);
    let lost = lost.map(|touch| format!("{:.4}", touch.point.value));
    let lost = lost.unwrap_or_else(|| "never".to_owned());
    println!("{sigma:<6} {peak:.3}  {at:.4}  {jumps:<20}  {lost}");
}

/// The backbone of (1) up to this highest position: what the resonance follows as the excitation grows.
fn free_oscillation(highest: f64) -> Result<Vec<[f64; 2]>, Error> {
    let (zeta, sigma) = (0.0, 0.0);
    let model = Ball { zeta, sigma };
    let curve = FreeOscillation::of(&model).from(1.02).to(highest).run()?;
    let points = curve.points.iter();
    Ok(points.map(|p| [p.omega(), p.peak_to_peak()]).collect())
}
