//! The procedural macros of `hertzian`: a thin wrapper around `hertzian-compiler`.
//!
//! Depend on `hertzian`, whose macros of the same names call these. They give its own path first, `($crate) declaration`, so
//! that generated code finds it under whatever name a package has it.

use proc_macro::TokenStream;
use proc_macro2::{TokenStream as Tokens, TokenTree};

/// What `hertzian::oscillator!` calls.
#[proc_macro]
pub fn oscillator(call: TokenStream) -> TokenStream {
    let (runtime, declaration) = parts(call);
    hertzian_compiler::oscillator(&runtime, declaration).into()
}

/// What `hertzian::law!` calls.
#[proc_macro]
pub fn law(call: TokenStream) -> TokenStream {
    let (runtime, declaration) = parts(call);
    hertzian_compiler::law(&runtime, declaration).into()
}

/// The path of the runtime, which stands in brackets, and the declaration after it.
fn parts(call: TokenStream) -> (Tokens, Tokens) {
    let mut tokens = Tokens::from(call).into_iter();
    let runtime = match tokens.next() {
        Some(TokenTree::Group(path)) => path.stream(),
        other => other.into_iter().collect(),
    };
    (runtime, tokens.collect())
}
