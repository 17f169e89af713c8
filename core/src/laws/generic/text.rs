//! Declarations read from text at run time.

use std::borrow::Cow;
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

use hertzian_compiler::interpret::{Coefficients, Family, Member};
use hertzian_compiler::text::{compile_law_text, compile_text};

pub use hertzian_compiler::text::Fault;

use super::law::{constant, evaluate_constant};
use super::program::Program;
use super::{InterpretedLaw, Node};
use crate::error::{Error, ErrorKind, Room};
use crate::law::Law;
use crate::model::validate;
use crate::system::{System, SystemFacts, Variable};

/// A system declared by text: the same language as [`oscillator!`](crate::oscillator), read at run time and interpreted.
///
/// ```
/// use hertzian::generic::Declaration;
/// use hertzian::system::System;
///
/// let mut model = Declaration::parse(
///     "Stop(x) {
///         param k > 0;
///         ddot(x) + x + H(x - 1)*k*(x - 1) = 0.1*cos(omega*t);
///     }",
/// )?;
/// model.set("k", 30.0)?;
/// assert_eq!(model.facts().parameters[0].name, "k");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A parameter without a default that has not been set is not a number, and a run refuses it by name.
#[derive(Debug, Clone)]
pub struct Declaration {
    facts: SystemFacts,
    values: Vec<f64>,
    coefficients: Program,
    by_omega: Program,
    by_parameter: Vec<Program>,
    laws: Vec<InterpretedLaw>,
}

/// Everything that is wrong with a declaration; at least one fault.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", lines(.faults))]
#[non_exhaustive]
pub struct DeclarationError {
    /// What is wrong, and where.
    pub faults: Vec<Fault>,
}

thread_local! {
    /// Parameters and, after them, the frequency: what the programs of coefficients take as arguments.
    static ARGUMENTS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

impl Declaration {
    /// Reads a declaration.
    ///
    /// # Errors
    /// Every fault, with its place in the text.
    pub fn parse(text: &str) -> Result<Self, DeclarationError> {
        let mut model = compile_text(text).map_err(|faults| DeclarationError { faults })?;
        let facts = model.facts();
        let laws = model.laws.clone();
        let laws = laws
            .iter()
            .map(|law| interpreted(Family::of(&mut model.dag, law)))
            .collect();
        let coefficients = Coefficients::of(&mut model);
        let parameters = model.parameters.iter();
        let defaults = parameters.map(|parameter| parameter.default.unwrap_or(f64::NAN));
        let program = |outputs: &Vec<usize>| constant(&coefficients.nodes, outputs);
        Ok(Self {
            values: defaults.collect(),
            coefficients: program(&coefficients.values),
            by_omega: program(&coefficients.by_omega),
            by_parameter: coefficients.by_parameter.iter().map(program).collect(),
            facts,
            laws,
        })
    }

    /// Sets a parameter. Whether the value is within its range is checked when a run starts, as for any system.
    ///
    /// # Errors
    /// If there is no parameter of that name.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), Error> {
        let parameters = self.facts.parameters.iter();
        let mut names = parameters.map(|parameter| parameter.name.as_ref());
        if let Some(index) = names.position(|known| known == name) {
            self.values[index] = value;
            return Ok(());
        }
        Err(validate::unknown(&self.facts, name))
    }

    /// Names and values of all parameters, in order of declaration.
    pub fn parameters(&self) -> Vec<(&str, f64)> {
        let parameters = self.facts.parameters.iter();
        let names = parameters.map(|parameter| parameter.name.as_ref());
        names.zip(self.values.iter().copied()).collect()
    }
}

/// A law declared by text: the same language as [`law!`](crate::law!), read at run time and interpreted.
///
/// ```
/// use hertzian::generic::law_from_text;
///
/// let law = law_from_text("Stop(gap, k > 0) { gap > 0 => k*gap^1.5, else => 0 }")?;
/// assert_eq!(law.facts().arguments[0].name, "k");
/// # Ok::<(), hertzian::generic::DeclarationError>(())
/// ```
///
/// # Errors
/// Every fault, with its place in the text.
pub fn law_from_text(text: &str) -> Result<Arc<dyn Law>, DeclarationError> {
    let (mut model, law) = compile_law_text(text).map_err(|faults| DeclarationError { faults })?;
    Ok(Arc::new(interpreted(Family::of(&mut model.dag, &law))))
}

impl System for Declaration {
    fn facts(&self) -> &SystemFacts {
        &self.facts
    }

    fn values(&self, values: &mut [f64]) {
        values.copy_from_slice(&self.values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        run(&self.coefficients, parameters, omega, coefficients);
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        let program = match variable {
            Variable::Omega => &self.by_omega,
            Variable::Parameter(index) => &self.by_parameter[index],
        };
        run(program, parameters, omega, derivatives);
    }

    fn law(&self, index: usize) -> &dyn Law {
        &self.laws[index]
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}

fn run(program: &Program, parameters: &[f64], omega: f64, out: &mut [f64]) {
    ARGUMENTS.with_borrow_mut(|arguments| {
        arguments.clear();
        arguments.extend_from_slice(parameters);
        arguments.push(omega);
        evaluate_constant(program, arguments, out);
    });
}

/// A law of what the compiler knows of it.
fn interpreted(family: Family) -> InterpretedLaw {
    let Family {
        nodes,
        whole,
        parts,
    } = family;
    let nodes: Cow<'static, [Node]> = nodes.into();
    let member =
        |member: Member| InterpretedLaw::compiled(member.facts.clone(), member.data(nodes.clone()));
    let law = member(whole);
    match parts.map(|parts| parts.map(member)) {
        Some([spring, primitive]) => law.with_parts(spring, primitive),
        None => law,
    }
}

/// Every fault on a line of its own.
fn lines(faults: &[Fault]) -> String {
    let lines: Vec<_> = faults.iter().map(Fault::to_string).collect();
    lines.join("\n")
}

// As of every error: the sentence, and with `{:#?}` what it consists of.
impl fmt::Debug for DeclarationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return fmt::Display::fmt(self, f);
        }
        f.debug_struct("DeclarationError")
            .field("faults", &self.faults)
            .finish()
    }
}

impl From<DeclarationError> for Error {
    fn from(error: DeclarationError) -> Self {
        Self::new(ErrorKind::Model, error)
    }
}

/// The numbers of each fault are its line and its column, from one on.
impl Room for DeclarationError {
    fn variant(&self) -> &'static str {
        "DeclarationError"
    }

    fn append_values<'s>(&'s self, values: &mut Vec<(&'s str, f64)>) {
        for fault in &self.faults {
            values.push(("line", fault.line as f64));
            values.push(("column", fault.column as f64));
        }
    }
}
