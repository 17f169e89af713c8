//! Powers, logarithms and cube roots against correctly rounded ones, on every instruction set that the processor has.

mod oracle;
mod table;

use oracle::{Pair, ulps};
use proptest::prelude::*;
use table::TABLE;

use super::*;
use crate::testing::random::Random;

/// Instruction sets that are present.
fn choices() -> Vec<Available> {
    let sets = Instructions::ALL.into_iter();
    sets.filter(|set| set.is_available())
        .map(Available::at_most)
        .collect()
}

/// The stated bound of the error of `x^a`, in units of the last place.
fn bound(x: f64, a: f64) -> f64 {
    1.5 + (1.2 * a.abs()).min(3.2 * (a * x.ln()).abs())
}

/// What is computed of an array of bases.
#[derive(Default)]
struct Results {
    /// Both parts of the logarithms to base two.
    logarithm: [Vec<f64>; 2],
    power: Vec<f64>,
    /// To an exponent one higher.
    next: Vec<f64>,
    /// The power without the next one.
    alone: Vec<f64>,
    cube_root: Vec<f64>,
}

struct Evaluation<'a> {
    base: &'a [f64],
    exponent: f64,
    to: &'a mut Results,
}

impl Work for Evaluation<'_> {
    #[inline(always)]
    #[allow(clippy::inline_always, reason = "compiled anew for each set")]
    fn run<T: Target>(self) {
        let Self { base, exponent, to } = self;
        let [whole, part] = &mut to.logarithm;
        logarithms::<T>(base, whole, part);
        let of = Bases { base, whole, part };
        two_powers::<T>(of, exponent, &mut to.power, &mut to.next);
        powers::<T>(of, exponent, &mut to.alone);
        cube_roots::<T>(base, &mut to.cube_root);
    }
}

fn evaluate(set: Available, base: &[f64], exponent: f64) -> Results {
    let unset = || vec![f64::NAN; base.len()];
    let mut to = Results {
        logarithm: [unset(), unset()],
        power: unset(),
        next: unset(),
        alone: unset(),
        cube_root: unset(),
    };
    set.run(Evaluation {
        base,
        exponent,
        to: &mut to,
    });
    assert!(
        same_bits(&to.power, &to.alone),
        "a power depends on whether the next is asked for"
    );
    to
}

fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.iter()
        .map(|x| x.to_bits())
        .eq(b.iter().map(|x| x.to_bits()))
}

/// Whether powers of positive bases are within the stated bound. Returns the greatest error beside its bound.
fn check(choice: Available, base: &[f64], exponent: f64) -> f64 {
    let found = evaluate(choice, base, exponent).power;
    let mut worst: f64 = 0.0;
    for (&x, &found) in base.iter().zip(&found) {
        let error = ulps(found, x, exponent);
        // A subnormal result is rounded once more.
        let subnormal = if found < f64::MIN_POSITIVE { 1.0 } else { 0.0 };
        let bound = bound(x, exponent) + subnormal;
        assert!(
            error <= bound,
            "{choice:?}: {x:e}^{exponent:e} = {found:e} is off by {error} of {bound}"
        );
        worst = worst.max(error / bound);
    }
    worst
}

/// Positive numbers of every size.
fn any_size(random: &mut Random) -> f64 {
    let largest = f64::MAX.to_bits() as f64;
    f64::from_bits(random.between(1.0, largest) as u64)
}

#[test]
fn the_oracle_agrees_with_mpmath() {
    for &(base, exponent, power, logarithm) in TABLE {
        let [base, exponent, power, logarithm] =
            [base, exponent, power, logarithm].map(f64::from_bits);
        assert!(
            ulps(power, base, exponent) <= 0.5 + 1e-9,
            "{base:e}^{exponent:e}"
        );
        let Pair { high, low } = Pair::ln(base);
        assert_eq!(high + low, logarithm, "ln {base:e}");
    }
}

#[test]
fn powers_at_the_edges_are_within_their_bounds() {
    for choice in choices() {
        for &(base, exponent, ..) in TABLE {
            check(choice, &[f64::from_bits(base); 8], f64::from_bits(exponent));
        }
    }
}

