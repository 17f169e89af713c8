//! The Jacobian of a continuation problem: dense in a core of unknowns, block triangular in a tail, with a border; or with a
//! [chain](super::chain) of unknowns that are eliminated before all others, or with [pairs](super::arrow) that are.
//!
//! High harmonics of an oscillator are almost free masses: their diagonal `(k Omega)^2 M` outweighs what couples them to each
//! other and to the low ones. The tail `y` has its diagonal blocks `D`, and what the core `x` does to it,
//!
//! ```text
//! [ A    0    a ] [ x ]   [ r ]
//! [ B    D    c ] [ y ] = [ q ]                                                                              (1)
//! [ b^T  d^T  e ] [ l ]   [ s ]
//! ```
//!
//! With `w = D^-T d`, elimination of `y` leaves the core with one border, where `b` becomes `b - B^T w`, `e` becomes `e - w . c`
//! and `s` becomes `s - w . q`: the factorisation costs that of the core. What (1) leaves out, the iteration must make up. It is
//! the method of Gauss and Seidel by blocks, which converges twice as fast as without `B`, where core and tail take turns.
//!
//! Source: Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (bordering); Varga (1962), Matrix
//! Iterative Analysis, chapter 4 (rates of consistently ordered matrices); the division into strongly and weakly coupled
//! harmonics follows Grolet and Thouverez (2012), On a new harmonic selection technique for harmonic balance method.

use super::arrow::Arrow;
use super::arrow::links::PairLinks;
use super::chain::Chain;
use crate::numeric::linear::{Lu, Matrix, Singular, dot};

/// Which unknowns are coupled densely, which by groups, and which are zero for ever.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partition {
    /// Number of unknowns, without the parameter.
    pub(crate) unknowns: usize,
    /// The unknowns of the core, in the order of its rows.
    pub(crate) core: Vec<usize>,
    /// The unknowns of the tail, group after group.
    pub(crate) tail: Vec<usize>,
    /// Unknowns in a group.
    pub(crate) group: usize,
    /// Unknowns of a chain, which are the last; then there is no tail.
    pub(crate) chained: usize,
    /// Pairs of unknowns at the beginning that are coupled with each other through all others only: then nothing is dense but what is left
    /// without them.
    pub(crate) pairs: usize,
}

impl Partition {
    /// Extended unknowns with zeros for those that are in no part, as the mean of an orbit with odd symmetry.
    pub(crate) fn clear_others(&self, u: &mut [f64]) {
        let mut kept = vec![0.0; u.len()];
        let parameter = u.len() - 1;
        for &unknown in self.core.iter().chain(&self.tail).chain([&parameter]) {
            kept[unknown] = u[unknown];
        }
        u.copy_from_slice(&kept);
    }

    /// All unknowns in the core.
    pub(crate) fn dense(unknowns: usize) -> Self {
        Self {
            unknowns,
            core: (0..unknowns).collect(),
            tail: Vec::new(),
            group: 1,
            chained: 0,
            pairs: 0,
        }
    }

    /// The first unknowns in pairs, all others in what is left without them.
    pub(crate) fn paired(unknowns: usize, pairs: usize) -> Self {
        Self {
            pairs,
            ..Self::dense(unknowns)
        }
    }

    /// The first unknowns in the core, the others in a chain.
    pub(crate) fn chained(unknowns: usize, core: usize) -> Self {
        Self {
            unknowns,
            chained: unknowns - core,
            ..Self::dense(core)
        }
    }
}

/// Entries, and after [`Jacobian::factorise`] factors, of the matrix of (1).
#[derive(Debug)]
pub struct Jacobian {
    partition: Partition,
    /// The core with its border, of one order more than the core.
    core: Matrix,
    lu: Lu,
    /// The blocks `D`.
    groups: Vec<Matrix>,
    group_lus: Vec<Lu>,
    /// `B`, row by row.
    coupling: Vec<f64>,
    /// `c`, and after factorisation `D^-1 c`.
    column: Vec<f64>,
    /// `d`, and after factorisation `w`.
    border: Vec<f64>,
    room: Vec<f64>,
    tail_room: Vec<f64>,
    /// What is eliminated before, with the part of the border that belongs to it, and all units.
    chain: Chain,
    chain_border: Vec<f64>,
    units: Vec<f64>,
    /// What is in the place of all the others but the units, where there are pairs.
    arrow: Option<Box<Arrow>>,
}

