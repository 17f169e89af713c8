//! The model of the vectors that are kept: what the matrices are in them.

use nalgebra::DMatrix;

use super::work::Work;
use crate::description::damping::Damping;
use crate::lanczos::{self, Basis};
use crate::matrix::SparseMatrix;
use crate::reduced::{Checked, Reduced};

impl Work<'_> {
    /// The model of the vectors that are kept.
    pub(super) fn reduced(
        &self,
        squares: &[f64],
        basis: &Basis<'_>,
        checked: Vec<Checked>,
    ) -> Reduced {
        let (kept, m) = (squares.len(), basis.vectors.len());
        let mut stiffness = DMatrix::zeros(m, m);
        for (mode, square) in squares.iter().enumerate() {
            stiffness[(mode, mode)] = *square;
        }
        for j in kept..m {
            let image = self.structure.stiffness.times(&basis.vectors[j]);
            // Modes are orthogonal in the product of the stiffness matrix too.
            for i in kept..m {
                stiffness[(i, j)] = lanczos::dot(&basis.vectors[i], &image);
            }
        }
        let stiffness = 0.5 * (&stiffness + stiffness.transpose());
        let (turn, all) = turned(&stiffness, squares);
        // Symmetric, or skew-symmetric by a sign of -1, to the last bit, as the matrix itself is up to rounding.
        let project = |matrix: &SparseMatrix, sign: f64| {
            let images: Vec<Vec<f64>> = basis.vectors.iter().map(|v| matrix.times(v)).collect();
            let inner = DMatrix::from_fn(m, m, |i, j| lanczos::dot(&basis.vectors[i], &images[j]));
            let turned = turn.transpose() * inner * &turn;
            0.5 * (&turned + sign * turned.transpose())
        };
        let row = |direction: &Vec<f64>| -> Vec<f64> {
            let inner = DMatrix::from_fn(1, m, |_, j| lanczos::dot(direction, &basis.vectors[j]));
            (inner * &turn).iter().copied().collect()
        };
        let structure = self.structure;
        // What was looked at is what is kept.
        let is_kept = !checked.is_empty();
        let coupling = is_kept.then(|| self.coupling(basis, &turn, &all));
        Reduced {
            version: Reduced::VERSION,
            fingerprint: Reduced::fingerprint_of(structure),
            coordinates: structure.coordinates(),
            to: self.options.to,
            asked: self.options.asked,
            modes: kept,
            damping: damping(&structure.damping, &all, &|matrix| project(matrix, 1.0)),
            gyroscopic: structure
                .gyroscopic
                .iter()
                .map(|g| entries(&project(&g.matrix, -1.0)))
                .collect(),
            coupling: coupling.unwrap_or_default(),
            squares: all,
            rows: self.directions.rows.iter().map(row).collect(),
            checked,
        }
    }
}

impl Work<'_> {
    /// `(B_p V)^T R (B_q V)` of each pair of a damping matrix that is given by its entries and gyroscopic ones: what is left out answers the
    /// vectors by its compliance `R`, that of a slow motion. None where there is no such matrix or nothing is left out.
    fn coupling(&self, basis: &Basis<'_>, turn: &DMatrix<f64>, squares: &[f64]) -> Vec<Vec<f64>> {
        let structure = self.structure;
        let m = basis.vectors.len();
        let given = match &structure.damping {
            Damping::Matrix(matrix) => Some(matrix),
            _ => None,
        };
        let turned = structure.gyroscopic.iter().map(|g| &g.matrix);
        let matrices: Vec<&SparseMatrix> = given.into_iter().chain(turned).collect();
        if matrices.is_empty() || m == structure.coordinates() {
            return Vec::new();
        }
        // All of them beside each other, and what the structure answers to them.
        let images = matrices
            .iter()
            .flat_map(|matrix| basis.vectors.iter().map(|v| matrix.times(v)));
        let images: Vec<Vec<f64>> = images.collect();
        let answers: Vec<Vec<f64>> = images
            .iter()
            .map(|image| self.factor.solve(image))
            .collect();
        let known = |image: &Vec<f64>| -> Vec<f64> {
            let parts = basis.vectors.iter().map(|v| lanczos::dot(v, image));
            (DMatrix::from_iterator(1, m, parts) * turn)
                .iter()
                .copied()
                .collect()
        };
        let along: Vec<Vec<f64>> = images.iter().map(known).collect();
        let entry = |i: usize, j: usize| {
            let terms = along[i].iter().zip(&along[j]).zip(squares);
            let of_vectors: f64 = terms
                .map(|((a, b), square)| a * b / (square + self.shift))
                .sum();
            lanczos::dot(&images[i], &answers[j]) - of_vectors
        };
        let count = matrices.len();
        let pairs = (0..count).flat_map(|p| (0..count).map(move |q| (p, q)));
        pairs
            .map(|(p, q)| {
                let block = DMatrix::from_fn(m, m, |i, j| entry(p * m + i, q * m + j));
                entries(&(turn.transpose() * block * turn))
            })
            .collect()
    }
}

/// The turn of vectors that makes the stiffness of those behind the modes diagonal, and squares of frequencies of all.
fn turned(stiffness: &DMatrix<f64>, squares: &[f64]) -> (DMatrix<f64>, Vec<f64>) {
    let (kept, m) = (squares.len(), stiffness.nrows());
    let (own, vectors) = diagonal(stiffness, kept);
    let mut order: Vec<usize> = (0..m - kept).collect();
    order.sort_by(|&a, &b| own[a].total_cmp(&own[b]));
    let mut turn = DMatrix::zeros(m, m);
    turn.view_mut((0, 0), (kept, kept)).fill_with_identity();
    let mut all = squares.to_vec();
    for (place, &of) in order.iter().enumerate() {
        all.push(own[of]);
        turn.view_mut((kept, kept + place), (m - kept, 1))
            .copy_from(&vectors.column(of));
    }
    (turn, all)
}

/// Eigenvalues and eigenvectors of what stands behind the modes.
fn diagonal(stiffness: &DMatrix<f64>, kept: usize) -> (Vec<f64>, DMatrix<f64>) {
    let count = stiffness.nrows() - kept;
    if count == 0 {
        return (Vec::new(), DMatrix::zeros(0, 0));
    }
    let part = stiffness.view((kept, kept), (count, count)).into_owned();
    let eigen = part.symmetric_eigen();
    (eigen.eigenvalues.as_slice().to_vec(), eigen.eigenvectors)
}

fn entries(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

/// The damping of the vectors that are kept, row by row.
fn damping(
    damping: &Damping,
    squares: &[f64],
    project: &dyn Fn(&SparseMatrix) -> DMatrix<f64>,
) -> Vec<f64> {
    let m = squares.len();
    let diagonal = |of: &dyn Fn(usize) -> f64| {
        entries(&DMatrix::from_fn(
            m,
            m,
            |i, j| if i == j { of(i) } else { 0.0 },
        ))
    };
    match damping {
        Damping::None => vec![0.0; m * m],
        Damping::Matrix(matrix) => entries(&project(matrix)),
        Damping::Rayleigh { mass, stiffness } => diagonal(&|i| mass + stiffness * squares[i]),
        Damping::Modal(ratios) => diagonal(&|i| {
            let frequency = squares[i].max(0.0).sqrt();
            2.0 * ratios.of(i, frequency) * frequency
        }),
    }
}
