//! Compiler of hertzian declarations: parse, check, lower, differentiate, simplify, emit.
//!
//! A part of the crate `hertzian`, which re-exports its macros: depend on that one. What is public here serves the tests, benches
//! and fuzzing of the compiler, and may change in any version; the runtime asks for exactly its own.
#![deny(missing_docs)]

pub mod ast;
pub mod dag;
pub mod differentiate;
pub mod emit;
pub mod errors;
pub mod facts;
pub mod interpret;
pub mod ir;
pub mod primitive;
pub mod simplify;
#[cfg(feature = "text")]
pub mod text;

mod check;
mod index;
mod law_alone;
mod lower;
mod parse;
mod sketch;
mod stages;
mod tape;

use proc_macro2::TokenStream;

use crate::ast::Form;
use crate::errors::Errors;
use crate::ir::Model;

pub use crate::law_alone::law;

/// Expands a declaration to code that names the runtime by a path, such as `::hertzian`. After errors the expansion holds all
/// of them, and a stub of the type.
pub fn oscillator(runtime: &TokenStream, declaration: TokenStream) -> TokenStream {
    let written = declaration.clone();
    match stages::read(declaration, Form::Model) {
        Ok(model) => emit::emit(runtime, &model),
        Err(errors) => {
            let mut expansion = errors.into_compile_error();
            for sketch in sketch::of(written) {
                expansion.extend(emit::stub(
                    runtime,
                    &sketch.name,
                    &sketch.visibility,
                    &sketch.parameters,
                ));
            }
            expansion
        }
    }
}

/// Compiles a declaration as far as the checked model.
///
/// # Errors
/// Everything that is wrong with the declaration.
pub fn compile(declaration: TokenStream) -> Result<Model, Errors> {
    stages::read(declaration, Form::Model)
}
