//! Against the matrix of all equations, without elimination.

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::testing::random::Random;

/// Random equations with a chain, and the matrix of all of them.
struct Whole {
    random: Random,
    chain: Chain,
    states: usize,
    others: usize,
    matrix: DMatrix<f64>,
    /// Of the other equations, when links are eliminated.
    core: DMatrix<f64>,
    /// How the states depend on all unknowns, and on the others when links are eliminated, row by row.
    by_all: DMatrix<f64>,
    by: Vec<f64>,
}

impl Whole {
    fn new(counts: &[usize], states: usize, others: usize) -> Self {
        let n = others + counts.iter().sum::<usize>();
        let columns = others + 1;
        let sizes = counts.iter().enumerate().map(|(index, &count)| Size {
            count,
            couples: couples(index),
        });
        let mut chain = Chain::new(sizes, states, others);
        chain.begin();
        let mut random = Random::seeded(7);
        let by: Vec<f64> = (0..states * columns)
            .map(|_| random.between(-1.0, 1.0))
            .collect();
        let mut whole = Self {
            random,
            chain,
            states,
            others,
            matrix: DMatrix::zeros(n + 1, n + 1),
            core: DMatrix::zeros(others, columns),
            by_all: DMatrix::zeros(states, n + 1),
            by,
        };
        for row in 0..states {
            for column in 0..columns {
                let place = whole.place(column);
                whole.by_all[(row, place)] = whole.by[row * columns + column];
            }
        }
        whole
    }

    fn next(&mut self) -> f64 {
        self.random.between(-1.0, 1.0)
    }

    /// The parameter stands last.
    fn place(&self, column: usize) -> usize {
        if column == self.others {
            self.matrix.ncols() - 1
        } else {
            column
        }
    }

    /// Fills a link, whose unknowns begin at a place.
    fn add(&mut self, index: usize, first: usize, count: usize) {
        let columns = self.others + 1;
        self.chain.link_mut(index).clear();
        for row in 0..count {
            let random: Vec<f64> = (0..count + self.states + columns)
                .map(|_| self.next())
                .collect();
            let [own, by_states, direct] = self.chain.link_mut(index).equation_mut(row);
            let all = own.iter_mut().chain(by_states).chain(direct);
            all.zip(&random).for_each(|(to, x)| *to = *x);
            own[row] += 3.0;
            for column in 0..count {
                self.matrix[(first + row, first + column)] += own[column];
            }
            for (state, b) in random[count..][..self.states].iter().enumerate() {
                let to = self.matrix.row(first + row) + *b * self.by_all.row(state);
                self.matrix.row_mut(first + row).copy_from(&to);
            }
            for (column, x) in random[count + self.states..].iter().enumerate() {
                let place = self.place(column);
                self.matrix[(first + row, place)] += x;
            }
        }
        self.carry(index, first, count);
    }

    /// Goes over to the states behind it.
    fn carry(&mut self, index: usize, first: usize, count: usize) {
        let columns = self.others + 1;
        let mut all = DMatrix::<f64>::zeros(self.states, self.matrix.ncols());
        let mut behind: Vec<f64> = (0..self.states * columns).map(|_| self.next()).collect();
        for row in 0..self.states {
            let mut random: Vec<f64> = (0..self.states + count).map(|_| self.next()).collect();
            let apart = |state: usize| !couples(index) && state / 2 != row / 2;
            for (state, e) in random[..self.states].iter_mut().enumerate() {
                if apart(state) {
                    *e = 0.0;
                }
            }
            let [carried, driven] = self.chain.link_mut(index).state_mut(row);
            let (start, width) = if couples(index) {
                (0, self.states)
            } else {
                (row - row % 2, 2)
            };
            carried.copy_from_slice(&random[start..][..width]);
            driven.copy_from_slice(&random[self.states..]);
            for (state, e) in random[..self.states].iter().enumerate() {
                let to = all.row(row) + *e * self.by_all.row(state);
                all.row_mut(row).copy_from(&to);
            }
            for (column, f) in random[self.states..].iter().enumerate() {
                all[(row, first + column)] += f;
            }
            for column in 0..columns {
                all[(row, self.place(column))] += behind[row * columns + column];
            }
        }
        self.chain.pass(index, &self.by, &mut behind);
        (self.by, self.by_all) = (behind, all);
    }

