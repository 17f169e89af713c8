//! A shaft in a bearing whose balls go round: `cargo run --release --example passing_balls` draws `passing_balls.svg`.
//!
//! ```text
//! M q'' + C q' + K q + sum_j e_j 100 max(e_j . q - 0.02, 0)^(3/2) = weight,    e_j = cos(a_j) down + sin(a_j) across
//! ```
//!
//! A bar in shear of six masses in two planes, held at its far end; the other end is in a bearing of eight balls, at the angles
//! `a_j = 2 pi j/8 + 2/5 omega t`: Sunnersjo (1978), J. Sound Vib. 58. Each ball that passes under the weight lifts the shaft, 16/5 times in a turn,
//! and where that meets a mode it shakes. Mass, stiffness and weight are one. Kept are four of twelve modes, with static vectors. To make it your
//! own, take the matrices of your shaft, and the places and the balls of its bearings.

use std::{error::Error, f64::consts::TAU, sync::Arc};

use hertzian::chart::Page;
use hertzian::structure::{Turn, parameter};
use hertzian::{ContactEquation, FrequencyResponse};
use hertzian_structure::{
    Damping, Direction, Load, LoadKind, Reduction, SparseContact, SparseMatrix, SparseStructure,
};

hertzian::law! {
    /// Ball between its rings
    Ball(gap, k) { gap > 0 => k*gap^1.5, else => 0 }
}

/// Masses in a plane: the first ones go down, those behind across.
pub(crate) const MASSES: usize = 6;

/// The shaft in its bearing.
pub(crate) fn shaft() -> Result<SparseStructure, Box<dyn Error>> {
    let (n, all) = (MASSES as f64, 2 * MASSES);
    let masses = (0..all).map(|i| (i, i, 1.0 / n));
    let springs = (0..all).flat_map(|i| {
        let is_first = i % MASSES == 0;
        let beside = [(i, i.wrapping_sub(1), -n), (i.wrapping_sub(1), i, -n)];
        let beside = beside.into_iter().filter(move |_| !is_first);
        beside.chain([(i, i, if is_first { n } else { 2.0 * n })])
    });
    let of = |entries: Vec<_>| SparseMatrix::from_triplets(all, all, entries);
    let weight = Load::new(LoadKind::Acceleration, whole(0), parameter("weight", 1.0));
    let mut shaft = SparseStructure::new(of(masses.collect())?, of(springs.collect())?)
        .name("Shaft on eight balls that pass under its weight")
        .damping(Damping::ratio(0.03))
        .load(weight.harmonic(0))
        .output("down", Direction::at(0))
        .output("across", Direction::at(MASSES));
    for ball in 0..8 {
        let turn = Turn::by(2, 5).from(TAU / 8.0 * f64::from(ball));
        let contact = SparseContact::new(&format!("ball{ball}"), Arc::new(Ball), Direction::at(0));
        let contact = contact.arguments([parameter("k", 100.0)]);
        let contact = contact.offset(parameter("clearance", 0.02));
        shaft = shaft.contact(contact.turning(Direction::at(MASSES), turn));
    }
    Ok(shaft)
}

/// All masses of a plane alike.
fn whole(plane: usize) -> Direction {
    let masses = plane * MASSES..(plane + 1) * MASSES;
    Direction::weighted(masses.map(|mass| (mass, 1.0)))
}

/// Traces how far the end of the shaft moves over the speed, and draws its path where that is farthest.
pub fn main() -> Result<(), Box<dyn Error>> {
    let shaft = shaft()?;
    let reduced = Reduction::to(2.0).modes(4).steps(1).run(&shaft)?;
    let request = FrequencyResponse::of(&reduced.structure(&shaft)?).by(ContactEquation::new());
    let branch = request.accuracy_of("down").from(0.8).to(1.1).run()?;
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let mut page = Page::new(1).chart(branch.chart());
    if let Some(peak) = branch.largest("down")? {
        let error = reduced.errors_at(&shaft, &branch, peak)?[0].error;
        println!("{} at {:.4}", branch.describe_size(peak), peak.value);
        println!("error of the reduction {error:.0e}");
        page = page.chart(branch.path(["across", "down"], peak)?);
    }
    Ok(page.write("passing_balls.svg")?)
}
