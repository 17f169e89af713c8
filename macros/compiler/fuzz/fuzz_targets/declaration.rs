//! Any text that lexes is compiled and expanded, as a model and as a law alone: no panic, and an end.
#![no_main]

use std::str::FromStr;

use libfuzzer_sys::fuzz_target;
use proc_macro2::TokenStream;
use quote::quote;

fuzz_target!(|text: &str| {
    if let Ok(tokens) = TokenStream::from_str(text) {
        let runtime = quote!(::hertzian);
        let _ = hertzian_compiler::oscillator(&runtime, tokens.clone());
        let _ = hertzian_compiler::law(&runtime, tokens);
    }
});
