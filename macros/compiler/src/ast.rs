//! A declaration as written: what parsing makes of tokens.

use std::fmt;

use proc_macro2::Ident;

use crate::dag::Rational;
use crate::errors::Extent;

/// The macro that a declaration stands in. A law alone is the law of the smallest model that has it: its arguments
/// are the parameters, and messages call them what their reader has written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Form {
    /// `oscillator!`
    #[default]
    Model,
    /// `law!`
    LawAlone,
}

impl Form {
    /// What a parameter is called.
    pub fn parameter(self) -> &'static str {
        match self {
            Self::Model => "parameter",
            Self::LawAlone => "argument",
        }
    }

    /// How to declare the range of a parameter; `declared` is its name with the range.
    pub fn how_to_declare_range(self, declared: &str) -> String {
        match self {
            Self::Model => format!("declare its range, as in `param {declared};`"),
            Self::LawAlone => format!("write `{declared}` in the list of arguments"),
        }
    }
}

/// A whole declaration, or as much of it as could be read.
#[derive(Debug, Clone)]
pub struct Declaration {
    /// The macro it stands in.
    pub form: Form,
    /// Text of the doc comments.
    pub documentation: String,
    /// Visibility of the type.
    pub visibility: syn::Visibility,
    /// Name of the type.
    pub name: Ident,
    /// Coordinates, and arrays of them.
    pub coordinates: Vec<Coordinate>,
    /// `param` items.
    pub parameters: Vec<Parameter>,
    /// `law` items.
    pub laws: Vec<Law>,
    /// `let` items.
    pub lets: Vec<Let>,
    /// Equations of motion, and loops of them.
    pub equations: Vec<Statement>,
    /// `output` items.
    pub outputs: Vec<Output>,
}

/// `name`, or `name[count]`
#[derive(Debug, Clone)]
pub struct Coordinate {
    /// Its name.
    pub name: Ident,
    /// How many elements an array has; `None` for a single coordinate.
    pub count: Option<usize>,
    /// Its unit.
    pub unit: Option<(Unit, Extent)>,
}

impl Coordinate {
    /// How many equations of motion it needs.
    pub fn size(&self) -> usize {
        self.count.unwrap_or(1)
    }
}

impl Declaration {
    /// A name, and nothing declared.
    pub fn named(name: Ident, form: Form) -> Self {
        Self {
            form,
            documentation: String::new(),
            visibility: syn::Visibility::Inherited,
            name,
            coordinates: Vec::new(),
            parameters: Vec::new(),
            laws: Vec::new(),
            lets: Vec::new(),
            equations: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// The names of all coordinates, those of arrays by element, with the name each stands in.
    pub fn elements(&self) -> impl Iterator<Item = (String, &Ident)> {
        self.coordinates.iter().flat_map(|coordinate| {
            let name = &coordinate.name;
            (0..coordinate.size()).map(move |index| match coordinate.count {
                Some(_) => (format!("{name}[{index}]"), name),
                None => (name.to_string(), name),
            })
        })
    }
}

/// `param name: unit = default range;`
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
    /// Its value where none is given.
    pub default: Option<(f64, Extent)>,
    /// Its unit.
    pub unit: Option<(Unit, Extent)>,
}

impl Parameter {
    /// A name, and nothing declared of it.
    pub fn named(name: Ident) -> Self {
        Self {
            documentation: String::new(),
            range: Extent::at(name.span()),
            name,
            minimum: None,
            maximum: None,
            default: None,
            unit: None,
        }
    }
}

/// A unit as written: symbols, each to an exact power.
#[derive(Debug, Clone, Default)]
pub struct Unit {
    /// The symbols with their places.
    pub factors: Vec<(Ident, Rational)>,
    /// All of it as written.
    pub text: String,
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

/// `output name: unit = value;`
#[derive(Debug, Clone)]
pub struct Output {
    /// Text of the doc comments.
    pub documentation: String,
    /// Its name.
    pub name: Ident,
    /// Its unit.
    pub unit: Option<(Unit, Extent)>,
    /// What it is equal to.
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

/// An equation, or a loop of equations.
#[derive(Debug, Clone)]
pub enum Statement {
    /// One equation.
    Equation(Equation),
    /// The same equations for every index.
    Loop(Box<Loop<Vec<Statement>>>),
}

/// `for index in start..end { let name = value; body }`
#[derive(Debug, Clone)]
pub struct Loop<T> {
    /// Name of the index.
    pub index: Ident,
    /// First index.
    pub start: Expr,
    /// Last index, or the one after it.
    pub end: Expr,
    /// Whether `end` itself is an index.
    pub inclusive: bool,
    /// `let` items, made anew for every index.
    pub lets: Vec<Let>,
    /// What is repeated.
    pub body: T,
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
    /// `force(law)`, in an output
    Force(Ident),
    /// `name[index]`
    Element(Ident, Box<Expr>),
    /// `for index in range { term }`: the sum of the terms.
    Sigma(Box<Loop<Expr>>),
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
            Kind::Number(..) | Kind::Name(_) | Kind::Force(_) => Vec::new(),
            Kind::Call(_, arguments) => arguments.iter().collect(),
            Kind::Element(_, index) => vec![index],
            Kind::Sigma(repeated) => repeated
                .expressions()
                .chain(std::iter::once(&repeated.body))
                .collect(),
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

