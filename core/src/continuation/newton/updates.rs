//! What the sizes of successive updates say.

use super::Converged;

/// The updates of a correction so far, by their sizes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Updates {
    /// How many were made.
    pub(super) count: usize,
    pub(super) first: Option<f64>,
    /// The last one, and the one before it; infinite where there is none.
    pub(super) previous: f64,
    pub(super) before: f64,
    /// Until the correction shows its own, what the matrix leaves out contracts as it did in the last one.
    pub(super) usual: f64,
}

impl Updates {
    /// None yet, after a correction with this contraction.
    pub(super) fn after(usual: f64) -> Self {
        Self {
            count: 0,
            first: None,
            previous: f64::INFINITY,
            before: f64::INFINITY,
            usual,
        }
    }

    /// Takes one over that was made.
    pub(super) fn take(&mut self, size: f64) {
        self.count += 1;
        (self.before, self.previous) = (self.previous, size);
    }

    /// Whether they grow to this size. What core and tail leave out need not contract in every norm at once.
    pub(super) fn grow_to(&self, size: f64, exact: bool) -> bool {
        let most = if exact {
            2.0 * self.previous
        } else {
            4.0 * self.before.max(self.previous)
        };
        self.count > 1 && size > most
    }

    /// The end, with an update of this size.
    pub(super) fn converged(&self, size: f64) -> Converged {
        Converged {
            iterations: self.count,
            first: self.first.unwrap_or(size),
            update: size,
        }
    }
}
