//! The stroboscopic map: the state after one period of the declaration, or after several.

use std::f64::consts::TAU;

use super::{Flow, FlowError, See, Tangent, Work};
use crate::error::Error;
use crate::system::{System, Variable};
use crate::time;

/// Of the flow, where none is asked for.
const TOLERANCE: f64 = 1e-10;

/// The map from a state at one phase to the state a whole number of periods later.
///
/// A period is that of the declaration, `2 pi divisor / omega`.
///
/// ```
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
/// for _ in 0..100 {
///     map.map(&mut state)?;
/// }
/// // The amplitude of the cosine: 3 (4 - 1) / ((4 - 1)^2 + 0.2^2)
/// assert!((state[0] - 9.0 / 9.04).abs() < 1e-12);
/// # Ok::<(), hertzian::Error>(())
/// ```
pub struct Stroboscope {
    flow: Box<dyn Flow>,
    phase: f64,
    every: usize,
    periods: u64,
}

impl std::fmt::Debug for Stroboscope {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stroboscope")
            .field("phase", &self.phase)
            .field("every", &self.every)
            .field("periods", &self.periods)
            .finish_non_exhaustive()
    }
}

impl Stroboscope {
    /// The map of a system at a frequency, at the values that its parameters have, over one period, from phase zero.
    ///
    /// # Errors
    /// As [`time::of`], with a tolerance of `1e-10`.
    pub fn of(system: &dyn System, omega: f64) -> Result<Self, Error> {
        Ok(Self::new(time::of(system, omega, TOLERANCE)?))
    }

    /// The map of a flow over one period, from phase zero.
    pub fn new(flow: Box<dyn Flow>) -> Self {
        Self {
            flow,
            phase: 0.0,
            every: 1,
            periods: 0,
        }
    }

    hertzian_contract::setters! { self:
        /// Looks at the states at another phase.
        phase(phase: f64) { self.phase = phase }

        /// Looks every so many periods.
        every(periods: usize) { self.every = periods.max(1) }
    }

    /// Periods of one application.
    pub(crate) fn stride(&self) -> usize {
        self.every
    }

    /// Entries of a state.
    pub fn order(&self) -> usize {
        2 * self.flow.coordinates()
    }

    /// Changes the frequency or a parameter.
    ///
    /// # Errors
    /// If there is no such parameter, the value is outside its declared range, or the equations could not be evaluated. The map
    /// is then as before.
    pub fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        if !self.flow.admits(variable, value) {
            return Err(FlowError::Value { variable, value });
        }
        self.flow.set(variable, value)
    }

    /// The phase at which states are looked at.
    pub fn start(&self) -> f64 {
        self.phase
    }

    /// The work that its flow has done.
    pub(crate) fn work(&self) -> Work {
        self.flow.work()
    }

    /// How many periods have been computed.
    pub fn periods(&self) -> u64 {
        self.periods
    }

    /// Maps a state.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub fn map(&mut self, state: &mut [f64]) -> Result<(), FlowError> {
        self.advance(state, None, None)
    }

    /// Maps a state, and its derivatives with it.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub fn map_with(&mut self, state: &mut [f64], tangent: &mut Tangent) -> Result<(), FlowError> {
        self.advance(state, Some(tangent), None)
    }

    /// The image of a state under some maps; the tangent comes out as the derivatives of that by the state, and by the parameters that it has.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(crate) fn linearised(
        &mut self,
        state: &[f64],
        times: usize,
        tangent: &mut Tangent,
    ) -> Result<Vec<f64>, FlowError> {
        tangent.columns.fill(0.0);
        for i in 0..state.len() {
            tangent.columns[i * state.len() + i] = 1.0;
        }
        let mut image = state.to_vec();
        for _ in 0..times {
            self.map_with(&mut image, tangent)?;
        }
        Ok(image)
    }

    /// Maps a state, and everything that a flow can move and show with it.
    pub(crate) fn advance(
        &mut self,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        self.pass(self.every, state, tangent, see)
    }

    /// Moves a state over one period and shows it, however many the map is over.
    pub(crate) fn show_period(&mut self, state: &mut [f64], see: See<'_>) -> Result<(), FlowError> {
        self.pass(1, state, None, Some(see))
    }

    /// Moves a state over one of so many parts of a period, from where the map begins.
    pub(crate) fn pass_part(&mut self, parts: usize, state: &mut [f64]) -> Result<(), FlowError> {
        let end = self.phase + TAU / parts as f64;
        self.flow.advance(self.phase, end, state, None, None)
    }

    fn pass(
        &mut self,
        periods: usize,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        self.periods += periods as u64;
        // The phase does not grow with the number of periods, so that a state returns to itself to the last bit.
        let end = self.phase + TAU * periods as f64;
        self.flow.advance(self.phase, end, state, tangent, see)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::one_sided::one_sided;
    use crate::time::affine::Affine;

    #[test]
    fn several_periods_at_once_are_the_same() {
        let model = one_sided(1.0);
        let map = || {
            let flow = Affine::new(&model, &[0.032, 1.0, 1.0], 1.0).expect("affine");
            Stroboscope::new(Box::new(flow)).phase(0.5)
        };
        let (mut one, mut three) = ([-2.0, 0.0], [-2.0, 0.0]);
        let mut by_one = map();
        (0..3).for_each(|_| by_one.map(&mut one).expect("a motion"));
        map().every(3).map(&mut three).expect("a motion");
        assert!((one[0] - three[0]).hypot(one[1] - three[1]) < 1e-12);
        assert_eq!(by_one.periods(), 3);
    }
}
