//! What the errors of a reduction are made of at an orbit: forces, gaps, and what is not known of compliances.

use hertzian::structure::Value;
use hertzian::{Branch, Error, Point};

use crate::description::{LoadKind, SparseStructure};
use crate::doubt::Doubt;
use crate::feedback::Feedback;
use crate::gaps::Gap;
use crate::reduced::{Reduced, ReducedError};

/// Harmonics of an orbit at which compliances are measured.
pub(crate) const HARMONICS: usize = 32;

/// An orbit of a reduced structure.
#[derive(Debug)]
pub(crate) struct AtOrbit<'s> {
    pub(crate) base: f64,
    /// Places of contacts and loads among what is driven with the amplitudes of their harmonics.
    pub(crate) forces: Vec<(usize, Vec<f64>)>,
    /// Of matrices that turn.
    pub(crate) speeds: Vec<f64>,
    /// With compliances at the harmonics of the orbit.
    pub(crate) measured: Reduced,
    pub(crate) doubt: Doubt,
    pub(crate) gaps: Vec<Gap<'s>>,
}

/// Values of parameters at an orbit.
fn known<'p>(branch: &'p Branch, point: &'p Point) -> impl Fn(&str) -> Option<f64> + Copy + 'p {
    move |name: &str| {
        let mut parameters = branch.model.parameters.iter().zip(&point.parameters);
        let found = parameters.find(|(of, _)| of.name == name);
        found.map(|(_, value)| *value)
    }
}

/// Places and amplitudes as in [`AtOrbit::forces`], and the base frequency.
struct Forces {
    amplitudes: Vec<(usize, Vec<f64>)>,
    base: f64,
}

impl Forces {
    fn of(structure: &SparseStructure, branch: &Branch, point: &Point) -> Result<Self, Error> {
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
        Ok(Self {
            amplitudes: forces,
            base,
        })
    }
}

impl<'s> AtOrbit<'s> {
    /// Of a branch of a reduction of a structure.
    pub(crate) fn of(
        reduced: &Reduced,
        structure: &'s SparseStructure,
        branch: &Branch,
        point: &Point,
    ) -> Result<Self, ReducedError> {
        reduced.is_of(structure)?;
        let Forces { amplitudes, base } = Forces::of(structure, branch, point)?;
        let of = |value: &Value| value.at(known(branch, point), point.omega());
        let speeds: Vec<f64> = structure.gyroscopic.iter().map(|g| of(&g.speed)).collect();
        let completed = branch.complete(point)?;
        if completed.orbit.coordinates() != reduced.vectors() {
            return Err(ReducedError::Other);
        }
        let gaps = structure.contacts.iter().enumerate();
        let gaps = gaps.map(|(index, contact)| {
            let arguments = contact.arguments.iter().map(of).collect();
            let (row, offset) = (&reduced.rows[2 * index], of(&contact.offset));
            Gap::of(&*contact.law, arguments, row, offset, &completed.orbit)
        });
        let harmonics = (1..=HARMONICS).map(|k| k as f64 * base);
        Ok(Self {
            base,
            forces: amplitudes,
            measured: reduced.measured(structure, harmonics),
            doubt: Doubt::of_orbit(reduced, structure, &speeds, base),
            gaps: gaps.collect(),
            speeds,
        })
    }

    /// What the contacts of a reduced structure do here, which may be a place where the branch turns.
    pub(crate) fn feedback<'r>(&self, reduced: &'r Reduced, at_fold: bool) -> Feedback<'r> {
        let slopes = self.gaps.iter().map(Gap::slopes).collect();
        Feedback::of(reduced, &self.speeds, self.base, slopes, at_fold)
    }

    /// By how much gaps are off, harmonic by harmonic, without what contacts make of that.
    pub(crate) fn off(&self) -> Vec<Vec<f64>> {
        let contacts = 0..self.gaps.len();
        let of = |contact: usize| {
            let measured = &self.measured;
            measured.harmonics_off(2 * contact, self.base, &self.forces, &self.doubt)
        };
        contacts.map(of).collect()
    }
}
