//! Compiler of hertzian declarations: parse, check, lower, differentiate, simplify, emit.
#![deny(missing_docs)]

pub mod dag;
pub mod differentiate;
pub mod ir;

/// Expands a declaration.
pub fn oscillator(_declaration: proc_macro2::TokenStream) -> proc_macro2::TokenStream {
    proc_macro2::TokenStream::new()
}
