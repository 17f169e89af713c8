//! Unknowns that are eliminated link by link, each from its own equations.
//!
//! A motion that is cut in pieces has many unknowns on each, which know of the pieces before through a few states `s` only. With the unknowns
//! `x_k` of link `k`, and `z` for all others and the parameter,
//!
//! ```text
//! A_k x_k + B_k s_k + L_k z = r_k                                                                             (1)
//! s_k+1 = E_k s_k + F_k x_k + G_k z,    s_0 = S_0 z                                                           (2)
//! sum_k P_ik s_k + Q_i z = r_i                                                                                (3)
//! ```
//!
//! where (3) are the other equations. Elimination of `x_k` leaves `s_k = S_k z + c_k` with
//!
//! ```text
//! D_k = A_k^-1 (B_k S_k + L_k),    h_k = A_k^-1 (r_k - B_k c_k),    x_k = h_k - D_k z                         (4)
//! S_k+1 = E_k S_k + G_k - F_k D_k,    c_k+1 = E_k c_k + F_k h_k                                               (5)
//! ```
//!
//! so that no factorisation is larger than a link. Whoever makes (1) has `S_k` and passes it on. Where a link couples states in pairs only, `E_k` has
//! blocks of order two, and what it does to a state costs as little as there are in its block.
//!
//! Source: Doedel, Keller and Kernevez (1991), Numerical analysis and control of bifurcation problems (II), section 2.5 (condensation of
//! parameters in collocation).

#[cfg(test)]
mod tests;

use std::ops::Range;

use multiversion::multiversion;

use crate::numeric::linear::{
    Group, LANES, Lu, Matrix, Placed, Singular, add_product, dot, times_columns,
};

/// What a link has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    /// Unknowns.
    pub(crate) count: usize,
    /// Its `E` couples all states, and not those of a pair alone.
    pub(crate) couples: bool,
}

/// One link.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    size: Size,
    /// Entries of a row of `E`.
    width: usize,
    /// `A`, factorised by [`Link::eliminate`].
    matrix: Matrix,
    lu: Lu,
    /// `B`, row by row.
    by_states: Vec<f64>,
    /// `E` row by row, of each what is in its block; and `F` row by row.
    carried: Vec<f64>,
    driven: Vec<f64>,
    /// `L` row by row in whole groups, and `D` column by column.
    direct: Vec<f64>,
    through: Vec<f64>,
}

/// A term of (3).
#[derive(Debug, Clone, Copy)]
struct Read {
    equation: usize,
    /// Of the states behind it.
    link: usize,
}

/// All links.
#[derive(Debug, Default)]
pub(crate) struct Chain {
    states: usize,
    /// Other unknowns, and the parameter.
    columns: usize,
    links: Vec<Link>,
    reads: Vec<Read>,
    /// `P`, read by read.
    factors: Vec<f64>,
    /// A link whose unknowns do not follow from its equations, if there is one.
    singular: Option<Singular>,
    /// States behind every link.
    room: Vec<f64>,
    /// Those at a link, and at the next.
    at: Vec<f64>,
    next: Vec<f64>,
    /// Some columns of `D`, row by row, and of `S`.
    solved: Vec<Group>,
    known: Vec<Group>,
    placed: Vec<Placed>,
}

impl Size {
    /// Entries of a row of `E`.
    fn width(self, states: usize) -> usize {
        if self.couples { states } else { 2 }
    }

    /// The state that the first of them belongs to.
    fn first(self, row: usize) -> usize {
        if self.couples { 0 } else { row - row % 2 }
    }
}

impl Link {
    fn new(size: Size, states: usize, columns: usize) -> Self {
        let count = size.count;
        Self {
            size,
            width: size.width(states).max(1),
            matrix: Matrix::zeros(count),
            lu: Lu::new(count),
            by_states: vec![0.0; count * states],
            carried: vec![0.0; states * size.width(states)],
            driven: vec![0.0; states * count],
            direct: vec![0.0; count * columns.next_multiple_of(LANES)],
            through: vec![0.0; columns * count],
        }
    }

    fn count(&self) -> usize {
        self.lu.order()
    }

    /// A row of `E`, and the states that it is of.
    fn carried(&self, row: usize) -> (&[f64], Range<usize>) {
        let (width, first) = (self.width, self.size.first(row));
        (&self.carried[row * width..][..width], first..first + width)
    }

