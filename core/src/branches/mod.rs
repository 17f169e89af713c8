//! Branches of periodic orbits: as data, and what follows them, whichever method computes the orbits.

pub(crate) mod branch;
pub(crate) mod branch_start;
pub(crate) mod checkpoint;
pub(crate) mod engine;
pub(crate) mod error;
pub(crate) mod extreme;
mod guess;
pub(crate) mod leap;
pub(crate) mod moduli;
pub(crate) mod observed;
pub(crate) mod orbit;
pub(crate) mod point;
pub(crate) mod problem;
pub(crate) mod progress;
pub(crate) mod record;
pub(crate) mod recurrence;
pub(crate) mod request;
pub(crate) mod solve;
pub(crate) mod stability;
pub(crate) mod value;
pub(crate) mod winding;
