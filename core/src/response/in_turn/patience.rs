//! How long a branch is followed once more that does not come as far as the first one.

use crate::branches::progress::{Progress, Stage};

/// So many times as many orbits as the first one had, and so many more, in which it has to come as far.
const TIMES: usize = 8;
const MORE: usize = 50;

/// What a branch that is followed once more has come to.
pub(super) struct Patience {
    most: usize,
    /// How far the first one came from its first orbit.
    than: f64,
    first: Option<f64>,
    farther: bool,
    ended: bool,
}

impl Patience {
    /// With a branch that had so many points and came so far.
    pub(super) fn with(points: usize, than: f64) -> Self {
        Self {
            most: TIMES * points + MORE,
            than,
            first: None,
            farther: false,
            ended: false,
        }
    }

    /// Whether it is not worth going on, at what was found last.
    pub(super) fn ends(&mut self, progress: &Progress<'_>) -> bool {
        let Some(point) = progress.point.filter(|_| progress.stage == Stage::Branch) else {
            return self.ended;
        };
        let first = *self.first.get_or_insert(point.value);
        self.farther |= (point.value - first).abs() > self.than;
        self.ended = !self.farther && progress.done > self.most;
        self.ended
    }

    /// Whether it was given up.
    pub(super) fn has_ended(&self) -> bool {
        self.ended
    }
}
