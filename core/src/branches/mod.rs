//! Branches of periodic orbits, as data.

pub mod branch;
