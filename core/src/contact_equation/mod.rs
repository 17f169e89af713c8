//! Periodic orbits by the contact equation: unknown are the forces at a few nodes of each stretch in contact, where stretches begin and
//! end, and the state at one phase. Between contacts the system is linear, and its motion known in closed form.
//!
//! The folders in the order in which they build on each other:
//!
//! | folder | what is in it |
//! |---|---|
//! | [`linear_part`] | the motion of the linear part, and of it with contacts whose forces are affine |
//! | [`collocation`] | nodes of a stretch, and integrals of the polynomials through forces at them |
//! | [`skeleton`] | which pieces gaps are on, where the unknowns stand, and where intervals begin and end |
//! | [`equations`] | residuals and derivatives, by one pass over the orbit |
//! | [`orbit`] | the motion at any phase, extremes of coordinates and gaps |
//! | [`run`] | what a branch has gathered and goes on with |
//! | [`reading`] | points with multipliers and errors, whether an orbit comes back earlier than asked for |
//! | [`switches`] | which switches an orbit has, whether they fit, equations with others |
//! | [`branch`] | what the engine of branches asks for: events, extremes of gaps; how a branch is resumed |
//!
//! [`problem`] is what was asked for, [`options`] how, [`guess`] where an orbit is looked for, and [`compute`] begins: one orbit, or a branch; [`at`] has the orbits
//! of a branch at a value, [`completed`] orbits with everything that is read off; [`march`] is how motions are guessed.
//!
//! Switches are unknowns and solved for. That there are no others is told by extremes of gaps, which are looked for between samples of the
//! motion: see [`extremes`](orbit::extremes) for what that may miss.
//!
//! Laws are called in `equations/pass.rs`; what their forces do to the motion is integrated in `equations/integrals.rs`.
//!
//! Source: Babitsky (1998), Theory of Vibro-Impact Systems and Applications, section 2.2 (integral equations of contact forces); Gauss
//! collocation as in Hairer, Norsett and Wanner (1993), Solving Ordinary Differential Equations I, section II.7.

pub(crate) mod at;
mod branch;
mod collocation;
pub(crate) mod completed;
pub(crate) mod compute;
mod equations;
mod guess;
mod linear_part;
mod march;
mod options;
mod orbit;
pub(crate) mod problem;
mod reading;
mod run;
mod skeleton;
mod switches;
#[cfg(test)]
mod tests;

pub(crate) use branch::resume_state::Rest;
pub use options::ContactEquation;
