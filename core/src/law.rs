//! The contract of a contact law: what the compiler emits and the runtime reads.
//!
//! A law is a force `phi(g, r; a)` of one gap `g`, of its rate `r = dg/dt` and of arguments `a`. *Levels* of the gap divide it into pieces:
//! piece `i` lies between level `i - 1` and level `i`. Inside a piece the force is smooth, except for powers that vanish or are unbounded
//! at its ends. The example of [`system`](crate::system) has a law by hand.

pub use hertzian_contract::law::*;
