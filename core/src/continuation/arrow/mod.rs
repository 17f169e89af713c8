//! Elimination of [pairs of states](links) before all other unknowns, so that the costs grow with their number and not with its cube.
//!
//! For the states `s` where the motion begins and the others `x`, those of links and the parameter among them, the equations are
//!
//! ```text
//! [ M  K ] [ s ]   [ T^-1 r ]
//! [ W  D ] [ x ] = [ q      ],    M = E_end .. E_0 - sign,    with blocks of order two                         (1)
//! ```
//!
//! Elimination of `s` leaves `C = D - W M^-1 K`, of which a column is what its unknown does where the states come back, since
//!
//! ```text
//! R_0 = -M^-1 K,    R_k+1 = E_k R_k + F_k + G_k,    C = sum_k (B_k + P_k) R_k + A + L + Q                      (2)
//! x = C^-1 (q - W M^-1 T^-1 r),    s = M^-1 T^-1 r - M^-1 K x                                                (3)
//! ```
//!
//! Pair after pair, so that what belongs to one is at hand; `M^-1 K` and `W M^-1` are kept for solutions, transposed ones too. Where a block of
//! `M` is nearly singular, as that of a free mass or of a mode in resonance that nothing damps, its pair stays among the others.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, section 3.2 (block elimination) and 2.1.4 (Sherman, Morrison and
//! Woodbury); Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 3 (bordered systems, and when block elimination of them is stable).

mod eliminate;
pub(crate) mod links;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use multiversion::multiversion;

use self::eliminate::{Room, eliminate, minus, row_times, times, whole};
use self::links::{Basis, PairLinks, Square};
use crate::numeric::linear::{Group, LANES, Lu, Matrix, Singular, dot};

/// A block `E - sign` of which the determinant is less than this part of the sizes of its terms stays among the others: its inverse has as many
/// digits less.
const NEAR: f64 = 1e-5;

/// Factors of (1), with a border as its last row.
#[derive(Debug)]
pub(crate) struct Arrow {
    pairs: usize,
    /// Number of `x`.
    others: usize,
    /// Of those, unknowns of links; and multiplications of a factorisation, about.
    inner: usize,
    operations: u64,
    basis: Arc<Basis>,
    /// `M^-1`; zero of a pair that stays.
    inverses: Vec<Square>,
    /// Sign of the determinant of `M`, and logarithm of its size.
    determinant: (f64, f64),
    /// Pairs that stay: their states come first among the unknowns that are left.
    kept: Vec<usize>,
    /// `M^-1 K` and `(W M^-1)^T`, state by state in whole groups.
    by_others: Vec<Group>,
    of_states: Vec<Group>,
    /// `C` row by row, while it is made.
    sums: Vec<Group>,
    matrix: Matrix,
    lu: Lu,
    room: Room,
    /// Of the states, of the others, and of all that are left.
    states: Vec<f64>,
    values: Vec<Group>,
    left: Vec<f64>,
}

impl Arrow {
    /// Room for so many pairs and unknowns, without the parameter.
    pub(crate) fn new(pairs: usize, unknowns: usize) -> Self {
        let others = unknowns + 1 - 2 * pairs;
        let groups = others.div_ceil(LANES);
        let one = || vec![[0.0; LANES]; groups];
        Self {
            pairs,
            others,
            inner: 0,
            operations: 0,
            basis: Arc::default(),
            inverses: vec![[[0.0; 2]; 2]; pairs],
            determinant: (1.0, 0.0),
            kept: Vec::with_capacity(pairs),
            by_others: vec![[0.0; LANES]; 2 * pairs * groups],
            of_states: vec![[0.0; LANES]; 2 * pairs * groups],
            sums: vec![[0.0; LANES]; others * groups],
            matrix: Matrix::zeros(others),
            lu: Lu::new(others),
            room: Room::new(groups),
            states: vec![0.0; 2 * pairs],
            values: one(),
            left: vec![0.0; others],
        }
    }

    /// Multiplications of a factorisation, about.
    pub(crate) fn operations(&self) -> u64 {
        self.operations
    }

    fn groups(&self) -> usize {
        self.values.len()
    }

    /// Eliminates the states from equations that are written: what is left has room for a border.
    pub(crate) fn take(&mut self, of: &mut PairLinks) {
        of.reads
            .sort_unstable_by_key(|read| (read.link, read.index));
        self.basis.clone_from(&of.basis);
        (self.inner, self.operations) = (of.inner, of.operations());
        self.invert(of);
        self.sums.fill([0.0; LANES]);
        self.add_direct(of);
        let kept = 2 * self.kept.len();
        let order = kept + self.others;
        if self.lu.order() != order {
            self.matrix = Matrix::zeros(order);
            self.lu = Lu::new(order);
            self.left.resize(order, 0.0);
        }
        self.matrix.clear();
        eliminate(self, of);
        let groups = self.groups();
        for (row, sums) in self.sums.chunks_exact(groups).enumerate() {
            self.matrix.row_mut(kept + row)[kept..]
                .copy_from_slice(&sums.as_flattened()[..self.others]);
        }
    }

