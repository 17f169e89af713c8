//! What a user asks of an orbit by names.

use std::f64::consts::TAU;

use super::measure::{Measure, Wanted};
use super::sampler::Sampler;
use super::sum::{Motions, Sum};
use super::waveform::Waveform;
use super::{Motion, amplitudes, phases};
use crate::branches::branch::{Branch, Model, Source};
use crate::branches::observed::Observed;
use crate::branches::point::Point;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::numeric::fourier::series;
use crate::system::System;

/// Samples of a line over a period, at least, and of its shortest wave.
const FEWEST: usize = 400;
const PER_WAVE: usize = 12;

/// A signal over the period of an orbit: an output, a coordinate, or the force of a contact.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Reading {
    /// Its extremes, mean and root of the mean square: those of the signal itself, not of its series.
    pub motion: Motion,
    /// Its Fourier series in harmonics of the orbit, as [`series`](crate::fourier::series) lays it out. Of a signal without forces it is the
    /// signal; that of a force is integrated from switch to switch.
    pub series: Vec<f64>,
    /// The base frequency of the orbit, in radians per unit of time.
    pub base: f64,
}

/// A harmonic of a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SpectrumLine {
    /// Its frequency, in radians per unit of time.
    pub omega: f64,
    /// Its amplitude; of the mean with its sign.
    pub amplitude: f64,
    /// Its phase lag, in radians: it is `amplitude cos(omega t - phase)`.
    pub phase: f64,
}

impl Reading {
    /// The mean and all harmonics, in increasing order.
    pub fn spectrum(&self) -> Vec<SpectrumLine> {
        let lines = amplitudes(&self.series);
        let lines = lines.into_iter().zip(phases(&self.series)).enumerate();
        lines
            .map(|(harmonic, (amplitude, phase))| SpectrumLine {
                omega: harmonic as f64 * self.base,
                amplitude,
                phase,
            })
            .collect()
    }

    /// What is asked of it; `None` of what only a contact has, and not of a harmonic that was not computed.
    pub fn measured(&self, measure: Measure) -> Option<f64> {
        let line = |harmonic: usize| {
            let spectrum = self.spectrum();
            spectrum.get(harmonic).copied()
        };
        match measure {
            Measure::Amplitude(harmonic) => line(harmonic).map(|line| line.amplitude),
            Measure::Phase(harmonic) => line(harmonic).map(|line| line.phase),
            _ => measure.of(&self.motion),
        }
    }
}

/// A coordinate of an orbit whose series are known; `None` of others.
pub(crate) fn of_coordinate(point: &Point, index: usize) -> Option<Reading> {
    let series = point.orbit.series(index)?.to_vec();
    let stored = read_off(&point.observed, Source::Coordinate(index), point.orbit.base);
    Some(Reading {
        motion: stored.unwrap_or_else(|| Motion::of(&series)),
        series,
        base: point.orbit.base,
    })
}

/// A signal of an orbit whose series are known.
///
/// # Errors
/// If the orbit is not one of the system.
pub(crate) fn of_series(
    system: &dyn System,
    point: &Point,
    source: Source,
) -> Result<Reading, Error> {
    let orbit = &point.orbit;
    let Some(motions) = Motions::of(system, &point.parameters, orbit) else {
        let entries = 2 * orbit.coordinates;
        let expected = 2 * system.facts().coordinates.len();
        return Err(RequestError::State { entries, expected }.into());
    };
    let waveform = Waveform::new(&motions, sum_of(&motions, source));
    // What was read off with the orbit is not found a second time, by another search that would differ in the last digit.
    let motion = match read_off(&point.observed, source, orbit.base) {
        Some(known) if known.rms.is_some() => known,
        Some(known) => Motion {
            rms: waveform.motion(&mut Sampler::default()).rms,
            ..known
        },
        None => waveform.motion(&mut Sampler::default()),
    };
    Ok(Reading {
        motion,
        series: waveform.series(orbit.harmonics()),
        base: orbit.base,
    })
}

/// What was read off a signal with the orbit: of the force of a contact all but the root of its mean square.
fn read_off(observed: &Observed, source: Source, base: f64) -> Option<Motion> {
    match source {
        Source::Output(index) => observed.outputs.get(index).copied(),
        Source::Coordinate(index) => observed.read().get(index).copied(),
        Source::Contact(index) => observed.contacts.get(index).map(|contact| Motion {
            maximum: contact.maximum_force,
            minimum: contact.minimum_force,
            mean: contact.impulse.map(|impulse| impulse / (TAU / base)),
            rms: None,
        }),
    }
}

/// A signal of an orbit whose series are known, as times and values over its period: enough of them to be drawn, and both sides of every
/// switch.
///
/// # Errors
/// If the orbit is not one of the system.
pub(crate) fn over_period(
    system: &dyn System,
    point: &Point,
    source: Source,
) -> Result<Vec<[f64; 2]>, Error> {
    let orbit = &point.orbit;
    let Some(motions) = Motions::of(system, &point.parameters, orbit) else {
        let entries = 2 * orbit.coordinates;
        let expected = 2 * system.facts().coordinates.len();
        return Err(RequestError::State { entries, expected }.into());
    };
    let waveform = Waveform::new(&motions, sum_of(&motions, source));
    let count = samples_of(orbit.harmonics());
    let samples = waveform.sampled(count).into_iter();
    Ok(samples.map(|[tau, y]| [tau / orbit.base, y]).collect())
}

