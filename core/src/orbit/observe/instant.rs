//! Outputs in a state.

use crate::error::Error;
use crate::model::request::RequestError;
use crate::system::System;
use crate::time::signals::{Asked, Signals};

/// The outputs of a system in a state `(q, dq/dt)`, at a phase of its waves and at given values of its parameters: of what motions settle to, say.
/// On a level the piece below counts.
///
/// ```
/// use hertzian::observe::outputs_at;
///
/// hertzian::oscillator! {
///     Stopped(x) {
///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
///         output push = force(stop);
///         output shaking = ddot(x);
///     }
/// }
///
/// let [push, shaking] = outputs_at(&Stopped {}, &[], 0.9, 0.0, &[1.5, 2.0])?[..] else { unreachable!() };
/// assert_eq!(push, 5.0);
/// assert!((shaking - (0.3 - 0.2 - 1.5 - 5.0)).abs() < 1e-14);
/// # Ok::<(), hertzian::Error>(())
/// ```
///
/// # Errors
/// If there are not as many values as parameters, or not as many entries in the state as there must be.
pub fn outputs_at(
    system: &dyn System,
    parameters: &[f64],
    omega: f64,
    phase: f64,
    state: &[f64],
) -> Result<Vec<f64>, Error> {
    let facts = system.facts();
    let (values, expected) = (parameters.len(), facts.parameters.len());
    if values != expected {
        return Err(RequestError::Values { values, expected }.into());
    }
    let (entries, expected) = (state.len(), 2 * facts.coordinates.len());
    if entries != expected {
        return Err(RequestError::State { entries, expected }.into());
    }
    let mut signals = Signals::new(system, parameters, omega, Asked::Outputs);
    let mut pieces = vec![0; facts.contacts.len()];
    signals.place(phase, state, &mut pieces);
    let mut outputs = vec![0.0; signals.count()];
    signals.write(phase, state, &pieces, &mut outputs);
    Ok(outputs)
}
