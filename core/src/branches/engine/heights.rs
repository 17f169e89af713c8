//! Heights of a test function above zero along a branch, and where it may come down to zero between them.
//!
//! With a second difference `c` that is at most so large between two points, `l` apart with heights `p` and `q` above zero, a function stays above
//!
//! ```text
//! p + (q - p) s / l - c s (l - s)                                                                            (1)
//! ```
//!
//! The second difference of three successive points is trusted to a factor. Where a level is touched between two points the function may have a
//! kink, to which no second difference is a bound. If it is convex all the same it stays above the chords of the parts beside. It need not be, and
//! falls the faster the nearer to the kink then: with slopes `m < 0` before and `n > 0` behind, or that of the part where that is steeper, both times `t = 2`,
//! it is looked at if
//!
//! ```text
//! p + t m s,     q - t n (l - s),                                                                              (2)
//! ```
//!
//! which meet where `s = (q - p - t n l) / (t (m - n))`, come down to zero.
//!
//! Source: (1) is the error bound of linear interpolation, as Piyavskii (1972), An algorithm for finding the absolute extremum of a
//! function, uses it with a bound on the first derivative. (2), with `t = 1`, are the two lines below a convex function of Rote (1992), The convergence rate of
//! the sandwich algorithm for approximating convex functions.

/// A second difference may be so many times as large between the points that it was taken of.
const TRUSTED: f64 = 3.0;
/// `t` of (2)
const STEEPER: f64 = 2.0;
/// The nearest that an orbit is looked for to another one, as a part of what lies between two.
const ASIDE: f64 = 0.15;

/// How far a test function is above zero at a place along the branch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    pub(super) place: f64,
    pub(super) height: f64,
}

/// Where (1), or (2) if there may be kinks, comes down lowest in an interval, below zero, between known heights that are not too close.
pub(super) fn in_doubt(
    known: &[Height],
    [from, to]: [f64; 2],
    close: f64,
    kinks: bool,
) -> Option<f64> {
    let differences: Vec<f64> = known.windows(3).map(second_difference).collect();
    let mut deepest: Option<Height> = None;
    for (i, pair) in known.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        if a.place < from || b.place > to || b.place - a.place < 2.0 * close {
            continue;
        }
        let beside = [i.checked_sub(1), Some(i)];
        let beside = beside.into_iter().flatten();
        let differences = beside.filter_map(|index| differences.get(index));
        let largest = differences.fold(0.0, |largest: f64, c| largest.max(c.abs()));
        let lowest = [
            Some(lowest_between(a, b, TRUSTED * largest)),
            below_chords(known, i).filter(|_| kinks),
        ];
        for lowest in lowest.into_iter().flatten() {
            let lower = |other: &Height| lowest.height < other.height;
            if lowest.height < 0.0 && deepest.as_ref().is_none_or(lower) {
                let aside = ASIDE * (b.place - a.place);
                let place = lowest.place.clamp(a.place + aside, b.place - aside);
                deepest = Some(Height { place, ..lowest });
            }
        }
    }
    deepest.map(|deepest| deepest.place)
}

/// Slope from one height to the next.
fn chord(pair: &[Height]) -> f64 {
    (pair[1].height - pair[0].height) / (pair[1].place - pair[0].place)
}

/// Second divided difference of three heights.
fn second_difference(known: &[Height]) -> f64 {
    (chord(&known[1..]) - chord(&known[..2])) / (known[2].place - known[0].place)
}

