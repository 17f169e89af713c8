//! How orbits come back before their period is over: after a part of it, with coordinates in each other's place.
//!
//! Let a system be so that with every motion `q(t)` also `S^-1 q(t + T/m)` is one, where `T` is the period of the declaration and `S`
//! permutes coordinates and changes signs. Odd symmetry has `m = 2` and `S = -1`; where `m` contacts take each other's place, as the
//! balls of a bearing, `S` is one. Orbits may have that symmetry or a power of it,
//!
//! ```text
//! q(t + j T/m) = S^j q(t),                                                                                     (1)
//! ```
//!
//! and `n m / j` such parts are a period of `n T`. With `S^m = 1`, `j / m` in lowest terms is the period over the number of parts.
//! Where an orbit ceases to have (1) and keeps it with `2 j`, its period doubles if the order of `S^j` is odd, and else it is the same:
//! then only a symmetry breaks.
//!
//! Source: Golubitsky, Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XVI (spatio-temporal
//! symmetry); Lamb and Melbourne (1999), Bifurcation from discrete rotating waves, section 2 (the map over a part of the period, of
//! which the multipliers are powers).

use crate::continuation::follow::Stop;
use crate::event::EventKind;

/// A permutation of coordinates with signs, `(S q)_i = s_i q_(p_i)`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SignedPermutation {
    /// `p_i` and `s_i`; nothing for the identity.
    entries: Vec<(usize, i8)>,
}

impl SignedPermutation {
    pub(crate) fn identity() -> Self {
        Self::default()
    }

    /// Whether it is one of so many coordinates: what was read from a file may be anything.
    pub(crate) fn is_of(&self, coordinates: usize) -> bool {
        let mut places: Vec<usize> = self.entries.iter().map(|(place, _)| *place).collect();
        places.sort_unstable();
        let signs = self.entries.iter().all(|(_, sign)| sign.abs() == 1);
        self.is_identity() || (signs && places.into_iter().eq(0..coordinates))
    }

    /// All signs change.
    pub(crate) fn minus(coordinates: usize) -> Self {
        Self::of((0..coordinates).map(|i| (i, -1)).collect())
    }

    /// Of the places `p_i` and signs `s_i`.
    pub(crate) fn of(entries: Vec<(usize, i8)>) -> Self {
        let same = entries.iter().enumerate();
        let mut same = same.map(|(i, entry)| *entry == (i, 1));
        if same.all(|same| same) {
            return Self::identity();
        }
        Self { entries }
    }

    pub(crate) fn is_identity(&self) -> bool {
        self.entries.is_empty()
    }

    pub(crate) fn is_minus(&self) -> bool {
        let mut entries = self.entries.iter().enumerate();
        !self.is_identity() && entries.all(|(i, entry)| *entry == (i, -1))
    }

    /// `p_i` and `s_i` of a coordinate.
    pub(crate) fn entry(&self, coordinate: usize) -> (usize, f64) {
        let entry = self.entries.get(coordinate);
        entry.map_or((coordinate, 1.0), |&(place, sign)| (place, f64::from(sign)))
    }

    /// The same of an entry of a state, or of states one after the other, of so many coordinates.
    pub(crate) fn state_entry(&self, entry: usize, coordinates: usize) -> (usize, f64) {
        let coordinate = entry % coordinates;
        let (place, sign) = self.entry(coordinate);
        (entry - coordinate + place, sign)
    }

    /// The image of states one after the other.
    pub(crate) fn of_states(&self, states: &[f64], coordinates: usize) -> Vec<f64> {
        let image = |entry: usize| {
            let (place, sign) = self.state_entry(entry, coordinates);
            sign * states[place]
        };
        (0..states.len()).map(image).collect()
    }

    /// Whether a state is its own image, to what [`are_near`] allows.
    pub(crate) fn holds(&self, state: &[f64], most: f64, omega: f64) -> bool {
        are_near(state, &self.of_states(state, state.len() / 2), most, omega)
    }

    /// Writes the image of one state.
    pub(crate) fn write(&self, state: &[f64], image: &mut [f64]) {
        for (entry, to) in image.iter_mut().enumerate() {
            let (place, sign) = self.state_entry(entry, state.len() / 2);
            *to = sign * state[place];
        }
    }

    /// This one after another one.
    pub(crate) fn after(&self, first: &Self) -> Self {
        let coordinates = self.entries.len().max(first.entries.len());
        let entry = |i: usize| {
            let (place, sign) = self.entry(i);
            let (place, other) = first.entry(place);
            (place, if sign * other < 0.0 { -1 } else { 1 })
        };
        Self::of((0..coordinates).map(entry).collect())
    }

