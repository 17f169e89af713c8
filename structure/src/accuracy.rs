//! What the reduction changes of an orbit.
//!
//! The whole structure and the reduced one answer equal forces with amplitudes that differ by
//!
//! ```text
//! sum_c sum_k E_yc(k w) |f_ck| + sum_l E_yl(h_l w) |b_l|                                                      (1)
//! ```
//!
//! at most, with the errors `E` of the compliance and the harmonics `f_ck` of the forces that were computed; for a rate `E` is multiplied by
//! the frequency of its harmonic, for an acceleration by the square. Gaps differ as much, and change the forces, to which the reduced
//! structure answers with all of its compliance: that is added ([`crate::feedback`]). At a fold it is what lies beside the branch.
//! Both are of first order, and say too little where the stiffness of a contact is as large as one over the error of the compliance.

use std::f64::consts::TAU;

use hertzian::law::{Derivatives, On};
use hertzian::structure::Value;
use hertzian::{Branch, Error, Point};

use crate::description::{LoadKind, SparseContact, SparseStructure};
use crate::doubt::Doubt;
use crate::feedback::{Feedback, Read, Slopes, TIMES};
use crate::reduced::{Reduced, ReducedError};

/// A multiplier so near to one is that of a fold.
const TURNS: f64 = 1e-4;

/// What the reduction changes of an output at an orbit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutputError {
    /// The output.
    pub name: String,
    /// Of its peak-to-peak, as a part of it, to first order (1).
    pub error: f64,
}

/// Values of parameters at an orbit.
fn known<'p>(branch: &'p Branch, point: &'p Point) -> impl Fn(&str) -> Option<f64> + Copy + 'p {
    move |name: &str| {
        let mut parameters = branch.model.parameters.iter().zip(&point.parameters);
        let found = parameters.find(|(of, _)| of.name == name);
        found.map(|(_, value)| *value)
    }
}

/// Places of contacts and loads among what is driven with the amplitudes of their harmonics, and the base frequency of these.
type Forces = (Vec<(usize, Vec<f64>)>, f64);

/// Forces of contacts and loads at an orbit.
fn forces(structure: &SparseStructure, branch: &Branch, point: &Point) -> Result<Forces, Error> {
    let mut forces: Vec<(usize, Vec<f64>)> = Vec::new();
    let mut base = point.omega();
    for (index, contact) in structure.contacts.iter().enumerate() {
        let reading = branch.reading(&contact.name, point)?;
        base = reading.base;
        let lines = reading.spectrum();
        let amplitudes = lines.iter().map(|line| line.amplitude).collect();
        forces.push((2 * index + 1, amplitudes));
    }
    let per_load = (point.omega() / base).round().max(1.0) as usize;
    for (index, load) in structure.loads.iter().enumerate() {
        let amplitude = load.amplitude.at(known(branch, point), point.omega());
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
    Ok((forces, base))
}

impl Reduced {
    /// What the reduction changes of each output of a structure at an orbit of a branch of it.
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Self::is_of), or the orbit cannot be read.
    pub fn errors_at(
        &self,
        structure: &SparseStructure,
        branch: &Branch,
        point: &Point,
    ) -> Result<Vec<OutputError>, ReducedError> {
        self.is_of(structure)?;
        let (forces, base) = forces(structure, branch, point)?;
        let first = 2 * structure.contacts.len() + structure.loads.len();
        let measured = self.measured(structure, base);
        let speeds = structure.gyroscopic.iter();
        let speeds = speeds.map(|g| g.speed.at(known(branch, point), point.omega()));
        let speeds: Vec<f64> = speeds.collect();
        let doubt = Doubt::of_orbit(self, structure, &speeds, base);
        let completed = branch.complete(point)?;
        let slopes = structure.contacts.iter().enumerate();
        let slopes = slopes
            .map(|(index, contact)| self.slopes(index, contact, &completed, &known(branch, point)));
        let feedback = Feedback::of(self, &speeds, base, slopes.collect(), turns(point));
        let contacts = 0..structure.contacts.len();
        let off =
            contacts.map(|contact| measured.harmonics_off(2 * contact, base, &forces, &doubt));
        let read = structure.outputs.iter().enumerate();
        let read = read.map(|(index, output)| Read {
            row: first + index,
            derivatives: output.kind.derivatives(),
        });
        let read: Vec<_> = read.collect();
        let changes = feedback.changes(&read, &off.collect::<Vec<_>>());
        let outputs = structure.outputs.iter().zip(&read).zip(changes);
        let errors = outputs.map(|((output, read), change)| {
            let alone = measured.response_off(read.row, output.kind, base, &forces, &doubt);
            let motion = branch.reading(&output.name, point)?.motion;
            Ok(OutputError {
                name: output.name.clone(),
                error: part(alone + change, motion.peak_to_peak()),
            })
        });
        errors.collect()
    }

    /// Slopes of the law of a contact along an orbit that has its series.
    fn slopes(
        &self,
        index: usize,
        contact: &SparseContact,
        point: &Point,
        known: &impl Fn(&str) -> Option<f64>,
    ) -> Slopes {
        let of = |value: &Value| value.at(known, point.omega());
        let row = &self.rows[2 * index];
        let orbit = &point.orbit;
        let (mut gaps, mut rates) = ([-of(&contact.offset); TIMES], [0.0; TIMES]);
        for (coordinate, factor) in row.iter().enumerate() {
            for time in 0..TIMES {
                let after = TAU / orbit.base * time as f64 / TIMES as f64;
                let (x, rate) = orbit.state_at(coordinate, after).unwrap_or_default();
                gaps[time] += factor * x;
                rates[time] += factor * rate;
            }
        }
        let arguments: Vec<f64> = contact.arguments.iter().map(of).collect();
        let mut slopes = Slopes {
            by_gap: vec![0.0; TIMES],
            by_rate: vec![0.0; TIMES],
        };
        let out = Derivatives {
            force: &mut [0.0; TIMES],
            by_gap: &mut slopes.by_gap,
            by_rate: &mut slopes.by_rate,
        };
        let on = On::AllPieces;
        contact.law.derivatives(on, &arguments, &gaps, &rates, out);
        slopes
    }
}

/// Whether a branch turns at an orbit.
fn turns(point: &Point) -> bool {
    let mut multipliers = point.stability.multipliers.iter();
    multipliers.any(|multiplier| (multiplier - 1.0).norm() < TURNS)
}

/// What an amplitude is of a peak-to-peak; what is not a number is unbounded.
fn part(amplitude: f64, size: f64) -> f64 {
    if amplitude == 0.0 {
        0.0
    } else if amplitude.is_nan() {
        f64::INFINITY
    } else {
        2.0 * amplitude / size
    }
}
