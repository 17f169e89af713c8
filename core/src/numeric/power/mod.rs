//! Powers with a real exponent, as generated laws compute them: many at a time, for the processor at hand.
//!
//! A power of a gap takes one logarithm and one exponential, shared by a force and its derivatives. Those of the standard
//! library handle one number at a time. The ones here are loops without a branch, which the compiler turns into vector
//! instructions, once for each instruction set; the best that the processor has is chosen when the first law is evaluated.
//!
//! # Choosing
//!
//! Two things can be chosen for a process, before its runs: by an environment variable, or by a function.
//!
//! | | variable | values | function |
//! |---|---|---|---|
//! | instruction set | `HERTZIAN_INSTRUCTIONS` | `baseline`, `avx2`, `avx512` | [`Instructions::pin`] |
//! | accuracy of powers | `HERTZIAN_POWERS` | `full`, `fast` | [`Accuracy::choose`] |
//!
//! A value that is unknown counts as none; for an instruction set that the processor does not have, the best one below it
//! is used. Without a variable, the best instruction set and full accuracy are.
//!
//! # Accuracy
//!
//! For a base `x` and an exponent `a`, errors relative to the power, in units of `2^-52`:
//!
//! | | error of `x^a` | relative time |
//! |---|---|---|
//! | full | `1.5 + 1.2 |a|`, and less near `x = 1`: `1.5 + 3.2 |a ln x|` | 1 |
//! | fast | `2 + 4 |a ln x|` | 0.9 |
//!
//! Both hold over the whole range, with subnormal bases, and with results that are subnormal or overflow (a subnormal
//! result is within one of its own last digits more). A force and its derivative share an exponential if
//! the exponent of the derivative is at least -1/2: the force then has the rounding of a product more, and that of the
//! difference of the exponents, less than `4 + 4 |a ln x|` in all.
//!
//! # Repeatability
//!
//! A power depends on nothing but its base, its exponent, the accuracy and the instruction set: not on its place in an
//! array, the length of that, or the number of threads. Between instruction sets powers differ within these bounds,
//! since a processor that fuses products and sums rounds once where another rounds twice. Where the last digits must
//! be the same on all x86-64 machines, pin `baseline` in a program that is compiled for all of them.

mod arrays;
mod cube_root;
mod functions;
mod instructions;
mod polynomial;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicU8, Ordering};

pub(crate) use arrays::{Bases, LANES, cube_roots, logarithms, multiply, powers, two_powers};
pub(crate) use cube_root::cube_root;
pub use instructions::Instructions;
pub(crate) use instructions::{Available, Baseline, Target, Work};

/// The environment variable that chooses the accuracy.
const VARIABLE: &str = "HERTZIAN_POWERS";

/// How accurate the powers of generated laws are: see [the module](self).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Accuracy {
    /// To about one unit in the last place for the exponents of contacts.
    #[default]
    Full,
    /// To a few units times the logarithm of the power.
    Fast,
}

/// The accuracy in use, by its position plus one; zero as long as it has not been asked for.
static IN_USE: AtomicU8 = AtomicU8::new(0);

impl Accuracy {
    /// The accuracy in use: full, unless [`Accuracy::choose`] or, when it is first asked for, the environment variable
    /// `HERTZIAN_POWERS` says otherwise.
    #[inline]
    pub fn in_use() -> Self {
        match IN_USE.load(Ordering::Relaxed) {
            1 => Self::Full,
            2 => Self::Fast,
            _ => Self::first(),
        }
    }

    /// Makes all generated laws of this process compute powers to this accuracy from now on. It is to be called before a
    /// run, not during one.
    pub fn choose(self) {
        IN_USE.store(self as u8 + 1, Ordering::Relaxed);
    }

    #[cold]
    fn first() -> Self {
        let named = std::env::var(VARIABLE).ok();
        let chosen = wanted(named.as_deref());
        let (new, order) = (chosen as u8 + 1, Ordering::Relaxed);
        // What was chosen in the meantime stays.
        match IN_USE.compare_exchange(0, new, order, order) {
            Ok(_) => chosen,
            Err(_) => Self::in_use(),
        }
    }
}

/// The accuracy that a value of the environment variable asks for.
fn wanted(named: Option<&str>) -> Accuracy {
    match named {
        Some(name) if name.eq_ignore_ascii_case("fast") => Accuracy::Fast,
        _ => Accuracy::Full,
    }
}
