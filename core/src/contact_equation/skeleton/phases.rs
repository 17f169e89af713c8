//! Phases of cuts with their derivatives by unknowns: of two switches by (2) of [`skeleton`](super).

use super::Skeleton;
use super::interval::{Cut, Mark};
use super::placement::Told;

/// `H` below which differences over the way are rounding.
pub(super) const CLOSEST: f64 = 1e-13;

/// By which unknown the way between two switches that may meet is told. Where both do, it is `H`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::contact_equation) enum Opening {
    /// By `H`, in which an orbit is smooth as long as the force grows from zero.
    Square,
    /// By its root, in which it is where the force jumps.
    Root,
}

impl Opening {
    /// Half of the way, and its derivative by the unknown; zero where there is none.
    pub(in crate::contact_equation) fn half(self, unknown: f64) -> [f64; 2] {
        if unknown <= 0.0 {
            return [0.0; 2];
        }
        match self {
            Self::Square => {
                let half = unknown.max(CLOSEST).sqrt();
                [half, 0.5 / half]
            }
            Self::Root => [unknown.max(CLOSEST.sqrt()), 1.0],
        }
    }

    /// How far the middle of the way moves for every unit of the lean, and its derivative by the unknown; zero where there is no way.
    pub(in crate::contact_equation) fn leaning(self, unknown: f64) -> [f64; 2] {
        if unknown <= 0.0 {
            return [0.0; 2];
        }
        match self {
            Self::Square => [unknown, 1.0],
            Self::Root => [unknown * unknown, 2.0 * unknown],
        }
    }

    /// `H`
    pub(in crate::contact_equation) fn square(self, unknown: f64) -> f64 {
        match self {
            Self::Root if unknown > 0.0 => unknown * unknown,
            _ => unknown,
        }
    }

    /// The unknown with an `H`.
    pub(in crate::contact_equation) fn unknown(self, square: f64) -> f64 {
        match self {
            Self::Root if square > 0.0 => square.sqrt(),
            _ => square,
        }
    }
}

/// A phase with its derivatives by unknowns.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Place {
    pub(in crate::contact_equation) phase: f64,
    by: [(usize, f64); 4],
    count: usize,
}

impl Place {
    pub(super) fn fixed(phase: f64) -> Self {
        Self {
            phase,
            by: [(0, 0.0); 4],
            count: 0,
        }
    }

    pub(in crate::contact_equation) fn add(&mut self, unknown: usize, slope: f64) {
        self.by[self.count] = (unknown, slope);
        self.count += 1;
    }

    pub(in crate::contact_equation) fn scale(&mut self, factor: f64) {
        self.phase *= factor;
        for (_, slope) in &mut self.by {
            *slope *= factor;
        }
    }

    pub(in crate::contact_equation) fn slopes(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        self.by.into_iter().take(self.count)
    }
}

impl Skeleton {
    /// Phase of a cut, and its derivatives by unknowns.
    pub(super) fn cut(&self, u: &[f64], cut: Cut) -> Place {
        match cut {
            Cut::Begin => Place::fixed(self.begin),
            Cut::End => Place::fixed(self.begin + self.length),
            Cut::Switch(index) => {
                let own = self.slot(index);
                let (first, square, sign) = match self.switches[index].told {
                    Told::Alone => {
                        let mut place = Place::fixed(self.begin + u[own]);
                        place.add(own, 1.0);
                        return place;
                    }
                    Told::First { other, .. } => (index, self.slot(other), -1.0),
                    Told::Second { other } => (other, own, 1.0),
                };
                let (middle, opening) = (self.slot(first), self.openings[index]);
                let [half, slope] = opening.half(u[square]);
                let [moved, by_square] = opening
                    .leaning(u[square])
                    .map(|by| self.switches[first].told.lean() * by);
                let mut place = Place::fixed(self.begin + u[middle] + moved + sign * half);
                place.add(middle, 1.0);
                if half > 0.0 {
                    place.add(square, by_square + sign * slope);
                }
                place
            }
        }
    }

    /// Phase of a mark, and its derivatives by unknowns.
    pub(in crate::contact_equation) fn place(&self, u: &[f64], mark: Mark) -> Place {
        let mut place = self.cut(u, mark.from);
        if mark.part > 0.0 {
            let to = self.cut(u, mark.to);
            place.scale(1.0 - mark.part);
            place.phase += mark.part * to.phase;
            for (unknown, slope) in to.slopes() {
                place.add(unknown, mark.part * slope);
            }
        }
        place
    }

    /// Phase of a switch.
    pub(in crate::contact_equation) fn phase(&self, u: &[f64], switch: usize) -> f64 {
        self.cut(u, Cut::Switch(switch)).phase
    }
}
