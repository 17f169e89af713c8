//! Laws of contacts: what generated code calls, and the same laws interpreted.

#[doc(hidden)]
pub mod emitted;
pub mod generic;
pub(crate) mod single;
