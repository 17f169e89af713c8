//! A law at work in a structure, and where.

use std::sync::Arc;

use super::Value;
use crate::law::Law;

/// A law at work in a structure.
///
/// The gap is `direction . q - offset`, and the force acts along the same direction unless another is given.
#[derive(Debug)]
pub struct Contact {
    pub(super) law: Arc<dyn Law>,
    pub(super) arguments: Vec<Value>,
    pub(super) gap: Vec<f64>,
    pub(super) force: Option<Vec<f64>>,
    pub(super) offset: Value,
    pub(super) unit: String,
}

impl Contact {
    /// A contact that follows a law.
    pub fn new(law: impl Law + 'static) -> Self {
        Self::of(Arc::new(law))
    }

    /// A contact that follows a law which others may share.
    pub fn of(law: Arc<dyn Law>) -> Self {
        Self {
            law,
            arguments: Vec::new(),
            gap: Vec::new(),
            force: None,
            offset: 0.0.into(),
            unit: String::new(),
        }
    }

    hertzian_contract::setters! { self:
        /// The arguments of the law, in its order. Where the law declares a range of one, the structure checks it.
        arguments(arguments: impl IntoIterator<Item = impl Into<Value>>) {
            self.arguments = arguments.into_iter().map(Into::into).collect();
        }

        /// The direction of gap and force, one entry per coordinate.
        direction(direction: impl Into<Vec<f64>>) { self.gap = direction.into() }

        /// A direction of the force that differs from that of the gap.
        force_direction(direction: impl Into<Vec<f64>>) { self.force = Some(direction.into()) }

        /// What is subtracted from `direction . q`.
        offset(offset: impl Into<Value>) { self.offset = offset.into() }

        /// The unit of its force, for reports and pictures.
        unit(unit: impl Into<String>) { self.unit = unit.into() }
    }
}
