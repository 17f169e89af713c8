//! Figures 2 to 7: primary resonances and what bends them.

use hertzian::Point;
use hertzian::backbone::FreeOscillation;
use hertzian::error::chain;

use super::curves::{Case, Curves};
use super::exact;
use super::figure::{Drawing, Task, Value};
use crate::response::models::ContinuousPower;

/// Hardening without load.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_2a(task: &Task<'_>) -> Result<Drawing, String> {
    let case = Case::continuous("symmetric", 1.5, [0.2, 1.7]).compared("2a");
    Ok(Curves::new(task).trace_all(&case)?.drawn())
}

/// Softening without load, with superharmonic resonances.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_2b(task: &Task<'_>) -> Result<Drawing, String> {
    let case = Case::continuous("symmetric", 0.6, [1.6, 0.38]).compared("2b");
    Ok(Curves::new(task).logarithmic().trace_all(&case)?.drawn())
}

/// Exponents above one, and the free vibration.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_3a(task: &Task<'_>) -> Result<Drawing, String> {
    skeletons(task, [1.25, 1.5, 2.0, 3.0])
}

/// Exponents below one, and the free vibration.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_3b(task: &Task<'_>) -> Result<Drawing, String> {
    skeletons(task, [0.8, 0.7, 0.6, 0.5])
}

fn skeletons(task: &Task<'_>, exponents: [f64; 4]) -> Result<Drawing, String> {
    let mut figure = Curves::new(task);
    for alpha in exponents {
        // From the side to which the resonance does not lean.
        let range = if alpha > 1.0 { [0.5, 2.4] } else { [1.9, 0.6] };
        let exact = match alpha {
            1.5 => "2a, primary",
            0.6 => "2b, primary",
            _ => "",
        };
        let case = Case::continuous(format!("α = {alpha}"), alpha, range);
        figure = figure.trace(&case.compared(exact))?;
        if let Some(&(_, exact)) = exact::BACKBONES.iter().find(|known| known.0 == alpha) {
            let what = format!("α = {alpha}: free vibration of amplitude one, ω");
            figure.value(Value::of(what, at_amplitude_one(alpha)?).exact(Some(exact)));
        }
        let label = if alpha == exponents[0] { "free" } else { "" };
        figure = figure.reference(label, skeleton(alpha)?);
    }
    Ok(figure.drawn())
}

/// Frequency and peak-to-peak of the free vibration.
fn skeleton(alpha: f64) -> Result<Vec<[f64; 2]>, String> {
    let spring = spring(alpha);
    // With an exponent above one the frequency falls to zero with the amplitude.
    let from = if alpha > 1.0 { 0.3 } else { 0.02 };
    let free = FreeOscillation::of(&spring).from(from).to(9.0);
    let curve = free
        .tolerance(1e-6)
        .run()
        .map_err(|error| chain(&error).to_string())?;
    let place = |point: &Point| [point.omega(), point.peak_to_peak()];
    Ok(curve.points.iter().map(place).collect())
}

/// Frequency of the free vibration of amplitude one.
fn at_amplitude_one(alpha: f64) -> Result<f64, String> {
    let spring = spring(alpha);
    let free = FreeOscillation::of(&spring).from(1.0).to(1.01);
    let curve = free.run().map_err(|error| chain(&error).to_string())?;
    let first = curve.points.first().ok_or("no free vibration was found")?;
    Ok(first.omega())
}

fn spring(alpha: f64) -> ContinuousPower {
    ContinuousPower {
        alpha,
        zeta: 0.0,
        load: 0.0,
        drive: 0.0,
    }
}

/// Loads on a spring of exponent 3/2.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_4a(task: &Task<'_>) -> Result<Drawing, String> {
    loads(
        task,
        1.5,
        [0.7, 2.0],
        &[(0.0, "2a, primary"), (1.0, "4a, W = 1"), (5.0, "4a, W = 5")],
    )
}

/// Loads on a spring of exponent 0.6.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_4b(task: &Task<'_>) -> Result<Drawing, String> {
    let known = [(0.0, "2b, primary"), (1.0, ""), (5.0, "")];
    loads(task, 0.6, [1.4, 0.42], &known)
}

fn loads(
    task: &Task<'_>,
    alpha: f64,
    range: [f64; 2],
    loads: &[(f64, &'static str)],
) -> Result<Drawing, String> {
    let mut figure = Curves::new(task);
    for &(load, exact) in loads {
        let case = Case::continuous(format!("W = {load}"), alpha, range);
        figure = figure.trace(&case.load(load).compared(exact))?;
    }
    Ok(figure.drawn())
}

/// One-sided against continuous, exponent one.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_5a(task: &Task<'_>) -> Result<Drawing, String> {
    sides(task, 1.0, [0.6, 1.4], "5a")
}

/// One-sided against continuous, exponent 3/2.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_5b(task: &Task<'_>) -> Result<Drawing, String> {
    sides(task, 1.5, [0.6, 1.6], "5b")
}

/// One-sided against continuous, exponent 0.6.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_5c(task: &Task<'_>) -> Result<Drawing, String> {
    sides(task, 0.6, [0.5, 1.2], "5c")
}

fn sides(
    task: &Task<'_>,
    alpha: f64,
    range: [f64; 2],
    exact: &'static str,
) -> Result<Drawing, String> {
    let one_sided = Case::one_sided("one-sided", alpha, range).compared(exact);
    let mut both = Case::one_sided("continuous", alpha, range);
    both.model.one_sided = false;
    both.model.continuous = true;
    let figure = Curves::new(task).trace(&one_sided)?.trace(&both)?;
    Ok(figure.boundary(&one_sided).drawn())
}

/// Damping of a one-sided contact of exponent 3/2 under load 1.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_6a(task: &Task<'_>) -> Result<Drawing, String> {
    dampings(task, 1.5, 1.0, [0.5, 1.6])
}

/// Damping of a one-sided contact of exponent 3/2 under load 2.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_6b(task: &Task<'_>) -> Result<Drawing, String> {
    dampings(task, 1.5, 2.0, [0.7, 1.8])
}

/// Damping of a one-sided contact of exponent 0.6 under load 1.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_7a(task: &Task<'_>) -> Result<Drawing, String> {
    dampings(task, 0.6, 1.0, [0.45, 1.1])
}

/// Damping of a one-sided contact of exponent 0.6 under load 2.
///
/// # Errors
/// If a curve does not begin.
pub fn figure_7b(task: &Task<'_>) -> Result<Drawing, String> {
    dampings(task, 0.6, 2.0, [0.4, 0.9])
}

fn dampings(task: &Task<'_>, alpha: f64, load: f64, range: [f64; 2]) -> Result<Drawing, String> {
    let mut figure = Curves::new(task);
    let case = |zeta: f64| {
        Case::one_sided(format!("ζ = {zeta}"), alpha, range)
            .load(load)
            .zeta(zeta)
    };
    for zeta in [0.032, 0.036, 0.045, 0.08] {
        figure = figure.trace(&case(zeta))?;
    }
    Ok(figure.boundary(&case(0.032)).drawn())
}
