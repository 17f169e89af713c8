//! What is said where something cannot be done: a sentence, and where it belongs.

use hertzian::error::{ErrorKind, chain};
use hertzian::generic::DeclarationError;
use hertzian::{Error, RequestError};
use serde::Serialize;

use crate::response::model_file::ModelError;

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Fault {
    /// What it is about, for whoever shows it: `request`, `declaration`, `value`, `busy`, `cancelled` or `computation`.
    pub kind: &'static str,
    /// A sentence.
    pub message: String,
    /// The field that it belongs to: a parameter, `from`, `to` and so on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// What is wrong with the declaration.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<Place>,
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
    pub fn new(kind: &'static str, message: impl Into<String>) -> Self {
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
        Self::new("request", message)
    }

    /// A newer request has taken its place, or nobody waits for it any more.
    pub fn cancelled() -> Self {
        Self::new(
            "cancelled",
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
            "value"
        } else {
            "computation"
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
            ..Self::new("declaration", message)
        }
    }
}

impl From<ModelError> for Fault {
    fn from(error: ModelError) -> Self {
        match error {
            ModelError::Faulty(error) => error.into(),
            ModelError::Parameter(message) => Self::new("value", message),
            ModelError::Unreadable(error) => Self::request(error.to_string()),
        }
    }
}
