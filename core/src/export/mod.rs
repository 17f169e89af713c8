//! Results as files that other programs read.

#[cfg(feature = "serde")]
mod json;
mod npy;

#[cfg(feature = "serde")]
pub(crate) use json::{pairs, seconds, text};
pub use npy::{Npy, Number};
