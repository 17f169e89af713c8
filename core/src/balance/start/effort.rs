//! How much work a search may take.
//!
//! Work is counted, not timed, so that a search ends in the same way on every machine: in multiplications, as the
//! evaluations of the balance and the factorisations estimate them.

use crate::branches::error::OrbitError;
use crate::cancel::Cancel;
use crate::continuation::newton::{Newton, NewtonError};
use crate::continuation::statistics::Statistics;
use crate::error::Error;

/// Multiplications that a search may take: some seconds. Most searches take less than a thousandth of it.
pub(super) const LIMIT: u64 = 20_000_000_000;

/// Multiplications that motions may take after it.
pub(super) const LIMIT_OF_MOTIONS: u64 = 4_000_000_000;

/// What a search has cost so far.
#[derive(Debug)]
pub(super) struct Effort {
    pub(super) statistics: Statistics,
    operations: u64,
    limit: u64,
    cancel: Cancel,
}

impl Effort {
    /// Nothing done, of `limit` multiplications, which a token may end before.
    pub(super) fn of(limit: u64, cancel: &Cancel) -> Self {
        Self {
            statistics: Statistics::default(),
            operations: 0,
            limit,
            cancel: cancel.clone(),
        }
    }

    /// Takes what an iteration has cost.
    pub(super) fn take(&mut self, newton: &mut Newton) {
        self.statistics += std::mem::take(&mut newton.statistics);
        self.operations += std::mem::take(&mut newton.operations);
    }

    /// Takes multiplications off.
    pub(super) fn take_operations(&mut self, operations: u64) {
        self.operations += operations;
    }

    /// Multiplications that are left.
    pub(super) fn remaining(&self) -> u64 {
        self.limit.saturating_sub(self.operations)
    }

    /// Whether nothing is left of it, or the search was cancelled.
    pub(super) fn is_spent(&self) -> bool {
        self.operations >= self.limit || self.cancel.is_cancelled()
    }

    /// Evaluations of the balance so far.
    pub(super) fn evaluations(&self) -> usize {
        self.statistics.residuals + self.statistics.jacobians
    }

    /// Why there is no orbit, when the last attempt said this.
    pub(super) fn error(&self, value: f64, reason: NewtonError) -> Error {
        if self.is_spent() {
            OrbitError::SearchLimit {
                value,
                evaluations: self.evaluations(),
                multiplications: self.limit,
                reason,
            }
            .into()
        } else {
            OrbitError::NoStart { value, reason }.into()
        }
    }
}
