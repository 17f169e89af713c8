//! Elimination and substitution, panel by panel.
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use std::hint::select_unpredictable;

use multiversion::multiversion;

use super::products::{add_products, sum_of_products, total};
use super::{Group, LANES, Lu, Matrix, Singular};

/// Rows that meet the panel at once: with a group of the panel they fill sixteen registers of four entries.
const TILE: usize = 6;

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(super) fn eliminate(matrix: &mut Matrix, lu: &mut Lu) -> Result<(), Singular> {
    let width = matrix.width();
    for (row, scale) in lu.scales.iter_mut().enumerate() {
        let mut sizes = [0.0; LANES];
        for x in &matrix.groups()[row * width..][..width] {
            for l in 0..LANES {
                sizes[l] = not_less(x[l].abs(), sizes[l]);
            }
        }
        for half in [4, 2, 1] {
            for l in 0..half {
                sizes[l] = not_less(sizes[l], sizes[l + half]);
            }
        }
        let largest = sizes[0];
        *scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
    }
    for panel in 0..width {
        eliminate_panel(matrix, panel, lu)?;
        if panel + 1 < width {
            let (above, below) = matrix
                .groups_mut()
                .split_at_mut((panel + 1) * LANES * width);
            let pivot_rows = &mut above[panel * LANES * width..];
            eliminate_right(pivot_rows, width, panel);
            let mut tiles = below.chunks_exact_mut(TILE * width);
            for rows in &mut tiles {
                eliminate_below::<TILE>(rows, pivot_rows, width, panel);
            }
            for row in tiles.into_remainder().chunks_exact_mut(width) {
                eliminate_below::<1>(row, pivot_rows, width, panel);
            }
        }
    }
    Ok(())
}

/// The larger of two numbers; the second if the first is a NaN.
#[inline(always)]
fn not_less(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// A row and the size of its candidate for the pivot.
#[derive(Clone, Copy)]
struct Candidate {
    row: usize,
    /// Numbers that are not negative are in the order of their bits, and a NaN is above them all: it becomes the pivot,
    /// and is then reported.
    size: u64,
}

impl Candidate {
    const NONE: Self = Self { row: 0, size: 0 };

    #[inline(always)]
    fn or(self, row: usize, entry: f64, scale: f64) -> Self {
        let size = (entry * scale).abs().to_bits();
        let larger = size > self.size;
        Self {
            row: select_unpredictable(larger, row, self.row),
            size: select_unpredictable(larger, size, self.size),
        }
    }
}

/// Eliminates the columns of one panel from each other, and exchanges whole rows.
#[inline(always)]
fn eliminate_panel(matrix: &mut Matrix, panel: usize, lu: &mut Lu) -> Result<(), Singular> {
    let (pivots, scales) = (&mut lu.pivots[..], &mut lu.scales[..]);
    let (n, width) = (matrix.order, matrix.width());
    let first = panel * LANES;
    let mut best = Candidate::NONE;
    for row in first..n {
        best = best.or(row, matrix.groups()[row * width + panel][0], scales[row]);
    }
    for column in first..n.min(first + LANES) {
        let (pivot_row, size) = (best.row, f64::from_bits(best.size));
        if !(size > f64::EPSILON * 1e-3 && size.is_finite()) {
            return Err(Singular {
                column,
                pivot: size,
            });
        }
        pivots[column] = pivot_row;
        if pivot_row != column {
            let (head, tail) = matrix.groups_mut().split_at_mut(pivot_row * width);
            head[column * width..][..width].swap_with_slice(&mut tail[..width]);
            scales.swap(column, pivot_row);
        }
        let lane = column - first;
        let (above, below) = matrix.groups_mut().split_at_mut((column + 1) * width);
        let pivot = &above[column * width + panel];
        lu.reciprocals[column] = 1.0 / pivot[lane];
        best = eliminate_column(below, pivot, lane, [width, panel], &scales[column + 1..]);
        best.row += column + 1;
    }
    Ok(())
}

/// Subtracts multiples of the pivot row from the rows below it, within a panel, and stores the multipliers. Returns the
/// best candidate of the next column.
#[inline(always)]
fn eliminate_column(
    below: &mut [Group],
    pivot: &Group,
    lane: usize,
    [width, panel]: [usize; 2],
    scales: &[f64],
) -> Candidate {
    let reciprocal = 1.0 / pivot[lane];
    // The multipliers of the columns before stay: nothing is subtracted. The new one comes out of `0 - factor (-1)`.
    let (mut kept, mut subtrahend) = ([1.0; LANES], *pivot);
    for l in 0..LANES {
        kept[l] = if l == lane { 0.0 } else { 1.0 };
        let fixed = if l == lane { -1.0 } else { 0.0 };
        subtrahend[l] = if l > lane { pivot[l] } else { fixed };
    }
    let next = (lane + 1) % LANES;
    let mut best = Candidate::NONE;
    for (row, (groups, scale)) in below.chunks_exact_mut(width).zip(scales).enumerate() {
        let x = &mut groups[panel];
        let factor = x[lane] * reciprocal;
        // The same operations as below, apart, so that the candidate need not wait for the group to be stored.
        best = best.or(row, x[next] - factor * pivot[next], *scale);
        for l in 0..LANES {
            x[l] = x[l] * kept[l] - factor * subtrahend[l];
        }
    }
    best
}

/// Eliminates the panel from its own rows, to the right of it: `U = L^-1 A`.
#[inline(always)]
fn eliminate_right(pivot_rows: &mut [Group], width: usize, panel: usize) {
    let factors: [Group; LANES] = std::array::from_fn(|row| pivot_rows[row * width + panel]);
    for g in panel + 1..width {
        let mut x: [Group; LANES] = std::array::from_fn(|row| pivot_rows[row * width + g]);
        for row in 1..LANES {
            for k in 0..row {
                for l in 0..LANES {
                    x[row][l] -= factors[row][k] * x[k][l];
                }
            }
        }
        for row in 1..LANES {
            pivot_rows[row * width + g] = x[row];
        }
    }
}

/// Eliminates the panel from `R` rows below it, to the right of it.
#[inline(always)]
fn eliminate_below<const R: usize>(
    rows: &mut [Group],
    pivot_rows: &[Group],
    width: usize,
    panel: usize,
) {
    let factors: [Group; R] = std::array::from_fn(|r| rows[r * width + panel]);
    for g in panel + 1..width {
        let mut x: [Group; R] = std::array::from_fn(|r| rows[r * width + g]);
        for k in 0..LANES {
            let u = pivot_rows[k * width + g];
            for r in 0..R {
                for l in 0..LANES {
                    x[r][l] -= factors[r][k] * u[l];
                }
            }
        }
        for r in 0..R {
            rows[r * width + g] = x[r];
        }
    }
}

/// Solves `L U x = b` in place for as many right-hand sides at once as a group has entries: every row is one.
///
/// Sums are two, which need not wait for each other.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(super) fn substitute_groups(matrix: &Matrix, reciprocals: &[f64], b: &mut [Group]) {
    for row in 1..b.len() {
        let (known, here) = b.split_at_mut(row);
        let sum = sum_of_products(&matrix.row(row)[..row], known);
        for l in 0..LANES {
            here[0][l] -= sum[l];
        }
    }
    for row in (0..b.len()).rev() {
        let (here, known) = b.split_at_mut(row + 1);
        let sum = sum_of_products(&matrix.row(row)[row + 1..], known);
        let here = &mut here[row];
        for l in 0..LANES {
            here[l] = (here[l] - sum[l]) * reciprocals[row];
        }
    }
}

