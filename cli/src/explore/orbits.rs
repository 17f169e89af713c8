//! All orbits of the branches at a value, with what a panel shows of each: motions, forces over gaps, spectrum, multipliers.

use std::f64::consts::TAU;

use hertzian::error::chain;
use hertzian::export;
use hertzian::observe::Wanted;
use hertzian::system::{Part, Place, System, Wave};
use hertzian::{Branch, Cancel, Error, Point};
use serde::Serialize;

use super::curve::{wanted, word};
use super::fault::Fault;
use super::traced::{Traced, is_cancelled};
use crate::response::value::of_varied;

/// Coordinates and contacts that are shown, at most.
const SHOWN: usize = 8;
/// Orbits at one value, at most: a diagram may have many branches.
const MOST: usize = 24;
/// A force that is a smaller part of the largest one is none.
const NO_FORCE: f64 = 1e-9;

/// What there is at a value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Orbits {
    /// The value of what varies.
    pub value: f64,
    /// The same as it is said.
    pub said: String,
    /// The orbits, branch by branch.
    pub orbits: Vec<Shown>,
    /// What could not be computed, and what is not shown.
    pub notes: Vec<String>,
}

/// An orbit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// Number of its branch.
    pub branch: usize,
    /// `stable`, `unstable` or `undecided`.
    pub verdict: &'static str,
    /// As `hertzian response --at` says it.
    pub said: String,
    /// What is drawn, in words.
    pub measured: String,
    /// What is drawn.
    pub size: Option<f64>,
    /// Relative error of its size, where it is known.
    pub error: Option<f64>,
    /// Period in periods of the declaration.
    pub periods: usize,
    /// The time after which it comes back.
    pub duration: f64,
    /// Frequency of the excitation.
    pub omega: f64,
    /// Floquet multipliers, real and imaginary part.
    pub multipliers: Vec<[f64; 2]>,
    /// The error that is stated of them; nothing where it is not known.
    pub multiplier_error: Option<f64>,
    /// The coordinates.
    pub motions: Vec<Motion>,
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// Name of the signal whose spectrum it is.
    pub signal: String,
    /// Frequencies and amplitudes.
    pub spectrum: Vec<[f64; 2]>,
}

/// A coordinate over the period.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Motion {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Times.
    pub times: Vec<f64>,
    /// Positions.
    pub positions: Vec<f64>,
    /// Velocities.
    pub velocities: Vec<f64>,
}

/// A contact over the period.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contact {
    /// Its name.
    pub name: String,
    /// Unit of its force.
    pub unit: String,
    /// Times, both sides of every switch.
    pub times: Vec<f64>,
    /// Forces.
    pub forces: Vec<f64>,
    /// Gaps.
    pub gaps: Vec<f64>,
    /// Stretches of time with a force.
    pub closed: Vec<[f64; 2]>,
    /// Of a contact of one coordinate that does not move: that coordinate, the factor of its gap, and where the gap is zero.
    pub surface: Option<(usize, f64, f64)>,
}

/// All orbits at a value.
///
/// # Errors
/// If the value is no number, what is drawn is nothing of this model, or the work was cancelled.
pub fn at(traced: &Traced, value: f64, plot: &str, cancel: &Cancel) -> Result<Orbits, Fault> {
    let mut found = Orbits {
        value,
        said: export::plain(value).to_string(),
        orbits: Vec::new(),
        notes: Vec::new(),
    };
    let Some(first) = traced.branches().next() else {
        return Ok(found);
    };
    found.said = of_varied(first, export::plain(value));
    let wanted = wanted(plot, first)?;
    for (number, branch) in traced.branches().enumerate() {
        let points = match branch.at(value) {
            Ok(points) => points,
            Err(error) if is_cancelled(&error) => return Err(error.into()),
            Err(error) => {
                let text = format!("branch {}: {}", number + 1, chain(&error));
                found.notes.push(text);
                continue;
            }
        };
        for point in &points {
            if cancel.is_cancelled() {
                return Err(Fault::cancelled());
            }
            if found.orbits.len() == MOST {
                found
                    .notes
                    .push(format!("there are more than {MOST} orbits here"));
                return Ok(found);
            }
            match show(branch, number, point, &wanted) {
                // In what the first branch is measured in, as the command does.
                Ok(shown) => found.orbits.push(Shown {
                    said: first.describe_size(point),
                    ..shown
                }),
                Err(error) => found.notes.push(chain(&error).to_string()),
            }
        }
    }
    for (what, names) in [
        ("coordinates", &first.model.coordinates),
        ("contacts", &first.model.contacts),
    ] {
        if names.len() > SHOWN && !found.orbits.is_empty() {
            let count = names.len();
            found
                .notes
                .push(format!("the first {SHOWN} of {count} {what} are shown"));
        }
    }
    if found.orbits.is_empty() && found.notes.is_empty() {
        let note = format!("no branch passes {} = {}", traced.asked.varied, found.said);
        found.notes.push(note);
    }
    Ok(found)
}