#[test]
fn random_powers_are_within_their_bounds() {
    let mut random = Random::seeded(1728);
    let mut exponents = vec![
        -1.9, -0.9, -0.4, 0.05, 0.3, 0.5, 1.0, 1.5, 1.7, 2.0, 2.2, 3.7, 17.3,
    ];
    exponents.extend((0..30).map(|_| random.between(-5.0, 5.0)));
    for choice in choices() {
        let mut worst: f64 = 0.0;
        for &exponent in &exponents {
            let near = (0..200).map(|_| 10_f64.powf(random.between(-3.0, 3.0)));
            let mut base: Vec<f64> = near.collect();
            base.extend((0..200).map(|_| any_size(&mut random)));
            base.extend((0..100).map(|_| 1.0 + random.between(-1e-6, 1e-6)));
            worst = worst.max(check(choice, &base, exponent));
        }
        assert!(worst > 0.3, "{choice:?}: {worst}");
    }
}

/// A force is made from the power of its derivative, if that has an exponent of at least -1/2.
#[test]
fn powers_made_from_the_one_below_are_within_their_bound() {
    let mut random = Random::seeded(1827);
    let mut exponents = vec![0.5, 0.6, 1.0, 1.5, 1.7, 2.2];
    exponents.extend((0..20).map(|_| random.between(0.5, 5.0)));
    for choice in choices() {
        for &exponent in &exponents {
            let mut base: Vec<f64> = (0..300).map(|_| any_size(&mut random)).collect();
            base.extend((0..300).map(|_| 10_f64.powf(random.between(-3.0, 3.0))));
            let found = evaluate(choice, &base, exponent - 1.0).next;
            for (&x, &found) in base.iter().zip(&found) {
                let error = ulps(found, x, exponent);
                let subnormal = if found < f64::MIN_POSITIVE { 1.0 } else { 0.0 };
                let bound = 4.0 + 4.0 * (exponent * x.ln()).abs() + subnormal;
                assert!(
                    error <= bound,
                    "{choice:?}: {x:e}^{exponent} is off by {error} of {bound}"
                );
            }
        }
    }
}

proptest! {
    #[test]
    fn any_power_is_within_its_bound(
        bases in prop::collection::vec(1..0x7ff0_0000_0000_0000_u64, 1..40),
        exponent in prop_oneof![-1e3..1e3, -3.0..3.0, -1e-3..1e-3, -1e300..1e300],
    ) {
        let bases: Vec<f64> = bases.into_iter().map(f64::from_bits).collect();
        for choice in choices() {
            check(choice, &bases, exponent);
        }
    }

    #[test]
    fn a_power_does_not_depend_on_its_neighbours(
        bases in prop::collection::vec(0..=u64::MAX, 1..60), exponent in -3.0..3.0_f64,
    ) {
        // Every bit pattern: negative, infinite and no numbers too.
        let bases: Vec<f64> = bases.into_iter().map(f64::from_bits).collect();
        for choice in choices() {
            let all = evaluate(choice, &bases, exponent);
            for (i, &base) in bases.iter().enumerate() {
                let one = evaluate(choice, &[base], exponent);
                prop_assert!(same_bits(&one.power, &all.power[i..=i]));
                prop_assert!(same_bits(&one.next, &all.next[i..=i]));
                prop_assert!(same_bits(&one.cube_root, &all.cube_root[i..=i]));
                for (one, all) in one.logarithm.iter().zip(&all.logarithm) {
                    prop_assert!(same_bits(one, &all[i..=i]));
                }
            }
        }
    }

    #[test]
    fn any_logarithm_is_within_four_units(bits in prop::collection::vec(1..0x7ff0_0000_0000_0000_u64, 1..40)) {
        let bases: Vec<f64> = bits.into_iter().map(f64::from_bits).collect();
        check_logarithms(&bases);
    }

    #[test]
    fn any_cube_root_is_within_one_unit(bits in prop::collection::vec(1..0x7ff0_0000_0000_0000_u64, 1..40)) {
        let bases: Vec<f64> = bits.into_iter().map(f64::from_bits).collect();
        check_cube_roots(&bases);
    }
}

