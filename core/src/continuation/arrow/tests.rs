//! Against the matrix of all equations, without elimination.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::links::operations;
use super::*;
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::numeric::sparse::SparseRows;
use crate::testing::random::Random;

/// What random equations have.
#[derive(Debug, Clone)]
struct Case {
    counts: Vec<usize>,
    pairs: usize,
    /// Unknowns that are in no link, without the parameter.
    others: usize,
    /// Pairs for which the states come back as they are, whatever they are.
    resonant: Vec<usize>,
    sign: f64,
    /// The parameter does more than links say.
    parameter: bool,
    seed: u64,
}

/// Random equations, and the matrix of all of them with a border.
struct Whole {
    random: Random,
    links: PairLinks,
    matrix: DMatrix<f64>,
    /// How states depend on all unknowns.
    states: DMatrix<f64>,
}

impl Whole {
    fn of(case: &Case) -> Self {
        let n = 2 * case.pairs + case.others + case.counts.iter().sum::<usize>();
        let mut random = Random::seeded(case.seed);
        let order = 2 * case.pairs;
        let basis = DMatrix::from_fn(order, order, |i, j| {
            f64::from(u8::from(i == j)) + 0.2 * random.between(-1.0, 1.0)
        });
        let inverse = basis.clone().try_inverse().unwrap();
        let mut links = PairLinks::new(case.counts.iter().copied(), case.pairs, case.others);
        let known = Basis {
            to: SparseRows::of(order, order, |i, j| basis[(i, j)]),
            from: SparseRows::of(order, order, |i, j| inverse[(i, j)]),
        };
        links.begin(&Arc::new(known), case.sign);
        let mut whole = Self {
            random,
            links,
            matrix: DMatrix::zeros(n + 1, n + 1),
            states: DMatrix::zeros(order, n + 1),
        };
        whole.states.columns_mut(0, order).copy_from(&inverse);
        for (index, &count) in case.counts.iter().enumerate() {
            whole.links.link_mut(index).clear();
            whole.add_equations(case, index, count);
            whole.carry(case, index, count);
            whole.read(case, index);
        }
        let mut back = &basis * &whole.states;
        for state in 0..order {
            back[(state, state)] -= case.sign;
        }
        whole.matrix.rows_mut(0, order).copy_from(&back);
        if case.parameter {
            let column: Vec<f64> = (0..n).map(|_| whole.next()).collect();
            for (row, x) in column.iter().enumerate() {
                whole.matrix[(row, n)] += x;
            }
            whole.links.set_parameter(&column);
        }
        whole
    }

    fn next(&mut self) -> f64 {
        self.random.between(-1.0, 1.0)
    }

    /// The place of one that is in no link; the parameter stands last.
    fn place(&self, case: &Case, other: usize) -> usize {
        if other == case.others {
            self.matrix.ncols() - 1
        } else {
            2 * case.pairs + other
        }
    }

    fn first(&self, case: &Case, index: usize) -> usize {
        2 * case.pairs + case.others + self.links.links[index].first
    }

    fn add_equations(&mut self, case: &Case, index: usize, count: usize) {
        let first = self.first(case, index);
        for row in 0..count {
            let entries: Vec<f64> = (0..=count + 2 * case.pairs + case.others)
                .map(|_| self.next())
                .collect();
            let [own, by_states, direct] = self.links.link_mut(index).equation_mut(row);
            let all = own.iter_mut().chain(by_states).chain(direct);
            all.zip(&entries).for_each(|(to, x)| *to = *x);
            own[row] += 3.0;
            self.matrix[(first + row, first + row)] += 3.0;
            for (column, x) in entries[..count].iter().enumerate() {
                self.matrix[(first + row, first + column)] += x;
            }
            for (state, x) in entries[count..][..2 * case.pairs].iter().enumerate() {
                let to = self.matrix.row(first + row) + *x * self.states.row(state);
                self.matrix.row_mut(first + row).copy_from(&to);
            }
            for (other, x) in entries[count + 2 * case.pairs..].iter().enumerate() {
                let place = self.place(case, other);
                self.matrix[(first + row, place)] += x;
            }
        }
    }

