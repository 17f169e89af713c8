//! Points with their names written beside them, where there is room.

use super::legend::crosses;
use super::svg::{Anchor, INK, Pen, Pixel, Rectangle, Svg, width_of};

const SIZE: f64 = 13.0;
/// Radius of the dot.
const DOT: f64 = 4.0;
/// Distances of a name from its dot that are tried, in order; a line leads to one that is far.
const DISTANCES: [f64; 6] = [6.0, 22.0, 44.0, 80.0, 130.0, 200.0];
/// Distance to keep from what is drawn, which has a width of its own.
const CLEARANCE: f64 = 7.0;
const LEADER: Pen = Pen {
    colour: INK,
    width: 0.8,
    dashes: "",
};

/// A name and what it is of.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    pub(super) label: String,
    pub(super) point: Pixel,
    /// Whether a dot is drawn there.
    pub(super) dot: bool,
}

/// A note with the place of its name.
pub(super) struct Placed {
    of: Named,
    room: Rectangle,
    /// Whether a line leads to the name.
    far: bool,
}

/// Places the names one after the other: each where it covers neither what is drawn nor a name before it.
pub(super) fn place(notes: Vec<Named>, frame: &Rectangle, drawn: &[Vec<Pixel>]) -> Vec<Placed> {
    let mut taken = drawn.to_vec();
    taken.extend(notes.iter().map(|note| vec![note.point]));
    let mut placed: Vec<Placed> = Vec::new();
    for of in notes {
        let point = of.point;
        let size = [width_of(&of.label, SIZE), SIZE];
        let inside = |room: &Rectangle| {
            room.left >= frame.left
                && room.top >= frame.top
                && room.right() <= frame.right()
                && room.bottom() <= frame.bottom()
        };
        let covered = |far: bool, room: &Rectangle| {
            let kept = room.grown(CLEARANCE);
            let others = taken.iter().filter(|line| line[..] != [point]);
            let lines = others.filter(|line| crosses(line, &kept)).count();
            let leader = leader(point, room);
            let names = placed.iter().filter(|_| far);
            lines + names.filter(|name| crosses(&leader, &name.room)).count()
        };
        // Where nothing is free, a name over few lines is better than none.
        let best = candidates(point, size)
            .filter(|(_, room)| inside(room))
            .min_by_key(|(far, room)| covered(*far, room));
        let (far, room) =
            best.unwrap_or_else(|| (false, beside(point, size, [1.0, 0.0], DISTANCES[0])));
        taken.extend(room.scanned());
        taken.extend(far.then(|| leader(point, &room)));
        placed.push(Placed { of, room, far });
    }
    placed
}

/// The line from a point to the nearest place of a name's room.
fn leader(point: Pixel, room: &Rectangle) -> Vec<Pixel> {
    let nearest = [
        point[0].clamp(room.left, room.right()),
        point[1].clamp(room.top, room.bottom()),
    ];
    vec![point, nearest]
}

/// Places around a point, near ones first, and whether they are far.
fn candidates(point: Pixel, size: [f64; 2]) -> impl Iterator<Item = (bool, Rectangle)> {
    const SIDES: [[f64; 2]; 12] = [
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, -1.0],
        [0.0, 1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, -1.0],
        [-1.0, 1.0],
        [1.0, 0.5],
        [1.0, -0.5],
        [-1.0, 0.5],
        [-1.0, -0.5],
    ];
    DISTANCES.into_iter().flat_map(move |distance| {
        let far = distance > DISTANCES[0];
        SIDES.map(|side| (far, beside(point, size, side, distance)))
    })
}

/// The room of a name on one side of a point.
fn beside([x, y]: Pixel, [width, height]: [f64; 2], [u, v]: [f64; 2], distance: f64) -> Rectangle {
    let reach = DOT + distance;
    Rectangle {
        left: x + u * (reach + 0.5 * width) - 0.5 * width,
        top: y + v * (reach + 0.5 * height) - 0.5 * height,
        width,
        height,
    }
}

impl Placed {
    pub(super) fn draw(&self, svg: &mut Svg) {
        let Self { of, room, far } = self;
        let point = of.point;
        if *far {
            svg.lines(&[leader(point, room)], LEADER);
        }
        if of.dot {
            svg.circle(point, DOT, INK, LEADER);
        }
        let start = [room.left, room.bottom() - 0.22 * SIZE];
        svg.text(start, SIZE, Anchor::Start, &of.label);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rectangle = Rectangle {
        left: 0.0,
        top: 0.0,
        width: 400.0,
        height: 300.0,
    };

    fn named(label: &str, point: Pixel) -> Named {
        Named {
            label: label.to_owned(),
            point,
            dot: true,
        }
    }

    #[test]
    fn names_cover_neither_lines_nor_each_other() {
        let line = vec![[0.0, 150.0], [400.0, 150.0]];
        let notes = [("first", [200.0, 150.0]), ("second", [205.0, 150.0])];
        let notes = notes.map(|(label, point)| named(label, point)).to_vec();
        let placed = place(notes, &FRAME, std::slice::from_ref(&line));
        for note in &placed {
            assert!(!crosses(&line, &note.room));
            assert!(FRAME.contains([note.room.left, note.room.top]));
        }
        let [a, b] = [placed[0].room, placed[1].room];
        let apart = a.right() < b.left || b.right() < a.left;
        assert!(apart || a.bottom() < b.top || b.bottom() < a.top);
    }

    #[test]
    fn lines_to_names_cross_no_other_name() {
        // Points along a rising curve, closer in its middle, as events are on a cascade.
        let curve: Vec<Pixel> = (0..40)
            .map(|i| [10.0 * f64::from(i), 250.0 - 5.0 * f64::from(i)])
            .collect();
        let notes = (0..6).map(|i| {
            let x = 180.0 + 9.0 * f64::from(i);
            named("fold ×2, grazing", [x, 250.0 - 0.5 * x])
        });
        let placed = place(notes.collect(), &FRAME, std::slice::from_ref(&curve));
        let far = placed.iter().filter(|note| note.far);
        assert!(far.clone().count() > 2);
        for note in far {
            let line = leader(note.of.point, &note.room);
            let others = placed
                .iter()
                .filter(|other| other.of.point != note.of.point);
            for other in others {
                assert!(!crosses(&line, &other.room), "{:?} {:?}", note.of, other.of);
            }
        }
    }

    #[test]
    fn a_name_at_the_edge_stays_inside() {
        let placed = place(vec![named("a long name", [398.0, 2.0])], &FRAME, &[]);
        let room = placed[0].room;
        assert!(room.right() <= 400.0 && room.top >= 0.0);
    }
}
