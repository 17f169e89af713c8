//! Where a free oscillation of several coordinates begins: at a mode of the system linearised about the place where it rests; and its energy
//! above that of rest.
//!
//! Beside rest at `q_0` the modes are those of
//!
//! ```text
//! (K + sum_c k_c e_c d_c^T - omega^2 M) v = 0                                                                 (1)
//! ```
//!
//! where a contact is a spring of the stiffness that its force has over an oscillation of its gap, `g_c + A cos tau`:
//!
//! ```text
//! k_c = 1/(pi A) integral of phi_c(g_c + A cos tau) cos tau over a period                                     (2)
//! ```
//!
//! which is the slope of a smooth force where `A` is small, and a mean of two slopes where a contact just closes. `A` follows from the mode
//! at the amplitude with which the oscillation begins, and the mode from (1), in turns.
//!
//! In a position `q_0` that is at rest too the energy is that of
//!
//! ```text
//! E = (q - q_0)^T K (q - q_0) / 2 + sum_c a_c integral from g_c(q_0) to g_c(q) of phi_c(g) - phi_c(g_c(q_0)) dg    (3)
//! ```
//!
//! where `e_c = a_c d_c`, without which a force has no potential. The integrals end at levels, where forces go as powers: they are taken by a
//! rule that does not mind.
//!
//! Source: Krylov and Bogoliubov (1947), Introduction to Non-Linear Mechanics, chapter XI (equivalent linearisation); Rosenberg (1966), Adv.
//! Appl. Mech. 9 (normal modes of nonlinear systems, which begin at those of the linear one); Takahasi and Mori (1974), Publ. RIMS Kyoto Univ.
//! 9 (the double exponential rule).

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::DMatrix;

use crate::balance::start;
use crate::bifurcation::error::BifurcationError;
use crate::cancel::Cancel;
use crate::error::Error;
use crate::law::On;
use crate::laws::single::Single;
use crate::model;
use crate::model::layout::{self, Layout, Term};
use crate::system::System;

/// Samples of (2) over half of a period.
const SAMPLES: usize = 64;
/// Turns between (1) and (2), at most, and the part of the frequency that they settle to.
const TURNS: usize = 30;
const SETTLED: f64 = 1e-10;
/// What differs from symmetry by more than this part of the largest entry is no rounding.
const SYMMETRIC: f64 = 1e-9;
/// The square of the frequency of a motion that nothing holds, as a part of the largest one.
const RIGID: f64 = 1e-13;

/// Steps of the double exponential rule to either side, and their length: beyond them weights are rounding.
const STEPS: i32 = 52;
const STEP: f64 = 1.0 / 16.0;

/// A contact in a system that rests.
struct Contact {
    law: usize,
    arguments: Vec<f64>,
    /// Directions of the force and of the gap.
    force: Vec<f64>,
    along: Vec<f64>,
    /// The gap at rest.
    gap: f64,
}

/// A system beside the place where it rests.
pub(super) struct Linearised {
    system: Arc<dyn System>,
    pub(super) rest: Vec<f64>,
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    contacts: Vec<Contact>,
}

impl Contact {
    /// `a_c` of (3).
    ///
    /// # Errors
    /// If the force acts in another direction than the gap opens in.
    fn part(&self) -> Result<f64, Error> {
        let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let square = product(&self.along, &self.along);
        if square == 0.0 {
            // A gap that no coordinate opens does no work.
            return Ok(0.0);
        }
        let part = product(&self.force, &self.along) / square;
        let pairs = self.force.iter().zip(&self.along);
        let off = pairs.fold(0.0, |most: f64, (e, d)| most.max((e - part * d).abs()));
        let largest = self
            .force
            .iter()
            .fold(0.0, |most: f64, e| most.max(e.abs()));
        if off > SYMMETRIC * largest {
            return Err(BifurcationError::NoPotential { off }.into());
        }
        Ok(part)
    }
}

/// A mode.
#[derive(Debug, Clone)]
pub(super) struct Mode {
    pub(super) omega: f64,
    /// How it moves the coordinates.
    pub(super) shape: Vec<f64>,
}

