//! Batches: kernels of one sample become loops over slices of one length, compiled for every instruction set.
//!
//! A kernel without powers is merged into one loop; values that the loop does not store are not computed. Of a kernel with
//! powers, every block of samples is gone over three times: its bases, then their logarithms and powers (in
//! [`power`](crate::numeric::power), compiled once and not for each law), then its values.

// Merged into the loops of every instruction set.
#![allow(clippy::inline_always)]

use std::f64::consts::LN_2;
use std::marker::PhantomData;

use super::outputs::Outputs;
use super::workspace::{BLOCK, Column, Plan, Room, raise};
use crate::law::Derivatives;
use crate::numeric::power::{Available, Target, Work};

/// Samples, and where to write values; runs a kernel on them.
pub trait Batch<const A: usize, const V: usize> {
    /// Runs a kernel.
    fn run<K: Kernel<A, V>>(self, kernel: K);

    /// Runs a kernel with powers.
    fn raise<K, const B: usize, const G: usize, const P: usize>(self, kernel: K)
    where
        K: Raising<A, V, B, G, P>;
}

/// A kernel: a function of arguments, gap and rate. It is a type, and not a closure, because a call of a closure is a
/// function between that the compiler may leave out of the loop.
pub trait Kernel<const A: usize, const V: usize> {
    /// The values at a sample.
    fn values(arguments: [f64; A], gap: f64, rate: f64) -> [f64; V];
}

/// The kernel of a piece without force.
#[derive(Debug)]
pub struct Nothing;

impl<const A: usize, const V: usize> Kernel<A, V> for Nothing {
    #[inline(always)]
    fn values(_: [f64; A], _: f64, _: f64) -> [f64; V] {
        [0.0; V]
    }
}

/// A kernel with `P` powers in `G` groups, of `B` bases.
pub trait Raising<const A: usize, const V: usize, const B: usize, const G: usize, const P: usize> {
    /// Which powers share an exponential.
    const GROUPS: [Group; G];

    /// What each value depends on.
    const USES: [Uses; V];

    /// The bases at a sample.
    fn bases(arguments: [f64; A], gap: f64, rate: f64) -> [f64; B];

    /// The exponents of the powers.
    fn exponents(arguments: [f64; A]) -> [f64; P];

    /// The values at a sample, from the natural logarithms of the bases and the powers.
    fn values(
        arguments: [f64; A],
        gap: f64,
        rate: f64,
        logarithms: [f64; B],
        powers: [f64; P],
    ) -> [f64; V];
}

/// Powers of one base that are computed together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Group {
    /// The position of the base.
    pub(super) base: usize,
    /// The position of the lowest power.
    pub(super) first: usize,
    /// How many there are.
    pub(super) count: usize,
    /// It is the cube root, whatever its exponent.
    pub(super) cube_root: bool,
}

/// Powers of a base, of which the first has a given position, with exponents that count up by one.
pub const fn group(base: usize, first: usize, count: usize) -> Group {
    Group {
        base,
        first,
        count,
        cube_root: false,
    }
}

/// The cube root of a base, as the power at a position.
pub const fn cube_root_group(base: usize, first: usize) -> Group {
    Group {
        base,
        first,
        count: 1,
        cube_root: true,
    }
}

/// Sets of logarithms and of powers, by position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Uses {
    logarithms: u64,
    powers: u64,
}

/// The sets of the given positions, each below 64.
pub const fn uses(logarithms: &[u32], powers: &[u32]) -> Uses {
    Uses {
        logarithms: set(logarithms),
        powers: set(powers),
    }
}

const fn set(positions: &[u32]) -> u64 {
    let (mut set, mut index) = (0, 0);
    while index < positions.len() {
        set |= 1 << positions[index];
        index += 1;
    }
    set
}

impl Uses {
    /// Nothing.
    pub(super) const NOTHING: Self = uses(&[], &[]);

    #[inline(always)]
    pub(super) const fn logarithm(self, position: usize) -> bool {
        self.logarithms >> position & 1 == 1
    }

    #[inline(always)]
    pub(super) const fn power(self, position: usize) -> bool {
        self.powers >> position & 1 == 1
    }

    /// What is in either.
    #[inline(always)]
    pub(super) const fn and(self, other: Self) -> Self {
        Self {
            logarithms: self.logarithms | other.logarithms,
            powers: self.powers | other.powers,
        }
    }
}

/// The inputs of a batch.
#[derive(Clone, Copy)]
pub(super) struct Samples<'a, const A: usize> {
    arguments: [f64; A],
    gap: &'a [f64],
    rate: &'a [f64],
}

impl<'a, const A: usize> Samples<'a, A> {
    #[inline]
    pub(super) fn new(arguments: &[f64], gap: &'a [f64], rate: &'a [f64]) -> Self {
        let arguments = super::arguments(arguments);
        assert_eq!(rate.len(), gap.len(), "gap and rate differ in length");
        Self {
            arguments,
            gap,
            rate,
        }
    }

    /// Whether an output is as long as the samples.
    #[inline]
    pub(super) fn check(&self, output: &[f64]) {
        assert_eq!(
            output.len(),
            self.gap.len(),
            "an output differs in length from the samples"
        );
    }

    #[inline]
    pub(super) fn check_all(&self, out: &Derivatives<'_>) {
        self.check(out.force);
        self.check(out.by_gap);
        self.check(out.by_rate);
    }
}

/// A batch to be run.
pub(super) struct Call<'a, O, const A: usize, const V: usize> {
    pub(super) samples: Samples<'a, A>,
    pub(super) outputs: O,
}

