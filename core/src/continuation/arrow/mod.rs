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
//! Source: Golub and Van Loan (2013), Matrix Computations, section 3.2.6 (block elimination); Govaerts (2000), Numerical Methods for
//! Bifurcations of Dynamical Equilibria, chapter 3 (bordered systems, and when block elimination of them is stable).
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

pub(crate) mod links;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use multiversion::multiversion;

use self::links::{Basis, PairLink, PairLinks, Square};
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

/// Of one pair.
#[derive(Debug)]
struct Room {
    /// `K`, or `R`.
    response: [Vec<Group>; 2],
    /// `W`
    forms: [Vec<Group>; 2],
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
            room: Room {
                response: [one(), one()],
                forms: [one(), one()],
            },
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

/// `E_end .. E_0` of a pair.
fn whole(of: &PairLinks, pair: usize) -> Square {
    let start = [[1.0, 0.0], [0.0, 1.0]];
    let links = of.links.iter();
    links.fold(start, |whole, link| product(link.block(pair), whole))
}

fn minus([[a, b], [c, d]]: Square, sign: f64) -> Square {
    [[a - sign, b], [c, d - sign]]
}

#[inline(always)]
fn product(a: Square, b: Square) -> Square {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

#[inline(always)]
fn times(a: Square, x: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| a[i][0] * x[0] + a[i][1] * x[1])
}

#[inline(always)]
fn row_times(x: [f64; 2], a: Square) -> [f64; 2] {
    [0, 1].map(|j| x[0] * a[0][j] + x[1] * a[1][j])
}

/// (2), pair after pair.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn eliminate(to: &mut Arrow, of: &PairLinks) {
    let groups = to.values.len();
    let mut kept = 0;
    for pair in 0..of.pairs {
        let response = &mut to.room.response;
        respond(of, pair, to.others - 1, response);
        let place = 2 * pair * groups..2 * (pair + 1) * groups;
        let by_others = &mut to.by_others[place.clone()];
        let inverse = to.inverses[pair];
        let stays = to.kept.get(kept) == Some(&pair);
        if stays {
            for (i, row) in response.iter_mut().enumerate() {
                let entries = to.matrix.row_mut(2 * kept + i);
                entries[2 * to.kept.len()..].copy_from_slice(&row.as_flattened()[..to.others]);
                let own = minus(whole(of, pair), of.sign)[i];
                entries[2 * kept..2 * kept + 2].copy_from_slice(&own);
                row.fill([0.0; LANES]);
            }
        }
        let [first, second] = response;
        for (g, (x, y)) in first.iter_mut().zip(second).enumerate() {
            for l in 0..LANES {
                let [a, b] = times(inverse, [x[l], y[l]]);
                (by_others[g][l], by_others[groups + g][l]) = (a, b);
                (x[l], y[l]) = (-a, -b);
            }
        }
        read(of, pair, to.others - 1, &mut to.room, &mut to.sums);
        let Room { forms, .. } = &to.room;
        let of_states = &mut to.of_states[place];
        for g in 0..groups {
            for l in 0..LANES {
                let [a, b] = row_times([forms[0][g][l], forms[1][g][l]], inverse);
                (of_states[g][l], of_states[groups + g][l]) = (a, b);
            }
        }
        if stays {
            for (row, x) in forms[0].as_flattened()[..to.others].iter().enumerate() {
                let entries = to.matrix.row_mut(2 * to.kept.len() + row);
                entries[2 * kept] = *x;
                entries[2 * kept + 1] = forms[1].as_flattened()[row];
            }
            kept += 1;
        }
    }
}

/// What the others do to a pair until the end of all links, from rest: `K`.
#[inline(always)]
fn respond(of: &PairLinks, pair: usize, last: usize, response: &mut [Vec<Group>; 2]) {
    for row in response.iter_mut() {
        row.fill([0.0; LANES]);
    }
    for (index, link) in of.links.iter().enumerate() {
        go(link, [pair, of.others, last], response, index > 0);
    }
    let parameter = of.parameter.iter().skip(2 * pair);
    for (row, by) in response.iter_mut().zip(parameter) {
        row.as_flattened_mut()[last] += by;
    }
}

/// Adds what is read of a pair to the rows of `C`, from `R_0` on, and writes what is read of its states where the motion begins.
#[inline(always)]
fn read(of: &PairLinks, pair: usize, last: usize, room: &mut Room, sums: &mut [Group]) {
    let Room { response, forms } = room;
    for row in forms.iter_mut() {
        row.fill([0.0; LANES]);
    }
    let groups = response[0].len();
    let states = 2 * of.pairs;
    let mut whole = [[1.0, 0.0], [0.0, 1.0]];
    let mut reads = of.reads.iter().peekable();
    for (index, link) in of.links.iter().enumerate() {
        let rows = (of.others + link.first)..(of.others + link.first + link.count);
        let sums_of = sums[rows.start * groups..rows.end * groups].chunks_exact_mut(groups);
        for ((sums, by), row) in sums_of.zip(link.by_states.chunks_exact(states)).zip(rows) {
            let by = [by[2 * pair], by[2 * pair + 1]];
            add_form(by, response, sums);
            add_states(row_times(by, whole), row, forms);
        }
        go(link, [pair, of.others, last], response, true);
        whole = product(link.block(pair), whole);
        while let Some(read) = reads.next_if(|read| read.link == index) {
            let by = &of.factors[read.index * states + 2 * pair..][..2];
            let by = [by[0], by[1]];
            add_form(by, response, &mut sums[read.equation * groups..][..groups]);
            add_states(row_times(by, whole), read.equation, forms);
        }
    }
}

/// Adds a form of a pair to a row of `C`.
#[inline(always)]
fn add_form(by: [f64; 2], response: &[Vec<Group>; 2], sums: &mut [Group]) {
    for ((sum, x), y) in sums.iter_mut().zip(&response[0]).zip(&response[1]) {
        for l in 0..LANES {
            sum[l] += by[0] * x[l] + by[1] * y[l];
        }
    }
}

/// Adds it to a row of `W`.
#[inline(always)]
fn add_states(by: [f64; 2], row: usize, forms: &mut [Vec<Group>; 2]) {
    for (form, x) in forms.iter_mut().zip(by) {
        form.as_flattened_mut()[row] += x;
    }
}

/// Goes over a link.
#[inline(always)]
fn go(
    link: &PairLink,
    [pair, others, last]: [usize; 3],
    response: &mut [Vec<Group>; 2],
    begun: bool,
) {
    if begun {
        let block = link.block(pair);
        let [first, second] = &mut *response;
        for (x, y) in first.iter_mut().zip(second) {
            for l in 0..LANES {
                let [a, b] = times(block, [x[l], y[l]]);
                (x[l], y[l]) = (a, b);
            }
        }
    }
    for (i, row) in response.iter_mut().enumerate() {
        let row = row.as_flattened_mut();
        let state = 2 * pair + i;
        let driven = &link.driven[state * link.count..][..link.count];
        let own = &mut row[others + link.first..][..link.count];
        for (x, by) in own.iter_mut().zip(driven) {
            *x += by;
        }
        let slopes = link.slopes[state];
        for (ends, slope) in link.ends.iter().zip(slopes) {
            for &(other, factor) in ends {
                row[other] += slope * factor;
            }
        }
        row[last] += slopes[2];
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
