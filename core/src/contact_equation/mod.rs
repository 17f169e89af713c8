//! Periodic orbits by the contact equation: unknown are the forces at a few nodes of each stretch in contact, where stretches begin and
//! end, and the state at one phase. Between contacts the system is linear, and its motion known in closed form.
//!
//! `linear` and `block` have the motion of the linear part, `configuration` that with contacts whose forces are affine, `moving_stiffness` what
//! of the stiffness varies in time, `nodes`, `grading` and `integrals` the integrals over a stretch, `skeleton`, `placement` and `place` which
//! pieces gaps are on and where the unknowns stand, `values`, `targets`, `pass`, `equations` and `eliminated` residuals and derivatives,
//! `motion`, `partway` and `extremes` the motion at any phase. `gaps`, `plan` and `transfer` tell which skeleton an orbit has, `fits` whether
//! it still is right, `ordered` which one it has where switches pass each other, `reading` and `errors` what is read off an orbit, with its
//! errors, `regular` whether it comes back earlier, `guess` where the first one is looked for. `compute`, `run`, `method`, `events` and
//! `touches` are what the engine of branches asks for.
//!
//! Switches are unknowns and solved for. That there are no others is told by extremes of gaps, which are looked for between samples of the
//! motion: see [`extremes`] for what that may miss.
//!
//! Laws are called in `pass`; what their forces do to the motion is integrated in `integrals`.
//!
//! Source: Babitsky (1998), Theory of Vibro-Impact Systems and Applications, section 2.2 (integral equations of contact forces); Gauss
//! collocation as in Hairer, Norsett and Wanner (1993), Solving Ordinary Differential Equations I, section II.7.

mod block;
pub(crate) mod compute;
mod configuration;
mod eliminated;
mod equations;
mod errors;
mod events;
mod extremes;
mod fits;
mod gaps;
mod grading;
mod guess;
mod integrals;
mod linear;
mod method;
mod motion;
mod moving_stiffness;
mod nodes;
mod options;
mod ordered;
mod partway;
mod pass;
mod place;
mod placement;
mod plan;
pub(crate) mod problem;
mod reading;
mod regular;
mod rest;
mod room;
mod run;
mod skeleton;
mod targets;
#[cfg(test)]
mod tests;
mod touches;
mod transfer;
mod values;

pub use options::ContactEquation;
pub(crate) use rest::Rest;
