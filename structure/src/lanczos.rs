//! The lowest modes `K phi = w^2 M phi` of a structure, from its factors at a shift.
//!
//! The Lanczos process with several starting vectors, so that repeated frequencies are found, on
//!
//! ```text
//! B = (K + s M)^-1 M,    B phi = phi / (w^2 + s)                                                              (1)
//! ```
//!
//! which is symmetric in the product `x^T M y`. New vectors are made orthogonal to all before, twice, so that none comes again. With the
//! coefficients `T` of `B V` over `V`, and a pair `T y = theta y` of the part that has been multiplied, the residual of a mode is what
//! `B V y` has outside of that part:
//!
//! ```text
//! | B V y - theta V y | = | T_outside y |                                                                      (2)
//! ```
//!
//! Source: Golub and Underwood (1977), The block Lanczos method for computing eigenvalues; Ericsson and Ruhe (1980), Math. Comp. 35,
//! 1251 (spectral transformation); Parlett (1998), The Symmetric Eigenvalue Problem, section 13.10.

use nalgebra::{DMatrix, DVector};

use crate::factor::Factor;
use crate::matrix::SparseMatrix;

/// Starting vectors: as many equal frequencies are found at once.
const STARTING: usize = 3;
/// Residual (2) of a mode, as a part of its `theta`.
const CONVERGED: f64 = 1e-11;
/// A vector is no new one if less than this part of it is left.
const DEPENDENT: f64 = 1e-12;

/// Vectors that are orthonormal in the product of the mass matrix.
#[derive(Debug)]
pub(crate) struct Basis<'m> {
    mass: &'m SparseMatrix,
    pub(crate) vectors: Vec<Vec<f64>>,
}

impl<'m> Basis<'m> {
    pub(crate) fn new(mass: &'m SparseMatrix, vectors: Vec<Vec<f64>>) -> Self {
        Self { mass, vectors }
    }

    /// The size of a vector; `None` where its square is negative.
    pub(crate) fn size(&self, x: &[f64]) -> Option<f64> {
        let square = dot(x, &self.mass.times(x));
        (square >= 0.0).then(|| square.sqrt())
    }

    /// Takes out of a vector what the others hold. Returns their coefficients.
    pub(crate) fn orthogonalise(&self, x: &mut [f64]) -> Vec<f64> {
        let mut coefficients = vec![0.0; self.vectors.len()];
        for _ in 0..2 {
            let product = self.mass.times(x);
            for (vector, total) in self.vectors.iter().zip(&mut coefficients) {
                let part = dot(vector, &product);
                *total += part;
                add(x, -part, vector);
            }
        }
        coefficients
    }

    /// Adds what a vector has besides the others, unless that is less than a part of it. Returns the coefficients of the vector.
    pub(crate) fn push(&mut self, mut x: Vec<f64>, least: f64) -> Option<Vec<f64>> {
        let before = self.size(&x)?;
        let mut coefficients = self.orthogonalise(&mut x);
        let left = self.size(&x)?;
        if left <= least * before {
            return Some(coefficients);
        }
        for x in &mut x {
            *x /= left;
        }
        self.vectors.push(x);
        coefficients.push(left);
        Some(coefficients)
    }
}

/// Why modes were not found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Missing {
    /// The mass matrix has a negative eigenvalue.
    Indefinite,
    /// So many were found.
    Found(usize),
    /// It was stopped.
    Cancelled,
}

/// As many of the lowest modes: squares of angular frequencies, ascending, and vectors.
pub(crate) fn lowest(
    factor: &Factor,
    mass: &SparseMatrix,
    shift: f64,
    count: usize,
    stop: &dyn Fn() -> bool,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), Missing> {
    let n = mass.rows();
    if count == 0 {
        return Ok((Vec::new(), Vec::new()));
    }
    let mut basis = Basis::new(mass, Vec::new());
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    for _ in 0..STARTING.min(n) {
        let start: Vec<f64> = (0..n).map(|_| random(&mut seed)).collect();
        // Without what the mass matrix does not see.
        let start = factor.solve(&mass.times(&start));
        basis.push(start, DEPENDENT).ok_or(Missing::Indefinite)?;
    }
    let most = n.min(8 * count + 120);
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut looked = 0;
    loop {
        if stop() {
            return Err(Missing::Cancelled);
        }
        let done = columns.len();
        let exhausted = done == basis.vectors.len();
        if exhausted || done >= most || done >= looked + 10 + looked / 4 {
            looked = done;
            let pairs = ritz(&columns, basis.vectors.len());
            let sound = pairs.iter().take(count);
            let sound = sound.filter(|pair| pair.residual <= CONVERGED * pair.theta.abs());
            let found = sound.count();
            if found == count {
                return Ok(modes(&pairs[..count], &basis, shift));
            }
            if exhausted || done >= most {
                return Err(Missing::Found(found));
            }
        }
        let image = factor.solve(&mass.times(&basis.vectors[done]));
        let coefficients = basis.push(image, DEPENDENT).ok_or(Missing::Indefinite)?;
        columns.push(coefficients);
    }
}

/// A pair of (2).
struct Pair {
    theta: f64,
    vector: DVector<f64>,
    residual: f64,
}

/// The pairs of the vectors that have been multiplied, those of the largest `theta` first.
fn ritz(columns: &[Vec<f64>], vectors: usize) -> Vec<Pair> {
    let done = columns.len();
    let entry = |i: usize, j: usize| columns[j].get(i).copied().unwrap_or(0.0);
    let inside = DMatrix::from_fn(done, done, |i, j| 0.5 * (entry(i, j) + entry(j, i)));
    let outside = DMatrix::from_fn(vectors - done, done, |i, j| entry(done + i, j));
    let eigen = inside.symmetric_eigen();
    let mut pairs: Vec<Pair> = (0..done)
        .map(|k| {
            let vector = eigen.eigenvectors.column(k).into_owned();
            Pair {
                theta: eigen.eigenvalues[k],
                residual: (&outside * &vector).norm(),
                vector,
            }
        })
        .collect();
    pairs.sort_by(|a, b| b.theta.total_cmp(&a.theta));
    pairs
}

fn modes(pairs: &[Pair], basis: &Basis<'_>, shift: f64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let squares = pairs.iter().map(|pair| 1.0 / pair.theta - shift).collect();
    let shape = |pair: &Pair| {
        let mut shape = vec![0.0; basis.vectors[0].len()];
        for (factor, vector) in pair.vector.iter().zip(&basis.vectors) {
            add(&mut shape, *factor, vector);
        }
        shape
    };
    (squares, pairs.iter().map(shape).collect())
}

/// Between minus one and one, the same in every run (`SplitMix64`).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut x = *seed;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ (x >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}

/// The product of two vectors, summed in eight lanes.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    let (a, b) = (x.chunks_exact(8), y.chunks_exact(8));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(x, y)| x * y).sum();
    for (x, y) in a.zip(b) {
        for ((lane, x), y) in lanes.iter_mut().zip(x).zip(y) {
            *lane += x * y;
        }
    }
    lanes.iter().sum::<f64>() + rest
}

/// `x + factor y`
pub(crate) fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += factor * y;
    }
}