impl<O: Outputs<V>, const A: usize, const V: usize> Batch<A, V> for Call<'_, O, A, V> {
    #[inline]
    fn run<K: Kernel<A, V>>(self, _: K) {
        Available::in_use().run(Plain::<'_, _, K, A, V> {
            call: self,
            kernel: PhantomData,
        });
    }

    #[inline]
    fn raise<K, const B: usize, const G: usize, const P: usize>(self, _: K)
    where
        K: Raising<A, V, B, G, P>,
    {
        let mut room = Room::take(3 * B + P);
        Available::in_use().run(Powers::<'_, _, K, A, V, B, G, P> {
            call: self,
            columns: room.columns(),
            kernel: PhantomData,
        });
        room.give_back();
    }
}

/// The loop of a kernel without powers.
struct Plain<'a, O, K, const A: usize, const V: usize> {
    call: Call<'a, O, A, V>,
    kernel: PhantomData<K>,
}

impl<O, K, const A: usize, const V: usize> Work for Plain<'_, O, K, A, V>
where
    O: Outputs<V>,
    K: Kernel<A, V>,
{
    #[inline(always)]
    fn run<T: Target>(self) {
        let (of, mut outputs) = (self.call.samples, self.call.outputs);
        let (arguments, gap, rate) = (of.arguments, of.gap, of.rate);
        let count = gap.len();
        let rate = &rate[..count];
        outputs.write(
            0,
            count,
            #[inline(always)]
            |i| K::values(arguments, gap[i], rate[i]),
        );
    }
}

/// The loops of a kernel with powers.
struct Powers<
    'a,
    O,
    K,
    const A: usize,
    const V: usize,
    const B: usize,
    const G: usize,
    const P: usize,
> {
    call: Call<'a, O, A, V>,
    columns: &'a mut [Column],
    kernel: PhantomData<K>,
}

impl<O, K, const A: usize, const V: usize, const B: usize, const G: usize, const P: usize> Work
    for Powers<'_, O, K, A, V, B, G, P>
where
    O: Outputs<V>,
    K: Raising<A, V, B, G, P>,
{
    #[inline(always)]
    fn run<T: Target>(self) {
        let (of, mut outputs) = (self.call.samples, self.call.outputs);
        let (arguments, gap, rate) = (of.arguments, of.gap, of.rate);
        let set = Available::in_use();
        let (needs, exponents) = (O::needs(&K::USES), K::exponents(arguments));
        let at_zero = exponents.map(super::at_zero);
        let plan = Plan {
            bases: B,
            needs,
            groups: &K::GROUPS,
            exponents: &exponents,
        };
        for start in (0..gap.len()).step_by(BLOCK) {
            let count = BLOCK.min(gap.len() - start);
            let (gap, rate) = (&gap[start..][..count], &rate[start..][..count]);
            for (base, column) in self.columns[..B].iter_mut().enumerate() {
                fill::<K, A, V, B, G, P>(&mut column.0[..count], base, arguments, [gap, rate]);
            }
            raise(set, self.columns, count, plan);
            let Some(of) = Raised::<B, P>::among(self.columns) else {
                return;
            };
            let Raised {
                base,
                whole,
                part,
                power,
            } = of;
            outputs.write(
                start,
                count,
                #[inline(always)]
                |i| {
                    let (mut logarithms, mut powers) = ([0.0; B], [0.0; P]);
                    for at in 0..B {
                        if needs.logarithm(at) {
                            let logarithm = (whole[at].0[i] + part[at].0[i]) * LN_2;
                            logarithms[at] = guarded(base[at].0[i], logarithm);
                        }
                    }
                    for group in K::GROUPS {
                        for at in group.first..group.first + group.count {
                            if needs.power(at) {
                                let base = base[group.base].0[i];
                                powers[at] = at_least(at_zero[at], guarded(base, power[at].0[i]));
                            }
                        }
                    }
                    K::values(arguments, gap[i], rate[i], logarithms, powers)
                },
            );
        }
    }
}

/// The columns of a block: bases, both parts of their logarithms, and powers.
struct Raised<'a, const B: usize, const P: usize> {
    base: &'a [Column; B],
    whole: &'a [Column; B],
    part: &'a [Column; B],
    power: &'a [Column; P],
}

impl<'a, const B: usize, const P: usize> Raised<'a, B, P> {
    #[inline(always)]
    fn among(columns: &'a [Column]) -> Option<Self> {
        let (base, columns) = columns.split_first_chunk()?;
        let (whole, columns) = columns.split_first_chunk()?;
        let (part, columns) = columns.split_first_chunk()?;
        let (power, _) = columns.split_first_chunk()?;
        Some(Self {
            base,
            whole,
            part,
            power,
        })
    }
}

/// What was computed of a base, or, where that is not positive, zero.
#[inline(always)]
fn guarded(base: f64, value: f64) -> f64 {
    if base <= 0.0 { 0.0 } else { value }
}

/// The greater of two numbers, the second of which may not be one; the result then is not either. Unlike `f64::max` it is
/// one instruction.
#[inline(always)]
fn at_least(low: f64, value: f64) -> f64 {
    if low > value { low } else { value }
}

/// Writes one base of every sample.
#[inline(always)]
fn fill<K, const A: usize, const V: usize, const B: usize, const G: usize, const P: usize>(
    column: &mut [f64],
    base: usize,
    arguments: [f64; A],
    [gap, rate]: [&[f64]; 2],
) where
    K: Raising<A, V, B, G, P>,
{
    let count = column.len();
    let (gap, rate) = (&gap[..count], &rate[..count]);
    for i in 0..count {
        column[i] = K::bases(arguments, gap[i], rate[i])[base];
    }
}