    /// Every other equation reads the states behind a link.
    fn read(&mut self, index: usize) {
        let columns = self.others + 1;
        for equation in 0..self.others {
            let form: Vec<f64> = (0..self.states).map(|_| self.next()).collect();
            self.chain.read(equation, index, 0.5, &form);
            for (state, p) in form.iter().enumerate() {
                let to = self.matrix.row(equation) + 0.5 * *p * self.by_all.row(state);
                self.matrix.row_mut(equation).copy_from(&to);
                for column in 0..columns {
                    self.core[(equation, column)] += 0.5 * p * self.by[state * columns + column];
                }
            }
        }
    }

    /// The Jacobian with a border, measured in units.
    fn jacobian(mut self) -> (Jacobian, DMatrix<f64>) {
        let n = self.matrix.ncols() - 1;
        let mut jacobian = Jacobian::new(Partition::chained(n, self.others));
        for equation in 0..self.others {
            for column in 0..=self.others {
                let (x, place) = (self.next(), self.place(column));
                self.core[(equation, column)] += x;
                self.matrix[(equation, place)] += x;
            }
            let row: Vec<f64> = self.core.row(equation).iter().copied().collect();
            jacobian.core_mut().row_mut(equation).copy_from_slice(&row);
        }
        jacobian.take_chain(&self.chain);
        let border: Vec<f64> = (0..=n).map(|_| self.next()).collect();
        for (to, x) in self.matrix.row_mut(n).iter_mut().zip(&border) {
            *to = *x;
        }
        jacobian.set_border(&border);
        let units: Vec<f64> = (0..=n).map(|unknown| 1.0 + 0.1 * unknown as f64).collect();
        jacobian.scale_columns(&units);
        for (column, unit) in units.iter().enumerate() {
            self.matrix.column_mut(column).scale_mut(*unit);
        }
        (jacobian, self.matrix)
    }
}

/// Every other link couples all states, the others those of a pair.
fn couples(link: usize) -> bool {
    link.is_multiple_of(2)
}

/// Links with these numbers of unknowns.
fn random(counts: &[usize], states: usize, others: usize) -> (Jacobian, DMatrix<f64>) {
    let mut whole = Whole::new(counts, states, others);
    let mut first = others;
    for (index, &count) in counts.iter().enumerate() {
        whole.add(index, first, count);
        whole.read(index);
        first += count;
    }
    whole.jacobian()
}

#[test]
fn solves_what_all_equations_say() {
    for (counts, states, others) in [
        (&[3, 0, 4][..], 2, 3),
        (&[8], 2, 4),
        (&[0, 0], 4, 2),
        (&[1, 2, 9, 1], 4, 7),
        (&[5, 9], 4, 20),
    ] {
        let (mut jacobian, whole) = random(counts, states, others);
        jacobian.factorise().unwrap();
        let n = whole.nrows();
        let right: Vec<f64> = (0..n).map(|i| (i as f64 + 0.3).sin()).collect();
        for transposed in [false, true] {
            let mut x = right.clone();
            let matrix = if transposed {
                jacobian.solve_transposed(&mut x);
                whole.transpose()
            } else {
                jacobian.solve(&mut x);
                whole.clone()
            };
            let left = matrix * DVector::from_vec(x);
            for (a, b) in left.iter().zip(&right) {
                assert!((a - b).abs() < 1e-9, "{counts:?} {transposed} {a} {b}");
            }
        }
    }
}

#[test]
fn determinants_are_those_of_all_equations() {
    let (mut jacobian, whole) = random(&[3, 0, 4], 2, 3);
    let units = (3..10).map(|unknown| (1.0 + 0.1 * f64::from(unknown)).ln());
    let (sign, size) = jacobian.determinant();
    let exact = whole.determinant();
    assert_eq!(sign, exact.signum());
    assert!((size + units.sum::<f64>() - exact.abs().ln()).abs() < 1e-9);
}