    pub(crate) fn power(&self, exponent: usize) -> Self {
        let mut power = Self::identity();
        for _ in 0..exponent % self.order() {
            power = self.after(&power);
        }
        power
    }

    /// The least power that is the identity: the least common multiple of the lengths of its cycles, twice those that change a sign.
    pub(crate) fn order(&self) -> usize {
        let mut seen = vec![false; self.entries.len()];
        let mut order: usize = 1;
        for first in 0..self.entries.len() {
            let (mut place, mut length, mut sign) = (first, 0, 1.0);
            while !seen[place] {
                seen[place] = true;
                let (next, own) = self.entry(place);
                (place, length, sign) = (next, length + 1, sign * own);
            }
            if length > 0 {
                let length = if sign < 0.0 { 2 * length } else { length };
                order = order.saturating_mul(length / greatest_common_divisor(order, length));
            }
        }
        order
    }
}

/// A symmetry of a system: motions are taken into motions by a part of the period of the declaration, one of so many, and coordinates in
/// each other's place. As many of it as there are parts are nothing but a period.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CyclicSymmetry {
    /// `m`
    pub(crate) parts: usize,
    /// `S`
    pub(crate) image: SignedPermutation,
}

impl CyclicSymmetry {
    /// What all systems have.
    #[cfg(test)]
    pub(crate) fn none() -> Self {
        Self {
            parts: 1,
            image: SignedPermutation::identity(),
        }
    }

    /// More regular recurrences than a given one which imply it, the most regular first, each with its `j`.
    pub(crate) fn within(
        &self,
        given: &Recurrence,
    ) -> impl Iterator<Item = (usize, Recurrence)> + use<'_> {
        let steps = given.period * self.parts;
        let whole = steps.is_multiple_of(given.parts);
        let steps = if whole { steps / given.parts } else { 0 };
        let implied = whole && self.image.power(steps) == given.image;
        let divisors = (1..=steps / 2).filter(move |j| implied && steps.is_multiple_of(*j));
        divisors.map(|j| (j, self.recurrence(j)))
    }

    /// (1)
    fn recurrence(&self, steps: usize) -> Recurrence {
        let common = greatest_common_divisor(steps, self.parts);
        Recurrence {
            period: steps / common,
            parts: self.parts / common,
            image: self.image.power(steps),
        }
    }
}

/// How an orbit comes back: after a part of its period, with an image of its coordinates.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Recurrence {
    /// Its period, in periods of the declaration.
    pub(crate) period: usize,
    /// How many such parts a period has.
    pub(crate) parts: usize,
    pub(crate) image: SignedPermutation,
}

impl Recurrence {
    /// After whole periods.
    pub(crate) fn whole(period: usize) -> Self {
        Self {
            period,
            parts: 1,
            image: SignedPermutation::identity(),
        }
    }

    /// Why a branch ends where it meets orbits that come back so.
    pub(crate) fn joined_at(&self, value: f64) -> Stop {
        Stop::Joined {
            period: self.period,
            symmetric: self.image.is_minus(),
            value,
        }
    }

    /// After twice the time.
    pub(crate) fn doubled(&self) -> Self {
        let halves = self.parts.is_multiple_of(2);
        Self {
            period: if halves { self.period } else { 2 * self.period },
            parts: if halves { self.parts / 2 } else { self.parts },
            image: self.image.after(&self.image),
        }
    }

    /// What happens where orbits begin that come back after twice the time only.
    pub(crate) fn doubling(&self) -> EventKind {
        if self.image.order().is_multiple_of(2) {
            EventKind::SymmetryBreaking
        } else {
            EventKind::PeriodDoubling
        }
    }

    /// Harmonics of the orbit are multiples of this one.
    pub(crate) fn stride(&self) -> usize {
        if self.image.is_identity() {
            self.parts
        } else if self.image.is_minus() {
            self.parts / 2
        } else {
            1
        }
    }
}

