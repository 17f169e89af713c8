//! Rules on powers and quotients: their bases, on the closed piece they stand in.

use crate::dag::{Dag, Id, Node, Rational, Variable};
use crate::errors::Extent;
use crate::lower::expand::Expander;
use crate::lower::interval::{Interval, Stretch};
use crate::lower::written::{Quote, Written, place_of_power, quote_of_power};

/// Every power in a force exists on its closed piece. Faults are at the power where its place is known, else at `extent`.
pub fn powers_are_defined(
    context: &mut Expander,
    force: Id,
    stretch: Stretch,
    written: &[Written],
    extent: Extent,
) -> syn::Result<()> {
    for id in context.dag.reachable(&[force]) {
        if let Node::Power(base, exponent) = *context.dag.node(id) {
            let place = place_of_power(written, id).unwrap_or(extent);
            let quote = quote_of_power(written, id, base);
            power_is_defined(context, base, exponent, stretch, quote)
                .map_err(|message| place.fault(message))?;
        }
    }
    Ok(())
}

/// One power exists while the gap is in a stretch; the fault in words if not.
pub fn power_is_defined(
    context: &mut Expander,
    base: Id,
    exponent: Id,
    stretch: Stretch,
    quote: Option<&Quote>,
) -> Result<(), String> {
    let [gap, rate] =
        [Variable::Gap, Variable::Rate].map(|variable| context.dag.depends_on(exponent, variable));
    if gap || rate {
        return Err("an exponent must be made of numbers and parameters".to_owned());
    }
    let power = Power {
        base,
        exponent,
        stretch,
        quote,
    };
    let number = context.dag.as_number(exponent);
    if number.is_some_and(Rational::is_integer) {
        return power.divisor_does_not_vanish(context);
    }
    power.base_is_not_negative(context)?;
    power.exponent_is_positive_where_the_base_vanishes(context)
}

/// A power on the stretch of gaps that it stands in.
struct Power<'q> {
    base: Id,
    exponent: Id,
    stretch: Stretch,
    quote: Option<&'q Quote>,
}

impl Power<'_> {
    /// The base of a power that is not whole is never negative on its piece.
    fn base_is_not_negative(&self, context: &mut Expander) -> Result<(), String> {
        if self.bounds(context).is_not_negative() {
            return Ok(());
        }
        let (shown, exponent) = self.quoted(context);
        let raised = as_exponent(&exponent);
        let place = where_it_holds(&context.dag, self.base);
        let advice = if self.base_moves(context) {
            format!(
                "write `|{shown}|^{raised}`, or `sgn({shown})*|{shown}|^{raised}` for an odd force, or restrict the piece"
            )
        } else {
            advice_on_ranges(context, self.base, ">=")
        };
        Err(format!(
            "`{shown}` may be negative{place}, and a negative number has no power `{exponent}`: {advice}"
        ))
    }

    /// Where the base of a power that is not whole can vanish, the exponent is positive.
    fn exponent_is_positive_where_the_base_vanishes(
        &self,
        context: &mut Expander,
    ) -> Result<(), String> {
        let exponents = context
            .ranges
            .bounds(&mut context.dag, self.exponent, Stretch::ALL);
        if exponents.is_positive() || self.bounds(context).is_positive() {
            return Ok(());
        }
        let (shown, exponent) = self.quoted(context);
        let advice = if context.dag.as_number(self.exponent).is_some() {
            format!(
                "add a positive distance to `{shown}`, as in `({shown} + a)^{}`",
                as_exponent(&exponent)
            )
        } else {
            advice_on_ranges(context, self.exponent, ">")
        };
        let place = where_it_holds(&context.dag, self.base);
        Err(format!(
            "`{shown}` vanishes{place}, so the exponent `{exponent}` must be positive: {advice}"
        ))
    }

    /// What is divided by never vanishes on its piece.
    fn divisor_does_not_vanish(&self, context: &mut Expander) -> Result<(), String> {
        let number = context.dag.as_number(self.exponent);
        let divides = number.is_some_and(Rational::is_negative);
        if !divides || self.bounds(context).excludes_zero() {
            return Ok(());
        }
        let (shown, _) = self.quoted(context);
        Err(if self.base_moves(context) {
            format!(
                "division by `{shown}`, which may vanish on this piece: add a positive distance to it"
            )
        } else {
            format!(
                "division by `{shown}`, which may be zero: {}",
                advice_on_ranges(context, self.base, ">")
            )
        })
    }

    /// Of the base, while the gap is in the stretch.
    fn bounds(&self, context: &mut Expander) -> Interval {
        context
            .ranges
            .bounds(&mut context.dag, self.base, self.stretch)
    }

    /// Whether the gap or its rate is in the base.
    fn base_moves(&self, context: &Expander) -> bool {
        let variables = context.dag.variables(self.base);
        let mut variables = variables.iter();
        variables.any(|variable| matches!(variable, Variable::Gap | Variable::Rate))
    }

    /// The base and the exponent as written, or else as they are.
    fn quoted(&self, context: &Expander) -> (String, String) {
        match self.quote {
            Some(quote) => (quote.operand.to_string(), quote.exponent.to_string()),
            None => (context.show(self.base), context.show(self.exponent)),
        }
    }
}

/// An exponent that is more than a number or a name needs parentheses.
fn as_exponent(text: &str) -> String {
    if text.contains([' ', '*', '/', '^']) {
        format!("({text})")
    } else {
        text.to_owned()
    }
}

fn where_it_holds(dag: &Dag, base: Id) -> &'static str {
    if dag.depends_on(base, Variable::Gap) {
        " on this piece"
    } else {
        ""
    }
}

/// Which range to declare so that an expression is bounded by zero.
pub fn advice_on_ranges(context: &Expander, id: Id, relation: &str) -> String {
    let names: Vec<String> = context
        .dag
        .variables(id)
        .into_iter()
        .filter(|variable| matches!(variable, Variable::Parameter(_) | Variable::Argument(_)))
        .map(|variable| context.label(variable))
        .collect();
    match names.as_slice() {
        [] => "change the numbers".to_owned(),
        [name] => {
            let declared = format!("{name} {relation} 0");
            context.form.how_to_declare_range(&declared)
        }
        names => format!("declare ranges that say so for `{}`", names.join("`, `")),
    }
}
