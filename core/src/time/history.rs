//! Time histories: states at equal distances of phase along a motion.

use std::f64::consts::TAU;

use super::{FlowError, Stretch};
use crate::time::stroboscope::Stroboscope;

/// Shows a motion of so many periods of the declaration to `see`: at its start, and then at equal distances, with so many states in each
/// period. Times are counted in periods of the declaration from the start.
///
/// ```
/// use hertzian::time::history;
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
/// let (mut state, mut positions) = ([0.0, 0.0], Vec::new());
/// let (periods, samples) = (2, 50);
/// history::record(&mut map, &mut state, periods, samples, &mut |_, state| positions.push(state[0]))?;
/// assert_eq!(positions.len(), 101);
/// # Ok::<(), hertzian::Error>(())
/// ```
///
/// # Errors
/// If the motion cannot be continued. What came before has been shown.
pub fn record(
    map: &mut Stroboscope,
    state: &mut [f64],
    periods: usize,
    samples: usize,
    see: &mut dyn FnMut(f64, &[f64]),
) -> Result<(), FlowError> {
    let mut between = state.to_vec();
    let phase = map.start();
    for period in 0..periods {
        let before = period as f64;
        see(before, state);
        let mut next = 1;
        let mut show = |stretch: &dyn Stretch| {
            let end = stretch.phases().1;
            while next < samples {
                let part = next as f64 / samples as f64;
                if phase + TAU * part > end {
                    break;
                }
                stretch.state(phase + TAU * part, &mut between);
                see(before + part, &between);
                next += 1;
            }
        };
        map.show_period(state, &mut show)?;
    }
    see(periods as f64, state);
    Ok(())
}
