//! Declarations that are text at run time, with the place of every fault.

mod primes;

use std::fmt;
use std::str::FromStr;

use proc_macro2::{Span, TokenStream, TokenTree};

use crate::ast::Form;
use crate::errors::Errors;
use crate::ir::{Law, Model};
use crate::law_alone::alone;
use crate::stages;

/// A longer text is no model of one person, and reading it would take long.
const LONGEST_TEXT: usize = 1 << 18;

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

/// Compiles a declaration as far as the checked model. The macro may stand around it, as in a program:
/// `hertzian::oscillator! { ... }`.
///
/// # Errors
/// Everything that is wrong with the declaration, in the order of its discovery.
pub fn compile_text(text: &str) -> Result<Model, Vec<Fault>> {
    let tokens = tokens(text)?;
    stages::read(inside(tokens, "oscillator"), Form::Model).map_err(|errors| placed(&errors))
}

/// Compiles a law without a model, as far as the checked law and the model that has its expressions. The macro may stand around it:
/// `hertzian::law! { ... }`.
///
/// # Errors
/// As [`compile_text`].
pub fn compile_law_text(text: &str) -> Result<(Model, Law), Vec<Fault>> {
    let tokens = tokens(text)?;
    let compiled = stages::read(inside(tokens, "law"), Form::LawAlone);
    let law = compiled.and_then(|mut model| {
        let law = alone(&mut model)?;
        Ok((model, law))
    });
    law.map_err(|errors| placed(&errors))
}

fn tokens(text: &str) -> Result<TokenStream, Vec<Fault>> {
    if text.len() > LONGEST_TEXT {
        let message =
            format!("this text has more than {LONGEST_TEXT} bytes: write what repeats as a loop");
        return Err(vec![Fault {
            message,
            line: 1,
            column: 1,
        }]);
    }
    TokenStream::from_str(text).map_err(|fault| {
        let primes = primes::faults(text);
        if !primes.is_empty() {
            return primes;
        }
        let message = "this is not made of words, numbers and marks that close what they open";
        vec![at(message.to_owned(), fault.span())]
    })
}

fn placed(errors: &Errors) -> Vec<Fault> {
    let faults = errors.faults().into_iter();
    faults
        .map(|fault| at(fault.to_string(), fault.span()))
        .collect()
}

/// What stands in the macro of this name, if nothing else stands beside it.
fn inside(tokens: TokenStream, called: &str) -> TokenStream {
    let all: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let is_word = |tree: &TokenTree, word| matches!(tree, TokenTree::Ident(name) if name == word);
    let is_mark =
        |tree: &TokenTree, mark| matches!(tree, TokenTree::Punct(own) if own.as_char() == mark);
    let call = match all.as_slice() {
        [path, colon, second, rest @ ..]
            if is_word(path, "hertzian") && is_mark(colon, ':') && is_mark(second, ':') =>
        {
            rest
        }
        all => all,
    };
    match call {
        [name, mark, TokenTree::Group(group), end @ ..]
            if is_word(name, called)
                && is_mark(mark, '!')
                && end.len() < 2
                && end.iter().all(|tree| is_mark(tree, ';')) =>
        {
            group.stream()
        }
        _ => tokens,
    }
}

fn at(message: String, span: Span) -> Fault {
    let start = span.start();
    Fault {
        message,
        line: start.line,
        column: start.column + 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "Linear(x) { ddot(x) + x = cos(omega*t); }";

    #[test]
    fn the_macro_may_stand_around_a_declaration() {
        for text in [
            MODEL.to_owned(),
            format!("// spring\nhertzian::oscillator! {{ {MODEL} }}"),
            format!("oscillator! {{ {MODEL} }}"),
            format!("hertzian::oscillator!({MODEL});"),
        ] {
            let model = compile_text(&text).unwrap_or_else(|faults| panic!("{text}: {faults:?}"));
            assert_eq!(model.name, "Linear");
        }
        let faults = compile_text("oscillator! {\n Linear(x) { ddot(x) + q = 0; } }");
        assert_eq!(faults.expect_err("`q` is unknown")[0].line, 2);
        assert!(compile_text(&format!("oscillator! {{ {MODEL} }} {MODEL}")).is_err());
        assert!(compile_text("oscillator!").is_err());
    }

    #[test]
    fn a_law_may_stand_alone() {
        let law = "Stop(gap, k > 0, n >= 1) { gap > 0 => k*gap^n, else => 0 }";
        for text in [law.to_owned(), format!("hertzian::law! {{ {law} }}")] {
            let (_, law) = compile_law_text(&text).expect("it is a law");
            assert_eq!(law.arguments, ["k", "n"]);
        }
        let faults = compile_law_text("Stop(gap, k)\n{ gap > 0 => q*gap, else => 0 }");
        assert_eq!(faults.expect_err("`q` is unknown")[0].line, 2);
        assert!(compile_law_text("Line(gap, k) { k*gap }").is_err());
        assert!(compile_law_text("").is_err());
    }

    #[test]
    fn primes_are_explained() {
        let faults = compile_text("Linear(x) {\n  x'' + x = 0;\n}").expect_err("no such mark");
        assert_eq!(
            faults[0].to_string(),
            "2:3: a second derivative by time is written `ddot(x)`, not `x''`"
        );
    }
}
