//! Structures whose modes are known.

use std::sync::Arc;

use hertzian::structure::parameter;
use hertzian_structure::{Direction, Load, SparseContact, SparseMatrix, SparseStructure};
use nalgebra::DMatrix;

/// A bar of unit length, stiffness and mass in equal elements, free at its end and clamped at its beginning unless it is free there too.
pub fn bar(elements: usize, free: bool) -> SparseStructure {
    let h = 1.0 / elements as f64;
    let n = if free { elements + 1 } else { elements };
    let of = |own: f64, beside: f64| {
        let entries = (0..elements).flat_map(move |e| {
            let (a, b) = if free {
                (Some(e), e + 1)
            } else {
                (e.checked_sub(1), e)
            };
            let first = a.map(|a| [(a, a, own), (a, b, beside), (b, a, beside)]);
            first.into_iter().flatten().chain([(b, b, own)])
        });
        SparseMatrix::from_triplets(n, n, entries).unwrap()
    };
    SparseStructure::new(of(h / 3.0, h / 6.0), of(1.0 / h, -1.0 / h))
}

/// A cantilever of unit length, bending stiffness and mass in equal Hermite elements: coordinates are deflection and slope of each node.
pub fn beam(elements: usize) -> SparseStructure {
    beam_of(elements, false)
}

/// The same, clamped or free at its beginning.
pub fn beam_of(elements: usize, free: bool) -> SparseStructure {
    let h = 1.0 / elements as f64;
    let stiffness = [
        [12.0, 6.0 * h, -12.0, 6.0 * h],
        [6.0 * h, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
        [-12.0, -6.0 * h, 12.0, -6.0 * h],
        [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
    ];
    let mass = [
        [156.0, 22.0 * h, 54.0, -13.0 * h],
        [22.0 * h, 4.0 * h * h, 13.0 * h, -3.0 * h * h],
        [54.0, 13.0 * h, 156.0, -22.0 * h],
        [-13.0 * h, -3.0 * h * h, -22.0 * h, 4.0 * h * h],
    ];
    let clamped = if free { 0 } else { 2 };
    let n = 2 * elements + 2 - clamped;
    let of = |element: [[f64; 4]; 4], factor: f64| {
        let mut entries = Vec::new();
        for e in 0..elements {
            for (i, row) in element.iter().enumerate() {
                for (j, value) in row.iter().enumerate() {
                    let place = |k: usize| (2 * e + k).checked_sub(clamped);
                    if let (Some(i), Some(j)) = (place(i), place(j)) {
                        entries.push((i, j, factor * value));
                    }
                }
            }
        }
        SparseMatrix::from_triplets(n, n, entries).unwrap()
    };
    SparseStructure::new(of(mass, h / 420.0), of(stiffness, 1.0 / h.powi(3)))
}

hertzian::law! {
    /// An elastic stop.
    Stop(gap, k >= 0) { gap > 0 => k*gap, else => 0 }
}

/// A force at one coordinate, a stop at another one, whose displacement is the output `stopped`.
pub fn stopped(
    structure: SparseStructure,
    drive: f64,
    k: f64,
    distance: f64,
    at: [usize; 2],
) -> SparseStructure {
    let [driven, stopped] = at.map(Direction::at);
    structure
        .load(Load::force(driven, parameter("drive", drive)))
        .contact(
            SparseContact::new("stop", Arc::new(Stop), stopped.clone())
                .arguments([k])
                .offset(distance),
        )
        .output("stopped", stopped)
}

/// The same matrix with all of its entries.
pub fn dense(matrix: &SparseMatrix) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(matrix.rows(), matrix.columns());
    for (row, column, value) in matrix.triplets() {
        dense[(row, column)] = value;
    }
    dense
}
