//! Checked models built by hand, as lowering would hand them over.

#![allow(dead_code)]

use hertzian_compiler::dag::{Dag, Id, Rational, Variable};
use hertzian_compiler::ir::{Law, Level, Model, Parameter};
use hertzian_contract::system::{Bound, ContactFacts, Place, Wave};

const POSITIVE: (Bound, Bound) = (Bound::Excluded(0.0), Bound::Unbounded);
const NOT_NEGATIVE: (Bound, Bound) = (Bound::Included(0.0), Bound::Unbounded);
const ANY: (Bound, Bound) = (Bound::Unbounded, Bound::Unbounded);

/// A law being built: its graph, and the arguments declared so far.
pub struct Sketch {
    pub dag: Dag,
    names: Vec<String>,
    ranges: Vec<(Bound, Bound)>,
}

impl Sketch {
    pub fn new(arguments: &[(&str, (Bound, Bound))]) -> Self {
        Self {
            dag: Dag::default(),
            names: arguments
                .iter()
                .map(|(name, _)| (*name).to_owned())
                .collect(),
            ranges: arguments.iter().map(|&(_, range)| range).collect(),
        }
    }

    pub fn gap(&mut self) -> Id {
        self.dag.variable(Variable::Gap)
    }

    pub fn rate(&mut self) -> Id {
        self.dag.variable(Variable::Rate)
    }

    pub fn argument(&mut self, index: usize) -> Id {
        self.dag.variable(Variable::Argument(index))
    }

    pub fn number(&mut self, text: &str) -> Id {
        self.dag
            .number(Rational::from_decimal(text).expect("a literal"))
    }

    pub fn law(&self, name: &str, levels: &[(Id, bool)], pieces: &[Id]) -> Law {
        Law {
            name: name.to_owned(),
            arguments: self.names.clone(),
            ranges: self.ranges.clone(),
            levels: levels
                .iter()
                .map(|&(value, belongs_above)| Level {
                    value,
                    belongs_above,
                })
                .collect(),
            pieces: pieces.to_vec(),
        }
    }

    /// `x'' + law(x) = drive cos(omega t) + load`, with the arguments of the law as parameters.
    pub fn model(mut self, name: &str, law: Law) -> Model {
        let mut parameters = Vec::new();
        let mut coefficients = Vec::new();
        let one = self.dag.integer(1);
        coefficients.push((Place::Mass { row: 0, column: 0 }, one));
        let constant = Wave::CONSTANT;
        coefficients.push((
            Place::ForceDirection {
                contact: 0,
                row: 0,
                wave: constant,
            },
            one,
        ));
        coefficients.push((
            Place::GapDirection {
                contact: 0,
                column: 0,
                wave: constant,
            },
            one,
        ));
        for (index, (argument, range)) in self.names.iter().zip(&self.ranges).enumerate() {
            let (minimum, maximum) = *range;
            parameters.push(parameter(argument, minimum, maximum));
            let value = self.dag.variable(Variable::Parameter(index));
            coefficients.push((Place::Argument { contact: 0, index }, value));
        }
        for (name, wave) in [("load", constant), ("drive", Wave::cosine(1))] {
            let value = self.dag.variable(Variable::Parameter(parameters.len()));
            parameters.push(parameter(name, ANY.0, ANY.1));
            coefficients.push((Place::Load { row: 0, wave }, value));
        }
        Model {
            dag: self.dag,
            visibility: syn::parse_quote!(pub),
            name: quote::format_ident!("{name}"),
            documentation: String::new(),
            equation: format!("ddot(x) + {}(x) = drive*cos(omega*t) + load", law.name),
            coordinates: vec!["x".to_owned()],
            units: Vec::new(),
            parameters,
            divisor: 1,
            laws: vec![law],
            contacts: vec![ContactFacts::new(0)],
            coefficients,
            outputs: Vec::new(),
        }
    }
}

fn parameter(name: &str, minimum: Bound, maximum: Bound) -> Parameter {
    Parameter {
        name: quote::format_ident!("{name}"),
        documentation: String::new(),
        unit: String::new(),
        minimum,
        maximum,
        default: None,
    }
}

/// `gap > 0 => 2*zeta*rate + gap^exponent`
fn one_sided_with(name: &str, exponent: &str) -> Model {
    let mut s = Sketch::new(&[("zeta", NOT_NEGATIVE)]);
    let (gap, rate, zeta) = (s.gap(), s.rate(), s.argument(0));
    let (zero, two, exponent) = (s.number("0"), s.number("2"), s.number(exponent));
    let damping = s.dag.product(&[two, zeta, rate]);
    let spring = s.dag.power(gap, exponent);
    let force = s.dag.sum(&[damping, spring]);
    let law = s.law("contact", &[(zero, false)], &[zero, force]);
    s.model(name, law)
}

pub fn one_sided() -> Model {
    one_sided_with("OneSided", "1.5")
}

