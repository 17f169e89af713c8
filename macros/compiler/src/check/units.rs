//! Rules on units. With units everywhere, every sum is checked to add what can be added.

use std::collections::HashMap;

use proc_macro2::Ident;

use crate::ast::{
    Condition, Declaration, Equation, Expr, Kind, Law, Loop, Output, Piece, Statement, Unit,
};
use crate::dag::Rational;
use crate::errors::{Diagnostics, Extent, nearest, shortened};
use crate::index::Constants;

mod dimension;

use self::dimension::{Dimension, SYMBOLS};

/// What an expression is measured in; `None` for zero, which fits everywhere.
type Measure = Option<Dimension>;

/// The units of a declaration, as they are shown: empty for plain numbers.
#[derive(Debug, Clone, Default)]
pub struct Units {
    /// One for each name of a coordinate; none where the declaration has no units.
    pub coordinates: Vec<String>,
    /// One for each parameter.
    pub parameters: Vec<String>,
    /// One for each output, with the power of ten that its expression is multiplied by.
    pub outputs: Vec<(String, Rational)>,
    /// Of the forces of laws, by name, that are in one unit wherever they act.
    pub laws: HashMap<String, String>,
}

/// Either everything has a unit, or nothing: then the equations are checked. An output is given the unit of what it is equal to, unless
/// it has one of its own.
pub(super) fn units_agree(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Units {
    let mut with = HashMap::new();
    let mut without: Vec<(&str, &Ident)> = Vec::new();
    let coordinates = declaration.coordinates.iter();
    let coordinates = coordinates.map(|item| ("coordinate", &item.name, &item.unit));
    let parameters = declaration.parameters.iter();
    let parameters = parameters.map(|item| ("parameter", &item.name, &item.unit));
    for (what, name, unit) in coordinates.chain(parameters) {
        match unit {
            Some((unit, extent)) => {
                let dimension = diagnostics.keep(units_are_known(unit, *extent));
                with.insert(name.to_string(), dimension);
            }
            None => without.push((what, name)),
        }
    }
    if with.is_empty() {
        outputs_have_no_units_alone(declaration, diagnostics);
    }
    if with.is_empty() || !diagnostics.is_clean() {
        return Units::default();
    }
    for (what, name) in &without {
        let message = format!(
            "{what} `{name}` has no unit, while others have one: write it, as in `{name}: N/m^1.5` or `{name}: 1`, or remove all units"
        );
        diagnostics.report(Extent::at(name.span()), message);
    }
    if without.is_empty() {
        checked(declaration, with, diagnostics)
    } else {
        Units::default()
    }
}

/// Every sum of a declaration whose coordinates and parameters have these units is checked, and what follows from them is told.
fn checked(
    declaration: &Declaration,
    names: HashMap<String, Measure>,
    diagnostics: &mut Diagnostics,
) -> Units {
    let mut checker = Checker {
        declaration,
        names,
        constants: Constants::of(&declaration.lets),
        known: HashMap::new(),
        forces: Vec::new(),
        depth: 0,
    };
    let second = Dimension::of_symbol("s");
    checker.names.insert("t".to_owned(), second);
    let per_second = Dimension::ONE.per_time(1);
    checker.names.insert("omega".to_owned(), per_second);
    checker.all(diagnostics);
    let text = |unit: &Option<(Unit, Extent)>| {
        let text = unit.as_ref().map(|(unit, _)| unit.text.clone());
        text.filter(|text| text != "1").unwrap_or_default()
    };
    let mut units = Units::default();
    for coordinate in &declaration.coordinates {
        let unit = std::iter::repeat_n(text(&coordinate.unit), coordinate.size());
        units.coordinates.extend(unit);
    }
    units.parameters = (declaration.parameters.iter())
        .map(|parameter| text(&parameter.unit))
        .collect();
    for output in &declaration.outputs {
        let found = diagnostics.keep(checker.output(output));
        units.outputs.extend(found);
    }
    units.laws = checker.units_of_laws();
    units
}

/// An output has a unit of its own only where everything has one.
fn outputs_have_no_units_alone(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    for output in &declaration.outputs {
        if let Some((_, extent)) = &output.unit {
            let message = format!(
                "output `{}` has a unit, while nothing else has one: declare those of all coordinates and parameters, or remove it",
                output.name
            );
            diagnostics.report(*extent, message);
        }
    }
}

/// Every symbol of a unit is known.
fn units_are_known(unit: &Unit, extent: Extent) -> syn::Result<Dimension> {
    let mut dimension = Dimension::ONE;
    for (symbol, exponent) in &unit.factors {
        let name = symbol.to_string();
        let Some(own) = Dimension::of_symbol(&name) else {
            let symbols = SYMBOLS.iter().map(|(symbol, _)| *symbol);
            let advice = match nearest(&name, symbols.clone()) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("known are {}", symbols.collect::<Vec<_>>().join(", ")),
            };
            let place = Extent::at(symbol.span());
            return Err(place.fault(format!("unknown unit `{name}`: {advice}")));
        };
        dimension = own
            .power(*exponent)
            .and_then(|own| dimension.times(own))
            .ok_or_else(|| extent.fault("the exponents of this unit are too large"))?;
    }
    Ok(dimension)
}