fn check_logarithms(bases: &[f64]) {
    for choice in choices() {
        let [whole, part] = evaluate(choice, bases, 1.0).logarithm;
        for ((&x, whole), part) in bases.iter().zip(whole).zip(part) {
            let exact = Pair::ln(x);
            let found = (whole + part) * std::f64::consts::LN_2;
            let error = ((found - exact.high) - exact.low) / (f64::EPSILON * exact.high);
            assert!(
                x == 1.0 || error.abs() <= 4.0,
                "{choice:?}: ln {x:e} is off by {error}"
            );
            assert!(x != 1.0 || found == 0.0);
        }
    }
}

#[test]
fn logarithms_near_one_are_within_four_units() {
    let mut random = Random::seeded(6);
    let mut near: Vec<f64> = vec![1.0, 1.0_f64.next_up(), 1.0_f64.next_down(), 0.7, 1.42];
    for size in [1e-15, 1e-9, 1e-4, 0.3] {
        near.extend((0..1000).map(|_| 1.0 + random.between(-size, size)));
    }
    check_logarithms(&near);
}

/// Whether `c^3 - x`, relative to `3 x`, is below a unit in the last place, on all instruction sets and by itself.
fn check_cube_roots(bases: &[f64]) {
    let mut found: Vec<Vec<f64>> = choices()
        .into_iter()
        .map(|choice| evaluate(choice, bases, 1.0).cube_root)
        .collect();
    found.push(bases.iter().map(|&x| cube_root::<Baseline>(x)).collect());
    for roots in found {
        for (&x, c) in bases.iter().zip(roots) {
            // By a power of eight into the middle of the range.
            let (scale, root_of_scale) = match x {
                ..1e-200 => (2_f64.powi(600), 2_f64.powi(200)),
                1e200.. => (2_f64.powi(-600), 2_f64.powi(-200)),
                _ => (1.0, 1.0),
            };
            let (scaled, c) = (x * scale, Pair::new(c * root_of_scale));
            let Pair { high, low } = c * c * c + Pair::new(-scaled);
            let error = (high + low) / (3.0 * scaled * f64::EPSILON);
            assert!(
                error.abs() <= 1.0,
                "the cube root of {x:e} is off by {error}"
            );
        }
    }
}

#[test]
fn cube_roots_are_within_one_unit() {
    let mut random = Random::seeded(27);
    let mut bases = vec![
        5e-324,
        f64::MIN_POSITIVE.next_down(),
        f64::MIN_POSITIVE,
        f64::MAX,
    ];
    bases.extend((0..20_000).map(|_| 8_f64.powf(random.between(-1.0, 1.0))));
    bases.extend((0..20_000).map(|_| any_size(&mut random)));
    check_cube_roots(&bases);
    let infinite = f64::INFINITY;
    for choice in choices() {
        let base = [0.0, 1.0, 8.0, 1e-300, infinite, f64::NAN];
        let found = evaluate(choice, &base, 1.0).cube_root;
        assert_eq!(found[..5], [0.0, 1.0, 2.0, 1e-100, infinite]);
        assert!(found[5].is_nan());
    }
}

#[test]
fn infinity_counts_as_itself_and_what_is_no_number_stays_so() {
    let infinite = f64::INFINITY;
    for choice in choices() {
        for (exponent, at_infinity) in [
            (1.7, infinite),
            (0.1, infinite),
            (-0.4, 0.0),
            (0.0, 1.0),
            (1e300, infinite),
        ] {
            let found = evaluate(choice, &[infinite, f64::NAN], exponent);
            assert_eq!(found.power[0], at_infinity, "{choice:?}, {exponent}");
            assert_eq!(found.next[0], infinite, "{choice:?}, {exponent}");
            let [whole, part] = &found.logarithm;
            assert_eq!(whole[0] + part[0], infinite);
            assert!((whole[1] + part[1]).is_nan());
            assert!(found.next[1].is_nan() && (exponent == 0.0 || found.power[1].is_nan()));
        }
    }
}

/// Nobody uses the power of such a base, but it must not send all others the long way, and its logarithm must be a number.
#[test]
fn the_logarithm_of_what_is_not_positive_is_zero() {
    let base = [0.0, -0.0, -5e-324, -1.0, -1e300, f64::NEG_INFINITY];
    for choice in choices() {
        let [whole, part] = evaluate(choice, &base, 1.7).logarithm;
        assert_eq!([whole, part], [[0.0; 6]; 2]);
    }
}