    /// Takes the factors of another one of the same size.
    fn take_over(&mut self, of: &Self) {
        self.matrix.clone_from(&of.matrix);
        self.lu.clone_from(&of.lu);
        self.by_states.clone_from(&of.by_states);
        self.carried.clone_from(&of.carried);
        self.driven.clone_from(&of.driven);
        self.through.clone_from(&of.through);
    }

    /// One of (1), to be written: rows of `A`, `B` and `L`.
    pub(crate) fn equation_mut(&mut self, row: usize) -> [&mut [f64]; 3] {
        let count = self.count().max(1);
        let states = self.by_states.len() / count;
        let stride = self.direct.len() / count;
        let columns = self.through.len() / count;
        [
            self.matrix.row_mut(row),
            &mut self.by_states[row * states..][..states],
            &mut self.direct[row * stride..][..columns],
        ]
    }

    /// One of (2), to be written: rows of `E`, of which there is what is in a block, and of `F`.
    pub(crate) fn state_mut(&mut self, row: usize) -> [&mut [f64]; 2] {
        let (width, count) = (self.width, self.count());
        [
            &mut self.carried[row * width..][..width],
            &mut self.driven[row * count..][..count],
        ]
    }

    /// All rows of `E`, to be written, of a link that couples all states.
    pub(crate) fn all_carried_mut(&mut self) -> &mut [f64] {
        &mut self.carried
    }

    /// Everything is zero, but that states go on as they are.
    pub(crate) fn clear(&mut self) {
        self.matrix.clear();
        let all = [&mut self.by_states, &mut self.driven, &mut self.direct];
        for of in all {
            of.fill(0.0);
        }
        let (width, size) = (self.width, self.size);
        for (row, entries) in self.carried.chunks_exact_mut(width).enumerate() {
            entries.fill(0.0);
            entries[row - size.first(row)] = 1.0;
        }
    }

    /// `E S` of (5), added.
    fn carry(&self, states: &[f64], next: &mut [f64], columns: usize, placed: &mut Vec<Placed>) {
        if self.size.couples {
            add_product(&self.carried, states, columns, next, placed);
            return;
        }
        for (row, to) in next.chunks_exact_mut(columns).enumerate() {
            let (carried, of) = self.carried(row);
            let of = states[of.start * columns..of.end * columns].chunks_exact(columns);
            for (factor, of) in carried.iter().zip(of) {
                if *factor != 0.0 {
                    for (to, of) in to.iter_mut().zip(of) {
                        *to += factor * of;
                    }
                }
            }
        }
    }

    /// (4) and (5) for `S` row by row, to which `G` is added by whoever knows it; there is room for some columns of `D` and `S`.
    fn eliminate(
        &mut self,
        states: &[f64],
        next: &mut [f64],
        [solved, known]: [&mut Vec<Group>; 2],
        placed: &mut Vec<Placed>,
    ) -> Result<(), Singular> {
        let count = self.count();
        let columns = states.len() / (self.carried.len() / self.width).max(1);
        self.carry(states, next, columns, placed);
        if count == 0 {
            return Ok(());
        }
        self.lu.factorise(&mut self.matrix)?;
        let stride = self.direct.len() / count;
        for first in (0..columns).step_by(LANES) {
            let width = LANES.min(columns - first);
            known.clear();
            known.extend(states.chunks_exact(columns).map(|row| {
                let mut group = [0.0; LANES];
                group[..width].copy_from_slice(&row[first..][..width]);
                group
            }));
            solved.clear();
            let direct = self.direct.chunks_exact(stride);
            let direct = direct.map(|row| row[first..].as_chunks().0[0]);
            solved.extend(direct);
            add_products(&self.by_states, known, solved);
            self.lu.solve_groups(&self.matrix, solved);
            let through = self.through[first * count..].chunks_exact_mut(count);
            for (l, column) in through.take(width).enumerate() {
                for (to, of) in column.iter_mut().zip(&*solved) {
                    *to = of[l];
                }
            }
            let rows = self.driven.chunks_exact(count);
            for (driven, to) in rows.zip(next.chunks_exact_mut(columns)) {
                let sum = times_columns(driven, solved);
                for (to, sum) in to[first..].iter_mut().zip(sum) {
                    *to -= sum;
                }
            }
        }
        Ok(())
    }
}

