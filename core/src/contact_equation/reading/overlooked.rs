//! Whether nodes step over a narrow place of a law.
//!
//! A finer solution tells the error only if its nodes see what those of the orbit do not. A bump of the force that a motion passes between two
//! nodes of both leaves no trace in either, and a slope that is steep between two nodes is seen by none. Where a law has such places along a
//! motion, gaps and rates, and how narrow they are, its data tell: see [narrow](crate::laws::generic::narrow). With nodes at parts `p_i` of a
//! panel, a place at `p` with the width `w` is seen if
//!
//! ```text
//! p_i <= p <= p_(i + 1)    only where    p_(i + 1) - p_i <= 2 w                                                (1)
//! ```
//!
//! Source: Shannon (1949), Communication in the presence of noise (what samples that are too far apart do not tell).

use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::problem::RESOLUTIONS;
use crate::contact_equation::run::Run;
use crate::laws::generic::narrow::{Narrow, Samples, Way};
use crate::laws::generic::scales::{Scales, Sight};

/// Widths that nodes may be apart, by (1).
const SEEN: f64 = 2.0;
/// Parts of a panel that are looked at.
const PARTS: usize = 64;

/// Nodes step over a narrow place of a law.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Overlooked {
    /// The first resolution that does not, if there is one.
    pub(in crate::contact_equation) needed: Option<usize>,
}

/// Where the law of a contact has narrow places.
pub(in crate::contact_equation) struct Sharp {
    scales: Scales,
    places: Vec<Narrow>,
    /// A panel at its ends and nodes.
    nodes: Samples,
}

impl Sharp {
    /// That of a law, if it may have some.
    pub(in crate::contact_equation) fn of(scales: Scales) -> Self {
        Self {
            scales,
            places: Vec::new(),
            nodes: Samples::default(),
        }
    }

    /// How far the nodes of a panel are apart about a narrow place, in widths, at most.
    fn widest(&mut self, piece: usize, at: &dyn Fn(f64) -> [f64; 2]) -> f64 {
        let Samples {
            places: nodes,
            gaps,
            rates,
        } = &self.nodes;
        if self.scales.look(piece, gaps, rates, 1.0) < Sight::Missed {
            return 0.0;
        }
        let apart = nodes.windows(2).map(|pair| pair[1] - pair[0]);
        let way = Way {
            at,
            range: [0.0, 1.0],
            parts: PARTS,
            widest: apart.fold(0.0, f64::max),
        };
        self.places.clear();
        self.scales.narrow_along(piece, way, &mut self.places);
        let mut widest = 0.0_f64;
        for pair in nodes.windows(2) {
            let places = self.places.iter();
            let between = places.filter(|place| pair[0] <= place.at && place.at <= pair[1]);
            widest = between.fold(widest, |most, place| {
                most.max((pair[1] - pair[0]) / place.width)
            });
        }
        widest
    }
}

impl Run<'_> {
    /// Whether nodes of the last pass step over a narrow place of a law.
    pub(in crate::contact_equation) fn overlooks(&mut self) -> Option<Overlooked> {
        let mut sharp = std::mem::take(&mut self.sharp);
        let widest = self.widest(&mut sharp);
        self.sharp = sharp;
        if widest <= SEEN {
            return None;
        }
        let nodes = |of: usize| (RESOLUTIONS[of].nodes * RESOLUTIONS[of].panels) as f64;
        let needed = nodes(self.resolution) * widest / SEEN;
        let mut finer = self.resolution + 1..RESOLUTIONS.len();
        let needed = finer.find(|of| nodes(*of) >= needed);
        Some(Overlooked { needed })
    }

    /// How far nodes are apart about a narrow place, in widths, at most.
    fn widest(&self, sharp: &mut [Option<Sharp>]) -> f64 {
        let mut widest = 0.0_f64;
        if sharp.iter().all(Option::is_none) {
            return widest;
        }
        let values = &self.equations.values;
        let motion = Motion::of(&self.equations);
        for (index, interval) in self.equations.skeleton.intervals.iter().enumerate() {
            let [from, to] = motion.phases(index);
            for active in interval.active.iter().filter(|_| to > from) {
                let contact = &values.contacts[active.contact];
                let Some(sharp) = &mut sharp[active.contact] else {
                    continue;
                };
                sharp.scales.set(&contact.arguments, &contact.levels);
                if !sharp.scales.may_be_narrow() {
                    continue;
                }
                let held =
                    |[gap, slope]: [f64; 2]| [contact.held(active.piece, gap), slope * values.base];
                let at = |part: f64| {
                    let part = part.clamp(0.0, 1.0);
                    held(motion.gap(active.contact, index, from + part * (to - from)))
                };
                sharp.nodes.clear();
                sharp.nodes.push(0.0, at(0.0));
                for node in 0..interval.nodes.count() {
                    let (phase, states) = motion.at_node(index, node);
                    let there = held(motion.gap_of(active.contact, phase, states));
                    sharp.nodes.push(interval.nodes.targets[node], there);
                }
                sharp.nodes.push(1.0, at(1.0));
                widest = widest.max(sharp.widest(active.piece, &at));
            }
        }
        widest
    }
}
