//! Structures of many coordinates with few contacts: finite-element models read from files, reduced with a stated error, and
//! followed by [`hertzian`].
//!
//! ```
//! use hertzian::structure::parameter;
//! use hertzian_structure::{Damping, Direction, Load, Reduction, SparseMatrix, SparseStructure};
//!
//! // A bar of a hundred elements, clamped at one end and pulled at the other.
//! let (n, h) = (100, 0.01);
//! let of = |diagonal: f64, beside: f64| {
//!     let entries = (0..n).flat_map(move |i| {
//!         let own = if i + 1 == n { diagonal / 2.0 } else { diagonal };
//!         [(i, i, own), (i, i + 1, beside), (i + 1, i, beside)]
//!     });
//!     SparseMatrix::from_triplets(n, n, entries.filter(|(i, j, _)| i.max(j) < &n))
//! };
//! let (mass, stiffness) = (of(2.0 * h / 3.0, h / 6.0)?, of(2.0 / h, -1.0 / h)?);
//! let bar = SparseStructure::new(mass, stiffness)
//!     .damping(Damping::ratio(0.01))
//!     .load(Load::force(Direction::at(n - 1), parameter("drive", 0.1)))
//!     .output("tip", Direction::at(n - 1));
//! let reduced = Reduction::to(4.0).run(&bar)?;
//! // The exact one is pi / 2.
//! assert!((reduced.frequencies()[0] - 1.5708).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where things are
//!
//! | What is wanted | Where it is |
//! |---|---|
//! | matrices from entries, Matrix Market files, arrays of numpy | [`SparseMatrix`], [`market`], [`npy`] |
//! | what acts on a structure and what it is read by | [`SparseStructure`] |
//! | all of that from one file | [`mod@file`] |
//! | few modes and vectors instead of all coordinates, and what that changes | [`Reduction`], [`Reduced`] |
//!
//! Coordinates are counted from zero, as in numpy.
#![deny(missing_docs)]
#![warn(missing_debug_implementations)]

pub mod file;
pub mod market;
pub mod npy;

mod accuracy;
mod arms;
mod at_orbit;
mod backbone;
mod description;
mod doubt;
mod error;
mod exponent;
mod factor;
mod feedback;
mod floquet;
mod gaps;
mod lanczos;
mod matrix;
mod multipliers;
mod reduced;
mod reduction;

pub use accuracy::{Effects, EffectsAt, OutputError};
pub use description::contact::SparseContact;
pub use description::damping::{Damping, Gyroscopic, Ratios};
pub use description::direction::Direction;
pub use description::load::{Load, LoadKind};
pub use description::output::OutputKind;
pub use description::structure::SparseStructure;
pub use error::StructureError;
pub use matrix::{MatrixError, SparseMatrix};
pub use multipliers::ReducedStability;
pub use reduced::{Reduced, ReducedError};
pub use reduction::{Reduction, ReductionError};
