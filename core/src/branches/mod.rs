//! Branches of periodic orbits, as data.

pub(crate) mod error;
pub(crate) mod observed;
pub(crate) mod orbit;
pub(crate) mod point;
pub(crate) mod stability;
