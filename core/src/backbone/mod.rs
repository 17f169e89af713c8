//! Backbone (skeleton) curves: the frequency of free oscillation over its amplitude, and where the damped and driven system is in
//! phase resonance.

mod free;
mod resonance;

pub use free::{FreeOscillation, FreePoint};
pub use resonance::{PhaseResonance, ResonancePoint};
