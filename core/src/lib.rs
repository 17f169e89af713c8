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
//! | curves of periodic orbits, by harmonic balance | [`FrequencyResponse`], which gives a [`Branch`] of [`Point`]s with its [`Event`]s |
//! | the same in the time domain, without truncation | [`FrequencyResponse::by`] with [`Shooting`], which gives a [`Branch`] too: module [`shooting`] |
//! | what an orbit is like: amplitudes, phases, contact, power | [`observe`] |
//! | multipliers by other methods, and what they cost | [`stability`] |
//! | all branches connected by bifurcations | [`Bifurcations`], which gives a [`Diagram`](bifurcation::Diagram) |
//! | curves of bifurcations in two parameters | [`FrequencyResponse::track`], [`Branch::track`] |
//! | free oscillation, phase resonance | [`backbone`] |
//! | motions in time, and what they settle to | [`time`]: histories, sections; [`attractors`]: sweeps, Lyapunov exponents, basins |
//! | derivatives of all of that by parameters | [`sensitivity`]: [`Branch::sensitivities`], [`Branch::event_sensitivities`] |
//! | a structure given as matrices, with contacts | [`structure`], whose laws [`law!`] declares |
//! | pictures and tables | `chart` (feature `plot`), [`export`] |
//! | what can go wrong, and what is unusual about a system | [`error`], [`remarks`] |
//! | the contract of generated code, for systems and laws by hand | [`system`], [`law`](mod@law), [`fourier::series`] |
//! | the same declarations interpreted, or read from text | [`generic`] |
//! | how powers are computed, and on which instruction set | [`power`] |
//!
//! # Features
//!
//! All of them only add something.
//!
//! - `parallel` (default): basins of attraction on several threads.
//! - `plot` (default): draws branches as SVG.
//! - `serde`: results are serialised and read back; branches as JSON, `Branch::write` and `Branch::read`.
//! - `text`: reads declarations from text at run time; brings the compiler in.
//!
//! The matrices and complex numbers of [`nalgebra`] are part of this interface.
//!
//! # Conventions
//!
//! A request takes a copy of the system, with the values that its parameters have at that moment. Requests and results own it: they
//! can be returned from a function and sent to another thread.
//!
//! Time has the unit that the equation has it in; frequencies are angles per time. Orbits are Fourier series, laid out as
//! [`fourier::series`] says, or states along them, by shooting. Nothing panics on the values of parameters or options: what is wrong comes back as an
//! [`Error`] before any work, and a branch that ends early comes back with what was computed and with the reason.
//!
//! The modules [`system`] and [`law`](mod@law) are the contract between generated code and the runtime; a system written by hand
//! against them is as good as a declared one. [`generic`] interprets the same declarations.
#![deny(missing_docs)]
#![warn(missing_debug_implementations)]

// Tests of the rooms call the macros by the name that users have for this crate.
#[cfg(test)]
extern crate self as hertzian;

pub mod attractors;
mod balance;
mod balance_branch;
pub mod bifurcation;
mod branches;
mod cancel;
mod contact_equation;
mod continuation;
pub mod error;
mod event;
#[cfg(doctest)]
mod guide;
pub mod law;
mod laws;
mod model;
mod numeric;
mod orbit;
mod report;
mod response;
pub mod sensitivity;
#[cfg(feature = "serde")]
mod serialise;
pub mod shooting;
pub mod system;
#[cfg(test)]
mod testing;
pub mod time;

pub use balance::aft::Aft;
pub use balance_branch::options::HarmonicBalance;
pub use bifurcation::Bifurcations;
pub use bifurcation::backbone;
pub use branches::branch::{Branch, Model, Named};
pub use branches::error::OrbitError;
pub use branches::leap::Leap;
pub use branches::orbit::Orbit;
pub use branches::point::{Event, Point};
pub use branches::progress::{Progress, Stage};
pub use branches::winding::Winding;
pub use cancel::Cancel;
pub use contact_equation::ContactEquation;
pub use continuation::newton::NewtonError;
pub use continuation::statistics::Statistics;
pub use continuation::stop::Stop;
pub use error::Error;
pub use event::{EventKind, Side, Turn};
#[doc(hidden)]
pub use laws::emitted;
pub use laws::generic;
pub use model::error::ModelError;
pub use model::request::RequestError;
pub use model::valued::with_values;
pub use model::{remarks, structure};
#[doc(no_inline)]
pub use nalgebra::Complex;
pub use numeric::estimate::Estimate;
pub use numeric::{fourier, power};
pub use orbit::stability::{Method, Stability, Verdict};
pub use orbit::{observe, stability};
pub use report::export;
#[doc(hidden)]
pub use response::stages;
pub use response::{Chosen, FrequencyResponse, OrbitMethod, OrbitMethodKind, Resume};
pub use shooting::Shooting;
pub use system::System;

