//! Pairs of multipliers: the test function of a Neimark-Sacker bifurcation.
//!
//! Where two complex multipliers meet the unit circle, their product is one, so that
//!
//! ```text
//! product over i < j of ( mu_i mu_j - 1 )                                                                     (1)
//! ```
//!
//! vanishes. It is real, and as smooth as the multipliers are. Two real ones whose product is one make it vanish as well, which is
//! nothing special.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 4 (the bialternate product).

use nalgebra::Complex;

use super::Method;
use super::method::Floquet;
use super::orbit::Orbit;
use crate::balance::Balance;

/// Error of the multipliers that is aimed at: the event is located to what it leaves.
const EXACT: f64 = 1e-12;

/// (1), and whether the pair whose product is nearest to one is complex; not a number where nothing is known.
pub(crate) fn product_of_pairs(multipliers: &[Complex<f64>]) -> (f64, bool) {
    if multipliers.is_empty() {
        return (f64::NAN, false);
    }
    let mut product = Complex::new(1.0, 0.0);
    let mut nearest = (f64::INFINITY, false);
    for (i, a) in multipliers.iter().enumerate() {
        for b in &multipliers[i + 1..] {
            let factor = a * b - 1.0;
            product *= factor;
            if factor.norm() < nearest.0 {
                nearest = (factor.norm(), a.im != 0.0 && b.im != 0.0);
            }
        }
    }
    (product.re, nearest.1)
}

/// Pairs of the multipliers of orbits of one balance.
#[derive(Debug)]
pub(crate) struct Pairs<'a> {
    balance: Balance<'a>,
    engine: Box<dyn Floquet>,
    /// Orbits whose multipliers were computed.
    pub(crate) computed: usize,
}

impl<'a> Pairs<'a> {
    pub(crate) fn new(balance: Balance<'a>) -> Self {
        Self {
            balance,
            engine: Method::Monodromy.engine(),
            computed: 0,
        }
    }

    /// (1) at an orbit, given as extended unknowns.
    pub(crate) fn product(&mut self, u: &[f64]) -> (f64, bool) {
        let last = u.len() - 1;
        self.balance.set(u[last]);
        self.computed += 1;
        let orbit = Orbit::of(&self.balance, &u[..last]);
        product_of_pairs(&self.engine.multipliers(&orbit, EXACT).multipliers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_on_the_unit_circle_makes_it_vanish() {
        let at = |modulus: f64, angle: f64| Complex::from_polar(modulus, angle);
        let of = |modulus: f64| {
            let pair = [at(modulus, 0.7), at(modulus, -0.7)];
            product_of_pairs(&[pair[0], pair[1], at(0.5, 0.0), at(0.2, 0.0)])
        };
        assert!(of(1.0).0.abs() < 1e-15 && of(1.0).1);
        assert!(of(0.99).0 * of(1.01).0 < 0.0);
        // 2 and 1/2: the product is one, but nothing happens.
        let (product, complex) = product_of_pairs(&[at(2.0, 0.0), at(0.5, 0.0)]);
        assert!(product == 0.0 && !complex);
        assert!(product_of_pairs(&[]).0.is_nan());
    }
}
