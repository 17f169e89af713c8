//! Lines through the orbits of a branch that bend as the branch does.
//!
//! From one orbit to the next a line is a cubic with the tangents of both (Hermite's), as many straight pieces as it takes. The tangent
//! at an orbit is that of the parabola through it and its neighbours over the lengths of the chords (Bessel's: de Boor 1978, A Practical
//! Guide to Splines, chapter IV). At a fold it is upright, since what is varied is stationary there. Where a gap touches a level, where
//! something was not located, and where chords turn sharply, the slope may jump, and each side has a tangent of its own. Between two
//! orbits a branch does not turn back, so a cubic that does is not drawn: the line is straight there.

use super::{Run, Scale};

type Vector = [f64; 2];

/// Orbits nearer to each other than this part of the chart share a tangent: their chord says nothing.
const NEAR: f64 = 1e-4;
/// How far a straight piece may be from the cubic, in parts of the chart.
const TOLERANCE: f64 = 1e-4;
/// Pieces of one cubic, at most.
const PIECES: f64 = 32.0;
/// The cosine of the angle of two chords beyond which the line has a corner.
const CORNER: f64 = 0.5;
/// How far a cubic may leave the interval of what is varied between its ends, in parts of the chart.
const BEYOND: f64 = 1e-3;
/// The cosine of the angle of a chord and a tangent beyond which the line stays straight.
const STRAIGHT: f64 = 0.3;

/// What is known of a line at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bend {
    /// It turns back.
    Upright,
    /// Its slope may jump.
    Corner,
}

/// The runs of one branch, with places between its orbits where the line bends: cubics with the tangents that the orbits and what is known
/// of some of them tell. Places that are given stay as they are. The scale is that of the vertical axis.
pub fn smoothed(runs: Vec<Run>, bends: &[(Vector, Bend)], scale: Scale) -> Vec<Run> {
    let mut places: Vec<Vector> = Vec::new();
    let mut starts = Vec::new();
    for run in &runs {
        // Neighbours share the place where they meet.
        let shared = places
            .last()
            .is_some_and(|last| Some(last) == run.points.first());
        starts.push(places.len() - usize::from(shared));
        places.extend(&run.points[usize::from(shared)..]);
    }
    let frame = Frame::of(&places, scale);
    let nodes: Vec<Vector> = places.iter().map(|place| frame.inside(place)).collect();
    let bend = |place: &Vector| bends.iter().find(|(own, _)| own == place);
    let bends: Vec<Option<Bend>> = places.iter().map(|p| Some(bend(p)?.1)).collect();
    let tangents = tangents(&nodes, &bends);
    let starts = starts.into_iter();
    let bent = runs.into_iter().zip(starts).map(|(run, start)| {
        let mut points = Vec::with_capacity(run.points.len());
        for (offset, place) in run.points.iter().enumerate() {
            points.push(*place);
            let (from, to) = (start + offset, start + offset + 1);
            if offset + 1 < run.points.len() {
                let cubic = Cubic {
                    ends: [nodes[from], nodes[to]],
                    slopes: [tangents[from][1], tangents[to][0]],
                };
                points.extend(
                    cubic
                        .between()
                        .into_iter()
                        .map(|place| frame.outside(place)),
                );
            }
        }
        Run { points, ..run }
    });
    bent.collect()
}

/// The chart as a square of size one.
struct Frame {
    scale: Scale,
    size: Vector,
}

impl Frame {
    fn of(places: &[Vector], scale: Scale) -> Self {
        let drawn = |place: &Vector| [place[0], level(scale, place[1])];
        let all = places.iter().map(drawn);
        let all = all.filter(|place| place.iter().all(|u| u.is_finite()));
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for place in all {
            for (ends, u) in ends.iter_mut().zip(place) {
                *ends = [ends[0].min(u), ends[1].max(u)];
            }
        }
        let size = ends.map(|[low, high]| if high > low { high - low } else { 1.0 });
        Self { scale, size }
    }

    fn inside(&self, [x, y]: &Vector) -> Vector {
        [x / self.size[0], level(self.scale, *y) / self.size[1]]
    }

    fn outside(&self, [x, y]: Vector) -> Vector {
        let y = y * self.size[1];
        let y = if self.scale == Scale::Linear {
            y
        } else {
            y.exp()
        };
        [x * self.size[0], y]
    }
}

/// Where a value is drawn; not a number where it has no place.
fn level(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Linear => value,
        _ if value > 0.0 => value.ln(),
        _ => f64::NAN,
    }
}

