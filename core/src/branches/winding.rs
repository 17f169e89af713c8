//! Where a branch winds: many folds in a small part of its range.

use std::fmt;

use super::branch::Branch;
use crate::event::EventKind;
use crate::numeric::decimal::Decimal;

/// So many folds are no shape that one reads off a curve.
const MANY: usize = 24;
/// The part of the range that they are in.
const NARROW: f64 = 1e-3;

/// A part of a branch in which it turns back again and again: see [`Branch::winding`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Winding {
    /// The folds in it, and other turns that were not located.
    pub folds: usize,
    /// The smallest and the largest value of them.
    pub within: [f64; 2],
}

impl Branch {
    /// Where it winds: the narrow part of its range, a thousandth, that has most folds, if those are dozens. The points of a branch are
    /// spent there, and what to do about it is what the text of this says.
    pub fn winding(&self) -> Option<Winding> {
        let values = self.points.iter().map(|point| point.value);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let folds = self.folds().map(|fold| fold.point.value);
        let turns = self
            .turns
            .iter()
            .filter(|turn| turn.kind == EventKind::Fold);
        let folds = folds.chain(turns.map(|turn| turn.value));
        densest(folds.collect(), NARROW * (high - low))
    }
}

/// The part of this width with most values, if those are many.
fn densest(mut values: Vec<f64>, width: f64) -> Option<Winding> {
    values.sort_unstable_by(f64::total_cmp);
    let mut first = 0;
    let mut most: Option<Winding> = None;
    for (last, &value) in values.iter().enumerate() {
        while value - values[first] > width {
            first += 1;
        }
        let folds = last + 1 - first;
        if folds >= MANY && most.is_none_or(|most| folds > most.folds) {
            most = Some(Winding {
                folds,
                within: [values[first], value],
            });
        }
    }
    most
}

impl fmt::Display for Winding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            folds,
            within: [low, high],
        } = *self;
        let apart = (high - low).max(f64::MIN_POSITIVE);
        let [low, high] = [low, high].map(|value| Decimal::to_error(value, apart));
        write!(
            f,
            "the branch winds: {folds} folds between {low} and {high}, within a thousandth of its range. \
             A coarser tolerance or a larger `largest_step` steps over turns that are smaller, `max_points` bounds what is spent on them, and \
             more damping or a law without a jump has fewer"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dozens_of_folds_in_a_narrow_part_are_a_winding() {
        let spread = (0..100).map(|index| f64::from(index) / 100.0);
        let close = (0..30).map(|index| 0.5 + 1e-5 * f64::from(index));
        assert_eq!(densest(spread.clone().collect(), 1e-3), None);
        let all: Vec<f64> = close.chain(spread).collect();
        let found = densest(all, 1e-3).expect("they are many");
        // One of the others is where they begin.
        assert_eq!(found.folds, 31);
        assert_eq!(found.within[0], 0.5);
        assert!((found.within[1] - 0.50029).abs() < 1e-12);
        let said = found.to_string();
        assert!(
            said.contains("31 folds between 0.5000 and 0.5003"),
            "{said}"
        );
        assert_eq!(densest((0..23).map(|_| 1.0).collect(), 1e-3), None);
        assert_eq!(densest(Vec::new(), f64::NAN), None);
    }
}