impl Jacobian {
    /// Zero, with room for everything.
    pub(crate) fn new(partition: Partition) -> Self {
        let arrow = (partition.pairs > 0)
            .then(|| Box::new(Arrow::new(partition.pairs, partition.unknowns)));
        let order = if arrow.is_some() {
            0
        } else {
            partition.core.len() + 1
        };
        let tail = partition.tail.len();
        let groups = tail / partition.group;
        Self {
            arrow,
            core: Matrix::zeros(order),
            lu: Lu::new(order),
            groups: (0..groups)
                .map(|_| Matrix::zeros(partition.group))
                .collect(),
            group_lus: (0..groups).map(|_| Lu::new(partition.group)).collect(),
            coupling: vec![0.0; tail * partition.core.len()],
            column: vec![0.0; tail],
            border: vec![0.0; tail],
            room: vec![0.0; order],
            tail_room: vec![0.0; tail],
            chain: Chain::default(),
            chain_border: vec![0.0; partition.chained],
            units: vec![1.0; partition.unknowns + 1],
            partition,
        }
    }

    /// Whether nothing is left out of the equations.
    pub(crate) fn is_exact(&self) -> bool {
        self.partition.tail.is_empty()
    }

    /// Multiplications of a factorisation, about.
    pub(crate) fn operations(&self) -> u64 {
        if let Some(arrow) = &self.arrow {
            return arrow.operations();
        }
        let cube = |n: usize| (n as u64).pow(3) / 3;
        cube(self.partition.core.len())
            + self.groups.len() as u64 * cube(self.partition.group)
            + self.chain.operations()
    }

    pub(crate) fn clear(&mut self) {
        self.core.clear();
        self.groups.iter_mut().for_each(Matrix::clear);
        self.coupling.fill(0.0);
        self.column.fill(0.0);
    }

    /// The core, whose last row and column are the border.
    pub(crate) fn core_mut(&mut self) -> &mut Matrix {
        &mut self.core
    }

    /// Takes a chain over: its unknowns are eliminated, and the core is what is left of the other equations.
    pub(crate) fn take_chain(&mut self, chain: &Chain) {
        self.chain.take_over(chain);
    }

    /// Takes equations with pairs over, whose states are eliminated.
    pub(crate) fn take_pairs(&mut self, links: &mut PairLinks) {
        debug_assert!(self.arrow.is_some(), "a partition with pairs has an arrow");
        if let Some(arrow) = &mut self.arrow {
            arrow.take(links);
        }
    }

    /// One group of the tail.
    pub(crate) fn group_mut(&mut self, group: usize) -> &mut Matrix {
        &mut self.groups[group]
    }

    /// Two rows of `B`, from a row of a group of the tail on: over the unknowns of the core.
    pub(crate) fn two_coupling_rows_mut(
        &mut self,
        group: usize,
        row: usize,
    ) -> (&mut [f64], &mut [f64]) {
        let core = self.partition.core.len();
        let start = (group * self.partition.group + row) * core;
        self.coupling[start..start + 2 * core].split_at_mut(core)
    }

    /// Writes the derivatives by the parameter, one for each unknown's equation.
    pub(crate) fn set_column(&mut self, values: &[f64]) {
        let last = self.partition.core.len();
        for (row, &unknown) in self.partition.core.iter().enumerate() {
            self.core.row_mut(row)[last] = values[unknown];
        }
        gather(&mut self.column, values, &self.partition.tail);
    }

    /// Writes the last row of (1), over the extended unknowns.
    pub(crate) fn set_border(&mut self, values: &[f64]) {
        if let Some(arrow) = &mut self.arrow {
            return arrow.set_border(values);
        }
        let last = self.partition.core.len();
        let row = self.core.row_mut(last);
        gather(row, values, &self.partition.core);
        row[last] = values[self.partition.unknowns];
        gather(&mut self.border, values, &self.partition.tail);
        if self.partition.chained > 0 {
            self.chain_border
                .copy_from_slice(&values[last..self.partition.unknowns]);
            if self.chain_border.iter().any(|x| *x != 0.0) {
                self.chain.take_row(&self.chain_border, row);
            }
        }
    }

