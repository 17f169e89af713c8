//! Results as files that other programs read.

mod npy;

pub use npy::{Npy, Number};