fn show(branch: &Branch, number: usize, point: &Point, wanted: &Wanted) -> Result<Shown, Error> {
    let whole = &branch.complete(point)?;
    let reading = branch.reading(&wanted.name, whole)?;
    let contacts = match branch.system() {
        Some(system) => contacts(branch, system, whole)?,
        None => Vec::new(),
    };
    let stability = &point.stability;
    let finite = |value: f64| value.is_finite().then_some(value);
    Ok(Shown {
        branch: number,
        verdict: word(stability.verdict),
        said: branch.describe_size(point),
        measured: branch.describe_measured(&wanted.to_string(), point)?,
        size: branch.measured(wanted, point)?.and_then(finite),
        error: point.error.and_then(finite),
        periods: point.orbit.period,
        duration: TAU / whole.orbit.base,
        omega: whole.orbit.omega,
        multipliers: stability.multipliers.iter().map(|m| [m.re, m.im]).collect(),
        multiplier_error: finite(stability.error),
        motions: motions(branch, whole)?,
        contacts,
        signal: wanted.name.clone(),
        spectrum: reading
            .spectrum()
            .iter()
            .map(|line| [line.omega, line.amplitude])
            .collect(),
    })
}

fn motions(branch: &Branch, point: &Point) -> Result<Vec<Motion>, Error> {
    let names = branch.model.coordinates.iter().enumerate().take(SHOWN);
    names
        .map(|(index, name)| {
            let wave = branch.waveform(name, point)?;
            let times: Vec<f64> = wave.iter().map(|[time, _]| *time).collect();
            let states = times
                .iter()
                .map(|time| point.orbit.state_at(index, *time).unwrap_or_default());
            let (positions, velocities) = states.unzip();
            Ok(Motion {
                name: name.clone(),
                unit: branch.model.unit_of(name).to_owned(),
                times,
                positions,
                velocities,
            })
        })
        .collect()
}

fn contacts(branch: &Branch, system: &dyn System, point: &Point) -> Result<Vec<Contact>, Error> {
    let facts = system.facts();
    let mut coefficients = vec![0.0; facts.places.len()];
    system.coefficients(&point.parameters, point.orbit.omega, &mut coefficients);
    let gap = |contact: usize, time: f64| -> f64 {
        let phase = point.orbit.omega * time / f64::from(facts.divisor);
        let terms = facts.places.iter().zip(&coefficients);
        let terms = terms.map(|(place, value)| match *place {
            Place::GapDirection {
                contact: own,
                column,
                wave,
            } if own == contact => {
                let position = point.orbit.state_at(column, time).unwrap_or_default().0;
                value * wave_at(wave, phase) * position
            }
            Place::Offset { contact: own, wave } if own == contact => -value * wave_at(wave, phase),
            _ => 0.0,
        });
        terms.sum()
    };
    let names = branch.model.contacts.iter().enumerate().take(SHOWN);
    names
        .map(|(index, name)| {
            let wave = branch.waveform(name, point)?;
            let times: Vec<f64> = wave.iter().map(|[time, _]| *time).collect();
            Ok(Contact {
                name: name.clone(),
                unit: branch.model.unit_of(name).to_owned(),
                gaps: times.iter().map(|time| gap(index, *time)).collect(),
                forces: wave.iter().map(|[_, force]| *force).collect(),
                closed: closed(&wave),
                surface: surface(system, index, &coefficients),
                times,
            })
        })
        .collect()
}

/// The value of a wave at a phase.
fn wave_at(wave: Wave, phase: f64) -> f64 {
    let angle = f64::from(wave.harmonic) * phase;
    match wave.part {
        Part::Cosine => angle.cos(),
        Part::Sine => angle.sin(),
    }
}

/// Stretches of time with a force.
fn closed(wave: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let largest = wave
        .iter()
        .fold(0.0_f64, |m, [_, force]| m.max(force.abs()));
    let mut stretches: Vec<[f64; 2]> = Vec::new();
    for pair in wave.windows(2) {
        let [[from, a], [to, b]] = [pair[0], pair[1]];
        if to <= from || a.abs().max(b.abs()) <= NO_FORCE * largest || largest == 0.0 {
            continue;
        }
        match stretches.last_mut() {
            Some(last) if last[1] >= from => last[1] = to,
            _ => stretches.push([from, to]),
        }
    }
    stretches
}

/// Of a contact whose gap is one coordinate times a factor, less a distance: which, the factor, and where the gap is zero.
fn surface(system: &dyn System, contact: usize, coefficients: &[f64]) -> Option<(usize, f64, f64)> {
    let (mut of, mut offset) = (None, 0.0);
    for (place, &value) in system.facts().places.iter().zip(coefficients) {
        let wave = match *place {
            Place::GapDirection {
                contact: own,
                column,
                wave,
            } if own == contact && value != 0.0 => {
                let known: &mut (usize, f64) = of.get_or_insert((column, 0.0));
                if known.0 != column {
                    return None;
                }
                known.1 += value;
                wave
            }
            Place::Offset { contact: own, wave } if own == contact && value != 0.0 => {
                offset += value;
                wave
            }
            _ => continue,
        };
        if wave != Wave::CONSTANT {
            return None;
        }
    }
    let (coordinate, factor) = of.filter(|(_, factor)| *factor != 0.0)?;
    Some((coordinate, factor, offset / factor))
}
