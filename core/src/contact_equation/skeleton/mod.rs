//! Which pieces the gaps of an orbit are on, one after the other, and where the unknowns that tell it stand. It is made from a [`placement`]
//! ([`build`]), with more nodes from another one ([`refine`]), and has [intervals](interval) and the [`phases`] of their ends; beside a short
//! stretch forces are carried over from the last orbit ([`carry_forces`]).
//!
//! The period is cut where a gap switches from one piece of its law to the next. What lies between two successive cuts is an *interval*: on
//! each the forces of contacts whose piece has one are unknown at [nodes](super::collocation::nodes), and those of the others are zero. Where they are
//! affine, they are in a [configuration](super::linear_part::configuration) of the linear part, and none is unknown.
//!
//! ```text
//! u = [ states at the beginning | places of switches | forces at nodes, interval by interval | parameter ]     (1)
//! ```
//!
//! A switch has its phase as unknown. Two that may meet, since the stretch between them is short, have `c` and `H`, the square of half of the
//! way between them:
//!
//! ```text
//! tau = c + l H -+ sqrt(H),    (g_1 + g_2)/2 = level,    (g_2 - g_1)/(2 sqrt H) = 0,    H > 0                 (2)
//! g(c) - level + (g''/2) H = 0,    g'(c) = 0,                                           H <= 0                (3)
//! l = -g''' / (6 g'')                                                                                         (4)
//! ```
//!
//! So `H` passes zero smoothly where the gap touches its level: beyond, (3) goes on with the extreme of a gap that does not reach it. The middle
//! of two crossings of a cubic moves away from its extreme with the slope (4) by `H`. A constant `l` near it takes that out of `c`, which had
//! a corner at `H = 0` otherwise, between both sides of which Newton's method may alternate. Where
//! the force jumps at the level, the orbit goes as the root of `H > 0`, which is the unknown there then; the gap has another shape at once there, and `l`
//! is zero.
//!
//! Of an orbit that comes back after a part of its period with an image `S` of its coordinates that part is cut, and its end is `S` of its
//! beginning.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing: the time in
//! contact grows as the root of the penetration).

mod build;
mod carry_forces;
pub(super) mod interval;
pub(super) mod phases;
pub(super) mod placement;
mod refine;

use self::interval::{Cut, Interval};
use self::phases::Opening;
use self::placement::{Placement, Switch, Told};
use crate::branches::recurrence::Recurrence;

/// All of it.
#[derive(Debug, Clone)]
pub(super) struct Skeleton {
    /// Phase where the period begins, or the part of it after which the orbit comes back, and its length.
    pub(super) begin: f64,
    pub(super) length: f64,
    /// Number of states.
    pub(super) order: usize,
    /// In the order of time.
    pub(super) switches: Vec<Switch>,
    /// How the way between two of them is told.
    openings: Vec<Opening>,
    pub(super) intervals: Vec<Interval>,
    /// Pieces of the contacts in every configuration.
    pub(super) configurations: Vec<Vec<usize>>,
    /// Number of forces.
    pub(super) forces: usize,
    pub(super) placement: Placement,
    /// How often it was made finer than that asks for.
    refined: usize,
}

impl Skeleton {
    /// How the orbit comes back at its end.
    pub(super) fn recurrence(&self) -> &Recurrence {
        &self.placement.beginning.recurrence
    }

    /// Number of unknowns, without the parameter.
    pub(super) fn unknowns(&self) -> usize {
        self.told() + self.forces
    }

    /// Number of those that are no forces.
    pub(super) fn told(&self) -> usize {
        self.order + self.switches.len()
    }

    /// The place of a switch's unknown.
    pub(super) fn slot(&self, switch: usize) -> usize {
        self.order + switch
    }

    /// Whether an interval lies between the two switches of a pair, and nothing else does.
    pub(super) fn is_within_pair(&self, interval: &Interval) -> bool {
        let Cut::Switch(first) = interval.from.from else {
            return false;
        };
        let Told::First { other, .. } = self.switches[first].told else {
            return false;
        };
        let marks = [interval.from, interval.to].into_iter();
        let mut cuts = marks.flat_map(|mark| [mark.from, mark.to]);
        cuts.all(|cut| cut == Cut::Switch(first) || cut == Cut::Switch(other))
    }

    /// The interval that ends at a switch.
    pub(super) fn before(&self, switch: usize) -> Option<usize> {
        let mut intervals = self.intervals.iter();
        intervals.position(|interval| interval.ends == Some(switch))
    }

    /// How the way between a switch and the other one of its pair is told.
    pub(super) fn opened(&self, switch: usize) -> Opening {
        self.openings[switch]
    }
}
