//! Programs a user of hertzian would run and copy.
//!
//! A program's `main.rs` only starts it; what it does is here, where tests can call it. To declare and trace an oscillator
//! of one's own, [`response::models`] is the part to copy.

pub mod attractors;
pub mod misplaced;
pub mod model;
pub mod multipliers;
pub mod paper;
pub mod program;
pub mod response;
pub mod values;
pub mod work_precision;
