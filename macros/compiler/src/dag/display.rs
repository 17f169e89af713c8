//! Expressions as a person writes them.

use std::collections::HashMap;

use super::{Dag, Function, Id, Node, Rational, Variable};

/// How tightly the outermost operation of a text binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

/// A longer text is cut, at every node: shared parts would double it with each use.
const LONGEST: usize = 2000;

impl Dag {
    /// The expression in infix notation; of a very long one the beginning, and `...`.
    pub fn display(&self, id: Id, names: &dyn Fn(Variable) -> String) -> String {
        let mut texts: HashMap<Id, (String, Binding)> = HashMap::new();
        for current in self.reachable(&[id]) {
            let at_least = |operand: &Id, binding: Binding| {
                let (text, own) = &texts[operand];
                if *own >= binding {
                    text.clone()
                } else {
                    format!("({text})")
                }
            };
            let text = match self.node(current) {
                Node::Number(number) => display_number(*number),
                Node::Pi => ("pi".to_owned(), Binding::Atom),
                Node::Variable(variable) => (names(*variable), Binding::Atom),
                Node::Sum(terms) => (self.display_sum(terms, &at_least), Binding::Sum),
                Node::Product(factors) => {
                    (self.display_product(factors, &at_least), Binding::Product)
                }
                Node::Power(base, exponent) if self.is_minus_one(*exponent) => (
                    format!("1/{}", at_least(base, Binding::Power)),
                    Binding::Product,
                ),
                Node::Power(base, exponent) => {
                    let (base, exponent) = (
                        at_least(base, Binding::Atom),
                        at_least(exponent, Binding::Atom),
                    );
                    (format!("{base}^{exponent}"), Binding::Power)
                }
                Node::PowerLog(base, exponent) => {
                    let logarithm = format!("ln({})", texts[base].0);
                    let power = (
                        at_least(base, Binding::Atom),
                        at_least(exponent, Binding::Atom),
                    );
                    (
                        format!("{}^{}*{logarithm}", power.0, power.1),
                        Binding::Product,
                    )
                }
                Node::Call(Function::Absolute, operand) => {
                    (format!("|{}|", texts[operand].0), Binding::Atom)
                }
                Node::Call(function, operand) => (
                    format!("{}({})", function_name(*function), texts[operand].0),
                    Binding::Atom,
                ),
            };
            texts.insert(current, (cut(text.0), text.1));
        }
        texts.remove(&id).map(|(text, _)| text).unwrap_or_default()
    }

    /// Positive terms first, and a number last, as one would write it.
    fn display_sum(&self, terms: &[Id], at_least: &dyn Fn(&Id, Binding) -> String) -> String {
        let mut terms: Vec<(bool, bool, String)> = terms
            .iter()
            .map(|term| {
                let text = at_least(term, Binding::Sum);
                (text.starts_with('-'), self.as_number(*term).is_some(), text)
            })
            .collect();
        terms.sort_by_key(|&(negative, number, _)| (negative, number));
        let mut joined = String::new();
        for (_, _, text) in terms {
            if joined.len() > LONGEST {
                break;
            }
            let (sign, magnitude) = match text.strip_prefix('-') {
                _ if joined.is_empty() => ("", text.as_str()),
                Some(magnitude) => (" - ", magnitude),
                None => (" + ", text.as_str()),
            };
            joined.push_str(sign);
            joined.push_str(magnitude);
        }
        joined
    }

    fn display_product(&self, factors: &[Id], at_least: &dyn Fn(&Id, Binding) -> String) -> String {
        let mut above = Vec::new();
        let mut below = Vec::new();
        let mut sign = "";
        let mut factors = factors.to_vec();
        factors.sort_by_key(|&factor| self.rank(factor));
        for factor in &factors {
            match self.node(*factor) {
                Node::Number(number) if number.is_negative() => {
                    sign = "-";
                    let magnitude = number.absolute().unwrap_or(*number);
                    if magnitude != Rational::ONE {
                        above.push(display_number(magnitude).0);
                    }
                }
                Node::Power(base, exponent) if self.is_minus_one(*exponent) => {
                    below.push(at_least(base, Binding::Power));
                }
                _ => above.push(at_least(factor, Binding::Product)),
            }
        }
        let mut text = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join("*")
        };
        for divisor in below {
            text.push('/');
            text.push_str(&divisor);
        }
        format!("{sign}{text}")
    }

    /// Where a factor stands in a product: numbers, parameters, time and frequency, coordinates, everything else.
    fn rank(&self, factor: Id) -> usize {
        match *self.node(factor) {
            Node::Number(_) | Node::Pi => 0,
            Node::Variable(Variable::Argument(_) | Variable::Parameter(_)) => 1,
            Node::Variable(Variable::Omega | Variable::Time) => 2,
            Node::Variable(_) => 3,
            Node::Power(base, _) => self.rank(base),
            _ => 4,
        }
    }

    fn is_minus_one(&self, id: Id) -> bool {
        self.as_number(id) == Some(Rational::integer(-1))
    }
}

/// At most as much of a text as is shown.
fn cut(mut text: String) -> String {
    if let Some((end, _)) = text.char_indices().nth(LONGEST) {
        text.truncate(end);
        text.push_str("...");
    }
    text
}

/// Decimal where that is exact and short, or where it is no fraction; a fraction otherwise.
fn display_number(number: Rational) -> (String, Binding) {
    let alone = if number.is_negative() {
        Binding::Sum
    } else {
        Binding::Atom
    };
    if number
        .fraction()
        .is_none_or(|(_, denominator)| denominator == 1)
    {
        return (number.to_string(), alone);
    }
    let decimal = number.to_f64().to_string();
    if decimal.len() <= 8 && Rational::from_decimal(&decimal) == Some(number) {
        return (decimal, alone);
    }
    (number.to_string(), Binding::Product)
}

fn function_name(function: Function) -> &'static str {
    match function {
        Function::Absolute => "abs",
        Function::Sign => "sgn",
        Function::Step => "H",
        Function::Sine => "sin",
        Function::Cosine => "cos",
        Function::Exponential => "exp",
        Function::Tanh => "tanh",
    }
}
