//! Crossings with known phases, and what must hold for any series.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::{Crossing, CrossingFinder, NearMiss, crossings};
use crate::numeric::fourier::series;
use crate::testing::allocations::count;

mod companion;

fn all(series: &[f64], level: f64) -> Vec<Crossing> {
    let mut found = Vec::new();
    crossings(series, level, &mut found);
    found
}

fn misses(series: &[f64], level: f64, distance: f64) -> Vec<NearMiss> {
    let mut finder = CrossingFinder::new(series::harmonics(series));
    finder.sample(series);
    let mut found = Vec::new();
    finder.near_misses(level, distance, &mut found);
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
fn crossings_at_the_end_of_the_period_are_in_order() {
    // sin 3 tau is zero at the first sample, on neither side.
    let found = all(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 0.0);
    assert_eq!(found.len(), 6);
    for (index, crossing) in found.iter().enumerate() {
        let phases = [0.0, PI / 3.0, TAU / 3.0, PI, 4.0 * PI / 3.0, 5.0 * PI / 3.0];
        let off = (crossing.tau - phases[index]).abs();
        assert!(off.min(TAU - off) < 1e-15, "{found:?}");
        assert_eq!(crossing.rising, index % 2 == 0);
    }
}

#[test]
fn nothing_crosses_when_it_only_touches_or_rests() {
    assert!(all(&[1.0, 1.0, 0.0], 2.0).is_empty());
    assert!(all(&[1.0], 1.0).is_empty());
    assert!(all(&[1.0, 0.0, 0.0], 0.5).is_empty());
    assert!(all(&[1.0, 1e-17, 1e-18], 1.0).is_empty());
    let (sine, cosine) = 0.1_f64.sin_cos();
    assert!(all(&[0.0, cosine, sine], 1.0).is_empty());
}

#[test]
fn a_touch_of_fourth_order_is_none() {
    // (1 - cos(tau - 1))^2 = 3/2 - 2 cos(tau - 1) + 1/2 cos 2(tau - 1), which is zero to fourth order at 1.
    let (s1, c1) = 1.0_f64.sin_cos();
    let (s2, c2) = 2.0_f64.sin_cos();
    let series = [1.5, -2.0 * c1, -2.0 * s1, 0.5 * c2, 0.5 * s2];
    assert!(all(&series, 0.0).is_empty());
    // Half of the width where it is below e is acos(1 - sqrt e).
    let found = all(&series, 1e-8);
    let half = (1.0 - 1e-4_f64).acos();
    assert_eq!(found.len(), 2);
    assert!((found[0].tau - (1.0 - half)).abs() < 1e-9 && !found[0].rising);
    assert!((found[1].tau - (1.0 + half)).abs() < 1e-9 && found[1].rising);
}

#[test]
fn a_stretch_that_rests_on_the_level_is_no_crossing() {
    // cos^40(tau / 2) = 2^-40 binomial(40, 20) (1 + 2 sum_k binomial(40, 20 + k) / binomial(40, 20) cos k tau), below
    // 1e-16 from tau = 2.33 on.
    let mut series = vec![0.0; series::length(20)];
    let mut share = 1.0;
    let mut sum = 1.0;
    for k in 1..=20 {
        share *= f64::from(21 - k) / f64::from(20 + k);
        series[2 * k as usize - 1] = 2.0 * share;
        sum += 2.0 * share;
    }
    series[0] = 1.0;
    for coefficient in &mut series {
        *coefficient /= sum;
    }
    assert!(all(&series, 0.0).is_empty());
    for level in [1e-9_f64, 1e-3, 0.5] {
        let found = all(&series, level);
        let half = 2.0 * level.powf(1.0 / 40.0).acos();
        assert_eq!(found.len(), 2);
        let slope = 20.0 * (0.5 * half).tan() * level;
        let allowed = 10.0 * f64::EPSILON / slope;
        assert!((found[0].tau - half).abs() < allowed && !found[0].rising);
        assert!((found[1].tau - (TAU - half)).abs() < allowed && found[1].rising);
    }
}

#[test]
fn an_inflection_on_the_level_crosses_once() {
    // sin^3 tau = 3/4 sin tau - 1/4 sin 3 tau.
    let found = all(&[0.0, 0.0, 0.75, 0.0, 0.0, 0.0, -0.25], 0.0);
    assert_eq!(found.len(), 2);
    for crossing in found {
        assert!(crossing.tau.sin().powi(3).abs() < 1e-15);
        assert_eq!(crossing.rising, crossing.tau.cos() > 0.0);
    }
}

#[test]
fn amplitudes_of_any_size_cross_at_the_same_phases() {
    let series = [0.25, 1.0, -0.5, 0.25, 0.125];
    let expected = all(&series, 0.5);
    assert_eq!(expected.len(), 2);
    for exponent in [-1000, -300, 300, 1000] {
        let factor = 2.0_f64.powi(exponent);
        let scaled = series.map(|x| x * factor);
        assert_eq!(all(&scaled, 0.5 * factor), expected);
    }
    for factor in [1e-300, 1e300, 1e-310, 1.7e308] {
        let scaled = series.map(|x| x * factor);
        let found = all(&scaled, 0.5 * factor);
        assert_eq!(found.len(), 2);
        for (a, b) in found.iter().zip(&expected) {
            // 1e-310 has 43 bits only.
            assert!((a.tau - b.tau).abs() < if factor == 1e-310 { 1e-12 } else { 1e-14 });
        }
    }
    assert_eq!(all(&[-1.7e308, 1.7e308, 0.0], 1e307).len(), 0);
    assert_eq!(all(&[-1.7e308, 1.7e308, 0.0], -1e307).len(), 2);
}

#[test]
fn what_is_not_finite_crosses_nothing() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for index in 0..5 {
            let mut series = [0.1, 1.0, -0.5, 0.25, 0.125];
            series[index] = bad;
            assert!(all(&series, 0.0).is_empty());
            assert!(misses(&series, 0.0, 10.0).is_empty());
        }
        assert!(all(&[0.1, 1.0, 0.5], bad).is_empty());
        assert!(misses(&[0.1, 1.0, 0.5], bad, 1.0).is_empty());
    }
    assert!(misses(&[0.1, 1.0, 0.5], 0.0, f64::NAN).is_empty());
    assert!(misses(&[0.1, 1.0, 0.5], 0.0, -1.0).is_empty());
    assert_eq!(misses(&[0.1, 1.0, 0.5], 0.0, f64::INFINITY).len(), 0);
    assert_eq!(misses(&[3.1, 1.0, 0.5], 0.0, f64::INFINITY).len(), 1);
    assert!(all(&[], 0.0).is_empty());
}

