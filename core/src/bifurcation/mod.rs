//! Bifurcations of periodic orbits: the branches that begin at them, and the curves that they lie on.

pub(crate) mod depart;
mod diagram;
mod known;
#[cfg(feature = "plot")]
mod picture;
mod request;

pub use diagram::{Diagram, Limb, Omitted, Origin, Reason};
pub use request::Bifurcations;
