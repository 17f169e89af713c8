//! How results are drawn and written.

mod branch;
#[cfg(feature = "plot")]
pub(crate) mod diagram;
pub(crate) mod error;
pub mod export;
#[cfg(feature = "plot")]
mod labels;
#[cfg(feature = "plot")]
pub(crate) mod picture;
