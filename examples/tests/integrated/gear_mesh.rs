//! Of the gears the deformation of the mesh alone, `r = pinion - wheel`: the difference of their equations.

use super::{Equations, agree, extremes_and_rms, period};
use crate::gear_mesh::GearMesh;
use hertzian::{Branch, EventKind, FrequencyResponse, HarmonicBalance, Point, Verdict};

const PLAY: f64 = 5e-5;

/// Slope of `(r, dr/dt)`.
fn slope(omega: f64) -> impl Fn(f64, &[f64], &[bool]) -> Vec<f64> {
    move |time, state, sides| {
        let [r, v] = [state[0], state[1]];
        let pressed = match sides {
            [true, _] => r - PLAY,
            [_, true] => r + PLAY,
            _ => 0.0,
        };
        let force = 2e8 * (1.0 + 0.2 * (omega * time).cos()) * pressed + 1000.0 * v;
        vec![v, (2000.0 - force) * 1.5]
    }
}

fn levels(state: &[f64]) -> Vec<f64> {
    vec![state[0] - PLAY, -state[0] - PLAY]
}

fn start(point: &Point) -> Vec<f64> {
    let state = point.orbit.state();
    vec![state[0] - state[1], state[2] - state[3]]
}

fn response(from: f64, to: f64) -> Branch {
    let model = GearMesh::default();
    let request = FrequencyResponse::of(&model).from(from).to(to);
    let request = request.by(HarmonicBalance::new().doublings(true));
    request.run().expect("a branch")
}

/// What settles from a stable orbit has its extremes and its root of the mean square; what begins beside an unstable one leaves it.
fn is_as_said(branch: &Branch, point: &Point) {
    let slope = slope(point.omega());
    let equations = Equations {
        slope: &slope,
        levels: &levels,
    };
    let (begin, period) = (start(point), period(&point.orbit));
    if point.stability.verdict == Verdict::Stable {
        let settled = equations.after(&begin, period, 60);
        let [low, high, rms] = extremes_and_rms(&equations.states(&settled, period, 2000), 0);
        for (name, integrated) in [
            ("relative:min", low),
            ("relative:max", high),
            ("relative:rms", rms),
        ] {
            let wanted = name.parse().expect("a measure");
            let measured = branch.measured(&wanted, point).expect("an output");
            agree(measured.expect("a number"), 1e6 * integrated, 1e-5);
        }
    } else {
        let beside = [begin[0] + 1e-9, begin[1]];
        let [left, kept] = [&beside[..], &begin].map(|begin| equations.after(begin, period, 20)[0]);
        let away = (left - kept).abs();
        assert!(away > 5e-8, "{away} at {}", point.value);
    }
}

#[test]
fn all_orbits_of_the_bent_resonance_are() {
    let branch = response(1.2e4, 1.7e4);
    let points = branch.at(1.4e4).expect("orbits");
    assert_eq!(points.len(), 3);
    for point in &points {
        is_as_said(&branch, point);
    }
}

#[test]
fn periods_double_where_a_multiplier_is_minus_one() {
    let branch = response(3.2e4, 3.8e4);
    let doublings: Vec<_> = branch.events(EventKind::PeriodDoubling).collect();
    assert_eq!(doublings.len(), 2);
    for event in &doublings {
        let slope = slope(event.point.omega());
        let equations = Equations {
            slope: &slope,
            levels: &levels,
        };
        let sizes = [1e-9, 1e-9 * event.point.omega()];
        let [[a, b], [c, d]] =
            equations.derivative(&start(&event.point), period(&event.point.orbit), sizes);
        let determinant = (a + 1.0) * (d + 1.0) - b * c;
        assert!(determinant.abs() < 1e-5, "{determinant}");
    }
}
