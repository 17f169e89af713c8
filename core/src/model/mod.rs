//! A system at values of its parameters: where its coefficients stand, what is checked, structures given as matrices.

pub(crate) mod error;
pub(crate) mod layout;
pub mod remarks;
pub(crate) mod request;
pub(crate) mod rigid;
pub mod structure;
pub(crate) mod validate;
