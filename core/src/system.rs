//! The contract of a system: its equations of motion.
//!
//! For coordinates `q`, the phase `tau = omega t / divisor` and parameters `p`, with a prime for a derivative by *time*:
//!
//! ```text
//! M q'' + C q' + K(tau) q + sum_c e_c(tau) phi_c(g_c, g_c'; a_c) = sum_h ( a_h cos h tau + b_h sin h tau )      (1)
//! g_c  = d_c(tau) . q - delta_c(tau)                                                                          (2)
//! g_c' = the total derivative of g_c with respect to time                                                      (3)
//! ```
//!
//! Everything but the laws is a list of scalar *coefficients*: functions of the parameters and of `omega`, each with a [`Place`] in the
//! equations. Two methods evaluate the whole list and its derivative; nothing else of a system needs code.
//!
//! # By hand
//!
//! [`oscillator!`](crate::oscillator) writes all of this. A system by hand is for what the language does not have; here it is a Duffing
//! oscillator, `x'' + 2 zeta x' + x + x^3 = drive cos(omega t)`, and it has the orbits of the declared one:
//!
//! ```
//! use std::sync::Arc;
//!
//! use hertzian::FrequencyResponse;
//! use hertzian::law::{Derivatives, Law, LawFacts, On, Parts, PieceFacts, RateDependence, Variation};
//! use hertzian::system::{ContactFacts, ParameterFacts, Place, System, SystemFacts, Variable, Wave};
//!
//! /// The force `x^3`.
//! #[derive(Clone)]
//! struct Cube(LawFacts);
//!
//! impl Law for Cube {
//!     fn facts(&self) -> &LawFacts {
//!         &self.0
//!     }
//!
//!     // One piece has no levels.
//!     fn levels(&self, _: &[f64], _: &mut [f64]) {}
//!     fn levels_by(&self, _: &[f64], _: usize, _: &mut [f64]) {}
//!
//!     fn force(&self, _: On, _: &[f64], gap: &[f64], _: &[f64], force: &mut [f64]) {
//!         for (force, x) in force.iter_mut().zip(gap) {
//!             *force = x * x * x;
//!         }
//!     }
//!
//!     fn derivatives(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], out: Derivatives<'_>) {
//!         self.force(on, arguments, gap, rate, out.force);
//!         for (by_gap, x) in out.by_gap.iter_mut().zip(gap) {
//!             *by_gap = 3.0 * x * x;
//!         }
//!         out.by_rate.fill(0.0);
//!     }
//!
//!     // It has no arguments, so that this is never asked for.
//!     fn derivatives_and_by(
//!         &self,
//!         _: usize,
//!         on: On,
//!         arguments: &[f64],
//!         gap: &[f64],
//!         rate: &[f64],
//!         out: Derivatives<'_>,
//!         by_argument: &mut [f64],
//!     ) {
//!         self.derivatives(on, arguments, gap, rate, out);
//!         by_argument.fill(0.0);
//!     }
//!
//!     fn parts(&self) -> Option<Parts<'_>> {
//!         None
//!     }
//! }
//!
//! #[derive(Clone)]
//! struct Duffing {
//!     facts: SystemFacts,
//!     law: Cube,
//!     /// `zeta` and `drive`
//!     values: [f64; 2],
//! }
//!
//! impl Duffing {
//!     fn new(zeta: f64, drive: f64) -> Self {
//!         let (row, column, contact, wave) = (0, 0, 0, Wave::CONSTANT);
//!         let facts = SystemFacts::new("Duffing")
//!             .coordinates(["x"])
//!             .parameters(["zeta", "drive"].map(ParameterFacts::new))
//!             .contacts(1, [ContactFacts::new(0)])
//!             .places([
//!                 Place::Mass { row, column },
//!                 Place::Damping { row, column },
//!                 Place::Stiffness { row, column, wave },
//!                 Place::Load { row, wave: Wave::cosine(1) },
//!                 Place::ForceDirection { contact, row, wave },
//!                 Place::GapDirection { contact, column, wave },
//!             ]);
//!         let piece = PieceFacts::smooth(0).slopes(Variation::Varying, Variation::Zero);
//!         let law = LawFacts::new("cube", [], [piece]).rate(RateDependence::None).odd(true);
//!         Self { facts, law: Cube(law), values: [zeta, drive] }
//!     }
//! }
//!
//! impl System for Duffing {
//!     fn facts(&self) -> &SystemFacts {
//!         &self.facts
//!     }
//!
//!     fn values(&self, values: &mut [f64]) {
//!         values.copy_from_slice(&self.values);
//!     }
//!
//!     // In the order of the places.
//!     fn coefficients(&self, parameters: &[f64], _: f64, coefficients: &mut [f64]) {
//!         coefficients.copy_from_slice(&[1.0, 2.0 * parameters[0], 1.0, parameters[1], 1.0, 1.0]);
//!     }
//!
//!     fn coefficients_by(&self, variable: Variable, _: &[f64], _: f64, derivatives: &mut [f64]) {
//!         derivatives.fill(0.0);
//!         match variable {
//!             Variable::Parameter(0) => derivatives[1] = 2.0,
//!             Variable::Parameter(_) => derivatives[3] = 1.0,
//!             Variable::Omega => {}
//!         }
//!     }
//!
//!     fn law(&self, _: usize) -> &dyn Law {
//!         &self.law
//!     }
//!
//!     fn shared(&self) -> Arc<dyn System> {
//!         Arc::new(self.clone())
//!     }
//! }
//!
//! hertzian::oscillator! {
//!     Declared(x) {
//!         param zeta;
//!         param drive;
//!         ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);
//!     }
//! }
//!
//! let by_hand = FrequencyResponse::of(&Duffing::new(0.05, 0.2)).orbit(1.2)?;
//! let declared = FrequencyResponse::of(&Declared { zeta: 0.05, drive: 0.2 }).orbit(1.2)?;
//! assert!((by_hand.peak_to_peak() / declared.peak_to_peak() - 1.0).abs() < 1e-9);
//! # Ok::<(), hertzian::Error>(())
//! ```
//!
//! Facts are made by constructors, so that such a system compiles against later versions too. What is said of a law has to be true: an
//! exponent that is not there, or a level at which the force jumps without a word, is a wrong result and no error.

pub use hertzian_contract::system::*;