    /// Measures every unknown in its unit, the parameter in the last one.
    pub(crate) fn scale_columns(&mut self, units: &[f64]) {
        if let Some(arrow) = &mut self.arrow {
            self.units.copy_from_slice(units);
            return arrow.scale_columns(units);
        }
        let (core, tail) = (&self.partition.core, &self.partition.tail);
        let (unknowns, group) = (self.partition.unknowns, self.partition.group);
        let last = core.len();
        self.units.copy_from_slice(units);
        gather(&mut self.room, units, core);
        self.room[last] = units[unknowns];
        gather(&mut self.tail_room, units, tail);
        for row in 0..=last {
            scale(self.core.row_mut(row), &self.room);
        }
        for row in self.coupling.chunks_exact_mut(last.max(1)) {
            scale(row, &self.room);
        }
        let groups = self.tail_room.chunks_exact(group);
        for (matrix, units) in self.groups.iter_mut().zip(groups) {
            for row in 0..group {
                scale(matrix.row_mut(row), units);
            }
        }
        for column in &mut self.column {
            *column *= units[unknowns];
        }
        scale(&mut self.border, &self.tail_room);
    }

    /// Factorises the tail, then the core with its new border.
    ///
    /// # Errors
    /// [`Singular`], with the column in the core, or behind it for a group of the tail.
    pub(crate) fn factorise(&mut self) -> Result<(), Singular> {
        if let Some(arrow) = &mut self.arrow {
            return arrow.factorise();
        }
        if let Some(at) = self.chain.singular() {
            return Err(at);
        }
        let (order, group) = (self.partition.core.len(), self.partition.group);
        for (index, (matrix, lu)) in self.groups.iter_mut().zip(&mut self.group_lus).enumerate() {
            lu.factorise(matrix).map_err(|at| Singular {
                column: order + index * group + at.column,
                ..at
            })?;
            let place = index * group..(index + 1) * group;
            lu.solve_transposed(matrix, &mut self.border[place.clone()]);
            let corner = dot(&self.border[place.clone()], &self.column[place.clone()]);
            self.core.row_mut(order)[order] -= corner;
            lu.solve(matrix, &mut self.column[place]);
        }
        let last = self.core.row_mut(order);
        let rows = self.coupling.chunks_exact(order.max(1));
        for (row, w) in rows.zip(&self.border) {
            for (x, b) in last.iter_mut().zip(row) {
                *x -= w * b;
            }
        }
        self.lu.factorise(&mut self.core)
    }

    /// How large an update of one in every unit makes the equation of the core that it changes least.
    pub(crate) fn smallest_equation(&self) -> f64 {
        match &self.arrow {
            Some(arrow) => arrow.smallest_equation(),
            None => self.lu.smallest_row(),
        }
    }

    /// Factorises, and gives the sign of the determinant and the logarithm of its size; the sign is zero where that fails.
    pub(crate) fn determinant(&mut self) -> (f64, f64) {
        if self.factorise().is_err() {
            return (0.0, f64::NEG_INFINITY);
        }
        if let Some(arrow) = &self.arrow {
            return arrow.determinant(&self.units);
        }
        let groups = self.groups.iter().zip(&self.group_lus);
        groups
            .map(|(matrix, lu)| lu.determinant(matrix))
            .chain([self.chain.determinant()])
            .fold(self.lu.determinant(&self.core), |a, b| {
                (a.0 * b.0, a.1 + b.1)
            })
    }

    /// Solves (1) in place, for an extended vector in the order of the unknowns.
    pub(crate) fn solve(&mut self, vector: &mut [f64]) {
        if let Some(arrow) = &mut self.arrow {
            return arrow.solve(vector, &self.units);
        }
        if self.partition.chained > 0 {
            return self.solve_chained(vector);
        }
        let (core, tail) = (&self.partition.core, &self.partition.tail);
        let (unknowns, group) = (self.partition.unknowns, self.partition.group);
        gather(&mut self.tail_room, vector, tail);
        gather(&mut self.room, vector, core);
        let last = core.len();
        self.room[last] = vector[unknowns] - dot(&self.border, &self.tail_room);
        self.lu.solve(&self.core, &mut self.room);
        let rows = self.coupling.chunks_exact(last.max(1));
        for (to, row) in self.tail_room.iter_mut().zip(rows) {
            *to -= dot(row, &self.room[..last]);
        }
        for (index, (matrix, lu)) in self.groups.iter().zip(&self.group_lus).enumerate() {
            lu.solve(matrix, &mut self.tail_room[index * group..][..group]);
        }
        let parameter = self.room[last];
        vector.fill(0.0);
        vector[unknowns] = parameter;
        for (from, &unknown) in self.room.iter().zip(core) {
            vector[unknown] = *from;
        }
        for ((from, &unknown), column) in self.tail_room.iter().zip(tail).zip(&self.column) {
            vector[unknown] = from - parameter * column;
        }
    }

