//! Whether the nodes see what a law does between them.
//!
//! A finer solution tells the error only if its nodes see what those of the orbit do not. A bump of the force that a gap passes between two nodes
//! of both leaves no trace in either. The [scales](crate::laws::generic::scales) of a law tell where it may change, from gaps and rates at
//! successive nodes, as they do for an integrator and for the balance.
//!
//! Source: that of [scales](crate::laws::generic::scales).

use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::Run;
use crate::laws::generic::scales::{Scales, Sight};

/// Largest change from node to node, in the units of [`Scales`], with which finer nodes see what these do not.
const SEEN: f64 = 1.5;

impl Run<'_> {
    /// Whether a law may change between two nodes of the last pass unseen.
    pub(super) fn overlooks(&mut self) -> bool {
        let mut sharp = std::mem::take(&mut self.sharp);
        let found = sharp.iter().any(Option::is_some) && self.overlooked_by(&mut sharp);
        self.sharp = sharp;
        found
    }

    fn overlooked_by(&self, sharp: &mut [Option<Scales>]) -> bool {
        let motion = Motion::of(&self.equations);
        let base = self.equations.values.base;
        let (mut gaps, mut rates) = (Vec::new(), Vec::new());
        for (index, interval) in self.equations.skeleton.intervals.iter().enumerate() {
            let [from, to] = motion.phases(index);
            for active in &interval.active {
                let Some(scales) = &mut sharp[active.contact] else {
                    continue;
                };
                let of = &self.equations.values.contacts[active.contact];
                scales.set(&of.arguments, &of.levels);
                if !scales.any(active.piece) || to <= from {
                    continue;
                }
                gaps.clear();
                rates.clear();
                for psi in &interval.nodes.targets {
                    let [gap, slope] = motion.gap(active.contact, index, from + psi * (to - from));
                    gaps.push(gap);
                    rates.push(slope * base);
                }
                if scales.look(active.piece, &gaps, &rates, SEEN) == Sight::Missed {
                    return true;
                }
            }
        }
        false
    }
}
