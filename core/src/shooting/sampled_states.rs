//! States of an orbit that is known by its Fourier series: shooting goes on from what the balance has found.

use super::equations::Span;
use super::problem::ShootingProblem;
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::numeric::fourier::series;
use crate::system::Variable;

/// An event with the states of its orbit at the beginnings of the segments, and the tangent of the branch there; as it is, if it has them.
pub(crate) fn with_states(problem: &ShootingProblem, event: &Event) -> Event {
    let orbit = &event.point.orbit;
    if !orbit.has_series() || !orbit.states.is_empty() {
        return event.clone();
    }
    let span = Span::of(orbit.recurrence(), orbit.period);
    let times =
        || (0..span.segments).map(|s| span.begins(s) * f64::from(problem.divisor) / orbit.omega);
    let states = times().flat_map(|time| state(orbit, &orbit.series, [orbit.base, 0.0], time));
    let mut tangent = Vec::new();
    if let Some((slope, of_series)) = event.tangent.split_last() {
        // A velocity is the base frequency times the slope of the series, and both change along the branch.
        let moves = problem.variable == Variable::Omega;
        let of_base = if moves {
            slope * orbit.base / orbit.omega
        } else {
            0.0
        };
        tangent
            .extend(times().flat_map(|time| state(orbit, of_series, [orbit.base, of_base], time)));
        tangent.push(*slope);
    }
    Event {
        point: Point {
            orbit: Orbit {
                states: states.collect(),
                ..orbit.clone()
            },
            ..event.point.clone()
        },
        tangent,
        ..event.clone()
    }
}

/// Positions and velocities of series at a time; velocities are the base times the slope, and the change of the base times that of the orbit.
fn state(orbit: &Orbit, of: &[f64], [base, of_base]: [f64; 2], time: f64) -> Vec<f64> {
    let length = of.len() / orbit.coordinates.max(1);
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for (row, own) in of
        .chunks_exact(length)
        .zip(orbit.series.chunks_exact(length))
    {
        let phase = orbit.base * time;
        let (x, slope, _) = series::value_and_derivatives(row, phase);
        let (_, own, _) = series::value_and_derivatives(own, phase);
        positions.push(x);
        velocities.push(base * slope + of_base * own);
    }
    [positions, velocities].concat()
}
