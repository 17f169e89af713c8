//! The product of two matrices, both row by row, a group of columns at a time: of the second one the rows that are zero in all of these are left out, as
//! where states are still those of the pair that they began in.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, section 1.5 (products by blocks).

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::{Group, LANES};

/// Rows whose sums are in registers at a time.
const ROWS: usize = 4;

/// A row of the second matrix in some columns, and which one it is.
pub type Placed = (usize, Group);

/// Adds the product of `a`, in rows as long as `b` has rows, and `b`, in rows of so many columns. There is room for some columns of `b`.
pub fn add_product(a: &[f64], b: &[f64], columns: usize, to: &mut [f64], room: &mut Vec<Placed>) {
    let inner = b.len() / columns.max(1);
    if inner == 0 {
        return;
    }
    for first in (0..columns).step_by(LANES) {
        let width = LANES.min(columns - first);
        place(b, columns, first, room);
        let (several, rest) = a.split_at(a.len() / (ROWS * inner) * ROWS * inner);
        let (to_several, to_rest) = to.split_at_mut(several.len() / inner * columns);
        let rows = several.chunks_exact(ROWS * inner);
        for (rows, to) in rows.zip(to_several.chunks_exact_mut(ROWS * columns)) {
            let sums = several_rows(rows, room);
            for (sum, to) in sums.iter().zip(to.chunks_exact_mut(columns)) {
                add(sum, &mut to[first..][..width]);
            }
        }
        let rows = rest.chunks_exact(inner);
        for (row, to) in rows.zip(to_rest.chunks_exact_mut(columns)) {
            let mut sum = [0.0; LANES];
            for (place, group) in &*room {
                sum = plus(sum, row[*place], group);
            }
            add(&sum, &mut to[first..][..width]);
        }
    }
}

/// Rows that are not zero in the columns of a group, filled up with zeros.
fn place(b: &[f64], columns: usize, first: usize, room: &mut Vec<Placed>) {
    room.clear();
    for (place, row) in b.chunks_exact(columns).enumerate() {
        let group = row[first..].first_chunk().copied().unwrap_or_else(|| {
            let mut group = [0.0; LANES];
            group[..columns - first].copy_from_slice(&row[first..]);
            group
        });
        if group != [0.0; LANES] {
            room.push((place, group));
        }
    }
}

/// Products of some rows at once.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn several_rows(a: &[f64], known: &[Placed]) -> [Group; ROWS] {
    let inner = a.len() / ROWS;
    let rows: [&[f64]; ROWS] = std::array::from_fn(|r| &a[r * inner..][..inner]);
    let mut sums = [[0.0; LANES]; ROWS];
    for (place, group) in known {
        let factors: [f64; ROWS] = std::array::from_fn(|r| rows[r][*place]);
        for r in 0..ROWS {
            sums[r] = plus(sums[r], factors[r], group);
        }
    }
    sums
}

#[inline(always)]
fn plus(mut sum: Group, factor: f64, of: &Group) -> Group {
    for l in 0..LANES {
        sum[l] += factor * of[l];
    }
    sum
}

fn add(sum: &Group, to: &mut [f64]) {
    for (to, x) in to.iter_mut().zip(sum) {
        *to += x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries are small whole numbers, so that sums are exact in every order.
    #[test]
    fn products_are_those_entry_by_entry() {
        let mut room = Vec::new();
        for (rows, inner, columns) in [(1, 1, 1), (3, 2, 8), (4, 5, 9), (9, 6, 21), (8, 3, 16)] {
            let entry = |i: usize, j: usize| ((7 * i + 3 * j) % 11) as f64 - 5.0;
            // Most entries of the second one are zero, and one of its rows is.
            let sparse = |i: usize, j: usize| {
                if i == 1 || !(i + j).is_multiple_of(3) {
                    0.0
                } else {
                    entry(j, i)
                }
            };
            let list = |m: usize, n: usize, of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
                (0..m * n).map(|at| of(at / n, at % n)).collect()
            };
            let (a, b) = (list(rows, inner, &entry), list(inner, columns, &sparse));
            let mut to = vec![2.0; rows * columns];
            add_product(&a, &b, columns, &mut to, &mut room);
            for (at, found) in to.iter().enumerate() {
                let (i, j) = (at / columns, at % columns);
                let sum: f64 = (0..inner).map(|l| entry(i, l) * sparse(l, j)).sum();
                assert_eq!(*found, 2.0 + sum, "{rows} {inner} {columns}: {i} {j}");
            }
        }
    }
}
