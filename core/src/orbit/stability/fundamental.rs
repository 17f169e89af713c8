//! The fundamental solution of the linearised equation as it is built up, step by step.

use nalgebra::{Complex, DMatrix};

use super::magnus::Magnus;
use super::product::eigenvalues_of_product;
use super::square::{self, Square};
use crate::model::rigid::Rigid;
use crate::numeric::spectrum::eigenvalues;
use crate::numeric::spectrum::{eigenvalues_of_two, spread};

/// The matrix `q L` of [`monodromy`](super::monodromy) is the error of `P` to about this factor.
const SAFETY: f64 = 1.5;

/// Rounding errors of a matrix, relative to its entries. A double multiplier moves by their root.
const ROUNDED: f64 = 1e-15;

/// Size of a multiplier, in parts of the matrix, below which it has lost half of its digits.
const LOST: f64 = 1e-8;

/// What has been integrated, for matrices of some order. Matrices are slices, column by column.
pub(super) trait Fundamental {
    /// Workspace for the matrix at one of the three nodes of a step, times the step.
    fn scaled(&mut self, node: usize) -> &mut [f64];

    /// A step in which the matrix is constant: that of the first node.
    fn constant(&mut self);

    /// A step with the matrices at the nodes.
    fn step(&mut self);

    /// The solution, and what the fourth order lacks in it, for a jump.
    fn matrices(&mut self) -> [&mut [f64]; 2];

    /// Multipliers of the solution, and their errors: by the steps, and by rounding.
    fn multipliers(&self) -> (Vec<Complex<f64>>, [f64; 2]);
}

/// Traces of the exponents, and sizes of commutators.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// `int trace A`
    trace: f64,
    /// `sum |C_k/12|` and `sum |D_k|`
    sizes: [f64; 2],
}

impl Sums {
    fn add(&mut self, trace: f64, sizes: [f64; 2]) {
        self.trace += trace;
        self.sizes[0] += sizes[0];
        self.sizes[1] += sizes[1];
    }

    /// What the steps leave in the multipliers of a matrix, from what the fourth order lacks in it.
    fn error(&self, multipliers: &[Complex<f64>], product: &[f64], lack: &[f64]) -> f64 {
        let part = SAFETY * self.part();
        if part == 0.0 {
            return 0.0;
        }
        spread(multipliers, product, |index| part * lack[index])
    }

    /// `q`
    fn part(&self) -> f64 {
        let [first, second] = self.sizes;
        if first > 0.0 {
            (second / first).min(1.0)
        } else {
            0.0
        }
    }
}

/// Of one coordinate.
#[derive(Debug)]
pub(super) struct FundamentalOfTwo {
    scaled: [Square; 3],
    product: Square,
    lack: Square,
    sums: Sums,
}

impl FundamentalOfTwo {
    pub(super) fn new() -> Self {
        Self {
            scaled: [[0.0; 4]; 3],
            product: square::IDENTITY,
            lack: [0.0; 4],
            sums: Sums::default(),
        }
    }
}

impl Fundamental for FundamentalOfTwo {
    fn scaled(&mut self, node: usize) -> &mut [f64] {
        &mut self.scaled[node]
    }

    fn constant(&mut self) {
        let propagator = square::exponential(self.scaled[0]);
        self.sums
            .add(self.scaled[0][0] + self.scaled[0][3], [0.0; 2]);
        self.product = square::product(&propagator, &self.product);
        self.lack = square::product(&propagator, &self.lack);
    }

    fn step(&mut self) {
        let step = square::step(&self.scaled);
        self.sums.add(step.trace, step.sizes);
        self.product = square::product(&step.propagator, &self.product);
        self.lack = square::product(&step.propagator, &self.lack);
        let lacking = square::product(&step.lack, &self.product);
        for (to, from) in self.lack.iter_mut().zip(lacking) {
            *to += from;
        }
    }

    fn matrices(&mut self) -> [&mut [f64]; 2] {
        [&mut self.product, &mut self.lack]
    }

    fn multipliers(&self) -> (Vec<Complex<f64>>, [f64; 2]) {
        let determinant = self.sums.trace.exp();
        let of = |[a, c, b, d]: Square| eigenvalues_of_two([[a, b], [c, d]], determinant);
        let Some(multipliers) = of(self.product) else {
            return (Vec::new(), [f64::INFINITY; 2]);
        };
        let by_steps = self.sums.error(&multipliers, &self.product, &self.lack);
        let rounded = |index: usize| ROUNDED * self.product[index];
        let by_rounding = spread(&multipliers, &self.product, rounded);
        (multipliers.to_vec(), [by_steps, by_rounding])
    }
}

/// Of several coordinates.
#[derive(Debug)]
pub(super) struct FundamentalOfMany {
    magnus: Magnus,
    product: DMatrix<f64>,
    lack: DMatrix<f64>,
    workspace: DMatrix<f64>,
    sums: Sums,
}

impl FundamentalOfMany {
    pub(super) fn new(order: usize) -> Self {
        let zeros = || DMatrix::zeros(order, order);
        Self {
            magnus: Magnus::new(order),
            product: zeros(),
            lack: zeros(),
            workspace: zeros(),
            sums: Sums::default(),
        }
    }

