//! Backbone (skeleton) curves: the frequency of free oscillation over its amplitude, and where the damped and driven system is in
//! phase resonance. Each is a [`Branch`](crate::Branch), to be drawn and written as any other; it has no orbits but its own.

mod free;
mod modes;
mod oscillation;
mod resonance;
mod walk;

pub use free::FreeOscillation;
pub use resonance::PhaseResonance;
