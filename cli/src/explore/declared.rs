//! What a declaration has: parameters with ranges, signals that can be drawn, and its equations.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use hertzian::Model;
use hertzian::generic::Declaration;
use hertzian::system::{Bound, ParameterFacts, System};
use serde::Serialize;

use super::fault::Fault;

/// Declarations that are kept as they were read.
const KEPT: usize = 8;

/// What a page shows of a declaration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Declared {
    /// Name of the declared type.
    pub name: String,
    /// The equations as written.
    pub equation: String,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// What can be drawn: outputs, coordinates, contacts.
    pub signals: Vec<Signal>,
    /// Whether it is measured in units; then time is in seconds.
    pub has_units: bool,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What it is.
    pub documentation: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// Its default; nothing where it has none.
    pub default: Option<f64>,
    /// The lower end of its range.
    pub minimum: Option<End>,
    /// The upper end.
    pub maximum: Option<End>,
}

/// One end of a range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct End {
    /// The value.
    pub value: f64,
    /// Whether the value itself is allowed.
    pub included: bool,
}

/// What can be drawn over the range.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Signal {
    /// Its name.
    pub name: String,
    /// `output`, `coordinate` or `contact`.
    pub kind: &'static str,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// What it is.
    pub documentation: String,
}

/// Declarations by their texts: while a slider is dragged, the same one is asked for again and again.
#[derive(Debug, Default)]
pub struct Texts {
    kept: Mutex<VecDeque<(String, Declaration)>>,
}

impl Texts {
    /// The declaration of a text.
    ///
    /// # Errors
    /// Every fault, with its place.
    pub fn parse(&self, text: &str) -> Result<Declaration, Fault> {
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = lock().iter().find(|(known, _)| known == text) {
            return Ok(known.clone());
        }
        let declaration = Declaration::parse(text)?;
        let mut kept = lock();
        kept.push_front((text.to_owned(), declaration.clone()));
        kept.truncate(KEPT);
        Ok(declaration)
    }
}

/// What a text declares.
///
/// # Errors
/// Every fault, with its place.
pub fn of(text: &str, texts: &Texts) -> Result<Declared, Fault> {
    let declaration = texts.parse(text)?;
    let model = Model::of(&declaration);
    let facts = declaration.facts().parameters.iter();
    let values = declaration.parameters().into_iter();
    let parameters = facts.zip(values);
    Ok(Declared {
        signals: signals(&model),
        parameters: parameters
            .map(|(facts, (_, value))| Parameter::of(facts, value))
            .collect(),
        has_units: !model.units.is_empty(),
        name: model.name,
        equation: model.equation,
    })
}

impl Parameter {
    fn of(facts: &ParameterFacts, default: f64) -> Self {
        let end = |bound: Bound| match bound {
            Bound::Unbounded => None,
            Bound::Included(value) => Some(End {
                value,
                included: true,
            }),
            Bound::Excluded(value) => Some(End {
                value,
                included: false,
            }),
        };
        Self {
            name: facts.name.to_string(),
            documentation: facts.documentation.to_string(),
            unit: facts.unit.to_string(),
            default: default.is_finite().then_some(default),
            minimum: end(facts.minimum),
            maximum: end(facts.maximum),
        }
    }
}

fn signals(model: &Model) -> Vec<Signal> {
    let signal = |name: &String, kind: &'static str, documentation: &str| Signal {
        name: name.clone(),
        kind,
        unit: model.unit_of(name).to_owned(),
        documentation: documentation.to_owned(),
    };
    let outputs = model.outputs.iter();
    let outputs = outputs.map(|output| signal(&output.name, "output", &output.documentation));
    let coordinates = model.coordinates.iter();
    let coordinates = coordinates.map(|name| signal(name, "coordinate", ""));
    let contacts = model.contacts.iter();
    let contacts = contacts.map(|name| signal(name, "contact", ""));
    outputs.chain(coordinates).chain(contacts).collect()
}
