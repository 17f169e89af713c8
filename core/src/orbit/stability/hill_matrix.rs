//! The linearised equation of motion in the frequency domain.
//!
//! With phase derivatives, a perturbation obeys `q'' + T q' + S q = 0`, where `S(tau) = M^-1 S / Omega^2` and
//! `T(tau) = M^-1 T / Omega` of (2) of [`linearised`](super::linearised). Their Fourier coefficients are those of the balance's
//! Jacobian: integrated from switch to switch, with an impulse where the force jumps, if the forces of the orbit are. With
//! `z = q' + T q` as the second half of the state, `q' = z - T q` and `z' = -(S - T') q`: where a force jumps because its damping
//! does, the impulse of `S` and that of `T'` cancel, and coefficients fall faster. Let a hat stand for the multiplication of series of
//! `H` harmonics by such a function, and `D` for their derivative. The Hill matrix is
//!
//! ```text
//! H = [ -D - T^         I ]
//!     [ -(S - T')^     -D ]                                                                                  (1)
//! ```
//!
//! A solution `e^(sigma tau) (p(tau), r(tau))` with periodic `p` and `r` is an eigenvector of it. (The eigenvalues are those of
//! the truncated equation of second order, for the product rule `D T^ = T^ D + (T')^` survives the truncation.)
//! In the basis `cos k tau, sin k tau`, and with whole or half numbers `k` alike,
//!
//! ```text
//! S^ : cos m -> sum_l (C_(l-m) + C_(l+m))/2 cos l + (S_(l+m) + S_(l-m))/2 sin l
//!      sin m -> sum_l (S_(l+m) - S_(l-m))/2 cos l + (C_(l-m) - C_(l+m))/2 sin l                              (2)
//! ```
//!
//! with `C` even, `S` odd and `C_0` twice the mean; the mean is the row and column of `k = 0`, its row halved.
//!
//! Source: Hill (1886); Lazarus and Thomas (2010), A harmonic-based method for computing the stability of periodic solutions
//! of dynamical systems, C. R. Mecanique 338 (second-order systems); Krack and Gross (2019), Harmonic Balance for Nonlinear
//! Vibration Problems, appendix (real basis).

use nalgebra::DMatrix;

use super::orbit::Orbit;
use crate::balance::aft::{ContactDerivatives, ContactForces, ContactInput};
use crate::balance::rate_series;
use crate::balance::terms::{add_derivative, stretched};
use crate::model::layout::{ContactLayout, Term};
use crate::numeric::fourier::series;
use crate::system::Wave;

/// Rows of a Hill matrix, at most: more take too long, and too much memory, since its exponential needs ten of them at once.
const MOST_ROWS: usize = 4000;

/// Fourier coefficients of `S - T'` and `T`.
#[derive(Debug)]
pub(super) struct Coefficients {
    /// Number of coordinates.
    coordinates: usize,
    /// Harmonics of a perturbation; those of the coefficients are twice as many.
    harmonics: usize,
    /// Row by row; each a series.
    stiffness: Vec<Vec<f64>>,
    damping: Vec<Vec<f64>>,
    /// Evaluations of contacts.
    pub(super) contacts: usize,
}

/// Which harmonics a perturbation has in the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lattice {
    /// 0, 1, 2, ..., H
    Whole,
    /// 1/2, 3/2, ..., H - 1/2
    Half,
}

impl Lattice {
    /// Number of cosines, the mean included.
    pub(super) fn cosines(self, harmonics: usize) -> usize {
        harmonics + usize::from(self == Self::Whole)
    }

    /// Entries of a series.
    pub(super) fn length(self, harmonics: usize) -> usize {
        2 * harmonics + usize::from(self == Self::Whole)
    }
}

impl Coefficients {
    /// Of an orbit, for perturbations with as many harmonics as the orbit. `None` if the mass matrix is singular or a coefficient
    /// is not finite.
    pub(super) fn of(orbit: &Orbit<'_>) -> Option<Self> {
        let n = orbit.layout.coordinates;
        let harmonics = orbit.series.len() / n / 2;
        if 2 * n * Lattice::Whole.length(harmonics) > MOST_ROWS {
            return None;
        }
        let zeros = || vec![vec![0.0; series::length(2 * harmonics)]; n * n];
        let mut all = Self {
            coordinates: n,
            harmonics,
            stiffness: zeros(),
            damping: zeros(),
            contacts: 0,
        };
        for entry in &orbit.layout.stiffness {
            let wave = stretched(entry.wave, orbit.period);
            let to = &mut all.stiffness[entry.row * n + entry.column];
            let value = orbit.coefficients[entry.coefficient];
            series::add_wave(to, wave.harmonic as usize, wave.part, value);
        }
        for entry in &orbit.layout.damping {
            all.damping[entry.row * n + entry.column][0] += orbit.coefficients[entry.coefficient];
        }
        let mut aft = orbit.aft.engine(orbit.samples);
        for contact in &orbit.layout.contacts {
            all.add_contact(orbit, contact, aft.as_mut());
        }
        all.divide(orbit)?;
        for (stiffness, damping) in all.stiffness.iter_mut().zip(&all.damping) {
            add_derivative(damping, -1.0, stiffness);
        }
        let entries = all.stiffness.iter().chain(&all.damping);
        let finite = entries.flatten().all(|x| x.is_finite());
        finite.then_some(all)
    }

