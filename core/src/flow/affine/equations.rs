//! The equations of motion on one combination of pieces, as a linear system with constant coefficients and no right side.
//!
//! With every contact on one of its affine pieces, `phi = f + k (g - g0) + c g'`, and the waves of load and offsets counted as
//! unknowns, equations (1) to (3) of [`system`](crate::system) read
//!
//! ```text
//! z = (q, q', 1, cos h_1 tau, sin h_1 tau, cos h_2 tau, ...),    dz/dtau = A z                               (1)
//! A = [ 0  I/nu  0 ;  M^-1 B / nu ;  0 0 (rotations by h_i) ],    nu = omega / divisor                       (2)
//! B = [ -K  -C  L ] + sum_c e s^T                                                                            (3)
//! s = ( -k d,  -c d,  k delta + c nu delta_tau + (k g0 - f on the constant) )                                (4)
//! ```
//!
//! where `delta` is the row of the offset's waves and `delta_tau` that of its derivative by phase. A constant and a wave need no
//! particular solution in this form, so none can be large where the motion is small: rest, resonance and no stiffness at all
//! are not special.
//!
//! Source: Van Loan (1978), Computing integrals involving the matrix exponential, IEEE Trans. Automatic Control 23.

use crate::law::{Derivatives, Law, On};
use crate::layout::{Entry, Layout, Term};
use crate::linear::{Lu, Matrix, Singular};
use crate::system::{Part, Wave};

/// What the entries of `z` are.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Number of coordinates.
    pub(super) coordinates: usize,
    /// The harmonics of load and offsets, in increasing order.
    pub(super) harmonics: Vec<u32>,
}

impl Basis {
    pub(super) fn of(layout: &Layout) -> Self {
        let loads = layout.load.iter().map(|entry| entry.wave.harmonic);
        let offsets = layout
            .contacts
            .iter()
            .flat_map(|contact| contact.offset.iter().map(|term| term.wave.harmonic));
        let mut harmonics: Vec<_> = loads.chain(offsets).filter(|&h| h > 0).collect();
        harmonics.sort_unstable();
        harmonics.dedup();
        Self {
            coordinates: layout.coordinates,
            harmonics,
        }
    }

    /// Entries of `z`.
    pub(super) fn order(&self) -> usize {
        2 * self.coordinates + self.waves()
    }

    /// The constant and the waves.
    pub(super) fn waves(&self) -> usize {
        1 + 2 * self.harmonics.len()
    }

    /// Position of a wave among the waves; the sine of harmonic zero has none.
    fn position(&self, wave: Wave) -> Option<usize> {
        let sine = usize::from(wave.part == Part::Sine);
        if wave.harmonic == 0 {
            return (sine == 0).then_some(0);
        }
        let index = self.harmonics.binary_search(&wave.harmonic).ok()?;
        Some(1 + 2 * index + sine)
    }

    /// Writes the constant and the waves at a phase.
    pub(super) fn write_waves(&self, phase: f64, waves: &mut [f64]) {
        waves[0] = 1.0;
        for (pair, &harmonic) in waves[1..].chunks_exact_mut(2).zip(&self.harmonics) {
            let (sine, cosine) = (f64::from(harmonic) * phase).sin_cos();
            (pair[0], pair[1]) = (cosine, sine);
        }
    }
}

/// Everything of (1) to (3) that is linear in the coefficients: from them, or from their derivatives by a variable.
#[derive(Debug, Clone)]
pub(super) struct Terms {
    pub(super) mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    load: Vec<f64>,
    pub(super) contacts: Vec<ContactTerms>,
    /// `nu`
    pub(super) base: f64,
}

/// The terms of one contact.
#[derive(Debug, Clone)]
pub(super) struct ContactTerms {
    /// `e`
    pub(super) force: Vec<f64>,
    /// `d`
    pub(super) gap: Vec<f64>,
    /// `delta`, by waves.
    pub(super) offset: Vec<f64>,
    pub(super) arguments: Vec<f64>,
}

impl Terms {
    pub(super) fn new(layout: &Layout, basis: &Basis) -> Self {
        let n = layout.coordinates;
        let contacts = layout.contacts.iter().map(|contact| ContactTerms {
            force: vec![0.0; n],
            gap: vec![0.0; n],
            offset: vec![0.0; basis.waves()],
            arguments: vec![0.0; contact.argument_count],
        });
        Self {
            mass: vec![0.0; n * n],
            damping: vec![0.0; n * n],
            stiffness: vec![0.0; n * n],
            load: vec![0.0; n * basis.waves()],
            contacts: contacts.collect(),
            base: 0.0,
        }
    }

    /// Sets all terms from coefficients.
    pub(super) fn fill(&mut self, layout: &Layout, basis: &Basis, coefficients: &[f64]) {
        let n = layout.coordinates;
        let matrix = |entries: &[Entry], out: &mut [f64]| {
            out.fill(0.0);
            for entry in entries {
                out[entry.row * n + entry.column] += coefficients[entry.coefficient];
            }
        };
        matrix(&layout.mass, &mut self.mass);
        matrix(&layout.damping, &mut self.damping);
        matrix(&layout.stiffness, &mut self.stiffness);
        self.load.fill(0.0);
        for entry in &layout.load {
            if let Some(wave) = basis.position(entry.wave) {
                self.load[entry.row * basis.waves() + wave] += coefficients[entry.coefficient];
            }
        }
        for (contact, terms) in layout.contacts.iter().zip(&mut self.contacts) {
            let constant = |of: &[Term], out: &mut [f64]| {
                out.fill(0.0);
                for term in of {
                    out[term.index] += coefficients[term.coefficient];
                }
            };
            constant(&contact.force, &mut terms.force);
            constant(&contact.gap, &mut terms.gap);
            terms.offset.fill(0.0);
            for term in &contact.offset {
                if let Some(wave) = basis.position(term.wave) {
                    terms.offset[wave] += coefficients[term.coefficient];
                }
            }
            contact.arguments(coefficients, &mut terms.arguments);
        }
    }
}

