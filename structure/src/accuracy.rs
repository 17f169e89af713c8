//! What the reduction changes of an orbit.
//!
//! The whole structure and the reduced one answer equal forces with amplitudes that differ by
//!
//! ```text
//! sum_c sum_k E_yc(k w) |f_ck| + sum_l E_yl(h_l w) |b_l|                                                      (1)
//! ```
//!
//! at most, with the errors `E` of the compliance and the harmonics `f_ck` of the forces that were computed; for a rate `E` is multiplied by
//! the frequency of its harmonic, for an acceleration by the square. That forces change as well is left out: the estimate is of first order,
//! and says too little where the stiffness of a contact is as large as one over the error of the compliance.

use hertzian::{Branch, Error, Point};

use crate::description::{LoadKind, SparseStructure};
use crate::reduced::Reduced;

/// What the reduction changes of an output at an orbit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutputError {
    /// The output.
    pub name: String,
    /// Of its peak-to-peak, as a part of it, to first order (1).
    pub error: f64,
}

impl Reduced {
    /// What the reduction changes of each output of a structure at an orbit of a branch of it.
    ///
    /// # Errors
    /// If the orbit cannot be read.
    pub fn errors_at(
        &self,
        structure: &SparseStructure,
        branch: &Branch,
        point: &Point,
    ) -> Result<Vec<OutputError>, Error> {
        let mut forces: Vec<(usize, Vec<f64>)> = Vec::new();
        let mut base = point.omega();
        for (index, contact) in structure.contacts.iter().enumerate() {
            let reading = branch.reading(&contact.name, point)?;
            base = reading.base;
            let lines = reading.spectrum();
            let amplitudes = lines.iter().map(|line| line.amplitude).collect();
            forces.push((2 * index + 1, amplitudes));
        }
        let known = |name: &str| {
            let mut parameters = branch.model.parameters.iter().zip(&point.parameters);
            parameters
                .find(|(of, _)| of.name == name)
                .map(|(_, value)| *value)
        };
        let per_load = (point.omega() / base).round().max(1.0) as usize;
        for (index, load) in structure.loads.iter().enumerate() {
            let amplitude = load.amplitude.at(known, point.omega());
            let frequency = f64::from(load.harmonic) * point.omega();
            let factor = match load.kind {
                LoadKind::Force | LoadKind::Acceleration => 1.0,
                LoadKind::Unbalance => point.omega().powi(2),
                LoadKind::Base => frequency * frequency,
            };
            let mut amplitudes = vec![0.0; load.harmonic as usize * per_load + 1];
            if let Some(last) = amplitudes.last_mut() {
                *last = (amplitude * factor).abs();
            }
            forces.push((2 * structure.contacts.len() + index, amplitudes));
        }
        let first = 2 * structure.contacts.len() + structure.loads.len();
        let outputs = structure.outputs.iter().enumerate();
        let errors = outputs.map(|(index, output)| {
            let amplitude = self.response_error(first + index, output.kind, base, &forces);
            let motion = branch.reading(&output.name, point)?.motion;
            let size = motion.peak_to_peak();
            Ok(OutputError {
                name: output.name.clone(),
                error: if amplitude == 0.0 {
                    0.0
                } else {
                    2.0 * amplitude / size
                },
            })
        });
        errors.collect()
    }
}
