//! `--backbone`: free oscillation of the same oscillator, and its phase resonance.

use std::fmt::Write;

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::chart::Series;
use hertzian::error::chain;
use hertzian::observe::Wanted;
use hertzian::{Branch, Cancel, Error, Point, System};
use serde::Serialize;

use super::models::declared;
use super::options::Options;
use super::structure::Reduced;
use crate::model::ModelOptions;

/// Smallest displacement from the state at rest, as a part of the largest of the branch.
const SMALLEST: f64 = 0.02;
/// Phase resonance is followed from the drive down to this part of it.
const LEAST_DRIVE: f64 = 0.05;

/// Both curves; none where it was not asked for or not found.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Backbone {
    /// Free oscillation, without damping and excitation.
    pub free: Option<Branch>,
    /// Phase resonance of the damped oscillator, as the drive falls.
    pub resonance: Option<Branch>,
    /// Energies of the orbits of free oscillation above rest; none where forces have no potential.
    pub energies: Vec<f64>,
}

/// Free oscillation, and the energies of its orbits.
struct Free {
    curve: Branch,
    energies: Result<Vec<f64>, Error>,
}

/// The backbones of an oscillator or a structure over the displacements of a branch in the frequency, and why one of them is missing.
pub fn of(
    options: &Options,
    model: &dyn System,
    reduced: Option<&Reduced>,
    branch: &Branch,
    cancel: &Cancel,
) -> (Backbone, Vec<String>) {
    let free = match reduced {
        Some(_) => of_mode(options, model, branch, cancel),
        None => free(options, branch, cancel),
    };
    let mut missing = Vec::new();
    let mut said = |error: &Error| missing.push(format!("backbone: {}", chain(error)));
    let mut backbone = Backbone::default();
    match free {
        Ok(Free { curve, energies }) => {
            backbone.free = Some(curve);
            match energies {
                Ok(energies) => backbone.energies = energies,
                Err(error) => said(&error),
            }
        }
        Err(error) => said(&error),
    }
    let resonance = match reduced.map(Reduced::drive) {
        Some(Some(drive)) => Some(of_drive(model, drive, branch, cancel)),
        Some(None) => None,
        None => Some(resonance(options, model, cancel)),
    };
    match resonance {
        Some(Ok(resonance)) => backbone.resonance = Some(resonance),
        Some(Err(error)) => said(&error),
        None => missing.push(
            "backbone: no phase resonance: the amplitudes of loads that change with time are not those of one parameter that could be varied"
                .to_owned(),
        ),
    }
    (backbone, missing)
}

fn free(options: &Options, branch: &Branch, cancel: &Cancel) -> Result<Free, Error> {
    let ModelOptions { alpha, load, .. } = options.model;
    let model = declared(&ModelOptions {
        zeta: 0.0,
        drive: 0.0,
        ..options.model.clone()
    });
    let rest = load.signum() * load.abs().powf(1.0 / alpha);
    let maxima = branch.points.iter().map(|point| point.motion().maximum);
    let largest = maxima.fold(rest, f64::max);
    let from = rest + SMALLEST * (largest - rest);
    let request = FreeOscillation::of(&*model).from(from).to(largest);
    let request = request.cancel(cancel);
    let curve = request.run()?;
    let energies = request.energies(&curve);
    Ok(Free { curve, energies })
}

/// Free oscillation of a structure in the lowest mode whose small oscillations have a frequency of the range, or in the mode next to the range.
fn of_mode(
    options: &Options,
    model: &dyn System,
    branch: &Branch,
    cancel: &Cancel,
) -> Result<Free, Error> {
    let request = FreeOscillation::of(model).conservative().cancel(cancel);
    let [low, high] = [options.range.from, options.range.to];
    let [low, high] = [low.min(high), low.max(high)];
    let away = |omega: f64| (low - omega).max(omega - high).max(0.0);
    let modes = request.modes()?;
    let held = modes.iter().enumerate().filter(|(_, omega)| **omega > 0.0);
    let nearest = held.min_by(|(_, a), (_, b)| away(**a).total_cmp(&away(**b)));
    let request = request.mode(nearest.map_or(1, |(mode, _)| mode + 1));
    let request = request.up_to(branch);
    let curve = request.run()?;
    let energies = request.energies(&curve);
    Ok(Free { curve, energies })
}

fn resonance(options: &Options, model: &dyn System, cancel: &Cancel) -> Result<Branch, Error> {
    let to = LEAST_DRIVE * options.model.drive;
    let request = PhaseResonance::of(model).vary("drive").to(to);
    let request = request.between(options.range.from, options.range.to);
    request.cancel(cancel).run()
}

/// Phase resonance along a branch, as the amplitude of the loads falls.
fn of_drive(
    model: &dyn System,
    drive: &str,
    branch: &Branch,
    cancel: &Cancel,
) -> Result<Branch, Error> {
    let mut parameters = branch.model.parameters.iter();
    let index = parameters.position(|known| known.name == drive);
    let mut values = vec![0.0; model.facts().parameters.len()];
    model.values(&mut values);
    let value = index.and_then(|index| values.get(index).copied());
    let request = PhaseResonance::of(model).vary(drive).on(branch);
    let request = request.to(LEAST_DRIVE * value.unwrap_or(0.0));
    request.cancel(cancel).run()
}

impl Backbone {
    /// For people: why each curve ended, and where nothing is known of it on the way.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let free = ("free oscillation", &self.free);
        let resonance = ("phase resonance", &self.resonance);
        for (label, curve) in [free, resonance] {
            let Some(curve) = curve else {
                continue;
            };
            let (count, stopped) = (curve.points.len(), curve.stopped);
            // Writing to a string does not fail.
            let _ = writeln!(text, "backbone   {label}: {count} orbits, {stopped}");
            for leap in &curve.leaps {
                let sides = [leap.after - 1, leap.after].map(|index| {
                    let point = curve.points.get(index);
                    point.map_or(f64::NAN, Point::omega)
                });
                let [from, to] = sides;
                let _ = writeln!(
                    text,
                    "           not followed from omega = {from:.8} to {to:.8}: {}",
                    leap.reason
                );
            }
        }
        text
    }

    /// Lines for a picture of what is wanted, peak-to-peak where nothing is.
    pub fn references(&self, wanted: Option<&Wanted>) -> Vec<Series> {
        let free = ("free oscillation", &self.free);
        let resonance = ("phase resonance", &self.resonance);
        let curves = [free, resonance].into_iter();
        let curves = curves.filter_map(|(label, curve)| Some((label, curve.as_ref()?)));
        let curves = curves.map(|(label, curve)| {
            let place = |point: &Point| {
                let y = match wanted {
                    Some(wanted) => curve.measured(wanted, point).ok()??,
                    None => point.peak_to_peak(),
                };
                Some([point.omega(), y])
            };
            let mut places: Vec<[f64; 2]> = Vec::with_capacity(curve.points.len());
            for part in curve.parts() {
                // No line leads from one part to the next.
                places.extend((!places.is_empty()).then_some([f64::NAN; 2]));
                places.extend(part.iter().filter_map(place));
            }
            Series::new(label, places)
        });
        curves.filter(|series| !series.points.is_empty()).collect()
    }
}
