//! Methods of Rust's numbers, `x.powi(3)`. The language has none: the message says how the same is written here.

use proc_macro2::{Delimiter, Ident};

use super::Parser;
use super::tokens::Token;
use crate::ast::{Expr, Kind};
use crate::dag::Rational;
use crate::errors::{Extent, shortened};

impl Parser<'_> {
    /// Whether a point and a name are next.
    pub(super) fn is_method(&self) -> bool {
        self.tokens.is(".") && matches!(self.tokens.ahead(1), Token::Name(_))
    }

    /// A method of an expression, which is refused; what was meant is returned, so that the rest can be read.
    pub(super) fn method(&mut self, of: Expr, start: Extent) -> syn::Result<Expr> {
        let place = self.tokens.here();
        self.tokens.next();
        let name = self.name("a name")?;
        if !matches!(self.tokens.peek(), Token::Open(Delimiter::Parenthesis, _)) {
            let message = format!(
                "there are no fields here, as `{name}` would be: declare a parameter, and write its name alone"
            );
            return Err(place.to(self.tokens.before()).fault(message));
        }
        let arguments = self.nested(Self::arguments)?;
        let extent = start.to(self.tokens.before());
        let mut written = Vec::new();
        written.extend(arguments.iter().map(ToString::to_string));
        let written = shortened(format!(".{name}({})", written.join(", ")));
        let Some(kind) = meant(&name, of, arguments) else {
            let message = format!(
                "there are no methods here, as `{written}` would be: write a function, as in `sqrt(x)`"
            );
            return Err(place.to(self.tokens.before()).fault(message));
        };
        let meant = Expr { kind, extent };
        let message = format!(
            "there are no methods here, as `{written}` would be: write `{}`",
            shortened(&meant)
        );
        self.diagnostics.report(extent, message);
        Ok(meant)
    }
}

/// What a method is in the language.
fn meant(name: &Ident, of: Expr, mut arguments: Vec<Expr>) -> Option<Kind> {
    let function = match name.to_string().as_str() {
        "powi" | "powf" | "pow" if arguments.len() == 1 => {
            let exponent = Box::new(arguments.remove(0));
            return Some(Kind::Power(Box::new(of), exponent));
        }
        "cbrt" if arguments.is_empty() => {
            let [one, three] = [1, 3].map(|value| Expr {
                kind: Kind::Number(Rational::integer(value), value.to_string()),
                extent: of.extent,
            });
            let third = Expr {
                kind: Kind::Product(vec![(false, one), (true, three)]),
                extent: of.extent,
            };
            return Some(Kind::Power(Box::new(of), Box::new(third)));
        }
        "abs" if arguments.is_empty() => return Some(Kind::Absolute(Box::new(of))),
        "signum" if arguments.is_empty() => "sgn",
        "sqrt" if arguments.is_empty() => "sqrt",
        "exp" if arguments.is_empty() => "exp",
        "sin" if arguments.is_empty() => "sin",
        "cos" if arguments.is_empty() => "cos",
        "tanh" if arguments.is_empty() => "tanh",
        "max" if arguments.len() == 1 => "max",
        "min" if arguments.len() == 1 => "min",
        _ => return None,
    };
    arguments.insert(0, of);
    Some(Kind::Call(Ident::new(function, name.span()), arguments))
}
