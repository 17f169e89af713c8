//! Curves of folds and of period doublings over a map.
//!
//! They begin at the bifurcations that are found along branches at a few values of either parameter, as the other one varies, and are followed by
//! shooting. Branches are looked for as those of the cells are: along the range, where they begin on others, and by what motions settle to.
//! Curves that none of these branches meets are not found.

use std::ops::ControlFlow;

use hertzian::bifurcation::Map;
use hertzian::chart::{Chart, Series};
use hertzian::{Cancel, Error, EventKind, FrequencyResponse, Shooting, System};

use crate::study::Prepared;

/// Values of a parameter at which branches are followed along the other one, as parts of its range.
const AT: [f64; 4] = [1.0, 0.7, 0.4, 0.1];
/// Parts of a branch's range, at whose borders motions are followed until they have settled.
const PARTS: usize = 8;
/// Branches and curves go beyond the ends of their range by this part of it: a curve has its last point inside of it, and the frame of the map
/// would be half a step away.
const BEYOND: f64 = 0.1;
/// Curves, at most.
const MOST: usize = 40;
/// A bifurcation is on a curve that is known if it is as near as this part of the range.
const NEAR: f64 = 2e-3;
/// What is followed, with its name in the legend.
const KINDS: [(EventKind, &str); 2] = [
    (EventKind::Fold, "folds"),
    (EventKind::PeriodDoubling, "period doublings"),
];

/// A curve in the plane of the map.
struct Track {
    kind: EventKind,
    points: Vec<[f64; 2]>,
}

/// The chart with the curves over it.
pub(super) fn over(mut chart: Chart, map: &Map, study: &Prepared, cancel: &Cancel) -> Chart {
    let plane = Plane {
        study,
        names: &map.names,
        ranges: [0, 1].map(|axis| ends(&map.values[axis])),
        cancel,
    };
    let tracks = plane.tracks();
    for (kind, label) in KINDS {
        let of_kind = tracks.iter().filter(|track| track.kind.is_like(kind));
        // What is not a number ends one curve and begins the next.
        let points = of_kind.flat_map(|track| track.points.iter().copied().chain([[f64::NAN; 2]]));
        let points: Vec<[f64; 2]> = points.collect();
        if !points.is_empty() {
            chart = chart.trace(Series::new(label, points));
        }
    }
    chart
}

/// Both parameters of a map.
struct Plane<'m> {
    study: &'m Prepared,
    names: &'m [String; 2],
    ranges: [[f64; 2]; 2],
    cancel: &'m Cancel,
}

