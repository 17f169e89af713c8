//! Results as files that other programs read.

#[cfg(feature = "serde")]
mod json;
mod npy;
mod table;

#[cfg(feature = "serde")]
pub(crate) use json::{pairs, seconds, text};
pub use npy::{Npy, Number};
pub use table::{COLUMNS, Table, cells};
