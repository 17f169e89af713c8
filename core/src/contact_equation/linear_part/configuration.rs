//! The linear part while contacts are closed whose forces are affine: these are in it, and the motion is known in closed form there too.
//!
//! Where every contact is on a piece without force, or on one of `phi = phi_0 + k (g - g_0) + c g'` whose gap `g = d . q - delta` has a
//! constant direction and a constant offset, as its force `e phi` has,
//!
//! ```text
//! M q'' + (C + sum c e d^T) q' + (K + sum k e d^T) q = F - sum e (phi_0 - k (g_0 + delta))                     (1)
//! ```
//!
//! With `T_c` of (1) in [`linear`](super::linear), states of the linear part are, with those of this one,
//!
//! ```text
//! y = S z,    S = T^-1 T_c                                                                                    (2)
//! ```
//!
//! Source: Shaw and Holmes (1983), A periodically forced piecewise linear oscillator, Journal of Sound and Vibration 90(1) (motions that
//! are known in closed form on both sides of a stop, with the times of switching as unknowns).

use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{Complex, DMatrix, DVector};

use super::block::{Block, add, add_both};
use super::contact::Contact;
use super::linear::{Linear, Seen, seen};
use super::refined::Pairs;
use super::values::Values;
use super::wave::Wave;
use crate::law::{Derivatives, On, Variation};
use crate::system::System;

/// More states than this are followed by forces at nodes: (2) costs their cube on every interval. Where coefficients change along the branch,
/// all of (1) is made anew at every value, and pays for fewer.
const MOST: usize = 40;
const MOST_IF_IT_CHANGES: usize = 12;
/// Eigenvectors nearer to dependent ones than this leave so many digits less in (2). Where they are, forces are unknown at nodes.
const DEPENDENT: f64 = 1e3;
/// Squares of its slowest exponents are found to rounding of those of its fastest ones, which no finer equations show: up to this quotient. A step that
/// leaves the square of an error leaves rounding up to the second one; where an exponent is zero none is made, so that it stays that.
const SPREAD: [f64; 2] = [1e4, 1e8];
/// What decays faster than this in a unit of phase grows as fast where equations go back, as between switches in another order.
const DECAYS: f64 = 100.0;

/// (1) at values of parameters and frequency.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Configuration {
    /// Its linear part and its load, without contacts.
    pub(in crate::contact_equation) values: Values,
    /// `S`
    pub(in crate::contact_equation) to: DMatrix<f64>,
    /// `S^-1`
    pub(in crate::contact_equation) from: DMatrix<f64>,
    /// Both row by row.
    pub(in crate::contact_equation) rows: [Vec<f64>; 2],
    /// Its pairs are those of [`refined`](super::refined).
    is_refined: bool,
}

/// Configurations that were asked for, by the pieces of the contacts.
#[derive(Debug, Clone, Default)]
pub(super) struct Kept(Arc<Mutex<Vec<Known>>>);

type Known = (Vec<usize>, Option<Configuration>);

impl Configuration {
    /// With every contact on a piece; `None` where a force is not affine, a direction or an offset moves, or eigenvectors are dependent. What is
    /// known is kept with the values.
    pub(in crate::contact_equation) fn new(
        system: &dyn System,
        values: &Values,
        pieces: &[usize],
    ) -> Option<Self> {
        let mut kept = values.kept.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept.iter().find(|(of, _)| of == pieces);
        let known = known.map(|(_, known)| known.clone());
        let mut of = known.unwrap_or_else(|| {
            let made = Self::made(system, values, pieces);
            kept.push((pieces.to_vec(), made.clone()));
            made
        })?;
        of.values.set_base(values.base);
        Some(of)
    }

    fn made(system: &dyn System, values: &Values, pieces: &[usize]) -> Option<Self> {
        let [mass, mut damping, mut stiffness] = values.matrices.clone();
        let mut load = DVector::zeros(mass.nrows());
        let mut products = Vec::new();
        let own = &values.linear;
        for (contact, &piece) in values.contacts.iter().zip(pieces) {
            let facts = &system.law(contact.law).facts().pieces[piece];
            if facts.force == Variation::Zero {
                continue;
            }
            let standing = contact.standing.as_ref().filter(|_| facts.affine)?;
            let affine = Affine::of(system, contact, piece);
            let product = &standing.force * standing.gap.transpose();
            damping += affine.by_rate * &product;
            stiffness += affine.by_gap * product;
            load -=
                (affine.force - affine.by_gap * (affine.at + standing.offset)) * &standing.force;
            let position = own.positions.tr_mul(&standing.gap);
            let rate = own.velocities.tr_mul(&standing.gap);
            products.push([
                &own.input * &standing.force,
                affine.by_gap * position + affine.by_rate * rate,
            ]);
        }
        let found = Linear::new(&mass, &damping, &stiffness)?;
        let mut pairs = Pairs {
            to: &own.inverse * states(&found),
            from: &found.inverse * states(own),
            blocks: found.blocks.clone(),
        };
        // One pair has nothing beside it.
        let mut blocks = found.blocks.iter();
        let may_be = found.blocks.len() > 1 && blocks.all(|block| block.squares().count() == 2);
        let refined = may_be.then(|| pairs.refined(&own.blocks, &products));
        let refined = refined.flatten();
        let is_refined = refined.is_some();
        let linear = if let Some(refined) = refined {
            pairs = refined;
            own.in_pairs(pairs.clone(), own.dependence.max(found.dependence))
        } else {
            found
        };
        let Pairs { to, from, .. } = pairs;
        let waves = waves(&values.load, &from, &(&linear.input * load));
        let values = Values {
            linear,
            base: 0.0,
            contacts: Vec::new(),
            load: waves,
            matrices: [mass, damping, stiffness],
            changes: values.changes,
            kept: Kept::default(),
        };
        let rows = [&to, &from].map(|of| of.transpose().as_slice().to_vec());
        Some(Self {
            values,
            to,
            from,
            rows,
            is_refined,
        })
    }

