//! An orbit as the methods of this room see it.

use crate::balance::Balance;
use crate::balance::aft::Aft;
use crate::model::layout::Layout;
use crate::model::rigid::Rigid;
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