#[test]
fn a_minimum_above_and_a_maximum_below_are_near_misses() {
    // Minima of cos 2 (tau - 0.3) are at 0.3 + pi/2 and 0.3 + 3 pi/2, with curvature 4.
    let (sine, cosine) = 0.6_f64.sin_cos();
    let series = [5.0, 0.0, 0.0, 3.0 * cosine, 3.0 * sine];
    for (level, first) in [(1.99, 0.3 + PI / 2.0), (8.01, 0.3)] {
        assert!(misses(&series, level, 0.009).is_empty());
        let found = misses(&series, level, 0.02);
        assert_eq!(found.len(), 2);
        for (miss, tau) in found.iter().zip([first, first + PI]) {
            assert!((miss.tau - tau).abs() < 1e-14, "{miss:?}");
            assert!((miss.distance - 0.01).abs() < 1e-14);
            assert!((miss.curvature - 12.0).abs() < 1e-12);
        }
    }
    // Across the level, so a pair of crossings and no miss.
    assert!(misses(&series, 2.01, 0.02).is_empty());
    // Exactly touched.
    assert_eq!(misses(&series, 2.0, 0.02).len(), 2);
}

#[test]
fn an_extremum_on_a_sample_is_one_near_miss() {
    for (sign, tau) in [(1.0, PI), (-1.0, 0.0)] {
        let found = misses(&[1.0, sign, 0.0], -0.125, 0.2);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].tau - tau).abs() < 1e-15);
        assert_eq!((found[0].distance, found[0].curvature), (0.125, 1.0));
    }
}