/// How an orbit comes back in less time than it is followed for, the least that there is; `None` if it does not. Whether it comes back
/// like this, after `j` steps of the symmetry of that index, is asked with `j` rising for each of them.
///
/// # Errors
/// What the answer fails with.
pub(crate) fn least<E>(
    given: &Recurrence,
    symmetries: &[CyclicSymmetry],
    mut comes_back: impl FnMut(usize, usize, &Recurrence) -> Result<bool, E>,
) -> Result<Option<Recurrence>, E> {
    let mut least: Option<Recurrence> = None;
    for (index, symmetry) in symmetries.iter().enumerate() {
        for (steps, recurrence) in symmetry.within(given) {
            let shorter = |least: &Recurrence| {
                recurrence.period * least.parts < least.period * recurrence.parts
            };
            if !least.as_ref().is_none_or(shorter) {
                break;
            }
            if comes_back(index, steps, &recurrence)? {
                least = Some(recurrence);
                break;
            }
        }
    }
    Ok(least)
}

/// Whether there may be orbits that come back in less time than one is followed for.
pub(crate) fn may_be_earlier(given: &Recurrence, symmetries: &[CyclicSymmetry]) -> bool {
    let mut symmetries = symmetries.iter();
    symmetries.any(|symmetry| symmetry.within(given).next().is_some())
}

/// Whether coordinates of two states differ by `most` at most, and their rates by that times `omega`.
pub(crate) fn are_near(state: &[f64], other: &[f64], most: f64, omega: f64) -> bool {
    let n = state.len() / 2;
    let mut pairs = state.iter().zip(other).enumerate();
    pairs.all(|(i, (x, y))| (x - y).abs() <= most * if i < n { 1.0 } else { omega })
}

pub(crate) fn greatest_common_divisor(mut a: usize, mut b: usize) -> usize {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recurrence(period: usize, parts: usize, image: SignedPermutation) -> Recurrence {
        Recurrence {
            period,
            parts,
            image,
        }
    }

    /// A quarter of a turn of the plane.
    fn turn() -> SignedPermutation {
        SignedPermutation::of(vec![(1, -1), (0, 1)])
    }

    #[test]
    fn images_are_a_group() {
        assert_eq!(turn().order(), 4);
        assert!(turn().power(2).is_minus());
        assert!(turn().power(4).is_identity());
        assert_eq!(
            turn().of_states(&[1.0, 2.0, 3.0, 4.0], 2),
            [-2.0, 1.0, -4.0, 3.0]
        );
        assert_eq!(SignedPermutation::identity().order(), 1);
    }

    /// Balls of a bearing: a sixteenth of the period, then an eighth. Seven of them: twice the declared period at once.
    #[test]
    fn a_passage_doubles_within_the_period_where_there_is_an_even_number_of_them() {
        let image = SignedPermutation::identity;
        let passage = recurrence(1, 16, image());
        assert_eq!(passage.doubling(), EventKind::PeriodDoubling);
        assert_eq!(passage.doubled(), recurrence(1, 8, image()));
        let odd = recurrence(1, 7, image());
        assert_eq!(odd.doubling(), EventKind::PeriodDoubling);
        assert_eq!(odd.doubled(), recurrence(2, 7, image()));
    }

    #[test]
    fn a_symmetry_of_even_order_breaks() {
        let half = recurrence(1, 2, SignedPermutation::minus(2));
        assert_eq!(half.doubling(), EventKind::SymmetryBreaking);
        assert_eq!(half.doubled(), Recurrence::whole(1));
        let quarter = recurrence(1, 4, turn());
        assert_eq!(quarter.doubling(), EventKind::SymmetryBreaking);
        assert_eq!(quarter.doubled(), half);
        let three = SignedPermutation::of(vec![(1, 1), (2, 1), (0, 1)]);
        let third = recurrence(1, 3, three);
        assert_eq!(third.doubling(), EventKind::PeriodDoubling);
        assert_eq!(third.doubled().period, 2);
    }

    #[test]
    fn more_regular_orbits_are_those_of_divisors() {
        let odd = CyclicSymmetry {
            parts: 2,
            image: SignedPermutation::minus(1),
        };
        let within = |period: usize| -> Vec<(usize, usize, bool)> {
            let given = Recurrence::whole(period);
            let found = odd.within(&given);
            found
                .map(|(_, found)| (found.period, found.parts, found.image.is_minus()))
                .collect()
        };
        assert_eq!(within(1), [(1, 2, true)]);
        assert_eq!(within(2), [(1, 2, true), (1, 1, false)]);
        assert_eq!(within(3), [(1, 2, true), (1, 1, false), (3, 2, true)]);
        let half = recurrence(3, 2, SignedPermutation::minus(1));
        let more: Vec<_> = odd.within(&half).map(|(steps, _)| steps).collect();
        assert_eq!(more, [1]);
    }
}
