//! Numbers known while compiling: indices of coordinates, ends of loops, and the `let` items these are made of.

use std::collections::HashMap;

use crate::ast::{Expr, Kind, Let, Loop};
use crate::dag::Rational;

/// Names that stand for exact numbers.
#[derive(Debug, Clone, Default)]
pub struct Constants(HashMap<String, Rational>);

impl Constants {
    /// The `let` items that are numbers.
    pub fn of(lets: &[Let]) -> Self {
        let mut constants = Self::default();
        for item in lets {
            constants.name(item);
        }
        constants
    }

    /// Adds the value of a `let` item, if it is a number; else forgets what had that name.
    pub fn name(&mut self, item: &Let) {
        let name = item.name.to_string();
        match self.value(&item.value) {
            Some(value) => self.0.insert(name, value),
            None => self.0.remove(&name),
        };
    }

    /// Sets the index of a loop.
    pub fn set<T>(&mut self, repeated: &Loop<T>, index: i128) {
        let name = repeated.index.to_string();
        self.0.insert(name, Rational::integer(index));
    }

    /// Forgets the names of a loop.
    pub fn leave<T>(&mut self, repeated: &Loop<T>) {
        self.0.remove(&repeated.index.to_string());
        for item in &repeated.lets {
            self.0.remove(&item.name.to_string());
        }
    }

    /// The value of an expression of numbers and known names; `None` for any other, and where it does not fit.
    pub fn value(&self, expression: &Expr) -> Option<Rational> {
        match &expression.kind {
            Kind::Number(value, _) => Some(*value),
            Kind::Name(name) => self.0.get(&name.to_string()).copied(),
            Kind::Sum(terms) => terms.iter().try_fold(Rational::ZERO, |sum, (minus, term)| {
                let term = self.value(term)?;
                if *minus {
                    sum.checked_sub(term)
                } else {
                    sum.checked_add(term)
                }
            }),
            Kind::Product(factors) => {
                factors
                    .iter()
                    .try_fold(Rational::ONE, |product, (divided, factor)| {
                        let factor = self.value(factor)?;
                        if *divided {
                            product.checked_div(factor)
                        } else {
                            product.checked_mul(factor)
                        }
                    })
            }
            Kind::Power(base, exponent) => {
                let exponent = self.value(exponent)?.to_integer()?;
                self.value(base)?.integer_power(exponent)
            }
            _ => None,
        }
    }

    /// The value of an expression that must be a whole number.
    ///
    /// # Errors
    /// If it is not, in words that begin with what it is.
    pub fn whole(&self, expression: &Expr, what: &str) -> syn::Result<i128> {
        match self.value(expression) {
            Some(value) => value.whole().ok_or_else(|| {
                let message = format!("{what} must be a whole number, and this is {value}");
                expression.extent.fault(message)
            }),
            None => Err(expression.extent.fault(format!(
                "{what} must be known while compiling: make it of whole numbers, indices of loops and `let` items that are numbers"
            ))),
        }
    }

    /// The indices of a loop.
    ///
    /// # Errors
    /// If its ends are not known whole numbers.
    pub fn range<T>(&self, repeated: &Loop<T>) -> syn::Result<std::ops::Range<i128>> {
        let start = self.whole(&repeated.start, "the first index")?;
        let end = self.whole(&repeated.end, "the end of a range")?;
        Ok(start..end.saturating_add(i128::from(repeated.inclusive)))
    }
}
