//! Powers with a real exponent, as generated laws compute them: many at a time, for the processor at hand.
//!
//! A power of a gap takes one logarithm and one exponential, shared by a force and its derivatives. Those of the standard
//! library handle one number at a time. The ones here are loops without a branch, which the compiler turns into vector
//! instructions, once for each instruction set; the best that the processor has is chosen when the first law is evaluated.
//!
//! # Instruction sets
//!
//! One set is used by all of a process, from the first law that is evaluated until it ends: the best that the processor has, or what the
//! environment variable `HERTZIAN_INSTRUCTIONS` (`baseline`, `avx2`, `avx512`) or [`Instructions::initialise`] asks for. A value of the
//! variable that is unknown counts as none; for a set that the processor does not have, the best one below it is used.
//!
//! # Accuracy
//!
//! For a base `x` and an exponent `a`, the error relative to the power is below `1.5 + 1.2 |a|` in units of `2^-52`, and less near `x = 1`:
//! `1.5 + 3.2 |a ln x|`. This holds over the whole range, with subnormal bases, and with results that are subnormal or overflow (a
//! subnormal result is within one of its own last digits more). A force and its derivative share an exponential if
//! the exponent of the derivative is at least -1/2: the force then has the rounding of a product more, and that of the
//! difference of the exponents, less than `4 + 4 |a ln x|` in all.
//!
//! # Repeatability
//!
//! A power depends on nothing but its base, its exponent and the instruction set: not on its place in an
//! array, the length of that, or the number of threads. Between instruction sets powers differ within these bounds,
//! since a processor that fuses products and sums rounds once where another rounds twice. Where the last digits must
//! be the same on all x86-64 machines, ask for `baseline` in a program that is compiled for all of them.

mod arrays;
mod cube_root;
mod functions;
mod instructions;
mod polynomial;
#[cfg(test)]
mod tests;

pub(crate) use arrays::{Bases, LANES, cube_roots, logarithms, multiply, powers, two_powers};
pub(crate) use cube_root::cube_root;
pub use instructions::Instructions;
pub(crate) use instructions::{Available, Baseline, Target, Work};
