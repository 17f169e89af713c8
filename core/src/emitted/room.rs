//! Working memory of kernels with powers, and what fills it: one column per base, logarithm and power of a block.

use std::cell::Cell;
use std::ops::Range;

use super::at_zero;
use super::batch::{Group, Uses};
use crate::power::{
    Accuracy, Available, Bases, LANES, Work, cube_roots, logarithms, multiply, powers, two_powers,
};

/// Samples per block. A column takes a kilobyte, so those of two bases and their powers stay in the first level of the
/// cache beside the outputs. Measured from 64 to 256: within 3 %.
pub(super) const BLOCK: usize = 256;

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
/// first ones.
pub(super) fn raise(set: Available, columns: &mut [Column], count: usize, plan: Plan<'_>) {
    let fill = Fill {
        columns,
        padded: count.next_multiple_of(LANES),
        plan,
    };
    for base in &mut fill.columns[..plan.bases] {
        base.0[count..fill.padded].fill(0.0);
    }
    match Accuracy::in_use() {
        Accuracy::Full => set.run(FillTo::<false>(fill)),
        Accuracy::Fast => set.run(FillTo::<true>(fill)),
    }
}

/// Columns to be filled.
struct Fill<'a> {
    columns: &'a mut [Column],
    /// The length that is computed.
    padded: usize,
    plan: Plan<'a>,
}

struct FillTo<'a, const FAST: bool>(Fill<'a>);

impl<const FAST: bool> Work for FillTo<'_, FAST> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Fill {
            columns,
            padded,
            plan,
        } = self.0;
        let (base, columns) = columns.split_at_mut(plan.bases);
        let (whole, columns) = columns.split_at_mut(plan.bases);
        let (part, power) = columns.split_at_mut(plan.bases);
        for (position, base) in base.iter().enumerate() {
            let base = Base::new(&base.0[..padded]);
            let whole = &mut whole[position].0[..padded];
            let part = &mut part[position].0[..padded];
            let needed = || plan.needed_of(position);
            if plan.needs.logarithm(position) || needed().any(|(group, _)| !group.cube_root) {
                base.logarithms::<FUSED, FAST>(whole, part);
            }
            for (group, last) in needed() {
                let members = group.first..=group.first + last;
                let exponents = &plan.exponents[members.clone()];
                let power = &mut power[members];
                if group.cube_root {
                    base.cube_root::<FUSED>(&mut power[0].0[..padded]);
                } else {
                    base.group::<FUSED, FAST>(whole, part, exponents, power);
                }
            }
        }
    }
}

/// The bases of a block. A contact that opens has runs of samples whose base is not positive; at the ends of a block these
/// are left out.
struct Base<'a> {
    base: &'a [f64],
    /// From the first group of lanes with a positive base to the last.
    positive: Range<usize>,
}

impl<'a> Base<'a> {
    #[inline(always)]
    fn new(base: &'a [f64]) -> Self {
        let mut groups = base.chunks_exact(LANES);
        let first = groups.position(is_positive).unwrap_or(0);
        let positive = base.chunks_exact(LANES).rposition(is_positive);
        let last = positive.map_or(first, |last| last + 1);
        Self {
            base,
            positive: first * LANES..last * LANES,
        }
    }

    /// The part of a column where bases are positive; the others get a value.
    #[inline(always)]
    fn positive<'b>(&self, column: &'b mut [f64], otherwise: f64) -> &'b mut [f64] {
        let Range { start, end } = self.positive;
        column[..start].fill(otherwise);
        column[end..].fill(otherwise);
        &mut column[start..end]
    }

    #[inline(always)]
    fn logarithms<const FUSED: bool, const FAST: bool>(&self, whole: &mut [f64], part: &mut [f64]) {
        let (whole, part) = (self.positive(whole, 0.0), self.positive(part, 0.0));
        logarithms::<FUSED, FAST>(&self.base[self.positive.clone()], whole, part);
    }

    #[inline(always)]
    fn cube_root<const FUSED: bool>(&self, root: &mut [f64]) {
        let root = self.positive(root, 0.0);
        cube_roots::<FUSED>(&self.base[self.positive.clone()], root);
    }

    /// The lowest power of a group is an exponential, the others are products with the base.
    #[inline(always)]
    fn group<const FUSED: bool, const FAST: bool>(
        &self,
        whole: &[f64],
        part: &[f64],
        exponents: &[f64],
        power: &mut [Column],
    ) {
        let positive = self.positive.clone();
        let of = Bases {
            base: &self.base[positive.clone()],
            whole: &whole[positive.clone()],
            part: &part[positive.clone()],
        };
        let count = self.base.len();
        let mut member = 0;
        while member < exponents.len() {
            let exponent = exponents[member];
            let (below, above) = power.split_at_mut(member);
            let below = below
                .last()
                .filter(|_| exponents[member - 1] >= LOWEST_SHARED);
            let [this, above @ ..] = above else { return };
            let this = self.positive(&mut this.0[..count], at_zero(exponent));
            member += 1;
            if let Some(below) = below {
                multiply(of.base, &below.0[positive.clone()], this);
                continue;
            }
            // The two of a force and its derivative at once.
            match above.first_mut().filter(|_| exponent >= LOWEST_SHARED) {
                Some(next) => {
                    let next = self.positive(&mut next.0[..count], 0.0);
                    two_powers::<FUSED, FAST>(of, exponent, this, next);
                    member += 1;
                }
                None => powers::<FUSED, FAST>(of, exponent, this),
            }
        }
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
