//! The equations of motion on one combination of pieces, as a linear system with constant coefficients and no right side.
//!
//! With every contact on one of its affine pieces, `phi = f + k (g - g0) + c g'`, and the waves of load and offsets counted as
//! unknowns, equations (1) to (3) of [`system`](crate::system) read
//!
//! ```text
//! z = (q, q', 1, cos h_1 tau, sin h_1 tau, cos h_2 tau, ...),    z' = A z                                    (1)
//! A = [ 0  I  0 ;  M^-1 B ;  0 0 (rotations by h_i nu) ],    tau' = nu = omega / divisor                     (2)
//! B = [ -K  -C  L ] + sum_c e s^T                                                                            (3)
//! s = ( -k d,  -c d,  k delta + c nu delta_tau + (k g0 - f on the constant) )                                (4)
//! ```
//!
//! where `delta` is the row of the offset's waves and `delta_tau` that of its derivative by phase. A constant and a wave need no
//! particular solution in this form, so none can be large where the motion is small: rest, resonance and no stiffness at all
//! are not special. A derivative is by time: where the frequency alone changes, the equations of the structure stay the same to the last bit. Divided
//! by `nu`, every entry would be rounded anew, and roundings of the stiffest entries move a structure's slow oscillations by far more than
//! one rounding error.
//!
//! Source: Van Loan (1978), Computing integrals involving the matrix exponential, IEEE Trans. Automatic Control 23.

use super::terms::{Basis, ContactTerms, Line, Terms};
use crate::numeric::linear::{Lu, Matrix, Singular};

/// `A` and its derivative, and room to make them.
#[derive(Debug)]
pub(super) struct Assembly {
    /// `A`, row by row.
    pub(super) matrix: Vec<f64>,
    /// Its derivative by the variable asked for at a fixed phase: `nu (A / nu)_p`.
    pub(super) derivative: Vec<f64>,
    mass: Matrix,
    lu: Lu,
    /// `M^-1 B`
    accelerations: Vec<f64>,
    row: Vec<f64>,
    column: Vec<f64>,
}

impl Assembly {
    pub(super) fn new(basis: &Basis) -> Self {
        let (n, order) = (basis.coordinates, basis.order());
        Self {
            matrix: vec![0.0; order * order],
            derivative: vec![0.0; order * order],
            mass: Matrix::zeros(n),
            lu: Lu::new(n),
            accelerations: vec![0.0; n * order],
            row: vec![0.0; order],
            column: vec![0.0; n],
        }
    }

    /// Factorises the mass matrix.
    pub(super) fn set_mass(&mut self, basis: &Basis, terms: &Terms) -> Result<(), Singular> {
        let n = basis.coordinates;
        for row in 0..n {
            self.mass
                .row_mut(row)
                .copy_from_slice(&terms.mass[row * n..][..n]);
        }
        self.lu.factorise(&mut self.mass)
    }

    /// `M^-1 e` of a contact.
    pub(super) fn solve(&self, direction: &mut [f64]) {
        self.lu.solve(&self.mass, direction);
    }

    /// Makes `A` by (2) to (4).
    pub(super) fn assemble(&mut self, basis: &Basis, terms: &Terms, lines: &[Line]) {
        let (n, order, nu) = (basis.coordinates, basis.order(), terms.base);
        let forces = &mut self.accelerations;
        linear_part(basis, terms, forces);
        for (contact, &line) in terms.contacts.iter().zip(lines) {
            self.row.fill(0.0);
            add_row(&mut self.row, basis, contact, line, nu);
            add_constant(&mut self.row, basis, line);
            add_product(forces, &contact.force, &self.row);
        }
        self.divide_by_mass(basis);
        self.matrix.fill(0.0);
        for i in 0..n {
            self.matrix[i * order + n + i] = 1.0;
            let from = &self.accelerations[i * order..][..order];
            self.matrix[(n + i) * order..][..order].copy_from_slice(from);
        }
        for (index, &harmonic) in basis.harmonics.iter().enumerate() {
            let cosine = 2 * n + 1 + 2 * index;
            self.matrix[cosine * order + cosine + 1] = -f64::from(harmonic) * nu;
            self.matrix[(cosine + 1) * order + cosine] = f64::from(harmonic) * nu;
        }
    }

    /// The derivative of `A` by a variable; `A` is the one that was assembled last.
    pub(super) fn differentiate(
        &mut self,
        basis: &Basis,
        terms: &Terms,
        lines: &[Line],
        terms_by: &Terms,
        lines_by: &[Line],
    ) {
        let (n, order, nu) = (basis.coordinates, basis.order(), terms.base);
        let forces = &mut self.accelerations;
        linear_part(basis, terms_by, forces);
        // B' - M' (M^-1 B): the accelerations are those in A.
        for i in 0..n {
            for k in 0..n {
                let mass = terms_by.mass[i * n + k];
                for m in 0..order {
                    forces[i * order + m] -= mass * self.matrix[(n + k) * order + m];
                }
            }
        }
        for (c, contact) in terms.contacts.iter().enumerate() {
            self.row.fill(0.0);
            add_row(&mut self.row, basis, contact, lines[c], nu);
            add_constant(&mut self.row, basis, lines[c]);
            add_product(forces, &terms_by.contacts[c].force, &self.row);
            self.row.fill(0.0);
            add_row(&mut self.row, basis, contact, lines_by[c], nu);
            add_constant(&mut self.row, basis, lines_by[c]);
            add_row(&mut self.row, basis, &terms_by.contacts[c], lines[c], nu);
            let by_rate = lines[c].by_rate * terms_by.base;
            add_offset_rate(&mut self.row, basis, contact, by_rate);
            add_product(forces, &contact.force, &self.row);
        }
        self.divide_by_mass(basis);
        self.derivative.fill(0.0);
        let stretch = terms_by.base / nu;
        for i in 0..n {
            self.derivative[i * order + n + i] = -stretch;
            for m in 0..order {
                let entry = (n + i) * order + m;
                self.derivative[entry] =
                    self.accelerations[i * order + m] - self.matrix[entry] * stretch;
            }
        }
    }

