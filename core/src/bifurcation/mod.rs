//! Bifurcations of periodic orbits: the branches that begin at them, and the curves that they lie on. Where they are, the
//! engine of branches (`branches/engine`) has found.

pub mod backbone;
mod cover;
pub(crate) mod diagram;
pub(crate) mod error;
mod followed;
pub(crate) mod map;
mod matching;
mod nearest;
mod request;
mod scatter;
mod settle;
mod solutions;
mod starts;
mod stretches;
mod transient;

pub use cover::{Searched, SettledTo, Settling};
pub use diagram::{Diagram, DiagramBranch, Omitted, Origin, Reason};
pub use map::{Cell, CellVerdict, Map};
pub use request::Bifurcations;
pub use solutions::{Solution, Solutions, SolutionsAt};
