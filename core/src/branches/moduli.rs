//! Moduli of multipliers as test functions.
//!
//! With the multipliers in the order of their moduli, the largest first,
//!
//! ```text
//! T_k = ln | mu_k |,     k = 1 ... n                                                                          (1)
//! ```
//!
//! are continuous along a branch wherever the multipliers are, and as many are positive as multipliers are outside of the unit circle. So
//! wherever that number changes, some of them pass zero, however many others are near the circle too: a product over all pairs, the test
//! function of Neimark-Sacker bifurcations in Govaerts (2000), chapter 4, is as small as the product of all their distances and drowns in
//! rounding. What passes there tells what happens: a complex pair, minus one, or one.

use nalgebra::{Complex, DMatrix};

use super::point::Event;
use crate::event::EventKind;
use crate::numeric::leading;
use crate::numeric::spectrum::{self, eigenvalues_of_map};

/// No modulus is told from zero below the exponential of this.
const LEAST: f64 = -30.0;
/// A multiplier whose angle to the real axis has a smaller sine is real but for rounding, which parts two that are equal by its root.
const REAL: f64 = 1e-5;
/// Logarithms of moduli that pass at once, rounded as those of a double multiplier are.
const TOGETHER: f64 = 1e-6;
/// Angles of one pair of multipliers differ by less.
const ALIKE: f64 = 1e-5;
/// So many times as large as those that are wanted: a little more than what may be left out.
const CLEAR: f64 = 1.05 * leading::OTHERS;
/// Values that differ by this part are one, whatever their errors are.
const SAME: f64 = 1e-10;

/// Eigenvalues of a map, largest first: all of them, or of many states the [leading] ones.
pub(crate) fn of_map(map: &DMatrix<f64>) -> Vec<Complex<f64>> {
    leading::leading(map).map_or_else(|| eigenvalues_of_map(map), spectrum::sort)
}

/// Multipliers over the whole period, of a map over one of its parts; largest first.
pub(crate) fn multipliers(map: &DMatrix<f64>, parts: usize) -> Vec<Complex<f64>> {
    over(of_map(map), parts)
}

/// Multipliers over so many parts, of those over one.
fn over(mut values: Vec<Complex<f64>>, parts: usize) -> Vec<Complex<f64>> {
    for value in &mut values {
        let of_part = *value;
        for _ in 1..parts {
            *value *= of_part;
        }
    }
    values
}

/// The eigenvalues of the map that was asked for last: an orbit that was looked at is read after it.
#[derive(Debug, Default)]
pub(crate) struct LastMap {
    known: Option<(DMatrix<f64>, Vec<Complex<f64>>)>,
}

impl LastMap {
    /// As [`of_map`].
    pub(crate) fn values(&mut self, map: &DMatrix<f64>) -> &[Complex<f64>] {
        let known = self.known.take().filter(|(known, _)| known == map);
        let known = known.unwrap_or_else(|| (map.clone(), of_map(map)));
        &self.known.insert(known).1
    }

    /// As [`multipliers`].
    pub(crate) fn multipliers(&mut self, map: &DMatrix<f64>, parts: usize) -> Vec<Complex<f64>> {
        over(self.values(map).to_vec(), parts)
    }
}

/// Largest distance between multipliers of a map of so many states and those of another approximation, each matched with its nearest. Where some are
/// left out as small by one of both, those count that neither leaves out.
pub(crate) fn distance(
    multipliers: &[Complex<f64>],
    others: &[Complex<f64>],
    states: usize,
) -> f64 {
    if multipliers.len().min(others.len()) == states || multipliers.is_empty() {
        return spectrum::distance(multipliers, others);
    }
    missed(multipliers, others).max(missed(others, multipliers))
}

/// How far those that are clearly not small are from their nearest among others, at most.
fn missed(multipliers: &[Complex<f64>], others: &[Complex<f64>]) -> f64 {
    let largest = multipliers.first().map_or(0.0, |m| m.norm());
    let least = CLEAR * leading::least(largest);
    let mut free = others.to_vec();
    let mut most = 0.0_f64;
    for multiplier in multipliers.iter().filter(|m| m.norm() > least) {
        let apart = |place: usize| (free[place] - multiplier).norm();
        let nearest = (0..free.len()).min_by(|&i, &j| apart(i).total_cmp(&apart(j)));
        let Some(place) = nearest else {
            return f64::INFINITY;
        };
        most = most.max((free.swap_remove(place) - multiplier).norm());
    }
    most
}

/// (1) of the multiplier at a place, those that are missing being too small to be told from zero; not a number where nothing is known.
pub(crate) fn logarithm(multipliers: &[Complex<f64>], place: usize) -> f64 {
    if multipliers.is_empty() {
        return f64::NAN;
    }
    let modulus = multipliers.get(place).map_or(0.0, |m| m.norm());
    if modulus.is_nan() {
        return f64::NAN;
    }
    modulus.ln().max(LEAST)
}

/// What happens where the multiplier at a place passes the unit circle.
pub(crate) fn crossing(multipliers: &[Complex<f64>], place: usize) -> EventKind {
    let Some(multiplier) = multipliers.get(place) else {
        return EventKind::NeimarkSacker;
    };
    if multiplier.im.abs() > REAL * multiplier.norm() {
        EventKind::NeimarkSacker
    } else if multiplier.re < 0.0 {
        EventKind::PeriodDoubling
    } else {
        EventKind::BranchPoint
    }
}

