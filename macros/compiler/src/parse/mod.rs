//! Tokens to [`Declaration`]. A fault in one item is reported and the item skipped, so that the others are read too.

mod expression;
mod number;
mod repeated;
mod tokens;
mod unit;

use proc_macro2::{Delimiter, Ident, TokenStream};
use syn::ext::IdentExt;

use self::tokens::{Token, Tokens};
use crate::ast::{
    Comparison, Condition, Coordinate, Declaration, Equation, Law, Let, Limit, Parameter, Piece,
    Statement,
};
use crate::dag::Rational;
use crate::errors::{Diagnostics, Extent};

/// Reads a declaration. `None` where not even its name could be read.
pub fn parse(declaration: TokenStream, diagnostics: &mut Diagnostics) -> Option<Declaration> {
    let mut parser = Parser {
        tokens: Tokens::new(declaration),
        depth: 0,
        diagnostics,
    };
    let result = parser.declaration();
    result.map_err(|fault| diagnostics.add(fault)).ok()
}

struct Parser<'a> {
    tokens: Tokens,
    depth: usize,
    diagnostics: &'a mut Diagnostics,
}

impl Parser<'_> {
    fn declaration(&mut self) -> syn::Result<Declaration> {
        let documentation = self.documentation()?;
        let visibility = self.visibility()?;
        let name = self.name("a name for the model, as in `pub Oscillator(x) { ... }`")?;
        let mut declaration = Declaration {
            documentation,
            visibility,
            name,
            coordinates: Vec::new(),
            parameters: Vec::new(),
            laws: Vec::new(),
            lets: Vec::new(),
            equations: Vec::new(),
        };
        match self.coordinates() {
            Ok(coordinates) => declaration.coordinates = coordinates,
            Err(fault) => {
                self.diagnostics.add(fault);
                return Ok(declaration);
            }
        }
        let Token::Open(Delimiter::Brace, close) = *self.tokens.peek() else {
            let fault = self.unexpected("`{` and the items of the model");
            self.diagnostics.add(fault);
            return Ok(declaration);
        };
        self.tokens.next();
        while self.tokens.position() < close {
            self.depth = 0;
            if let Err(fault) = self.item(&mut declaration) {
                self.diagnostics.add(fault);
                self.recover(close);
            }
        }
        self.tokens.go_to(close + 1);
        if !matches!(self.tokens.peek(), Token::End) {
            let fault = self.unexpected("nothing after the closing `}`: one model per macro");
            self.diagnostics.add(fault);
        }
        Ok(declaration)
    }

    /// Skips to the end of a faulty item: past its `;`, or to the next item that begins with a keyword.
    fn recover(&mut self, close: usize) {
        while self.tokens.position() < close && !self.tokens.take(";") {
            if matches!(self.tokens.peek(), Token::Name(name) if name == "param" || name == "law" || name == "let")
            {
                break;
            }
            self.tokens.skip();
        }
    }

    fn item(&mut self, declaration: &mut Declaration) -> syn::Result<()> {
        let documentation = self.documentation()?;
        if self.tokens.take_word("param") {
            let (parameter, result) = self.parameter(documentation)?;
            declaration.parameters.push(parameter);
            return result;
        } else if self.tokens.take_word("law") {
            let law = self.law()?;
            declaration.laws.push(law);
        } else if self.tokens.take_word("let") {
            let item = self.named()?;
            declaration.lets.push(item);
        } else if matches!(self.tokens.peek(), Token::Close(_)) {
            return Err(self.unexpected("an item after the doc comment"));
        } else {
            let statement = self.statement()?;
            declaration.equations.push(statement);
        }
        Ok(())
    }

    /// `name = value ;`, after the word `let`.
    fn named(&mut self) -> syn::Result<Let> {
        let name = self.name("a name, as in `let k = 2*zeta;`")?;
        self.expect("=", "`=`")?;
        let value = self.expression()?;
        self.expect(";", "an operator or `;`")?;
        Ok(Let { name, value })
    }

    /// `left = right ;`, or a loop of such.
    fn statement(&mut self) -> syn::Result<Statement> {
        if self.is_loop_of_equations() {
            return self.loop_of_equations();
        }
        let left = self.expression()?;
        self.expect("=", "an operator or `=`")?;
        let right = self.expression()?;
        self.expect(";", "an operator or `;`")?;
        Ok(Statement::Equation(Equation { left, right }))
    }

    /// `name : unit = default range ;`. A parameter with a faulty range is kept, so that its field exists.
    fn parameter(&mut self, documentation: String) -> syn::Result<(Parameter, syn::Result<()>)> {
        let name = self.name("the name of the parameter")?;
        let mut parameter = Parameter {
            documentation,
            range: Extent::at(name.span()),
            name,
            minimum: None,
            maximum: None,
            default: None,
            unit: None,
        };
        let result = self
            .details(&mut parameter)
            .and_then(|()| self.expect(";", "`;`, or a range such as `in 0.0..` or `> 0`"));
        Ok((parameter, result))
    }

    /// What follows the name of a parameter: unit, default and range, each if it is there.
    fn details(&mut self, parameter: &mut Parameter) -> syn::Result<()> {
        parameter.unit = self.unit()?;
        if self.tokens.is("=") {
            self.tokens.next();
            let start = self.tokens.here();
            let Some(Limit { value, .. }) = self.limit(true)? else {
                return Err(self.unexpected("a number, as in `param k = 1.5e3;`"));
            };
            parameter.default = Some((value, start.to(self.tokens.before())));
        }
        self.range(parameter)
    }

    /// `(x, y[8], z: m)`, at least one.
    fn coordinates(&mut self) -> syn::Result<Vec<Coordinate>> {
        let example = "the coordinates in parentheses, as in `Oscillator(x)`";
        self.list(example, |parser| {
            let name = parser.name("a name")?;
            let count = parser.count()?;
            let unit = parser.unit()?;
            Ok(Coordinate { name, count, unit })
        })
    }

    /// `[8]`, if it is there.
    fn count(&mut self) -> syn::Result<Option<usize>> {
        let Token::Open(Delimiter::Bracket, _) = self.tokens.peek() else {
            return Ok(None);
        };
        self.tokens.next();
        let place = self.tokens.here();
        let count = match self.tokens.next() {
            Token::Literal(text) => text.parse().ok(),
            _ => None,
        };
        let Some(count) = count.filter(|&count: &usize| count > 0) else {
            return Err(place.fault("an array has a length of at least one, as in `Chain(x[64])`"));
        };
        self.close("`]`")?;
        Ok(Some(count))
    }

    /// One of `in a..b`, `> a`, `>= a`, `< b`, `<= b`, or nothing.
    fn range(&mut self, parameter: &mut Parameter) -> syn::Result<()> {
        let start = self.tokens.here();
        let end = if self.tokens.take_word("in") {
            parameter.minimum = self.limit(true)?;
            let inclusive = self.tokens.is("..=");
            if !inclusive && !self.tokens.is("..") {
                return Err(self.unexpected("a range, as in `0.0..` or `-1..=1`"));
            }
            let _ = self.tokens.take("..=") || self.tokens.take("..");
            parameter.maximum = self.limit(inclusive)?;
            self.tokens.before()
        } else if let Some((lower, or_equal)) = self.relation() {
            let limit = self.limit(or_equal)?;
            if limit.is_none() {
                return Err(self.unexpected("a number"));
            }
            *(if lower {
                &mut parameter.minimum
            } else {
                &mut parameter.maximum
            }) = limit;
            self.tokens.before()
        } else {
            return Ok(());
        };
        parameter.range = start.to(end);
        Ok(())
    }

    /// A number that may carry a sign, if there is one.
    fn limit(&mut self, included: bool) -> syn::Result<Option<Limit>> {
        let minus = self.tokens.take("-");
        let Token::Literal(text) = self.tokens.peek().clone() else {
            return if minus {
                Err(self.unexpected("a number"))
            } else {
                Ok(None)
            };
        };
        let place = self.tokens.here();
        self.tokens.next();
        let Some(value) = Rational::from_decimal(&text) else {
            return Err(place.fault(format!(
                "expected a decimal number in the range, found `{text}`"
            )));
        };
        let value = if minus {
            -value.to_f64()
        } else {
            value.to_f64()
        };
        Ok(Some(Limit { value, included }))
    }

    /// Takes `>`, `>=`, `<` or `<=`: whether it is a `>`, and whether the two sides may be equal.
    fn relation(&mut self) -> Option<(bool, bool)> {
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

    fn law(&mut self) -> syn::Result<Law> {
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
    fn condition(&mut self, first: crate::ast::Expr, start: Extent) -> syn::Result<Condition> {
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

    /// The text of doc comments, which arrive as `#[doc = "..."]`. No other attribute is known.
    fn documentation(&mut self) -> syn::Result<String> {
        let mut text = String::new();
        while self.tokens.is("#") {
            let place = self.tokens.here();
            let Token::Open(Delimiter::Bracket, close) = *self.tokens.ahead(1) else {
                break;
            };
            let word = self.tokens.ahead(2).clone();
            let value = self.tokens.ahead(4).clone();
            let (Token::Name(word), Token::Literal(value)) = (word, value) else {
                return Err(place.fault("the only attributes are doc comments, `/// ...`"));
            };
            let line = syn::parse_str::<syn::LitStr>(&value)
                .ok()
                .filter(|_| word == "doc");
            let Some(line) = line else {
                return Err(place.fault("the only attributes are doc comments, `/// ...`"));
            };
            if !text.is_empty() {
                text.push('\n');
            }
            text.push_str(line.value().trim());
            self.tokens.go_to(close + 1);
        }
        Ok(text)
    }

    /// `pub`, `pub(crate)` and their like. Parentheses after a bare `pub` belong to it only around a path word.
    fn visibility(&mut self) -> syn::Result<syn::Visibility> {
        let place = self.tokens.here();
        if !self.tokens.take_word("pub") {
            return Ok(syn::Visibility::Inherited);
        }
        let mut text = "pub".to_owned();
        if let Token::Open(Delimiter::Parenthesis, close) = *self.tokens.peek() {
            while self.tokens.position() <= close {
                match self.tokens.next() {
                    Token::Name(name) => {
                        text.push(' ');
                        text.push_str(&name.to_string());
                    }
                    Token::Mark(mark, _) => text.push(mark),
                    Token::Open(..) => text.push('('),
                    Token::Close(_) => text.push(')'),
                    Token::Literal(_) | Token::End => break,
                }
            }
        }
        syn::parse_str(&text)
            .map_err(|_| place.fault("expected a visibility such as `pub` or `pub(crate)`"))
    }

    /// `(a, b, ...)`, at least one.
    fn names(&mut self, expected: &str) -> syn::Result<Vec<Ident>> {
        self.list(expected, |parser| parser.name("a name"))
    }

    /// Items in parentheses, with commas between them and perhaps after them; at least one.
    fn list<T>(
        &mut self,
        expected: &str,
        mut item: impl FnMut(&mut Self) -> syn::Result<T>,
    ) -> syn::Result<Vec<T>> {
        if !matches!(self.tokens.peek(), Token::Open(Delimiter::Parenthesis, _)) {
            return Err(self.unexpected(expected));
        }
        self.tokens.next();
        let mut items = vec![item(self)?];
        while self.tokens.take(",") && !matches!(self.tokens.peek(), Token::Close(_)) {
            items.push(item(self)?);
        }
        self.close("`,` or `)`")?;
        Ok(items)
    }

    fn name(&mut self, expected: &str) -> syn::Result<Ident> {
        match self.tokens.peek() {
            Token::Name(name) if syn::parse_str::<Ident>(&name.to_string()).is_ok() => {
                let name = name.clone();
                self.tokens.next();
                Ok(name)
            }
            Token::Name(name) => {
                let message = format!("`{}` is a word of Rust: choose another name", name.unraw());
                Err(self.tokens.here().fault(message))
            }
            _ => Err(self.unexpected(expected)),
        }
    }

    fn expect(&mut self, operator: &str, expected: &str) -> syn::Result<()> {
        if self.tokens.take(operator) {
            Ok(())
        } else {
            Err(self.unexpected(expected))
        }
    }

    fn unexpected(&self, expected: &str) -> syn::Error {
        self.tokens.here().fault(format!(
            "expected {expected}, found {}",
            self.tokens.found()
        ))
    }
}
