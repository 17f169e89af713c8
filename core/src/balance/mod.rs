//! Residual and Jacobian of the harmonic balance.
//!
//! Every coordinate is a series of `K` harmonics of the base frequency `Omega = omega / (divisor period)`. The
//! equations (1) of [`system`](crate::system), projected on the same harmonics, are
//!
//! ```text
//! R = Omega^2 M D^2 u + Omega C D u + K u + sum_c e_c F_c(u) - f                                            (1)
//! ```
//!
//! where `D` differentiates by phase, `(c_k, s_k) -> (k s_k, -k c_k)`, and `F_c` is the series of the force of contact
//! `c` that [`aft`](crate::balance::aft) makes from the series of its gap. Its derivative needs the series of
//! `S = e_c phi_g d_c + Omega e_c phi_r D d_c` and `T = e_c phi_r d_c`: multiplying by a periodic function is a
//! Toeplitz plus a Hankel matrix of its coefficients,
//!
//! ```text
//! 2 <S cos l cos m> = (C_(l-m) + C_(l+m)) / 2,      2 <S cos l sin m> = (S_(l+m) - S_(l-m)) / 2,
//! 2 <S sin l sin m> = (C_(l-m) - C_(l+m)) / 2,      2 <S sin l cos m> = (S_(l+m) + S_(l-m)) / 2              (2)
//! ```
//!
//! with `C` even, `S` odd and `C_0` twice the mean.
//!
//! Source: Cameron and Griffin (1989); Krack and Gross (2019), Harmonic Balance for Nonlinear Vibration Problems,
//! chapter 2 and appendix on Toeplitz and Hankel blocks. Unknowns are ordered coordinate by coordinate, each
//! `[mean, cos 1, sin 1, ..., cos K, sin K]`.

pub(crate) mod aft;
pub(crate) mod critical_block;
pub(crate) mod resolution;
pub(crate) mod start;
pub(crate) mod subharmonics;
pub(crate) mod symmetry;
pub(crate) mod truncation;

mod alike;
mod assemble;
mod blocks;
mod contacts;
mod harmonics;
mod linear;
mod sizes;
#[cfg(test)]
mod switched_tests;
pub(crate) mod terms;
#[cfg(test)]
mod tests;

use crate::balance::aft::{Aft, ContactForces};
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::cancel::Cancel;
use crate::continuation::jacobian::Partition;
use crate::model::layout::Layout;
use crate::model::rigid::{Place, Rigid};
use crate::numeric::fourier::series;
use crate::system::{System, Variable};
use alike::Alike;
use blocks::Block;
use contacts::Scratch;
use harmonics::Harmonics;
pub(crate) use terms::{gap_series, rate_series, stretched};

/// Which harmonics are unknowns; the others are zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Parity {
    /// All.
    All,
    /// Those of an orbit with odd symmetry.
    Odd,
    /// Those that break it.
    Even,
}

/// How finely an orbit is represented.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Resolution {
    /// Harmonics of the base frequency.
    pub harmonics: usize,
    /// The equations of harmonics up to this one are coupled densely, those above to these and each to itself.
    pub core: usize,
    /// Which harmonics are unknowns.
    pub parity: Parity,
    /// The unknowns are multiples of this harmonic, and `parity` speaks of the multiples.
    pub stride: usize,
    /// Samples of one period of the orbit, for methods that sample.
    pub samples: usize,
    /// How contact forces are found.
    pub aft: Aft,
    /// Number of excitation periods in one period of the orbit.
    pub period: usize,
}

/// Harmonics at equal distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Lattice {
    pub(crate) first: usize,
    pub(crate) step: usize,
}

impl Resolution {
    /// The harmonics that are unknowns, up to the highest.
    pub(crate) fn lattice(&self) -> Lattice {
        let stride = self.stride;
        let (first, step) = match self.parity {
            Parity::All => (0, stride),
            Parity::Odd => (stride, 2 * stride),
            Parity::Even => (0, 2 * stride),
        };
        Lattice { first, step }
    }

    /// How orbits come back that have these harmonics.
    pub(crate) fn recurrence(&self, coordinates: usize) -> Recurrence {
        let odd = self.parity == Parity::Odd;
        Recurrence {
            period: self.period,
            parts: self.stride * if odd { 2 } else { 1 },
            image: if odd {
                SignedPermutation::minus(coordinates)
            } else {
                SignedPermutation::identity()
            },
        }
    }
}