/// The same of a coordinate, which takes no system.
pub(crate) fn series_over_period(point: &Point, index: usize) -> Vec<[f64; 2]> {
    let orbit = &point.orbit;
    let (series, count) = (orbit.row(index), samples_of(orbit.harmonics()));
    let at = |i: usize| TAU * i as f64 / count as f64;
    let samples = (0..=count).map(|i| [at(i) / orbit.base, series::value(series, at(i))]);
    samples.collect()
}

/// Samples of a period by which a line is drawn.
fn samples_of(harmonics: usize) -> usize {
    FEWEST.max(PER_WAVE * harmonics)
}

fn sum_of(motions: &Motions<'_>, source: Source) -> Sum {
    match source {
        Source::Coordinate(index) => Sum::series(motions.row(index)),
        Source::Output(index) => motions.output(index),
        Source::Contact(index) => Sum::force(index),
    }
}

impl Branch {
    /// What charts show unless they are asked for something else: peak-to-peak of the first output, if it was read off all orbits; else of
    /// the coordinate that moves most, among those measured in what the first one is.
    pub fn leading(&self) -> Wanted {
        let read = |point: &Point| !point.observed.outputs.is_empty();
        let output = self.model.outputs.first();
        let output = output.filter(|_| self.points.iter().all(read));
        let name = output.map_or_else(|| self.largest_coordinate(), |output| &output.name);
        Wanted {
            name: name.to_owned(),
            measure: Measure::PeakToPeak,
        }
    }

    fn largest_coordinate(&self) -> &str {
        let Model {
            coordinates, units, ..
        } = &self.model;
        let size = |index: usize| {
            let motions = self.points.iter().map(|p| p.observed.motions.get(index));
            motions
                .flatten()
                .map(Motion::peak_to_peak)
                .fold(0.0, f64::max)
        };
        let alike = |index: &usize| units.get(*index) == units.first();
        let mut largest = (0, size(0));
        for index in (1..coordinates.len()).filter(alike) {
            let own = size(index);
            // Coordinates of one motion differ by rounding.
            if own > largest.1 * (1.0 + 1e-6) {
                largest = (index, own);
            }
        }
        coordinates.get(largest.0).map_or("", String::as_str)
    }
}

/// What is known without the system.
pub(crate) fn stored(
    observed: &Observed,
    source: Source,
    measure: Measure,
    base: f64,
) -> Option<f64> {
    if let (true, Source::Contact(index)) = (measure.is_of_contact(), source) {
        let contact = observed.contacts.get(index)?;
        return match measure {
            Measure::Impulse => contact.impulse,
            Measure::Impacts => Some(contact.impacts() as f64),
            Measure::OnPiece(piece) => {
                let parts = observed.on_pieces.get(index)?;
                parts.get(piece.checked_sub(1)?).copied()
            }
            _ => None,
        };
    }
    measure.of(&read_off(observed, source, base)?)
}

impl Model {
    /// Whether there is what can be asked for.
    ///
    /// # Errors
    /// If nothing has that name, or the measure is not one of it.
    pub fn check(&self, wanted: &Wanted) -> Result<(), Error> {
        self.measurable(wanted).map(|_| ())
    }

    /// The unit of an output, a coordinate, or the force of a contact, by its name; empty where there is none.
    pub fn unit_of(&self, name: &str) -> &str {
        match self.source(name) {
            Ok(Source::Output(index)) => &self.outputs[index].unit,
            Ok(Source::Coordinate(index)) => self.units.get(index).map_or("", String::as_str),
            Ok(Source::Contact(index)) => self.force_units.get(index).map_or("", String::as_str),
            Err(_) => "",
        }
    }

    /// The unit of what a branch varies, by its name; empty where there is none.
    pub fn unit_of_varied(&self, name: &str) -> &str {
        let mut parameters = self.parameters.iter();
        match parameters.find(|parameter| parameter.name == name) {
            Some(parameter) => &parameter.unit,
            None if self.units.is_empty() => "",
            None => "rad/s",
        }
    }

    /// What is asked of, if it has what is asked for.
    pub(crate) fn measurable(&self, wanted: &Wanted) -> Result<Source, Error> {
        let source = self.source(&wanted.name)?;
        if wanted.measure.is_of_contact() && !matches!(source, Source::Contact(_)) {
            let measure = wanted.measure.in_words();
            let name = wanted.name.clone();
            return Err(RequestError::NoContactMeasure { name, measure }.into());
        }
        if let (Measure::OnPiece(piece), Source::Contact(index)) = (wanted.measure, source) {
            let pieces = self.pieces.get(index).copied().unwrap_or(0);
            if piece > pieces {
                let name = wanted.name.clone();
                return Err(RequestError::NoPiece {
                    name,
                    piece,
                    pieces,
                }
                .into());
            }
        }
        Ok(source)
    }

    /// What has a name.
    pub(crate) fn source(&self, name: &str) -> Result<Source, Error> {
        let output = self.outputs.iter().position(|output| output.name == name);
        let place = |names: &[String]| names.iter().position(|own| own == name);
        let (coordinate, contact) = (|| place(&self.coordinates), || place(&self.contacts));
        let found = output.map(Source::Output);
        let found = found.or_else(|| coordinate().map(Source::Coordinate));
        let found = found.or_else(|| contact().map(Source::Contact));
        found.ok_or_else(|| {
            let outputs = self.outputs.iter().map(|output| &output.name);
            let names = outputs.chain(&self.coordinates).chain(&self.contacts);
            RequestError::UnknownSignal {
                name: name.to_owned(),
                known: names.cloned().collect(),
            }
            .into()
        })
    }
}
