//! The period of a gap, cut where it crosses a level.

use std::f64::consts::TAU;

use crate::aft::ContactInput;
use crate::fourier::crossings::{Crossing, crossings};
use crate::fourier::series;

/// The gap crosses a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Switch {
    pub(super) tau: f64,
    pub(super) level: usize,
    pub(super) rising: bool,
}

impl Switch {
    /// The piece that begins here.
    fn piece(self) -> usize {
        self.level + usize::from(self.rising)
    }
}

/// What bounds a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The gap crosses this level.
    Level(usize),
    /// Nothing but the period.
    Period,
}

/// A part of the period on which the gap stays on one piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Panel {
    /// From this phase, in `[0, 2 pi]`,
    pub(super) start: f64,
    /// to this one, at most a period later.
    pub(super) end: f64,
    pub(super) piece: usize,
    pub(super) from: End,
    pub(super) to: End,
}

impl Panel {
    /// Whether it is the whole period.
    pub(super) fn is_period(&self) -> bool {
        self.from == End::Period
    }
}

/// Switches and panels of the gap cut last.
#[derive(Debug, Default)]
pub(super) struct Cut {
    levels: Vec<f64>,
    levels_by: Vec<f64>,
    found: Vec<Crossing>,
    switches: Vec<Switch>,
    panels: Vec<Panel>,
}

impl Cut {
    /// Cuts the period of a gap.
    pub(super) fn apply(&mut self, input: ContactInput<'_>) {
        let count = input.law.facts().levels.len();
        self.levels.resize(count, 0.0);
        input.law.levels(input.arguments, &mut self.levels);
        self.switches.clear();
        for (level, &value) in self.levels.iter().enumerate() {
            self.found.clear();
            crossings(input.gap, value, &mut self.found);
            let found = self.found.iter();
            self.switches
                .extend(found.map(|&Crossing { tau, rising }| Switch { tau, level, rising }));
        }
        // Levels that coincide are crossed in their order when the gap rises, and in the opposite one when it falls.
        let order = |switch: &Switch| {
            let level = switch.level as isize;
            if switch.rising { level } else { -level }
        };
        self.switches
            .sort_unstable_by(|a, b| a.tau.total_cmp(&b.tau).then(order(a).cmp(&order(b))));
        self.fill_panels(input.gap);
    }

    fn fill_panels(&mut self, gap: &[f64]) {
        self.panels.clear();
        let Some(&last) = self.switches.last() else {
            let value = series::value(gap, 0.0);
            self.panels.push(Panel {
                start: 0.0,
                end: TAU,
                piece: self.levels.iter().filter(|&&level| value > level).count(),
                from: End::Period,
                to: End::Period,
            });
            return;
        };
        let mut from = Switch {
            tau: last.tau - TAU,
            ..last
        };
        for &to in &self.switches {
            if to.tau > from.tau {
                self.panels.push(Panel {
                    start: from.tau,
                    end: to.tau,
                    piece: from.piece(),
                    from: End::Level(from.level),
                    to: End::Level(to.level),
                });
            }
            from = to;
        }
    }

    pub(super) fn panels(&self) -> &[Panel] {
        &self.panels
    }

    pub(super) fn switches(&self) -> &[Switch] {
        &self.switches
    }

    pub(super) fn levels(&self) -> &[f64] {
        &self.levels
    }

    /// How a level moves when the arguments change.
    pub(super) fn level_by(&mut self, input: ContactInput<'_>, level: usize, by: &[f64]) -> f64 {
        self.levels_by.resize(self.levels.len(), 0.0);
        let mut sum = 0.0;
        for (argument, &change) in by.iter().enumerate().filter(|&(_, &change)| change != 0.0) {
            input
                .law
                .levels_by(input.arguments, argument, &mut self.levels_by);
            sum += change * self.levels_by[level];
        }
        sum
    }
}