    /// `M^-1`, where there is one.
    fn invert(&mut self, of: &PairLinks) {
        self.kept.clear();
        self.determinant = (1.0, 0.0);
        for (pair, inverse) in self.inverses.iter_mut().enumerate() {
            let whole = whole(of, pair);
            let [[a, b], [c, d]] = minus(whole, of.sign);
            let determinant = a * d - b * c;
            let size = (1.0 + whole[0][0].abs()) * (1.0 + whole[1][1].abs()) + (b * c).abs();
            // What is not a number stays, and is found.
            if determinant.abs() > NEAR * size {
                let by = 1.0 / determinant;
                *inverse = [[by * d, -by * b], [-by * c, by * a]];
                let (sign, logarithm) = self.determinant;
                self.determinant = (
                    sign * determinant.signum(),
                    logarithm + determinant.abs().ln(),
                );
            } else {
                *inverse = [[0.0; 2]; 2];
                self.kept.push(pair);
            }
        }
    }

    /// What of `C` is not through states.
    fn add_direct(&mut self, of: &PairLinks) {
        let groups = self.groups();
        let (z, last) = (of.others, self.others - 1);
        let mut rows = self.sums.chunks_exact_mut(groups);
        let mut write = |own: &[f64], first: usize, direct: &[f64]| {
            let Some(row) = rows.next() else { return };
            let row = row.as_flattened_mut();
            row[z + first..][..own.len()].copy_from_slice(own);
            row[..z].copy_from_slice(&direct[..z]);
            row[last] = direct[z];
        };
        for direct in of.direct.chunks_exact(z + 1) {
            write(&[], 0, direct);
        }
        for link in &of.links {
            let count = link.count.max(1);
            let rows = link.own.chunks_exact(count);
            for (own, direct) in rows.zip(link.direct.chunks_exact(z + 1)) {
                write(own, link.first, direct);
            }
        }
        let rows = self.sums.chunks_exact_mut(groups);
        for (row, by) in rows.zip(of.parameter.iter().skip(2 * of.pairs)) {
            row.as_flattened_mut()[last] += by;
        }
    }

    /// Writes the last row, over the extended unknowns.
    pub(crate) fn set_border(&mut self, values: &[f64]) {
        let (order, groups, kept) = (2 * self.pairs, self.groups(), 2 * self.kept.len());
        let last = self.others - 1;
        self.basis
            .to
            .times_transposed(&values[..order], &mut self.states);
        let row = self.matrix.row_mut(kept + last);
        for (index, pair) in self.kept.iter().enumerate() {
            row[2 * index..2 * index + 2].copy_from_slice(&self.states[2 * pair..2 * pair + 2]);
        }
        self.values.fill([0.0; LANES]);
        self.values.as_flattened_mut()[..self.others].copy_from_slice(&values[order..]);
        add_rows(&self.by_others, -1.0, &self.states, &mut self.values);
        row[kept..].copy_from_slice(&self.values.as_flattened()[..self.others]);
        let (group, lane) = (last / LANES, last % LANES);
        for (pair, inverse) in self.inverses.iter().enumerate() {
            let of = [self.states[2 * pair], self.states[2 * pair + 1]];
            for (j, x) in row_times(of, *inverse).into_iter().enumerate() {
                self.of_states[(2 * pair + j) * groups + group][lane] = x;
            }
        }
    }

    /// Measures the others in their units.
    pub(crate) fn scale_columns(&mut self, units: &[f64]) {
        let kept = 2 * self.kept.len();
        let units = &units[2 * self.pairs..];
        for row in 0..kept + self.others {
            for (x, unit) in self.matrix.row_mut(row)[kept..].iter_mut().zip(units) {
                *x *= unit;
            }
        }
    }

    /// Factorises what is left.
    ///
    /// # Errors
    /// [`Singular`], with the column there.
    pub(crate) fn factorise(&mut self) -> Result<(), Singular> {
        self.lu.factorise(&mut self.matrix)
    }

    /// The largest entry of that equation of those that are left, the border aside, whose largest entry is smallest.
    pub(crate) fn smallest_equation(&self) -> f64 {
        self.lu.smallest_row()
    }

