//! Declarations: those that compile, those that are refused, and packages that have the runtime under another name.

mod accepted;
mod packages;
mod refused;
mod shown;
