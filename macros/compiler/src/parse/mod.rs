//! Tokens to [`Declaration`]. A fault in one item is reported and the item skipped, so that the others are read too.

mod alone;
mod declared;
mod expression;
mod law;
mod method;
mod number;
mod output;
mod repeated;
mod tokens;
mod unit;

use proc_macro2::{Delimiter, Ident, TokenStream};
use syn::ext::IdentExt;

use self::tokens::{Token, Tokens};
use crate::ast::{Declaration, Equation, Form, Let, Statement};
use crate::errors::{Diagnostics, LONGEST_NAME, shortened};

/// Reads a declaration. `None` where not even its name could be read.
pub fn parse(
    declaration: TokenStream,
    form: Form,
    diagnostics: &mut Diagnostics,
) -> Option<Declaration> {
    let tokens = diagnostics.keep(Tokens::new(declaration))?;
    let mut parser = Parser {
        tokens,
        depth: 0,
        in_output: false,
        diagnostics,
    };
    let result = match form {
        Form::Model => parser.declaration(),
        Form::LawAlone => parser.law_alone(),
    };
    result.map_err(|fault| diagnostics.add(fault)).ok()
}

struct Parser<'a> {
    tokens: Tokens,
    depth: usize,
    /// Whether `force(law)` may stand here.
    in_output: bool,
    diagnostics: &'a mut Diagnostics,
}

impl Parser<'_> {
    fn declaration(&mut self) -> syn::Result<Declaration> {
        let documentation = self.documentation()?;
        let visibility = self.visibility()?;
        let name = self.name("a name for the model, as in `pub Oscillator(x) { ... }`")?;
        let mut declaration = Declaration::named(name, Form::Model);
        declaration.documentation = documentation;
        declaration.visibility = visibility;
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
            self.in_output = false;
            if let Err(fault) = self.item(&mut declaration) {
                self.diagnostics.add(fault);
                self.recover(close);
            }
        }
        self.tokens.go_to(close + 1);
        self.end("nothing after the closing `}`: one model per macro");
        Ok(declaration)
    }

    fn end(&mut self, expected: &str) {
        if !matches!(self.tokens.peek(), Token::End) {
            let fault = self.unexpected(expected);
            self.diagnostics.add(fault);
        }
    }

    /// Skips to the end of a faulty item: past its `;`, or to the next item that begins with a keyword.
    fn recover(&mut self, close: usize) {
        while self.tokens.position() < close && !self.tokens.take(";") {
            let is_item = matches!(self.tokens.peek(), Token::Name(name) if name == "param" || name == "law" || name == "let");
            if is_item || self.is_output() {
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
        } else if self.is_output() {
            let output = self.output(documentation)?;
            declaration.outputs.push(output);
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
        if matches!(
            self.tokens.peek(),
            Token::Mark(';', _) | Token::Close(_) | Token::End
        ) {
            return Err(self.tokens.here().fault(
                "an equation has two sides: where nothing stands on the right, end it with `= 0;`",
            ));
        }
        self.expect("=", "an operator or `=`")?;
        let right = self.expression()?;
        self.expect(";", "an operator or `;`")?;
        Ok(Statement::Equation(Equation { left, right }))
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
                if name.to_string().len() > LONGEST_NAME {
                    let message = format!("a name has at most {LONGEST_NAME} letters");
                    return Err(self.tokens.here().fault(message));
                }
                self.tokens.next();
                Ok(name)
            }
            Token::Name(name) => {
                let message = format!(
                    "`{}` is a word of Rust: choose another name",
                    shortened(name.unraw())
                );
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
