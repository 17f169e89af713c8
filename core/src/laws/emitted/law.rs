//! What every generated law has in common.

use std::marker::PhantomData;

use super::batch::{Batch, Call, Samples};
use super::outputs::{Force, Slopes, SlopesAndBy};
use crate::law::{Derivatives, Law, LawFacts, On, Parts};
use crate::laws::generic::LawData;

/// The kernels of a law with `A` arguments, `L` levels and `V` values: force, by gap, by rate, and by each argument; of a
/// law that is linear in its rate then the primitive of its rate term, and the derivatives of that by each argument.
pub trait Kernels<const A: usize, const L: usize, const V: usize>: 'static {
    /// The levels.
    fn levels(arguments: [f64; A]) -> [f64; L];

    /// The derivatives of the levels by one argument: zero, unless a law says otherwise.
    fn levels_by(_argument: usize, _arguments: [f64; A]) -> [f64; L] {
        [0.0; L]
    }

    /// Runs a batch with the kernel of one piece, or of all pieces by selection.
    fn on(on: On, batch: impl Batch<A, V>);

    /// Makes a call with the position, among the values of a kernel, of the derivative by one argument.
    fn by_argument(argument: usize, call: impl ByArgument);
}

/// A call that needs the position of the derivative by an argument.
pub trait ByArgument {
    /// Makes the call.
    fn run<const AT: usize>(self);
}

/// The law that kernels, facts and data make.
#[derive(Debug)]
pub struct Generated<K, const A: usize, const L: usize, const V: usize> {
    facts: LawFacts,
    data: LawData,
    parts: Option<Parts<'static>>,
    kernels: PhantomData<fn() -> K>,
}

impl<K, const A: usize, const L: usize, const V: usize> Generated<K, A, L, V> {
    /// The law of given kernels, without [`parts`](Law::parts).
    pub const fn new(facts: LawFacts, data: LawData) -> Self {
        Self {
            facts,
            data,
            parts: None,
            kernels: PhantomData,
        }
    }

    /// The same law with the spring and the primitive of [`Law::parts`].
    #[must_use]
    pub const fn with_parts(
        mut self,
        spring: &'static dyn Law,
        primitive: &'static dyn Law,
    ) -> Self {
        self.parts = Some(Parts::new(spring, primitive));
        self
    }
}

impl<K: Kernels<A, L, V>, const A: usize, const L: usize, const V: usize> Law
    for Generated<K, A, L, V>
{
    fn facts(&self) -> &LawFacts {
        &self.facts
    }

    fn data(&self) -> Option<&LawData> {
        Some(&self.data)
    }

    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        levels.copy_from_slice(&K::levels(super::arguments(arguments)));
    }

    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) {
        by_argument.copy_from_slice(&K::levels_by(argument, super::arguments(arguments)));
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        let samples = Samples::new(arguments, gap, rate);
        samples.check(force);
        K::on(
            on,
            Call {
                samples,
                outputs: Force(force),
            },
        );
    }

    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        let samples = Samples::new(arguments, gap, rate);
        samples.check_all(&out);
        K::on(
            on,
            Call {
                samples,
                outputs: Slopes(out),
            },
        );
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        let samples = Samples::new(arguments, gap, rate);
        samples.check_all(&out);
        samples.check(by_argument);
        let call = CallBy {
            kernels: PhantomData::<K>,
            on,
            samples,
            out,
            by_argument,
        };
        K::by_argument(argument, call);
    }

    fn parts(&self) -> Option<Parts<'_>> {
        self.parts
    }
}

/// A call that is made once it is known where the derivative by an argument is.
struct CallBy<'a, K, const A: usize, const L: usize, const V: usize> {
    kernels: PhantomData<K>,
    on: On,
    samples: Samples<'a, A>,
    out: Derivatives<'a>,
    by_argument: &'a mut [f64],
}