    fn divide_by_mass(&mut self, basis: &Basis) {
        let (n, order) = (basis.coordinates, basis.order());
        for m in 0..order {
            for i in 0..n {
                self.column[i] = self.accelerations[i * order + m];
            }
            self.lu.solve(&self.mass, &mut self.column);
            for i in 0..n {
                self.accelerations[i * order + m] = self.column[i];
            }
        }
    }

    /// Units of `z` in which the entries of `A` are alike in size: coordinates count by the roots of their masses, velocities by the [rate](Self::rate) too, and
    /// the constant and the waves by what they move.
    pub(super) fn units(&self, basis: &Basis, terms: &Terms) -> Vec<f64> {
        let (n, order) = (basis.coordinates, basis.order());
        let rate = self.rate(basis, terms);
        let mut units = vec![1.0; order];
        for i in 0..n {
            units[i] = 1.0 / scale(terms, n, i);
            units[n + i] = rate * units[i];
        }
        let driven = |i: usize| {
            let entries = &self.matrix[(n + i) * order + 2 * n..][..order - 2 * n];
            entries.iter().fold(0.0_f64, |most, x| most.max(x.abs())) / units[n + i]
        };
        let driven = (0..n).map(driven).fold(0.0, f64::max);
        if driven > 0.0 {
            units[2 * n..].fill(rate / driven);
        }
        units
    }

    /// A rate that no coordinate exceeds: its Taylor coefficients in time fall faster than those of `exp(rate s)`. From
    /// `|x''| <= c |x'| + k |x|` with norms of `M^-1 C` and `M^-1 K`, in coordinates scaled by the roots of their masses.
    pub(super) fn rate(&self, basis: &Basis, terms: &Terms) -> f64 {
        let (n, order, nu) = (basis.coordinates, basis.order(), terms.base);
        let scale = |i: usize| scale(terms, n, i);
        let norm = |first: usize| {
            let row = |i: usize| -> f64 {
                let entries = &self.matrix[(n + i) * order + first..][..n];
                let sizes = entries.iter().enumerate();
                scale(i) * sizes.map(|(k, x)| x.abs() / scale(k)).sum::<f64>()
            };
            (0..n).map(row).fold(0.0_f64, f64::max)
        };
        let (stiffness, damping) = (norm(0), norm(n));
        let own = 0.5 * damping + (0.25 * damping * damping + stiffness).sqrt();
        let waves = nu * basis.harmonics.last().map_or(1.0, |&h| f64::from(h));
        if own > waves { own } else { waves }
    }
}

/// The root of the mass of a coordinate.
fn scale(terms: &Terms, n: usize, i: usize) -> f64 {
    let mass = terms.mass[i * n + i].abs();
    if mass > 0.0 { mass.sqrt() } else { 1.0 }
}

/// `[-K -C L]` of (3).
fn linear_part(basis: &Basis, terms: &Terms, forces: &mut [f64]) {
    let (n, order, waves) = (basis.coordinates, basis.order(), basis.waves());
    for (i, row) in forces.chunks_exact_mut(order).enumerate() {
        for k in 0..n {
            row[k] = -terms.stiffness[i * n + k];
            row[n + k] = -terms.damping[i * n + k];
        }
        row[2 * n..].copy_from_slice(&terms.load[i * waves..][..waves]);
    }
}

/// Adds the row (4), but for its constant.
fn add_row(row: &mut [f64], basis: &Basis, contact: &ContactTerms, line: Line, nu: f64) {
    let n = basis.coordinates;
    for (k, d) in contact.gap.iter().enumerate() {
        row[k] -= line.by_gap * d;
        row[n + k] -= line.by_rate * d;
    }
    for (out, delta) in row[2 * n..].iter_mut().zip(&contact.offset) {
        *out += line.by_gap * delta;
    }
    add_offset_rate(row, basis, contact, line.by_rate * nu);
}

/// The constant of the row (4).
fn add_constant(row: &mut [f64], basis: &Basis, line: Line) {
    row[2 * basis.coordinates] += line.by_gap * line.at - line.force;
}

/// Adds `factor delta_tau`.
fn add_offset_rate(row: &mut [f64], basis: &Basis, contact: &ContactTerms, factor: f64) {
    let waves = &mut row[2 * basis.coordinates + 1..];
    let pairs = waves
        .chunks_exact_mut(2)
        .zip(contact.offset[1..].chunks_exact(2));
    for ((pair, offset), &harmonic) in pairs.zip(&basis.harmonics) {
        let factor = factor * f64::from(harmonic);
        pair[0] += factor * offset[1];
        pair[1] -= factor * offset[0];
    }
}

/// Adds `e s^T`.
fn add_product(forces: &mut [f64], e: &[f64], s: &[f64]) {
    for (row, e) in forces.chunks_exact_mut(s.len()).zip(e) {
        for (out, s) in row.iter_mut().zip(s) {
            *out += e * s;
        }
    }
}