impl Linearised {
    /// Of a system at the values of its parameters.
    pub(super) fn of(system: &Arc<dyn System>, cancel: &Cancel) -> Result<Self, Error> {
        let parameters = model::values(system);
        let rest = start::rest(system, &parameters, cancel)?;
        let layout = Layout::of(system);
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(&parameters, 1.0, &mut coefficients);
        let n = layout.coordinates;
        let row = |terms: &[Term]| {
            let mut row = vec![0.0; n];
            let constant = terms.iter().filter(|term| term.wave.harmonic == 0);
            constant.for_each(|term| row[term.index] += coefficients[term.coefficient]);
            row
        };
        let contacts = layout.contacts.iter().map(|contact| {
            let mut arguments = vec![0.0; contact.argument_count];
            contact.arguments(&coefficients, &mut arguments);
            let along = row(&contact.gap);
            let constant = contact.offset.iter().filter(|term| term.wave.harmonic == 0);
            let offset: f64 = constant.map(|term| coefficients[term.coefficient]).sum();
            let pairs = along.iter().zip(&rest);
            Contact {
                law: contact.law,
                gap: pairs.map(|(d, q)| d * q).sum::<f64>() - offset,
                force: row(&contact.force),
                along,
                arguments,
            }
        });
        let contacts = contacts.collect();
        Ok(Self {
            mass: layout.mass(&coefficients),
            stiffness: layout::constant(&layout.stiffness, &coefficients, n),
            contacts,
            rest,
            system: Arc::clone(system),
        })
    }

    /// The slope of the force of a contact at rest.
    fn slope(&self, contact: &Contact) -> f64 {
        let law = self.system.law(contact.law);
        let at = [contact.gap, 0.0];
        Single::of(law, On::AllPieces, &contact.arguments, at).by_gap
    }

    /// (2); the slope where the gap does not move.
    fn stiffness_over(&self, contact: &Contact, amplitude: f64) -> f64 {
        if amplitude == 0.0 {
            return self.slope(contact);
        }
        let law = self.system.law(contact.law);
        let force = |cosine: f64| {
            let at = [contact.gap + amplitude * cosine, 0.0];
            cosine * Single::of(law, On::AllPieces, &contact.arguments, at).force
        };
        let phases = (0..SAMPLES).map(|i| PI * (i as f64 + 0.5) / SAMPLES as f64);
        let mean = phases.map(|phase| force(phase.cos())).sum::<f64>() / SAMPLES as f64;
        2.0 * mean / amplitude
    }

    /// All modes (1), the lowest first, where contacts have these stiffnesses; those of motions that nothing holds have the frequency zero.
    fn modes(&self, contacts: &[f64]) -> Result<Vec<Mode>, Error> {
        let mut stiffness = self.stiffness.clone();
        for (contact, k) in self.contacts.iter().zip(contacts) {
            for (i, e) in contact.force.iter().enumerate() {
                for (j, d) in contact.along.iter().enumerate() {
                    stiffness[(i, j)] += k * e * d;
                }
            }
        }
        for matrix in [&self.mass, &stiffness] {
            let off = (matrix - matrix.transpose()).amax();
            if off > SYMMETRIC * matrix.amax() {
                return Err(BifurcationError::NoPotential { off }.into());
            }
        }
        let none = || Error::from(BifurcationError::NoKineticEnergy);
        let root = self.mass.clone().cholesky().ok_or_else(none)?.l();
        let half = root.solve_lower_triangular(&stiffness).ok_or_else(none)?;
        let whole = root
            .solve_lower_triangular(&half.transpose())
            .ok_or_else(none)?;
        let eigen = whole.symmetric_eigen();
        let shapes = root.tr_solve_lower_triangular(&eigen.eigenvectors);
        let shapes = shapes.ok_or_else(none)?;
        let least = RIGID * eigen.eigenvalues.amax();
        let modes = eigen.eigenvalues.iter().zip(shapes.column_iter());
        let modes = modes.map(|(square, shape)| Mode {
            omega: if *square > least { square.sqrt() } else { 0.0 },
            shape: shape.iter().copied().collect(),
        });
        let mut modes: Vec<Mode> = modes.collect();
        modes.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        Ok(modes)
    }

    /// The modes of small oscillations.
    pub(super) fn small(&self) -> Result<Vec<Mode>, Error> {
        let slopes: Vec<f64> = self.contacts.iter().map(|c| self.slope(c)).collect();
        self.modes(&slopes)
    }

    /// The coordinate that moves most, as inertia tells.
    pub(super) fn leading(&self, mode: &Mode) -> usize {
        let inertia = |i: usize| self.mass[(i, i)] * mode.shape[i].powi(2);
        let coordinates = 0..mode.shape.len();
        let largest = coordinates.max_by(|&a, &b| inertia(a).total_cmp(&inertia(b)));
        largest.unwrap_or(0)
    }