    pub(super) fn order(&self) -> usize {
        self.product.nrows()
    }

    /// Whether a multiplier has lost digits because it is smaller than the matrix.
    pub(super) fn has_lost(&self, multipliers: &[Complex<f64>]) -> bool {
        let lost = |last: &Complex<f64>| last.norm() < LOST * self.product.amax();
        multipliers.last().is_some_and(lost)
    }

    /// Takes what is known of rigid motions out of what has been integrated.
    pub(super) fn take_out(&mut self, rigid: &Rigid) {
        for matrix in [&mut self.product, &mut self.lack] {
            *matrix = rigid.taken_out_of(matrix);
        }
    }

    /// Begins anew.
    pub(super) fn begin(&mut self) {
        self.product.fill_with_identity();
        self.lack.fill(0.0);
        self.sums = Sums::default();
    }

    /// Multiplies by the propagator.
    fn advance(&mut self) {
        for matrix in [&mut self.product, &mut self.lack] {
            self.workspace
                .gemm(1.0, &self.magnus.propagator, matrix, 0.0);
            matrix.copy_from(&self.workspace);
        }
    }
}

impl Fundamental for FundamentalOfMany {
    fn scaled(&mut self, node: usize) -> &mut [f64] {
        self.magnus.scaled[node].as_mut_slice()
    }

    fn constant(&mut self) {
        self.magnus.constant();
        self.sums.add(self.magnus.scaled[0].trace(), [0.0; 2]);
        self.advance();
    }

    fn step(&mut self) {
        let sizes = self.magnus.step();
        self.sums.add(self.magnus.omega.trace(), sizes);
        self.advance();
        self.lack.gemm(1.0, &self.magnus.lack, &self.product, 1.0);
    }

    fn matrices(&mut self) -> [&mut [f64]; 2] {
        [self.product.as_mut_slice(), self.lack.as_mut_slice()]
    }

    fn multipliers(&self) -> (Vec<Complex<f64>>, [f64; 2]) {
        let multipliers = eigenvalues(&self.product);
        if multipliers.is_empty() {
            return (multipliers, [f64::INFINITY; 2]);
        }
        let (product, lack) = (self.product.as_slice(), self.lack.as_slice());
        let by_steps = self.sums.error(&multipliers, product, lack);
        // Eigenvalues are those of a matrix that differs by rounding errors of the largest entry.
        let rounded = ROUNDED * self.product.amax();
        let by_rounding = spread(&multipliers, product, |_| rounded);
        (multipliers, [by_steps, by_rounding])
    }
}

/// The factors of the solution, for multipliers that its matrix has lost.
#[derive(Debug)]
pub(super) struct FundamentalOfFactors {
    magnus: Magnus,
    done: Vec<DMatrix<f64>>,
    /// The product of the factors since, and the integral of its trace.
    factor: DMatrix<f64>,
    trace: f64,
    /// A jump needs a second matrix.
    nothing: [f64; 0],
}

/// Ratio of the largest entry to the mean size of the eigenvalues with which a factor is done.
const SPREAD: f64 = 30.0;
/// Norm of an exponent beyond which the exponential is divided.
const LONG: f64 = 2.0;

impl FundamentalOfFactors {
    pub(super) fn new(order: usize) -> Self {
        Self {
            magnus: Magnus::new(order),
            done: Vec::new(),
            factor: DMatrix::identity(order, order),
            trace: 0.0,
            nothing: [],
        }
    }

    fn advance(&mut self, trace: f64) {
        self.factor = &self.magnus.propagator * &self.factor;
        self.trace += trace;
        let order = self.factor.nrows();
        if self.factor.amax().ln() - self.trace / order as f64 > SPREAD.ln() {
            let next = DMatrix::identity(order, order);
            self.done.push(std::mem::replace(&mut self.factor, next));
            self.trace = 0.0;
        }
    }
}

/// The size of a matrix when displacements and velocities are scaled to be alike.
fn frequency(a: &DMatrix<f64>) -> f64 {
    let half = a.nrows() / 2;
    let size = |i, j| a.view((i, j), (half, half)).amax();
    (size(0, half) * size(half, 0)).sqrt() + size(half, half)
}

impl Fundamental for FundamentalOfFactors {
    fn scaled(&mut self, node: usize) -> &mut [f64] {
        self.magnus.scaled[node].as_mut_slice()
    }

    fn constant(&mut self) {
        let size = frequency(&self.magnus.scaled[0]) / LONG;
        let parts = if size > 1.0 {
            size.ceil().min(1e4)
        } else {
            1.0
        };
        self.magnus.scaled[0] /= parts;
        self.magnus.constant();
        let trace = self.magnus.scaled[0].trace();
        for _ in 0..parts as usize {
            self.advance(trace);
        }
    }

    fn step(&mut self) {
        self.magnus.step();
        let trace = self.magnus.omega.trace();
        self.advance(trace);
    }

    fn matrices(&mut self) -> [&mut [f64]; 2] {
        [self.factor.as_mut_slice(), &mut self.nothing]
    }

    fn multipliers(&self) -> (Vec<Complex<f64>>, [f64; 2]) {
        let factors = [&self.done[..], std::slice::from_ref(&self.factor)].concat();
        (eigenvalues_of_product(&factors), [0.0; 2])
    }
}
