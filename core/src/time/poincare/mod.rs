//! Poincare sections: where a motion passes a surface `g(tau, state) = 0`, located on its dense output.

mod search;
#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use super::gap::Gap;
use super::stroboscope::Stroboscope;
use super::{FlowError, Stretch};
use crate::error::Error;
use crate::model::layout::Layout;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::system::System;
use search::Search;

/// Which crossings of a surface count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    /// From below to above.
    Rising,
    /// From above to below.
    Falling,
    /// All.
    Both,
}

/// A function of phase and state.
type Function<'a> = dyn Fn(f64, &[f64]) -> f64 + Send + Sync + 'a;

/// A surface in the space of phase and state. Crossings from below to above count, or those that [`falling`](Section::falling) or
/// [`both`](Section::both) asks for.
///
/// ```
/// use hertzian::time::poincare::Section;
/// use hertzian::time::stroboscope::Stroboscope;
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear { drive: 3.0 };
/// let mut map = Stroboscope::of(&model, 1.0)?;
/// let mut state = [0.0, 0.0];
/// let mut crossings = 0;
/// // Once it has settled, the motion passes zero upwards once in each period.
/// (0..20).try_for_each(|_| map.map(&mut state))?;
/// let section = Section::entry(0, 0.0);
/// section.follow(&mut map, &mut state, 5, &mut |_| crossings += 1)?;
/// assert_eq!(crossings, 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Section<'a> {
    function: Box<Function<'a>>,
    direction: Direction,
    /// Entries that a state must have.
    entries: usize,
}

impl std::fmt::Debug for Section<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Section")
            .field("direction", &self.direction)
            .finish_non_exhaustive()
    }
}

/// A crossing of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Crossing<'a> {
    /// Periods since the start.
    pub periods: f64,
    /// Phase, between that of the stroboscope and one period later.
    pub phase: f64,
    /// Coordinates, then their rates.
    pub state: &'a [f64],
    /// Whether `g` rises.
    pub rises: bool,
}

impl<'a> Section<'a> {
    /// The zeros of a continuous function of phase and state.
    pub fn new(function: impl Fn(f64, &[f64]) -> f64 + Send + Sync + 'a) -> Self {
        Self {
            function: Box::new(function),
            direction: Direction::Rising,
            entries: 0,
        }
    }

    /// One entry of the state passes a value: a coordinate, or with `entry >= n` its rate.
    pub fn entry(entry: usize, value: f64) -> Self {
        Self {
            entries: entry + 1,
            ..Self::new(move |_, state| state[entry] - value)
        }
    }

    /// The gap of a contact of a system, counted from zero, passes a value, at given values of the parameters and of `omega`.
    ///
    /// # Errors
    /// If there is no such contact, or the values cannot be used.
    pub fn gap(
        system: &dyn System,
        parameters: &[f64],
        omega: f64,
        contact: usize,
        value: f64,
    ) -> Result<Self, Error> {
        validate::values(system, parameters, omega)?;
        let layout = Layout::of(system);
        let contact = layout.contacts.get(contact).ok_or(RequestError::Option {
            name: "contact",
            value: contact as f64,
            must: "must be the position of a contact, counted from zero",
        })?;
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let base = omega / f64::from(system.facts().divisor);
        let gap = Gap::new(contact, &coefficients, base);
        let distance = move |phase: f64, state: &[f64]| gap.at(phase, state).0 - value;
        Ok(Self {
            entries: 2 * layout.coordinates,
            ..Self::new(distance)
        })
    }

    hertzian_contract::setters! { self:
        /// Crossings from above to below count.
        falling() { self.direction = Direction::Falling }

        /// Crossings of either direction count.
        both() { self.direction = Direction::Both }
    }

    fn counts(&self, rises: bool) -> bool {
        match self.direction {
            Direction::Rising => rises,
            Direction::Falling => !rises,
            Direction::Both => true,
        }
    }

    /// Follows a motion for some periods and shows its crossings, in order.
    ///
    /// A motion that starts on the surface and leaves it has not crossed it.
    ///
    /// # Errors
    /// If the motion cannot be continued, or the function of the surface is not a number: what came before has been shown. If a
    /// state has not the entries that the surface asks for.
    pub fn follow(
        &self,
        map: &mut Stroboscope,
        state: &mut [f64],
        periods: usize,
        see: &mut dyn FnMut(Crossing<'_>),
    ) -> Result<(), FlowError> {
        if state.len() < self.entries || state.len() != map.order() {
            return Err(FlowError::Entries {
                entries: state.len(),
                expected: map.order(),
            });
        }
        let phase = map.start();
        let mut search = Search::new(self, phase, state);
        for period in 0..periods {
            let mut show = |stretch: &dyn Stretch| {
                search.scan(stretch, &mut |at, state, rises| {
                    see(Crossing {
                        periods: period as f64 + (at - phase) / TAU,
                        phase: at,
                        state,
                        rises,
                    });
                });
            };
            map.show_period(state, &mut show)?;
            if let Some(phase) = search.undefined {
                return Err(FlowError::Section { phase });
            }
        }
        Ok(())
    }
}
