//! How gaps go through the extremes that pairs of switches are told by, where that has changed since the pairs were made.
//!
//! Equations (2) and (3) of [`skeleton`](crate::contact_equation::skeleton) have constants, half of the second derivative `b = g''/2` and the lean `l`, of the extreme as it was
//! when they were made. An orbit has the same switches whatever these are, but where they are wrong the unknowns of a branch have a corner at `H = 0`. With
//! others, `b'` and `l'`, the same orbit has
//!
//! ```text
//! c' = c + (l - l') H,    H' = H,           H > 0                                                              (1)
//! c' = c,                 H' = (b / b') H,  H <= 0                                                             (2)
//! ```
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use crate::contact_equation::orbit::gaps::{BEND, Shape};
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::Run;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::placement::Told;

/// Pairs are near a touch of their level up to this `H`.
const NEAR: f64 = 0.01;
/// Shapes are others once they differ by this part, where a lean of less than the other one is none.
const OTHER: f64 = 0.2;
const UPRIGHT: f64 = 0.1;

impl Run<'_> {
    /// The present switches told by the shapes that extremes near a touch have on the orbit of the last pass, if those are others.
    pub(in crate::contact_equation) fn reshaped(&self, u: &[f64]) -> Option<Skeleton> {
        let skeleton = &self.equations.skeleton;
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        let gaps = self.gaps(&at);
        let mut reshaped = None;
        for (first, switch) in skeleton.switches.iter().enumerate() {
            let Told::First { other, bend, lean } = switch.told else {
                continue;
            };
            let square = u[skeleton.slot(other)];
            if square.abs() > NEAR || self.has_leap(switch.contact, switch.level) {
                continue;
            }
            let ends = [first, other].map(|index| skeleton.phase(u, index));
            let beside = BEND.max(0.5 * (ends[1] - ends[0]));
            let now = gaps.shape(switch.contact, 0.5 * (ends[0] + ends[1]), beside);
            let bent = (bend / now.bend - 1.0).abs();
            let leant = (lean - now.lean).abs() / lean.abs().max(now.lean.abs()).max(UPRIGHT);
            if bend * now.bend > 0.0 && bent.max(leant) > OTHER {
                let to = reshaped.get_or_insert_with(|| skeleton.clone());
                to.tell(first, other, now);
            }
        }
        reshaped
    }
}

impl Skeleton {
    /// Has a pair told by another shape.
    fn tell(&mut self, first: usize, other: usize, Shape { bend, lean }: Shape) {
        let told = Told::First { other, bend, lean };
        self.switches[first].told = told;
        self.placement.placed[first].switch.told = told;
    }

    /// (1) and (2): extended unknowns `u`, and a change of them, as those of the same switches told by other shapes.
    pub(in crate::contact_equation) fn told_by(
        &self,
        to: &Self,
        u: &[f64],
        change: &[f64],
    ) -> [Vec<f64>; 2] {
        let (mut moved, mut changed) = (u.to_vec(), change.to_vec());
        for (first, switch) in self.switches.iter().enumerate() {
            let Told::First { other, bend, lean } = switch.told else {
                continue;
            };
            let Told::First {
                bend: now,
                lean: leans,
                ..
            } = to.switches[first].told
            else {
                continue;
            };
            let [middle, square] = [first, other].map(|index| self.slot(index));
            if u[square] > 0.0 {
                moved[middle] += (lean - leans) * u[square];
                changed[middle] += (lean - leans) * change[square];
            } else {
                moved[square] *= bend / now;
                changed[square] *= bend / now;
            }
        }
        [moved, changed]
    }
}
