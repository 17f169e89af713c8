//! What examples of structures find, against what is known without following anything: linear vibration, equilibria, and balances of forces.

mod casing;
mod chain_of_beads;
mod gear_train;
mod microscope;
mod rotor;

use hertzian::structure::DMatrix;

/// Amplitudes, as cosine and sine, of `M q'' + C q' + K q = force cos(omega t)`: the real and the imaginary part of one complex system.
fn response(matrices: [&DMatrix<f64>; 3], force: &[f64], omega: f64) -> Vec<[f64; 2]> {
    let [mass, damping, stiffness] = matrices;
    let n = force.len();
    let dynamic = stiffness - omega * omega * mass;
    let whole = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) | (false, false) => dynamic[(i % n, j % n)],
        (true, false) => omega * damping[(i, j - n)],
        (false, true) => -omega * damping[(i - n, j)],
    });
    let force = DMatrix::from_fn(2 * n, 1, |i, _| if i < n { force[i] } else { 0.0 });
    let found = whole.lu().solve(&force).expect("a regular matrix");
    (0..n).map(|i| [found[i], found[n + i]]).collect()
}

fn size([cosine, sine]: [f64; 2]) -> f64 {
    cosine.hypot(sine)
}

/// Whether numbers agree, relative to the second.
fn agree(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within * b.abs(), "{a}, {b}");
}
