//! Outputs: `output tip: mm = x[9] - x[0];`.

use proc_macro2::{Delimiter, Ident};

use super::Parser;
use super::tokens::Token;
use crate::ast::{Kind, Output};

impl Parser<'_> {
    /// Whether an output is next: the word, and a name after it. Elsewhere `output` is a name like any other.
    pub(super) fn is_output(&self) -> bool {
        matches!(self.tokens.peek(), Token::Name(word) if word == "output")
            && matches!(self.tokens.ahead(1), Token::Name(_))
    }

    /// `output name: unit = value;`
    pub(super) fn output(&mut self, documentation: String) -> syn::Result<Output> {
        self.tokens.next();
        let name = self.name("a name, as in `output tip = x[9];`")?;
        let unit = self.unit()?;
        self.expect("=", "`=`, or a unit as in `: mm`")?;
        self.in_output = true;
        let value = self.expression()?;
        self.in_output = false;
        self.expect(";", "an operator or `;`")?;
        Ok(Output {
            documentation,
            name,
            unit,
            value,
        })
    }

    /// `(law)`, after the word `force` in an output.
    pub(super) fn force(&mut self, word: &Ident) -> Option<Kind> {
        let (Token::Open(Delimiter::Parenthesis, _), Token::Name(law), Token::Close(_)) = (
            self.tokens.peek(),
            self.tokens.ahead(1),
            self.tokens.ahead(2),
        ) else {
            return None;
        };
        let law = (self.in_output && word == "force").then(|| law.clone())?;
        for _ in 0..3 {
            self.tokens.next();
        }
        Some(Kind::Force(law))
    }
}
