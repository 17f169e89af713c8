//! Periodic orbits by shooting: a state that returns to itself, found by Newton's method on a [`Flow`](crate::time::Flow).
//!
//! Nothing is left out of an orbit but the error of the flow, which its tolerance bounds; where the flow is in closed form, only
//! rounding. So shooting refines what a balance has found, and follows branches of orbits with their folds and period doublings
//! by the same continuation.

mod at;
mod bend;
mod beyond;
mod checked;
mod companion;
mod compute;
mod crossed;
mod cycle;
mod equations;
mod events;
mod extremes;
mod grazing;
mod halved;
mod method;
mod recurrence;
mod request;
mod run;
mod series;
mod setting;
mod solve;
mod start;
mod switch;
mod tested;
#[cfg(test)]
mod tests;
mod touch;
mod trace;
mod track;
mod watch;

pub use crate::event::Side;
pub use cycle::{Cycle, CycleBranch, CycleEvent, End};
pub use extremes::Extremes;
pub use request::Shooting;
pub use trace::{Special, SpecialKind, Track, TrackEnd, TrackPoint};
