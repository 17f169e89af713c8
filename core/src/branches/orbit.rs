//! A periodic orbit as data.

use super::recurrence::{Recurrence, SignedPermutation};
use crate::numeric::fourier::series;

/// A periodic orbit: the Fourier series of its coordinates, as the balance finds them, or states along it, as shooting does; or both.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Orbit {
    /// Coordinate by coordinate, each laid out as in [`series`]; nothing where the series are not known.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) series: Vec<f64>,
    /// States at the beginnings of the segments; nothing where they are not known.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) states: Vec<f64>,
    pub(crate) coordinates: usize,
    /// Excitation frequency.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub omega: f64,
    /// Base frequency: the orbit repeats after `2 pi / base`.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub base: f64,
    /// Number of periods of the declaration (`2 pi divisor / omega`) in its period.
    pub period: usize,
    /// Number of equal parts of its period after each of which it is the same again: one, two where it has odd symmetry, or as many as
    /// a symmetry of the system makes of it, as the passages of alike balls in a bearing. Contacts that are alike are then in each
    /// other's place. The shortest time in which such an orbit comes back is this part of its period.
    pub parts: usize,
    /// Whether it was followed as one of odd symmetry: half a period later every coordinate has the opposite sign.
    pub symmetric: bool,
    /// Which coordinates are in each other's place after a part of the period.
    pub(crate) image: SignedPermutation,
}

/// No request takes longer periods, and no symmetry makes more parts of one.
const MOST_PERIODS: usize = 1000;
const MOST_PARTS: usize = 1 << 20;

impl Orbit {
    /// Fourier series of one coordinate, `[mean, cos 1, sin 1, ...]` in harmonics of the base frequency; `None` if there is no such
    /// coordinate, or the orbit is known by its states alone: [`Branch::complete`](crate::Branch::complete) has the series.
    pub fn series(&self, coordinate: usize) -> Option<&[f64]> {
        (coordinate < self.coordinates && self.has_series()).then(|| self.row(coordinate))
    }

    /// Whether it is one of so many coordinates, and its numbers belong together: they may have been read from a file.
    pub(crate) fn is_of(&self, coordinates: usize) -> bool {
        let row = self.series.len().checked_div(coordinates).unwrap_or(0);
        let series =
            self.series.is_empty() || row % 2 == 1 && row * coordinates == self.series.len();
        coordinates > 0
            && self.coordinates == coordinates
            && (1..=MOST_PERIODS).contains(&self.period)
            && (1..=MOST_PARTS).contains(&self.parts)
            && self.image.is_of(coordinates)
            && series
            && self.states.len().is_multiple_of(2 * coordinates)
            && !(self.series.is_empty() && self.states.is_empty())
    }

    /// How it comes back.
    pub(crate) fn recurrence(&self) -> Recurrence {
        Recurrence {
            period: self.period,
            parts: self.parts,
            image: self.image.clone(),
        }
    }

    pub(crate) fn has_series(&self) -> bool {
        !self.series.is_empty()
    }

    /// The series of a coordinate that there is, where series are known.
    pub(crate) fn row(&self, coordinate: usize) -> &[f64] {
        let length = self.series.len() / self.coordinates;
        &self.series[coordinate * length..][..length]
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of harmonics; zero where the series are not known.
    pub fn harmonics(&self) -> usize {
        if self.has_series() {
            series::harmonics(self.row(0))
        } else {
            0
        }
    }

    /// Position and velocity of one coordinate at a time, from the series; `None` where [`series`](Self::series) is.
    pub fn state_at(&self, coordinate: usize, time: f64) -> Option<(f64, f64)> {
        let row = self.series(coordinate)?;
        let (x, slope, _) = series::value_and_derivatives(row, self.base * time);
        Some((x, self.base * slope))
    }

    /// The state `(q, dq/dt)` at phase zero: all positions, then all velocities.
    pub fn state(&self) -> Vec<f64> {
        if let Some(state) = self.states.get(..2 * self.coordinates) {
            return state.to_vec();
        }
        let at_start = (0..self.coordinates).filter_map(|i| self.state_at(i, 0.0));
        let (positions, velocities): (Vec<f64>, Vec<f64>) = at_start.unzip();
        [positions, velocities].concat()
    }

    /// The states at the beginnings of the segments, of equal length, that shooting divides the orbit into, or one of its
    /// [parts](Self::parts): by default one for each period of the declaration. None of an orbit of the balance.
    pub fn states(&self) -> impl Iterator<Item = &[f64]> {
        self.states.chunks_exact(2 * self.coordinates.max(1))
    }
}
