//! Branches of periodic orbits, as data.

pub(crate) mod orbit;
pub(crate) mod point;