/// The lowest place of (2) between a height and the next one. Where one chord alone is known, that is half of the way that it is below zero.
fn below_chords(known: &[Height], i: usize) -> Option<Height> {
    let (a, b) = (known[i], known[i + 1]);
    let l = b.place - a.place;
    let before = i.checked_sub(1).map(|first| chord(&known[first..=i]));
    let behind = known.get(i + 1..i + 3).map(chord);
    let (s, height) = match (before, behind) {
        (Some(m), Some(n)) => {
            let own = (b.height - a.height) / l;
            let steep = [m.min(own), n.max(own)];
            let falls = steep[0] < 0.0 && steep[1] > 0.0;
            let [m, n] = if falls {
                steep.map(|slope| STEEPER * slope)
            } else {
                [m, n]
            };
            let s = (b.height - a.height - n * l) / (m - n);
            (s, a.height + m * s)
        }
        (Some(m), None) => (0.5 * (l - a.height / m), 0.5 * (a.height + m * l)),
        (None, Some(n)) => (0.5 * (l - b.height / n), 0.5 * (b.height - n * l)),
        (None, None) => return None,
    };
    (s > 0.0 && s < l).then_some(Height {
        place: a.place + s,
        height,
    })
}

/// The lowest place of (1) inside an interval; one of its ends if it falls or rises all along.
fn lowest_between(a: Height, b: Height, c: f64) -> Height {
    let l = b.place - a.place;
    let (p, q) = (a.height, b.height);
    let s = 0.5 * l - 0.5 * (q - p) / (c * l);
    if s > 0.0 && s < l {
        Height {
            place: a.place + s,
            height: p + (q - p) * s / l - c * s * (l - s),
        }
    } else if p < q {
        a
    } else {
        b
    }
}

#[cfg(test)]
mod tests {
    use super::super::dip::{CLOSE, LOOKS};
    use super::*;

    /// Where a function is found below zero between the last two of three points, or else the number of orbits that were looked at.
    fn below(f: impl Fn(f64) -> f64, places: [f64; 3]) -> Result<f64, usize> {
        below_between(f, places, [places[1], places[2]])
    }

    /// The same between any two of them.
    fn below_between(
        f: impl Fn(f64) -> f64,
        places: [f64; 3],
        step: [f64; 2],
    ) -> Result<f64, usize> {
        let at = |place: f64| Height {
            place,
            height: f(place),
        };
        let mut known: Vec<Height> = places.map(at).into();
        for looks in 0..LOOKS {
            let Some(place) = in_doubt(&known, step, CLOSE * (step[1] - step[0]), true) else {
                return Err(looks);
            };
            if f(place) < 0.0 {
                return Ok(place);
            }
            let next = known.iter().position(|other| other.place > place).unwrap();
            known.insert(next, at(place));
        }
        Err(LOOKS)
    }

    /// Twice the period of a gear: the function falls steeply to a touch just before the last point, and rises from there. A second difference
    /// of three points is less than a third of what there is at the touch.
    #[test]
    fn a_kink_hides_no_pair_of_zeros() {
        let kink =
            |s: f64| (1.15 - 1.6 * s).max(0.17 + 1.1 * (s - 1.0)) + 0.4 * (s * s - s).max(0.0);
        let points = [-1.2, 0.0, 1.0];
        let found = below(kink, points).unwrap();
        assert!((0.7..0.9).contains(&found), "{found}");
        assert!(below(|s| kink(s) + 0.4, points).is_err());
    }

    /// A pair of multipliers of four masses, whose modulus falls the faster the nearer it comes to a kink, where it is below one for a tenth of the step.
    #[test]
    fn a_kink_that_is_come_to_steeply_hides_no_pair_of_zeros() {
        let kink = |s: f64| {
            if s < 0.77 {
                0.365 - 0.5 * (0.77_f64.sqrt() - (0.77 - s).sqrt())
            } else {
                -0.074 + 1.2 * (s - 0.77)
            }
        };
        let points = [0.0, 1.0, 1.3];
        let found = below_between(kink, points, [0.0, 1.0]).unwrap();
        assert!((0.7..0.84).contains(&found), "{found}");
    }

    /// What halves from point to point leads to zero at the next one, and no further.
    #[test]
    fn what_decays_is_not_looked_at() {
        assert_eq!(below(|s| (-0.6 * s).exp(), [0.0, 1.0, 2.0]), Err(0));
    }
}