#[test]
fn the_finder_does_not_allocate_once_it_has_room() {
    let series: Vec<f64> = (0..41).map(|n| 1.0 / f64::from(1 + n * n)).collect();
    let mut finder = CrossingFinder::new(20);
    let (mut found, mut misses) = (Vec::new(), Vec::new());
    let mut run = || {
        found.clear();
        misses.clear();
        finder.sample(&series);
        for level in [0.5, 1.0, 1.5] {
            finder.crossings(level, &mut found);
            finder.near_misses(level, 1.0, &mut misses);
        }
    };
    run();
    assert_eq!(count(run), 0);
    assert!(!found.is_empty() && !misses.is_empty());
}

#[test]
fn a_finder_may_serve_shorter_and_longer_series() {
    let mut finder = CrossingFinder::new(4);
    for length in [3, 41, 9, 3] {
        let series: Vec<f64> = (0..length).map(|n| 1.0 / f64::from(1 + n * n)).collect();
        let mut found = Vec::new();
        finder.sample(&series);
        finder.crossings(1.0, &mut found);
        let expected = all(&series, 1.0);
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(&expected) {
            assert!((a.tau - b.tau).abs() < 1e-14);
        }
    }
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

    #[test]
    fn many_harmonics_lose_no_change_of_sign(
        series in (50_usize..101).prop_flat_map(|k| prop::collection::vec(-1.0..1.0_f64, series::length(k))),
        level in -3.0..3.0_f64,
    ) {
        let found = all(&series, level);
        let mut above = series::value(&series, 0.0) > level;
        let mut next = 0;
        for n in 1..=5000 {
            let tau = TAU * f64::from(n) / 5000.0;
            let before = next;
            while next < found.len() && found[next].tau <= tau {
                next += 1;
            }
            above ^= (next - before) % 2 == 1;
            let x = series::value(&series, tau) - level;
            prop_assert!((x > 0.0) == above || x.abs() < 1e-11);
        }
    }

    #[test]
    fn all_extrema_within_reach_are_near_misses_or_lie_across(
        series in (1_usize..10).prop_flat_map(|k| prop::collection::vec(-1.0..1.0_f64, series::length(k))),
        level in -2.0..2.0_f64,
    ) {
        let mut slope = series.clone();
        series::differentiate(&series, &mut slope);
        let distance = 0.5;
        let found = misses(&series, level, distance);
        let expected: Vec<f64> = all(&slope, 0.0)
            .iter()
            .filter(|crossing| {
                let off = series::value(&series, crossing.tau) - level;
                off.abs() <= distance && (off > 0.0) == crossing.rising
            })
            .map(|crossing| crossing.tau)
            .collect();
        prop_assert_eq!(found.len(), expected.len());
        for (miss, tau) in found.iter().zip(expected) {
            let (x, _, curvature) = series::value_and_derivatives(&series, tau);
            // Where the curvature is small, the phase of an extremum is uncertain.
            prop_assert!((miss.tau - tau).abs() < 1e-11 / curvature.abs().min(1.0));
            prop_assert!((miss.distance - (x - level).abs()).abs() < 1e-13);
            // It is taken one Newton step earlier, and that step is at most sqrt(2 epsilon |x''| / M_3).
            let third: f64 = series[1..]
                .chunks_exact(2)
                .zip(1..)
                .map(|(pair, k)| pair[0].hypot(pair[1]) * f64::from(k).powi(3))
                .sum();
            let allowed = (2.0 * f64::EPSILON * curvature.abs() * third).sqrt() + 1e-12;
            prop_assert!((miss.curvature - curvature.abs()).abs() <= allowed);
        }
    }
}
