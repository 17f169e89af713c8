//! The power laws in dual numbers, as one would write them with num-dual: a value with its derivatives by gap, rate and,
//! where there are three, by the exponent.

use num_dual::{DualNum, DualSVec64};

/// Whether a law has a force on both sides of its level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// `phi = 2 zeta r + sgn(g) |g|^alpha`
    Both,
    /// `phi = H(g) (2 zeta r + g^alpha)`
    One,
}

/// The exponent of a law.
#[derive(Debug, Clone, Copy)]
pub enum Exponent<D> {
    ThreeHalves,
    Number(D),
}

/// Force, and its derivatives by gap, by rate and, if `N` is three, by the exponent.
#[inline]
pub fn force<const N: usize>(
    sides: Sides,
    zeta: f64,
    exponent: Exponent<f64>,
    gap: f64,
    rate: f64,
) -> (f64, [f64; N]) {
    let variable = |value: f64, index| DualSVec64::<N>::from_re(value).derivative(index);
    let exponent = match exponent {
        Exponent::ThreeHalves => Exponent::ThreeHalves,
        Exponent::Number(alpha) if N > 2 => Exponent::Number(variable(alpha, 2)),
        Exponent::Number(alpha) => Exponent::Number(DualSVec64::from_re(alpha)),
    };
    let force = law(sides, zeta, exponent, variable(gap, 0), variable(rate, 1));
    let slopes = force.eps.unwrap_generic(nalgebra::Const::<N>, nalgebra::U1);
    (force.re, slopes.into())
}

/// The law.
#[inline]
fn law<const N: usize>(
    sides: Sides,
    zeta: f64,
    exponent: Exponent<DualSVec64<N>>,
    gap: DualSVec64<N>,
    rate: DualSVec64<N>,
) -> DualSVec64<N> {
    let power = |base: DualSVec64<N>| match exponent {
        Exponent::ThreeHalves => base * base.sqrt(),
        Exponent::Number(alpha) => base.powd(alpha),
    };
    let damping = rate * (2.0 * zeta);
    if gap.re > 0.0 {
        damping + power(gap)
    } else if sides == Sides::Both {
        damping - power(-gap)
    } else {
        DualSVec64::from_re(0.0)
    }
}
