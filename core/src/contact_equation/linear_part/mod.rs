//! The linear part of the system in closed form: its modes as pairs of states ([`linear`], [`block`], and all of them at once, [`kernels`]), a system
//! at values in these ([`values`]: each [`contact`], each [`wave`] of the load, and what [moves](moving_vector) in them with the phase), and the same
//! while contacts are closed whose forces are affine ([`configuration`]), to as many digits ([`refined`]). Stiffness that varies in time is none of
//! it, and becomes contacts that are always closed ([`moving_stiffness`]).

pub(super) mod block;
pub(super) mod configuration;
pub(super) mod contact;
pub(super) mod kernels;
pub(super) mod linear;
pub(super) mod moving_stiffness;
mod moving_vector;
mod refined;
pub(super) mod values;
pub(super) mod wave;
