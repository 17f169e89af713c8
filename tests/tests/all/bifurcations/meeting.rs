//! Two pairs of multipliers that meet and part across the unit circle within a step.

use hertzian::{Branch, EventKind, FrequencyResponse, Shooting};

hertzian::oscillator! {
    /// A driven oscillator, beside two whose coupling varies: their rest loses stability where its frequency is near the sum of theirs.
    Combination(x, y, z) {
        param strength;
        param c;
        ddot(x) + 0.1*dot(x) + 9*x = 0.1*cos(omega*t);
        ddot(y) + c*dot(y) + y + strength*cos(omega*t)*z = 0;
        ddot(z) + c*dot(z) + 1.96*z + strength*cos(omega*t)*y = 0;
    }
}

/// Values and errors.
fn tori(branch: &Branch) -> Vec<[f64; 2]> {
    let mut values: Vec<_> = branch
        .events(EventKind::NeimarkSacker)
        .map(|event| [event.point.value, event.error])
        .collect();
    values.sort_by(|a, b| a[0].total_cmp(&b[0]));
    values
}

/// To first order the ends are `a + b +- (p^2 / (4 a b) - c^2)^(1/2)`, with `a = 1`, `b = 1.4`, `p = 0.01` and `c = 0.002`. Source: Nayfeh and
/// Mook (1979), Nonlinear Oscillations, section 5.4 (combination resonances of the additive type).
#[test]
fn a_combination_resonance_within_a_step() {
    let (strength, c) = (0.01_f64, 0.002_f64);
    let model = Combination { strength, c };
    let half = (strength * strength / (4.0 * 1.4) - c * c).sqrt();
    for [from, to] in [[1.6, 3.2], [3.2, 1.6]] {
        let response = FrequencyResponse::of(&model).from(from).to(to);
        let shooting = response.clone().by(Shooting::new());
        let long = tori(&shooting.run().unwrap());
        let short = tori(&shooting.largest_step(1e-3).run().unwrap());
        let balance = tori(&response.bifurcations(true).run().unwrap());
        assert_eq!([long.len(), short.len(), balance.len()], [2; 3]);
        for (place, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let [value, error] = short[place];
            for [other, unsure] in [long[place], balance[place]] {
                let apart = (other - value).abs();
                assert!(
                    apart <= error + unsure,
                    "{other} +- {unsure:.0e}, {value} +- {error:.0e}"
                );
                assert!(apart < 1e-6, "{other} {value}");
            }
            assert!(
                (value - 2.4 - sign * half).abs() < strength * strength,
                "{value}"
            );
        }
    }
}
