//! Against the zeros of `z^K (p(z) - level)` on the unit circle, `z = exp(i tau)`: the eigenvalues of a companion matrix
//! (Boyd (2006), Computing the zeros, maxima and inflection points of Chebyshev, Legendre and Fourier series: solving
//! transcendental equations by spectral interpolation and polynomial rootfinding, J. Eng. Math. 56, 203-219).
//!
//! A zero off the circle has a mirror image at the same angle. So a zero whose nearest neighbour is at a distance `d` is
//! on the circle if it is within `d / 8` of it, and off if it is farther than `d / 3`; nothing lies between. Two zeros
//! closer than 1e-4 are a pair whose place rounding blurs. Their middle is an extremum, and it decides: the pair is on
//! the circle if the extremum lies across the level, and *undecidable* if it is within 16 rounding errors of
//! `|level| + |mean| + sum of amplitudes` of it. A series with an undecidable pair is left out of the count.
//!
//! 20 000 series take some seconds; `HERTZIAN_SERIES=100000` runs as many.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, Schur};

use super::super::{Crossing, CrossingFinder};
use crate::numeric::fourier::series;
use crate::testing::random::Random;

/// Sum of sines and cosines, each by itself.
fn value(series: &[f64], tau: f64) -> f64 {
    let waves = series[1..].chunks_exact(2).enumerate();
    let waves = waves.map(|(index, pair)| {
        let (sine, cosine) = ((index + 1) as f64 * tau).sin_cos();
        pair[0] * cosine + pair[1] * sine
    });
    series[0] + waves.sum::<f64>()
}

fn size(series: &[f64]) -> f64 {
    let amplitudes = series[1..]
        .chunks_exact(2)
        .map(|pair| pair[0].hypot(pair[1]));
    series[0].abs() + amplitudes.sum::<f64>()
}

fn zeros(series: &[f64], level: f64) -> Vec<Complex<f64>> {
    let k = series::harmonics(series);
    let coefficient = |power: usize| {
        let harmonic = power.abs_diff(k);
        if harmonic == 0 {
            return Complex::new(series[0] - level, 0.0);
        }
        let (c, s) = (0.5 * series[2 * harmonic - 1], 0.5 * series[2 * harmonic]);
        Complex::new(c, if power > k { -s } else { s })
    };
    let leading = coefficient(2 * k);
    let companion = DMatrix::from_fn(2 * k, 2 * k, |row, column| {
        if row == 0 {
            -coefficient(2 * k - 1 - column) / leading
        } else {
            Complex::from(f64::from(u8::from(column + 1 == row)))
        }
    });
    let schur = Schur::try_new(companion, f64::EPSILON, 10_000).expect("it converges");
    let (_, triangle) = schur.unpack();
    triangle.diagonal().iter().copied().collect()
}

fn phase(z: Complex<f64>) -> f64 {
    z.arg().rem_euclid(TAU)
}

/// Phases of the crossings; nothing if a pair is undecidable.
fn expected(series: &[f64], level: f64) -> Option<Vec<f64>> {
    let zeros = zeros(series, level);
    let mut phases = Vec::new();
    for (index, &z) in zeros.iter().enumerate() {
        let off = (z.norm() - 1.0).abs();
        let others = zeros
            .iter()
            .enumerate()
            .filter(|&(other, _)| other != index);
        let (other, distance) = others
            .map(|(other, at)| (other, (at - z).norm()))
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        if off > 0.1 {
            continue;
        }
        if distance > 1e-4 {
            assert!(
                off < distance / 8.0 || off > distance / 3.0,
                "{z} {distance}"
            );
            if off < distance / 8.0 {
                phases.push(phase(z));
            }
            continue;
        }
        let middle = phase(z + zeros[other]);
        let (_, _, curvature) = series::value_and_derivatives(series, middle);
        let beyond = (value(series, middle) - level) * -curvature.signum();
        if beyond.abs() <= 16.0 * f64::EPSILON * (level.abs() + size(series)) {
            return None;
        }
        if beyond > 0.0 && index < other {
            let half = (2.0 * beyond / curvature.abs()).sqrt();
            phases.extend([middle - half, middle + half].map(|tau| tau.rem_euclid(TAU)));
        }
    }
    phases.sort_by(f64::total_cmp);
    Some(phases)
}

