//! `--backbone`: free oscillation of the same oscillator, and its phase resonance.

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::chart::Series;
use hertzian::error::chain;
use hertzian::{Branch, Cancel, Error, Point, System};
use serde::Serialize;

use super::models::declared;
use super::options::Options;
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
}

/// The backbones of the oscillator over the displacements of a branch in the frequency, and why one of them is missing.
pub fn of(
    options: &Options,
    model: &dyn System,
    branch: &Branch,
    cancel: &Cancel,
) -> (Backbone, Vec<String>) {
    let free = free(options, branch, cancel);
    let resonance = resonance(options, model, cancel);
    let missing = free
        .as_ref()
        .err()
        .into_iter()
        .chain(resonance.as_ref().err());
    let warnings = missing.map(|error| format!("backbone: {}", chain(error)));
    let warnings = warnings.collect();
    let (free, resonance) = (free.ok(), resonance.ok());
    (Backbone { free, resonance }, warnings)
}

fn free(options: &Options, branch: &Branch, cancel: &Cancel) -> Result<Branch, Error> {
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
    request.cancel(cancel).run()
}

fn resonance(options: &Options, model: &dyn System, cancel: &Cancel) -> Result<Branch, Error> {
    let to = LEAST_DRIVE * options.model.drive;
    let request = PhaseResonance::of(model).vary("drive").to(to);
    let request = request.between(options.range.from, options.range.to);
    request.cancel(cancel).run()
}

impl Backbone {
    /// Lines for the picture.
    pub fn references(&self) -> impl Iterator<Item = Series> {
        let free = ("free oscillation", &self.free);
        let resonance = ("phase resonance", &self.resonance);
        let curves = [free, resonance].into_iter();
        let curves = curves.filter_map(|(label, curve)| Some((label, curve.as_ref()?)));
        let curves = curves.filter(|(_, curve)| !curve.points.is_empty());
        let place = |point: &Point| [point.omega(), point.peak_to_peak()];
        curves.map(move |(label, curve)| Series {
            label: label.to_owned(),
            points: curve.points.iter().map(place).collect(),
        })
    }
}
