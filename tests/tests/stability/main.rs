//! Multipliers and verdicts against orbits that are known better.

mod draw;
mod orbits;
mod truth;