    /// Goes over to the states behind a link.
    fn carry(&mut self, case: &Case, index: usize, count: usize) {
        let first = self.first(case, index);
        let mut next = DMatrix::zeros(2 * case.pairs, self.matrix.ncols());
        let others = case.others.max(1);
        let ends = [(index, 0.7), (index + 1, -0.4)].map(|(end, by)| (end % others, by));
        let moves = case.others > 0;
        let known = |end: usize| ends[end..=end].iter().copied().filter(move |_| moves);
        self.links.link_mut(index).set_ends([known(0), known(1)]);
        for state in 0..2 * case.pairs {
            let pair = state / 2;
            let mut entries: Vec<f64> = (0..5 + count).map(|_| self.next()).collect();
            if case.resonant.contains(&pair) {
                let sign = if index == 0 { case.sign } else { 1.0 };
                let near = if state % 2 == 0 { 0.3 } else { 0.0 };
                entries[state % 2] = sign;
                entries[1 - state % 2] = near;
            }
            let link = self.links.link_mut(index);
            let [carried, driven] = link.state_mut(state);
            carried.copy_from_slice(&entries[..2]);
            driven.copy_from_slice(&entries[5..]);
            *link.slopes_mut(state) = [entries[2], entries[3], entries[4]];
            let before = self.states.rows(2 * pair, 2);
            let mut row = entries[0] * before.row(0) + entries[1] * before.row(1);
            for (column, x) in entries[5..].iter().enumerate() {
                row[first + column] += x;
            }
            for (x, (other, by)) in entries[2..4].iter().zip(ends).filter(|_| moves) {
                row[self.place(case, other)] += x * by;
            }
            row[self.place(case, case.others)] += entries[4];
            next.row_mut(state).copy_from(&row);
        }
        self.states = next;
    }

    /// Every equation that is in no link reads the states behind one.
    fn read(&mut self, case: &Case, index: usize) {
        for equation in 0..case.others {
            let form: Vec<f64> = (0..2 * case.pairs).map(|_| self.next()).collect();
            let row = 2 * case.pairs + equation;
            self.links.read(equation, index, 0.5, &form);
            for (state, x) in form.iter().enumerate() {
                let to = self.matrix.row(row) + 0.5 * *x * self.states.row(state);
                self.matrix.row_mut(row).copy_from(&to);
            }
            for other in 0..=case.others {
                let (x, place) = (self.next(), self.place(case, other));
                self.links.direct_mut(equation)[other] += x;
                self.matrix[(row, place)] += x;
            }
        }
    }

    /// With a border, measured in units.
    fn jacobian(mut self, case: &Case) -> (Jacobian, DMatrix<f64>) {
        let n = self.matrix.ncols() - 1;
        let mut jacobian = Jacobian::new(Partition::paired(n, case.pairs));
        jacobian.take_pairs(&mut self.links);
        let border: Vec<f64> = (0..=n).map(|_| self.next()).collect();
        jacobian.set_border(&border);
        let units: Vec<f64> = (0..=n).map(|unknown| 1.0 + 0.1 * unknown as f64).collect();
        jacobian.scale_columns(&units);
        for (column, x) in border.iter().enumerate() {
            self.matrix[(n, column)] = *x;
        }
        for (column, unit) in units.iter().enumerate() {
            self.matrix.column_mut(column).scale_mut(*unit);
        }
        (jacobian, self.matrix)
    }
}

/// Solutions, transposed ones and determinants are those of the whole matrix.
fn is_that_of_all(case: &Case) {
    let (mut jacobian, whole) = Whole::of(case).jacobian(case);
    let n = whole.nrows();
    let inner: usize = case.counts.iter().sum();
    let units = (n - 1 - inner..n - 1).map(|unknown| (1.0 + 0.1 * unknown as f64).ln());
    let (sign, size) = jacobian.determinant();
    let factors = whole.clone().lu();
    let exact = factors.determinant();
    let left = factors.try_inverse().unwrap();
    let condition = left.amax() * whole.amax();
    if condition > 1e6 {
        return;
    }
    assert_eq!(sign, exact.signum());
    assert!((size + units.sum::<f64>() - exact.abs().ln()).abs() < 1e-12 * condition.max(1e3));
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
            assert!(
                (a - b).abs() < 1e-12 * condition.max(1e3),
                "{transposed} {a} {b}"
            );
        }
    }
}

fn case() -> impl Strategy<Value = Case> {
    let sizes = (
        prop::collection::vec(0_usize..10, 1..5),
        1_usize..7,
        0_usize..4,
    );
    let kinds = (
        prop::collection::vec(0_usize..7, 0..3),
        any::<bool>(),
        any::<bool>(),
        any::<u64>(),
    );
    (sizes, kinds).prop_map(
        |((counts, pairs, others), (resonant, minus, parameter, seed))| Case {
            counts,
            pairs,
            others,
            resonant,
            sign: if minus { -1.0 } else { 1.0 },
            parameter,
            seed,
        },
    )
}

proptest! {
    #[test]
    fn solves_what_all_equations_say(case in case()) {
        is_that_of_all(&case);
    }
}

/// The same numbers for one more pair, however many there are.
#[test]
fn operations_grow_with_the_number_of_pairs() {
    let at = |pairs| operations(4, 12, pairs, 2);
    let more = at(2001) - at(2000);
    assert_eq!(more, at(11) - at(10));
    assert_eq!(at(2000) - at(1000), 1000 * more);
}

/// Room for what a number of pairs needs grows with it.
#[test]
fn room_grows_with_the_number_of_pairs() {
    let size = |pairs: usize| {
        let arrow = Arrow::new(pairs, 2 * pairs + 14);
        8 * (arrow.by_others.len() + arrow.of_states.len() + arrow.sums.len()) + arrow.states.len()
    };
    assert_eq!(size(2000) - size(1000), 1000 * (size(11) - size(10)));
}
