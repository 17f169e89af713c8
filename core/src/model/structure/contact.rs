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
}

impl Contact {
    /// A contact that follows a law.
    pub fn new(law: impl Law + 'static) -> Self {
        Self {
            law: Arc::new(law),
            arguments: Vec::new(),
            gap: Vec::new(),
            force: None,
            offset: 0.0.into(),
        }
    }

    /// The arguments of the law, in its order. Where the law declares a range of one, the structure checks it.
    #[must_use]
    pub fn arguments(mut self, arguments: impl IntoIterator<Item = impl Into<Value>>) -> Self {
        self.arguments = arguments.into_iter().map(Into::into).collect();
        self
    }

    /// The direction of gap and force, one entry per coordinate.
    #[must_use]
    pub fn direction(mut self, direction: impl Into<Vec<f64>>) -> Self {
        self.gap = direction.into();
        self
    }

    /// A direction of the force that differs from that of the gap.
    #[must_use]
    pub fn force_direction(mut self, direction: impl Into<Vec<f64>>) -> Self {
        self.force = Some(direction.into());
        self
    }

    /// What is subtracted from `direction . q`.
    #[must_use]
    pub fn offset(mut self, offset: impl Into<Value>) -> Self {
        self.offset = offset.into();
        self
    }
}
