//! Working memory of kernels with powers, and what fills it: one column per base, logarithm and power of a block.

use std::cell::Cell;
use std::ops::Range;

use super::batch::{Group, Uses};
use crate::numeric::power::{
    Available, Bases, LANES, Target, Work, cube_roots, logarithms, multiply, powers, two_powers,
};

/// Samples per block. A column takes two kilobytes, so those of one or two bases and their powers stay in the first level of
/// the cache. Measured from 128 to 512: this is the fastest, by 5 to 10 %.
pub(super) const BLOCK: usize = 256;

/// Powers are not made from one of an exponent below this: its errors grow with its own size times the logarithm, and
/// would be greater than theirs may be. Nor does it overflow: at the smallest number, `5e-324^-0.5 = 4e161`.
const LOWEST_SHARED: f64 = -0.5;

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

impl<'a> Plan<'a> {
    /// The groups of a base that are needed, each with its highest power that is. Those below are computed with it in any
    /// case, so that it is the same whether they are needed or not.
    #[inline(always)]
    fn needed_of(&self, base: usize) -> impl Iterator<Item = (&'a Group, usize)> {
        let needs = self.needs;
        let groups = self.groups.iter().filter(move |group| group.base == base);
        groups.filter_map(move |group| {
            let mut members = (0..group.count).rev();
            let last = members.find(|member| needs.power(group.first + member))?;
            Some((group, last))
        })
    }
}

/// Fills columns, which are those of bases, of the first and the second parts of their logarithms, and of powers, from the
/// first ones. Where a base is not positive, the others hold some number.
pub(super) fn raise(set: Available, columns: &mut [Column], count: usize, plan: Plan<'_>) {
    let padded = count.next_multiple_of(LANES);
    for base in &mut columns[..plan.bases] {
        base.0[count..padded].fill(0.0);
    }
    fill(set, columns, padded, plan);
}

/// Every loop is work of its own: of several in one function, the constants of all would compete for registers.
fn fill(set: Available, columns: &mut [Column], count: usize, plan: Plan<'_>) {
    let (base, columns) = columns.split_at_mut(plan.bases);
    let (whole, columns) = columns.split_at_mut(plan.bases);
    let (part, power) = columns.split_at_mut(plan.bases);
    for (position, base) in base.iter().enumerate() {
        let mut at = 0..count;
        set.run(Positive {
            base: &base.0[..count],
            at: &mut at,
        });
        let base = &base.0[at.clone()];
        let (whole, part) = (
            &mut whole[position].0[at.clone()],
            &mut part[position].0[at.clone()],
        );
        let needed = || plan.needed_of(position);
        if plan.needs.logarithm(position) || needed().any(|(group, _)| !group.cube_root) {
            set.run(Logarithms { base, whole, part });
        }
        let of = Bases { base, whole, part };
        for (group, last) in needed() {
            let members = group.first..=group.first + last;
            let exponents = &plan.exponents[members.clone()];
            let power = &mut power[members];
            if group.cube_root {
                set.run(CubeRoots {
                    base,
                    root: &mut power[0].0[at.clone()],
                });
            } else {
                raise_group(set, of, exponents, power, &at);
            }
        }
    }
}

/// The lowest power of a group is an exponential, the others are products with the base.
fn raise_group(
    set: Available,
    of: Bases<'_>,
    exponents: &[f64],
    power: &mut [Column],
    at: &Range<usize>,
) {
    let mut member = 0;
    while member < exponents.len() {
        let exponent = exponents[member];
        let (below, above) = power.split_at_mut(member);
        let below = below
            .last()
            .filter(|_| exponents[member - 1] >= LOWEST_SHARED);
        let [this, above @ ..] = above else { return };
        let power = &mut this.0[at.clone()];
        member += 1;
        if let Some(below) = below {
            multiply(of.base, &below.0[at.clone()], power);
            continue;
        }
        // The two of a force and its derivative at once.
        match above.first_mut().filter(|_| exponent >= LOWEST_SHARED) {
            Some(next) => {
                set.run(TwoPowers {
                    of,
                    exponent,
                    power,
                    next: &mut next.0[at.clone()],
                });
                member += 1;
            }
            None => set.run(Powers {
                of,
                exponent,
                power,
            }),
        }
    }
}

struct Logarithms<'a> {
    base: &'a [f64],
    whole: &'a mut [f64],
    part: &'a mut [f64],
}

impl Work for Logarithms<'_> {
    #[inline(always)]
    fn run<T: Target>(self) {
        logarithms::<T>(self.base, self.whole, self.part);
    }
}

struct Powers<'a> {
    of: Bases<'a>,
    exponent: f64,
    power: &'a mut [f64],
}

impl Work for Powers<'_> {
    #[inline(always)]
    fn run<T: Target>(self) {
        powers::<T>(self.of, self.exponent, self.power);
    }
}

struct TwoPowers<'a> {
    of: Bases<'a>,
    exponent: f64,
    power: &'a mut [f64],
    next: &'a mut [f64],
}

impl Work for TwoPowers<'_> {
    #[inline(always)]
    fn run<T: Target>(self) {
        two_powers::<T>(self.of, self.exponent, self.power, self.next);
    }
}

struct CubeRoots<'a> {
    base: &'a [f64],
    root: &'a mut [f64],
}

impl Work for CubeRoots<'_> {
    #[inline(always)]
    fn run<T: Target>(self) {
        cube_roots::<T>(self.base, self.root);
    }
}

/// Finds the samples from the first group of lanes with a positive base to the last. A contact that opens has runs of
/// samples whose base is not positive; at the ends of a block these are left out.
struct Positive<'a> {
    base: &'a [f64],
    at: &'a mut Range<usize>,
}

impl Work for Positive<'_> {
    #[inline(always)]
    fn run<T: Target>(self) {
        let mut groups = self.base.chunks_exact(LANES);
        let first = groups.position(is_positive).unwrap_or(0);
        let last = self.base.chunks_exact(LANES).rposition(is_positive);
        let end = last.map_or(first, |last| last + 1);
        *self.at = first * LANES..end * LANES;
    }
}

/// Whether a base of a group of lanes is positive, or not a number.
#[inline(always)]
fn is_positive(group: &[f64]) -> bool {
    let positive = |base: f64| (base > 0.0) | base.is_nan();
    group
        .iter()
        .fold(false, |found, &base| found | positive(base))
}
