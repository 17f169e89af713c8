//! Dense factorisation and one solution, three ways: `cargo run --release` in this folder.
//!
//! Each contender copies the matrix, factorises it and solves for one right side. Ours and faer copy into room at hand
//! and allocate nothing; nalgebra takes its matrix by value, so its copy is a new one, as Newton's loop would need. faer
//! is called through its low-level interface, in place, on one thread. All run in turns, so that a change of the
//! processor's frequency meets all alike; medians are compared.

use std::hint::black_box;
use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::{Mat, Par};
use linear::{Lu, Matrix};
use nalgebra::{DMatrix, DVector};

// The module is private to the runtime; what the benchmark does not call is not a mistake here.
#[allow(dead_code, unused_imports)]
#[path = "../../../core/src/numeric/linear/mod.rs"]
mod linear;

const ORDERS: [usize; 6] = [11, 21, 41, 81, 161, 321];
/// Turns of each contender; the median is taken over them.
const TURNS: usize = 101;
/// Multiply-adds per turn, so that a turn is long compared with the resolution of the clock.
const WORK: usize = 4_000_000;

/// A matrix of an order.
type Make = fn(usize) -> DMatrix<f64>;

fn main() {
    println!("microseconds to factorise and solve once, medians of {TURNS} turns");
    println!(
        "{:<10}{:>5}{:>10}{:>10}{:>10}{:>16}{:>12}",
        "matrix", "n", "own", "nalgebra", "faer", "nalgebra / own", "faer / own"
    );
    for (name, make) in [("random", random as Make), ("jacobian", jacobian)] {
        for n in ORDERS {
            let [own, nalgebra, faer] = compare(&make(n));
            println!(
                "{name:<10}{n:>5}{own:>10.2}{nalgebra:>10.2}{faer:>10.2}{:>16.2}{:>12.2}",
                nalgebra / own,
                faer / own
            );
        }
    }
}

/// Median times in microseconds.
fn compare(matrix: &DMatrix<f64>) -> [f64; 3] {
    let n = matrix.nrows();
    let calls = (WORK / n.pow(3)).max(1);
    let mut contenders: [Box<dyn Contender>; 3] = [
        Box::new(Own::new(matrix)),
        Box::new(Nalgebra::new(matrix)),
        Box::new(Faer::new(matrix)),
    ];
    let right = DVector::from_fn(n, |i, _| 1.0 + (i as f64).sin());
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..TURNS {
        for (contender, times) in contenders.iter_mut().zip(&mut times) {
            let start = Instant::now();
            for _ in 0..calls {
                contender.run(black_box(right.as_slice()));
            }
            times.push(start.elapsed().as_secs_f64());
        }
    }
    for contender in &contenders {
        let residual = (matrix * DVector::from_column_slice(contender.solution()) - &right).amax();
        assert!(residual < 1e-9, "a residual of {residual:e}");
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        1e6 * times[TURNS / 2] / calls as f64
    })
}

/// Factorises a copy of a matrix and solves.
trait Contender {
    fn run(&mut self, right: &[f64]);
    fn solution(&self) -> &[f64];
}

struct Own {
    source: Matrix,
    matrix: Matrix,
    lu: Lu,
    solution: Vec<f64>,
}

impl Own {
    fn new(source: &DMatrix<f64>) -> Self {
        let n = source.nrows();
        let mut matrix = Matrix::zeros(n);
        for row in 0..n {
            for (to, from) in matrix.row_mut(row).iter_mut().zip(source.row(row).iter()) {
                *to = *from;
            }
        }
        Self {
            source: matrix,
            matrix: Matrix::zeros(n),
            lu: Lu::new(n),
            solution: vec![0.0; n],
        }
    }
}

impl Contender for Own {
    fn run(&mut self, right: &[f64]) {
        self.matrix.clone_from(&self.source);
        self.solution.copy_from_slice(right);
        let done = self.lu.factorise(&mut self.matrix);
        assert!(done.is_ok());
        self.lu.solve(&self.matrix, &mut self.solution);
    }

    fn solution(&self) -> &[f64] {
        &self.solution
    }
}

struct Nalgebra {
    source: DMatrix<f64>,
    solution: DVector<f64>,
}

impl Nalgebra {
    fn new(source: &DMatrix<f64>) -> Self {
        Self {
            source: source.clone(),
            solution: DVector::zeros(source.nrows()),
        }
    }
}

impl Contender for Nalgebra {
    fn run(&mut self, right: &[f64]) {
        self.solution.as_mut_slice().copy_from_slice(right);
        let done = self.source.clone().lu().solve_mut(&mut self.solution);
        assert!(done);
    }

    fn solution(&self) -> &[f64] {
        self.solution.as_slice()
    }
}

struct Faer {
    source: Mat<f64>,
    matrix: Mat<f64>,
    order: Vec<usize>,
    place: Vec<usize>,
    scratch: MemBuffer,
    solution: Mat<f64>,
}

impl Faer {
    fn new(source: &DMatrix<f64>) -> Self {
        let n = source.nrows();
        let params = faer::prelude::default();
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, params)
            .or(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        Self {
            source: Mat::from_fn(n, n, |i, j| source[(i, j)]),
            matrix: Mat::zeros(n, n),
            order: vec![0; n],
            place: vec![0; n],
            scratch: MemBuffer::new(scratch),
            solution: Mat::zeros(n, 1),
        }
    }
}

impl Contender for Faer {
    fn run(&mut self, right: &[f64]) {
        self.matrix.copy_from(&self.source);
        self.solution.col_as_slice_mut(0).copy_from_slice(right);
        let (_, rows) = factor::lu_in_place(
            self.matrix.as_mut(),
            &mut self.order,
            &mut self.place,
            Par::Seq,
            MemStack::new(&mut self.scratch),
            faer::prelude::default(),
        );
        solve::solve_in_place(
            self.matrix.as_ref(),
            self.matrix.as_ref(),
            rows,
            self.solution.as_mut(),
            Par::Seq,
            MemStack::new(&mut self.scratch),
        );
    }

    fn solution(&self) -> &[f64] {
        self.solution.col_as_slice(0)
    }
}

/// Entries between -1 and 1, so that almost every column exchanges rows.
fn random(n: usize) -> DMatrix<f64> {
    // Source of the numbers: Marsaglia (2003), Xorshift RNGs, the triple 13, 7, 17.
    let mut state = 88_172_645_463_325_252_u64;
    DMatrix::from_fn(n, n, |_, _| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

/// The balance of one coordinate with a contact: `1 - k^2 omega^2` and damping by harmonics, and a stiffness whose
/// series falls as one over the square of the harmonic.
fn jacobian(n: usize) -> DMatrix<f64> {
    let (omega, damping) = (0.73_f64, 0.05);
    let stiffness = |m: usize| 0.4 / (1.0 + (m * m) as f64);
    DMatrix::from_fn(n, n, |i, j| {
        let (k, m) = (i.div_ceil(2), j.div_ceil(2));
        let mut entry = 0.0;
        if k == 0 || m == 0 || i % 2 == j % 2 {
            let sign = if i % 2 == 0 && i > 0 { -1.0 } else { 1.0 };
            entry += stiffness(k.abs_diff(m)) + sign * stiffness(k + m);
        }
        if k == m {
            let rate = k as f64 * omega;
            if i == j {
                entry += 1.0 - rate * rate;
            } else {
                entry += if i < j {
                    damping * rate
                } else {
                    -damping * rate
                };
            }
        }
        entry
    })
}
