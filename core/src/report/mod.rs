//! How results are drawn and written.

mod branch;
#[cfg(feature = "plot")]
pub(crate) mod diagram;
pub mod export;
#[cfg(feature = "plot")]
pub(crate) mod picture;