    /// Sign of the determinant of all equations, and logarithm of its size, where unknowns of links are in no units.
    pub(crate) fn determinant(&self, units: &[f64]) -> (f64, f64) {
        let (order, last) = (2 * self.pairs, units.len() - 1);
        let logarithm = |units: &[f64]| units.iter().map(|unit| unit.ln()).sum::<f64>();
        let scaled = logarithm(&units[..order]) - logarithm(&units[last - self.inner..last]);
        let own = self.lu.determinant(&self.matrix);
        let (sign, size) = self.determinant;
        (sign * own.0, size + own.1 + scaled)
    }

    /// (3) for an extended vector, in place.
    pub(crate) fn solve(&mut self, vector: &mut [f64], units: &[f64]) {
        let (order, kept) = (2 * self.pairs, 2 * self.kept.len());
        let (own, others) = vector.split_at_mut(order);
        self.basis.from.times(own, &mut self.states);
        for (index, pair) in self.kept.iter().enumerate() {
            self.left[2 * index..2 * index + 2]
                .copy_from_slice(&self.states[2 * pair..2 * pair + 2]);
        }
        self.gather(others);
        add_rows(&self.of_states, -1.0, &self.states, &mut self.values);
        self.left[kept..].copy_from_slice(&self.values.as_flattened()[..self.others]);
        self.lu.solve(&self.matrix, &mut self.left);
        others.copy_from_slice(&self.left[kept..]);
        self.gather(others);
        for (x, unit) in self
            .values
            .as_flattened_mut()
            .iter_mut()
            .zip(&units[order..])
        {
            *x *= unit;
        }
        for (states, inverse) in self.states.chunks_exact_mut(2).zip(&self.inverses) {
            let known = [states[0], states[1]];
            states.copy_from_slice(&times(*inverse, known));
        }
        take_products(&self.by_others, &self.values, &mut self.states);
        self.give_kept();
        self.basis.to.times(&self.states, own);
        for (x, unit) in own.iter_mut().zip(units) {
            *x /= unit;
        }
    }

    /// The transposed system, in place.
    pub(crate) fn solve_transposed(&mut self, vector: &mut [f64], units: &[f64]) {
        let (order, kept) = (2 * self.pairs, 2 * self.kept.len());
        let (own, others) = vector.split_at_mut(order);
        for (x, unit) in own.iter_mut().zip(units) {
            *x /= unit;
        }
        self.basis.to.times_transposed(own, &mut self.states);
        for (index, pair) in self.kept.iter().enumerate() {
            self.left[2 * index..2 * index + 2]
                .copy_from_slice(&self.states[2 * pair..2 * pair + 2]);
        }
        self.values.fill([0.0; LANES]);
        add_rows(&self.by_others, -1.0, &self.states, &mut self.values);
        let through = self.values.as_flattened().iter();
        let known = others.iter().zip(&units[order..]).zip(through);
        for (to, ((x, unit), through)) in self.left[kept..].iter_mut().zip(known) {
            *to = x + unit * through;
        }
        self.lu.solve_transposed(&self.matrix, &mut self.left);
        others.copy_from_slice(&self.left[kept..]);
        self.gather(others);
        for (states, inverse) in self.states.chunks_exact_mut(2).zip(&self.inverses) {
            let known = [states[0], states[1]];
            states.copy_from_slice(&row_times(known, *inverse));
        }
        take_products(&self.of_states, &self.values, &mut self.states);
        self.give_kept();
        self.basis.from.times_transposed(&self.states, own);
    }

    /// Writes the others in whole groups.
    fn gather(&mut self, others: &[f64]) {
        self.values.fill([0.0; LANES]);
        self.values.as_flattened_mut()[..others.len()].copy_from_slice(others);
    }

    /// States that stay are among what is left.
    fn give_kept(&mut self) {
        for (index, pair) in self.kept.iter().enumerate() {
            self.states[2 * pair..2 * pair + 2]
                .copy_from_slice(&self.left[2 * index..2 * index + 2]);
        }
    }
}

/// Adds a multiple of the product of a row over the states and what stands state by state.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_rows(rows: &[Group], factor: f64, states: &[f64], to: &mut [Group]) {
    for (row, x) in rows.chunks_exact(to.len()).zip(states) {
        let x = factor * x;
        for (to, of) in to.iter_mut().zip(row) {
            for l in 0..LANES {
                to[l] += x * of[l];
            }
        }
    }
}

/// Takes from every state its row times the others.
fn take_products(rows: &[Group], others: &[Group], states: &mut [f64]) {
    for (row, x) in rows.chunks_exact(others.len()).zip(states) {
        *x -= dot(row.as_flattened(), others.as_flattened());
    }
}
