//! Bifurcations of periodic orbits: the branches that begin at them, and the curves that they lie on.

pub mod backbone;
pub(crate) mod diagram;
pub(crate) mod error;
mod matching;
mod request;

pub use diagram::{Diagram, DiagramBranch, Omitted, Origin, Reason};
pub use request::Bifurcations;
