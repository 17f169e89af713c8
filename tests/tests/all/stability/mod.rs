//! Multipliers and verdicts against orbits that are known better.

mod draw;
mod exact;
mod orbits;
mod sharp;
mod truncation;
mod truth;
mod two_masses;
