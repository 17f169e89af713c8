//! Where gaps meet levels.

use nalgebra::DVector;

use super::motion::{Motions, Step};

impl Motions<'_> {
    /// The first level that a gap meets in a step: contact, the piece after it, and the time from the beginning.
    pub fn switch(
        &self,
        here: &Step,
        to: &DVector<f64>,
        length: f64,
    ) -> Option<(usize, usize, f64)> {
        let mut first: Option<(usize, usize, f64)> = None;
        for (contact, levels) in self.levels.iter().enumerate() {
            let piece = here.pieces[contact];
            let low = piece
                .checked_sub(1)
                .map(|below| (levels[below], 1.0, below));
            let high = levels.get(piece).map(|level| (*level, -1.0, piece + 1));
            for (level, sign, after) in low.into_iter().chain(high) {
                let met = match first {
                    Some((_, _, at)) => {
                        self.met(here, (contact, level, sign), at, &self.step(here, at).to)
                    }
                    None => self.met(here, (contact, level, sign), length, to),
                };
                if let Some(at) = met {
                    first = Some((contact, after, at));
                }
            }
        }
        first
    }

    /// Where a gap leaves its piece through a border, within so much of a step.
    fn met(
        &self,
        here: &Step,
        (contact, level, sign): (usize, f64, f64),
        length: f64,
        to: &DVector<f64>,
    ) -> Option<f64> {
        let inside = |[value, rate]: [f64; 2]| [sign * (value - level), sign * rate];
        let after = |time: f64| inside(self.gap(contact, &self.step(here, time).to));
        let begin = inside(self.gap(contact, &here.from));
        let end = inside(self.gap(contact, to));
        let (mut low, mut high) = ((0.0, begin[0]), (length, end[0]));
        if begin[1] * end[1] < 0.0 {
            // It has an extremum within.
            let extremum_matters = begin[1] < 0.0 || end[0] < 0.0;
            if extremum_matters {
                let at = root((0.0, begin[1]), (length, end[1]), |time| after(time)[1]);
                let extremum = after(at)[0];
                if extremum < 0.0 && begin[0] > 0.0 {
                    high = (at, extremum);
                } else if extremum > 0.0 {
                    low = (at, extremum);
                } else if end[0] >= 0.0 {
                    return None;
                }
            }
        }
        if high.1 >= 0.0 {
            return None;
        }
        if low.1 <= 0.0 {
            // It begins on the border and leaves at once.
            return Some(0.0);
        }
        Some(root(low, high, |time| after(time)[0]))
    }
}

/// A zero between two places of different sign: the Illinois method of Dowell and Jarratt (1971), BIT 11, 168.
pub fn root(
    (mut a, mut at_a): (f64, f64),
    (mut b, mut at_b): (f64, f64),
    f: impl Fn(f64) -> f64,
) -> f64 {
    for _ in 0..60 {
        let middle = (a * at_b - b * at_a) / (at_b - at_a);
        let between = middle > a.min(b) && middle < a.max(b);
        let middle = if between { middle } else { 0.5 * (a + b) };
        let at_middle = f(middle);
        if at_middle == 0.0 || (b - a).abs() <= 4.0 * f64::EPSILON * b.abs().max(a.abs()) {
            return middle;
        }
        if at_middle * at_b < 0.0 {
            (a, at_a) = (b, at_b);
        } else {
            at_a *= 0.5;
        }
        (b, at_b) = (middle, at_middle);
    }
    b
}
