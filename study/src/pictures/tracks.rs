//! Curves of folds and of period doublings over a map.
//!
//! They begin at the bifurcations that are found along the branches at a few values of the second parameter, and are followed by shooting.
//! Curves that none of these branches meets are not found.

use hertzian::bifurcation::{Bifurcations, Map};
use hertzian::chart::{Chart, Series};
use hertzian::shooting::BifurcationCurve;
use hertzian::{Cancel, EventKind, FrequencyResponse, Shooting};

use crate::study::Prepared;

/// Values of the second parameter at which branches are followed, as parts of its range.
const AT: [f64; 4] = [1.0, 0.7, 0.4, 0.1];
/// Bifurcations between a branch and the first one.
const DEPTH: usize = 1;
/// Curves, at most.
const MOST: usize = 40;
/// A bifurcation is on a curve that is known if it is as near as this part of the range.
const NEAR: f64 = 2e-3;

/// The chart with the curves over it.
pub(super) fn over(mut chart: Chart, map: &Map, study: &Prepared, cancel: &Cancel) -> Chart {
    let curves = curves(map, study, cancel);
    for (kind, label) in [
        (EventKind::Fold, "folds"),
        (EventKind::PeriodDoubling, "period doublings"),
    ] {
        let of_kind = curves.iter().filter(|curve| curve.kind.is_like(kind));
        // What is not a number ends one curve and begins the next.
        let points = of_kind.flat_map(|curve| {
            let places = curve.points.iter().map(|point| point.values);
            places.chain([[f64::NAN; 2]])
        });
        let points: Vec<[f64; 2]> = points.collect();
        if !points.is_empty() {
            let label = label.to_owned();
            chart = chart.trace(Series { label, points });
        }
    }
    chart
}

/// The curves that are met.
fn curves(map: &Map, study: &Prepared, cancel: &Cancel) -> Vec<BifurcationCurve> {
    let asked = &study.plan.request;
    let [low, high] = ends(&map.values[1]);
    let mut curves: Vec<BifurcationCurve> = Vec::new();
    for part in AT {
        if cancel.is_cancelled() {
            break;
        }
        let value = low + part * (high - low);
        let (system, omega) = study.at_second(value);
        let mut request = FrequencyResponse::of(&system)
            .by(Shooting::new())
            .from(asked.from)
            .to(asked.to)
            .cancel(cancel);
        if asked.vary != "omega" {
            request = request.vary(&asked.vary).omega(omega.unwrap_or(f64::NAN));
        }
        let request = Bifurcations::starting_with(request)
            .depth(DEPTH)
            .margin(0.0);
        // Where nothing is found at one value there may be at another.
        let Ok(diagram) = request.run() else {
            continue;
        };
        for kind in [EventKind::Fold, EventKind::PeriodDoubling] {
            for (number, event) in diagram.events(kind) {
                let place = [event.point.value, value];
                let range = [asked.to - asked.from, high - low];
                let known = curves.iter().any(|curve| passes(curve, kind, place, range));
                if known || curves.len() >= MOST {
                    continue;
                }
                let branch = &diagram.branches[number].branch;
                let tracked = branch.track_with(event, &map.names[1], [low, high], |_| {
                    if cancel.is_cancelled() {
                        std::ops::ControlFlow::Break(())
                    } else {
                        std::ops::ControlFlow::Continue(())
                    }
                });
                curves.extend(tracked);
            }
        }
    }
    curves
}

fn ends(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(*value), high.max(*value)]
        })
}

/// Whether a curve passes a place.
fn passes(curve: &BifurcationCurve, kind: EventKind, place: [f64; 2], range: [f64; 2]) -> bool {
    let scaled = |values: [f64; 2]| {
        [0, 1].map(|axis| (values[axis] - place[axis]) / range[axis].abs().max(f64::MIN_POSITIVE))
    };
    let near = |a: [f64; 2], b: [f64; 2]| {
        // The point of a segment that is nearest to the origin.
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let part = -(a[0] * along[0] + a[1] * along[1]) / square;
        let part = if part.is_finite() {
            part.clamp(0.0, 1.0)
        } else {
            0.0
        };
        (a[0] + part * along[0]).hypot(a[1] + part * along[1]) < NEAR
    };
    let points = curve.points.windows(2);
    let mut points = points.map(|pair| [scaled(pair[0].values), scaled(pair[1].values)]);
    curve.kind.is_like(kind) && points.any(|[a, b]| near(a, b))
}