    /// Whether so many states may be followed so, where coefficients change along the branch or not.
    pub(in crate::contact_equation) fn pays(order: usize, changes: bool) -> bool {
        order <= if changes { MOST_IF_IT_CHANGES } else { MOST }
    }

    /// It is known to nearly all digits: eigenvectors are far from dependent ones, exponents near enough to each other, and nothing decays at once.
    pub(in crate::contact_equation) fn is_sound(&self) -> bool {
        let Linear {
            blocks, dependence, ..
        } = &self.values.linear;
        let decay = blocks.iter().map(Block::decay).fold(0.0, f64::max);
        let sizes = || blocks.iter().flat_map(Block::squares);
        let [most, least] = [
            sizes().fold(0.0, f64::max),
            sizes().fold(f64::INFINITY, f64::min),
        ];
        let near = blocks.len() == 1 || most <= SPREAD[usize::from(self.is_refined)] * least;
        *dependence <= DEPENDENT && near && decay <= DECAYS * self.values.base
    }

    /// States of this one from those of the linear part.
    pub(in crate::contact_equation) fn take(&self, y: &[f64], z: &mut [f64]) {
        product(&self.from, y, z);
    }

    /// What a row over states of the linear part sees of those of this one.
    pub(in crate::contact_equation) fn row(&self, row: &[Seen]) -> Vec<Seen> {
        self.row_by(row, |x| x)
    }

    /// The same of the largest sizes that a row may have.
    pub(in crate::contact_equation) fn largest_row(&self, row: &[Seen]) -> Vec<Seen> {
        self.row_by(row, f64::abs)
    }

    fn row_by(&self, row: &[Seen], of: fn(f64) -> f64) -> Vec<Seen> {
        let order = self.to.nrows();
        let mut both = [vec![0.0; order], vec![0.0; order]];
        let mut columns = [vec![0.0; order], vec![0.0; order]];
        for seen in row {
            let pair = self.rows[0][2 * seen.block * order..].chunks_exact(order);
            for (column, own) in columns.iter_mut().zip(pair) {
                column.clear();
                column.extend(own.iter().map(|x| of(*x)));
            }
            let columns = columns.each_ref().map(|of| &of[..]);
            let [position, rate] = &mut both;
            add_both(columns, seen.position, position);
            add_both(columns, seen.rate, rate);
        }
        let [position, rate] = both;
        seen(position.into_iter(), rate.into_iter())
    }

    /// States of the linear part from those of this one.
    pub(in crate::contact_equation) fn give(&self, z: &[f64], y: &mut [f64]) {
        product(&self.to, z, y);
    }
}

fn product(matrix: &DMatrix<f64>, of: &[f64], to: &mut [f64]) {
    to.fill(0.0);
    for (column, x) in matrix.column_iter().zip(of) {
        add(to, *x, column.as_slice());
    }
}

/// `T`
fn states(linear: &Linear) -> DMatrix<f64> {
    let n = linear.blocks.len();
    let mut both = DMatrix::zeros(2 * n, 2 * n);
    both.rows_mut(0, n).copy_from(&linear.positions);
    both.rows_mut(n, n).copy_from(&linear.velocities);
    both
}

/// A force on a piece of a law, `force + by_gap (g - at) + by_rate g'`.
pub(in crate::contact_equation) struct Affine {
    pub(in crate::contact_equation) at: f64,
    pub(in crate::contact_equation) force: f64,
    pub(in crate::contact_equation) by_gap: f64,
    pub(in crate::contact_equation) by_rate: f64,
}

impl Affine {
    pub(in crate::contact_equation) fn of(
        system: &dyn System,
        contact: &Contact,
        piece: usize,
    ) -> Self {
        let at = contact.held(piece, 0.0);
        let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        let law = system.law(contact.law);
        law.derivatives(On::Piece(piece), &contact.arguments, &[at], &[0.0], out);
        Self {
            at,
            force: force[0],
            by_gap: by_gap[0],
            by_rate: by_rate[0],
        }
    }
}

/// Waves of a load as they are for other states, and what does not change in it with what a constant load does to these.
fn waves(load: &[Wave], from: &DMatrix<f64>, constant: &DVector<f64>) -> Vec<Wave> {
    let order = constant.len();
    let from = from.map(|x| Complex::new(x, 0.0));
    let constant = constant.map(|x| Complex::new(x, 0.0));
    let of = |wave: &Wave| {
        let entries = wave.input.iter().flatten().copied();
        let mut input = &from * DVector::from_iterator(order, entries);
        if wave.harmonic == 0.0 {
            input += &constant;
        }
        Wave::new(wave.harmonic, &input)
    };
    let mut waves: Vec<Wave> = load.iter().map(of).collect();
    let is_loaded = constant.iter().any(|x| *x != Complex::new(0.0, 0.0));
    if is_loaded && load.iter().all(|wave| wave.harmonic != 0.0) {
        waves.push(Wave::new(0.0, &constant));
    }
    waves
}
