//! Instruction sets, chosen at run time: one compilation of the same loops for each.
//!
//! Where nothing is optimised (`opt-level` 0, told by `build.rs`), loops are not vectors, and only the baseline is compiled: a
//! program with many models is then built in a third of the time.

use std::sync::atomic::{AtomicU8, Ordering};

/// The environment variable that chooses the instruction set.
const VARIABLE: &str = "HERTZIAN_INSTRUCTIONS";

/// An instruction set that inner loops are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Instructions {
    /// What every processor of the target has: on x86-64, vectors of two numbers.
    Baseline,
    /// AVX2 and fused multiply-add: vectors of four numbers.
    Avx2,
    /// AVX-512 (F, DQ, VL, BW) as well: vectors of eight numbers.
    Avx512,
}

impl Instructions {
    /// All of them, each with more than the one before.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// Its name in the environment variable.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// Whether this processor has it. Without optimisation there is the baseline alone.
    pub fn is_available(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(all(target_arch = "x86_64", not(unoptimised)))]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(all(target_arch = "x86_64", not(unoptimised)))]
            Self::Avx512 => {
                Self::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512bw")
            }
            #[cfg(any(not(target_arch = "x86_64"), unoptimised))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// The instruction set that generated laws use, from the first evaluation until the process ends: the last that the processor
    /// has, unless [`Instructions::initialise`] or the environment variable `HERTZIAN_INSTRUCTIONS` (`baseline`, `avx2` or `avx512`) said
    /// otherwise before.
    pub fn in_use() -> Self {
        Available::in_use().0
    }

    /// Makes all generated laws of this process use this instruction set, or, where the processor does not have it, the last before it
    /// that it has. To be called once, before any law is evaluated; what is in use is never changed. Returns the set in use.
    ///
    /// Forces differ between instruction sets in their last digits, because products and sums are fused where that is
    /// possible.
    ///
    /// ```
    /// use hertzian::power::Instructions;
    ///
    /// assert_eq!(Instructions::Baseline.initialise(), Ok(Instructions::Baseline));
    /// // Whoever asks for another one later is told so.
    /// if Instructions::Avx2.is_available() {
    ///     assert_eq!(Instructions::Avx2.initialise(), Err(Instructions::Baseline));
    /// }
    /// ```
    ///
    /// # Errors
    /// If another one is in use already: that one.
    pub fn initialise(self) -> Result<Self, Self> {
        let wanted = Available::at_most(self);
        let Available(found) = wanted.unless_chosen();
        if found == wanted.0 {
            Ok(found)
        } else {
            Err(found)
        }
    }
}

/// The set in use, by its position plus one; zero as long as it has not been asked for.
static IN_USE: AtomicU8 = AtomicU8::new(0);

/// An instruction set that this processor has: no other can be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Available(Instructions);

impl Available {
    /// The last that the processor has, up to the given one.
    pub(crate) fn at_most(wanted: Instructions) -> Self {
        let mut sets = Instructions::ALL.into_iter().rev();
        let found = sets.find(|set| *set <= wanted && set.is_available());
        Self(found.unwrap_or(Instructions::Baseline))
    }

    /// The set in use.
    #[inline]
    pub fn in_use() -> Self {
        match IN_USE.load(Ordering::Relaxed) {
            // What was stored is the position of an available set.
            1 => Self(Instructions::Baseline),
            2 => Self(Instructions::Avx2),
            3 => Self(Instructions::Avx512),
            _ => Self::first(),
        }
    }

    /// Chooses and stores the set. Two threads that do so at once store the same.
    #[cold]
    fn first() -> Self {
        let named = std::env::var(VARIABLE).ok();
        Self::at_most(wanted(named.as_deref())).unless_chosen()
    }

    /// Puts this set into use, unless there is one; the one in use.
    fn unless_chosen(self) -> Self {
        let (new, order) = (self.0 as u8 + 1, Ordering::Relaxed);
        match IN_USE.compare_exchange(0, new, order, order) {
            Ok(_) => self,
            Err(_) => Self::in_use(),
        }
    }

    /// Runs work that was compiled for this set.
    #[inline]
    pub fn run<W: Work>(self, work: W) {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", not(unoptimised)))]
            // SAFETY: the set is available, by the construction of `Available`.
            Instructions::Avx512 => unsafe { avx512(work) },
            #[cfg(all(target_arch = "x86_64", not(unoptimised)))]
            // SAFETY: as above.
            Instructions::Avx2 => unsafe { avx2(work) },
            _ => baseline(work),
        }
    }
}