/// The same where its modulus was driven to one. A real multiplier that passes alone where a determinant `tells` so is nothing new; that of
/// two that pass at once, as those of copies do, or one after the other, does not change its sign.
pub(crate) fn seen_by_moduli(
    multipliers: &[Complex<f64>],
    place: usize,
    tells: bool,
) -> Option<EventKind> {
    let kind = crossing(multipliers, place);
    let here = logarithm(multipliers, place);
    let passes = |other: usize| {
        (logarithm(multipliers, other) - here).abs() <= TOGETHER
            && crossing(multipliers, other) == kind
    };
    let beside = [place.checked_sub(1), Some(place + 1)];
    let mut beside = beside.into_iter().flatten();
    let is_told = tells && kind != EventKind::NeimarkSacker && !beside.any(passes);
    (!is_told).then_some(kind)
}

/// Logarithms of the complex multipliers with a positive imaginary part.
pub(crate) fn pairs(multipliers: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let places = 0..multipliers.len();
    let pairs = places.filter(|place| {
        multipliers[*place].im > 0.0 && crossing(multipliers, *place) == EventKind::NeimarkSacker
    });
    let logarithms = pairs.map(|place| {
        let angle = multipliers[place].arg();
        Complex::new(logarithm(multipliers, place), angle)
    });
    logarithms.collect()
}

/// Whether an event is one of those recorded behind the same point, within the errors of both. A pair that passes has two test functions
/// (1), and rounding may part their zeros; other pairs have other angles.
pub(crate) fn is_recorded(events: &[Event], event: &Event) -> bool {
    let range = SAME * event.point.value.abs();
    let angle = |event: &Event| {
        let multipliers = &event.point.stability.multipliers;
        multipliers
            .get(nearest(multipliers).0)
            .map(|m| m.arg().abs())
    };
    let one_pair = |other: &Event| match (angle(other), angle(event)) {
        (Some(a), Some(b)) => (a - b).abs() <= ALIKE,
        _ => false,
    };
    events.iter().any(|other| {
        let apart = (other.point.value - event.point.value).abs();
        other.kind == event.kind
            && other.after == event.after
            && apart <= other.error + event.error + range
            && (event.kind != EventKind::NeimarkSacker || one_pair(other))
    })
}

/// How far the nearest multiplier is from what an event is due to: one, minus one at a doubling, or one again where the part after which an
/// orbit comes back doubles, and the unit circle at the birth of a torus. Zero where nothing is known, or multipliers say nothing of it.
pub(crate) fn from_critical(multipliers: &[Complex<f64>], kind: EventKind) -> f64 {
    let distance = |m: &Complex<f64>| match kind {
        EventKind::Fold | EventKind::BranchPoint | EventKind::SymmetryBreaking => (m - 1.0).norm(),
        EventKind::PeriodDoubling => (m + 1.0).norm().min((m - 1.0).norm()),
        EventKind::NeimarkSacker => (m.norm() - 1.0).abs(),
        _ => 0.0,
    };
    let distances = multipliers.iter().map(distance);
    distances.reduce(f64::min).unwrap_or(0.0)
}

/// The place of the multiplier that is nearest to the unit circle, if there is one, and its distance as (1) measures it.
pub(crate) fn nearest(multipliers: &[Complex<f64>]) -> (usize, f64) {
    let places = 0..multipliers.len();
    let distances = places.map(|place| (place, logarithm(multipliers, place).abs()));
    let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.unwrap_or((0, f64::INFINITY))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One pair passes the circle; fourteen others beside it do not make it small.
    #[test]
    fn a_pair_that_passes_the_unit_circle_changes_two_signs() {
        let others = (0..14).map(|i| Complex::from_polar(0.999, 0.1 + 0.2 * f64::from(i)));
        let others: Vec<_> = others.flat_map(|m| [m, m.conj()]).collect();
        let signs = |modulus: f64| {
            let pair = Complex::from_polar(modulus, 1.23);
            let all = [&[pair, pair.conj()], &others[..]].concat();
            let all = crate::numeric::spectrum::sort(all);
            (0..30)
                .map(|k| logarithm(&all, k) > 0.0)
                .collect::<Vec<_>>()
        };
        let changed = signs(1.0 - 1e-9).into_iter().zip(signs(1.0 + 1e-9));
        assert_eq!(changed.filter(|(a, b)| a != b).count(), 2);
    }

    #[test]
    fn what_passes_tells_what_happens() {
        let at = |re: f64, im: f64| crossing(&[Complex::new(re, im)], 0);
        assert_eq!(at(-0.6, 0.8), EventKind::NeimarkSacker);
        // Two that are minus one, parted by the root of a rounding.
        assert_eq!(at(-1.0, 1e-8), EventKind::PeriodDoubling);
        assert_eq!(at(1.0, 0.0), EventKind::BranchPoint);
        let alone = [Complex::new(-1.0, 0.0), Complex::new(0.9, 0.0)];
        assert_eq!(seen_by_moduli(&alone, 0, true), None);
        let untold = seen_by_moduli(&alone, 0, false);
        assert_eq!(untold, Some(EventKind::PeriodDoubling));
        let copies = [alone[0]; 2];
        let found = seen_by_moduli(&copies, 0, true);
        assert_eq!(found, Some(EventKind::PeriodDoubling));
        assert!(logarithm(&[], 0).is_nan());
        assert_eq!(logarithm(&[Complex::new(0.5, 0.0)], 1), LEAST);
    }
}
