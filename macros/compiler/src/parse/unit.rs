//! Units: `: N/m^1.5`, symbols to exact powers.

use proc_macro2::Delimiter;

use super::Parser;
use super::tokens::Token;
use crate::ast::Unit;
use crate::dag::Rational;
use crate::errors::Extent;

impl Parser<'_> {
    /// `: unit`, if it is there.
    pub(super) fn unit(&mut self) -> syn::Result<Option<(Unit, Extent)>> {
        if !self.tokens.take(":") {
            return Ok(None);
        }
        let start = self.tokens.here();
        let unit = self.product_of_units()?;
        Ok(Some((unit, start.to(self.tokens.before()))))
    }

    pub(super) fn product_of_units(&mut self) -> syn::Result<Unit> {
        let mut unit = self.power_of_unit()?;
        loop {
            let divided = self.tokens.is("/");
            if !self.tokens.take("/") && !self.tokens.take("*") {
                return Ok(unit);
            }
            let place = self.tokens.here();
            let factor = self.power_of_unit()?;
            let sign = Rational::integer(if divided { -1 } else { 1 });
            unit.text.push(if divided { '/' } else { '*' });
            unit.text.push_str(&factor.text);
            unit.factors.extend(raised(factor, sign, place)?);
        }
    }

    fn power_of_unit(&mut self) -> syn::Result<Unit> {
        let unit = self.symbol()?;
        if !self.tokens.take("^") {
            return Ok(unit);
        }
        let place = self.tokens.here();
        let (exponent, text) = self.exponent()?;
        Ok(Unit {
            text: format!("{}^{text}", unit.text),
            factors: raised(unit, exponent, place)?,
        })
    }

    /// A symbol, `1`, or a unit in parentheses.
    fn symbol(&mut self) -> syn::Result<Unit> {
        match self.tokens.peek().clone() {
            Token::Name(name) => {
                self.tokens.next();
                let text = name.to_string();
                let factors = vec![(name, Rational::ONE)];
                Ok(Unit { factors, text })
            }
            Token::Literal(text) if text == "1" => {
                self.tokens.next();
                let factors = Vec::new();
                Ok(Unit { factors, text })
            }
            Token::Open(Delimiter::Parenthesis, _) => {
                self.tokens.next();
                let inner = self.nested(Self::product_of_units)?;
                self.close("`*`, `/` or `)`")?;
                let text = format!("({})", inner.text);
                Ok(Unit { text, ..inner })
            }
            _ => Err(self.unexpected("a unit, as in `N/m^1.5`, or `1` for a plain number")),
        }
    }

    /// `2`, `-1.5`, or `(3/2)`.
    fn exponent(&mut self) -> syn::Result<(Rational, String)> {
        if !matches!(self.tokens.peek(), Token::Open(Delimiter::Parenthesis, _)) {
            return self.signed_number();
        }
        self.tokens.next();
        let (mut value, mut text) = self.signed_number()?;
        if self.tokens.take("/") {
            let place = self.tokens.here();
            let (divisor, divisor_text) = self.signed_number()?;
            value = value.checked_div(divisor).ok_or_else(|| {
                place.fault("an exponent of a unit is a fraction such as `(3/2)`")
            })?;
            text = format!("{text}/{divisor_text}");
        }
        self.close("`)`")?;
        Ok((value, format!("({text})")))
    }

    fn signed_number(&mut self) -> syn::Result<(Rational, String)> {
        let minus = self.tokens.take("-");
        let place = self.tokens.here();
        let number = match self.tokens.peek() {
            Token::Literal(text) => Rational::from_decimal(text).map(|value| (value, text.clone())),
            _ => None,
        };
        let largest = Rational::integer(100);
        let small = |value: Rational| {
            let room = value
                .absolute()
                .and_then(|value| largest.checked_sub(value));
            let denominator = value.fraction().map(|(_, denominator)| denominator);
            room.is_some_and(|room| !room.is_negative()) && denominator.is_some_and(|d| d <= 1000)
        };
        let Some((value, text)) = number.filter(|&(value, _)| small(value)) else {
            return Err(place.fault("the exponent of a unit is a number, as in `N/m^1.5`"));
        };
        self.tokens.next();
        Ok(if minus {
            (value.negate().unwrap_or(value), format!("-{text}"))
        } else {
            (value, text)
        })
    }
}

/// The factors of a unit with their exponents multiplied.
fn raised(
    unit: Unit,
    exponent: Rational,
    place: Extent,
) -> syn::Result<Vec<(proc_macro2::Ident, Rational)>> {
    let times = |(symbol, own): (proc_macro2::Ident, Rational)| {
        let product = own.checked_mul(exponent);
        product
            .map(|product| (symbol, product))
            .ok_or_else(|| place.fault("this exponent is too large"))
    };
    unit.factors.into_iter().map(times).collect()
}