    /// A mode of small oscillations where a coordinate moves by so much, with the springs that contacts are then. None where it does not move, or
    /// nothing holds it.
    pub(super) fn at(
        &self,
        mode: &Mode,
        coordinate: usize,
        by: f64,
    ) -> Result<Option<Mode>, Error> {
        let Some(mut found) = mode.scaled(coordinate, by) else {
            return Ok(None);
        };
        for _ in 0..TURNS {
            let springs = self.contacts.iter().map(|contact| {
                let pairs = contact.along.iter().zip(&found.shape);
                let amplitude: f64 = pairs.map(|(d, q)| d * q).sum();
                self.stiffness_over(contact, amplitude.abs())
            });
            let springs: Vec<f64> = springs.collect();
            let mut nearest: Option<(f64, Mode)> = None;
            for other in self.modes(&springs)? {
                let part = self.likeness(&found, &other);
                if nearest.as_ref().is_none_or(|(most, _)| part > *most) {
                    nearest = Some((part, other));
                }
            }
            let next = nearest.and_then(|(_, next)| next.scaled(coordinate, by));
            let Some(next) = next else {
                return Ok(None);
            };
            let change = (next.omega - found.omega).abs();
            found = next;
            if change <= SETTLED * found.omega {
                break;
            }
        }
        Ok(Some(found).filter(|found| found.omega > 0.0))
    }

    /// (3) of positions that are at rest.
    pub(super) fn energy(&self, positions: &[f64]) -> Result<f64, Error> {
        let pairs = positions.iter().zip(&self.rest);
        let apart: Vec<f64> = pairs.map(|(q, rest)| q - rest).collect();
        let mut energy = 0.0;
        for (i, by) in apart.iter().enumerate() {
            let row = self.stiffness.row(i);
            let force: f64 = row.iter().zip(&apart).map(|(k, q)| k * q).sum();
            energy += 0.5 * by * force;
        }
        for contact in &self.contacts {
            let opened = contact.along.iter().zip(&apart).map(|(d, q)| d * q);
            energy += contact.part()? * self.work(contact, opened.sum());
        }
        Ok(energy)
    }

    /// The integral of (3), over gaps that change by so much.
    fn work(&self, contact: &Contact, by: f64) -> f64 {
        let law = self.system.law(contact.law);
        let force = |gap: f64| {
            let at = [gap, 0.0];
            Single::of(law, On::AllPieces, &contact.arguments, at).force
        };
        let at_rest = force(contact.gap);
        let [low, high] = [
            contact.gap.min(contact.gap + by),
            contact.gap.max(contact.gap + by),
        ];
        let mut ends = vec![0.0; law.facts().levels.len()];
        law.levels(&contact.arguments, &mut ends);
        ends.retain(|level| (low..high).contains(level));
        ends.insert(0, low);
        ends.push(high);
        let parts = ends.windows(2);
        let parts = parts.map(|part| between(part[0], part[1], |gap| force(gap) - at_rest));
        parts.sum::<f64>() * by.signum()
    }

    /// How far two modes have one shape: the cosine between them in the product of the mass matrix.
    pub(super) fn likeness(&self, a: &Mode, b: &Mode) -> f64 {
        let product = |a: &Mode, b: &Mode| {
            let n = a.shape.len();
            let entries = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let terms = entries.map(|(i, j)| a.shape[i] * self.mass[(i, j)] * b.shape[j]);
            terms.sum::<f64>()
        };
        product(a, b).abs() / (product(a, a) * product(b, b)).sqrt()
    }
}

impl Mode {
    /// Whether a coordinate moves in it, and comes back to rest.
    pub(super) fn moves(&self, coordinate: usize) -> bool {
        let largest = self.shape.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        self.omega > 0.0 && self.shape[coordinate].abs() > SYMMETRIC * largest
    }

    /// The same where a coordinate moves by so much; none where it does not move.
    fn scaled(&self, coordinate: usize, by: f64) -> Option<Self> {
        let own = self.shape[coordinate];
        let largest = self.shape.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if own.abs() <= SYMMETRIC * largest {
            return None;
        }
        let shape = self.shape.iter().map(|x| x * by / own);
        Some(Self {
            omega: self.omega,
            shape: shape.collect(),
        })
    }
}

/// The integral of a function that is smooth between both ends, by the double exponential rule.
fn between(low: f64, high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * (high - low);
    let term = |step: i32| {
        let t = STEP * f64::from(step);
        let inner = 0.5 * PI * t.sinh();
        let weight = 0.5 * PI * t.cosh() / inner.cosh().powi(2);
        // From the end that is near, so that no digit of the distance is lost.
        let near = 2.0 * half / ((2.0 * inner.abs()).exp() + 1.0);
        let x = if step < 0 { low + near } else { high - near };
        weight * of(x)
    };
    half * STEP * (-STEPS..=STEPS).map(term).sum::<f64>()
}
