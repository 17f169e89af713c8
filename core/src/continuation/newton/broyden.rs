//! Updates that learn from those before.
//!
//! A matrix `B` that is kept, or leaves something out, makes updates that shrink at a steady rate. Broyden's method corrects `B`
//! after each update so that it would have predicted the residual behind it. With `d_j` the updates so far, from the first one,
//! and `r` the residual, the next one is
//!
//! ```text
//! z = B^-1 r;   z += (d_j . z / d_j . d_j) d_(j+1),  j = 0 .. k - 2;   d_k = z / (1 - d_(k-1) . z / d_(k-1) . d_(k-1))  (1)
//! ```
//!
//! which needs products of vectors only. For equations that are linear it ends after finitely many steps.
//!
//! Source: Kelley (1995), Iterative Methods for Linear and Nonlinear Equations, section 7.3 (algorithm brsol).

use crate::continuation::problem::{Norm, Scale};

/// Updates that are remembered.
const MOST: usize = 8;
/// Where the last update predicts more than this part of the next one, it says nothing of where the solution is.
const STEADY: f64 = 0.8;

/// The updates since a matrix was made.
#[derive(Debug)]
pub(super) struct Broyden {
    /// The updates `d_j`, one after the other.
    updates: Vec<f64>,
    /// `d_j . d_j`
    squares: [f64; MOST],
    count: usize,
}

impl Broyden {
    /// Room for vectors of this length.
    pub(super) fn new(length: usize) -> Self {
        Self {
            updates: vec![0.0; MOST * length],
            squares: [0.0; MOST],
            count: 0,
        }
    }

    /// Forgets all updates: there is another matrix.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Makes `B^-1 r` the next update, (1).
    pub(super) fn improve(&self, norm: &Norm, scale: Scale, z: &mut [f64]) {
        let length = z.len();
        let known = self.updates.chunks_exact(length).zip(self.squares);
        let mut known = known.take(self.count).peekable();
        while let Some((update, square)) = known.next() {
            let part = norm.product(scale, update, z) / square;
            match known.peek() {
                Some((next, _)) => add(z, part, next),
                None if part < STEADY => {
                    for x in z.iter_mut() {
                        *x /= 1.0 - part;
                    }
                }
                None => {}
            }
        }
    }

    /// Remembers an update that was made. When there is no more room, the oldest ones are forgotten, and with them what they
    /// told.
    pub(super) fn remember(&mut self, norm: &Norm, scale: Scale, update: &[f64]) {
        if self.count == MOST {
            self.count = 0;
        }
        let square = norm.product(scale, update, update);
        if square > 0.0 {
            self.updates[self.count * update.len()..][..update.len()].copy_from_slice(update);
            self.squares[self.count] = square;
            self.count += 1;
        }
    }
}

fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    for (x, y) in to.iter_mut().zip(from) {
        *x += factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::jacobian::Jacobian;
    use crate::continuation::problem::Problem;

    /// Three linear equations.
    struct Linear;

    const MATRIX: [[f64; 3]; 3] = [[2.0, 0.9, -0.3], [0.4, 3.0, 0.8], [-0.7, 0.5, 1.5]];

    impl Problem for Linear {
        fn unknowns(&self) -> usize {
            3
        }

        fn evaluate(&mut self, u: &[f64], residual: &mut [f64], _jacobian: Option<&mut Jacobian>) {
            for (r, row) in residual.iter_mut().zip(MATRIX) {
                *r = row.iter().zip(u).map(|(a, x)| a * x).sum::<f64>() - 1.0;
            }
        }

        fn weights(&self, weights: &mut [f64]) {
            weights.fill(1.0);
        }

        fn is_mean(&self, _unknown: usize) -> bool {
            false
        }
    }

    /// With the diagonal for `B`, updates shrink by less than a half each. Broyden's method ends after `2 n` of them (Gay (1979),
    /// Some convergence properties of Broyden's method).
    #[test]
    fn linear_equations_end() {
        let norm = Norm::of(&Linear);
        let mut memory = Broyden::new(4);
        let (mut u, mut residual) = ([0.0; 4], [0.0; 4]);
        let mut sizes = Vec::new();
        for _ in 0..7 {
            Linear.evaluate(&u, &mut residual[..3], None);
            let mut update = residual;
            for i in 0..3 {
                update[i] /= MATRIX[i][i];
            }
            memory.improve(&norm, Scale::UNIT, &mut update);
            for i in 0..3 {
                u[i] -= update[i];
            }
            sizes.push(norm.length(Scale::UNIT, &update));
            memory.remember(&norm, Scale::UNIT, &update);
        }
        assert!(sizes[6] < 1e-13, "{sizes:?}");
    }
}