/// The harmonic balance of a system, as a function of one variable.
pub struct Balance<'a> {
    system: &'a dyn System,
    layout: Layout,
    resolution: Resolution,
    parameters: Vec<f64>,
    omega: f64,
    variable: Variable,
    drive_factor: f64,
    aft: Box<dyn ContactForces>,
    coefficients: Vec<f64>,
    coefficients_by: Vec<f64>,
    scratch: Scratch,
    harmonics: Harmonics,
    blocks: Vec<Block>,
    /// The contacts that are evaluated.
    alike: Vec<Alike>,
    rigid: Option<Rigid>,
    /// What gives the mean along rigid motions its stiffness, row by row.
    gauge: Vec<f64>,
    cancel: Cancel,
}

impl std::fmt::Debug for Balance<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Balance")
            .field("system", &self.system.facts().name)
            .field("resolution", &self.resolution)
            .field("variable", &self.variable)
            .finish_non_exhaustive()
    }
}

impl<'a> Balance<'a> {
    /// Balances a system at given parameters; `variable` is what the last extended unknown stands for.
    pub fn new(
        system: &'a dyn System,
        parameters: &[f64],
        omega: f64,
        variable: Variable,
        resolution: Resolution,
    ) -> Self {
        let layout = Layout::of(system);
        let harmonics = Harmonics::of(resolution);
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let place = Place {
            system,
            layout: &layout,
            parameters,
            omega,
            variable,
        };
        let rigid = Rigid::beside(place);
        let alike = alike::of(place, resolution);
        let base = omega / (f64::from(system.facts().divisor) * resolution.period as f64);
        let gauge = rigid.as_ref().map_or(Vec::new(), |rigid| {
            let rows = rigid.inertia().transpose();
            rows.iter().map(|x| base * base * x).collect()
        });
        Self {
            rigid,
            gauge,
            alike,
            system,
            resolution,
            parameters: parameters.to_vec(),
            omega,
            variable,
            drive_factor: 1.0,
            aft: resolution.aft.engine(resolution.samples),
            coefficients,
            coefficients_by: vec![0.0; layout.coefficients],
            scratch: Scratch::new(&layout, resolution, harmonics.coupling()),
            blocks: blocks::of_layout(&layout, harmonics.coupling()),
            harmonics,
            layout,
            cancel: Cancel::new(),
        }
    }

    /// The same, and solving it ends when this token is cancelled.
    pub(crate) fn until(self, cancel: &Cancel) -> Self {
        let cancel = cancel.clone();
        Self { cancel, ..self }
    }

    /// How finely orbits are represented.
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Parameters at the last evaluation.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Excitation frequency at the last evaluation.
    pub fn omega(&self) -> f64 {
        self.omega
    }

    /// Base frequency at the last evaluation.
    pub fn base(&self) -> f64 {
        self.omega / self.base_divisor()
    }

    /// What a continuation varies.
    pub(crate) fn variable(&self) -> Variable {
        self.variable
    }

    pub(crate) fn system(&self) -> &'a dyn System {
        self.system
    }

    pub(crate) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The rigid motions, if there are any.
    pub(crate) fn rigid(&self) -> Option<&Rigid> {
        self.rigid.as_ref()
    }

    pub(crate) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Length of the series of one coordinate.
    pub(crate) fn length(&self) -> usize {
        series::length(self.resolution.harmonics)
    }

    /// Which unknowns are coupled densely, and which by groups.
    pub(crate) fn partition(&self) -> Partition {
        self.harmonics
            .partition(self.layout.coordinates, self.resolution.harmonics)
    }

    /// Harmonics that the series of a contact force must have room for.
    pub(crate) fn force_harmonics(&self) -> usize {
        series::harmonics(&self.scratch.force)
    }

    /// Harmonics that the series of a gap must have room for.
    pub(crate) fn gap_harmonics(&self) -> usize {
        series::harmonics(&self.scratch.gap)
    }

    /// Multiplies the oscillating part of the load from now on: the homotopy of a start.
    pub(crate) fn set_drive_factor(&mut self, factor: f64) {
        self.drive_factor = factor;
    }

    /// Sets the variable, and evaluates the coefficients there.
    pub(crate) fn set(&mut self, value: f64) {
        match self.variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.parameters[index] = value,
        }
        self.system
            .coefficients(&self.parameters, self.omega, &mut self.coefficients);
    }

    /// Changes a parameter that is not the variable; takes effect when the variable is set.
    pub(crate) fn set_parameter(&mut self, index: usize, value: f64) {
        self.parameters[index] = value;
    }

    fn base_divisor(&self) -> f64 {
        f64::from(self.system.facts().divisor) * self.resolution.period as f64
    }

    /// Derivative of the base frequency by the variable.
    fn base_by(&self) -> f64 {
        if self.variable == Variable::Omega {
            1.0 / self.base_divisor()
        } else {
            0.0
        }
    }
}
