//! What the harmonics and samples that were left out would change.
//!
//! The orbit is put into a balance of twice the harmonics and samples. What contacts couple of the harmonics above `K` is small
//! beside their inertia, so their part of the residual gives them one by one, and the residual that they leave in the first `K`
//! harmonics gives the change of those by one step with the factors at hand:
//!
//! ```text
//! v_k = -( K_0 + i k Omega C - (k Omega)^2 M )^-1 R_k(u, 0),  K < k <= 2 K;      du = -B^-1 [ R_1..K(u, v) ; 0 ]    (1)
//! ```
//!
//! with complex amplitudes, and `K_0` the part of the linear stiffness that is constant. What harmonics above `2 K` do that meet a
//! linear mode is bounded by extrapolation ([`modes`]), and added to the change of the orbit; its part in the error of an event is not.
//!
//! Where contact forces are integrated exactly, the orbit leaves no residual in the first `K` harmonics, `R_1..K(u, 0) = 0`. Then
//! only what depends on the tail is evaluated: the contacts, and the stiffness that varies.
//!
//! What this changes of the peak-to-peak of a coordinate is, to first order, its value where the largest value lies less that
//! where the smallest lies. It may vanish at one orbit of a branch, when contributions of opposite sign cancel, and tells
//! nothing then of the harmonics beyond. So three contributions are taken by their sizes,
//!
//! ```text
//! | du | + | v from K to 3/2 K | + | v from 3/2 K to 2 K |,                                                  (2)
//! ```
//!
//! which do not vanish together. To second order the extremes move as well: with the slope `d` of the change and the curvature `c`
//! of the orbit there, each adds `d^2 / 2 c`, which counts where a harmonic meets a resonance and is a quarter of its period late.
//!
//! A contact that is stiffer than the inertia of the tail, and a Jacobian that changes with the orbit, as beside a resonance that is
//! not resolved, make (1) a first step only. What the contacts couple of `v` is in the residual that `v` leaves in its own harmonics: as a part
//! of the residual before, harmonic by harmonic, it tells how the next step would be to this one. Where it is large, where (1) is not small, or
//! harmonics are few, more such steps are made with the residual of the finer balance, and what they do not settle is bounded by how fast they
//! fall ([`chord`]).
//!
//! Source: the tail as a diagonal follows Grolet and Thouverez (2012), On a new harmonic selection technique for harmonic
//! balance method, where the residual of omitted harmonics steers their number; (1) turns it into a corrected orbit.

mod change;
mod chord;
mod modes;

use nalgebra::{DMatrix, DVector};

use modes::Modes;

use crate::balance::aft::Aft;
use crate::balance::alike::Alike;
use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::newton::Newton;
use crate::continuation::problem::Problem;
use crate::model::layout::add_constant;
use crate::numeric::fourier::series;
use crate::system::{System, Variable};

/// The change by the harmonics from `K` to `2 K` times this is that by all above `K`, where it falls as `K^-1.6` or faster.
pub(crate) const BEYOND: f64 = 1.5;
/// What contacts couple of the tail is measured in its first harmonics, which hold all of its square but this part.
const UNMEASURED: f64 = 0.1;
/// Size of a correction, in parts of the orbit, that Newton's method leaves.
pub(crate) const NOTHING: f64 = 1e-13;
/// Size of an oscillation, in parts of the mean, that is one of rounding.
const STILL: f64 = 1e-12;
/// Relative error of an event that rounding leaves.
const ROUNDING: f64 = 1e-12;

/// A finer balance of the same system, and workspace for its vectors.
#[derive(Debug)]
pub(crate) struct RefinedBalance<'a> {
    balance: Balance<'a>,
    coarse: Resolution,
    /// The orbit with its tail, extended.
    orbit: Vec<f64>,
    residual: Vec<f64>,
    /// Residual in the harmonics of the coarse balance, extended by a zero.
    core: Vec<f64>,
    /// Mass, damping and constant stiffness, each row by row.
    linear: [Vec<f64>; 3],
    /// Linear modes, and bounds on the amplitudes of the harmonics above the tail that meet one, for each coordinate.
    modes: Modes,
    beyond: Vec<f64>,
    /// The coarse balance, where contact forces are exact.
    plain: Option<Balance<'a>>,
    /// Series of a contact force.
    force: Vec<f64>,
    /// The tail alone.
    without_core: Vec<f64>,
    /// The last orbit corrected further, and before its last step.
    further: Vec<f64>,
    before: Vec<f64>,
    change: f64,
    /// Residual of the tail before it was added, and what contacts couple of it to its inertia.
    alone: Vec<f64>,
    coupled: f64,
    /// The highest harmonic in which that is measured.
    measured: usize,
}