    /// Visits this expression and everything in it, with the loops around each part.
    pub fn walk_in<'a>(&'a self, loops: &Scope<'a>, visit: &mut dyn FnMut(&'a Expr, &Scope<'a>)) {
        visit(self, loops);
        if let Kind::Sigma(repeated) = &self.kind {
            let inner = repeated.walk_head(loops, visit);
            repeated.body.walk_in(&inner, visit);
        } else {
            for operand in self.operands() {
                operand.walk_in(loops, visit);
            }
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

/// The names that loops around an expression declare, outermost first.
pub type Scope<'a> = Vec<(&'static str, &'a Ident)>;

impl<T> Loop<T> {
    /// The expressions of its head: the two ends, and the values of its `let` items.
    pub fn expressions(&self) -> impl Iterator<Item = &Expr> {
        [&self.start, &self.end]
            .into_iter()
            .chain(self.lets.iter().map(|item| &item.value))
    }

    /// Visits the expressions of its head, each with the names it may use; the names for the body are returned.
    pub fn walk_head<'a>(
        &'a self,
        loops: &Scope<'a>,
        visit: &mut dyn FnMut(&'a Expr, &Scope<'a>),
    ) -> Scope<'a> {
        self.start.walk_in(loops, visit);
        self.end.walk_in(loops, visit);
        let mut inner = loops.clone();
        inner.push(("index", &self.index));
        for item in &self.lets {
            item.value.walk_in(&inner, visit);
            inner.push(("`let`", &item.name));
        }
        inner
    }

    /// Everything before the body.
    fn write_head(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let dots = if self.inclusive { "..=" } else { ".." };
        write!(
            formatter,
            "for {} in {}{dots}{} {{ ",
            self.index, self.start, self.end
        )?;
        for item in &self.lets {
            write!(formatter, "let {} = {}; ", item.name, item.value)?;
        }
        Ok(())
    }
}

impl Statement {
    /// Visits its expressions, each with the names of the loops around it.
    pub fn walk_in<'a>(&'a self, loops: &Scope<'a>, visit: &mut dyn FnMut(&'a Expr, &Scope<'a>)) {
        match self {
            Self::Equation(equation) => {
                equation.left.walk_in(loops, visit);
                equation.right.walk_in(loops, visit);
            }
            Self::Loop(repeated) => {
                let inner = repeated.walk_head(loops, visit);
                for statement in &repeated.body {
                    statement.walk_in(&inner, visit);
                }
            }
        }
    }

    /// The equations as written, each once.
    pub fn equations(&self) -> Vec<&Equation> {
        match self {
            Self::Equation(equation) => vec![equation],
            Self::Loop(repeated) => repeated.body.iter().flat_map(Self::equations).collect(),
        }
    }
}

impl fmt::Display for Statement {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Equation(equation) => write!(formatter, "{equation}"),
            Self::Loop(repeated) => {
                repeated.write_head(formatter)?;
                for statement in &repeated.body {
                    write!(formatter, "{statement}; ")?;
                }
                formatter.write_str("}")
            }
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
            Kind::Force(law) => write!(formatter, "force({law})"),
            Kind::Element(name, index) => write!(formatter, "{name}[{index}]"),
            Kind::Sigma(repeated) => {
                repeated.write_head(formatter)?;
                write!(formatter, "{} }}", repeated.body)
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

impl fmt::Display for Let {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "let {} = {}", self.name, self.value)
    }
}

impl fmt::Display for Law {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "law {}({}", self.name, self.gap)?;
        for argument in &self.arguments {
            write!(formatter, ", {argument}")?;
        }
        formatter.write_str(") { ")?;
        for (index, piece) in self.pieces.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            formatter.write_str(comma)?;
            match &piece.condition {
                Condition::Always => {}
                Condition::Else(_) => formatter.write_str("else => ")?,
                Condition::All(comparisons, _) => {
                    let all = comparisons
                        .iter()
                        .map(|comparison| comparison.of(&self.gap));
                    let all: Vec<String> = all.collect();
                    write!(formatter, "{} => ", all.join(" && "))?;
                }
            }
            write!(formatter, "{}", piece.force)?;
        }
        formatter.write_str(" }")
    }
}

impl Comparison {
    /// As one writes it: the gap first where it is compared.
    fn of(&self, gap: &Ident) -> String {
        let equal = if self.or_equal { "=" } else { "" };
        let Self {
            smaller, larger, ..
        } = self;
        match &larger.kind {
            Kind::Name(name) if name == gap => format!("{larger} >{equal} {smaller}"),
            _ => format!("{smaller} <{equal} {larger}"),
        }
    }
}

impl fmt::Display for Equation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} = {}", self.left, self.right)
    }
}
