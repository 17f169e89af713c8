//! Scalar products, summed in lanes.
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::{Group, LANES};

/// Scalar product, summed in lanes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    inlined_dot(a, b)
}

/// The same for callers that are compiled for an instruction set.
#[inline(always)]
pub(crate) fn inlined_dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks(), b.as_chunks());
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    total(&add_products([0.0; LANES], a, b)) + rest
}

/// Scalar product of three lists, as long as the shortest, summed in lanes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn weighted_dot(weights: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let n = weights.len().min(a.len()).min(b.len());
    let ((w, w_rest), (a, a_rest), (b, b_rest)) = (
        weights[..n].as_chunks::<LANES>(),
        a[..n].as_chunks::<LANES>(),
        b[..n].as_chunks::<LANES>(),
    );
    let rest = w_rest.iter().zip(a_rest).zip(b_rest);
    let rest: f64 = rest.map(|((w, x), y)| w * x * y).sum();
    let mut sum = [0.0; LANES];
    for ((w, x), y) in w.iter().zip(a).zip(b) {
        for l in 0..LANES {
            sum[l] += w[l] * x[l] * y[l];
        }
    }
    total(&sum) + rest
}

/// Adds the products of two lists of groups, lane by lane; the longer one is cut.
#[inline(always)]
pub(super) fn add_products(mut sum: Group, a: &[Group], b: &[Group]) -> Group {
    for (x, y) in a.iter().zip(b) {
        for l in 0..LANES {
            sum[l] += x[l] * y[l];
        }
    }
    sum
}

/// A row times some columns, which stand row by row.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn times_columns(row: &[f64], columns: &[Group]) -> Group {
    sum_of_products(row, columns)
}

/// The same, in two sums that need not wait for each other.
#[inline(always)]
pub(super) fn sum_of_products(row: &[f64], columns: &[Group]) -> Group {
    let (mut even, mut odd) = ([0.0; LANES], [0.0; LANES]);
    let ((pairs, rest), (two, one)) = (row.as_chunks::<2>(), columns.as_chunks::<2>());
    for ([a, b], [x, y]) in pairs.iter().zip(two) {
        for l in 0..LANES {
            even[l] += a * x[l];
            odd[l] += b * y[l];
        }
    }
    if let ([a], [x]) = (rest, one) {
        for l in 0..LANES {
            even[l] += a * x[l];
        }
    }
    for l in 0..LANES {
        even[l] += odd[l];
    }
    even
}

#[inline(always)]
pub(super) fn total(lanes: &Group) -> f64 {
    ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6]))
        + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]))
}
