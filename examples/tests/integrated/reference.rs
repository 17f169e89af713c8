//! Orbits of the examples as an integration in Python found them, with unstable ones: `reference.tsv`, which `reference.py` writes.

use crate::approach::Approached;
use crate::ball_bearing::Bearing;
use crate::bolted_joint::BoltedJoint;
use crate::gear_mesh::GearMesh;
use hertzian::{Branch, FrequencyResponse};

/// A line of the table: which task, the value of what varies, the number of the orbit, what is said of it, of what the number is, the number.
type Line = [&'static str; 6];

fn lines(task: &str) -> impl Iterator<Item = Line> {
    let rows = include_str!("reference.tsv").lines();
    let rows = rows.map(|row| {
        let mut cells = row.split('\t');
        [(); 6].map(|()| cells.next().unwrap_or_default())
    });
    rows.filter(move |row| row[0] == task)
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

/// What is asked of peak-to-peak by default, relative.
const TOLERANCE: f64 = 1e-6;

/// Orbits of a branch are those of the table, in the order of their size, to this part of how far each signal moves.
fn are_all(branch: &Branch, task: &str, signal: &str, within: f64) {
    let wanted = lines(task).filter(|line| !line[2].is_empty());
    let wanted: Vec<Line> = wanted.collect();
    let size = format!("{signal}:p2p").parse().expect("a measure");
    let size = |point: &_| {
        branch
            .measured(&size, point)
            .expect("a signal")
            .expect("a number")
    };
    let mut points = branch.at(number(wanted[0][1])).expect("orbits");
    points.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let count = wanted.iter().map(|line| line[2]).max();
    assert_eq!(points.len().to_string(), count.expect("an orbit"), "{task}");
    for [_, _, orbit, verdict, what, value] in wanted {
        let point = &points[number(orbit) as usize - 1];
        assert_eq!(point.stability.verdict.to_string(), verdict);
        // Of eight balls under the load each has the forces of the first, a part of the period later.
        let what = what.replace("ball:", "ball_1:");
        let (signal, measure) = what.split_once(':').expect("a measure");
        // The least force of the ball that is pressed most is no measure of one.
        if signal == "ball_1" && measure != "max" {
            continue;
        }
        let measured = branch.measured(&what.parse().expect("a measure"), point);
        let measured = measured.expect("a signal").expect("a number");
        let extent = branch.reading(signal, point).expect("a signal").motion;
        let bound = within * extent.peak_to_peak();
        let off = (measured - number(value)).abs();
        assert!(off <= bound, "{task} {orbit} {what}: {measured}, {value}");
    }
}

#[test]
fn gears() {
    let request = FrequencyResponse::of(&GearMesh::default());
    let branch = request.from(1.2e4).to(1.7e4).run();
    are_all(
        &branch.expect("a branch"),
        "gear_mesh",
        "relative",
        TOLERANCE,
    );
}

#[test]
fn balls() {
    let request = FrequencyResponse::of(&Bearing::default());
    let branch = request.from(0.52).to(0.48).run();
    are_all(&branch.expect("a branch"), "ball_bearing", "y", TOLERANCE);
}

#[test]
fn a_tip_from_either_side() {
    let request = FrequencyResponse::of(&Approached::default());
    let request = request.vary("distance").omega(1e6);
    for (from, to) in [(14.0, -2.0), (-2.0, 14.0)] {
        let branch = request.clone().from(from).to(to).run();
        // The surface has 0.43 N/m where it is pressed most, by which an error of x of 14 nm is twice that part of its force, 0.62 nN.
        are_all(&branch.expect("a branch"), "approach", "x", 2.0 * TOLERANCE);
    }
}

#[test]
fn a_joint() {
    let request = FrequencyResponse::of(&BoltedJoint::default());
    let branch = request.from(2000.0).to(3000.0).run();
    are_all(
        &branch.expect("a branch"),
        "bolted_joint",
        "opening",
        TOLERANCE,
    );
}

/// As the example prints it: `at 3.9 peak-to-peak of tip 0.0025116964545824, unstable`.
#[test]
fn a_beam() {
    let printed = crate::printed("beam");
    let said = printed
        .lines()
        .filter_map(|line| line.trim().strip_prefix("at 3.9 peak-to-peak of tip "));
    let mut said: Vec<(&str, &str)> = said.filter_map(|line| line.split_once(", ")).collect();
    said.sort_by(|a, b| number(a.0).total_cmp(&number(b.0)));
    let ends: Vec<Line> = lines("beam").collect();
    assert_eq!(2 * said.len(), ends.len());
    for (pair, (size, verdict)) in ends.chunks(2).zip(said) {
        let exact = number(pair[1][5]) - number(pair[0][5]);
        assert_eq!(verdict, pair[0][3]);
        assert!(
            (number(size) - exact).abs() < 1e-10 * exact,
            "{size}, {exact}"
        );
    }
}
