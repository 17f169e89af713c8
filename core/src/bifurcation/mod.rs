//! Bifurcations of periodic orbits: the branches that begin at them, and the curves that they lie on.

mod diagram;
mod known;
mod request;

pub use diagram::{Diagram, Limb, Omitted, Origin, Reason};
pub use request::Bifurcations;