    /// Solves the transposed system in place.
    pub(crate) fn solve_transposed(&mut self, vector: &mut [f64]) {
        if let Some(arrow) = &mut self.arrow {
            return arrow.solve_transposed(vector, &self.units);
        }
        if self.partition.chained > 0 {
            return self.solve_chained_transposed(vector);
        }
        let (core, tail) = (&self.partition.core, &self.partition.tail);
        let (unknowns, group) = (self.partition.unknowns, self.partition.group);
        let last = core.len();
        gather(&mut self.tail_room, vector, tail);
        gather(&mut self.room, vector, core);
        self.room[last] = vector[unknowns] - dot(&self.column, &self.tail_room);
        for (index, (matrix, lu)) in self.groups.iter().zip(&self.group_lus).enumerate() {
            lu.solve_transposed(matrix, &mut self.tail_room[index * group..][..group]);
        }
        let rows = self.coupling.chunks_exact(last.max(1));
        for (row, y) in rows.zip(&self.tail_room) {
            for (x, b) in self.room.iter_mut().zip(row) {
                *x -= y * b;
            }
        }
        self.lu.solve_transposed(&self.core, &mut self.room);
        let parameter = self.room[last];
        for (x, w) in self.tail_room.iter_mut().zip(&self.border) {
            *x -= parameter * w;
        }
        vector.fill(0.0);
        vector[unknowns] = parameter;
        for (from, &unknown) in self.room.iter().zip(core) {
            vector[unknown] = *from;
        }
        for (from, &unknown) in self.tail_room.iter().zip(tail) {
            vector[unknown] = *from;
        }
    }

    /// The same where there is a chain.
    fn solve_chained(&mut self, vector: &mut [f64]) {
        let (core, unknowns) = (self.partition.core.len(), self.partition.unknowns);
        self.chain.forward(vector);
        self.room[..core].copy_from_slice(&vector[..core]);
        self.room[core] = vector[unknowns] - dot(&self.chain_border, &vector[core..unknowns]);
        self.lu.solve(&self.core, &mut self.room);
        vector[..core].copy_from_slice(&self.room[..core]);
        vector[unknowns] = self.room[core];
        scale(&mut self.room[..core], &self.units);
        self.room[core] *= self.units[unknowns];
        let own = &mut vector[core..unknowns];
        self.chain.back(&self.room, own);
        for (x, unit) in own.iter_mut().zip(&self.units[core..]) {
            *x /= unit;
        }
    }

    /// The transposed system where there is a chain.
    fn solve_chained_transposed(&mut self, vector: &mut [f64]) {
        let (core, unknowns) = (self.partition.core.len(), self.partition.unknowns);
        for (x, unit) in vector[core..unknowns].iter_mut().zip(&self.units[core..]) {
            *x /= unit;
        }
        for (to, (x, unit)) in self.room.iter_mut().zip(vector.iter().zip(&self.units)) {
            *to = x / unit;
        }
        self.room[core] = vector[unknowns] / self.units[unknowns];
        self.chain.take_row(&vector[core..unknowns], &mut self.room);
        scale(&mut self.room[..core], &self.units);
        self.room[core] *= self.units[unknowns];
        self.lu.solve_transposed(&self.core, &mut self.room);
        let parameter = self.room[core];
        vector[..core].copy_from_slice(&self.room[..core]);
        vector[unknowns] = parameter;
        let own = &mut vector[core..unknowns];
        for (x, w) in own.iter_mut().zip(&self.chain_border) {
            *x -= parameter * w;
        }
        self.chain.back_transposed(&self.room[..core], own);
    }

