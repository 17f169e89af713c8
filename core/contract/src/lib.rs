//! What compiler and runtime of hertzian both know of a system and its laws.
//!
//! A part of the crate `hertzian`, which re-exports it as `hertzian::system`, `hertzian::law` and `hertzian::generic`: depend on that one.
#![deny(missing_docs)]

#[doc(hidden)]
pub mod constants;
#[doc(hidden)]
pub mod data;
#[doc(hidden)]
pub mod declared;
pub mod law;
mod output;
mod setters;
pub mod system;
