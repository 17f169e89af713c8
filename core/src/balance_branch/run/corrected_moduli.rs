//! Moduli of multipliers between two points of a branch, as the verdicts have them.
//!
//! The multipliers of a point are corrected for the harmonics left out, those of orbits between two points are not. What the correction
//! makes of a modulus changes little from one point to the next, so that with `s` from 0 at the one to 1 at the other
//!
//! ```text
//! T(s) = ln | mu_k(s) | + (1 - s) d_0 + s d_1,     d_i = what it makes of ln | mu_k | at either point                (1)
//! ```
//!
//! agrees with the verdicts at both ends: what changes between them is found, and what does not is not.

use nalgebra::Complex;

use super::Run;
use super::event_monitor::EventMonitor;
use crate::balance::resolution::resize;
use crate::branches::moduli;
use crate::branches::point::Point;
use crate::orbit::stability::uncorrected::Uncorrected;

/// Multipliers that may be wrong by more are not compared with one.
const COARSE: f64 = 1e-3;
/// Points between which is looked: those of the last two steps.
const POINTS: usize = 3;

/// What the correction makes of the logarithms of moduli, at points given by their number.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Corrections(Vec<Correction>);

/// What the correction makes of the logarithms at one point.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Correction {
    number: usize,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    moduli: Vec<f64>,
}

impl Corrections {
    /// Whether they are those of the last of so many points, with so many multipliers: they may have been read from a file.
    pub(super) fn are_of(&self, points: usize, multipliers: usize) -> bool {
        let is_one = |own: &Correction| {
            own.number < points
                && [0, multipliers].contains(&own.moduli.len())
                && own.moduli.iter().all(|d| d.is_finite())
        };
        self.0.len() <= POINTS && self.0.iter().all(is_one)
    }

    /// `d` of (1) at a point, given as extended unknowns.
    fn at(
        &mut self,
        number: usize,
        u: &[f64],
        point: &Point,
        multipliers: &mut Uncorrected<'_>,
        place: usize,
    ) -> f64 {
        let known = self.0.iter().position(|other| other.number == number);
        let index = known.unwrap_or_else(|| {
            let corrected = &point.stability.multipliers;
            let plain = multipliers.at(u);
            let of = |place| {
                let d = moduli::logarithm(corrected, place) - moduli::logarithm(plain, place);
                if d.is_finite() { d } else { 0.0 }
            };
            self.0.retain(|other| other.number + POINTS > number);
            self.0.push(Correction {
                number,
                moduli: (0..corrected.len()).map(of).collect(),
            });
            self.0.len() - 1
        });
        self.0[index].moduli.get(place).copied().unwrap_or(0.0)
    }
}

impl<'a> Run<'a> {
    /// (1) at an orbit of one of the last steps, given as extended unknowns; not a number where nothing is known.
    pub(super) fn modulus(&self, monitor: &mut EventMonitor<'a>, at: &[f64], place: usize) -> f64 {
        let first = self.record.points.len().saturating_sub(POINTS);
        let last = &self.record.points[first..];
        let states: Vec<Vec<f64>> = last.iter().map(|point| like(point, at)).collect();
        let here = states.iter().position(|u| u == at);
        if let Some(known) = here.map(|index| &last[index].stability.multipliers)
            && !known.is_empty()
        {
            return moduli::logarithm(known, place);
        }
        let Some(multipliers) = &mut monitor.multipliers else {
            return f64::NAN;
        };
        let plain = moduli::logarithm(multipliers.at(at), place);
        // An orbit beside the chord of a bent step, or corrected once more, may lie a little outside of it.
        let parts = states.windows(2).map(|ends| part(&ends[0], &ends[1], at));
        let outside = |s: f64| (-s).max(s - 1.0).max(0.0);
        let around = parts
            .enumerate()
            .filter(|(_, s)| s.is_finite())
            .min_by(|(_, s), (_, t)| outside(*s).total_cmp(&outside(*t)));
        let Some((index, s)) = around.map(|(index, s)| (index, s.clamp(0.0, 1.0))) else {
            return plain;
        };
        let mut d = |index: usize| {
            let corrections = &mut monitor.corrections;
            let point = &last[index];
            corrections.at(first + index, &states[index], point, multipliers, place)
        };
        plain + (1.0 - s) * d(index) + s * d(index + 1)
    }

    /// Logarithms of the complex multipliers of an orbit with a positive imaginary part, where multipliers are looked at.
    pub(super) fn pairs(
        &self,
        monitor: &mut EventMonitor<'a>,
        at: &[f64],
    ) -> Option<Vec<Complex<f64>>> {
        let multipliers = monitor.multipliers.as_mut()?;
        let last = self.record.points.iter().rev().take(POINTS);
        let here = last.clone().find(|point| like(point, at) == at);
        let known = here.map(|point| &point.stability.multipliers);
        Some(match known.filter(|known| !known.is_empty()) {
            Some(known) => moduli::pairs(known),
            None => moduli::pairs(multipliers.at(at)),
        })
    }

    /// How well multipliers are known along the last step.
    pub(super) fn error_of_multipliers(&self) -> f64 {
        self.last_error().min(COARSE)
    }

    /// The same, however coarse.
    pub(super) fn last_error(&self) -> f64 {
        self.record.last_error(0.0)
    }
}

/// A point as extended unknowns, with as many harmonics as another one.
fn like(point: &Point, other: &[f64]) -> Vec<f64> {
    let mut u = point.orbit.series.clone();
    u.push(point.value);
    let coordinates = point.orbit.coordinates;
    resize(&u, coordinates, (other.len() - 1) / coordinates)
}

/// Where an orbit is along the chord from one to another.
fn part(a: &[f64], b: &[f64], at: &[f64]) -> f64 {
    let (mut along, mut length) = (0.0, 0.0);
    for ((a, b), x) in a.iter().zip(b).zip(at) {
        along += (x - a) * (b - a);
        length += (b - a) * (b - a);
    }
    along / length
}