impl<'a> RefinedBalance<'a> {
    pub(crate) fn new(
        system: &'a dyn System,
        parameters: &[f64],
        omega: f64,
        variable: Variable,
        coarse: Resolution,
    ) -> Self {
        let fine = Resolution {
            // An orbit of one odd harmonic has its next one at three, whether the system is odd or the orbit alone.
            harmonics: (2 * coarse.harmonics
                + if coarse.parity == Parity::Odd {
                    coarse.stride
                } else {
                    0
                })
            .max(coarse.harmonics + 2 * coarse.period * coarse.stride),
            core: 0,
            samples: 2 * coarse.samples,
            ..coarse
        };
        let of = |resolution| Balance::new(system, parameters, omega, variable, resolution);
        let (balance, plain) = (of(fine), of(coarse));
        let unknowns = balance.unknowns();
        let coordinates = balance.layout().coordinates;
        Self {
            coarse,
            orbit: vec![0.0; unknowns + 1],
            residual: vec![0.0; unknowns],
            core: vec![0.0; coordinates * series::length(coarse.harmonics) + 1],
            linear: Default::default(),
            modes: Modes::default(),
            beyond: vec![0.0; coordinates],
            force: vec![0.0; series::length(balance.force_harmonics())],
            measured: fine.harmonics,
            plain: (coarse.aft == Aft::Switched).then_some(plain),
            without_core: Vec::new(),
            further: Vec::new(),
            before: Vec::new(),
            change: f64::INFINITY,
            alone: Vec::new(),
            coupled: 0.0,
            balance,
        }
    }

