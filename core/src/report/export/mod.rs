//! Results as files that other programs read.

#[cfg(feature = "serde")]
mod consistent;
mod csv;
#[cfg(feature = "serde")]
pub(crate) mod json;
#[cfg(feature = "serde")]
mod json_of_diagrams;
pub(crate) mod map;
mod npy;
pub(crate) mod table;

pub use crate::numeric::decimal::{plain, rounded, to_error};
pub use hertzian_file::{can_write, write};

#[cfg(feature = "serde")]
pub use json::JSON_VERSION;
pub use npy::{npy, npy_of_labels};
pub use table::{COLUMNS, Table, cells};
