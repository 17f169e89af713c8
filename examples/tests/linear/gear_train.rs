//! Gears whose teeth do not part vibrate linearly, and begin to part where the linear motion says.

use super::{agree, response, size};
use crate::gear_train::GearTrain;
use hertzian::structure::{DMatrix, assemble};
use hertzian::{EventKind, FrequencyResponse, Shooting};

/// Amplitude of the mesh, without and with the error of the profile, while teeth are pressed together.
fn linear(omega: f64) -> [f64; 2] {
    let spring = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
    let of = |factors: [f64; 3]| {
        let springs = factors.map(|factor| factor * &spring);
        assemble(4, springs.iter().enumerate())
    };
    let inertias = [4.0, 1.0, 2.0, 8.0];
    let mass = DMatrix::from_fn(4, 4, |i, j| if i == j { inertias[i] } else { 0.0 });
    let (damping, stiffness) = (of([0.003, 0.06, 0.003]), of([0.1, 1.0, 0.1]));
    let force = [0.0, 0.05, -0.05, 0.0];
    let found = response([&mass, &damping, &stiffness], &force, omega);
    let [cosine, sine] = [0, 1].map(|part| found[1][part] - found[2][part]);
    [size([cosine, sine]), size([cosine - 0.05, sine])]
}

#[test]
fn teeth_part_where_they_must() {
    let request = FrequencyResponse::of(&GearTrain::default()).by(Shooting::new());
    let branch = request.from(0.9).to(1.5).run().expect("a branch");
    // The gap moves by less than the mean deformation, which the torque makes.
    let point = &branch.at(0.9).expect("orbits")[0];
    let measured = branch.measured(&"relative:h1".parse().unwrap(), point);
    agree(measured.unwrap().unwrap(), linear(0.9)[0], 1e-8);
    let touches: Vec<f64> = branch
        .events(EventKind::Grazing { turns: false })
        .map(|e| e.point.value)
        .collect();
    assert_eq!(touches.len(), 2);
    for omega in touches {
        agree(linear(omega)[1], 0.2, 1e-8);
    }
}

/// In the mean over a period the mesh carries the torque, and so do the shafts, whatever teeth do.
#[test]
fn the_mesh_carries_the_torque() {
    let request = FrequencyResponse::of(&GearTrain::default()).by(Shooting::new());
    let branch = request.from(0.9).to(1.5).run().expect("a branch");
    let points = branch.at(1.1).expect("orbits");
    assert_eq!(points.len(), 3);
    for point in points {
        let period = std::f64::consts::TAU / 1.1;
        let contact = &point.observed.contacts[0];
        agree(contact.impulse.unwrap() / period, 0.2, 1e-8);
        let twist = branch.measured(&"twist:mean".parse().unwrap(), &point);
        agree(twist.unwrap().unwrap(), 0.2 / 0.1, 1e-8);
    }
}