    /// The finer balance, set to the parameter of the last orbit.
    pub(crate) fn balance(&self) -> &Balance<'a> {
        &self.balance
    }

    /// The series of the last corrected orbit, coordinate by coordinate.
    pub(crate) fn series(&self) -> &[f64] {
        &self.orbit[..self.residual.len()]
    }

    /// The same, extended by the parameter.
    pub(crate) fn extended(&self) -> &[f64] {
        &self.orbit
    }

    /// Adds the tail to an orbit of the coarse balance. Returns the residual that is left in the coarse harmonics,
    /// extended by a zero; `None` if a matrix of (1) is singular or the residual is not finite.
    pub(crate) fn add_tail(&mut self, u: &[f64], newton: &mut Newton) -> Option<&mut [f64]> {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let coordinates = self.balance.layout().coordinates;
        self.orbit.fill(0.0);
        for i in 0..coordinates {
            self.orbit[i * fine..][..coarse].copy_from_slice(&u[i * coarse..][..coarse]);
        }
        let last = self.orbit.len() - 1;
        self.orbit[last] = u[u.len() - 1];
        if self.plain.is_some() {
            self.exact_tail(u)?;
        } else {
            self.sampled_tail()?;
        }
        newton.statistics.residuals += 2;
        self.core
            .iter()
            .all(|x| x.is_finite())
            .then_some(&mut self.core)
    }

    /// By residuals with all terms.
    fn sampled_tail(&mut self) -> Option<()> {
        self.balance.evaluate(&self.orbit, &mut self.residual, None);
        self.solve_tail()?;
        self.alone.clone_from(&self.residual);
        self.balance.evaluate(&self.orbit, &mut self.residual, None);
        self.measure_coupling(false);
        self.core.fill(0.0);
        self.add_core(1.0);
        Some(())
    }

    /// The harmonic up to which those of the tail hold all of its square but [`UNMEASURED`]: inertia grows with the square of a harmonic, and
    /// harmonics fall, unless one of them meets a mode.
    fn first_harmonics(&self) -> usize {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let n = self.balance.layout().coordinates;
        let square = |entry: usize| {
            let rows = (0..n).map(|i| &self.orbit[i * fine + entry..][..2]);
            rows.map(|pair| pair[0].powi(2) + pair[1].powi(2))
                .sum::<f64>()
        };
        let entries = (coarse..fine).step_by(2);
        let most = UNMEASURED * entries.clone().map(square).sum::<f64>();
        let mut beyond = 0.0;
        let last = entries.rev().find(|&entry| {
            beyond += square(entry);
            beyond > most
        });
        last.map_or(self.coarse.harmonics, |entry| entry.div_ceil(2))
    }

    /// What contacts couple of the tail that was added to its inertia, from the residual that it leaves, or from the forces on it alone:
    /// the next step of the tail to this one, harmonic by harmonic, up to the highest that is measured.
    fn measure_coupling(&mut self, forces: bool) {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let n = self.balance.layout().coordinates;
        let (mut next, mut this) = (0.0, 0.0);
        for entry in (coarse..series::length(self.measured)).step_by(2) {
            let [mut tail, mut before, mut left] = [0.0; 3];
            for at in (0..n).flat_map(|i| [i * fine + entry, i * fine + entry + 1]) {
                let own = if forces { self.alone[at] } else { 0.0 };
                tail += self.orbit[at].powi(2);
                before += self.alone[at].powi(2);
                left += (self.residual[at] - own).powi(2);
            }
            if before > 0.0 {
                this += tail;
                next += tail * left / before;
            }
        }
        self.coupled = if next > 0.0 {
            (next / this).sqrt()
        } else {
            0.0
        };
    }

    /// By contacts alone, where the orbit leaves no residual in the coarse harmonics.
    fn exact_tail(&mut self, u: &[f64]) -> Option<()> {
        let value = u[u.len() - 1];
        self.balance.set(value);
        self.residual.fill(0.0);
        if let Some(plain) = &mut self.plain {
            plain.set(value);
            for index in 0..plain.alike.len() {
                let Alike { contact, count } = plain.alike[index];
                plain.contact_force(u, contact, &mut self.force);
                self.balance
                    .add_in_direction(contact, count, &self.force, &mut self.residual);
            }
            self.balance.keep_unknowns(&mut self.residual);
        }
        self.core.fill(0.0);
        self.add_core(-1.0);
        self.add_stiffness();
        self.solve_tail()?;
        self.alone.clone_from(&self.residual);
        self.measured = self.first_harmonics();
        // Those of a force reach farther where its direction moves.
        let beside = self.balance.force_harmonics() - self.balance.resolution().harmonics;
        let short = series::length(self.measured + beside);
        self.residual.fill(0.0);
        for index in 0..self.balance.alike.len() {
            let Alike { contact, count } = self.balance.alike[index];
            let force = &mut self.force[..short];
            self.balance.contact_force(&self.orbit, contact, force);
            self.balance
                .add_in_direction(contact, count, force, &mut self.residual);
        }
        self.measure_coupling(true);
        self.balance.keep_unknowns(&mut self.residual);
        self.add_stiffness_of_tail();
        self.add_core(1.0);
        Some(())
    }

    /// Adds the stiffness where it varies: elsewhere it does not couple harmonics.
    fn add_stiffness(&mut self) {
        let entries = &self.balance.layout().stiffness;
        if entries.iter().any(|entry| entry.wave.harmonic > 0) {
            let coefficients = self.balance.coefficients();
            self.balance
                .add_stiffness(coefficients, &self.orbit, &mut self.residual);
        }
    }

    /// The same, of the tail alone.
    fn add_stiffness_of_tail(&mut self) {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        self.without_core.clone_from(&self.orbit);
        for series in self.without_core.chunks_exact_mut(fine) {
            series[..coarse].fill(0.0);
        }
        std::mem::swap(&mut self.orbit, &mut self.without_core);
        self.add_stiffness();
        std::mem::swap(&mut self.orbit, &mut self.without_core);
    }

    /// Adds a multiple of the residual in the coarse harmonics to that of the core.
    fn add_core(&mut self, factor: f64) {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let rows = self.core.chunks_exact_mut(coarse);
        for (to, from) in rows.zip(self.residual.chunks_exact(fine)) {
            for (to, from) in to.iter_mut().zip(from) {
                *to += factor * from;
            }
        }
    }

    /// Adds `v` of (1), from the residual, and bounds what is beyond it; `None` where a matrix is singular.
    fn solve_tail(&mut self) -> Option<()> {
        self.write_linear();
        self.beyond.fill(0.0);
        self.modes.add_bounds(
            &self.balance,
            &self.linear,
            &self.residual,
            &mut self.beyond,
        );
        self.move_tail()
    }

    /// Adds `v` of (1) to the harmonics of the tail, with the matrices written last.
    fn move_tail(&mut self) -> Option<()> {
        let fine = self.balance.length();
        let n = self.balance.layout().coordinates;
        let base = self.balance.base();
        let [mass, damping, stiffness] = &self.linear;
        let stride = self.coarse.stride;
        let last = self.balance.resolution().harmonics;
        for k in (self.coarse.harmonics + 1..=last).filter(|k| k.is_multiple_of(stride)) {
            let frequency = base * k as f64;
            let real = |entry: usize| stiffness[entry] - frequency * frequency * mass[entry];
            let imaginary = |entry: usize| frequency * damping[entry];
            let at = |i: usize| i * fine + 2 * k - 1;
            if n == 1 {
                let (a, b) = (real(0), imaginary(0));
                let square = a * a + b * b;
                if square == 0.0 {
                    return None;
                }
                let (c, s) = (self.residual[at(0)], self.residual[at(0) + 1]);
                self.orbit[at(0)] += (b * s - a * c) / square;
                self.orbit[at(0) + 1] -= (b * c + a * s) / square;
                continue;
            }
            let matrix = dynamic_stiffness(n, real, imaginary);
            let residual = DVector::from_fn(2 * n, |row, _| -self.residual[at(row % n) + row / n]);
            let tail = matrix.lu().solve(&residual)?;
            for (row, &value) in tail.iter().enumerate() {
                self.orbit[at(row % n) + row / n] += value;
            }
        }
        Some(())
    }

    /// Writes what of mass, damping and stiffness is constant, each row by row.
    fn write_linear(&mut self) {
        let layout = self.balance.layout();
        let coefficients = self.balance.coefficients();
        for matrix in &mut self.linear {
            matrix.clear();
            matrix.resize(layout.coordinates * layout.coordinates, 0.0);
        }
        for (matrix, entries) in
            self.linear
                .iter_mut()
                .zip([&layout.mass, &layout.damping, &layout.stiffness])
        {
            add_constant(entries, coefficients, layout.coordinates, matrix);
        }
    }

    /// Adds the tail and the change of the coarse harmonics, (1); false if that fails.
    pub(crate) fn correct(&mut self, u: &[f64], newton: &mut Newton) -> bool {
        if self.add_tail(u, newton).is_none() {
            return false;
        }
        self.move_core(newton);
        let last = self.orbit.len() - 1;
        self.balance.set(self.orbit[last]);
        self.measure(u);
        self.orbit.iter().all(|x| x.is_finite())
    }

    /// Moves the corrected orbit along a direction of the coarse balance.
    pub(crate) fn move_along(&mut self, u: &[f64], direction: &[f64], by: f64) {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let last = self.orbit.len() - 1;
        let rows = self.orbit[..last].chunks_exact_mut(fine);
        for (to, along) in rows.zip(direction.chunks_exact(coarse)) {
            for (to, along) in to.iter_mut().zip(along) {
                *to += by * along;
            }
        }
        self.orbit[last] += by * direction[direction.len() - 1];
        self.balance.set(self.orbit[last]);
        self.measure(u);
    }

    /// Adds `du` of (1), from the residual in the coarse harmonics.
    fn move_core(&mut self, newton: &mut Newton) {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        newton.solve(&mut self.core);
        for i in 0..self.balance.layout().coordinates {
            for index in 0..coarse {
                self.orbit[i * fine + index] -= self.core[i * coarse + index];
            }
        }
        let last = self.orbit.len() - 1;
        self.orbit[last] -= self.core[self.core.len() - 1];
    }

    /// Compares the corrected orbit with the other one.
    fn measure(&mut self, u: &[f64]) {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let mut largest = (0.0_f64, 0.0_f64);
        let series = self.orbit.chunks_exact(fine).zip(u.chunks_exact(coarse));
        for ((corrected, plain), beyond) in series.zip(&self.beyond) {
            let (same, tail) = corrected.split_at(coarse);
            let core = same.iter().zip(plain).map(|(a, b)| (a - b).abs());
            let change: f64 = core.chain(tail.iter().map(|x| x.abs())).sum();
            let change = change + beyond;
            let oscillation: f64 = plain[1..].iter().map(|x| x.abs()).sum();
            let size = oscillation.max(STILL * plain[0].abs());
            largest = (largest.0.max(change), largest.1.max(size));
        }
        // An orbit at rest is known to rounding of where it is.
        let (change, size) = largest;
        self.change = if change > 0.0 { change / size } else { 0.0 };
    }

    /// A bound on the change of a coordinate by the last correction, relative to the size of the largest oscillation.
    pub(crate) fn change(&self) -> f64 {
        self.change
    }

    /// How much the peak-to-peak of a coordinate is changed by the last correction, (2), given the phases of the smallest and
    /// the largest value.
    pub(crate) fn peak_to_peak_change(
        &self,
        u: &[f64],
        coordinate: usize,
        phases: [f64; 2],
    ) -> f64 {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let corrected = &self.orbit[coordinate * fine..][..fine];
        let before = &u[coordinate * coarse..][..coarse];
        let (few, many) = (series::harmonics(before), series::harmonics(corrected));
        let part = |k: usize| usize::from(k > few) + usize::from(k > few.midpoint(many));
        let mut parts = [0.0; 3];
        let (mut moved, mut most) = (0.0, 0.0);
        for (tau, sign) in phases.into_iter().zip([-1.0, 1.0]) {
            let (sine, cosine) = tau.sin_cos();
            let (mut c, mut s) = (sign, 0.0);
            let (mut slope, mut curvature) = (0.0, 0.0);
            for k in 1..=many {
                (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
                let rate = k as f64;
                for (index, wave, turned) in [(2 * k - 1, c, -s), (2 * k, s, c)] {
                    let old = before.get(index).copied().unwrap_or(0.0);
                    let change = corrected[index] - old;
                    parts[part(k)] += change * wave;
                    slope += change * rate * turned;
                    curvature += old * rate * rate * wave;
                    most += change.abs();
                }
            }
            if slope != 0.0 {
                moved += 0.5 * slope * slope / f64::abs(curvature);
            }
        }
        // The extremes do not move by more than all changes together.
        let moved = f64::min(moved, most);
        let beyond = 2.0 * self.beyond[coordinate];
        parts.iter().map(|part| part.abs()).sum::<f64>() + moved + beyond
    }

    /// Estimated error of the parameter at a fold, whose factors Newton's method holds.
    pub(crate) fn fold_error(&mut self, u: &[f64], newton: &mut Newton) -> f64 {
        let mut psi = vec![0.0; u.len()];
        newton.left_null_vector(&mut psi);
        let n = u.len() - 1;
        let value = u[n].abs();
        let left = newton.left_in_parameter();
        self.add_tail(u, newton).map_or(f64::INFINITY, |core| {
            let change = crate::numeric::linear::dot(&psi[..n], &core[..n]).abs();
            BEYOND * change + ROUNDING * value + left
        })
    }
}

/// Matrix of a complex one of order `n`, given entry by entry: the cosines of all coordinates, then their sines.
fn dynamic_stiffness(
    n: usize,
    real: impl Fn(usize) -> f64,
    imaginary: impl Fn(usize) -> f64,
) -> DMatrix<f64> {
    DMatrix::from_fn(2 * n, 2 * n, |row, column| {
        let entry = row % n * n + column % n;
        match (row < n, column < n) {
            (true, false) => imaginary(entry),
            (false, true) => -imaginary(entry),
            _ => real(entry),
        }
    })
}
