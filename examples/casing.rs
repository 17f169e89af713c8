//! A casing between twenty stops: `cargo run --release --example casing` draws `casing.svg`.
//!
//! ```text
//! M q'' + C q' + K q + sum_j e_j 5 max(e_j . q - c_j, 0) = F cos(omega t)
//! ```
//!
//! A thin ring in its plane by sixty elements, from triplets, on a soft layer, with a stop at every third node. Where all are open the squares of
//! its frequencies are `n^2 (n^2 - 1)^2 / (n^2 + 1) + 1/4`: Hoppe (1871), in Love's Theory of Elasticity. Radius, bending stiffness and mass
//! per length are one; displacements are in units of the least clearance. To make it your own, take the matrices of your finite elements.

use std::{error::Error, f64::consts::PI, sync::Arc};

use hertzian::chart::{Chart, Page, Series};
use hertzian::structure::{DMatrix, parameter};
use hertzian::{ContactEquation, FrequencyResponse};
use hertzian_structure::{
    Damping, Direction, Load, Reduction, SparseContact, SparseMatrix, SparseStructure,
};

hertzian::law! {
    /// Elastic stop
    Stop(gap, k) { gap > 0 => k*gap, else => 0 }
}

const NODES: usize = 60;
const STOPS: usize = 20;
/// Of an element across its chord: deflection and slope, times its length, at either end.
const INERTIA: [i16; 16] = [
    156, 22, 54, -13, 22, 4, 13, -3, 54, 13, 156, -22, -13, -3, -22, 4,
];
const BENDING: [i16; 16] = [12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4];

/// The entries of a matrix of the ring, whose nodes move along the ring, move outwards, and turn, from those of an element.
fn ring(factor: f64, along: [f64; 2], across: [i16; 16]) -> Vec<(usize, usize, f64)> {
    let element = DMatrix::from_fn(6, 6, |i, j| match (i % 3, j % 3) {
        (0, 0) => factor * along[usize::from(i != j)],
        (0, _) | (_, 0) => 0.0,
        (m, n) => factor * f64::from(across[4 * (i / 3 * 2 + m - 1) + j / 3 * 2 + n - 1]),
    });
    let (sine, cosine) = (PI / NODES as f64).sin_cos();
    let turned = DMatrix::from_fn(6, 6, |i, j| match (i % 3, j % 3, i / 3 == j / 3) {
        (0, 0, true) | (1, 1, true) => cosine,
        (0, 1, true) | (1, 0, true) => sine * f64::from(1 - 2 * i8::from((i < j) == (i < 3))),
        _ => f64::from(i8::from(i == j)),
    });
    let element = turned.transpose() * element * turned;
    let places = (0..NODES).flat_map(|node| (0..36).map(move |k| [node, k / 6, k % 6]));
    let place = |node: usize, entry: usize| (3 * node + entry) % (3 * NODES);
    let entries = places.map(|[node, i, j]| (place(node, i), place(node, j), element[(i, j)]));
    entries.collect()
}

/// The ring on its layer, with the load at its top; the clearances of its stops are from 1 to 1.38.
pub(crate) fn casing() -> Result<SparseStructure, Box<dyn Error>> {
    let h = 2.0 * PI / NODES as f64;
    // Its thickness is a tenth of its radius.
    let stretch = 1200.0 * h * h;
    let mass = ring(h / 420.0, [140.0, 70.0], INERTIA);
    let mut stiffness = ring(h.powi(-3), [stretch, -stretch], BENDING);
    stiffness.extend(mass.iter().map(|(i, j, m)| (*i, *j, 0.25 * m)));
    let of = |entries: Vec<_>| SparseMatrix::from_triplets(3 * NODES, 3 * NODES, entries);
    let mut casing = SparseStructure::new(of(mass)?, of(stiffness)?)
        .name("Casing between twenty stops")
        .damping(Damping::ratio(0.02))
        .load(Load::force(Direction::at(1), parameter("drive", 1.8)))
        .output("top", Direction::at(1));
    for stop in 0..STOPS {
        let outwards = Direction::at(9 * stop + 1);
        let contact = SparseContact::new(&format!("stop{stop}"), Arc::new(Stop), outwards)
            .arguments([parameter("k", 5.0)])
            .offset(1.0 + 0.02 * (7 * stop % STOPS) as f64);
        casing = casing.contact(contact);
    }
    Ok(casing)
}

/// Traces the resonance of the oval shape, and says how many stops close at 2.75 and what the reduction to nine modes changes there.
pub fn main() -> Result<(), Box<dyn Error>> {
    let casing = casing()?;
    let reduced = Reduction::to(4.0).modes(9).steps(0).run(&casing)?;
    let request = FrequencyResponse::of(&reduced.structure(&casing)?).by(ContactEquation::new());
    let branch = request.accuracy_of("top").from(2.4).to(3.2).run()?;
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let mut chart = Chart::new("Largest force of each stop at 2.75")
        .x("number of the stop, around the ring from the load on")
        .y("force");
    for point in branch.at(2.75)? {
        let forces = point.observed.contacts.iter().map(|c| c.maximum_force);
        let error = reduced.errors_at(&casing, &branch, &point)?[0].error;
        let closed = forces.clone().filter(|force| *force > 0.0).count();
        println!("at 2.75 {closed} stops close; error of the reduction {error:.0e}");
        let places = (0..STOPS).map(|stop| stop as f64).zip(forces);
        let places: Vec<_> = places.map(<[f64; 2]>::from).collect();
        chart = chart.markers(Series::new("largest force in the period", places));
    }
    let page = Page::new(1).chart(branch.chart()).chart(chart);
    Ok(page.write("casing.svg")?)
}
