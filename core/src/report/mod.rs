//! How results are drawn and written.

#[cfg(feature = "plot")]
pub(crate) mod diagram;
pub mod export;
#[cfg(feature = "plot")]
pub(crate) mod picture;
