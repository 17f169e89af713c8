//! The ring, whose waves are known in closed form.

use super::{agree, response, size};
use crate::casing::casing;
use hertzian::structure::DMatrix;
use hertzian::{ContactEquation, EventKind, FrequencyResponse};
use hertzian_structure::Reduction;

/// Square of the frequency and the shape, outwards and along, of `n` waves around a ring that stretches with 1200 and bends with one, where
/// stretching is the least: strain `a + n b` and bending `n^2 a + n b` of the shape `a cos(n s)` outwards, `b sin(n s)` along.
fn wave(n: usize) -> (f64, [f64; 2]) {
    let n = n as f64;
    let (stretch, bend) = ([1.0, n], [n * n, n]);
    let entry = |i: usize, j: usize| 1200.0 * stretch[i] * stretch[j] + bend[i] * bend[j];
    let eigen = DMatrix::from_fn(2, 2, entry).symmetric_eigen();
    let least = usize::from(eigen.eigenvalues[1] < eigen.eigenvalues[0]);
    let shape = eigen.eigenvectors.column(least);
    (eigen.eigenvalues[least] + 0.25, [shape[0], shape[1]])
}

#[test]
fn its_frequencies_are_those_of_a_ring() {
    let reduced = Reduction::to(4.0)
        .modes(11)
        .steps(0)
        .run(&casing().unwrap());
    let found = reduced.unwrap().frequencies();
    // It turns and swings on its layer, and each shape but these can stand at two places.
    let known = [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5];
    for (found, n) in found.into_iter().zip(known) {
        let square = if n == 0 { 0.25 } else { wave(n).0 };
        agree(found, square.sqrt(), 1e-3);
        // Without stretching, which is what Hoppe has, it is a little stiffer.
        let n = n as f64;
        let hoppe = (n * (n * n - 1.0)).powi(2) / (n * n + 1.0) + 0.25;
        agree(found, hoppe.sqrt(), 2e-2);
    }
}

/// The stop at the load is met first, where the linear motion there, of the four shapes that are kept, has the amplitude one.
#[test]
fn the_first_stop_is_met_where_it_must() {
    let casing = casing().unwrap();
    let reduced = Reduction::to(4.0).modes(9).steps(0).run(&casing).unwrap();
    let request = FrequencyResponse::of(&reduced.structure(&casing).unwrap());
    let request = request.by(ContactEquation::new()).accuracy_of("top");
    let branch = request.from(2.64).to(2.75).run().unwrap();
    let first = branch
        .events(EventKind::Grazing { turns: false })
        .next()
        .expect("a touch");
    let waves = [1, 2, 3, 4].map(wave);
    let diagonal = |of: &dyn Fn(f64) -> f64| {
        DMatrix::from_fn(4, 4, |i, j| if i == j { of(waves[i].0) } else { 0.0 })
    };
    // Of unit mass, which goes with pi for a wave around the ring.
    let at_load = waves.map(|(_, [outwards, _])| outwards / std::f64::consts::PI.sqrt());
    let mass = diagonal(&|_| 1.0);
    let damping = diagonal(&|square| 2.0 * 0.02 * square.sqrt());
    let stiffness = diagonal(&|square| square);
    let force = at_load.map(|shape| 1.8 * shape);
    let amplitude = |omega: f64| {
        let modes = response([&mass, &damping, &stiffness], &force, omega);
        let sum = |part: usize| -> f64 {
            let terms = modes.iter().zip(at_load);
            terms.map(|(mode, shape)| mode[part] * shape).sum()
        };
        size([sum(0), sum(1)])
    };
    let (mut low, mut high) = (2.6, 2.7);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if amplitude(middle) < 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    agree(first.point.value, low, 1e-3);
    // What the load does in a period, modes lose: stops are elastic.
    for point in branch.at(2.75).unwrap() {
        let observed = &point.observed;
        agree(
            observed.input_power.unwrap(),
            observed.dissipated_power.unwrap(),
            1e-8,
        );
        assert_eq!(observed.contacts.iter().filter(|c| c.count > 0).count(), 6);
    }
}
