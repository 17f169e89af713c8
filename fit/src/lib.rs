//! Parameters of a model from measured response curves, with what the data say of them.
//!
//! A [`Fit`] has a model, [data sets](DataSet), and parameters that are free. It moves the parameters until the curves of periodic orbits pass through
//! the data: by the distances of these to the curves, along the branch that a [sweep](Sweep) was on. What comes of it is a [`Fitted`]: estimates
//! with standard errors, what the data cannot tell apart, residuals, outliers.

mod assign;
mod checks;
mod compare;
mod curve;
mod data;
mod error;
mod fit;
mod minimise;
mod moves;
mod path;
mod picture;
mod problem;
mod report;
mod result;
mod search;
mod spline;
mod statistics;
mod table;
mod trial;
mod turn;
mod unit;

pub use compare::{Compared, Comparison};
pub use data::{DataSet, Jump, Sweep};
pub use error::FitError;
pub use fit::{Fit, Loss, Progress, Stage};
pub use result::{Estimate, Fitted, FittedSet, FittedValue, Part, Started};
pub use table::read;
