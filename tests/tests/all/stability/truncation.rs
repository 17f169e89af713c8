//! What the harmonics left out do to multipliers, at orbits where their change by the correction vanishes.
//!
//! With one coordinate the product of both multipliers is known, so that a small change is one number, that of the trace. Between
//! two points of a branch where it has opposite signs it passes zero, and says nothing there of what the correction leaves out in
//! turn. The estimate must not vanish with it.

use std::ops::ControlFlow;

use hertzian::stability::{Answer, Method};
use hertzian::{Branch, FrequencyResponse, Point, Shooting, System};

use crate::stability::truth::distance;

hertzian::oscillator! {
    Hertz(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

/// Halvings of the interval in which the change passes zero.
const HALVINGS: usize = 16;
/// Changes below this are those of the method, not of the orbit.
const LEAST: f64 = 1e-7;
/// Neighbours of an orbit have estimates that differ by less than this factor; more is a touch.
const ALIKE: f64 = 10.0;

/// How much the correction changes the trace.
fn change(answer: &Answer) -> f64 {
    let given = &answer.stability.multipliers;
    let sums = given.iter().zip(&answer.uncorrected).map(|(a, b)| a - b);
    sums.sum::<hertzian::Complex<f64>>().re
}

/// The orbit at a frequency, as a branch of one point.
fn at(system: &dyn System, near: &Point, omega: f64) -> Branch {
    let request = FrequencyResponse::of(system).from(omega).to(1.01 * omega);
    let request = request.near_orbit(&near.orbit).stability(false);
    let request = request.harmonics(near.orbit.harmonics());
    request.run_with(|_| ControlFlow::Break(())).unwrap()
}

/// At every zero of the change along a branch: change, estimate, and true error.
fn zeros(system: &dyn System, harmonics: usize) -> Vec<[f64; 3]> {
    let request = FrequencyResponse::of(system).from(0.6).to(1.2);
    let branch = request.harmonics(harmonics).stability(false).run().unwrap();
    let of = |branch: &Branch, index: usize| {
        branch
            .multipliers(&branch.points[index], Method::Monodromy)
            .unwrap()
    };
    let answers: Vec<_> = (0..branch.points.len()).map(|i| of(&branch, i)).collect();
    let mut found = Vec::new();
    for (index, pair) in answers.windows(2).enumerate() {
        let [before, behind] = [&pair[0], &pair[1]];
        let estimates = [before.stability.error, behind.stability.error];
        let known = change(before).abs().min(change(behind).abs()) > LEAST;
        let alike = estimates[0].max(estimates[1]) < ALIKE * estimates[0].min(estimates[1]);
        if !(known && alike && change(before) * change(behind) < 0.0) {
            continue;
        }
        let near = &branch.points[index];
        let (mut low, mut high) = (near.value, branch.points[index + 1].value);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if change(&of(&at(system, near, middle), 0)) * change(before) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let there = at(system, near, low);
        let answer = of(&there, 0);
        // Where the corrected orbit is, for beside a fold that matters.
        let shooting = FrequencyResponse::of(system)
            .by(Shooting::new())
            .near_orbit(&there.points[0].orbit);
        let exact = shooting.tolerance(1e-11).orbit(answer.value).unwrap();
        let given = &answer.stability.multipliers;
        let error = distance(given, &exact.stability.multipliers);
        println!(
            "omega {low:.6}: change {:.1e}, estimate {:.1e}, of neighbours {:.1e} and {:.1e}, error {error:.1e}",
            change(&answer),
            answer.stability.error,
            estimates[0],
            estimates[1],
        );
        found.push([change(&answer).abs(), answer.stability.error, error]);
    }
    found
}

#[test]
fn the_estimate_does_not_vanish_where_the_change_of_the_trace_does() {
    let model = Hertz { drive: 1.0 };
    let found: Vec<_> = [6, 12, 24]
        .into_iter()
        .flat_map(|harmonics| zeros(&model, harmonics))
        .collect();
    assert!(
        found
            .iter()
            .any(|[change, _, error]| *error > 10.0 * change)
    );
    for [_, estimate, error] in found {
        assert!(error < estimate, "{error:e} {estimate:e}");
    }
}
