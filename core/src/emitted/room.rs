//! Working memory of kernels with powers, and what fills it: one column per base, logarithm and power of a block.

use std::cell::Cell;

use super::batch::{Group, Uses};
use crate::power::{Accuracy, Available, Bases, LANES, logarithms, multiply, powers};

/// Samples per block. A column takes a kilobyte, so those of two bases and their powers stay in the first level of the
/// cache beside the outputs. Measured from 64 to 256: within 3 %.
pub(super) const BLOCK: usize = 128;

/// Below this exponent a power may overflow where the next higher ones do not, so these are not made from it: at the
/// smallest number, `5e-324^-0.9 = 1e291`.
const LOWEST_SHARED: f64 = -0.9;

/// One number for each sample of a block, at the start of a line of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Column(pub(super) [f64; BLOCK]);

thread_local! {
    /// The memory of a thread: it grows when a law first needs more, and is kept, so that repeated calls do not allocate.
    static ROOM: Cell<Vec<Column>> = const { Cell::new(Vec::new()) };
}

/// Columns on loan.
pub(super) struct Room(Vec<Column>);

impl Room {
    /// At least as many columns as are needed. What they hold means nothing.
    #[inline]
    pub(super) fn take(needed: usize) -> Self {
        let mut columns = ROOM.take();
        if columns.len() < needed {
            columns.resize(needed, Column([0.0; BLOCK]));
        }
        Self(columns)
    }

    #[inline]
    pub(super) fn columns(&mut self) -> &mut [Column] {
        &mut self.0
    }

    /// For the next call.
    #[inline]
    pub(super) fn give_back(self) {
        ROOM.set(self.0);
    }
}

/// What is to be raised: powers by their groups and exponents.
#[derive(Clone, Copy)]
pub(super) struct Plan<'a> {
    /// How many bases there are.
    pub(super) bases: usize,
    /// What is needed of logarithms and powers.
    pub(super) needs: Uses,
    pub(super) groups: &'a [Group],
    /// One for each power.
    pub(super) exponents: &'a [f64],
}

/// Fills columns, which are those of bases, of the first and the second parts of their logarithms, and of powers, from the
/// first ones.
pub(super) fn raise(columns: &mut [Column], count: usize, plan: Plan<'_>) {
    let (set, accuracy) = (Available::in_use(), Accuracy::in_use());
    let padded = count.next_multiple_of(LANES);
    let (base, columns) = columns.split_at_mut(plan.bases);
    let (whole, columns) = columns.split_at_mut(plan.bases);
    let (part, power) = columns.split_at_mut(plan.bases);
    let is_needed = |group: &&Group| plan.last_needed(group).is_some();
    for position in 0..plan.bases {
        let mut groups = plan.groups.iter().filter(|group| group.base == position);
        if plan.needs.logarithm(position) || groups.any(|group| is_needed(&group)) {
            base[position].0[count..padded].fill(1.0);
            let parts = [&mut whole[position], &mut part[position]];
            let parts = parts.map(|column| &mut column.0[..padded]);
            logarithms(set, accuracy, &base[position].0[..padded], parts);
        }
    }
    for group in plan.groups {
        let Some(last) = plan.last_needed(group) else {
            continue;
        };
        let of = Bases {
            base: &base[group.base].0[..padded],
            whole: &whole[group.base].0[..padded],
            part: &part[group.base].0[..padded],
        };
        let members = group.first..=group.first + last;
        let exponents = &plan.exponents[members.clone()];
        raise_group(set, accuracy, of, exponents, &mut power[members]);
    }
}

impl Plan<'_> {
    /// The highest power of a group that is needed. Those below are computed with it in any case, so that it is the same
    /// whether they are needed or not.
    fn last_needed(&self, group: &Group) -> Option<usize> {
        (0..group.count)
            .rev()
            .find(|member| self.needs.power(group.first + member))
    }
}

/// The lowest power is an exponential, the others are products with the base.
fn raise_group(
    set: Available,
    accuracy: Accuracy,
    of: Bases<'_>,
    exponents: &[f64],
    power: &mut [Column],
) {
    let count = of.base.len();
    let mut member = 0;
    while member < exponents.len() {
        let (below, above) = power.split_at_mut(member);
        let below = below
            .last()
            .filter(|_| exponents[member - 1] >= LOWEST_SHARED);
        let [this, above @ ..] = above else { return };
        let this = &mut this.0[..count];
        if let Some(below) = below {
            multiply(set, of.base, &below.0[..count], this);
            member += 1;
        } else {
            // The two of a force and its derivative at once.
            let exponent = exponents[member];
            let next = above.first_mut().filter(|_| exponent >= LOWEST_SHARED);
            member += if next.is_some() { 2 } else { 1 };
            let next = next.map(|next| &mut next.0[..count]);
            powers(set, accuracy, of, exponent, this, next);
        }
    }
}
