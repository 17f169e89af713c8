//! Laws and their pieces.

use proc_macro2::Delimiter;

use super::Parser;
use super::tokens::Token;
use crate::ast::{Comparison, Condition, Expr, Law, Piece};
use crate::errors::Extent;

impl Parser<'_> {
    pub(super) fn law(&mut self) -> syn::Result<Law> {
        let name = self.name("the name of the law")?;
        let mut arguments =
            self.names("the gap in parentheses, as in `law contact(gap) { ... }`")?;
        let gap = arguments.remove(0);
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
        Ok(Law {
            name,
            gap,
            arguments,
            pieces,
        })
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
