//! A branch that is kept from where it comes farther than the one that is kept until then.

use std::sync::{Arc, Mutex, PoisonError};

use crate::branches::branch::{Branch, Further, Model};
use crate::branches::checkpoint::{Keep, Rest};
use crate::branches::point::Point;
use crate::branches::record::Kept;
use crate::error::Error;

/// Keeps a branch from where it comes farther than the one that is kept until then.
#[derive(Debug)]
pub(super) struct Farther {
    by: Arc<dyn Keep>,
    than: f64,
    /// What the branch is, until it takes the other one's place.
    head: Mutex<Option<Head>>,
}

/// What a branch that is kept begins with.
#[derive(Debug)]
struct Head {
    model: Model,
    varied: String,
    further: Further,
}

impl Farther {
    pub(super) fn new(by: &Arc<dyn Keep>, than: f64) -> Arc<Self> {
        Arc::new(Self {
            by: Arc::clone(by),
            than,
            head: Mutex::default(),
        })
    }

    /// Takes the place of what is kept, unless that is done.
    ///
    /// # Errors
    /// If the branch cannot be kept.
    pub(super) fn take(&self) -> Result<(), Error> {
        let mut head = self.head.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(Head {
            model,
            varied,
            further,
        }) = head.as_ref()
        {
            self.by.begin(model, varied, further)?;
        }
        *head = None;
        Ok(())
    }

    fn waits(&self) -> bool {
        let head = self.head.lock().unwrap_or_else(PoisonError::into_inner);
        head.is_some()
    }

    /// Every orbit is the last one once.
    fn comes_farther(&self, points: &[Point]) -> bool {
        let ends = points.first().zip(points.last());
        ends.is_some_and(|(first, last)| (last.value - first.value).abs() > self.than)
    }
}

impl Keep for Farther {
    fn begin(&self, model: &Model, varied: &str, further: &Further) -> Result<(), Error> {
        let head = Head {
            model: model.clone(),
            varied: varied.to_owned(),
            further: further.clone(),
        };
        *self.head.lock().unwrap_or_else(PoisonError::into_inner) = Some(head);
        Ok(())
    }

    fn keep(&self, kept: Kept<'_>, rest: &dyn Rest) -> bool {
        if self.waits() && !self.comes_farther(kept.points) {
            return true;
        }
        self.take().is_ok() && self.by.keep(kept, rest)
    }

    fn end(&self, branch: &Branch) -> bool {
        self.by.end(branch)
    }

    fn failure(&self) -> Option<Error> {
        self.by.failure()
    }
}
