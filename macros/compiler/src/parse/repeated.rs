//! Loops: `for j in 0..8 { ... }` around a term or around equations.
//!
//! Which of the two it is shows at its end: equations end with `;`, a term does not.

use proc_macro2::Delimiter;

use super::Parser;
use super::tokens::Token;
use crate::ast::{Expr, Loop, Statement};

impl Parser<'_> {
    /// Whether a loop of equations is next, rather than an equation that begins with a sum.
    pub(super) fn is_loop_of_equations(&self) -> bool {
        if !matches!(self.tokens.peek(), Token::Name(name) if name == "for") {
            return false;
        }
        let mut distance = 0;
        loop {
            match self.tokens.ahead(distance) {
                Token::Open(Delimiter::Brace, close) => return self.tokens.ends_with_mark(*close),
                Token::Open(_, close) => distance = close + 1 - self.tokens.position(),
                Token::End => return false,
                _ => distance += 1,
            }
        }
    }

    /// A loop of equations. A fault in one of them is reported, and the others are read.
    pub(super) fn loop_of_equations(&mut self) -> syn::Result<Statement> {
        self.tokens.next();
        let (head, close) = self.head()?;
        let mut body = Vec::new();
        while self.tokens.position() < close {
            match self.nested(Self::statement) {
                Ok(statement) => body.push(statement),
                Err(fault) => {
                    self.diagnostics.add(fault);
                    self.recover(close);
                }
            }
        }
        self.tokens.go_to(close + 1);
        Ok(Statement::Loop(Box::new(head.around(body))))
    }

    /// A sum of terms, after the word `for`.
    pub(super) fn sigma(&mut self) -> syn::Result<Loop<Expr>> {
        let (head, _) = self.head()?;
        let term = self.expression()?;
        self.close("an operator or `}`")?;
        Ok(head.around(term))
    }

    /// `index in start..end { let ...;`, and where the closing brace is.
    fn head(&mut self) -> syn::Result<(Loop<()>, usize)> {
        let example = "an index and its range, as in `for j in 0..8 { ... }`";
        let index = self.name(example)?;
        if !self.tokens.take_word("in") {
            return Err(self.unexpected(example));
        }
        let start = self.expression()?;
        let inclusive = self.tokens.is("..=");
        if !inclusive && !self.tokens.is("..") {
            return Err(self.unexpected("a range, as in `0..8`"));
        }
        let _ = self.tokens.take("..=") || self.tokens.take("..");
        let end = self.expression()?;
        let Token::Open(Delimiter::Brace, close) = *self.tokens.peek() else {
            return Err(self.unexpected("`{` and what is repeated"));
        };
        self.tokens.next();
        let mut lets = Vec::new();
        while self.tokens.take_word("let") {
            lets.push(self.named()?);
        }
        let head = Loop {
            index,
            start,
            end,
            inclusive,
            lets,
            body: (),
        };
        Ok((head, close))
    }
}

impl Loop<()> {
    fn around<T>(self, body: T) -> Loop<T> {
        Loop {
            index: self.index,
            start: self.start,
            end: self.end,
            inclusive: self.inclusive,
            lets: self.lets,
            body,
        }
    }
}
