//! What lies between two successive cuts of a period, or a part of it, and the contacts whose forces are unknown there.

use crate::contact_equation::collocation::nodes::Nodes;

/// Where an interval begins or ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::contact_equation) enum Cut {
    /// Where the period begins.
    Begin,
    /// Where it ends.
    End,
    /// At a switch.
    Switch(usize),
}

/// A part of the way from one cut to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::contact_equation) struct Mark {
    pub(in crate::contact_equation) from: Cut,
    pub(in crate::contact_equation) to: Cut,
    pub(in crate::contact_equation) part: f64,
}

impl Mark {
    pub(in crate::contact_equation) fn at(cut: Cut) -> Self {
        Self {
            from: cut,
            to: cut,
            part: 0.0,
        }
    }
}

/// A contact whose force is unknown on an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::contact_equation) struct Active {
    pub(in crate::contact_equation) contact: usize,
    pub(in crate::contact_equation) piece: usize,
    /// Place of the first of its forces among the unknowns.
    pub(in crate::contact_equation) first: usize,
}

/// What lies between two cuts, or a part of it.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Interval {
    pub(in crate::contact_equation) from: Mark,
    pub(in crate::contact_equation) to: Mark,
    /// Per contact.
    pub(in crate::contact_equation) pieces: Vec<usize>,
    pub(in crate::contact_equation) active: Vec<Active>,
    /// The configuration that has the forces, where none is unknown although there are some.
    pub(in crate::contact_equation) configuration: Option<usize>,
    /// The powers of the grading that its ends ask for.
    pub(in crate::contact_equation) steepness: [usize; 2],
    pub(in crate::contact_equation) nodes: &'static Nodes,
    /// The switch where it ends.
    pub(in crate::contact_equation) ends: Option<usize>,
}

impl Interval {
    /// Number of its forces.
    pub(in crate::contact_equation) fn forces(&self) -> usize {
        self.active.len() * self.nodes.count()
    }

    /// Place of the first of them among the unknowns.
    pub(in crate::contact_equation) fn first(&self) -> usize {
        self.active.first().map_or(0, |active| active.first)
    }

    /// Where it begins and ends, in parts of the way between two cuts.
    pub(in crate::contact_equation) fn parts(&self) -> [f64; 2] {
        let part = |mark: Mark, end: f64| if mark.from == mark.to { end } else { mark.part };
        [part(self.from, 0.0), part(self.to, 1.0)]
    }

    /// Half of the way from its beginning to its end.
    pub(in crate::contact_equation) fn middle(&self) -> Mark {
        // Panels of one way have the same ends; a whole one has its own.
        if (self.from.from, self.from.to) == (self.to.from, self.to.to)
            && self.from.part != self.to.part
        {
            return Mark {
                part: 0.5 * (self.from.part + self.to.part),
                ..self.from
            };
        }
        let whole = |mark: Mark| mark.from == mark.to;
        let [from, to] = match [whole(self.from), whole(self.to)] {
            [true, true] => [self.from.from, self.to.from],
            [true, false] => [self.to.from, self.to.to],
            _ => [self.from.from, self.from.to],
        };
        let part = |mark: Mark, end: f64| if whole(mark) { end } else { mark.part };
        Mark {
            from,
            to,
            part: 0.5 * (part(self.from, 0.0) + part(self.to, 1.0)),
        }
    }
}
