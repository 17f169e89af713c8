//! The parts of a law that is linear in its rate: other views of the kernels of the whole.

// Merged into the loops of every instruction set.
#![allow(clippy::inline_always)]

use std::marker::PhantomData;

use super::batch::{Batch, Group, Kernel, Raising, Uses};
use super::law::{ByArgument, Kernels};
use crate::law::On;

/// The spring `f` of a law: the law at zero rate.
#[derive(Debug)]
pub struct Spring<K>(PhantomData<fn() -> K>);

/// The primitive `G` of the rate term of a law.
#[derive(Debug)]
pub struct Primitive<K>(PhantomData<fn() -> K>);

/// Declares the kernels of a part: those of the whole law, run through a batch that changes their values.
macro_rules! part {
    ($name:ident, $batch:ident) => {
        impl<K: Kernels<A, L, V>, const A: usize, const L: usize, const V: usize> Kernels<A, L, V>
            for $name<K>
        {
            fn levels(arguments: [f64; A]) -> [f64; L] {
                K::levels(arguments)
            }

            fn levels_by(argument: usize, arguments: [f64; A]) -> [f64; L] {
                K::levels_by(argument, arguments)
            }

            fn on(on: On, batch: impl Batch<A, V>) {
                K::on(on, $batch(batch));
            }

            fn by_argument(argument: usize, call: impl ByArgument) {
                K::by_argument(argument, call);
            }
        }
    };
}

part!(Spring, AtRest);
part!(Primitive, Integrated);

/// A batch whose kernel is run at zero rate; also such a kernel.
struct AtRest<T>(T);

/// A batch that sees the primitive, its derivative by the gap, which is the law's by its rate, and those by arguments; also
/// such a kernel.
struct Integrated<T>(T);

/// Declares the batch of a part.
macro_rules! batch {
    ($name:ident) => {
        impl<T: Batch<A, V>, const A: usize, const V: usize> Batch<A, V> for $name<T> {
            #[inline]
            fn run<K: Kernel<A, V>>(self, kernel: K) {
                self.0.run($name(kernel));
            }

            #[inline]
            fn raise<K, const B: usize, const G: usize, const P: usize>(self, kernel: K)
            where
                K: Raising<A, V, B, G, P>,
            {
                self.0.raise($name(kernel));
            }
        }
    };
}

batch!(AtRest);
batch!(Integrated);

/// The values of a law at zero rate, or what they depend on.
#[inline(always)]
const fn at_rest<T: Copy, const V: usize>(whole: [T; V], nothing: T) -> [T; V] {
    let mut values = whole;
    values[2] = nothing;
    values
}

/// The values of the primitive among those of the law, or what they depend on.
#[inline(always)]
const fn integrated<T: Copy, const A: usize, const V: usize>(whole: [T; V], nothing: T) -> [T; V] {
    let mut values = [nothing; V];
    values[0] = whole[3 + A];
    values[1] = whole[2];
    let mut argument = 0;
    while argument < A {
        values[3 + argument] = whole[4 + A + argument];
        argument += 1;
    }
    values
}

/// Declares the kernels of a part, from the values of the whole.
macro_rules! kernels {
    ($name:ident, $values:expr) => {
        impl<K: Kernel<A, V>, const A: usize, const V: usize> Kernel<A, V> for $name<K> {
            #[inline(always)]
            fn values(arguments: [f64; A], gap: f64, _: f64) -> [f64; V] {
                $values(K::values(arguments, gap, 0.0), 0.0)
            }
        }

        impl<K, const A: usize, const V: usize, const B: usize, const G: usize, const P: usize>
            Raising<A, V, B, G, P> for $name<K>
        where
            K: Raising<A, V, B, G, P>,
        {
            const GROUPS: [Group; G] = K::GROUPS;
            const USES: [Uses; V] = $values(K::USES, Uses::NOTHING);

            #[inline(always)]
            fn bases(arguments: [f64; A], gap: f64, _: f64) -> [f64; B] {
                K::bases(arguments, gap, 0.0)
            }

            #[inline(always)]
            fn exponents(arguments: [f64; A]) -> [f64; P] {
                K::exponents(arguments)
            }

            #[inline(always)]
            fn values(
                arguments: [f64; A],
                gap: f64,
                _: f64,
                logarithms: [f64; B],
                powers: [f64; P],
            ) -> [f64; V] {
                $values(K::values(arguments, gap, 0.0, logarithms, powers), 0.0)
            }
        }
    };
}

kernels!(AtRest, at_rest);
kernels!(Integrated, integrated::<_, A, V>);
