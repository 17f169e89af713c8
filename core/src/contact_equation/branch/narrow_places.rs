//! Steps in which an extreme of a gap passes a narrow place of its law.
//!
//! While an extreme goes through a place of the width `w` where a law without levels changes, the branch may turn twice and its orbits lose and regain
//! stability (see [`narrow`](crate::branches::engine)). A step that [goes through](Narrow::is_leapt_over) more of it than it may is made again, shorter, so
//! that there are points in the place, with nodes that fit them.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2: at a touch the distance of the extreme,
//! not the parameter, tells the orbits apart.

use std::f64::consts::TAU;

use super::method::ContactBranch;
use crate::branches::extreme::{Extreme, pairs};
use crate::contact_equation::run::Run;
use crate::continuation::follow::CurvePoint;
use crate::laws::generic::narrow::Narrow;

/// A step is made shorter so often for a narrow place at most: one of a thousandth of it is come to so.
const NARROWED: usize = 12;

impl ContactBranch<'_, '_> {
    /// Whether the step to an orbit whose equations are computed is to be made again, shorter, since an extreme goes through more of a narrow place than it
    /// may. If not, its extremes are those of the last orbit that was kept.
    pub(super) fn comes_nearer_to_narrow(&mut self, at: &CurvePoint) -> bool {
        if self.narrowed < NARROWED && self.leaps_over_narrow(at) {
            self.narrowed += 1;
            self.refused = 0;
            return true;
        }
        self.narrowed = 0;
        std::mem::swap(&mut self.narrow, &mut self.narrow_next);
        false
    }

    /// Whether it does, on the way from the last orbit that was kept.
    fn leaps_over_narrow(&mut self, at: &CurvePoint) -> bool {
        if !self.run.may_be_narrow() {
            return false;
        }
        self.narrow_next = self.run.plain_extremes();
        if self.narrow.is_empty() && !self.kept.is_empty() {
            // A branch that goes on from a file knows its last orbit alone.
            let kept = std::mem::take(&mut self.kept);
            self.run.equations.compute(&kept, false);
            self.narrow = self.run.plain_extremes();
            self.kept = kept;
            let stability = self.run.problem.asked.stability;
            self.run.equations.compute(&at.u, stability);
        }
        let run = &*self.run;
        pairs(&self.narrow, &self.narrow_next).any(|[before, next]| run.leaps(before, next))
    }
}

impl Run<'_> {
    /// Whether any law may have narrow places.
    fn may_be_narrow(&self) -> bool {
        let values = &self.equations.values;
        let mut contacts = 0..values.contacts.len();
        contacts.any(|contact| self.equations.setting.is_narrow(values, contact))
    }

    /// The extremes of gaps over the period, as they are; none where they are not known.
    fn plain_extremes(&self) -> Vec<Extreme> {
        if self.equations.failed || !self.equations.is_in_order() {
            return Vec::new();
        }
        let whole = TAU * self.equations.skeleton.recurrence().period as f64;
        let found = self.of_period();
        let plain = found.iter().map(|extreme| Extreme {
            tau: TAU * extreme.phase.rem_euclid(whole) / whole,
            maximum: extreme.maximum,
            above: extreme.gap,
            plain: true,
            ..Extreme::of(extreme.contact, 0, 1.0, false)
        });
        plain.collect()
    }

    fn leaps(&self, before: &Extreme, next: &Extreme) -> bool {
        let (values, contact) = (&self.equations.values, before.contact);
        let Some(mut scales) = self.equations.setting.sharp(values, contact) else {
            return false;
        };
        let ways = [before, next].map(Extreme::gap);
        let (low, high) = (ways[0].min(ways[1]), ways[0].max(ways[1]));
        let moved = high - low;
        let of = &values.contacts[contact];
        scales.set(&of.arguments, &of.levels);
        let mut places: Vec<Narrow> = Vec::new();
        scales.narrow([low - moved, high + moved], &mut places);
        places.iter().any(|place| place.is_leapt_over(ways))
    }
}
