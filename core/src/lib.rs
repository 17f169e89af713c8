//! Vibration of oscillators with piecewise power-law forces: contacts that open, springs of any exponent, play, stops.
//!
//! [`oscillator!`] turns an equation of motion into a type with public parameters and into specialised code for its forces
//! and their derivatives. [`FrequencyResponse`] follows its periodic orbits as the excitation frequency or a parameter
//! varies, and returns a [`Branch`]: orbits, their [`Stability`], folds, and what it cost.
//!
//! ```
//! use hertzian::FrequencyResponse;
//!
//! hertzian::oscillator! {
//!     Duffing(x) {
//!         /// damping ratio
//!         param zeta in 0.0..;
//!         /// excitation amplitude
//!         param drive;
//!         ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);
//!     }
//! }
//!
//! let model = Duffing { zeta: 0.05, drive: 0.2 };
//! let branch = FrequencyResponse::of(&model).from(0.5).to(2.0).harmonics(7).samples(64).run()?;
//! assert_eq!(branch.folds().count(), 2);
//! # Ok::<(), hertzian::Error>(())
//! ```
//!
//! # Where things are
//!
//! | What is wanted | Where it is |
//! |---|---|
//! | curves of periodic orbits, by harmonic balance | [`FrequencyResponse`], which gives a [`Branch`]: module [`branch`] |
//! | the same in the time domain, without truncation | [`Shooting`], which gives a [`CycleBranch`]: module [`shooting`] |
//! | what an orbit is like: amplitudes, phases, contact, power | [`observe`] |
//! | multipliers by other methods, and what they cost | [`stability`] |
//! | all branches connected by bifurcations | [`Bifurcations`], which gives a [`Diagram`](bifurcation::Diagram) |
//! | curves of bifurcations in two parameters | [`Shooting::track`] |
//! | free oscillation, phase resonance | [`backbone`] |
//! | motions in time, and what they settle to | [`time`]: histories, sections; [`attractors`]: sweeps, Lyapunov exponents, basins |
//! | a structure given as matrices, with contacts | [`structure`], whose laws [`law!`] declares |
//! | pictures and tables | `chart` (feature `plot`), [`export`] |
//! | what can go wrong, and what is unusual about a system | [`error`], [`remarks`] |
//! | the contract of generated code, for systems and laws by hand | [`system`], [`law`](mod@law), [`fourier::series`] |
//! | the same declarations interpreted, or read from text | [`generic`] |
//! | how powers are computed, and how to pin that | [`power`] |
//!
//! # Features
//!
//! All of them only add something.
//!
//! - `parallel` (default): basins of attraction on several threads.
//! - `plot` (default): draws branches as SVG.
//! - `text`: reads declarations from text at run time; brings the compiler in.
//!
//! The matrices and complex numbers of [`nalgebra`] are part of this interface.
//!
//! # Conventions
//!
//! Time has the unit that the equation has it in; frequencies are angles per time. Orbits are Fourier series, laid out as
//! [`fourier::series`] says. Nothing panics on the values of parameters or options: what is wrong comes back as an
//! [`Error`] before any work, and a branch that ends early comes back with what was computed and with the reason.
//!
//! The modules [`system`] and [`law`](mod@law) are the contract between generated code and the runtime; a system written by hand
//! against them is as good as a declared one. [`generic`] interprets the same declarations.
#![deny(missing_docs)]
#![warn(missing_debug_implementations)]

// Generated code names this crate `::hertzian`; inside the crate itself that name must exist too.
extern crate self as hertzian;

pub mod attractors;
mod balance;
pub mod bifurcation;
mod branches;
#[cfg(feature = "plot")]
pub mod chart;
mod continuation;
pub mod error;
mod event;
mod file;
#[cfg(doctest)]
mod guide;
pub mod law;
mod laws;
mod model;
mod numeric;
mod orbit;
mod report;
mod response;
pub mod shooting;
pub mod system;
#[cfg(test)]
mod testing;
pub mod time;

pub use balance::aft::Aft;
pub use bifurcation::Bifurcations;
pub use bifurcation::backbone;
pub use branches::orbit::Orbit;
pub use branches::point::{Event, Point};
pub use continuation::follow::Stop;
pub use continuation::statistics::Statistics;
pub use error::Error;
pub use event::{EventKind, Side, Turn};
#[doc(hidden)]
pub use laws::emitted;
pub use laws::generic;
pub use model::{remarks, structure};
pub use nalgebra::Complex;
pub use numeric::{fourier, power};
pub use orbit::stability::{Method, Stability, Verdict};
pub use orbit::{observe, stability};
pub use report::export;
pub use response::FrequencyResponse;
pub use response::branch::Branch;
#[doc(hidden)]
pub use response::stages;
pub use shooting::{Cycle, CycleBranch, CycleEvent, End, Shooting};
pub use system::System;

/// Computed branches of periodic orbits.
pub mod branch {
    pub use crate::branches::orbit::Orbit;
    pub use crate::branches::point::{Event, Point};
    pub use crate::event::{EventKind, Turn};
    pub use crate::response::branch::Branch;
}

/// ```
/// hertzian::oscillator! {
///     /// One-sided contact spring with damping, loaded and shaken.
///     pub OneSided(x) {
///         /// damping ratio
///         param zeta in 0.0..;
///         /// normal load
///         param load;
///         /// excitation amplitude
///         param drive;
///
///         law contact(gap) {
///             gap > 0 => 2*zeta*dot(gap) + gap^1.5,
///             else    => 0,
///         }
///
///         ddot(x) + contact(x) = drive*cos(omega*t) + load;
///     }
/// }
///
/// let model = OneSided { zeta: 0.032, load: 1.0, drive: 0.1 };
/// let orbit = hertzian::FrequencyResponse::of(&model).orbit(0.5)?;
/// // Far below the resonance the contact stays closed.
/// assert!(orbit.motion().minimum > 0.0);
/// # Ok::<(), hertzian::Error>(())
/// ```
pub use hertzian_macros::oscillator;

/// ```
/// use hertzian::law::{Law, On};
///
/// hertzian::law! {
///     /// Contact whose damping grows with the force, Hunt and Crossley (1975).
///     pub HuntCrossley(gap, k, c, n >= 1) {
///         gap > 0 => k*gap^n*(1 + c*dot(gap)),
///         else    => 0,
///     }
/// }
///
/// let (arguments, gap, rate) = ([2.0, 0.5, 1.5], [4.0, -1.0], [1.0, 1.0]);
/// let mut force = [0.0; 2];
/// HuntCrossley.force(On::AllPieces, &arguments, &gap, &rate, &mut force);
/// assert!((force[0] - 24.0).abs() < 1e-12);
/// assert_eq!(force[1], 0.0);
/// ```
pub use hertzian_macros::law;

// The twenty lines of the README are run as a test.
#[cfg(all(doctest, feature = "plot"))]
#[doc = include_str!("../../README.md")]
struct Readme;
