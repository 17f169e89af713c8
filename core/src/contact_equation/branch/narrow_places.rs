//! Extremes of gaps, as the engine asks for them to tell which narrow places of laws a step [goes through](Narrow::is_leapt_over).
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2: at a touch the distance of the extreme,
//! not the parameter, tells the orbits apart.

use std::f64::consts::TAU;

use crate::branches::extreme::Extreme;
use crate::contact_equation::run::Run;
use crate::laws::generic::narrow::Narrow;

impl Run<'_> {
    /// The extremes over the period of an orbit of gaps whose laws may have narrow places, as they are. Says whether there are such laws, and the orbit is
    /// known.
    pub(super) fn plain_extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        extremes.clear();
        let is_narrow = |run: &Self, contact: usize| {
            let equations = &run.equations;
            equations.setting.is_narrow(&equations.values, contact)
        };
        let contacts = self.equations.values.contacts.len();
        if !(0..contacts).any(|contact| is_narrow(self, contact)) {
            return false;
        }
        self.equations.compute(u, false);
        if self.equations.failed || !self.equations.is_in_order() {
            return false;
        }
        let whole = TAU * self.equations.skeleton.recurrence().period as f64;
        let mut found = self.of_period();
        found.retain(|extreme| is_narrow(self, extreme.contact));
        extremes.extend(found.iter().map(|extreme| Extreme {
            tau: TAU * extreme.phase.rem_euclid(whole) / whole,
            maximum: extreme.maximum,
            above: extreme.gap,
            plain: true,
            ..Extreme::of(extreme.contact, 0, 1.0, false)
        }));
        true
    }

    /// Adds the narrow places that the law of a contact has in a range of its gap.
    pub(super) fn narrow_places(&self, contact: usize, range: [f64; 2], to: &mut Vec<Narrow>) {
        let values = &self.equations.values;
        if let Some(mut scales) = self.equations.setting.sharp(values, contact) {
            let of = &values.contacts[contact];
            scales.set(&of.arguments, &of.levels);
            scales.narrow(range, to);
        }
    }
}
