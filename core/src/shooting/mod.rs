//! Periodic orbits by shooting: a state that returns to itself, found by Newton's method on a [`Flow`](crate::time::Flow).
//!
//! Nothing is left out of an orbit but the error of the flow, which its tolerance bounds; where the flow is in closed form, only
//! rounding. So shooting refines what a balance has found, and follows branches of orbits with their folds and period doublings
//! by the same continuation.

pub(crate) mod at;
pub(crate) mod bifurcation_curve;
mod broken_symmetry;
pub(crate) mod checked;
mod codimension_one;
pub(crate) mod complete;
pub(crate) mod compute;
mod crossed;
mod equations;
mod error_reference;
mod events;
pub(crate) mod extremes;
mod gap_extremes;
mod gap_scan;
mod generalised_flip;
mod grazing_condition;
mod method;
mod minimal_period;
mod normal_form;
mod options;
mod output_error;
mod past_fold;
pub(crate) mod problem;
pub(crate) mod reading;
mod rest;
mod run;
mod sampled_states;
mod special_monitor;
mod special_search;
mod start;
mod switch;
pub(crate) mod tested;
#[cfg(test)]
mod tests;

pub(crate) use bifurcation_curve::Plane;
pub use bifurcation_curve::{BifurcationCurve, BifurcationCurvePoint, Special, SpecialKind};
pub(crate) use broken_symmetry::breaks;
pub(crate) use checked::Asked;
pub use options::Shooting;
pub(crate) use rest::Rest;
pub(crate) use sampled_states::with_states;
