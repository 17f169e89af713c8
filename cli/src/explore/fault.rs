//! What is said where something cannot be done: a sentence, and where it belongs.

use hertzian::error::{ErrorKind, chain};
use hertzian::generic::DeclarationError;
use hertzian::{Error, RequestError};
use serde::Serialize;

use crate::response::model_file::ModelError;

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Fault {
    /// What it is about.
    pub kind: Kind,
    /// A sentence.
    pub message: String,
    /// The field that it belongs to: a parameter, `from`, `to` and so on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// What is wrong with the declaration.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<Place>,
}

/// What a fault is about: so whoever shows it knows where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The request is none that is answered.
    Request,
    /// The declaration.
    Declaration,
    /// A value that is asked for.
    Value,
    /// The computation, which came to nothing.
    Computation,
    /// Too much waits.
    Busy,
    /// A newer request has taken the place of this one.
    Cancelled,
}

/// A fault of a declaration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Place {
    /// Line, from one.
    pub line: usize,
    /// Column, from one, in characters.
    pub column: usize,
    /// What is wrong, and mostly what to write instead.
    pub message: String,
}

impl Fault {
    /// A sentence of a kind.
    pub fn new(kind: Kind, message: impl Into<String>) -> Self {
        Self {
            kind,
            message: message.into(),
            field: None,
            places: Vec::new(),
        }
    }

    /// About a field.
    #[must_use]
    pub fn of(mut self, field: impl Into<String>) -> Self {
        self.field = Some(field.into());
        self
    }

    /// What was asked for makes no sense.
    pub fn request(message: impl Into<String>) -> Self {
        Self::new(Kind::Request, message)
    }

    /// A newer request has taken its place, or nobody waits for it any more.
    pub fn cancelled() -> Self {
        Self::new(
            Kind::Cancelled,
            "a newer request has taken the place of this one",
        )
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        if error.kind() == ErrorKind::Cancelled {
            return Self::cancelled();
        }
        let field = match error.downcast_ref() {
            Some(RequestError::Parameter { name, .. } | RequestError::Varied { name, .. }) => {
                Some(name.clone())
            }
            Some(RequestError::Option { name, .. }) => Some((*name).to_owned()),
            Some(RequestError::EmptyRange { .. }) => Some("to".to_owned()),
            Some(RequestError::UnknownSignal { .. } | RequestError::UnknownMeasure { .. }) => {
                Some("plot".to_owned())
            }
            _ => None,
        };
        let kind = if field.is_some() {
            Kind::Value
        } else {
            Kind::Computation
        };
        Self {
            field,
            ..Self::new(kind, chain(&error).to_string())
        }
    }
}

impl From<DeclarationError> for Fault {
    fn from(error: DeclarationError) -> Self {
        let places = error.faults.into_iter().map(|fault| Place {
            line: fault.line,
            column: fault.column,
            message: fault.message,
        });
        let places: Vec<Place> = places.collect();
        let message = match places.len() {
            1 => "the declaration has a fault".to_owned(),
            count => format!("the declaration has {count} faults"),
        };
        Self {
            places,
            ..Self::new(Kind::Declaration, message)
        }
    }
}

impl From<ModelError> for Fault {
    fn from(error: ModelError) -> Self {
        match error {
            ModelError::Faulty(error) => error.into(),
            ModelError::Parameter(message) => Self::new(Kind::Value, message),
            ModelError::Unreadable(error) => Self::request(error.to_string()),
        }
    }
}
