//! Parameters and coordinates, with unit, default and range.

use proc_macro2::{Delimiter, Ident};

use super::Parser;
use super::number::out_of_range;
use super::tokens::Token;
use crate::ast::{Coordinate, Limit, Parameter};
use crate::dag::Rational;
use crate::errors::shortened;

impl Parser<'_> {
    /// `name : unit = default range ;`. A parameter with a faulty range is kept, so that its field exists.
    pub(super) fn parameter(
        &mut self,
        documentation: String,
    ) -> syn::Result<(Parameter, syn::Result<()>)> {
        let name = self.name("the name of the parameter")?;
        let mut parameter = Parameter {
            documentation,
            ..Parameter::named(name)
        };
        let result = self
            .details(&mut parameter)
            .and_then(|()| self.expect(";", "`;`, or a range such as `in 0.0..` or `> 0`"));
        Ok((parameter, result))
    }

    /// What follows the name of a parameter: unit, default and range, each if it is there.
    fn details(&mut self, parameter: &mut Parameter) -> syn::Result<()> {
        parameter.unit = self.unit()?;
        if matches!(self.tokens.peek(), Token::Open(Delimiter::Bracket, _)) {
            self.tokens.next();
            if let Some(fault) = self.unit_in_brackets(&parameter.name) {
                return Err(fault);
            }
        }
        if self.tokens.is("=") {
            self.tokens.next();
            let start = self.tokens.here();
            let Some(Limit { value, .. }) = self.limit(true)? else {
                return Err(self.unexpected("a number, as in `param k = 1.5e3;`"));
            };
            parameter.default = Some((value, start.to(self.tokens.before())));
        }
        self.range(parameter)?;
        if self.tokens.is("=") {
            return Err(self.default_after_range(parameter));
        }
        Ok(())
    }

    /// What is said of a default that stands behind the range: both in their order.
    fn default_after_range(&mut self, parameter: &Parameter) -> syn::Error {
        let place = self.tokens.here();
        self.tokens.next();
        let written = |limit: &Option<Limit>| limit.as_ref().map(|limit| limit.value.to_string());
        let default = written(&self.limit(true).ok().flatten());
        let default = default.unwrap_or_else(|| "1".to_owned());
        let is_open = |limit: &Option<Limit>| limit.as_ref().is_some_and(|limit| !limit.included);
        let [low, high] = [&parameter.minimum, &parameter.maximum].map(written);
        let range = match (low, high) {
            (Some(low), None) if is_open(&parameter.minimum) => format!("> {low}"),
            (Some(low), None) => format!(">= {low}"),
            (None, Some(high)) if is_open(&parameter.maximum) => format!("< {high}"),
            (None, Some(high)) => format!("<= {high}"),
            (low, high) => {
                let dots = if is_open(&parameter.maximum) {
                    ".."
                } else {
                    "..="
                };
                let ends = [low, high].map(Option::unwrap_or_default);
                format!("in {}{dots}{}", ends[0], ends[1])
            }
        };
        let name = &parameter.name;
        place.fault(format!(
            "the default stands before the range: write `{name} = {default} {range}`"
        ))
    }

    /// `(x, y[8], z: m)`, at least one.
    pub(super) fn coordinates(&mut self) -> syn::Result<Vec<Coordinate>> {
        let example = "the coordinates in parentheses, as in `Oscillator(x)`";
        self.list(example, |parser| {
            let name = parser.name("a name")?;
            let count = parser.count(&name)?;
            let unit = parser.unit()?;
            Ok(Coordinate { name, count, unit })
        })
    }

    /// What is said of `x [m]`, if what is next, after the bracket, is a unit.
    fn unit_in_brackets(&mut self, name: &Ident) -> Option<syn::Error> {
        let place = self.tokens.here();
        let unit = self.product_of_units().ok()?;
        let unit = shortened(unit.text);
        Some(place.fault(format!("a unit is written after a colon: `{name}: {unit}`")))
    }

    /// `[8]`, if it is there.
    fn count(&mut self, name: &Ident) -> syn::Result<Option<usize>> {
        let Token::Open(Delimiter::Bracket, _) = self.tokens.peek() else {
            return Ok(None);
        };
        self.tokens.next();
        let place = self.tokens.here();
        let first = self.tokens.position();
        let count = match self.tokens.next() {
            Token::Literal(text) => text.parse().ok(),
            _ => None,
        };
        let Some(count) = count.filter(|&count: &usize| count > 0) else {
            self.tokens.go_to(first);
            if let Some(fault) = self.unit_in_brackets(name) {
                return Err(fault);
            }
            return Err(place.fault("an array has a length of at least one, as in `Chain(x[64])`"));
        };
        self.close("`]`")?;
        Ok(Some(count))
    }

    /// One of `in a..b`, `> a`, `>= a`, `< b`, `<= b`, or nothing.
    pub(super) fn range(&mut self, parameter: &mut Parameter) -> syn::Result<()> {
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
    pub(super) fn limit(&mut self, included: bool) -> syn::Result<Option<Limit>> {
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
            let shown = shortened(&text);
            let message = out_of_range(&text, &shown).unwrap_or_else(|| {
                format!("expected a decimal number in the range, found `{shown}`")
            });
            return Err(place.fault(message));
        };
        let value = if minus {
            -value.to_f64()
        } else {
            value.to_f64()
        };
        Ok(Some(Limit { value, included }))
    }
}
