//! Where a run of the balance is, as data: what is left of it follows from that.

use super::corrected_moduli::Corrections;
use super::{Run, SLOW_POINTS};
use crate::balance::Resolution;
use crate::balance::resolution::Chooser;
use crate::branches::engine::{Places, Walk};
use crate::branches::record::Kept;
use crate::numeric::fourier::series;
use crate::orbit::stability::judge::{self, Judge};
use crate::orbit::stability::uncorrected::{self, Uncorrected};

/// A core that has grown from one without limits has no more than this.
const MOST_CORE: usize = 1 << 40;

/// What a run goes on from.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rest {
    pub(super) walk: Walk,
    resolution: Resolution,
    core: usize,
    core_before: usize,
    slow: usize,
    chooser: Option<Chooser>,
    /// Of what computes multipliers.
    judge: Option<judge::Memory>,
    uncorrected: Option<uncorrected::Memory>,
    corrections: Corrections,
}

impl Rest {
    /// What the branch had then.
    pub(crate) fn kept(&mut self) -> &mut Places {
        &mut self.walk.kept
    }
}

impl Run<'_> {
    /// Where it is.
    pub(super) fn rest(&self, walk: Walk) -> Rest {
        Rest {
            walk,
            resolution: self.resolution,
            core: self.core,
            core_before: self.core_before,
            slow: self.slow,
            chooser: self.chooser.clone(),
            judge: self.evaluator.judge.as_ref().map(Judge::memory),
            uncorrected: self.monitor.multipliers.as_ref().map(Uncorrected::memory),
            corrections: self.monitor.corrections.clone(),
        }
    }

    /// As it was there, with what the branch had. `None` where that is not one of this run: it may have been read from a file.
    pub(crate) fn resumed(mut self, rest: &Rest, had: Kept<'_>) -> Option<Self> {
        let coordinates = self.context.system.facts().coordinates.len();
        let asked = self.context.resolution;
        let same = Resolution {
            harmonics: asked.harmonics,
            core: asked.core,
            ..rest.resolution
        };
        // Another number of harmonics than those asked for is what the chooser may have chosen.
        let Resolution {
            harmonics, core, ..
        } = rest.resolution;
        let most = self.chooser.as_ref().map_or(asked.harmonics, Chooser::most);
        let chooser = match (&rest.chooser, &self.chooser) {
            (Some(rest), Some(asked)) => rest.continues(asked),
            (rest, asked) => rest.is_none() && asked.is_none(),
        };
        let most_core = rest.core.max(rest.core_before);
        let counts = most_core <= MOST_CORE && rest.slow < SLOW_POINTS;
        let coarse = harmonics <= most.max(asked.harmonics) && core <= harmonics;
        if same != asked || !chooser || !counts || !coarse {
            return None;
        }
        self.record = had.at(&rest.walk.kept)?;
        (self.core, self.core_before) = (rest.core, rest.core_before);
        self.slow = rest.slow;
        self.resolution = rest.resolution;
        self.wanted = rest.resolution;
        self.chooser.clone_from(&rest.chooser);
        self.renew();
        if let (Some(judge), Some(memory)) = (&mut self.evaluator.judge, rest.judge) {
            judge.remember(memory);
        }
        if let (Some(multipliers), Some(memory)) =
            (&mut self.monitor.multipliers, &rest.uncorrected)
        {
            multipliers.remember(memory);
        }
        self.monitor.corrections.clone_from(&rest.corrections);
        self.remembers(rest, coordinates).then_some(self)
    }

    /// Whether what is remembered is of these orbits.
    fn remembers(&self, rest: &Rest, coordinates: usize) -> bool {
        let unknowns = coordinates * series::length(rest.resolution.harmonics);
        let multipliers = 2 * coordinates;
        let uncorrected = match &rest.uncorrected {
            Some(memory) => memory.is_of(unknowns, multipliers),
            None => true,
        };
        rest.walk.fits(unknowns)
            && rest.walk.tests(self.monitor.watched.len())
            && rest.judge.is_some() == self.evaluator.judge.is_some()
            && rest.uncorrected.is_some() == self.monitor.multipliers.is_some()
            && uncorrected
            && rest.corrections.are_of(rest.walk.kept.points, multipliers)
    }
}
