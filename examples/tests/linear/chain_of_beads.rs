//! Beads that move by little: a chain of equal masses and springs between two walls.

use super::{agree, response, size};
use crate::chain_of_beads::Beads;
use hertzian::FrequencyResponse;
use hertzian::structure::DMatrix;

#[test]
fn small_motions_are_those_of_springs() {
    let drive = 1e-6;
    let model = Beads {
        drive,
        ..Beads::default()
    };
    let request = FrequencyResponse::of(&model);
    let one = DMatrix::identity(4, 4);
    let springs = DMatrix::from_fn(4, 4, |i, j| match i.abs_diff(j) {
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let damping = 0.03 * &one;
    // At the resonances of such a chain, between two of them, and above where anything passes.
    let resonances = [1.0, 2.0, 3.0, 4.0].map(|k| 2.0 * (k * std::f64::consts::PI / 10.0).sin());
    for omega in resonances.into_iter().chain([0.9, 2.2]) {
        let linear = response([&one, &damping, &springs], &[drive, 0.0, 0.0, 0.0], omega);
        let orbit = request.clone().orbit(omega).expect("an orbit");
        let measured = request.measured(&"arrives:h1".parse().unwrap(), &orbit);
        agree(measured.unwrap().unwrap(), size(linear[3]), 1e-4);
    }
}
