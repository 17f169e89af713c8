//! A law without a model, `Name(gap, argument range, ...) { pieces }`, read as the smallest model that has it:
//! `Name(x) { param argument range; ... law Name(gap) { pieces } ddot(x) + Name(x) = 0; }`.

use proc_macro2::{Ident, Span};

use super::Parser;
use super::tokens::Token;
use crate::ast::{Coordinate, Declaration, Equation, Expr, Form, Kind, Law, Parameter, Statement};
use crate::dag::Rational;
use crate::errors::Extent;

impl Parser<'_> {
    /// A fault after the name is reported, so that the type exists.
    pub(super) fn law_alone(&mut self) -> syn::Result<Declaration> {
        let documentation = self.documentation()?;
        let visibility = self.visibility()?;
        let name = self.name("a name for the law, as in `pub Contact(gap, k) { ... }`")?;
        let mut declaration = Declaration::named(name, Form::LawAlone);
        declaration.documentation = documentation;
        declaration.visibility = visibility;
        if let Err(fault) = self.body_of_law(&mut declaration) {
            self.diagnostics.add(fault);
            return Ok(declaration);
        }
        self.end("nothing after the closing `}`: one law per macro");
        Ok(declaration)
    }

    /// `(gap, argument range, ...) { pieces }`
    fn body_of_law(&mut self, declaration: &mut Declaration) -> syn::Result<()> {
        let mut gap = None;
        let example = "the gap and the arguments in parentheses, as in `Contact(gap, k)`";
        self.list(example, |parser| {
            if gap.is_none() {
                gap = Some(parser.gap_alone()?);
            } else {
                let argument = parser.argument_alone()?;
                declaration.parameters.push(argument);
            }
            Ok(())
        })?;
        let Some(gap) = gap else {
            return Err(self.unexpected(example));
        };
        let law = Law {
            name: declaration.name.clone(),
            gap,
            arguments: Vec::new(),
            pieces: self.pieces()?,
        };
        surround(declaration, law);
        Ok(())
    }

    /// The gap is declared by its name alone.
    fn gap_alone(&mut self) -> syn::Result<Ident> {
        let name = self.name("the name of the gap")?;
        let place = self.tokens.here();
        let [more, less, unit, default] = [">", "<", ":", "="].map(|sign| self.tokens.is(sign));
        if more || less || unit || default || self.tokens.take_word("in") {
            let message = format!(
                "the gap has no range, unit or default: write `{name}` alone, and say with a piece where there is a force, as in `{name} > 0 => k*{name}`"
            );
            self.diagnostics.report(place, message);
            self.skip_to_next();
        }
        Ok(name)
    }

    /// `name range`
    fn argument_alone(&mut self) -> syn::Result<Parameter> {
        let mut parameter = Parameter::named(self.name("the name of an argument")?);
        let place = self.tokens.here();
        if self.unit()?.is_some() {
            self.diagnostics.report(
                place.to(self.tokens.before()),
                "an argument here has no unit: the law is evaluated with numbers as they are; remove it",
            );
        }
        self.default_is_not_given(&parameter.name)?;
        self.range(&mut parameter)?;
        self.default_is_not_given(&parameter.name)?;
        if !self.tokens.is(",") && !matches!(self.tokens.peek(), Token::Close(_)) {
            return Err(self.unexpected("`,`, `)`, or a range such as `in 0.0..` or `> 0`"));
        }
        Ok(parameter)
    }

    fn default_is_not_given(&mut self, name: &Ident) -> syn::Result<()> {
        let place = self.tokens.here();
        if self.tokens.is("=") {
            self.tokens.next();
            if self.limit(true)?.is_none() {
                return Err(self.unexpected("a number"));
            }
            let message = format!(
                "an argument here has no default: write `{name}` without it, and give the value where the law is attached, with `Contact::arguments`"
            );
            self.diagnostics
                .report(place.to(self.tokens.before()), message);
        }
        Ok(())
    }
}

/// The smallest model with a law.
fn surround(declaration: &mut Declaration, law: Law) {
    let span: Span = law.name.span();
    let extent = Extent::at(span);
    let expression = |kind| Expr { kind, extent };
    let coordinate = Ident::new("coordinate_of_the_law", span);
    let call = |name: Ident| {
        let operand = expression(Kind::Name(coordinate.clone()));
        expression(Kind::Call(name, vec![operand]))
    };
    let acceleration = call(Ident::new("ddot", span));
    let force = call(law.name.clone());
    declaration.equations.push(Statement::Equation(Equation {
        left: expression(Kind::Sum(vec![(false, acceleration), (false, force)])),
        right: expression(Kind::Number(Rational::ZERO, "0".to_owned())),
    }));
    declaration.coordinates.push(Coordinate {
        name: coordinate,
        count: None,
        unit: None,
    });
    declaration.laws.push(law);
}
