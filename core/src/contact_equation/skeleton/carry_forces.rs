//! Forces of another orbit beside a short stretch, where nodes move as the root of `H` of (2) of [`skeleton`](super).

use super::Skeleton;
use super::interval::{Cut, Mark};
use super::placement::Told;

/// A stretch is short where `H` is less.
const OPEN: f64 = 0.05;

impl Skeleton {
    /// Takes forces from another orbit beside a short stretch. Its ends move as the root of `H`, and nodes on both sides with them; as functions
    /// of the phase from its middle `c` forces hardly change there. Says whether there were any.
    pub(in crate::contact_equation) fn carry_forces(&self, known: &[f64], u: &mut [f64]) -> bool {
        let mut polynomials = Vec::new();
        let mut carried = false;
        for interval in &self.intervals {
            let marks = [interval.from, interval.to];
            let is_beside = marks.iter().any(|mark| {
                let mut cuts = [mark.from, mark.to].into_iter();
                cuts.any(|cut| self.opens(cut, u, known))
            });
            if interval.active.is_empty() || self.is_within_pair(interval) || !is_beside {
                continue;
            }
            let ends = |u: &[f64]| marks.map(|mark| self.place(u, mark).phase);
            let ([from, to], [a, b]) = (ends(u), ends(known));
            if b <= a {
                continue;
            }
            carried = true;
            let [first, last] = marks.map(|mark| self.moved(mark, u, known));
            polynomials.resize(interval.nodes.count(), 0.0);
            for node in 0..polynomials.len() {
                let target = interval.nodes.targets[node];
                let moved = first + target * (last - first);
                let psi = (from + target * (to - from) - moved - a) / (b - a);
                interval
                    .nodes
                    .polynomials(psi.clamp(0.0, 1.0), &mut polynomials);
                for active in &interval.active {
                    let forces = &known[active.first..][..polynomials.len()];
                    let force = polynomials.iter().zip(forces).map(|(l, f)| l * f).sum();
                    u[active.first + node] = force;
                }
            }
        }
        carried
    }

    /// How far a mark has moved between two orbits, of a short pair its `c`: that moves by little where `H` passes zero.
    fn moved(&self, mark: Mark, u: &[f64], known: &[f64]) -> f64 {
        let cut = |cut: Cut| match cut {
            Cut::Switch(index) if self.opens(cut, u, known) => {
                let place = match self.switches[index].told {
                    Told::Second { other } => self.slot(other),
                    Told::First { .. } | Told::Alone => self.slot(index),
                };
                u[place] - known[place]
            }
            _ => self.cut(u, cut).phase - self.cut(known, cut).phase,
        };
        (1.0 - mark.part) * cut(mark.from) + mark.part * cut(mark.to)
    }

    /// Whether a cut is at one of a pair of switches with a short way between them in one of two orbits at least, which has not gone in both.
    fn opens(&self, cut: Cut, u: &[f64], known: &[f64]) -> bool {
        let Cut::Switch(index) = cut else {
            return false;
        };
        let second = match self.switches[index].told {
            Told::Alone => return false,
            Told::First { other, .. } => other,
            Told::Second { .. } => index,
        };
        let told = self.openings[index];
        let squares = [u, known].map(|u| told.square(u[self.slot(second)]));
        squares[0].max(squares[1]) > 0.0 && squares[0].min(squares[1]) <= OPEN
    }
}
