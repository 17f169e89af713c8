//! Perturbations of a motion, and its derivative by a variable.
//!
//! Between switches perturbations of the state obey the homogeneous equation; the derivative by a variable has the derivative of
//! the table besides. Where a gap crosses a level into a piece on which the force is larger by `F + D g'`, the phase of the
//! crossing moves with the gap, and the velocities of a perturbation jump,
//!
//! ```text
//! dq'  ->  dq' - M^-1 e ( F / g' + D ) dg,    dg = d . dq  (+ d_p . q - delta_p - level_p)                      (1)
//! ```
//!
//! where the part in brackets belongs to the derivative by the variable `p`. Where the force is continuous, `F = 0`, (1) holds at any
//! rate of the gap, also as it tends to zero.
//!
//! Source: Leine and Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7.

use super::Switch;
use super::crossing::value_and_slope;
use super::model::Model;
use super::table::{COEFFICIENTS, Polynomial, Table};
use crate::time::Tangent;

/// What moving a tangent writes into.
pub(super) struct Workspace<'w> {
    /// Motions, and their derivatives by a variable, as polynomials on a cell.
    pub(super) rows: &'w mut [Polynomial],
    pub(super) rows_by: &'w mut [Polynomial],
    pub(super) column: &'w mut [f64],
    /// What a unit of each coordinate and velocity makes of all of them.
    pub(super) propagator: &'w mut [f64],
}

/// Moves a tangent over some cells of a motion that begins at `z`.
pub(super) fn advance(
    model: &Model,
    table: &Table,
    z: &[f64],
    cells: f64,
    tangent: &mut Tangent,
    workspace: Workspace<'_>,
) {
    let Workspace {
        rows,
        rows_by,
        column: start,
        propagator,
    } = workspace;
    let n = model.basis.coordinates;
    let (cell, s) = table.place(cells);
    let rate = model.terms.base / table.cell;
    let homogeneous = homogeneous(tangent, n);
    table.propagator(cell, s, rate, propagator);
    for (index, column) in tangent.columns.chunks_exact_mut(2 * n).enumerate() {
        start.copy_from_slice(column);
        column.fill(0.0);
        for (unit, x) in propagator.chunks_exact(2 * n).zip(&*start) {
            for (sum, u) in column.iter_mut().zip(unit) {
                *sum += u * x;
            }
        }
        if index < homogeneous {
            continue;
        }
        rows.fill([0.0; COEFFICIENTS]);
        table.add_derivatives(cell, z, rows);
        table.polynomials(cell, z, rows_by);
        let stretch = model.terms_by.base / table.cell;
        for i in 0..n {
            let (value, slope) = value_and_slope(&rows[i], s);
            column[i] += value;
            column[n + i] += slope * rate + value_and_slope(&rows_by[i], s).1 * stretch;
        }
    }
}

/// The saltation (1), where a contact crosses one of its levels, upwards or downwards.
pub(super) fn switch(model: &Model, z: &[f64], switch: Switch, tangent: &mut Tangent) {
    let Switch {
        contact,
        level,
        upwards,
    } = switch;
    let n = model.basis.coordinates;
    let (force, by_rate) = model.jump(contact, level);
    if force == 0.0 && by_rate == 0.0 {
        return;
    }
    let (_, rate) = model.gap(contact, z);
    let steepness = if force == 0.0 {
        by_rate
    } else {
        force / rate + by_rate
    };
    let steepness = if upwards { steepness } else { -steepness };
    let homogeneous = homogeneous(tangent, n);
    let direction = &model.terms.contacts[contact].gap;
    for (index, column) in tangent.columns.chunks_exact_mut(2 * n).enumerate() {
        let mut gap: f64 = direction.iter().zip(&*column).map(|(d, q)| d * q).sum();
        if index >= homogeneous {
            gap += model.gap_by(contact, z) - model.contacts[contact].levels_by[level];
        }
        for (velocity, push) in column[n..].iter_mut().zip(&model.contacts[contact].push) {
            *velocity -= push * steepness * gap;
        }
    }
}

/// Columns that are not the derivative by a variable.
pub(super) fn homogeneous(tangent: &Tangent, coordinates: usize) -> usize {
    tangent.homogeneous(2 * coordinates)
}