/// The set that a value of the environment variable asks for; without one, or with an unknown one, the last.
fn wanted(named: Option<&str>) -> Instructions {
    let mut sets = Instructions::ALL.into_iter();
    let found = sets.find(|set| named.is_some_and(|name| name.eq_ignore_ascii_case(set.name())));
    found.unwrap_or(Instructions::Avx512)
}

/// Loops to be compiled for several instruction sets. Everything they call has to be merged into them
/// (`#[inline(always)]`): a function that is called is compiled for the baseline.
pub trait Work {
    /// Does the work.
    fn run<T: Target>(self);
}

/// What loops are compiled for.
pub trait Target {
    /// Whether a product and a sum are one operation. Where they are not, `mul_add` is a slow function.
    const FUSED: bool;

    /// How polynomials are summed. All were measured on all targets.
    const ORDER: Order;

    /// `a b + c`
    #[inline(always)]
    #[allow(clippy::inline_always, reason = "one or two operations")]
    fn add_product(a: f64, b: f64, c: f64) -> f64 {
        if Self::FUSED {
            a.mul_add(b, c)
        } else {
            a * b + c
        }
    }
}

/// Orders of the terms of a polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    any(not(target_arch = "x86_64"), unoptimised),
    allow(dead_code, reason = "the baseline has one")
)]
pub enum Order {
    /// Fewest operations.
    Horner,
    /// Two chains of operations that wait for each other.
    EvenAndOdd,
    /// Many short ones.
    Estrin,
}

/// What every processor of the target has.
pub struct Baseline;

impl Target for Baseline {
    const FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
    const ORDER: Order = Order::Estrin;
}

/// With [`Instructions::Avx2`].
#[cfg(all(target_arch = "x86_64", not(unoptimised)))]
struct Avx2;

#[cfg(all(target_arch = "x86_64", not(unoptimised)))]
impl Target for Avx2 {
    const FUSED: bool = true;
    const ORDER: Order = Order::EvenAndOdd;
}

/// With [`Instructions::Avx512`], which has registers for four vectors of a chain each.
#[cfg(all(target_arch = "x86_64", not(unoptimised)))]
struct Avx512;

#[cfg(all(target_arch = "x86_64", not(unoptimised)))]
impl Target for Avx512 {
    const FUSED: bool = true;
    const ORDER: Order = Order::Horner;
}

/// A function of its own, as those below: who calls it would have room for its variables on the stack otherwise.
#[inline(never)]
fn baseline<W: Work>(work: W) {
    work.run::<Baseline>();
}

#[cfg(all(target_arch = "x86_64", not(unoptimised)))]
#[target_feature(enable = "avx2,fma")]
fn avx2<W: Work>(work: W) {
    work.run::<Avx2>();
}

#[cfg(all(target_arch = "x86_64", not(unoptimised)))]
#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw")]
fn avx512<W: Work>(work: W) {
    work.run::<Avx512>();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_in_the_environment() {
        assert_eq!(wanted(Some("baseline")), Instructions::Baseline);
        assert_eq!(wanted(Some("AVX2")), Instructions::Avx2);
        assert_eq!(wanted(Some("avx512")), Instructions::Avx512);
        for unknown in [None, Some(""), Some("neon"), Some("avx-512")] {
            assert_eq!(wanted(unknown), Instructions::Avx512);
        }
    }

    #[test]
    fn only_available_sets_are_made() {
        for wanted in Instructions::ALL {
            let Available(found) = Available::at_most(wanted);
            assert!(found <= wanted && found.is_available());
            let better = Instructions::ALL.into_iter();
            let mut better = better.filter(|set| found < *set && *set <= wanted);
            assert!(better.all(|set| !set.is_available()));
        }
        assert!(Instructions::in_use().is_available());
    }

    /// Work runs once, on every set that is present.
    #[test]
    fn work_is_done_on_every_set() {
        struct Square<'a>(&'a mut [f64]);
        impl Work for Square<'_> {
            #[inline(always)]
            #[allow(clippy::inline_always, reason = "compiled anew for each set")]
            fn run<T: Target>(self) {
                for x in self.0 {
                    *x = T::add_product(*x, *x, 1.0);
                }
            }
        }
        for wanted in Instructions::ALL {
            let mut x: [f64; 37] = std::array::from_fn(|i| i as f64);
            Available::at_most(wanted).run(Square(&mut x));
            for (i, x) in x.into_iter().enumerate() {
                assert_eq!(x, (i * i + 1) as f64);
            }
        }
    }
}
