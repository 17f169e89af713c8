//! `--backbone`: free oscillation of the same oscillator, and its phase resonance.

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::chart::Reference;
use hertzian::error::chain;
use hertzian::{Branch, Cancel, Error, System};
use serde::Serialize;

use super::models::declared;
use super::options::Options;
use crate::model::ModelOptions;

/// Smallest displacement from the state at rest, as a part of the largest of the branch.
const SMALLEST: f64 = 0.02;
/// Phase resonance is followed from the drive down to this part of it.
const LEAST_DRIVE: f64 = 0.05;

/// One point of a backbone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BackbonePoint {
    /// Frequency.
    pub omega: f64,
    /// Largest less smallest displacement.
    pub peak_to_peak: f64,
    /// Amplitude of the excitation; zero of free oscillation.
    pub drive: f64,
}

/// Both curves.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Backbone {
    /// Free oscillation, without damping and excitation.
    pub free: Vec<BackbonePoint>,
    /// Phase resonance of the damped oscillator, as the drive falls.
    pub resonance: Vec<BackbonePoint>,
}

/// The backbones of the oscillator over the displacements of a branch in the frequency, and why one of them is missing.
pub fn of(
    options: &Options,
    model: &dyn System,
    branch: &Branch,
    cancel: &Cancel,
) -> (Backbone, Vec<String>) {
    let mut warnings = Vec::new();
    let mut kept = |found: Result<Vec<BackbonePoint>, Error>| {
        found.unwrap_or_else(|error| {
            warnings.push(format!("backbone: {}", chain(&error)));
            Vec::new()
        })
    };
    let free = kept(free(options, branch, cancel));
    let resonance = kept(resonance(options, model, cancel));
    (Backbone { free, resonance }, warnings)
}

fn free(options: &Options, branch: &Branch, cancel: &Cancel) -> Result<Vec<BackbonePoint>, Error> {
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
    let curve = request.cancel(cancel).run()?;
    let points = curve.points.iter().map(|point| BackbonePoint {
        omega: point.omega,
        peak_to_peak: point.peak_to_peak(),
        drive: 0.0,
    });
    Ok(points.collect())
}

fn resonance(
    options: &Options,
    model: &dyn System,
    cancel: &Cancel,
) -> Result<Vec<BackbonePoint>, Error> {
    let to = LEAST_DRIVE * options.model.drive;
    let request = PhaseResonance::of(model).vary("drive").to(to);
    let request = request.between(options.from, options.to);
    let curve = request.cancel(cancel).run()?;
    let points = curve.points.iter().map(|point| BackbonePoint {
        omega: point.orbit.omega,
        peak_to_peak: point.motion.peak_to_peak(),
        drive: point.value,
    });
    Ok(points.collect())
}

impl Backbone {
    /// Lines for the picture.
    pub fn references(&self) -> impl Iterator<Item = Reference> {
        let place = |point: &BackbonePoint| [point.omega, point.peak_to_peak];
        let curves = [
            ("free oscillation", &self.free),
            ("phase resonance", &self.resonance),
        ];
        let curves = curves.into_iter().filter(|(_, points)| !points.is_empty());
        curves.map(move |(label, points)| Reference {
            label: label.to_owned(),
            points: points.iter().map(place).collect(),
        })
    }
}
