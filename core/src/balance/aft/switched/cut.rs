//! The period of a gap, cut where it crosses a level, and where it nearly does if the force has a broken power of the distance.

use std::f64::consts::TAU;

use super::panel::power_at;
use crate::balance::aft::ContactInput;
use crate::numeric::fourier::crossings::CrossingFinder;
use crate::numeric::fourier::crossings::levels::{Cuts, Segment, Switch};
use crate::numeric::fourier::series;

/// What bounds a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The gap crosses this level.
    Level(usize),
    /// The gap nearly touches this level.
    Near(usize),
    /// Nothing but the period.
    Period,
}

/// A part of the period on which the gap stays on one piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Panel {
    /// From this phase
    pub(super) start: f64,
    /// to this one, at most a period later.
    pub(super) end: f64,
    pub(super) piece: usize,
    pub(super) from: End,
    pub(super) to: End,
}

impl Panel {
    /// Whether it is the whole period, uncut.
    pub(super) fn is_period(&self) -> bool {
        self.from == End::Period
    }
}

impl From<&Segment> for Panel {
    fn from(segment: &Segment) -> Self {
        let &Segment {
            start,
            end,
            piece,
            levels,
        } = segment;
        let [from, to] = levels.map_or([End::Period; 2], |levels| levels.map(End::Level));
        Self {
            start,
            end,
            piece,
            from,
            to,
        }
    }
}

/// Switches and panels of the gap cut last.
#[derive(Debug, Default)]
pub(super) struct Cut {
    finder: Option<CrossingFinder>,
    levels: Vec<f64>,
    levels_by: Vec<f64>,
    cuts: Cuts,
    panels: Vec<Panel>,
}

impl Cut {
    /// Cuts the period of a gap.
    pub(super) fn apply(&mut self, input: ContactInput<'_>) {
        let count = input.law.facts().levels.len();
        self.levels.resize(count, 0.0);
        input.law.levels(input.arguments, &mut self.levels);
        if count > 0 {
            let harmonics = series::harmonics(input.gap);
            self.finder
                .get_or_insert_with(|| CrossingFinder::new(harmonics))
                .sample(input.gap);
        }
        let finder = self.finder.as_ref().filter(|_| count > 0);
        self.cuts.apply(finder, input.gap, &self.levels);
        self.panels.clear();
        self.panels
            .extend(self.cuts.segments().iter().map(Panel::from));
        for level in 0..count {
            self.cut_near(input, level);
        }
    }

    /// Cuts panels where the gap nearly touches a level from a side on which the force has a broken power of the distance.
    fn cut_near(&mut self, input: ContactInput<'_>, level: usize) {
        let facts = &input.law.facts().pieces;
        let broken = |piece: usize| {
            let upper = piece == level;
            power_at(
                &facts[piece],
                input.arguments,
                &[],
                End::Level(level),
                upper,
            ) > 1
        };
        let sides = [broken(level), broken(level + 1)];
        if sides == [false, false] {
            return;
        }
        let Some(finder) = &self.finder else {
            return;
        };
        let value = self.levels[level];
        for tau in self.cuts.near_misses(finder, input.gap, value) {
            cut_panel(&mut self.panels, tau, level, sides);
        }
    }

    pub(super) fn panels(&self) -> &[Panel] {
        &self.panels
    }

    pub(super) fn switches(&self) -> &[Switch] {
        self.cuts.switches()
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

/// Cuts the panel that a phase lies in, if its piece is beside a level on a side that needs it.
fn cut_panel(panels: &mut Vec<Panel>, tau: f64, level: usize, sides: [bool; 2]) {
    let middle = End::Near(level);
    let lies_in = |panel: &Panel| {
        // Panels begin up to a period before the phases of near misses, and may end a period after them.
        let phases = [tau - TAU, tau, tau + TAU];
        phases
            .into_iter()
            .find(|&tau| tau > panel.start && tau < panel.end)
    };
    let mut found = panels.iter().enumerate();
    let found = found.find_map(|(index, panel)| lies_in(panel).map(|tau| (index, tau)));
    let Some((index, tau)) = found else {
        return;
    };
    let panel = panels[index];
    let adjacent = panel.piece == level || panel.piece == level + 1;
    if !adjacent || !sides[panel.piece - level] {
        return;
    }
    let next = Panel {
        start: tau,
        from: middle,
        ..panel
    };
    if panel.is_period() {
        panels[index] = Panel {
            end: tau + TAU,
            to: middle,
            ..next
        };
        return;
    }
    (panels[index].end, panels[index].to) = (tau, middle);
    panels.push(next);
}