    /// All entries, before factorisation, as the matrix of (1).
    #[cfg(test)]
    pub(crate) fn entries(&self) -> nalgebra::DMatrix<f64> {
        let n = self.partition.unknowns;
        let mut entries = nalgebra::DMatrix::zeros(n + 1, n + 1);
        let mut places = self.partition.core.clone();
        places.push(n);
        for (row, &to) in places.iter().enumerate() {
            for (column, &from) in places.iter().enumerate() {
                entries[(to, from)] = self.core.row(row)[column];
            }
        }
        let group = self.partition.group;
        for (index, &unknown) in self.partition.tail.iter().enumerate() {
            entries[(unknown, n)] = self.column[index];
            entries[(n, unknown)] = self.border[index];
            let start = index / group * group;
            for column in 0..group {
                let other = self.partition.tail[start + column];
                entries[(unknown, other)] = self.groups[index / group].row(index % group)[column];
            }
            let order = self.partition.core.len();
            let row = &self.coupling[index * order..][..order];
            for (&from, value) in self.partition.core.iter().zip(row) {
                entries[(unknown, from)] = *value;
            }
        }
        entries
    }
}

fn scale(row: &mut [f64], units: &[f64]) {
    for (x, unit) in row.iter_mut().zip(units) {
        *x *= unit;
    }
}

/// Takes the entries of a vector at these places.
fn gather(to: &mut [f64], from: &[f64], places: &[usize]) {
    for (to, &place) in to.iter_mut().zip(places) {
        *to = from[place];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;
    use nalgebra::DVector;

    fn filled(partition: Partition) -> Jacobian {
        let mut random = Random::seeded(4);
        let mut next = |_| random.between(-1.0, 1.0);
        let mut jacobian = Jacobian::new(partition);
        for row in 0..=jacobian.partition.core.len() {
            for x in jacobian.core.row_mut(row) {
                *x = next(0);
            }
        }
        for group in 0..jacobian.groups.len() {
            for row in 0..jacobian.partition.group {
                let entries = jacobian.group_mut(group).row_mut(row);
                for x in entries.iter_mut() {
                    *x = next(0);
                }
                entries[row] += 3.0;
            }
        }
        for x in &mut jacobian.coupling {
            *x = next(0);
        }
        let n = jacobian.partition.unknowns;
        let (column, border): (Vec<f64>, Vec<f64>) = (0..=n).map(|i| (next(i), next(i))).unzip();
        jacobian.set_column(&column[..n]);
        jacobian.set_border(&border);
        let units: Vec<f64> = (0..=n).map(|unknown| 1.0 + 0.1 * unknown as f64).collect();
        jacobian.scale_columns(&units);
        jacobian
    }

    #[test]
    fn solves_what_its_entries_say() {
        let mixed = Partition {
            unknowns: 11,
            core: vec![0, 1, 2, 5, 6],
            tail: vec![3, 4, 7, 8],
            group: 2,
            chained: 0,
            pairs: 0,
        };
        for partition in [mixed, Partition::dense(4), Partition::dense(0)] {
            let absent: Vec<usize> = (0..partition.unknowns)
                .filter(|i| !partition.core.contains(i) && !partition.tail.contains(i))
                .collect();
            let mut jacobian = filled(partition);
            let mut matrix = jacobian.entries();
            let n = matrix.nrows();
            for &unknown in &absent {
                matrix[(unknown, unknown)] = 1.0;
            }
            jacobian.factorise().unwrap();
            let mut right: Vec<f64> = (0..n).map(|i| (i as f64 + 0.3).sin()).collect();
            for &unknown in &absent {
                right[unknown] = 0.0;
            }
            for transposed in [false, true] {
                let mut x = right.clone();
                let reference = if transposed {
                    jacobian.solve_transposed(&mut x);
                    matrix.transpose()
                } else {
                    jacobian.solve(&mut x);
                    matrix.clone()
                };
                let left = &reference * DVector::from_vec(x);
                for (a, b) in left.iter().zip(&right) {
                    assert!((a - b).abs() < 1e-11, "{transposed} {a} {b}");
                }
            }
        }
    }

    #[test]
    fn a_singular_group_is_reported_behind_the_core() {
        let partition = Partition {
            unknowns: 3,
            core: vec![0],
            tail: vec![1, 2],
            group: 1,
            chained: 0,
            pairs: 0,
        };
        let mut jacobian = filled(partition);
        jacobian.group_mut(1).row_mut(0)[0] = 0.0;
        assert_eq!(jacobian.factorise().unwrap_err().column, 2);
    }
}
