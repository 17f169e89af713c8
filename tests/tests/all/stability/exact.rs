//! Multipliers of the one-sided oscillator with exponent one, load 1, damping ratio 0.032 and frequency 1, against exact ones.
//!
//! Exact values: from the closed-form flow between switches in 80-bit arithmetic, independent of this project
//! (`periodic_solutions` of the reference values).

use std::ops::ControlFlow;

use hertzian::stability::Method;
use hertzian::{Complex, FrequencyResponse, Shooting};

use crate::stability::truth::distance;

hertzian::oscillator! {
    OneSided(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

/// Orbits at drive 1 by period: a state at phase zero to three digits, and the multiplier with positive imaginary part.
const EXACT: [([f64; 2], [f64; 2]); 3] = [
    (
        [-2.0, 0.178],
        [-0.655_596_449_627_929_2, 0.615_582_920_279_132_8],
    ),
    (
        [-5.632, 3.527],
        [-0.524_746_191_089_171_2, 0.733_336_154_170_019_1],
    ),
    (
        [-31.334, 0.605],
        [-0.380_774_924_593_537_2, 0.817_888_662_584_343_5],
    ),
];

fn pair([re, im]: [f64; 2]) -> [Complex<f64>; 2] {
    [Complex::new(re, im), Complex::new(re, -im)]
}

/// The monodromy along an orbit in closed form.
#[test]
fn orbits_by_shooting_have_the_exact_multipliers() {
    let model = OneSided { drive: 1.0 };
    for (index, (state, multiplier)) in EXACT.into_iter().enumerate() {
        let shooting = FrequencyResponse::of(&model)
            .by(Shooting::new())
            .vary("drive")
            .omega(1.0);
        let cycle = shooting
            .period(index + 1)
            .near_state(&state)
            .orbit(1.0)
            .unwrap();
        let error = distance(&cycle.stability.multipliers, &pair(multiplier));
        println!("period {}: {error:.1e}", index + 1);
        assert!(error < 1e-9, "{error:e}");
    }
}

/// What an independent implementation of exact switching and saltation left with 5, 10, 20, 40 and 80 harmonics per period of the
/// excitation, to one digit (`method_errors` of the reference values): drive, period, errors.
const ELSEWHERE: [(f64, usize, [f64; 5]); 3] = [
    (0.5, 1, [1e-3, 2e-4, 3e-5, 4e-6, 5e-7]),
    (1.0, 1, [3e-3, 4e-4, 5e-5, 6e-6, 9e-7]),
    (1.0, 2, [9e-3, 9e-4, 1e-4, 2e-5, 2e-6]),
];

/// The method by itself does as well; the multipliers that are given, those of the corrected orbit, are better and within their
/// estimate.
#[test]
fn orbits_of_few_harmonics_have_multipliers_as_good_as_they_can_be() {
    for (drive, period, elsewhere) in ELSEWHERE {
        let model = OneSided { drive };
        let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
        let request = request.period(period).from(drive).to(1.01 * drive);
        for (harmonics, expected) in [5, 10, 20, 40, 80].into_iter().zip(elsewhere) {
            let request = request.clone().harmonics(harmonics).stability(false);
            let branch = request.run_with(|_| ControlFlow::Break(())).unwrap();
            let point = &branch.points[0];
            let shooting = FrequencyResponse::of(&model)
                .by(Shooting::new())
                .near_orbit(&point.orbit);
            let exact = shooting.orbit(1.0).unwrap().stability.multipliers;
            if (drive, period) == (1.0, 1) {
                assert!(distance(&exact, &pair(EXACT[0].1)) < 1e-9);
            }
            let answer = branch.multipliers(point, Method::Monodromy).unwrap();
            let plain = distance(&answer.uncorrected, &exact);
            let given = distance(&answer.stability.multipliers, &exact);
            let estimate = answer.stability.error;
            println!(
                "drive {drive}, period {period}, {harmonics} harmonics: {plain:.1e}, elsewhere {expected:.0e}, \
                 corrected {given:.1e}, estimate {estimate:.1e}"
            );
            // Half a unit of the one digit.
            let unit = 10_f64.powf(expected.log10().floor());
            assert!(plain < expected + 0.5 * unit, "{plain:e} {expected:e}");
            assert!(given < expected && given < estimate, "{given:e}");
        }
    }
}
