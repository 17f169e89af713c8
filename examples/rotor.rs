//! A rotor on two ball bearings: `cargo run --release --example rotor` draws `rotor.svg`.
//!
//! ```text
//! M q'' + C q' + K q + sum_j e_j 10 max(e_j . q - 0.1, 0)^(3/2) = weight + unbalance omega^2 (cos, sin)(omega t)
//! ```
//!
//! A disc on an elastic shaft, three fifths of its load on the left bearing: Jeffcott (1919), here with eight balls in each bearing, which
//! press as Hertz has it and stay where they are. What balls do as they pass under the load is in `ball_bearing`. Lengths are in units of the
//! sag of the shaft, masses in those of the disc, time in that of its critical speed on rigid bearings. To make it your own, take the
//! matrices of your shaft, with its gyroscopic one, and the places of its bearings.

use std::f64::consts::TAU;

use hertzian::chart::Page;
use hertzian::structure::{Contact, DMatrix, Structure, parameter};
use hertzian::{Error, FrequencyResponse, HarmonicBalance};

hertzian::law! {
    /// Ball between its rings
    Ball(gap, k) { gap > 0 => k*gap^1.5, else => 0 }
}

/// Disc, left and right journal: first downwards, then across.
pub(crate) const MASSES: [f64; 3] = [1.0, 0.1, 0.1];
pub(crate) const DAMPING: [f64; 3] = [0.05, 0.1, 0.1];
/// By how much each bends the shaft, whose stiffness under the disc is one.
pub(crate) const BENDS: [f64; 3] = [1.0, -0.6, -0.4];

/// The directions of the balls of a bearing.
pub(crate) fn balls(journal: usize) -> impl Iterator<Item = Vec<f64>> {
    (0..8).map(move |ball| {
        let (across, down) = (TAU / 8.0 * f64::from(ball)).sin_cos();
        let mut direction = vec![0.0; 6];
        direction[journal] = down;
        direction[journal + 3] = across;
        direction
    })
}

/// The rotor with this unbalance.
pub(crate) fn rotor(unbalance: f64) -> Result<Structure, Error> {
    let of_planes = |entry: &dyn Fn(usize, usize) -> f64| {
        let entry = |i: usize, j: usize| f64::from(u8::from(i / 3 == j / 3)) * entry(i % 3, j % 3);
        DMatrix::from_fn(6, 6, entry)
    };
    let diagonal = |of: [f64; 3]| of_planes(&|i, j| if i == j { of[i] } else { 0.0 });
    let stiffness = of_planes(&|i, j| BENDS[i] * BENDS[j]);
    let unbalance = || parameter("unbalance", unbalance).times_omega(2);
    let mut rotor = Structure::of(&diagonal(MASSES), &diagonal(DAMPING), &stiffness)
        .name("Rotor on two ball bearings")
        .constant(0, parameter("weight", 1.0))
        .cosine(0, 1, unbalance())
        .sine(3, 1, unbalance())
        .output("down", [1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        .output("across", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    for direction in balls(1).chain(balls(2)) {
        let ball = Contact::new(Ball).arguments([parameter("k", 10.0)]);
        let clearance = parameter("clearance", 0.1);
        rotor = rotor.contact(ball.direction(direction).offset(clearance));
    }
    rotor.build()
}

/// Traces the critical speed, and draws the path of the disc where it is largest.
pub fn main() -> Result<(), Error> {
    let request = FrequencyResponse::of(&rotor(0.05)?).by(HarmonicBalance::new());
    let request = request.accuracy_of("down").tolerance(1e-3);
    let branch = request.from(0.6).to(1.2).run()?;
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    let mut page = Page::new(1).chart(branch.chart());
    if let Some(peak) = branch.largest("down")? {
        let touching = peak.observed.contacts.iter().map(|ball| ball.fraction);
        let held = touching.clone().filter(|part| *part == 1.0).count();
        let bounce = touching.filter(|part| *part > 0.0 && *part < 1.0).count();
        println!("{} at {:.4}", branch.describe_size(peak), peak.value);
        println!("{held} balls are held there, {bounce} are met and left in a period");
        page = page.chart(branch.path(["across", "down"], peak)?);
    }
    Ok(page.write("rotor.svg")?)
}