impl Plane<'_> {
    /// The curves that are met along rows, then along columns.
    fn tracks(&self) -> Vec<Track> {
        let mut tracks = Vec::new();
        for axis in [0, 1] {
            let [low, high] = self.ranges[1 - axis];
            for part in AT {
                if self.cancel.is_cancelled() {
                    return tracks;
                }
                // Where nothing is found at one value there may be at another.
                let _ = self.along(axis, (1.0 - part) * low + part * high, &mut tracks);
            }
        }
        tracks
    }

    /// Adds those that are met as one parameter varies at a value of the other.
    ///
    /// # Errors
    /// If there is no branch.
    fn along(&self, axis: usize, value: f64, tracks: &mut Vec<Track>) -> Result<(), Error> {
        let [low, high] = self.ranges[axis];
        let mut at = [low; 2];
        at[1 - axis] = value;
        let (system, omega) = self.study.at_both(at);
        let [from, to] = self.widened(axis);
        let mut request = FrequencyResponse::of(&system)
            .by(Shooting::new())
            .from(from)
            .to(to)
            .cancel(self.cancel);
        if self.names[axis] != "omega" {
            request = request.vary(&self.names[axis]).omega(omega);
        }
        let part = |part: usize| low + part as f64 / PARTS as f64 * (high - low);
        let values: Vec<f64> = (0..=PARTS).map(part).collect();
        let diagram = request.solutions(&values)?.diagram;
        for (kind, _) in KINDS {
            for (number, event) in diagram.events(kind) {
                let mut place = [value; 2];
                place[axis] = event.point.value;
                let known = tracks.iter().any(|track| self.passes(track, kind, place));
                if known || tracks.len() >= MOST {
                    continue;
                }
                let branch = &diagram.branches[number].branch;
                let (other, range) = (&self.names[1 - axis], self.widened(1 - axis));
                let curve = branch.track_with(event, other, range, |_| self.going());
                tracks.extend(curve.ok().map(|curve| {
                    Track {
                        kind,
                        points: (curve.values.iter())
                            .map(|values| [values[axis], values[1 - axis]])
                            .collect(),
                    }
                }));
            }
        }
        Ok(())
    }

    fn going(&self) -> ControlFlow<()> {
        if self.cancel.is_cancelled() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// The range of a parameter and what is beyond its ends, as far as it may have such values.
    fn widened(&self, axis: usize) -> [f64; 2] {
        let ends = self.ranges[axis];
        let beyond = BEYOND * (ends[1] - ends[0]);
        let mut parameters = self.study.system.facts().parameters.iter();
        let facts = parameters.find(|facts| facts.name == self.names[axis]);
        let admits = |value: f64| facts.map_or(value > 0.0, |facts| facts.admits(value));
        [[ends[0], -beyond], [ends[1], beyond]].map(|[end, beyond]| {
            Some(end + beyond)
                .filter(|&value| admits(value))
                .unwrap_or(end)
        })
    }

    /// Whether a curve passes a place.
    fn passes(&self, track: &Track, kind: EventKind, place: [f64; 2]) -> bool {
        let scaled =
            |values: [f64; 2]| [0, 1].map(|axis| (values[axis] - place[axis]) / self.length(axis));
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
        let points = track.points.windows(2);
        let mut points = points.map(|pair| [scaled(pair[0]), scaled(pair[1])]);
        track.kind.is_like(kind) && points.any(|[a, b]| near(a, b))
    }

    fn length(&self, axis: usize) -> f64 {
        let [low, high] = self.ranges[axis];
        (high - low).max(f64::MIN_POSITIVE)
    }
}

fn ends(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(*value), high.max(*value)]
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Spread, Study, Variants};
    use hertzian::HarmonicBalance;

    hertzian::oscillator! {
        /// One-sided contact with a linear spring, under a load.
        OneSided(x) {
            param drive = 0.3;
            law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + 1;
        }
    }

    /// Orbits of period two begin at a fold that no branch of period one leads to. Its curve goes beyond both borders of the map, and is where the
    /// balance has the fold.
    #[test]
    fn folds_of_branches_that_stand_alone_are_followed_over_the_whole_map() {
        let drives = [0.28, 0.32];
        let study = Study::of(&OneSided::default())
            .variants(Variants::grid().over("drive", Spread::list(&drives)))
            .request(Request::solutions(0.9, 1.1, &[0.9, 1.1]))
            .prepare()
            .expect("a study");
        let plane = Plane {
            study: &study,
            names: &["omega".to_owned(), "drive".to_owned()],
            ranges: [[0.9, 1.1], drives],
            cancel: &Cancel::new(),
        };
        let tracks = plane.tracks();
        let [track] = &tracks[..] else {
            panic!("{} curves", tracks.len());
        };
        let omegas = track.points.iter().map(|point| point[0]);
        let low = omegas.clone().fold(f64::INFINITY, f64::min);
        let high = omegas.fold(0.0, f64::max);
        assert!(low < 0.9 && high > 1.1, "{low} {high}");
        let request = FrequencyResponse::of(&OneSided::default())
            .by(HarmonicBalance::new())
            .vary("drive")
            .omega(1.1)
            .from(0.28)
            .to(0.324);
        let values: Vec<f64> = (0..=8).map(|part| 0.28 + 0.005 * f64::from(part)).collect();
        let diagram = request.solutions(&values).expect("orbits").diagram;
        let folds: Vec<f64> = diagram
            .events(EventKind::Fold)
            .map(|(_, fold)| fold.point.value)
            .collect();
        assert_eq!(folds.len(), 1, "{folds:?}");
        assert!(
            plane.passes(track, EventKind::Fold, [1.1, folds[0]]),
            "{folds:?}"
        );
    }
}
