//! Expressions of a declaration: printed in the language of the macro, and evaluated here by nothing of the library.

use std::fmt::{self, Display, Formatter};

/// `sin` or `cos` of `numerator/denominator*omega*t`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wave {
    pub sine: bool,
    pub numerator: u32,
    pub denominator: u32,
}

impl Wave {
    pub fn cosine(numerator: u32, denominator: u32) -> Self {
        Self {
            sine: false,
            numerator,
            denominator,
        }
    }

    pub fn sine(numerator: u32, denominator: u32) -> Self {
        Self {
            sine: true,
            ..Self::cosine(numerator, denominator)
        }
    }

    fn ratio(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator)
    }

    /// At a phase `omega t`.
    pub fn value(self, phase: f64) -> f64 {
        let angle = self.ratio() * phase;
        if self.sine { angle.sin() } else { angle.cos() }
    }

    /// Derivative by the phase.
    pub fn slope(self, phase: f64) -> f64 {
        let angle = self.ratio() * phase;
        self.ratio() * if self.sine { angle.cos() } else { -angle.sin() }
    }
}

impl Display for Wave {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = if self.sine { "sin" } else { "cos" };
        match (self.numerator, self.denominator) {
            (1, 1) => write!(f, "{name}(omega*t)"),
            (n, 1) => write!(f, "{name}({n}*omega*t)"),
            (n, d) => write!(f, "{name}({n}/{d}*omega*t)"),
        }
    }
}

/// A part of a law or of an equation.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// Not negative.
    Number(f64),
    /// By position in the table of parameters.
    Parameter(usize),
    /// The gap of the law.
    Gap,
    /// Its rate.
    Rate,
    /// A coordinate.
    Position(usize),
    /// Its derivative by time.
    Velocity(usize),
    /// The excitation frequency.
    Omega,
    Wave(Wave),
    Sum(Vec<Expression>),
    Product(Vec<Expression>),
    Quotient(Box<[Expression; 2]>),
    Power(Box<[Expression; 2]>),
    Negative(Box<Expression>),
    Tanh(Box<Expression>),
    Exp(Box<Expression>),
    Abs(Box<Expression>),
    /// The sign, which is zero at zero.
    Sign(Box<Expression>),
    /// The larger one of zero and this.
    Positive(Box<Expression>),
    /// The force of a contact.
    Force(usize),
}

/// What an expression is evaluated at.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    pub parameters: &'a [f64],
    pub omega: f64,
    pub phase: f64,
    pub positions: &'a [f64],
    pub velocities: &'a [f64],
    pub gap: f64,
    pub rate: f64,
    pub forces: &'a [f64],
}

impl<'a> Place<'a> {
    /// Parameters alone.
    pub fn of(parameters: &'a [f64]) -> Self {
        Self {
            parameters,
            omega: 0.0,
            phase: 0.0,
            positions: &[],
            velocities: &[],
            gap: 0.0,
            rate: 0.0,
            forces: &[],
        }
    }
}

impl Expression {
    pub fn over(self, divisor: Self) -> Self {
        Self::Quotient(Box::new([self, divisor]))
    }

    pub fn to(self, exponent: Self) -> Self {
        Self::Power(Box::new([self, exponent]))
    }

    pub fn times(self, factor: Self) -> Self {
        Self::Product(vec![self, factor])
    }

    pub fn plus(self, term: Self) -> Self {
        Self::Sum(vec![self, term])
    }

    pub fn negative(self) -> Self {
        Self::Negative(Box::new(self))
    }

    pub fn tanh(self) -> Self {
        Self::Tanh(Box::new(self))
    }

    pub fn exp(self) -> Self {
        Self::Exp(Box::new(self))
    }

    pub fn abs(self) -> Self {
        Self::Abs(Box::new(self))
    }

    pub fn sign(self) -> Self {
        Self::Sign(Box::new(self))
    }

    pub fn positive(self) -> Self {
        Self::Positive(Box::new(self))
    }

