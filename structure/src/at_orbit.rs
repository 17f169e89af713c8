//! What the errors of a reduction are made of at an orbit: forces, gaps, and what is not known of compliances.

use hertzian::observe::{Motion, Reading};
use hertzian::structure::Value;
use hertzian::{Branch, Cancel, Point};

use crate::arms::Arm;
use crate::description::load::LoadKind;
use crate::description::output::OutputKind;
use crate::description::structure::SparseStructure;
use crate::doubt::{self, Doubt};
use crate::feedback::Feedback;
use crate::gaps::{self, Gap};
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
    /// Of each contact.
    pub(crate) arms: Vec<Vec<Arm>>,
    /// What each output does.
    pub(crate) outputs: Vec<Motion>,
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
    /// With the force of each contact.
    fn of(
        reduced: &Reduced,
        structure: &SparseStructure,
        branch: &Branch,
        point: &Point,
        readings: &[Reading],
    ) -> Self {
        // Forces along one row come together with their phases.
        let mut along: Vec<(usize, Vec<f64>)> = Vec::new();
        let mut base = point.omega();
        for (index, (contact, reading)) in structure.contacts.iter().zip(readings).enumerate() {
            base = reading.base;
            for arm in Arm::of(contact, index, [point.omega(), base]) {
                let series = arm.times(&reading.series);
                let row = reduced.first_like(arm.driven);
                match along.iter_mut().find(|(known, _)| *known == row) {
                    Some((_, sum)) => gaps::add(sum, 1.0, &series),
                    None => along.push((row, series)),
                }
            }
        }
        let sizes = along.into_iter().map(|(row, series)| {
            let pairs = series.get(1..).unwrap_or_default().chunks_exact(2);
            let harmonics = pairs.map(|pair| pair[0].hypot(pair[1]));
            let mean = series.first().copied().unwrap_or(0.0).abs();
            (row, [mean].into_iter().chain(harmonics).collect())
        });
        let mut forces: Vec<(usize, Vec<f64>)> = sizes.collect();
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
        Self {
            amplitudes: forces,
            base,
        }
    }
}

impl<'s> AtOrbit<'s> {
    /// Of a branch of a reduction of a structure.
    pub(crate) fn of(
        reduced: &Reduced,
        structure: &'s SparseStructure,
        branch: &Branch,
        point: &Point,
        cancel: &Cancel,
    ) -> Result<Self, ReducedError> {
        reduced.is_of(structure)?;
        let contacts = structure.contacts.iter().map(|of| &*of.name);
        let outputs = structure.outputs.iter().map(|of| &*of.name);
        let names: Vec<&str> = contacts.chain(outputs).collect();
        let readings = branch.readings(&names, point)?;
        let (contacts, outputs) = readings.split_at(structure.contacts.len());
        let Forces { amplitudes, base } = Forces::of(reduced, structure, branch, point, contacts);
        let of = |value: &Value| value.at(known(branch, point), point.omega());
        let speeds: Vec<f64> = structure.gyroscopic.iter().map(|g| of(&g.speed)).collect();
        let completed = branch.complete(point)?;
        if completed.orbit.coordinates() != reduced.vectors() {
            return Err(ReducedError::Other);
        }
        let arms = structure.contacts.iter().enumerate();
        let arms = arms.map(|(index, contact)| Arm::of(contact, index, [point.omega(), base]));
        let arms: Vec<Vec<Arm>> = arms.collect();
        let gaps = structure.contacts.iter().zip(&arms);
        let gaps = gaps.map(|(contact, arms)| {
            let arguments = contact.arguments.iter().map(of).collect();
            let offset = of(&contact.offset);
            let (law, orbit) = (&*contact.law, &completed.orbit);
            Gap::of(law, arguments, reduced, arms, offset, orbit)
        });
        let harmonics = (1..=HARMONICS).map(|k| k as f64 * base);
        let measured = reduced.measured(structure, harmonics, cancel)?;
        Ok(Self {
            base,
            forces: amplitudes,
            measured,
            doubt: Doubt::of_orbit(reduced, structure, &speeds, base),
            gaps: gaps.collect(),
            arms,
            outputs: outputs.iter().map(|reading| reading.motion).collect(),
            speeds,
        })
    }

    /// What the contacts of a reduced structure do here, which may be a place where the branch turns.
    pub(crate) fn feedback<'r>(&self, reduced: &'r Reduced, at_fold: bool) -> Feedback<'r> {
        let slopes = self.gaps.iter().map(Gap::slopes).collect();
        let damping = doubt::damping(reduced, &self.speeds);
        Feedback::of(reduced, &damping, self.base, slopes, &self.arms, at_fold)
    }

    /// By how much what gaps are made of is off, harmonic by harmonic, without what contacts make of that: rows along which contacts are read,
    /// each once.
    pub(crate) fn off(&self) -> Vec<(usize, Vec<f64>)> {
        let measured = &self.measured;
        let mut rows: Vec<usize> = Vec::new();
        for arm in self.arms.iter().flatten() {
            let row = measured.first_like(arm.read);
            if !rows.contains(&row) {
                rows.push(row);
            }
        }
        let of = |row: usize| {
            let kind = OutputKind::Displacement;
            measured.harmonics_off(row, kind, self.base, &self.forces, &self.doubt)
        };
        rows.into_iter().map(|row| (row, of(row))).collect()
    }
}
