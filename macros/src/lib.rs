//! The procedural macro of hertzian: a thin wrapper around `hertzian-compiler`.

use proc_macro::TokenStream;

/// Declares a system of oscillators.
#[proc_macro]
pub fn oscillator(declaration: TokenStream) -> TokenStream {
    hertzian_compiler::oscillator(declaration.into()).into()
}
