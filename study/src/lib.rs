//! Studies: thousands of variants of a model, on threads, in parts on many machines, as one table.
//!
//! A design is not one curve. A [`Study`] has a model, its variants (a grid, a list, a Latin hypercube, the sequence of Sobol, or
//! distributions), what is computed of each, and what is kept. Rows are equal bit for bit for any number of threads or parts, and a run that
//! was killed goes on where it was: each block of variants is a file that is whole or not there.
//!
//! ```no_run
//! use std::ops::ControlFlow;
//!
//! use hertzian_study::{Folder, Request, Runner, Spread, Study, Variants};
//!
//! hertzian::oscillator! {
//!     OneSided(x) {
//!         param zeta = 0.032 in 0.0..;
//!         param drive = 0.1;
//!         law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
//!         ddot(x) + contact(x) = drive*cos(omega*t) + 1;
//!     }
//! }
//!
//! let variants = Variants::sobol(1000)
//!     .over("zeta", Spread::uniform(0.02, 0.05))
//!     .over("drive", Spread::normal(0.1, 0.005));
//! let study = Study::of(&OneSided::default())
//!     .variants(variants)
//!     .request(Request::response(0.6, 1.6))
//!     .prepare()?;
//! let folder = Folder::open("folds", &study)?;
//! Runner::new(&study, &folder).run(&mut |_| ControlFlow::Continue(()))?;
//! println!("{}", study.merge(&[folder])?);
//! # Ok::<(), hertzian_study::StudyError>(())
//! ```

mod builders;
mod checks;
mod design;
mod error;
mod evaluate;
mod folder;
#[cfg(any(feature = "mpi", test))]
mod hand_out;
mod merge;
#[cfg(feature = "mpi")]
mod mpi;
mod names;
#[cfg(feature = "parquet")]
mod parquet;
mod pictures;
mod plan;
mod rows;
mod run;
mod spread;
mod study;
mod table;
mod write;

pub use error::StudyError;
pub use folder::Folder;
pub use merge::Merged;
#[cfg(feature = "mpi")]
pub use mpi::Ranks;
pub use plan::{
    Design, Format, InstructionSet, Keep, Method, Picture, Plan, Request, Shown, Variants, What,
    Which,
};
pub use run::{Part, Ran, Runner};
pub use spread::{Spread, SpreadScale};
pub use study::{Prepared, Study};
pub use table::{Column, ColumnKind, Value};
