//! Where a series crosses a level.
//!
//! The phase is cut into intervals several times shorter than the shortest wave. An interval with a change of sign
//! holds one crossing; one whose ends lie on the same side, with an extremum between them that points to the level, holds
//! two or none: the extremum is found first. Both searches are Newton's method kept inside a bracket by bisection
//! (Press et al. (2007), Numerical Recipes, section 9.4).

use std::f64::consts::TAU;

use super::series;

/// A crossing of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Phase, in `[0, 2 pi]`.
    pub tau: f64,
    /// From below to above.
    pub rising: bool,
}

/// Intervals per shortest wave.
const INTERVALS_PER_WAVE: usize = 8;

/// Appends the crossings in order of phase. A series that touches the level without crossing it has none.
pub fn crossings(series: &[f64], level: f64, found: &mut Vec<Crossing>) {
    let highest = series[1..]
        .chunks_exact(2)
        .rposition(|pair| pair[0] != 0.0 || pair[1] != 0.0);
    let Some(highest) = highest else {
        return;
    };
    let series = &series[..series::length(highest + 1)];
    let intervals = (INTERVALS_PER_WAVE * (highest + 1)).max(32);
    let at = |tau: f64| {
        let (x, x1, x2) = series::value_and_derivatives(series, tau);
        (x - level, x1, x2)
    };
    let mut left = (0.0, at(0.0));
    for index in 1..=intervals {
        let tau = TAU * index as f64 / intervals as f64;
        // The period closes exactly, whatever the rounding of 2 pi.
        let right = (tau, if index == intervals { at(0.0) } else { at(tau) });
        search_interval(&at, left, right, found);
        left = right;
    }
}

type Sample = (f64, (f64, f64, f64));

fn search_interval(
    at: &impl Fn(f64) -> (f64, f64, f64),
    left: Sample,
    right: Sample,
    found: &mut Vec<Crossing>,
) {
    let (a, (xa, va, _)) = left;
    let (b, (xb, vb, _)) = right;
    let above = xa > 0.0;
    if above != (xb > 0.0) {
        found.push(Crossing {
            tau: root(|t| first_two(at(t)), a, b, above),
            rising: !above,
        });
        return;
    }
    let dips = if above {
        va < 0.0 && vb > 0.0
    } else {
        va > 0.0 && vb < 0.0
    };
    if dips {
        let extremum = root(|t| last_two(at(t)), a, b, va > 0.0);
        if (at(extremum).0 > 0.0) != above {
            let first = root(|t| first_two(at(t)), a, extremum, above);
            let second = root(|t| first_two(at(t)), extremum, b, !above);
            found.push(Crossing {
                tau: first,
                rising: !above,
            });
            found.push(Crossing {
                tau: second,
                rising: above,
            });
        }
    }
}

fn first_two((x, v, _): (f64, f64, f64)) -> (f64, f64) {
    (x, v)
}

/// The phase in `[a, b]` where the slope of a series changes its sign; `rising` is its sign at `a`.
pub(crate) fn extremum(of: &[f64], a: f64, b: f64, rising: bool) -> f64 {
    root(
        |t| last_two(series::value_and_derivatives(of, t)),
        a,
        b,
        rising,
    )
}

fn last_two((_, v, a): (f64, f64, f64)) -> (f64, f64) {
    (v, a)
}

/// The change of sign in `[a, b]` of a function given with its derivative; `positive` is its sign at `a`.
fn root(f: impl Fn(f64) -> (f64, f64), mut a: f64, mut b: f64, positive: bool) -> f64 {
    let mut t = 0.5 * (a + b);
    for _ in 0..100 {
        let (x, slope) = f(t);
        if (x > 0.0) == positive {
            a = t;
        } else {
            b = t;
        }
        let newton = t - x / slope;
        let next = if newton > a && newton < b {
            newton
        } else {
            0.5 * (a + b)
        };
        if (next - t).abs() <= 2.0 * f64::EPSILON * t.abs().max(1e-3) {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn all(series: &[f64], level: f64) -> Vec<Crossing> {
        let mut found = Vec::new();
        crossings(series, level, &mut found);
        found
    }

    #[test]
    fn a_cosine_crosses_where_its_arc_cosine_is() {
        let found = all(&[0.0, 2.0, 0.0], 1.0);
        let third = TAU / 6.0;
        assert_eq!(found.len(), 2);
        assert!((found[0].tau - third).abs() < 1e-15 && !found[0].rising);
        assert!((found[1].tau - (TAU - third)).abs() < 1e-14 && found[1].rising);
    }

    #[test]
    fn a_pair_closer_than_an_interval_is_found() {
        // cos tau exceeds 1 - 1e-8 only for |tau| < 1.4e-4, and with a phase that interval straddles no sample.
        let (sine, cosine) = 0.1_f64.sin_cos();
        let found = all(&[0.0, cosine, sine], 1.0 - 1e-8);
        let half = (1.0 - 1e-8_f64).acos();
        assert_eq!(found.len(), 2);
        assert!((found[0].tau - (0.1 - half)).abs() < 1e-11);
        assert!((found[1].tau - (0.1 + half)).abs() < 1e-11);
    }

    #[test]
    fn nothing_crosses_when_it_only_touches_or_rests() {
        assert!(all(&[1.0, 1.0, 0.0], 2.0).is_empty());
        assert!(all(&[1.0], 1.0).is_empty());
        assert!(all(&[1.0, 0.0, 0.0], 0.5).is_empty());
    }

    proptest! {
        #[test]
        fn signs_between_crossings_are_right(
            series in (1_usize..10).prop_flat_map(|k| prop::collection::vec(-1.0..1.0_f64, series::length(k))),
        ) {
            let found = all(&series, 0.2);
            prop_assert!(found.len().is_multiple_of(2));
            let mut above = series::value(&series, 0.0) > 0.2;
            let mut last = 0.0;
            for crossing in &found {
                let middle = 0.5 * (last + crossing.tau);
                prop_assert_eq!(series::value(&series, middle) > 0.2, above);
                prop_assert_eq!(crossing.rising, !above);
                prop_assert!((series::value(&series, crossing.tau) - 0.2).abs() < 1e-12);
                above = crossing.rising;
                last = crossing.tau;
            }
        }
    }
}