/// Adds the products of every row with some columns.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_products(rows: &[f64], columns: &[Group], to: &mut [Group]) {
    for (row, to) in rows.chunks_exact(columns.len()).zip(to) {
        for (factor, of) in row.iter().zip(columns) {
            for l in 0..LANES {
                to[l] += factor * of[l];
            }
        }
    }
}

impl Chain {
    /// Of links of these sizes, between so many states, beside so many other unknowns.
    pub(crate) fn new(sizes: impl Iterator<Item = Size>, states: usize, unknowns: usize) -> Self {
        let columns = unknowns + 1;
        let links: Vec<Link> = sizes.map(|of| Link::new(of, states, columns)).collect();
        Self {
            states,
            columns,
            room: vec![0.0; links.len() * states],
            at: vec![0.0; states],
            next: vec![0.0; states],
            solved: Vec::with_capacity(links.iter().map(Link::count).max().unwrap_or(0)),
            known: Vec::with_capacity(states),
            placed: Vec::with_capacity(states),
            links,
            reads: Vec::new(),
            factors: Vec::new(),
            singular: None,
        }
    }

    /// Takes the factors of another one over, in place where that has the same sizes.
    pub(crate) fn take_over(&mut self, of: &Self) {
        let alike = self.sizes().eq(of.sizes());
        if !alike || (self.states, self.columns) != (of.states, of.columns) {
            *self = Self::new(of.sizes(), of.states, of.columns - 1);
        }
        for (link, of) in self.links.iter_mut().zip(&of.links) {
            link.take_over(of);
        }
        self.reads.clone_from(&of.reads);
        self.factors.clone_from(&of.factors);
        self.singular = of.singular;
    }

