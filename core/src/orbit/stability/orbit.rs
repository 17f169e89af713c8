//! An orbit as the methods of this room see it.

use crate::balance::Balance;
use crate::balance::aft::Aft;
use crate::balance::gap_series;
use crate::model::layout::{ContactLayout, Layout};
use crate::model::rigid::Rigid;
use crate::numeric::fourier::series;
use crate::system::System;

/// An orbit: the system, its coefficients, and the series of its coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Orbit<'a> {
    pub(crate) system: &'a dyn System,
    pub(crate) layout: &'a Layout,
    pub(crate) coefficients: &'a [f64],
    /// Base frequency.
    pub(crate) base: f64,
    /// Excitation periods per period of the orbit.
    pub(crate) period: usize,
    /// Coordinate by coordinate.
    pub(crate) series: &'a [f64],
    /// How its contact forces were found, and with how many samples where they were sampled.
    pub(crate) aft: Aft,
    pub(crate) samples: usize,
    /// Rigid motions of the system, whose multipliers are known.
    pub(crate) rigid: Option<&'a Rigid>,
}

impl<'a> Orbit<'a> {
    /// Writes the series of a gap.
    pub(super) fn gap(&self, layout: &ContactLayout, gap: &mut Vec<f64>) {
        let length = self.series.len() / self.layout.coordinates;
        let harmonics = length / 2 + layout.gap_harmonic() * self.period;
        let highest = harmonics.max(layout.offset_harmonic() * self.period);
        gap.resize(series::length(highest), 0.0);
        let (coefficients, series) = (self.coefficients, self.series);
        gap_series(layout, coefficients, self.period, series, length, gap);
    }

    /// Writes the levels of a contact's law at its arguments.
    pub(super) fn levels(&self, layout: &ContactLayout, arguments: &[f64], levels: &mut Vec<f64>) {
        let law = self.system.law(layout.law);
        levels.resize(law.facts().levels.len(), 0.0);
        law.levels(arguments, levels);
    }

    /// The orbit with these series, at the variable that the balance was set to last.
    pub(crate) fn of(balance: &'a Balance<'_>, series: &'a [f64]) -> Self {
        Self {
            system: balance.system(),
            layout: balance.layout(),
            coefficients: balance.coefficients(),
            base: balance.base(),
            period: balance.resolution().period,
            series,
            aft: balance.resolution().aft,
            samples: balance.resolution().samples,
            rigid: balance.rigid(),
        }
    }
}