/// An affine piece: `phi = force + by_gap (g - at) + by_rate g'`, or its derivative by a variable at fixed `at`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Line {
    pub(super) at: f64,
    pub(super) force: f64,
    pub(super) by_gap: f64,
    pub(super) by_rate: f64,
}

impl Line {
    /// A piece of a law.
    pub(super) fn of(law: &dyn Law, arguments: &[f64], levels: &[f64], piece: usize) -> Self {
        let at = end_of(levels, piece);
        let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        law.derivatives(On::Piece(piece), arguments, &[at], &[0.0], out);
        Self {
            at,
            force: force[0],
            by_gap: by_gap[0],
            by_rate: by_rate[0],
        }
    }

    /// Adds the derivative of a piece by one argument, times the derivative of that argument.
    pub(super) fn add_derivative(
        &mut self,
        law: &dyn Law,
        arguments: &[f64],
        levels: &[f64],
        piece: usize,
        (argument, factor): (usize, f64),
    ) {
        let at = end_of(levels, piece);
        // Another gap of the same piece.
        let other = match levels.get(piece) {
            Some(&upper) if upper > at => upper,
            Some(_) => at - 1.0,
            None => at + 1.0,
        };
        let mut by = [0.0; 3];
        let [mut force, mut by_gap, mut by_rate] = [[0.0; 3]; 3];
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        let (gap, rate) = ([at, other, at], [0.0, 0.0, 1.0]);
        let on = On::Piece(piece);
        law.derivatives_and_by(argument, on, arguments, &gap, &rate, out, &mut by);
        self.at = at;
        self.force += factor * by[0];
        self.by_gap += factor * (by[1] - by[0]) / (other - at);
        self.by_rate += factor * (by[2] - by[0]);
    }
}

/// A gap at the end of a piece.
fn end_of(levels: &[f64], piece: usize) -> f64 {
    let level = levels.get(piece.saturating_sub(1));
    level.copied().unwrap_or(0.0)
}

/// `A` and its derivative, and room to make them.
#[derive(Debug)]
pub(super) struct Assembly {
    /// `A`, row by row.
    pub(super) matrix: Vec<f64>,
    /// Its derivative by the variable asked for.
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
            self.matrix[i * order + n + i] = 1.0 / nu;
            let from = &self.accelerations[i * order..][..order];
            for (out, x) in self.matrix[(n + i) * order..][..order].iter_mut().zip(from) {
                *out = x / nu;
            }
        }
        for (index, &harmonic) in basis.harmonics.iter().enumerate() {
            let cosine = 2 * n + 1 + 2 * index;
            self.matrix[cosine * order + cosine + 1] = -f64::from(harmonic);
            self.matrix[(cosine + 1) * order + cosine] = f64::from(harmonic);
        }
    }

    /// The derivative of `A` by a variable; `A` is the one that was assembled last.
    pub(super) fn differentiate(
        &mut self,
        basis: &Basis,
        (terms, lines): (&Terms, &[Line]),
        (terms_by, lines_by): (&Terms, &[Line]),
    ) {
        let (n, order, nu) = (basis.coordinates, basis.order(), terms.base);
        let forces = &mut self.accelerations;
        linear_part(basis, terms_by, forces);
        // B' - M' (M^-1 B): the accelerations are those in A.
        for i in 0..n {
            for k in 0..n {
                let mass = terms_by.mass[i * n + k] * nu;
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
            self.derivative[i * order + n + i] = -stretch / nu;
            for m in 0..order {
                let entry = (n + i) * order + m;
                self.derivative[entry] =
                    self.accelerations[i * order + m] / nu - self.matrix[entry] * stretch;
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

    /// A rate that no coordinate exceeds: its Taylor coefficients in the phase fall faster than those of `exp(rate s)`. From
    /// `|x''| <= c |x'| + k |x|` with norms of `M^-1 C` and `M^-1 K`, in coordinates scaled by the roots of their masses.
    pub(super) fn rate(&self, basis: &Basis, terms: &Terms) -> f64 {
        let (n, order, nu) = (basis.coordinates, basis.order(), terms.base);
        let scale = |i: usize| {
            let mass = terms.mass[i * n + i].abs();
            if mass > 0.0 { mass.sqrt() } else { 1.0 }
        };
        let norm = |first: usize| {
            let row = |i: usize| -> f64 {
                let entries = &self.matrix[(n + i) * order + first..][..n];
                let sizes = entries.iter().enumerate();
                scale(i) * sizes.map(|(k, x)| x.abs() / scale(k)).sum::<f64>()
            };
            (0..n).map(row).fold(0.0_f64, f64::max)
        };
        let (stiffness, damping) = (norm(0) / nu, norm(n));
        let own = 0.5 * damping + (0.25 * damping * damping + stiffness).sqrt();
        let waves = basis.harmonics.last().map_or(1.0, |&h| f64::from(h));
        if own > waves { own } else { waves }
    }
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
