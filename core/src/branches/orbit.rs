//! A periodic orbit as data.

use crate::numeric::fourier::series;

/// A periodic orbit as Fourier series of its coordinates.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Orbit {
    /// Coordinate by coordinate, each laid out as in [`series`].
    pub(crate) series: Vec<f64>,
    pub(crate) coordinates: usize,
    /// Excitation frequency.
    pub omega: f64,
    /// Base frequency: the orbit repeats after `2 pi / base`.
    pub base: f64,
    /// Number of periods of the declaration (`2 pi divisor / omega`) in its period.
    pub period: usize,
}

impl Orbit {
    /// Fourier series of one coordinate, `[mean, cos 1, sin 1, ...]` in harmonics of the base frequency; `None` if there is no such
    /// coordinate.
    pub fn series(&self, coordinate: usize) -> Option<&[f64]> {
        (coordinate < self.coordinates).then(|| self.row(coordinate))
    }

    /// The series of a coordinate that there is.
    pub(crate) fn row(&self, coordinate: usize) -> &[f64] {
        let length = self.series.len() / self.coordinates;
        &self.series[coordinate * length..][..length]
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of harmonics.
    pub fn harmonics(&self) -> usize {
        series::harmonics(self.row(0))
    }

    /// Position and velocity of one coordinate at a time.
    ///
    /// # Panics
    /// If there is no such coordinate.
    pub fn state(&self, coordinate: usize, time: f64) -> (f64, f64) {
        let (x, slope, _) = series::value_and_derivatives(self.row(coordinate), self.base * time);
        (x, self.base * slope)
    }
}