struct Checker<'a> {
    declaration: &'a Declaration,
    names: HashMap<String, Measure>,
    constants: Constants,
    /// Forces of laws, by name and the measures of gap and arguments.
    known: HashMap<(String, Vec<Measure>), Measure>,
    /// Those of the contacts, in the order of the equations: a law may be called by another one too, in another unit.
    forces: Vec<(String, Measure)>,
    /// How many laws deep.
    depth: usize,
}

impl Checker<'_> {
    fn all(&mut self, diagnostics: &mut Diagnostics) {
        let declaration = self.declaration;
        for item in &declaration.lets {
            let Some(measure) = diagnostics.keep(self.of(&item.value)) else {
                return;
            };
            self.names.insert(item.name.to_string(), measure);
        }
        for statement in &declaration.equations {
            diagnostics.keep(self.statement(statement));
        }
    }

    /// The unit of an output, and the power of ten that its expression is multiplied by: that is measured in what the unit says, up to
    /// such a power.
    fn output(&mut self, output: &Output) -> syn::Result<(String, Rational)> {
        let Some(own) = self.of(&output.value)? else {
            return Ok((String::new(), Rational::ZERO));
        };
        let Some((unit, extent)) = &output.unit else {
            let shown = self.angle(output, own).unwrap_or_else(|| own.to_string());
            let shown = Some(shown).filter(|shown| shown != "1").unwrap_or_default();
            return Ok((shown, Rational::ZERO));
        };
        let power = own.in_units_of(units_are_known(unit, *extent)?);
        let power = power.ok_or_else(|| {
            extent.fault(format!(
                "`{}` {}, and is not measured in {}",
                shortened(&output.value),
                said(own),
                unit.text
            ))
        })?;
        let text = if unit.text == "1" { "" } else { &unit.text };
        Ok((text.to_owned(), power))
    }

    /// The unit of an angle, or of its rate or acceleration, where an output is one of angles alone.
    fn angle(&self, output: &Output, own: Dimension) -> Option<String> {
        let shown = match (0..3).find(|&times| Dimension::ONE.per_time(times) == Some(own))? {
            0 => "rad",
            1 => "rad/s",
            _ => "rad/s^2",
        };
        let (mut angles, mut others) = (0, 0);
        output.value.walk(&mut |part| match &part.kind {
            Kind::Name(name) | Kind::Element(name, _) => {
                let mut coordinates = self.declaration.coordinates.iter();
                let own = coordinates.find(|item| item.name == *name);
                if let Some((unit, _)) = own.and_then(|item| item.unit.as_ref()) {
                    let count = if unit.text == "rad" {
                        &mut angles
                    } else {
                        &mut others
                    };
                    *count += 1;
                }
            }
            Kind::Force(_) => others += 1,
            _ => {}
        });
        (angles > 0 && others == 0).then(|| shown.to_owned())
    }

    fn statement(&mut self, statement: &Statement) -> syn::Result<()> {
        match statement {
            Statement::Equation(Equation { left, right }) => {
                let first = self.of(left)?;
                let second = self.of(right)?;
                agree(&first, &second, right, "the left side").map(|_| ())
            }
            Statement::Loop(repeated) => self.repeat(repeated, |checker| {
                let mut statements = repeated.body.iter();
                statements.try_for_each(|statement| checker.statement(statement))
            }),
        }
    }

    fn repeat<T>(
        &mut self,
        repeated: &Loop<T>,
        mut body: impl FnMut(&mut Self) -> syn::Result<()>,
    ) -> syn::Result<()> {
        self.names
            .insert(repeated.index.to_string(), Some(Dimension::ONE));
        for index in self.constants.range(repeated)? {
            self.constants.set(repeated, index);
            for item in &repeated.lets {
                let measure = self.of(&item.value)?;
                self.names.insert(item.name.to_string(), measure);
                self.constants.name(item);
            }
            body(self)?;
        }
        self.constants.leave(repeated);
        Ok(())
    }

    /// What an expression is measured in.
    fn of(&mut self, expression: &Expr) -> syn::Result<Measure> {
        match &expression.kind {
            Kind::Number(value, _) => Ok((!value.is_zero()).then_some(Dimension::ONE)),
            Kind::Name(name) | Kind::Element(name, _) => {
                let measure = self.names.get(&name.to_string());
                Ok(measure.copied().unwrap_or(Some(Dimension::ONE)))
            }
            Kind::Sum(terms) => self.same(terms.iter().map(|(_, term)| term)),
            Kind::Product(factors) => self.product(factors, expression.extent),
            Kind::Power(base, exponent) => self.power(base, exponent, expression.extent),
            Kind::Absolute(operand) => self.of(operand),
            Kind::Force(law) => self.force(law, expression),
            Kind::Call(name, arguments) => {
                self.call(&name.to_string(), arguments, expression.extent)
            }
            Kind::Sigma(repeated) => {
                let mut sum = None;
                self.repeat(repeated, |checker| {
                    let term = checker.of(&repeated.body)?;
                    sum = agree(&sum, &term, &repeated.body, "the sum before it")?;
                    Ok(())
                })?;
                Ok(sum)
            }
        }
    }

    /// What is added or compared is measured alike; the fault is at the first that is not.
    fn same<'b>(&mut self, terms: impl Iterator<Item = &'b Expr>) -> syn::Result<Measure> {
        let mut sum = None;
        for term in terms {
            let own = self.of(term)?;
            sum = agree(&sum, &own, term, "what stands before it")?;
        }
        Ok(sum)
    }

    fn product(&mut self, factors: &[(bool, Expr)], extent: Extent) -> syn::Result<Measure> {
        let mut product = Some(Dimension::ONE);
        for (divided, factor) in factors {
            let own = self.of(factor)?;
            let sign = Rational::integer(if *divided { -1 } else { 1 });
            product = match (product, own) {
                (Some(product), Some(own)) => {
                    let power = own.power(sign).and_then(|own| product.times(own));
                    Some(power.ok_or_else(|| too_large(extent))?)
                }
                _ => None,
            };
        }
        Ok(product)
    }

    /// Any exact power of anything; powers known at run time of plain numbers alone.
    fn power(&mut self, base: &Expr, exponent: &Expr, extent: Extent) -> syn::Result<Measure> {
        let measure = self.of(base)?;
        self.plain(exponent, "an exponent")?;
        let Some(measure) = measure else {
            return Ok(None);
        };
        if measure == Dimension::ONE {
            return Ok(Some(measure));
        }
        let Some(exponent_value) = self.constants.value(exponent) else {
            return Err(base.extent.fault(format!(
                "`{0}` is in {measure}, and its exponent `{1}` is known at run time only, so the power has no unit: divide by a reference value, as in `({0}/reference)^{1}`",
                shortened(base),
                shortened(exponent)
            )));
        };
        let power = measure.power(exponent_value);
        power.map(Some).ok_or_else(|| too_large(extent))
    }

    /// What must be a plain number is one.
    fn plain(&mut self, expression: &Expr, what: &str) -> syn::Result<()> {
        match self.of(expression)? {
            Some(measure) if measure != Dimension::ONE => Err(expression.extent.fault(format!(
                "{what} must be a plain number, and `{}` is in {measure}",
                shortened(expression)
            ))),
            _ => Ok(()),
        }
    }

    fn call(&mut self, name: &str, arguments: &[Expr], extent: Extent) -> syn::Result<Measure> {
        let declaration = self.declaration;
        if let Some(law) = declaration.laws.iter().find(|law| law.name == name) {
            let measures = arguments.iter().map(|argument| self.of(argument));
            let measures = measures.collect::<syn::Result<Vec<_>>>()?;
            let force = self.law(law, measures)?;
            if self.depth == 0 {
                self.forces.push((name.to_owned(), force));
            }
            return Ok(force);
        }
        let [argument, ..] = arguments else {
            return Ok(None);
        };
        match name {
            "max" | "min" => self.same(arguments.iter()),
            "abs" => self.of(argument),
            "H" | "sgn" => self.of(argument).map(|_| Some(Dimension::ONE)),
            "sqrt" | "dot" | "ddot" => {
                let Some(own) = self.of(argument)? else {
                    return Ok(None);
                };
                let measure = match name {
                    "sqrt" => Rational::new(1, 2).and_then(|half| own.power(half)),
                    "dot" => own.per_time(1),
                    _ => own.per_time(2),
                };
                measure.map(Some).ok_or_else(|| too_large(extent))
            }
            _ => {
                self.plain(argument, &format!("the argument of `{name}`"))?;
                Ok(Some(Dimension::ONE))
            }
        }
    }

    /// A law is checked once for each way of measuring its gap and arguments.
    fn law(&mut self, law: &Law, measures: Vec<Measure>) -> syn::Result<Measure> {
        let key = (law.name.to_string(), measures);
        if let Some(&measure) = self.known.get(&key) {
            return Ok(measure);
        }
        let outer = self.names.clone();
        let names = std::iter::once(&law.gap).chain(&law.arguments);
        for (name, &measure) in names.zip(&key.1) {
            self.names.insert(name.to_string(), measure);
        }
        self.depth += 1;
        let mut force = None;
        for piece in &law.pieces {
            self.condition(piece)?;
            let own = self.of(&piece.force)?;
            force = agree(
                &force,
                &own,
                &piece.force,
                "the force of the pieces before it",
            )?;
        }
        self.depth -= 1;
        self.names = outer;
        self.known.insert(key, force);
        Ok(force)
    }

    /// What a law is measured in where it acts: in one unit, whatever the contact.
    fn force(&self, law: &Ident, expression: &Expr) -> syn::Result<Measure> {
        let own = self.forces.iter().filter(|(name, _)| law == name);
        let mut measures = own.filter_map(|(_, measure)| *measure);
        let Some(first) = measures.next() else {
            return Ok(None);
        };
        match measures.find(|other| *other != first) {
            None => Ok(Some(first)),
            Some(other) => Err(expression.extent.fault(format!(
                "`{law}` {} where it acts once and {} where it acts again: write the force that is meant as in the equation, with its gap",
                said(first),
                said(other)
            ))),
        }
    }

    /// Of each law whose forces are measured in one unit, and are no plain numbers.
    fn units_of_laws(&self) -> HashMap<String, String> {
        let unit = |law: &Law| {
            let own = self.forces.iter().filter(|(name, _)| law.name == name);
            let mut measures = own.filter_map(|(_, measure)| *measure);
            let first = measures.next().filter(|first| *first != Dimension::ONE)?;
            let alike = measures.all(|other| other == first);
            alike.then(|| (law.name.to_string(), first.to_string()))
        };
        self.declaration.laws.iter().filter_map(unit).collect()
    }

    fn condition(&mut self, piece: &Piece) -> syn::Result<()> {
        let Condition::All(comparisons, _) = &piece.condition else {
            return Ok(());
        };
        for comparison in comparisons {
            self.same([&comparison.smaller, &comparison.larger].into_iter())?;
        }
        Ok(())
    }
}

/// What something is measured in, as it is said of it.
fn said(own: Dimension) -> String {
    if own == Dimension::ONE {
        "has no unit".to_owned()
    } else {
        format!("is in {own}")
    }
}

fn agree(before: &Measure, own: &Measure, term: &Expr, what: &str) -> syn::Result<Measure> {
    match (before, own) {
        (Some(before), Some(own)) if before != own => Err(term.extent.fault(format!(
            "`{}` {}, and {what} {}: they cannot be added or compared",
            shortened(term),
            said(*own),
            said(*before)
        ))),
        (Some(_), _) => Ok(*before),
        (None, own) => Ok(*own),
    }
}

fn too_large(extent: Extent) -> syn::Error {
    extent.fault("the unit of this has exponents that are too large")
}
