//! Matrices of drawn structures.

use hertzian_structure::{Direction, Ratios, SparseMatrix};
use hertzian_tests::random::Random;
use nalgebra::{DMatrix, DVector};

use crate::common::{beam_of, dense};

/// Entries of a matrix that is made of elements between two places.
pub fn bonds(n: usize, bonds: &[(usize, usize, f64)], [own, beside]: [f64; 2]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(n, n);
    for &(a, b, factor) in bonds {
        for (i, j, x) in [(a, a, own), (b, b, own), (a, b, beside), (b, a, beside)] {
            matrix[(i, j)] += factor * x;
        }
    }
    matrix
}

/// Mass and stiffness.
pub fn matrices(random: &mut Random, n: usize, free: bool) -> [DMatrix<f64>; 2] {
    if n.is_multiple_of(2) && n <= 8 && random.once_in(3) {
        let elements = if free { n / 2 - 1 } else { n / 2 };
        let beam = beam_of(elements, free);
        return [beam.mass(), beam.stiffness()].map(dense);
    }
    let mut springs: Vec<_> = (1..n)
        .map(|i| (i - 1, i, random.between(0.4, 2.0)))
        .collect();
    let mass = if random.once_in(3) {
        // Bars with linear displacements.
        let bars: Vec<_> = (springs.iter())
            .map(|&(a, b, _)| (a, b, random.between(0.6, 1.6)))
            .collect();
        bonds(n, &bars, [1.0 / 3.0, 1.0 / 6.0])
    } else {
        let all_alike = random.once_in(3);
        let masses = (0..n).map(|_| {
            if all_alike {
                1.0
            } else {
                random.between(0.5, 2.5)
            }
        });
        DMatrix::from_diagonal(&DVector::from_iterator(n, masses))
    };
    if n > 3 && random.once_in(2) {
        for _ in 0..n.div_ceil(3) {
            let (a, b) = (random.below(n), random.below(n));
            if a != b {
                springs.push((a, b, random.between(0.1, 1.0)));
            }
        }
    }
    let mut stiffness = bonds(n, &springs, [1.0, -1.0]);
    if !free {
        stiffness[(0, 0)] += random.between(0.5, 2.0);
        for _ in 0..random.below(3) {
            let at = random.below(n);
            stiffness[(at, at)] += random.between(0.1, 1.0);
        }
    }
    [mass, stiffness]
}

/// Squares of frequencies in ascending order, and modes of unit mass.
pub fn modes_of(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let lower = mass.clone().cholesky().expect("a positive mass").l();
    let half = lower.solve_lower_triangular(stiffness).expect("regular");
    let whole = lower
        .solve_lower_triangular(&half.transpose())
        .expect("regular");
    let eigen = (0.5 * (&whole + whole.transpose())).symmetric_eigen();
    let mut order: Vec<usize> = (0..mass.nrows()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let sorted = DMatrix::from_columns(
        &order
            .iter()
            .map(|&i| eigen.eigenvectors.column(i))
            .collect::<Vec<_>>(),
    );
    let modes = lower
        .transpose()
        .solve_upper_triangular(&sorted)
        .expect("regular");
    (order.iter().map(|&i| eigen.eigenvalues[i]).collect(), modes)
}

/// Of a mode.
pub fn ratio(ratios: &Ratios, mode: usize, frequency: f64) -> f64 {
    match ratios {
        Ratios::One(ratio) => *ratio,
        Ratios::PerMode(all) => all[mode.min(all.len() - 1)],
        Ratios::Table(table) => {
            let last = table.len() - 1;
            if frequency <= table[0][0] {
                return table[0][1];
            }
            let between = (0..last).find(|&i| frequency <= table[i + 1][0]);
            between.map_or(table[last][1], |i| {
                let ([a, low], [b, high]) = (table[i], table[i + 1]);
                low + (high - low) * (frequency - a) / (b - a)
            })
        }
    }
}

/// Without the coordinates that have no part in it.
pub fn along(direction: &DVector<f64>) -> Direction {
    let entries = direction.iter().copied().enumerate();
    Direction::weighted(entries.filter(|(_, x)| *x != 0.0))
}

/// Without zeros.
pub fn sparse(matrix: &DMatrix<f64>) -> SparseMatrix {
    let (n, m) = matrix.shape();
    let entries = (0..n).flat_map(|i| (0..m).map(move |j| (i, j, matrix[(i, j)])));
    SparseMatrix::from_triplets(n, m, entries.filter(|(_, _, x)| *x != 0.0)).expect("finite")
}
