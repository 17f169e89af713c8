//! Periodic orbits by shooting: a state that returns to itself, found by Newton's method on a [`Flow`](crate::time::Flow).
//!
//! Nothing is left out of an orbit but the error of the flow, which its tolerance bounds; where the flow is in closed form, only
//! rounding. So shooting refines what a balance has found, and follows branches of orbits with their folds and period doublings
//! by the same continuation.
//!
//! `equations` has the equations, `start` the first orbit, `sampled_states` one from a balance, `minimal_period` whether an orbit comes back earlier.
//! `run` takes each orbit of a branch: its multipliers and their stated errors (`Run::read`), by another flow of `error_reference`, its extremes
//! (`extremes`, `gap_extremes`), and what its outputs are (`complete`, `signals`, `output_error`). `method` is what the engine of branches asks for,
//! `test_functions` are what tells events, `events` what is recorded at their zeros. `at`, `branch_switch` and `branch_switch_at_crossing` answer
//! what a branch is asked afterwards (`past_fold`, `broken_symmetry`), `resume_state` is what one goes on from. The folder `bifurcation_curve`
//! follows an event in two parameters.

pub(crate) mod at;
pub(crate) mod bifurcation_curve;
mod branch_switch;
mod branch_switch_at_crossing;
mod broken_symmetry;
pub(crate) mod checked;
mod closed;
pub(crate) mod complete;
pub(crate) mod compute;
mod equations;
mod error_reference;
mod events;
pub(crate) mod extremes;
mod gap_extremes;
mod gap_scan;
mod method;
mod minimal_period;
mod options;
mod output_error;
mod past_fold;
pub(crate) mod problem;
mod resume_state;
mod run;
mod sampled_states;
pub(crate) mod signals;
mod start;
pub(crate) mod test_functions;
#[cfg(test)]
mod tests;

pub(crate) use bifurcation_curve::Plane;
pub use bifurcation_curve::{BifurcationCurve, Special, SpecialKind};
pub(crate) use broken_symmetry::breaks;
pub(crate) use checked::Asked;
pub use options::Shooting;
pub(crate) use resume_state::Rest;
pub(crate) use sampled_states::with_states;
