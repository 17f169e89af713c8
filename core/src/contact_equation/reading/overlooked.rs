//! Whether nodes step over a narrow place of a law.
//!
//! A finer solution tells the error only if its nodes see what those of the orbit do not. A bump of the force that a gap passes between two nodes
//! of both leaves no trace in either. Where a law has such places, and how narrow they are, its data tell: see
//! [narrow](crate::laws::generic::narrow). With gaps `g_i` at successive nodes, one at `g` with the width `w` is seen if
//!
//! ```text
//! g_i <= g <= g_(i + 1)    only where    g_(i + 1) - g_i <= 2 w                                                (1)
//! ```
//!
//! Source: Shannon (1949), Communication in the presence of noise (what samples that are too far apart do not tell).

use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::problem::RESOLUTIONS;
use crate::contact_equation::run::Run;
use crate::laws::generic::narrow::Narrow;
use crate::laws::generic::scales::Scales;

/// Widths that nodes may be apart, by (1).
const SEEN: f64 = 2.0;

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
}

impl Sharp {
    /// That of a law, if it may have some.
    pub(in crate::contact_equation) fn of(scales: Scales) -> Self {
        Self {
            scales,
            places: Vec::new(),
        }
    }

    /// Those in the range of some gaps.
    fn places(&mut self, [arguments, levels]: [&[f64]; 2], gaps: &[f64]) -> &[Narrow] {
        let low = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let high = gaps.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        self.places.clear();
        self.scales.set(arguments, levels);
        // How wide a place is depends on where it is looked for: on this orbit alone.
        let range = [low, high];
        if self.scales.may_be_narrow() {
            self.scales.narrow(range, &mut self.places);
        }
        &self.places
    }
}

impl Run<'_> {
    /// Whether nodes of the last pass step over a narrow place of a law.
    pub(super) fn overlooks(&mut self) -> Option<Overlooked> {
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
        let motion = Motion::of(&self.equations);
        let mut gaps = Vec::new();
        for (index, interval) in self.equations.skeleton.intervals.iter().enumerate() {
            let [from, to] = motion.phases(index);
            for active in interval.active.iter().filter(|_| to > from) {
                let Some(sharp) = &mut sharp[active.contact] else {
                    continue;
                };
                let of = &self.equations.values.contacts[active.contact];
                gaps.clear();
                gaps.extend((0..interval.nodes.count()).map(|node| {
                    let (phase, states) = motion.at_node(index, node);
                    motion.gap_of(active.contact, phase, states)[0]
                }));
                let places = sharp.places([&of.arguments, &of.levels], &gaps);
                for pair in gaps.windows(2) {
                    let (low, high) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                    let between = places
                        .iter()
                        .filter(|place| low <= place.at && place.at <= high);
                    widest =
                        between.fold(widest, |most, place| most.max((high - low) / place.width));
                }
            }
        }
        widest
    }
}