    /// Adds `e (phi_g d + phi_r dd/dt)` to the stiffness and `e phi_r d` to the damping.
    fn add_contact(
        &mut self,
        orbit: &Orbit<'_>,
        contact: &ContactLayout,
        aft: &mut dyn ContactForces,
    ) {
        let n = self.coordinates;
        let period = orbit.period;
        let mut gap = Vec::new();
        orbit.gap(contact, &mut gap);
        let mut rate = gap.clone();
        rate_series(&gap, orbit.base, &mut rate);
        let mut arguments = vec![0.0; contact.argument_count];
        contact.arguments(orbit.coefficients, &mut arguments);
        let waves = (contact.force_harmonic() + contact.gap_harmonic()) * period;
        let slopes = series::length(2 * self.harmonics + waves);
        let (mut by_gap, mut by_rate) = (vec![0.0; slopes], vec![0.0; slopes]);
        let mut by_parameter = vec![0.0; 1];
        let mut force = vec![0.0; series::length(self.harmonics)];
        let input = ContactInput {
            law: orbit.system.law(contact.law),
            arguments: &arguments,
            gap: &gap,
            rate: &rate,
            base: orbit.base,
        };
        let mut out = ContactDerivatives {
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
            by_parameter: &mut by_parameter,
        };
        aft.derivatives(input, None, &mut force, &mut out);
        self.contacts += 1;
        let value = |term: &Term| orbit.coefficients[term.coefficient];
        for e in &contact.force {
            for d in &contact.gap {
                let waves = [e.wave, d.wave].map(|wave| stretched(wave, period));
                let factor = value(e) * value(d);
                let (stiffness, damping) = (
                    &mut self.stiffness[e.index * n + d.index],
                    &mut self.damping[e.index * n + d.index],
                );
                add_twice(&by_gap, waves, factor, stiffness);
                add_twice(&by_rate, waves, factor, damping);
                let [e, d] = waves;
                if d.harmonic > 0 {
                    let (slope, sign) = d.derivative();
                    let turn = sign * f64::from(d.harmonic) * orbit.base;
                    add_twice(&by_rate, [e, slope], factor * turn, stiffness);
                }
            }
        }
    }

    /// Divides by the mass matrix, and by the base frequency to make derivatives those by phase.
    fn divide(&mut self, orbit: &Orbit<'_>) -> Option<()> {
        let n = self.coordinates;
        let inverse = orbit.layout.mass(orbit.coefficients).try_inverse()?;
        let base = orbit.base;
        for (matrix, unit) in [
            (&mut self.stiffness, base * base),
            (&mut self.damping, base),
        ] {
            let before = std::mem::take(matrix);
            for i in 0..n {
                for j in 0..n {
                    let mut sum = vec![0.0; before[j].len()];
                    for k in 0..n {
                        let factor = inverse[(i, k)] / unit;
                        for (to, from) in sum.iter_mut().zip(&before[k * n + j]) {
                            *to += factor * from;
                        }
                    }
                    matrix.push(sum);
                }
            }
        }
        Some(())
    }

    pub(super) fn coordinates(&self) -> usize {
        self.coordinates
    }

    pub(super) fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// The determinant of the monodromy matrix, by Liouville's formula: `exp(-int trace T)`.
    pub(super) fn determinant(&self) -> f64 {
        let n = self.coordinates;
        let trace: f64 = (0..n).map(|i| self.damping[i * n + i][0]).sum();
        (-std::f64::consts::TAU * trace).exp()
    }

