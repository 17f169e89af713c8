//! Declarations that are text at run time, with the place of every fault.

use std::fmt;
use std::str::FromStr;

use proc_macro2::{Span, TokenStream};

use crate::compile;
use crate::ir::Model;

/// Something wrong with a text, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// What is wrong, and mostly what to write instead.
    pub message: String,
    /// Line, from one.
    pub line: usize,
    /// Column, from one.
    pub column: usize,
}

impl fmt::Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            message,
            line,
            column,
        } = self;
        write!(formatter, "{line}:{column}: {message}")
    }
}

/// Compiles a declaration as far as the checked model.
///
/// # Errors
/// Everything that is wrong with the declaration, in the order of its discovery.
pub fn compile_text(text: &str) -> Result<Model, Vec<Fault>> {
    let tokens = TokenStream::from_str(text).map_err(|fault| {
        let message = "this is not made of words, numbers and marks that close what they open";
        vec![at(message.to_owned(), fault.span())]
    })?;
    compile(tokens).map_err(|errors| {
        let faults = errors.faults().into_iter();
        faults
            .map(|fault| at(fault.to_string(), fault.span()))
            .collect()
    })
}

fn at(message: String, span: Span) -> Fault {
    let start = span.start();
    Fault {
        message,
        line: start.line,
        column: start.column + 1,
    }
}
