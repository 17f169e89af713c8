//! The program `hertzian`: curves of periodic orbits, what motions settle to, and measurements, from the command line.
//!
//! `main.rs` only starts it; what it does is here, where tests can call it. A subcommand is a module with its options and a function
//! `start`; [`command`] lists them.

pub mod attractors;
pub mod built_in;
pub mod command;
#[cfg(feature = "explore")]
pub mod explore;
pub mod fit;
mod install;
pub mod look;
pub mod map;
pub mod misplaced;
pub mod model;
pub mod multipliers;
pub mod paper;
pub mod program;
pub mod range;
pub mod response;
pub mod show;
pub mod study;
pub mod values;
pub mod work_precision;
