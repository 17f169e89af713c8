//! The linear part of the system in closed form: its modes as pairs of states ([`linear`], [`block`], and all of them at once, [`kernels`]), a system at values in these
//! ([`values`]), and the same while contacts are closed whose forces are affine ([`configuration`]), to as many digits ([`refined`]). Stiffness that varies in time is none of
//! it, and becomes contacts that are always closed ([`moving_stiffness`]).

pub(super) mod block;
pub(super) mod configuration;
pub(super) mod kernels;
pub(super) mod linear;
pub(super) mod moving_stiffness;
mod refined;
pub(super) mod values;
