//! The rotor: what its bearings carry, and how it vibrates by little.

use super::{agree, response, size};
use crate::rotor::{BENDS, DAMPING, MASSES, balls, rotor};
use hertzian::structure::DMatrix;
use hertzian::{FrequencyResponse, HarmonicBalance};

/// In the mean over a period the bearings carry the weight, three fifths and two fifths of it, and nothing across, however balls bounce.
#[test]
fn bearings_carry_the_weight() {
    let request = FrequencyResponse::of(&rotor(0.05).unwrap()).by(HarmonicBalance::new());
    let orbit = request
        .accuracy_of("down")
        .tolerance(1e-4)
        .orbit(0.95)
        .unwrap();
    let impulses: Vec<f64> = orbit
        .observed
        .contacts
        .iter()
        .map(|c| c.impulse.unwrap())
        .collect();
    assert!(
        orbit
            .observed
            .contacts
            .iter()
            .filter(|c| c.fraction > 0.0)
            .count()
            > 6
    );
    let period = std::f64::consts::TAU / 0.95;
    for (bearing, weight) in [(1, 0.6), (2, 0.4)] {
        let of_balls = || balls(bearing).zip(&impulses[8 * (bearing - 1)..]);
        let carried: f64 = of_balls()
            .map(|(along, impulse)| along[bearing] * impulse)
            .sum();
        let across: f64 = of_balls()
            .map(|(along, impulse)| along[bearing + 3] * impulse)
            .sum();
        agree(carried / period, weight, 1e-6);
        assert!((across / period).abs() < 1e-6, "{across}");
    }
}

/// How far a bearing gives way to a load, by halving, and its stiffness there, downwards and across.
fn bearing(load: f64) -> [f64; 2] {
    let gap = |y: f64, along: &[f64]| (y * along[1] - 0.1).max(0.0);
    let force = |y: f64| -> f64 {
        balls(1)
            .map(|along| along[1] * 10.0 * gap(y, &along).powf(1.5))
            .sum()
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if force(middle) < load {
            low = middle;
        } else {
            high = middle;
        }
    }
    [1, 4].map(|entry| {
        let terms = balls(1).map(|along| along[entry].powi(2) * 15.0 * gap(low, &along).sqrt());
        terms.sum()
    })
}

/// With little unbalance it vibrates about the place where it rests, with the stiffness that bearings have there.
#[test]
fn a_little_unbalance_makes_a_linear_vibration() {
    let unbalance = 1e-6;
    let [left, right] = [0.6, 0.4].map(bearing);
    let diagonal = |of: [f64; 3]| DMatrix::from_fn(3, 3, |i, j| if i == j { of[i] } else { 0.0 });
    let request = FrequencyResponse::of(&rotor(unbalance).unwrap()).by(HarmonicBalance::new());
    for omega in [0.5, 0.9, 1.2] {
        let orbit = request.clone().orbit(omega).unwrap();
        for (plane, name) in ["down:h1", "across:h1"].into_iter().enumerate() {
            let bends = DMatrix::from_fn(3, 3, |i, j| BENDS[i] * BENDS[j]);
            let stiffness = bends + diagonal([0.0, left[plane], right[plane]]);
            let matrices = [&diagonal(MASSES), &diagonal(DAMPING), &stiffness];
            let linear = response(matrices, &[unbalance * omega * omega, 0.0, 0.0], omega);
            let measured = request.measured(&name.parse().unwrap(), &orbit).unwrap();
            agree(measured.unwrap(), size(linear[0]), 1e-4);
        }
    }
}