/// Charts as SVG, and what a branch draws on them.
#[cfg(feature = "plot")]
pub mod chart {
    pub use crate::report::band::Band;
    pub use crate::report::picture::event_markers;
    pub use crate::report::view::{Frequency, View};
    pub use hertzian_chart::*;
}

/// Declares a system of oscillators: a type with one public `f64` field per parameter, which implements
/// [`System`].
///
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
///
/// # Grammar
///
/// ```text
/// model       = { doc } [ visibility ] name "(" coordinate { "," coordinate } [ "," ] ")" "{" { item } "}"
/// coordinate  = name [ "[" number "]" ] [ ":" unit ]
/// item        = { doc } ( parameter | law | let | statement | output )
/// parameter   = "param" name [ ":" unit ] [ "=" bound ] [ range ] ";"
/// range       = "in" [ bound ] ( ".." | "..=" ) [ bound ] | ( ">" | ">=" | "<" | "<=" ) bound
/// bound       = [ "-" ] number
/// unit        = factor { ( "*" | "/" ) factor }
/// factor      = ( symbol | "1" | "(" unit ")" ) [ "^" ( bound | "(" bound [ "/" bound ] ")" ) ]
/// law         = "law" name "(" name { "," name } [ "," ] ")" pieces
/// pieces      = "{" ( expression | piece { "," piece } [ "," ] ) "}"
/// piece       = ( condition | "else" ) "=>" expression
/// condition   = chain { "&&" chain }
/// chain       = expression relation expression { relation expression }
/// relation    = ">" | ">=" | "<" | "<="
/// let         = "let" name "=" expression ";"
/// statement   = equation | "for" head "{" { let } { statement } "}"
/// equation    = expression "=" expression ";"
/// output      = "output" name [ ":" unit ] "=" expression ";"
/// head        = name "in" expression ( ".." | "..=" ) expression
/// expression  = product { ( "+" | "-" ) product }
/// product     = signed { ( "*" | "/" ) signed }
/// signed      = ( "-" | "+" ) signed | power
/// power       = operand [ "^" signed ]
/// operand     = number | name | name "[" expression "]" | name "(" expression { "," expression } ")"
///             | "(" expression ")" | "|" expression "|" | "for" head "{" { let } expression "}"
/// ```
///
/// The chapter "Declaring contacts" of the book has an example of each production.
///
/// A power binds tighter than a sign in front of it and to the right: `-x^2` is `-(x^2)`, `2^3^2` is `2^9`. Products need
/// their star: `2*zeta`. Numbers are exact: `1.5` is three halves.
///
/// # Names
///
/// - `omega` is the frequency of excitation, `t` is time, `pi` is the number.
/// - `dot` and `ddot` are the first and second derivative by time.
/// - `H` is the step (one for a positive operand, zero otherwise), `sgn` the sign, `abs(x)` or `|x|` the absolute value.
/// - `cos`, `sin`, `exp`, `tanh` and `sqrt` are what they are everywhere, and so are `max` and `min`, of two operands.
///
/// # Arrays and loops
///
/// `Chain(x[64])` has the coordinates `x[0]` to `x[63]`. A loop around equations repeats them, and a loop around a term
/// is the sum of its repetitions. Both are written out while compiling, so the ends of a range and every index are made
/// of whole numbers, indices of loops, and `let` items that are numbers.
///
/// ```text
/// for j in 1..63 { ddot(x[j]) + contact(x[j] - x[j + 1]) - contact(x[j - 1] - x[j]) = 0; }
/// m*ddot(y) + for j in 0..8 { cos(2*pi*j/8)*contact(y*cos(2*pi*j/8) - clearance) } = 0;
/// ```
///
/// # Defaults and units
///
/// If every parameter has a default (`param k = 1e9;`), the type implements `Default`. If every parameter and every
/// coordinate has a unit, the equations are checked for them; `1` is the unit of a plain number. Exponents of units are
/// exact, as in `N/m^1.5`. A power whose exponent is a parameter has a plain number as its base. Values are used as they
/// are: `mm` and `m` do not agree.
///
/// # Outputs
///
/// What the model is read by: sums of coordinates, of `dot` and `ddot` of them, of forces of laws and of waves of `omega*t`, with
/// coefficients that may depend on parameters and `omega`. `force(law)` is the force of the one contact of a law; a law with several is
/// called as in the equation, with the gap of the one that is meant. A model with units gives an output its unit; one that is written
/// converts it by its power of ten.
///
/// ```text
/// output tip: um = x[9] - x[0];
/// output tooth = force(mesh);
/// ```
///
/// # Equations
///
/// Each coordinate has one equation. What depends on the motion stands on the left; constants and forcing may stand on
/// either side. Forcing is a sum of products of `cos` and `sin` of rational multiples of `omega*t`, with phases
/// (`cos(2/5*omega*t + phi)`) and coefficients that may depend on parameters and `omega`.
///
/// Terms that are linear in the coordinates become mass, damping and stiffness, the stiffness also with harmonic
/// coefficients: `(1 + e*cos(2*omega*t))*x`. All others are forces of a *gap*, a fixed combination of coordinates. They may
/// be written in place, and are grouped by gap:
///
/// ```text
/// ddot(x) + 2*zeta*H(x)*dot(x) + H(x)*sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
/// ```
///
/// # Laws
///
/// A law is a force of its gap, of the rate `dot(gap)` and of arguments, in pieces or as one expression. It may use every
/// parameter. Pieces are bounded by comparisons of the gap with numbers and parameters, and hold every gap once; which
/// level is the higher one follows from the ranges of the parameters.
///
/// ```text
/// param play > 0;
/// law backlash(gap, k) {
///     gap > play  => k*(gap - play),
///     gap < -play => k*(gap + play),
///     else        => 0,
/// }
/// ```
///
/// The gap of a call is linear in the coordinates and may move with time; a factor of the force may as well:
///
/// ```text
/// ddot(x) + cos(omega*t)*contact(x*cos(omega*t) + y*sin(omega*t) - clearance) = 0;
/// ```
///
/// The base of a power that is not whole must not be negative on its piece (`max(0, u)` never is), and where it can vanish
/// the exponent must be positive: declare `param alpha > 0;`. A force may jump where the gap crosses a level. It may not jump with the rate, as
/// dry friction does; it may have a kink there, as `max(0, k*gap + c*dot(gap))` has.
///
/// A force depends on one gap. Polynomials of several coordinates, or of several velocities, are taken apart into powers
/// of sums: `x*y^2` is `((x + y)^3 + (x - y)^3 - 2*x^3)/6`. Other mixtures are refused.
#[macro_export]
macro_rules! oscillator {
    ($($declaration:tt)*) => {
        $crate::emitted::oscillator! { ($crate) $($declaration)* }
    };
}

/// Declares a law without a model: a type without fields that implements [`Law`](law::Law), to be attached to the
/// matrices of a [`Structure`](structure::Structure) while the program runs.
///
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
///
/// # Grammar
///
/// ```text
/// alone       = { doc } [ visibility ] name "(" name { "," argument } [ "," ] ")" pieces
/// argument    = name [ range ]
/// ```
///
/// The first name is that of the gap. `pieces` and `range` are those of [`oscillator!`], with the same rules: an
/// exponent whose base can vanish must be positive, and it must be known which level is the higher one. Here the ranges
/// of the arguments say so, where a law in a model goes by the ranges of the parameters. A structure refuses values
/// outside of them; [`LawFacts`](law::LawFacts) holds them. An argument has neither default nor unit. A law that is linear in gap and
/// rate everywhere is refused: it belongs into the matrices.
#[macro_export]
macro_rules! law {
    ($($declaration:tt)*) => {
        $crate::emitted::law! { ($crate) $($declaration)* }
    };
}

// The twenty lines of the README are run as a test.
#[cfg(all(doctest, feature = "plot"))]
#[doc = include_str!("../../README.md")]
struct Readme;
