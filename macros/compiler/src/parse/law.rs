//! Laws and their pieces.

use proc_macro2::{Delimiter, Ident};

use super::Parser;
use super::tokens::Token;
use crate::ast::{Comparison, Condition, Expr, Law, Piece};
use crate::errors::Extent;

impl Parser<'_> {
    pub(super) fn law(&mut self) -> syn::Result<Law> {
        let name = self.name("the name of the law")?;
        let example = "the gap in parentheses, as in `law contact(gap) { ... }`";
        let mut names = self.list(example, Self::argument)?;
        let gap = names.remove(0);
        Ok(Law {
            name,
            gap,
            arguments: names,
            pieces: self.pieces()?,
        })
    }

    /// The name of a gap or argument. What else is declared of a parameter is refused and skipped.
    pub(super) fn argument(&mut self) -> syn::Result<Ident> {
        let name = self.name("a name")?;
        let place = self.tokens.here();
        let message = if self.tokens.is(":") {
            "no unit is written here: what is passed in a call has one"
        } else if self.tokens.is("=") {
            "no default is written here: every call passes a value, as in `contact(x, 1.5)`"
        } else if self.tokens.is(">") || self.tokens.is("<") || self.tokens.take_word("in") {
            "no range is written here: inside a model the ranges of the parameters that a call passes count, as in `param n > 1;`"
        } else {
            return Ok(name);
        };
        self.diagnostics.report(place, message);
        self.skip_to_next();
        Ok(name)
    }

    /// To the next name in a list, or its end.
    pub(super) fn skip_to_next(&mut self) {
        while !self.tokens.is(",") && !matches!(self.tokens.peek(), Token::Close(_) | Token::End) {
            self.tokens.skip();
        }
    }

    /// The pieces in braces.
    pub(super) fn pieces(&mut self) -> syn::Result<Vec<Piece>> {
        let Token::Open(Delimiter::Brace, close) = *self.tokens.peek() else {
            return Err(self.unexpected("`{` and the pieces of the law"));
        };
        self.tokens.next();
        let mut pieces = Vec::new();
        let mut sound = true;
        while self.tokens.position() < close {
            self.depth = 0;
            match self.piece(pieces.is_empty()) {
                Ok(piece) => pieces.push(piece),
                Err(fault) => {
                    sound = false;
                    self.diagnostics.add(fault);
                    while self.tokens.position() < close && !self.tokens.take(",") {
                        self.tokens.skip();
                    }
                }
            }
        }
        if pieces.is_empty() && sound {
            self.diagnostics.report(
                self.tokens.here(),
                "a law has at least one piece, as in `gap > 0 => gap^1.5`",
            );
        }
        self.tokens.go_to(close + 1);
        Ok(pieces)
    }

    /// `condition => force`, or the one expression that a law without pieces is.
    fn piece(&mut self, first: bool) -> syn::Result<Piece> {
        let start = self.tokens.here();
        let condition = if self.tokens.take_word("else") {
            Condition::Else(start)
        } else {
            let operand = self.expression()?;
            if first && matches!(self.tokens.peek(), Token::Close(_)) {
                return Ok(Piece {
                    condition: Condition::Always,
                    force: operand,
                });
            }
            self.condition(operand, start)?
        };
        self.expect("=>", "`=>` and the force of the piece")?;
        let force = self.expression()?;
        if !matches!(self.tokens.peek(), Token::Close(_)) {
            self.expect(",", "an operator, or `,` after the piece")?;
        }
        Ok(Piece { condition, force })
    }

    /// Chains of comparisons, such as `0 < gap <= 1`, joined by `&&`.
    fn condition(&mut self, first: Expr, start: Extent) -> syn::Result<Condition> {
        let mut comparisons = Vec::new();
        let mut operand = first;
        loop {
            let before = comparisons.len();
            while !self.tokens.is("=>")
                && let Some((greater, or_equal)) = self.relation()
            {
                let next = self.expression()?;
                let (smaller, larger) = if greater {
                    (next.clone(), operand)
                } else {
                    (operand, next.clone())
                };
                comparisons.push(Comparison {
                    smaller,
                    larger,
                    or_equal,
                });
                operand = next;
            }
            if comparisons.len() == before {
                return Err(self.unexpected("a comparison, as in `gap > 0`, or `else`"));
            }
            if !self.tokens.take("&&") {
                return Ok(Condition::All(comparisons, start.to(self.tokens.before())));
            }
            operand = self.expression()?;
        }
    }

    /// Takes `>`, `>=`, `<` or `<=`: whether it is a `>`, and whether the two sides may be equal.
    pub(super) fn relation(&mut self) -> Option<(bool, bool)> {
        let greater = self.tokens.is(">");
        if !greater && !self.tokens.is("<") {
            return None;
        }
        let or_equal = self.tokens.take(">=") || self.tokens.take("<=");
        if !or_equal {
            let _ = self.tokens.take(">") || self.tokens.take("<");
        }
        Some((greater, or_equal))
    }
}