/// The tangents on both sides of each node, of length one or so over the length of the chords; none where the line is straight or
/// interrupted.
fn tangents(nodes: &[Vector], bends: &[Option<Bend>]) -> Vec<[Option<Vector>; 2]> {
    let mut tangents = vec![[None; 2]; nodes.len()];
    let mut heaps: Vec<Heap> = Vec::new();
    for (index, node) in nodes.iter().enumerate() {
        if !node.iter().all(|u| u.is_finite()) {
            bent(&heaps, nodes, &mut tangents);
            heaps.clear();
            continue;
        }
        match heaps.last_mut() {
            Some(heap) if length(minus(*node, nodes[heap.last])) < NEAR => {
                heap.last = index;
                // What is known of one is known of all; a fold outweighs a touch beside it.
                if heap.bend != Some(Bend::Upright) {
                    heap.bend = bends[index].or(heap.bend);
                }
            }
            _ => heaps.push(Heap {
                first: index,
                last: index,
                bend: bends[index],
            }),
        }
    }
    bent(&heaps, nodes, &mut tangents);
    tangents
}

/// Nodes at one place.
#[derive(Debug, Clone, Copy)]
struct Heap {
    first: usize,
    last: usize,
    bend: Option<Bend>,
}

/// The tangents of an uninterrupted line.
fn bent(heaps: &[Heap], nodes: &[Vector], tangents: &mut [[Option<Vector>; 2]]) {
    let chords: Vec<Vector> = heaps
        .windows(2)
        .map(|pair| minus(nodes[pair[1].first], nodes[pair[0].last]))
        .collect();
    let is_corner = |index: usize| {
        let [before, after] = [chords[index - 1], chords[index]];
        let turned = dot(before, after) < CORNER * length(before) * length(after);
        match heaps[index].bend {
            Some(Bend::Corner) => true,
            Some(Bend::Upright) => false,
            None => turned,
        }
    };
    let inner = |index: usize| {
        let [before, after] = [chords[index - 1], chords[index]];
        let [h, k] = [length(before), length(after)];
        let weighted = |u: f64, v: f64| (u / h * k + v / k * h) / (h + k);
        let tangent = [weighted(before[0], after[0]), weighted(before[1], after[1])];
        let rise = before[1] + after[1];
        match heaps[index].bend {
            Some(Bend::Upright) if rise != 0.0 => [0.0, rise.signum()],
            _ => tangent,
        }
    };
    let count = heaps.len();
    for (index, heap) in heaps
        .iter()
        .enumerate()
        .take(count.saturating_sub(1))
        .skip(1)
    {
        if !is_corner(index) {
            let tangent = Some(inner(index));
            for node in heap.first..=heap.last {
                tangents[node] = [tangent; 2];
            }
        }
    }
    // At an end and beside a corner, the tangent of the parabola with the chord and the tangent at its other end.
    for (index, chord) in chords.iter().enumerate() {
        let [from, to] = [heaps[index].last, heaps[index + 1].first];
        let reflected = |known: Vector| {
            let unit = length(*chord);
            [0, 1].map(|k| 2.0 * chord[k] / unit - known[k])
        };
        match (tangents[from][1], tangents[to][0]) {
            (None, Some(known)) => tangents[from][1] = Some(reflected(known)),
            (Some(known), None) => tangents[to][0] = Some(reflected(known)),
            _ => {}
        }
    }
}

/// The line from one node to the next.
struct Cubic {
    ends: [Vector; 2],
    slopes: [Option<Vector>; 2],
}

impl Cubic {
    /// Places between its ends.
    fn between(self) -> Vec<Vector> {
        let [from, to] = self.ends;
        let chord = minus(to, from);
        let size = length(chord);
        let aside = |slope: Option<Vector>| {
            let slope = slope?;
            let cosine = dot(slope, chord) / (length(slope) * size);
            (cosine > STRAIGHT).then(|| cosine.min(1.0).acos())
        };
        let angle = match (aside(self.slopes[0]), aside(self.slopes[1])) {
            (Some(first), Some(second)) => first + second,
            _ => 0.0,
        };
        // An arc that turns by an angle is an eighth of it times its length aside of its chord, and of half the length a quarter of that.
        let pieces = (size * angle / (8.0 * TOLERANCE)).sqrt().ceil();
        let pieces = pieces.clamp(1.0, PIECES);
        let [a, b] = self.slopes.map(Option::unwrap_or_default);
        let [low, high] = [from[0].min(to[0]), from[0].max(to[0])];
        let place = |i: u32| {
            let s = f64::from(i) / pieces;
            let r = 1.0 - s;
            let [x, y] = [0, 1].map(|k| {
                let bent = r * r * s * a[k] - r * s * s * b[k];
                r * r * (1.0 + 2.0 * s) * from[k] + s * s * (3.0 - 2.0 * s) * to[k] + size * bent
            });
            let inside = x.clamp(low, high);
            ((x - inside).abs() < BEYOND).then_some([inside, y])
        };
        let places: Option<Vec<Vector>> = (1..pieces as u32).map(place).collect();
        places.unwrap_or_default()
    }
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(a: Vector) -> f64 {
    a[0].hypot(a[1])
}

#[cfg(test)]
mod tests {
    use super::super::Line;
    use super::*;

    /// `x = 4 y^3 - 3 y` turns back at `y = -1/2`, `x = 1` and at `y = 1/2`, `x = -1`.
    fn curve(y: f64) -> Vector {
        [y * (4.0 * y * y - 3.0), y]
    }

