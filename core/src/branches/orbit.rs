//! A periodic orbit as data.

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
    /// Whether it was followed as one of odd symmetry: half a period later every coordinate has the opposite sign.
    pub symmetric: bool,
}

impl Orbit {
    /// Fourier series of one coordinate, `[mean, cos 1, sin 1, ...]` in harmonics of the base frequency; `None` if there is no such
    /// coordinate, or the orbit is known by its states alone: [`Branch::complete`](crate::Branch::complete) has the series.
    pub fn series(&self, coordinate: usize) -> Option<&[f64]> {
        (coordinate < self.coordinates && self.has_series()).then(|| self.row(coordinate))
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

    /// The states at the beginnings of the segments, of equal length, that shooting divides the orbit into, or half of it if it is
    /// symmetric: by default one for each period of the declaration. None of an orbit of the balance.
    pub fn states(&self) -> impl Iterator<Item = &[f64]> {
        self.states.chunks_exact(2 * self.coordinates.max(1))
    }
}
