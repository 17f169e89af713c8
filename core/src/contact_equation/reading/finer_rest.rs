//! What a finer solution leaves out itself, which its distance from an orbit does not tell.
//!
//! At the ends of a panel an orbit by collocation at Gauss nodes is off by a product of what the forces and of what the rule of integration leave
//! out. Between them it is off by what the forces leave out alone, integrated twice: that goes as their last coefficients `t`, and changes its sign
//! as often as there are nodes. At one place in a panel, as where a coordinate is largest, an orbit and a finer one may be off by as much by
//! chance, and (1) of [`reading`](super) vanishes. With `E` the most by which they differ anywhere in the panel, and the part of what forces leave
//! out that is left in the finer one,
//!
//! ```text
//! q = t_finer / t,    e_finer <= E q / (1 - q)                                                                 (1)
//! ```
//!
//! Elsewhere the product has `q^2` in place of `q`, and `E` is the most by which they differ at all.
//!
//! What is stated then is the distance of both orbits, and (1) again or that distance if it is more.
//!
//! Source: de Boor and Swartz (1973), Collocation at Gaussian points, SIAM Journal on Numerical Analysis 10, 582 (orders at the ends of panels
//! and between them).

use super::plain_outputs::Plain;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::Run;
use crate::contact_equation::run::error_estimate::SAFETY;
use crate::contact_equation::skeleton::interval::Interval;
use crate::orbit::observe::Accuracy;

/// Phases of a panel at which two motions are compared.
const COMPARED: usize = 12;
/// The most of (1) that may be left: where forces of the finer solution leave out as much, nothing is known of the rest but that it is more.
const MOST: f64 = 0.9;

/// How far an orbit is from a finer one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Apart {
    /// In what the error is of.
    asked: f64,
    /// What is told of orbits near by, of which `SAFETY` times as much is stated: the most at the phases that are compared, and what makes that the
    /// most in panels that the error depends on, since extremes are elsewhere in them.
    pub(super) most: f64,
    /// What may be left in the finer one, by (1).
    rest: f64,
}

impl Apart {
    /// What is stated of the error.
    pub(super) fn stated(&self) -> f64 {
        self.asked + self.asked.max(self.rest)
    }
}

impl Run<'_> {
    /// How far the orbit of the last pass is from that of a finer one, where that is this far in what the error is of, and so far anywhere.
    pub(super) fn apart_with_rest(
        &self,
        finer: &Equations,
        value: f64,
        asked: f64,
        everywhere: f64,
    ) -> Apart {
        let output = self.plain_output(value);
        if output.is_none() && matches!(self.accuracy(), Accuracy::Output(_)) {
            // Motions tell nothing of an output in other units, whose extremes are looked for in both.
            return Apart {
                asked,
                most: everywhere,
                rest: 0.0,
            };
        }
        let left = self.part_left(finer);
        let within = self.apart_within(finer, output.as_ref());
        let sum = |q: f64| q / (1.0 - q);
        Apart {
            asked,
            most: everywhere.max(within / SAFETY),
            rest: (within * sum(left)).max(everywhere * sum(left * left)),
        }
    }

    /// `q` of (1), of all panels together.
    fn part_left(&self, finer: &Equations) -> f64 {
        let [own, others] = [&self.equations, finer].map(|equations| {
            let tails = self.tails_of(&equations.skeleton, &equations.last);
            tails.iter().fold(0.0, |sum: f64, tail| sum.hypot(*tail))
        });
        if own > 0.0 {
            (others / own).min(MOST)
        } else {
            0.0
        }
    }

    /// `E` of (1): of panels in which coordinates that the error is of are smallest or largest, or of all where it is of an output.
    fn apart_within(&self, finer: &Equations, output: Option<&Plain>) -> f64 {
        let motions = [&self.equations, finer].map(Motion::of);
        let skeleton = &self.equations.skeleton;
        let asked = self.asked_panels(&motions[0]);
        let panels = skeleton.intervals.iter().zip(asked).enumerate();
        let forced = |(_, (interval, asked)): &(usize, (&Interval, bool))| {
            *asked && !interval.active.is_empty()
        };
        let coordinates = self.equations.values.linear.positions.nrows();
        let mut states = [vec![0.0; 2 * coordinates], vec![0.0; 2 * coordinates]];
        let mut most = 0.0_f64;
        for (panel, _) in panels.filter(forced) {
            let [from, to] = motions[0].phases(panel);
            for sample in 0..COMPARED {
                let part = (sample as f64 + 0.5) / COMPARED as f64;
                for (motion, state) in motions.iter().zip(&mut states) {
                    motion.at(from + part * (to - from), state);
                }
                let [a, b] = states.each_ref().map(|state| &state[..coordinates]);
                let pairs = a.iter().zip(b);
                most = match (output, self.accuracy()) {
                    (Some(output), _) => most.max(output.apart([a, b])),
                    (None, Accuracy::Coordinate(one)) => most.max((a[one] - b[one]).abs()),
                    (None, _) => pairs.fold(most, |most, (a, b)| most.max((a - b).abs())),
                };
            }
        }
        most
    }

    /// Which panels the error depends on.
    fn asked_panels(&self, motion: &Motion<'_>) -> Vec<bool> {
        let Some(found) = self.equations.extremes.coordinates.get() else {
            // Extremes of an output are looked for among all.
            return vec![true; motion.intervals()];
        };
        let mut asked = vec![false; motion.intervals()];
        let own = |index: &usize| match self.accuracy() {
            Accuracy::Coordinate(one) => *index == one,
            Accuracy::Coordinates | Accuracy::Output(_) => true,
        };
        for (_, places) in found.iter().enumerate().filter(|(index, _)| own(index)) {
            for place in places {
                asked[motion.interval(place.x).0] = true;
            }
        }
        asked
    }
}
