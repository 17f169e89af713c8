//! The part of the Jacobian that belongs to harmonics which the orbits of a branch do not have.
//!
//! Orbits of odd symmetry have no even harmonics. Orbits of period `n`, as orbits of period `2 n`, have harmonic `k` at `2 k` and
//! none of odd order. In both cases the Jacobian of the larger balance falls apart into two blocks: that of the harmonics which the
//! orbits have, and that of the others. Where the determinant of the other block changes its sign, a branch of orbits
//! crosses that do have them: the symmetry breaks, or the period doubles.
//!
//! Orbits that come back after a part of `1 / m` of the period ([`stride`](crate::balance::symmetry)) have harmonics that are multiples of `m`.
//! The block of the others falls apart again: waves that are multiples of `m` couple harmonic `k` to those that are `k` or `-k` to
//! the modulus `m`. A shift of `1 / m` of the period multiplies a class by `exp(2 pi i k / m)` and commutes with its block, which is
//! that of a complex matrix and its conjugate: a determinant that is a square, and changes no sign. Two classes are real, that of the
//! orbits and, where `m` is even, that of the odd multiples of `m / 2`. Where `m` is odd, the second is found in twice the period: that
//! of the odd multiples of `m` there.
//!
//! Where the branch crosses another one of orbits with the same harmonics, all of the matrix is singular that Newton's method has on
//! it, `[R_u R_l; t^T]` with the tangent `t` (Keller's test function): its determinant changes its sign there, and not at a fold.
//!
//! This finds the bifurcations of the discrete balance, to rounding, and the branch that begins there is one of the same
//! balance. Floquet multipliers of its orbits, which are integrated, would put them elsewhere by what the harmonics leave out.
//!
//! Source: Detroux, Renson, Masset and Kerschen (2015), The harmonic balance method for bifurcation analysis of large-scale
//! nonlinear mechanical systems, section 4; Golubitsky, Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation
//! Theory II, chapter XIII (block structure).

use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::event::EventKind;
use crate::numeric::fourier::series;
use crate::system::{System, Variable};

/// A part of the Jacobian that becomes singular by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The harmonics that the orbits have, with the tangent of the branch.
    Own,
    /// The even multiples of the stride, where the orbits have odd ones.
    Even,
    /// The odd multiples of half the stride, which is even.
    Between,
    /// The odd multiples of the stride in twice the period.
    Doubled,
}

impl Part {
    /// What happens where it is singular. The time in which orbits come back may double within the declared period, or beyond it.
    pub(crate) fn kind(self) -> EventKind {
        match self {
            Self::Even => EventKind::SymmetryBreaking,
            Self::Between | Self::Doubled => EventKind::PeriodDoubling,
            Self::Own => EventKind::BranchPoint,
        }
    }

    /// What is singular where the time in which orbits come back doubles, whose harmonics are multiples of this one.
    pub(crate) fn doubled(stride: usize) -> Self {
        if stride.is_multiple_of(2) {
            Self::Between
        } else {
            Self::Doubled
        }
    }
}

/// The block of one balance, or all of its Jacobian.
#[derive(Debug)]
pub(crate) struct CriticalBlock<'a> {
    pub(crate) part: Part,
    balance: Balance<'a>,
    jacobian: Jacobian,
    residual: Vec<f64>,
    border: Vec<f64>,
    /// The last orbit, as it was given and as an orbit of this balance, and its determinant.
    orbit: Vec<f64>,
    stretched: Vec<f64>,
    known: (f64, f64),
    /// Determinants computed, each a Jacobian and a factorisation.
    pub(crate) computed: usize,
}

impl<'a> CriticalBlock<'a> {
    /// For orbits of a balance of this resolution.
    pub(crate) fn new(
        part: Part,
        system: &'a dyn System,
        parameters: &[f64],
        omega: f64,
        variable: Variable,
        resolution: Resolution,
    ) -> Self {
        // Nothing is left out of the block: its determinant is what counts.
        let resolution = match part {
            Part::Even => Resolution {
                parity: Parity::Even,
                core: resolution.harmonics,
                ..resolution
            },
            Part::Between => Resolution {
                parity: Parity::Odd,
                stride: resolution.stride / 2,
                core: resolution.harmonics,
                ..resolution
            },
            Part::Doubled => Resolution {
                parity: Parity::Odd,
                harmonics: 2 * resolution.harmonics,
                core: 2 * resolution.harmonics,
                samples: 2 * resolution.samples,
                period: 2 * resolution.period,
                ..resolution
            },
            Part::Own => Resolution {
                core: resolution.harmonics,
                ..resolution
            },
        };
        let balance = Balance::new(system, parameters, omega, variable, resolution);
        let n = balance.unknowns();
        let mut border = vec![0.0; n + 1];
        border[n] = 1.0;
        Self {
            part,
            jacobian: Jacobian::new(balance.partition()),
            residual: vec![0.0; n],
            border,
            balance,
            orbit: Vec::new(),
            stretched: vec![0.0; n + 1],
            known: (0.0, 0.0),
            computed: 0,
        }
    }

