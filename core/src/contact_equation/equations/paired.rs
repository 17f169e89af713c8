//! Where equations keep the states of modes apart, to be eliminated mode by mode: which those are, and what a mode is of positions and velocities.

use std::sync::Arc;

use crate::contact_equation::linear_part::linear::Linear;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::interval::Interval;
use crate::continuation::arrow::links::{Basis, PairLinks, operations};
use crate::numeric::sparse::SparseRows;

/// States are eliminated before forces where that is so many times cheaper.
const CHEAPER: u64 = 2;

/// `T` of a linear part, and its inverse.
pub(super) fn basis(linear: &Linear) -> Arc<Basis> {
    let order = linear.inverse.nrows();
    let n = order / 2;
    let entry = |i: usize, j: usize| {
        if i < n {
            linear.positions[(i, j)]
        } else {
            linear.velocities[(i - n, j)]
        }
    };
    Arc::new(Basis {
        to: SparseRows::of(order, order, entry),
        from: SparseRows::of(order, order, |i, j| linear.inverse[(i, j)]),
    })
}

/// The sign of the image after which an orbit comes back, if it is one.
pub(super) fn sign(skeleton: &Skeleton) -> Option<f64> {
    let image = &skeleton.recurrence().image;
    if image.is_identity() {
        Some(1.0)
    } else {
        image.is_minus().then_some(-1.0)
    }
}

/// Room for such equations, where no interval couples modes but by forces at nodes, and neither does the image; `None` where that is not so, or
/// the other way is cheaper.
pub(super) fn links(skeleton: &Skeleton) -> Option<PairLinks> {
    sign(skeleton)?;
    let mut intervals = skeleton.intervals.iter();
    if intervals.any(|interval| interval.configuration.is_some()) {
        return None;
    }
    let counts = || skeleton.intervals.iter().map(Interval::forces);
    let (pairs, others) = (skeleton.order / 2, skeleton.switches.len());
    let paired = operations(skeleton.intervals.len(), skeleton.forces, pairs, others);
    let pays = CHEAPER * paired < chained(counts(), skeleton);
    pays.then(|| PairLinks::new(counts(), pairs, others))
}

/// Multiplications where forces are eliminated first, about.
fn chained(counts: impl Iterator<Item = usize>, skeleton: &Skeleton) -> u64 {
    let (order, told) = (skeleton.order as u64, skeleton.told() as u64);
    let links = counts.map(|count| {
        let count = count as u64;
        count.pow(3) / 3 + count.pow(2) * told + 2 * order * told * (count + 1)
    });
    told.pow(3) / 3 + links.sum::<u64>()
}
