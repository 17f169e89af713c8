//! A declaration as written: what parsing makes of tokens.

use std::fmt;

use proc_macro2::Ident;

use crate::dag::Rational;
use crate::errors::Extent;

/// A whole declaration, or as much of it as could be read.
#[derive(Debug, Clone)]
pub struct Declaration {
    /// Text of the doc comments.
    pub documentation: String,
    /// Visibility of the type.
    pub visibility: syn::Visibility,
    /// Name of the type.
    pub name: Ident,
    /// Names of the coordinates.
    pub coordinates: Vec<Ident>,
    /// `param` items.
    pub parameters: Vec<Parameter>,
    /// `law` items.
    pub laws: Vec<Law>,
    /// `let` items.
    pub lets: Vec<Let>,
    /// Equations of motion.
    pub equations: Vec<Equation>,
}

/// `param name range;`
#[derive(Debug, Clone)]
pub struct Parameter {
    /// Text of the doc comments.
    pub documentation: String,
    /// Its name.
    pub name: Ident,
    /// Lower end of its range.
    pub minimum: Option<Limit>,
    /// Upper end of its range.
    pub maximum: Option<Limit>,
    /// The whole range, or the name where there is none.
    pub range: Extent,
}

/// One end of a range.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// Its value.
    pub value: f64,
    /// The value itself is allowed.
    pub included: bool,
}

/// `law name(gap, arguments) { pieces }`
#[derive(Debug, Clone)]
pub struct Law {
    /// Its name.
    pub name: Ident,
    /// Name of the gap.
    pub gap: Ident,
    /// Names of the arguments.
    pub arguments: Vec<Ident>,
    /// Its pieces, as ordered in the declaration.
    pub pieces: Vec<Piece>,
}

/// `condition => force`
#[derive(Debug, Clone)]
pub struct Piece {
    /// Where the piece holds.
    pub condition: Condition,
    /// Its force.
    pub force: Expr,
}

/// Where a piece holds.
#[derive(Debug, Clone)]
pub enum Condition {
    /// Everywhere: the law is one expression.
    Always,
    /// Wherever no other piece does.
    Else(Extent),
    /// Where all comparisons hold.
    All(Vec<Comparison>, Extent),
}

/// `left < right`, and its three kin.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// Smaller side.
    pub smaller: Expr,
    /// Larger side.
    pub larger: Expr,
    /// The two may be equal.
    pub or_equal: bool,
}

/// `let name = value;`
#[derive(Debug, Clone)]
pub struct Let {
    /// Its name.
    pub name: Ident,
    /// Its value.
    pub value: Expr,
}

/// `left = right;`
#[derive(Debug, Clone)]
pub struct Equation {
    /// Before the sign of equality.
    pub left: Expr,
    /// After it.
    pub right: Expr,
}

/// An expression and where it stands.
#[derive(Debug, Clone)]
pub struct Expr {
    /// What it is.
    pub kind: Kind,
    /// Where it stands.
    pub extent: Extent,
}

/// What an expression is. Sums and products are lists, so that a long one is not a deep one.
#[derive(Debug, Clone)]
pub enum Kind {
    /// A number, exactly, and as written.
    Number(Rational, String),
    /// A name.
    Name(Ident),
    /// `name(arguments)`
    Call(Ident, Vec<Expr>),
    /// Terms, each added or (`true`) subtracted.
    Sum(Vec<(bool, Expr)>),
    /// Factors, each multiplied or (`true`) divided by.
    Product(Vec<(bool, Expr)>),
    /// `base ^ exponent`
    Power(Box<Expr>, Box<Expr>),
    /// `|operand|`
    Absolute(Box<Expr>),
}

impl Expr {
    /// The operands.
    pub fn operands(&self) -> Vec<&Expr> {
        match &self.kind {
            Kind::Number(..) | Kind::Name(_) => Vec::new(),
            Kind::Call(_, arguments) => arguments.iter().collect(),
            Kind::Sum(parts) | Kind::Product(parts) => parts.iter().map(|(_, part)| part).collect(),
            Kind::Power(base, exponent) => vec![base, exponent],
            Kind::Absolute(operand) => vec![operand],
        }
    }

    /// Visits this expression and everything in it, in the order of the text.
    pub fn walk<'a>(&'a self, visit: &mut dyn FnMut(&'a Expr)) {
        visit(self);
        for operand in self.operands() {
            operand.walk(visit);
        }
    }

    /// How tightly the outermost operation binds: 0 for sums, 1 for products, 2 for powers, 3 for the rest.
    fn binding(&self) -> u8 {
        match self.kind {
            Kind::Sum(_) => 0,
            Kind::Product(_) => 1,
            Kind::Power(..) => 2,
            _ => 3,
        }
    }

    fn write(&self, formatter: &mut fmt::Formatter<'_>, at_least: u8) -> fmt::Result {
        if self.binding() < at_least {
            write!(formatter, "({self})")
        } else {
            write!(formatter, "{self}")
        }
    }
}

impl fmt::Display for Expr {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Number(_, text) => formatter.write_str(text),
            Kind::Name(name) => write!(formatter, "{name}"),
            Kind::Call(name, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
                write!(formatter, "{name}({})", arguments.join(", "))
            }
            Kind::Sum(terms) => {
                for (index, (minus, term)) in terms.iter().enumerate() {
                    formatter.write_str(match (index, minus) {
                        (0, false) => "",
                        (0, true) => "-",
                        (_, false) => " + ",
                        (_, true) => " - ",
                    })?;
                    term.write(formatter, 1)?;
                }
                Ok(())
            }
            Kind::Product(factors) => {
                for (index, (divided, factor)) in factors.iter().enumerate() {
                    formatter.write_str(match (index, divided) {
                        (0, _) => "",
                        (_, false) => "*",
                        (_, true) => "/",
                    })?;
                    factor.write(formatter, 2)?;
                }
                Ok(())
            }
            Kind::Power(base, exponent) => {
                base.write(formatter, 3)?;
                formatter.write_str("^")?;
                exponent.write(formatter, 2)
            }
            Kind::Absolute(operand) => write!(formatter, "|{operand}|"),
        }
    }
}

impl fmt::Display for Equation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} = {}", self.left, self.right)
    }
}