    fn sizes(&self) -> impl Iterator<Item = Size> + '_ {
        self.links.iter().map(|link| link.size)
    }

    /// Forgets what the other equations read.
    pub(crate) fn begin(&mut self) {
        self.reads.clear();
        self.factors.clear();
        self.singular = None;
    }

    pub(crate) fn link_mut(&mut self, link: usize) -> &mut Link {
        &mut self.links[link]
    }

    /// Goes over a link whose equations are written, from `S` in front of it to that behind it, which has `G`.
    pub(crate) fn pass(&mut self, link: usize, states: &[f64], next: &mut [f64]) {
        let room = [&mut self.solved, &mut self.known];
        if let Err(at) = self.links[link].eliminate(states, next, room, &mut self.placed) {
            self.singular = Some(at);
        }
    }

    /// Adds a multiple of a linear form of the states behind a link to one of (3).
    pub(crate) fn read(&mut self, equation: usize, link: usize, factor: f64, form: &[f64]) {
        self.reads.push(Read { equation, link });
        self.factors.extend(form.iter().map(|x| factor * x));
    }

    /// Writes `D` of the parameter as that which makes up for residuals of these derivatives by it; what is left of them is in the others.
    pub(crate) fn set_parameter(&mut self, derivatives: &mut [f64]) {
        self.forward(derivatives);
        let mut first = self.columns - 1;
        for link in &mut self.links {
            let count = link.count();
            let last = (self.columns - 1) * count;
            link.through[last..].copy_from_slice(&derivatives[first..][..count]);
            first += count;
        }
    }

    /// Why there is no elimination.
    pub(crate) fn singular(&self) -> Option<Singular> {
        self.singular
    }

    /// Multiplications of the factorisations, about.
    pub(crate) fn operations(&self) -> u64 {
        let cube = |n: usize| (n as u64).pow(3) / 3;
        self.links.iter().map(|link| cube(link.count())).sum()
    }

    /// The derivatives of the unknowns of a link by one of the others, with the other sign: a column of `D` of (4), once all links were passed.
    pub(crate) fn by_other(&self, link: usize, other: usize) -> &[f64] {
        let link = &self.links[link];
        let count = link.count();
        &link.through[other * count..][..count]
    }

    /// Sign of the determinant of all `A`, and logarithm of its size.
    pub(crate) fn determinant(&self) -> (f64, f64) {
        self.links.iter().fold((1.0, 0.0), |(sign, size), link| {
            let own = link.lu.determinant(&link.matrix);
            (sign * own.0, size + own.1)
        })
    }

    /// Forward: the unknowns of links become `h`, and what `c` does to the other equations is taken from these. The vector has the other
    /// unknowns, link by link those of links, and more or not.
    pub(crate) fn forward(&mut self, vector: &mut [f64]) {
        let (order, mut first) = (self.states, self.columns - 1);
        self.at.fill(0.0);
        for (link, behind) in self.links.iter().zip(self.room.chunks_exact_mut(order)) {
            let count = link.count();
            let own = &mut vector[first..first + count];
            for (x, by) in own.iter_mut().zip(link.by_states.chunks_exact(order)) {
                *x -= by.iter().zip(&self.at).map(|(b, c)| b * c).sum::<f64>();
            }
            if count > 0 {
                link.lu.solve(&link.matrix, own);
            }
            for (row, behind) in behind.iter_mut().enumerate() {
                let (carried, of) = link.carried(row);
                let carried = carried.iter().zip(&self.at[of]);
                let carried: f64 = carried.map(|(e, c)| e * c).sum();
                *behind = carried + dot(&link.driven[row * count..][..count], own);
            }
            self.at.copy_from_slice(behind);
            first += count;
        }
        let factors = self.factors.chunks_exact(order);
        for (read, factors) in self.reads.iter().zip(factors) {
            let behind = &self.room[read.link * order..][..order];
            vector[read.equation] -= factors.iter().zip(behind).map(|(p, c)| p * c).sum::<f64>();
        }
    }

    /// Back: the unknowns of links from `h` and from the others, the parameter last among them.
    pub(crate) fn back(&self, others: &[f64], own: &mut [f64]) {
        let mut first = 0;
        for link in &self.links {
            let count = link.count();
            if count > 0 {
                let own = &mut own[first..first + count];
                for (factor, through) in others.iter().zip(link.through.chunks_exact(count)) {
                    if *factor != 0.0 {
                        for (x, d) in own.iter_mut().zip(through) {
                            *x -= factor * d;
                        }
                    }
                }
            }
            first += count;
        }
    }

    /// Takes `w^T D` from a row over the others, for a row over the unknowns of links. A right-hand side in front of such a row loses `w . h`.
    pub(crate) fn take_row(&self, own: &[f64], others: &mut [f64]) {
        let mut first = 0;
        for link in &self.links {
            let count = link.count();
            if count > 0 {
                let own = &own[first..first + count];
                for (x, through) in others.iter_mut().zip(link.through.chunks_exact(count)) {
                    *x -= dot(own, through);
                }
            }
            first += count;
        }
    }

    /// The transposed equations, back: the unknowns of links from what the other ones are, in place of right-hand sides from which a border
    /// is taken already.
    pub(crate) fn back_transposed(&mut self, others: &[f64], own: &mut [f64]) {
        let order = self.states;
        self.room.fill(0.0);
        let factors = self.factors.chunks_exact(order);
        for (read, factors) in self.reads.iter().zip(factors) {
            let to = &mut self.room[read.link * order..][..order];
            for (to, p) in to.iter_mut().zip(factors) {
                *to += p * others[read.equation];
            }
        }
        self.at.fill(0.0);
        let mut end = own.len();
        for (link, read) in self.links.iter().zip(self.room.chunks_exact(order)).rev() {
            let count = link.count();
            for (at, read) in self.at.iter_mut().zip(read) {
                *at += read;
            }
            let own = &mut own[end - count..end];
            for (row, at) in self.at.iter().enumerate() {
                for (x, f) in own.iter_mut().zip(&link.driven[row * count..][..count]) {
                    *x -= f * at;
                }
            }
            if count > 0 {
                link.lu.solve_transposed(&link.matrix, own);
            }
            self.next.fill(0.0);
            for (row, at) in self.at.iter().enumerate() {
                let (carried, of) = link.carried(row);
                for (to, e) in self.next[of].iter_mut().zip(carried) {
                    *to += e * at;
                }
            }
            for (x, by) in own.iter().zip(link.by_states.chunks_exact(order)) {
                for (to, b) in self.next.iter_mut().zip(by) {
                    *to += b * x;
                }
            }
            std::mem::swap(&mut self.at, &mut self.next);
            end -= count;
        }
    }
}