/// Solves `L U x = b` in place.
///
/// What is known from other groups is a sum in lanes, which need not wait for the row before; what is known from the
/// group of the row itself is subtracted one by one, the latest last.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(super) fn substitute(matrix: &Matrix, reciprocals: &[f64], b: &mut [f64]) {
    let (n, width) = (matrix.order, matrix.width());
    for (row, groups) in matrix.groups().chunks_exact(width.max(1)).enumerate() {
        let panel = row / LANES;
        let (known, here) = b.split_at_mut(panel * LANES);
        let sum = add_products([0.0; LANES], &groups[..panel], known.as_chunks().0);
        let (here, value) = here[..=row % LANES].split_at_mut(row % LANES);
        value[0] -= total(&sum);
        for (x, factor) in here.iter().zip(&groups[panel]) {
            value[0] -= factor * x;
        }
    }
    // The last group, filled up with zeros.
    let mut last = [0.0; LANES];
    for (row, groups) in (0..n).zip(matrix.groups().chunks_exact(width.max(1))).rev() {
        let (panel, lane) = (row / LANES, row % LANES);
        let (here, known) = b[panel * LANES..].split_at_mut(LANES.min(n - panel * LANES));
        let mut sum = [0.0; LANES];
        if panel + 1 < width {
            sum = add_products(sum, &groups[panel + 1..], known.as_chunks().0);
            if n % LANES > 0 {
                sum = add_products(sum, &groups[width - 1..], &[last]);
            }
        }
        let (value, here) = here[lane..].split_at_mut(1);
        value[0] -= total(&sum);
        for (x, factor) in here.iter().zip(&groups[panel][lane + 1..]).rev() {
            value[0] -= factor * x;
        }
        value[0] *= reciprocals[row];
        if panel + 1 == width {
            last[lane] = value[0];
        }
    }
}
