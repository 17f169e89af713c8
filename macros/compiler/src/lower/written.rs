//! What a message quotes: powers and switches as they were written, whatever has become of them since.

use std::collections::HashMap;
use std::rc::Rc;

use crate::ast::{Expr, Kind};
use crate::dag::{Dag, Id};
use crate::errors::{Extent, shortened};

/// A power or quotient, or what an absolute value, sign or step is taken of (a *switch*).
#[derive(Debug, Clone)]
pub struct Written {
    /// The power; of a switch, its operand.
    whole: Id,
    /// The base; of a switch, its operand.
    operand: Id,
    quote: Quote,
    extent: Extent,
}

/// An operand as written, and the exponent of a power.
#[derive(Debug, Clone)]
pub struct Quote {
    /// The base of a power, the divisor, or the operand of a switch.
    pub operand: Rc<str>,
    /// The exponent; empty where there is none.
    pub exponent: Rc<str>,
}

impl Quote {
    /// A base and an exponent.
    pub fn power(base: &Expr, exponent: &str) -> Self {
        Self {
            operand: shortened(base).into(),
            exponent: exponent.into(),
        }
    }

    /// The operand of a switch.
    pub fn switch(operand: &Expr) -> Self {
        Self::power(operand, "")
    }

    /// What the choice between two depends on.
    pub fn difference(first: &Expr, second: &Expr) -> Self {
        let is_zero = |expression: &Expr| matches!(&expression.kind, Kind::Number(value, _) if value.is_zero());
        let operand = match &second.kind {
            _ if is_zero(second) => shortened(first),
            _ if is_zero(first) => shortened(second),
            Kind::Sum(_) => format!("{} - ({})", shortened(first), shortened(second)),
            _ => format!("{} - {}", shortened(first), shortened(second)),
        };
        Self {
            operand: operand.into(),
            exponent: "".into(),
        }
    }
}

impl Written {
    /// A power, its base, and where it stands.
    pub fn power(power: Id, base: Id, quote: Quote, extent: Extent) -> Self {
        Self {
            whole: power,
            operand: base,
            quote,
            extent,
        }
    }

    /// A switch, and where its function stands.
    pub fn switch(operand: Id, quote: Quote, extent: Extent) -> Self {
        Self::power(operand, operand, quote, extent)
    }

    /// What has become of it in an expression that was rebuilt; `None` if it is no part of that.
    fn followed(&self, rebuilt: &HashMap<Id, Id>) -> Option<Self> {
        Some(Self {
            whole: *rebuilt.get(&self.whole)?,
            operand: *rebuilt.get(&self.operand)?,
            ..self.clone()
        })
    }
}

/// What has become of powers and switches in an expression that was rebuilt.
pub fn followed<T: FromIterator<Written>>(written: &[Written], rebuilt: &HashMap<Id, Id>) -> T {
    let parts = written.iter().filter_map(|part| part.followed(rebuilt));
    parts.collect()
}

/// What to quote of a power, if it still is what was written.
pub fn quote_of_power(written: &[Written], power: Id, base: Id) -> Option<&Quote> {
    written
        .iter()
        .find(|part| part.whole == power && part.operand == base)
        .map(|part| &part.quote)
}

/// Where a power stands.
pub fn place_of_power(written: &[Written], power: Id) -> Option<Extent> {
    written
        .iter()
        .find(|part| part.whole == power)
        .map(|part| part.extent)
}

/// What to quote of a switch.
///
/// The graph keeps a switch only up to a constant factor.
pub fn quote_of_switch<'a>(dag: &mut Dag, written: &'a [Written], operand: Id) -> Option<&'a str> {
    let wanted = dag.up_to_a_factor(operand);
    let found = written
        .iter()
        .find(|part| part.whole == part.operand && dag.up_to_a_factor(part.operand) == wanted)?;
    Some(&found.quote.operand)
}