pub fn soft() -> Model {
    one_sided_with("Soft", "0.6")
}

/// `gap > 0 => gap^alpha, else => -(-gap)^alpha`
pub fn power_law() -> Model {
    let mut s = Sketch::new(&[("alpha", POSITIVE)]);
    let (gap, alpha, zero) = (s.gap(), s.argument(0), s.number("0"));
    let opposite = s.dag.negate(gap);
    let above = s.dag.power(gap, alpha);
    let below = s.dag.power(opposite, alpha);
    let below = s.dag.negate(below);
    let law = s.law("power", &[(zero, false)], &[below, above]);
    s.model("PowerLaw", law)
}

/// `gap > b => k*(gap - b), gap < -b => k*(gap + b), else => 0`
pub fn backlash() -> Model {
    let mut s = Sketch::new(&[("k", ANY), ("b", NOT_NEGATIVE)]);
    let (gap, k, b, zero) = (s.gap(), s.argument(0), s.argument(1), s.number("0"));
    let lower = s.dag.negate(b);
    let (beyond, before) = (s.dag.difference(gap, b), s.dag.sum(&[gap, b]));
    let above = s.dag.product(&[k, beyond]);
    let below = s.dag.product(&[k, before]);
    let law = s.law(
        "backlash",
        &[(lower, true), (b, false)],
        &[below, zero, above],
    );
    s.model("Backlash", law)
}

/// `gap > 0 => k*gap^1.5*(1 + c*rate)`
pub fn hunt_crossley() -> Model {
    let mut s = Sketch::new(&[("k", ANY), ("c", ANY)]);
    let (gap, rate, k, c) = (s.gap(), s.rate(), s.argument(0), s.argument(1));
    let (zero, one, exponent) = (s.number("0"), s.number("1"), s.number("1.5"));
    let spring = s.dag.power(gap, exponent);
    let damping = s.dag.product(&[c, rate]);
    let factor = s.dag.sum(&[one, damping]);
    let force = s.dag.product(&[k, spring, factor]);
    let law = s.law("contact", &[(zero, false)], &[zero, force]);
    s.model("HuntCrossley", law)
}

/// `gap > d => preload + k*(gap - d)`
pub fn preloaded() -> Model {
    let mut s = Sketch::new(&[("k", ANY), ("d", ANY), ("preload", POSITIVE)]);
    let (gap, k, d, preload) = (s.gap(), s.argument(0), s.argument(1), s.argument(2));
    let zero = s.number("0");
    let beyond = s.dag.difference(gap, d);
    let spring = s.dag.product(&[k, beyond]);
    let force = s.dag.sum(&[preload, spring]);
    let law = s.law("stop", &[(d, true)], &[zero, force]);
    s.model("Preloaded", law)
}

/// `gap > 0 => k*gap^1.5 - pull, else => -pull*a0^2*(a0 - gap)^-2`
pub fn dmt() -> Model {
    let mut s = Sketch::new(&[("k", ANY), ("pull", ANY), ("a0", POSITIVE)]);
    let (gap, k, pull, a0) = (s.gap(), s.argument(0), s.argument(1), s.argument(2));
    let (zero, two, exponent) = (s.number("0"), s.number("2"), s.number("1.5"));
    let hertz = s.dag.power(gap, exponent);
    let hertz = s.dag.product(&[k, hertz]);
    let above = s.dag.difference(hertz, pull);
    let distance = s.dag.difference(a0, gap);
    let ratio = s.dag.quotient(a0, distance);
    let ratio = s.dag.power(ratio, two);
    let attraction = s.dag.product(&[pull, ratio]);
    let below = s.dag.negate(attraction);
    let law = s.law("tip", &[(zero, false)], &[below, above]);
    s.model("Dmt", law)
}

/// `gap > b => k*(gap - b)^alpha*(1 + c*gap*rate), else => 0`: a runtime exponent at a runtime level, and a rate term
/// that is integrated by rewriting it in the base.
pub fn shifted() -> Model {
    let mut s = Sketch::new(&[("k", ANY), ("b", ANY), ("alpha", POSITIVE), ("c", ANY)]);
    let (gap, rate) = (s.gap(), s.rate());
    let [k, b, alpha, c] = [0, 1, 2, 3].map(|index| s.argument(index));
    let (zero, one) = (s.number("0"), s.number("1"));
    let beyond = s.dag.difference(gap, b);
    let spring = s.dag.power(beyond, alpha);
    let damping = s.dag.product(&[c, gap, rate]);
    let factor = s.dag.sum(&[one, damping]);
    let force = s.dag.product(&[k, spring, factor]);
    let law = s.law("contact", &[(b, false)], &[zero, force]);
    s.model("Shifted", law)
}

/// Every model here.
pub fn all() -> Vec<Model> {
    vec![
        one_sided(),
        soft(),
        power_law(),
        backlash(),
        hunt_crossley(),
        preloaded(),
        dmt(),
        shifted(),
    ]
}