    /// Largest coefficient of each harmonic, in the complex form and as an entry of the matrix of the first order whose halves are
    /// scaled by `unit`; for estimates of their decay.
    pub(super) fn sizes(&self, unit: f64) -> Vec<f64> {
        let n = self.coordinates;
        let size = |of: &[Vec<f64>], k: usize| {
            let square = |series: &Vec<f64>| {
                if k == 0 {
                    series[0] * series[0]
                } else {
                    0.25 * (series[2 * k - 1].powi(2) + series[2 * k].powi(2))
                }
            };
            of.iter().map(square).sum::<f64>()
        };
        (0..=2 * self.harmonics)
            .map(|k| {
                let unity = if k == 0 { n as f64 * unit * unit } else { 0.0 };
                let stiffness = size(&self.stiffness, k) / (unit * unit);
                (unity + stiffness + size(&self.damping, k)).sqrt()
            })
            .collect()
    }

    /// The Hill matrix (1). The state is the displacements and then `z`, coordinate by coordinate; a series is
    /// `[mean,] cos, sin, cos, sin, ...`.
    pub(super) fn matrix(&self, lattice: Lattice) -> DMatrix<f64> {
        let n = self.coordinates;
        let length = lattice.length(self.harmonics);
        let half = n * length;
        let mut matrix = DMatrix::zeros(2 * half, 2 * half);
        for i in 0..2 * n {
            subtract_derivative(&mut matrix, i * length, length, lattice);
        }
        for i in 0..half {
            matrix[(i, half + i)] = 1.0;
        }
        for i in 0..n {
            for j in 0..n {
                let (stiffness, damping) = (&self.stiffness[i * n + j], &self.damping[i * n + j]);
                let [above, below] = [i * length, half + i * length];
                self.subtract(stiffness, lattice, &mut matrix, [below, j * length]);
                self.subtract(damping, lattice, &mut matrix, [above, j * length]);
            }
        }
        matrix
    }

    /// Subtracts (2) from a block.
    fn subtract(
        &self,
        series: &[f64],
        lattice: Lattice,
        matrix: &mut DMatrix<f64>,
        [top, left]: [usize; 2],
    ) {
        let count = lattice.cosines(self.harmonics);
        let cosine = |k: isize| match k.unsigned_abs() {
            0 => 2.0 * series[0],
            k => series[2 * k - 1],
        };
        let sine = |k: isize| match k.unsigned_abs() {
            0 => 0.0,
            index => (k.signum() as f64) * series[2 * index],
        };
        for a in 0..count {
            for b in 0..count {
                // The harmonics are `a` and `b`, or half a harmonic more.
                let half = isize::from(lattice == Lattice::Half);
                let (difference, sum) = (a as isize - b as isize, (a + b) as isize + half);
                let (mean_row, mean_column) = (a == 0 && half == 0, b == 0 && half == 0);
                // Projected on the mean, a cosine gives half of what it gives on another.
                let unit = if mean_row { 0.25 } else { 0.5 };
                let (row, column) = (top + place(lattice, a), left + place(lattice, b));
                let (same, mirrored) = (cosine(difference), cosine(sum));
                let (odd, mirrored_odd) = (sine(difference), sine(sum));
                matrix[(row, column)] -= unit * (same + mirrored);
                if !mean_column {
                    matrix[(row, column + 1)] -= unit * (mirrored_odd - odd);
                }
                if !mean_row {
                    matrix[(row + 1, column)] -= unit * (mirrored_odd + odd);
                }
                if !(mean_row || mean_column) {
                    matrix[(row + 1, column + 1)] -= unit * (same - mirrored);
                }
            }
        }
    }
}

/// Place of a cosine in a series.
pub(super) fn place(lattice: Lattice, index: usize) -> usize {
    match lattice {
        Lattice::Whole => (2 * index).saturating_sub(1),
        Lattice::Half => 2 * index,
    }
}

/// `D: (c, s) -> (k s, -k c)`
fn subtract_derivative(matrix: &mut DMatrix<f64>, start: usize, length: usize, lattice: Lattice) {
    let (first, shift) = match lattice {
        Lattice::Whole => (1, 0.0),
        Lattice::Half => (0, -0.5),
    };
    for (index, place) in (start + first..start + length).step_by(2).enumerate() {
        let k = (index + 1) as f64 + shift;
        matrix[(place, place + 1)] -= k;
        matrix[(place + 1, place)] += k;
    }
}

/// Adds `factor e(tau) d(tau) series(tau)`.
fn add_twice(from: &[f64], [e, d]: [Wave; 2], factor: f64, to: &mut [f64]) {
    if d.harmonic == 0 {
        series::add_product(from, e, factor, to);
    } else {
        let mut workspace = vec![0.0; from.len()];
        series::add_product(from, d, factor, &mut workspace);
        series::add_product(&workspace, e, 1.0, to);
    }
}
