//! The lever far from the sample, and what rings when it taps: its modes answer to the harmonics of the force.

use super::{agree, size};
use crate::microscope::{QUALITY, RATIOS, SHAKEN, lever};
use hertzian::{FrequencyResponse, Shooting};

/// What modes with these shares answer at the tip to a force of one.
fn answer(shares: [f64; 3], frequency: f64) -> [f64; 2] {
    let modes = RATIOS.into_iter().zip(shares).map(|(ratio, share)| {
        let [stiff, lossy] = [
            ratio * ratio - frequency * frequency,
            ratio * frequency / QUALITY,
        ];
        let square = stiff * stiff + lossy * lossy;
        [share * stiff / square, share * lossy / square]
    });
    modes.fold([0.0, 0.0], |[a, b], [c, d]| [a + c, b + d])
}

/// Ratios and shares are those of a uniform beam: roots `b` of `cos b cosh b = -1`, and `4/b (sinh b - sin b)/(cosh b + cos b)`, signs in turn.
#[test]
fn modes_are_those_of_a_uniform_cantilever() {
    let starts = [1.875, 4.694, 7.855];
    let roots = starts.map(|start: f64| {
        (0..20).fold(start, |b, _| {
            let value = b.cos() * b.cosh() + 1.0;
            b - value / (b.cos() * b.sinh() - b.sin() * b.cosh())
        })
    });
    for (mode, b) in roots.into_iter().enumerate() {
        agree(RATIOS[mode], (b / roots[0]).powi(2), 1e-6);
        let shaken = 4.0 / b * (b.sinh() - b.sin()) / (b.cosh() + b.cos());
        agree(SHAKEN[mode].abs(), shaken, 1e-6);
        assert_eq!(SHAKEN[mode] > 0.0, mode % 2 == 0);
    }
}

#[test]
fn far_from_the_sample_it_is_linear() {
    let mut lever = lever(3).unwrap();
    lever.set("distance", 1e4).unwrap();
    let request = FrequencyResponse::of(&lever).by(Shooting::new());
    for omega in [0.998_f64, 1.0, 1.004] {
        let orbit = request.clone().orbit(omega).unwrap();
        let measured = request.measured(&"tip:h1".parse().unwrap(), &orbit);
        let shaken = SHAKEN.map(|share| 0.016 * omega * omega * share);
        agree(
            measured.unwrap().unwrap(),
            size(answer(shaken, omega)),
            1e-6,
        );
    }
}

/// Harmonics of the tip are what the modes make of those of the force of the sample: the sixth is near the second mode.
#[test]
fn modes_answer_to_the_force_of_the_sample() {
    let lever = lever(3).unwrap();
    let request = FrequencyResponse::of(&lever).by(Shooting::new());
    let branch = request.from(1.006).to(0.994).run().unwrap();
    let points = branch.at(1.0).unwrap();
    assert_eq!(points.len(), 3);
    for point in &points {
        let force = branch.reading("Sample", point).unwrap();
        let tip = branch.reading("tip", point).unwrap();
        for harmonic in [2, 6, 9] {
            let [force, tip] = [&force, &tip].map(|read| read.spectrum()[harmonic].amplitude);
            let linear = force * size(answer([1.0; 3], harmonic as f64));
            agree(tip, linear, 1e-3);
        }
    }
}