impl<K: Kernels<A, L, V>, const A: usize, const L: usize, const V: usize> ByArgument
    for CallBy<'_, K, A, L, V>
{
    #[inline]
    fn run<const AT: usize>(self) {
        let Self {
            out, by_argument, ..
        } = self;
        let outputs = SlopesAndBy::<AT> { out, by_argument };
        K::on(
            self.on,
            Call {
                samples: self.samples,
                outputs,
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::emitted::{
        Group, Kernel, Nothing, Primitive, Raising, Spring, Uses, group, uses,
    };

    /// `phi = a g^2 + 3 g r` and its primitive `3 g^2 / 2`, on two pieces that meet at `a`.
    struct Square;

    impl Kernel<1, 6> for Square {
        fn values([a]: [f64; 1], g: f64, r: f64) -> [f64; 6] {
            let by_gap = 2.0 * a * g + 3.0 * r;
            [
                a * g * g + 3.0 * g * r,
                by_gap,
                3.0 * g,
                g * g,
                1.5 * g * g,
                0.0,
            ]
        }
    }

    impl Kernels<1, 1, 6> for Square {
        fn levels(arguments: [f64; 1]) -> [f64; 1] {
            arguments
        }

        fn on(on: On, batch: impl Batch<1, 6>) {
            match on {
                On::Piece(0) => batch.run(Nothing),
                _ => batch.run(Square),
            }
        }

        fn by_argument(argument: usize, call: impl ByArgument) {
            assert_eq!(argument, 0);
            call.run::<3>();
        }
    }

    fn law<K>() -> Generated<K, 1, 1, 6> {
        use crate::laws::emitted::constants::*;
        Generated::new(
            law_facts("square", &[], &[], &[], LINEAR, false),
            data(&[], &[], &[]),
        )
    }

    /// Force, by gap, by rate, by argument at gap 2, rate 5, argument 7.
    fn values(law: &dyn Law, on: On) -> [f64; 4] {
        let [mut force, mut by_gap, mut by_rate, mut by_argument] = [[f64::NAN]; 4];
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        law.derivatives_and_by(0, on, &[7.0], &[2.0], &[5.0], out, &mut by_argument);
        let mut alone = [f64::NAN];
        law.force(on, &[7.0], &[2.0], &[5.0], &mut alone);
        assert_eq!(alone, force);
        [force[0], by_gap[0], by_rate[0], by_argument[0]]
    }

    #[test]
    fn a_law_and_its_parts_are_views_of_one_kernel() {
        assert_eq!(
            values(&law::<Square>(), On::AllPieces),
            [58.0, 43.0, 6.0, 4.0]
        );
        assert_eq!(values(&law::<Square>(), On::Piece(0)), [0.0; 4]);
        let spring = law::<Spring<Square>>();
        assert_eq!(values(&spring, On::AllPieces), [28.0, 28.0, 0.0, 4.0]);
        let primitive = law::<Primitive<Square>>();
        assert_eq!(values(&primitive, On::AllPieces), [6.0, 6.0, 0.0, 0.0]);
        let mut levels = [f64::NAN];
        primitive.levels(&[7.0], &mut levels);
        assert_eq!(levels, [7.0]);
        primitive.levels_by(&[7.0], 0, &mut levels);
        assert_eq!(levels, [0.0]);
    }

    /// `phi = g^a`, with its derivatives by `g` and `a`.
    struct Power;

    impl Raising<1, 4, 1, 1, 2> for Power {
        const GROUPS: [Group; 1] = [group(0, 0, 2)];
        const USES: [Uses; 4] = [
            uses(&[], &[1]),
            uses(&[], &[0]),
            uses(&[], &[]),
            uses(&[0], &[1]),
        ];

        fn bases(_: [f64; 1], g: f64, _: f64) -> [f64; 1] {
            [g]
        }

        fn exponents([a]: [f64; 1]) -> [f64; 2] {
            [a - 1.0, a]
        }

        fn values(
            [a]: [f64; 1],
            _: f64,
            _: f64,
            [l]: [f64; 1],
            [below, power]: [f64; 2],
        ) -> [f64; 4] {
            [power, a * below, 0.0, power * l]
        }
    }

    impl Kernels<1, 0, 4> for Power {
        fn levels(_: [f64; 1]) -> [f64; 0] {
            []
        }

        fn on(_: On, batch: impl Batch<1, 4>) {
            batch.raise(Power);
        }

        fn by_argument(_: usize, call: impl ByArgument) {
            call.run::<3>();
        }
    }

    /// Where no power is computed, nothing is left of what was computed before.
    #[test]
    fn powers_of_what_is_not_positive_are_those_of_zero() {
        use crate::laws::emitted::constants::{INDEPENDENT, data, law_facts};
        let law = Generated::<Power, 1, 0, 4>::new(
            law_facts("power", &[], &[], &[], INDEPENDENT, false),
            data(&[], &[], &[]),
        );
        let gaps = |i: usize| [0.0, -3.0, -0.0, f64::NEG_INFINITY][i % 4];
        let closed: Vec<f64> = (0..600).map(gaps).collect();
        let open = [f64::INFINITY; 600];
        let mut outputs = [const { Vec::new() }; 4];
        for (gap, a, expected) in [
            (open.as_slice(), 1.7, [f64::INFINITY; 3]),
            (&closed, 1.7, [0.0; 3]),
            (&open, 1.0, [f64::INFINITY, 1.0, f64::INFINITY]),
            (&closed, 1.0, [0.0, 1.0, 0.0]),
            (&closed, 0.4, [0.0; 3]),
            (&open, 0.4, [f64::INFINITY, 0.0, f64::INFINITY]),
            (&open, 0.6, [f64::INFINITY, 0.0, f64::INFINITY]),
        ] {
            let [force, by_gap, by_rate, by_argument] = &mut outputs;
            for output in [&mut *force, by_gap, by_rate, by_argument] {
                *output = vec![f64::NAN; gap.len()];
            }
            let out = Derivatives {
                force,
                by_gap,
                by_rate,
            };
            law.derivatives_and_by(0, On::AllPieces, &[a], gap, gap, out, by_argument);
            for (output, expected) in [force, by_gap, by_argument].into_iter().zip(expected) {
                assert!(output.iter().all(|&found| found == expected), "{gap:?}^{a}");
            }
        }
    }

    #[test]
    #[should_panic(expected = "gap and rate differ in length")]
    fn slices_of_different_length_are_refused() {
        law::<Square>().force(On::AllPieces, &[7.0], &[1.0], &[], &mut [0.0]);
    }
}
