//! Expressions.
//!
//! `^` is right-associative and binds tighter than a sign in front: `-x^2` is `-(x^2)`, `2^-x^2` is `2^(-(x^2))`. A bar
//! where an operand is expected opens an absolute value, and where an operator is expected closes one: there is no
//! product without a sign, hence no doubt.

use proc_macro2::Delimiter;

use super::Parser;
use super::tokens::Token;
use crate::ast::{Expr, Kind};
use crate::dag::Rational;
use crate::errors::{Diagnostics, shortened};

/// Deeper nesting than anyone writes, and far less than what a stack holds.
const DEEPEST: usize = 40;

impl Parser<'_> {
    /// A sum of products.
    pub(super) fn expression(&mut self) -> syn::Result<Expr> {
        let start = self.tokens.here();
        let mut terms = Vec::new();
        let mut minus = false;
        loop {
            terms.push((minus, self.product()?));
            if self.tokens.take("+") {
                minus = false;
            } else if !self.tokens.is("->") && self.tokens.take("-") {
                minus = true;
            } else {
                break;
            }
        }
        if let [(false, _)] = terms[..] {
            return Ok(terms.remove(0).1);
        }
        Ok(Expr {
            kind: Kind::Sum(terms),
            extent: start.to(self.tokens.before()),
        })
    }

    fn product(&mut self) -> syn::Result<Expr> {
        let start = self.tokens.here();
        let mut factors = Vec::new();
        let mut divided = false;
        loop {
            let factor = self.signed()?;
            if let (true, Some((_, power))) = (divided, factors.last()) {
                exponent_is_in_parentheses(power, &factor, self.diagnostics);
            }
            factors.push((divided, factor));
            if self.tokens.is("**") {
                return Err(self
                    .tokens
                    .here()
                    .fault("a power is written `^`, as in `gap^1.5`"));
            } else if self.tokens.take("*") {
                divided = false;
            } else if self.tokens.take("/") {
                divided = true;
            } else {
                break;
            }
        }
        if self.starts_operand() {
            let message = format!(
                "an operator is missing before {}: write `*` between factors",
                self.tokens.found()
            );
            return Err(self.tokens.here().fault(message));
        }
        if let [(false, _)] = factors[..] {
            return Ok(factors.remove(0).1);
        }
        Ok(Expr {
            kind: Kind::Product(factors),
            extent: start.to(self.tokens.before()),
        })
    }

    /// Whether the next token can only begin another operand.
    fn starts_operand(&self) -> bool {
        match self.tokens.peek() {
            Token::Name(_) | Token::Literal(_) => true,
            Token::Open(delimiter, _) => *delimiter != Delimiter::Brace,
            _ => false,
        }
    }

    fn signed(&mut self) -> syn::Result<Expr> {
        let start = self.tokens.here();
        if self.tokens.take("-") {
            let operand = self.nested(Self::signed)?;
            return Ok(Expr {
                kind: Kind::Sum(vec![(true, operand)]),
                extent: start.to(self.tokens.before()),
            });
        }
        if self.tokens.take("+") {
            return self.nested(Self::signed);
        }
        self.power()
    }

    fn power(&mut self) -> syn::Result<Expr> {
        let start = self.tokens.here();
        let mut base = self.operand()?;
        let mut methods = 0;
        while self.is_method() {
            base = self.method(base, start)?;
            methods += 1;
            if methods == DEEPEST {
                return Err(self.tokens.here().fault(too_deep()));
            }
        }
        if !self.tokens.take("^") {
            return Ok(base);
        }
        let exponent = self.nested(Self::signed)?;
        let extent = start.to(self.tokens.before());
        Ok(Expr {
            kind: Kind::Power(Box::new(base), Box::new(exponent)),
            extent,
        })
    }

    fn operand(&mut self) -> syn::Result<Expr> {
        let start = self.tokens.here();
        let kind = match self.tokens.peek().clone() {
            Token::Literal(text) => {
                self.tokens.next();
                return self.number(&text, start);
            }
            Token::Name(name) if name == "for" => {
                self.tokens.next();
                Kind::Sigma(Box::new(self.nested(Self::sigma)?))
            }
            Token::Name(name) => {
                self.tokens.next();
                if let Some(force) = self.force(&name) {
                    return Ok(Expr {
                        kind: force,
                        extent: start.to(self.tokens.before()),
                    });
                }
                match *self.tokens.peek() {
                    Token::Open(Delimiter::Parenthesis, _) => {
                        Kind::Call(name, self.nested(Self::arguments)?)
                    }
                    Token::Open(Delimiter::Bracket, _) => {
                        self.tokens.next();
                        let index = self.nested(Self::expression)?;
                        self.close("an operator or `]`")?;
                        Kind::Element(name, Box::new(index))
                    }
                    _ => Kind::Name(name),
                }
            }
            Token::Open(Delimiter::Parenthesis | Delimiter::None, _) => {
                self.tokens.next();
                let inner = self.nested(Self::expression)?;
                self.close("an operator or `)`")?;
                return Ok(Expr {
                    extent: start.to(self.tokens.before()),
                    ..inner
                });
            }
            Token::Mark('|', _) => {
                self.tokens.next();
                let inner = self.nested(Self::expression)?;
                if !self.tokens.take("|") {
                    return Err(
                        self.unexpected("an operator or the `|` that closes the absolute value")
                    );
                }
                Kind::Absolute(Box::new(inner))
            }
            _ => return Err(self.unexpected("a number, a name or `(`")),
        };
        Ok(Expr {
            kind,
            extent: start.to(self.tokens.before()),
        })
    }

    /// `(a, b, ...)`
    pub(super) fn arguments(&mut self) -> syn::Result<Vec<Expr>> {
        self.tokens.next();
        let mut arguments = Vec::new();
        while !matches!(self.tokens.peek(), Token::Close(_)) {
            arguments.push(self.expression()?);
            if !self.tokens.take(",") {
                break;
            }
        }
        self.close("an operator, `,` or `)`")?;
        Ok(arguments)
    }

    /// Takes a closing bracket.
    pub(super) fn close(&mut self, expected: &str) -> syn::Result<()> {
        match self.tokens.peek() {
            Token::Close(_) => {
                self.tokens.next();
                Ok(())
            }
            _ => Err(self.unexpected(expected)),
        }
    }

    /// Reads one level deeper, down to a limit.
    pub(super) fn nested<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> syn::Result<T>,
    ) -> syn::Result<T> {
        if self.depth == DEEPEST {
            return Err(self.tokens.here().fault(too_deep()));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }
}

fn too_deep() -> String {
    format!("nested more than {DEEPEST} deep: name parts of it with `let`")
}

/// An exponent that is a fraction is in parentheses: `x^1/3` is `(x^1)/3`, which nobody means.
fn exponent_is_in_parentheses(power: &Expr, divisor: &Expr, diagnostics: &mut Diagnostics) {
    if let Kind::Power(base, exponent) = &power.kind
        && matches!(&exponent.kind, Kind::Number(value, _) if *value == Rational::ONE)
    {
        let written = Expr {
            kind: Kind::Product(vec![(false, power.clone()), (true, divisor.clone())]),
            extent: power.extent.to(divisor.extent),
        };
        let root = Expr {
            kind: Kind::Power(
                base.clone(),
                Box::new(Expr {
                    kind: Kind::Product(vec![
                        (false, (**exponent).clone()),
                        (true, divisor.clone()),
                    ]),
                    extent: exponent.extent,
                }),
            ),
            extent: power.extent,
        };
        let message = format!(
            "`{}` divides the power, not the exponent: put the exponent in parentheses, as in `{}`",
            shortened(&written),
            shortened(&root)
        );
        diagnostics.report(written.extent, message);
    }
}
