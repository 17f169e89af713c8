//! How results are drawn and written.

#[cfg(feature = "plot")]
pub(crate) mod band;
#[cfg(feature = "serde")]
mod checkpoint;
#[cfg(feature = "plot")]
mod curve;
#[cfg(feature = "plot")]
pub(crate) mod diagram;
#[cfg(feature = "plot")]
mod drawn;
pub(crate) mod error;
pub mod export;
#[cfg(feature = "plot")]
mod labels;
#[cfg(feature = "plot")]
mod map_chart;
#[cfg(feature = "plot")]
mod panels;
#[cfg(feature = "plot")]
mod path;
#[cfg(feature = "plot")]
pub(crate) mod picture;
#[cfg(feature = "plot")]
mod prefix;
mod said;
#[cfg(feature = "plot")]
mod together;
#[cfg(feature = "plot")]
mod tornado;
pub(crate) mod unit;
#[cfg(feature = "plot")]
pub(crate) mod view;
#[cfg(all(test, feature = "plot"))]
mod view_tests;