    /// Its value. The power of a negative base to a fraction is zero: a piece is asked for that beyond its end only, by the last
    /// stages of a step that is cut there.
    pub fn value(&self, at: &Place<'_>) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Parameter(index) => at.parameters[*index],
            Self::Gap => at.gap,
            Self::Rate => at.rate,
            Self::Position(index) => at.positions[*index],
            Self::Velocity(index) => at.velocities[*index],
            Self::Omega => at.omega,
            Self::Wave(wave) => wave.value(at.phase),
            Self::Sum(terms) => terms.iter().map(|term| term.value(at)).sum(),
            Self::Product(factors) => factors.iter().map(|factor| factor.value(at)).product(),
            Self::Quotient(parts) => parts[0].value(at) / parts[1].value(at),
            Self::Power(parts) => power(parts[0].value(at), parts[1].value(at)),
            Self::Negative(inner) => -inner.value(at),
            Self::Tanh(inner) => inner.value(at).tanh(),
            Self::Exp(inner) => inner.value(at).exp(),
            Self::Abs(inner) => inner.value(at).abs(),
            Self::Sign(inner) => {
                let value = inner.value(at);
                if value == 0.0 { 0.0 } else { value.signum() }
            }
            Self::Positive(inner) => inner.value(at).max(0.0),
            Self::Force(contact) => at.forces[*contact],
        }
    }

    /// Its text, with names of parameters and of coordinates, and of what stands for the force of each contact.
    pub fn text(&self, names: &Names) -> String {
        let name = |vector: &[String], index: usize| vector[index].clone();
        match self {
            Self::Number(number) => written(*number),
            Self::Parameter(index) => name(&names.parameters, *index),
            Self::Gap => "gap".to_owned(),
            Self::Rate => "dot(gap)".to_owned(),
            Self::Position(index) => name(&names.coordinates, *index),
            Self::Velocity(index) => format!("dot({})", names.coordinates[*index]),
            Self::Omega => "omega".to_owned(),
            Self::Wave(wave) => wave.to_string(),
            Self::Sum(terms) => sum(terms, names),
            Self::Product(factors) => {
                let atoms: Vec<String> = factors.iter().map(|factor| factor.atom(names)).collect();
                atoms.join("*")
            }
            Self::Quotient(parts) => {
                format!("{}/{}", parts[0].atom(names), parts[1].atom(names))
            }
            Self::Power(parts) => format!("{}^{}", parts[0].atom(names), parts[1].atom(names)),
            Self::Negative(inner) => format!("-{}", inner.atom(names)),
            Self::Tanh(inner) => format!("tanh({})", inner.text(names)),
            Self::Exp(inner) => format!("exp({})", inner.text(names)),
            Self::Abs(inner) => format!("abs({})", inner.text(names)),
            Self::Sign(inner) => format!("sgn({})", inner.text(names)),
            Self::Positive(inner) => format!("max(0, {})", inner.text(names)),
            Self::Force(contact) => name(&names.forces, *contact),
        }
    }

    /// Its text, in parentheses unless it is one thing.
    fn atom(&self, names: &Names) -> String {
        let text = self.text(names);
        let parted = matches!(
            self,
            Self::Sum(_)
                | Self::Product(_)
                | Self::Quotient(_)
                | Self::Power(_)
                | Self::Negative(_)
        );
        if parted { format!("({text})") } else { text }
    }
}

/// Names for the text of an expression.
#[derive(Debug, Default)]
pub struct Names {
    pub parameters: Vec<String>,
    pub coordinates: Vec<String>,
    pub forces: Vec<String>,
}

/// Terms with their signs between them.
pub fn sum(terms: &[Expression], names: &Names) -> String {
    let mut text = String::new();
    for (index, term) in terms.iter().enumerate() {
        let (sign, term) = match term {
            Expression::Negative(inner) => ("-", inner.atom(names)),
            Expression::Sum(_) => ("+", term.atom(names)),
            _ => ("+", term.text(names)),
        };
        let sign = match (index, sign) {
            (0, "+") => "",
            (0, _) => "-",
            (_, "+") => " + ",
            _ => " - ",
        };
        text += sign;
        text += &term;
    }
    text
}

/// A number, whole ones without a point.
fn written(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

fn power(base: f64, exponent: f64) -> f64 {
    if base >= 0.0 || exponent.fract() == 0.0 {
        base.powf(exponent)
    } else {
        0.0
    }
}