    /// The same at an orbit whose branch has a direction, which matters where all harmonics are in the block.
    pub(crate) fn determinant_along(&mut self, u: &[f64], tangent: &[f64]) -> (f64, f64) {
        if self.part == Part::Own {
            self.border.copy_from_slice(tangent);
        }
        self.determinant(u)
    }

    /// The determinant of the block at an orbit: its sign, and the logarithm of its size. The sign is zero if the block is
    /// singular. Of the same orbit again it is known.
    pub(crate) fn determinant(&mut self, u: &[f64]) -> (f64, f64) {
        if self.orbit == u {
            return self.known;
        }
        self.orbit.clear();
        self.orbit.extend_from_slice(u);
        self.computed += 1;
        if self.part == Part::Doubled {
            let coordinates = self.balance.layout().coordinates;
            stretch(u, coordinates, &mut self.stretched);
        } else {
            self.stretched.copy_from_slice(u);
        }
        self.jacobian.clear();
        let jacobian = Some(&mut self.jacobian);
        self.balance
            .evaluate(&self.stretched, &mut self.residual, jacobian);
        self.jacobian.set_border(&self.border);
        self.known = self.jacobian.determinant();
        self.known
    }
}

/// Steps of inverse iteration: each takes the part that is not in the null space down by the ratio of the two smallest singular
/// values, which is below a part in a million at a located event.
const INVERSE: usize = 3;

/// Parts of the value by which the matrix is taken beside the event, where it is singular to the last bit at the event itself.
const NUDGES: [f64; 4] = [0.0, 1e-13, 1e-11, 1e-9];

impl CriticalBlock<'_> {
    /// The vector that the factorised matrix takes closest to zero.
    fn inverse_iteration(&mut self, v: &mut [f64]) {
        let n = v.len() - 1;
        for (i, x) in v.iter_mut().enumerate() {
            *x = (1.0 + i as f64).sin();
        }
        for _ in 0..INVERSE {
            // What the border says is across the tangent.
            v[n] = 0.0;
            self.jacobian.solve(v);
            let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            for x in v.iter_mut() {
                *x /= largest;
            }
        }
    }

    /// The orbit as one of the larger balance, and the null vector of the block there, at an event whose branch has this tangent. Its
    /// last entry, for the parameter, is zero but where all harmonics are in the block.
    pub(crate) fn null_vector(&mut self, u: &[f64], tangent: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = self.residual.len();
        let mut v = vec![0.0; n + 1];
        let mut at = u.to_vec();
        let value = at.len() - 1;
        for nudge in NUDGES {
            at[value] = u[value] + nudge * u[value].abs().max(f64::MIN_POSITIVE);
            self.orbit.clear();
            if self.determinant_along(&at, tangent).0 != 0.0 {
                break;
            }
        }
        self.inverse_iteration(&mut v);
        // Where it was nudged, the orbit is still the one given.
        let last = self.stretched.len() - 1;
        self.stretched[last] = u[value];
        if self.part != Part::Own {
            v[n] = 0.0;
        }
        (self.stretched.clone(), v)
    }
}

/// Extended unknowns of an orbit as those of twice the period: harmonic `k` becomes harmonic `2 k`.
fn stretch(u: &[f64], coordinates: usize, to: &mut [f64]) {
    let from = (u.len() - 1) / coordinates;
    let length = (to.len() - 1) / coordinates;
    to.fill(0.0);
    for i in 0..coordinates {
        let (short, long) = (&u[i * from..][..from], &mut to[i * length..][..length]);
        long[0] = short[0];
        for k in 1..=series::harmonics(short) {
            long[4 * k - 1] = short[2 * k - 1];
            long[4 * k] = short[2 * k];
        }
    }
    to[coordinates * length] = u[u.len() - 1];
}