    fn run(line: Line, points: Vec<Vector>) -> Run {
        Run { line, points }
    }

    /// Largest distance from the curve, along x over the slope or along y, whichever is less.
    fn error(points: &[Vector]) -> f64 {
        let errors = points.iter().map(|&[x, y]| {
            let slope = 12.0 * y * y - 3.0;
            (curve(y)[0] - x).abs() / (1.0 + slope * slope).sqrt()
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn a_line_follows_a_curve_with_two_folds() {
        let at = |range: std::ops::RangeInclusive<i32>| {
            range
                .map(|i| curve(f64::from(i) / 10.0))
                .collect::<Vec<_>>()
        };
        let runs = vec![
            run(Line::Stable, at(-10..=-5)),
            run(Line::Unstable, at(-5..=5)),
            run(Line::Stable, at(5..=10)),
        ];
        let folds = [-0.5, 0.5].map(|y| (curve(y), Bend::Upright));
        let bent = smoothed(runs.clone(), &folds, Scale::Linear);
        let all = |runs: &[Run]| {
            runs.iter()
                .flat_map(|run| run.points.clone())
                .collect::<Vec<_>>()
        };
        // Middles of the chords of the same orbits.
        let chords: Vec<Vector> = all(&runs)
            .windows(2)
            .map(|pair| [0, 1].map(|k| 0.5 * (pair[0][k] + pair[1][k])))
            .collect();
        let (straight, curved) = (error(&chords), error(&all(&bent)));
        assert!(
            straight > 0.012 && curved < 0.4 * straight,
            "{straight} {curved}"
        );
        // Nothing goes beyond a fold, all orbits are kept, and the runs join as before.
        assert!(all(&bent).iter().all(|[x, _]| x.abs() <= 1.0 + 1e-12));
        for (bent, run) in bent.iter().zip(&runs) {
            assert!(run.points.iter().all(|point| bent.points.contains(point)));
            assert_eq!(bent.points.first(), run.points.first());
            assert_eq!(bent.points.last(), run.points.last());
        }
        // Twice as many orbits: an error of the third order is an eighth, which that of a chord is not.
        let at = |range: std::ops::RangeInclusive<i32>| {
            range
                .map(|i| curve(f64::from(i) / 20.0))
                .collect::<Vec<_>>()
        };
        let finer = smoothed(vec![run(Line::Stable, at(-20..=20))], &folds, Scale::Linear);
        assert!(
            error(&all(&finer)) < 0.2 * curved,
            "{}",
            error(&all(&finer))
        );
    }

    #[test]
    fn corners_and_gaps_stay() {
        let corner = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, -1.0]];
        let runs = vec![run(Line::Stable, corner.to_vec())];
        assert_eq!(smoothed(runs.clone(), &[], Scale::Linear), runs);
        // A gentle one stays where it is known to be one: both sides are parabolas then, which do not share a tangent.
        let gentle: Vec<Vector> = (0..=8)
            .map(|i| f64::from(i) / 4.0)
            .map(|x| [x, if x < 1.0 { 0.2 * x * x } else { 0.2 }])
            .collect();
        let bent = smoothed(
            vec![run(Line::Stable, gentle.clone())],
            &[([1.0, 0.2], Bend::Corner)],
            Scale::Linear,
        );
        let beyond = bent[0].points.iter().filter(|[x, _]| *x > 1.0);
        assert!(beyond.clone().count() >= 4);
        assert!(beyond.clone().all(|[_, y]| (y - 0.2).abs() < 1e-12));
        let gap = [[0.0, 0.0], [1.0, f64::NAN], [2.0, 1.0]];
        let bent = smoothed(vec![run(Line::Stable, gap.to_vec())], &[], Scale::Linear);
        assert_eq!(bent[0].points.len(), 3);
        assert_eq!(smoothed(Vec::new(), &[], Scale::Linear), []);
    }

    #[test]
    fn nothing_turns_back_between_orbits() {
        // Steep, with steps of very different lengths.
        let steep = [
            [0.0, 0.0],
            [0.8, 0.0],
            [0.81, -0.2],
            [0.82, -0.5],
            [0.821, -1.0],
            [1.0, -1.01],
        ];
        let bent = smoothed(vec![run(Line::Stable, steep.to_vec())], &[], Scale::Linear);
        let places = &bent[0].points;
        assert!(places.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        assert!(places.len() > steep.len());
    }

    #[test]
    fn a_power_is_straight_on_a_logarithmic_axis() {
        let points: Vec<Vector> = (0..6).map(|i| [f64::from(i), 10_f64.powi(i)]).collect();
        let runs = vec![run(Line::Stable, points)];
        for scale in [Scale::Logarithmic, Scale::Decibel] {
            let bent = smoothed(runs.clone(), &[], scale);
            let off = |&[x, y]: &Vector| (y.log10() - x).abs();
            assert!(bent[0].points.iter().all(|point| off(point) < 1e-12));
        }
    }
}