/// A series and a level; two of three times the level is close to an extremum.
fn draw(random: &mut Random) -> (Vec<f64>, f64) {
    let k = 1 + (12.0 * random.between(0.0, 1.0)) as usize;
    let decay = random.between(0.0, 2.0);
    let mut series = vec![random.between(-1.0, 1.0)];
    for harmonic in 1..=k {
        let size = (harmonic as f64).powf(-decay);
        series.extend([random.between(-size, size), random.between(-size, size)]);
    }
    if random.between(0.0, 1.0) < 1.0 / 3.0 {
        let level = value(&series, random.between(0.0, TAU));
        return (series, level);
    }
    let mut slope = series.clone();
    series::differentiate(&series, &mut slope);
    let phase = |n: usize| TAU * n as f64 / (16 * k) as f64;
    let start = (random.between(0.0, 1.0) * (16 * k) as f64) as usize;
    let rises = |n: usize| value(&slope, phase(n)) > 0.0;
    let turn = (start..start + 16 * k).find(|&n| rises(n) != rises(n + 1));
    let turn = turn.expect("a slope has no mean");
    let extremum = super::super::extremum(&series, phase(turn), phase(turn + 1));
    let epsilon = 10.0_f64.powf(random.between(-14.0, -2.0));
    let side = if random.between(0.0, 1.0) < 0.5 {
        epsilon
    } else {
        -epsilon
    };
    let level = value(&series, extremum) + side;
    (series, level)
}

fn distance(a: f64, b: f64) -> f64 {
    let off = (a - b).abs();
    off.min(TAU - off)
}

fn check(series: &[f64], level: f64, phases: &[f64], found: &[Crossing]) {
    let told =
        || format!("series {series:?}, level {level:e}, expected {phases:?}, found {found:?}");
    assert_eq!(found.len(), phases.len(), "{}", told());
    let rounding = f64::EPSILON * (level.abs() + size(series));
    for (index, crossing) in found.iter().enumerate() {
        assert!(
            index == 0 || found[index - 1].tau <= crossing.tau,
            "{}",
            told()
        );
        assert!(
            index == 0 || found[index - 1].rising != crossing.rising,
            "{}",
            told()
        );
        let (_, slope, curvature) = series::value_and_derivatives(series, crossing.tau);
        // The phase itself is rounded; what remains is a few rounding errors of a sum.
        let residual = value(series, crossing.tau) - level;
        let by_phase = 2.0 * f64::EPSILON * crossing.tau * slope.abs();
        assert!(
            residual.abs() <= 8.0 * rounding + by_phase,
            "{residual:e} {}",
            told()
        );
        assert!(
            slope == 0.0 || (slope > 0.0) == crossing.rising,
            "{}",
            told()
        );
        // A simple zero moves by the error over the slope, a double one by the root of it over the curvature.
        let nearest = phases.iter().map(|&phase| distance(phase, crossing.tau));
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        let error = 1e4 * rounding;
        let allowed = (error / slope.abs()).min((error / curvature.abs()).sqrt()) + 1e-10;
        assert!(nearest <= allowed, "{nearest:e} > {allowed:e} {}", told());
    }
}

#[test]
fn crossings_are_the_zeros_on_the_unit_circle() {
    let count = std::env::var("HERTZIAN_SERIES")
        .ok()
        .and_then(|text| text.parse().ok());
    let count: usize = count.unwrap_or(20_000);
    let mut random = Random::seeded(20_240_229);
    let mut finder = CrossingFinder::new(12);
    let mut found = Vec::new();
    let (mut undecidable, mut pairs) = (0, 0);
    for _ in 0..count {
        let (series, level) = draw(&mut random);
        let Some(phases) = expected(&series, level) else {
            undecidable += 1;
            continue;
        };
        found.clear();
        finder.sample(&series);
        finder.crossings(level, &mut found);
        check(&series, level, &phases, &found);
        pairs += found
            .windows(2)
            .filter(|pair| pair[1].tau - pair[0].tau < 1e-4)
            .count();
    }
    println!("{count} series, {undecidable} undecidable, {pairs} pairs closer than 1e-4");
    assert!(undecidable * 10 < count && pairs * 20 > count);
}
